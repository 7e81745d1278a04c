/// One pin under a moving hand: its control block, its coil and its motion, advanced from row to row of
/// the inputs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/device/coil.hpp"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/scan_inputs.hpp"
#include "pindrive/events/stepper.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::device {

/// Pin under a hand with a path that is given while the hand moves. The times at which the caller pauses do not
/// change a bit.
class PinFollower {
 public:
  using Sink = Stepper<double>::Sink;

  /// Complete state: a follower constructed from this state gives identical bits.
  struct State {
    StepperState<double> motion;
    CoilState<double> coil;
    double sampled;               ///< time until which the page is sampled, s
    double passed;                ///< time of the last row of an input, s since the begin
    bool decision;                ///< last decision of the control block
    std::vector<double> pending;  ///< times of the switchings that are due, s
  };

  PinFollower(const ScanInputs& scan, const PinState& from)
      : device_(&scan.device),
        begin_(scan.begin),
        coil_(Coil<double>::begun(device_->magnet, from.coil, begin_)),
        sampled_(begin_),
        decision_(from.decision),
        pending_(from.pending),
        stepper_(from.motion ? Stepper<double>(device_->drive, *from.motion, begun(scan))
                             : Stepper<double>(device_->drive, release(scan, from))) {
    pass(scan, 0, {});
  }
  PinFollower(const ScanInputs& scan, const State& state)
      : device_(&scan.device),
        begin_(scan.begin),
        coil_(passed(Coil<double>(device_->magnet, state.coil), begin_, state.passed)),
        sampled_(state.sampled),
        passed_(state.passed),
        decision_(state.decision),
        pending_(state.pending),
        stepper_(device_->drive, state.motion, begun(scan)) {}
  PinFollower(const PinFollower&) = delete;
  PinFollower& operator=(const PinFollower&) = delete;

  State state() const {
    return {
        stepper_.state(), coil_.state(),
        sampled_,         passed_,
        decision_,        {pending_.begin() + static_cast<std::ptrdiff_t>(given_), pending_.end()}};
  }

  /// Samples the page under the spot of the pin before a time, s.
  void sample(const ScanInputs& scan, std::size_t pin, double until) {
    const Controller& controller = device_->controller;
    controller.each_sample(sampled_, until, [&](double time) {
      controller.sample(time, scan.luminance(pin, time), decision_, pending_);
      return true;
    });
    sampled_ = until;
  }

  /// Advances the pin to a time until which it is sampled, s; false as for `Stepper::step`. Rows and
  /// switchings at that time itself wait for the next call. `go_on` is called after each event and row.
  bool advance(const ScanInputs& scan, double until, GoOn go_on = {}, Sink sink = {}) {
    const double end = until - begin_;
    for (double row = next(scan); row < end; row = next(scan)) {
      const double time = std::max(row, stepper_.now());
      if (!stepper_.step(time, false, go_on, sink) || !go_on()) return false;
      pass(scan, time, sink);
    }
    return stepper_.step(end, false, go_on, sink);
  }

  /// Ends the motion at the end of the path; returns its state for another scan that begins there.
  StepperState<double> hand_over(const ScanInputs& scan) {
    StepperState<double> found = stepper_.hand_over();
    // The value of a piece at its end is rounded otherwise than that of the row.
    const double end = scan.plate.end();
    if (!scan.plate.along().straight())
      found.mouse_velocity.line.value = scan.plate.along().from(end).value;
    if (!scan.plate.across().straight())
      found.across_velocity.line.value = scan.plate.across().from(end).value;
    return found;
  }

  const Stepper<double>& stepper() const { return stepper_; }  ///< time since the begin
  const Coil<double>& coil() const { return coil_; }
  bool decision() const { return decision_; }  ///< last decision of the control block

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Inputs of a release, with their values at the begin of the scan.
  Inputs<double> release(const ScanInputs& scan, const PinState& from) {
    const PlateVelocity& plate = scan.plate;
    const Held<double> along = detail::held_from(0.0, plate.along().from(0));
    Inputs<double> inputs{
        along,    from.position, std::isnan(from.velocity) ? along.line.value : from.velocity,
        infinity, load(scan, 0), scan.held_stretch(from.stretch)};
    inputs.across_velocity = detail::held_from(0.0, plate.across().from(0));
    inputs.finger_load = begun(scan).finger_load;
    return inputs;
  }
  /// The touch at the begin, with the power of its friction.
  static Inputs<double> begun(const ScanInputs& scan) {
    Inputs<double> inputs{0.0, 0, 0};
    const Profile<double> touch(0, scan.finger_load.given_from(0).line());
    inputs.finger_load = touch.to_the(scan.finger_load.power());
    return inputs;
  }
  /// Factor of the plate friction from a time on, s since the begin: from the present piece of the pull, and from the
  /// touch. `turns`: the touch has a row there.
  Held<double> load(const ScanInputs& scan, double time, bool turns = false) {
    const LineSince<double> touch = scan.touch(time);
    load_ = device_->pressing.load_under(coil_.pull_piece(), begin_, touch);
    if (turns) load_ = later(load_, touch.since);
    const InputPiece<double>& piece = load_.piece;
    if (!piece.straight()) return Held<double>(piece);
    return {piece.begin, {piece.polynomial[0], piece.polynomial[1]}};
  }
  /// Advances a coil past its changes until a time, s, which counts from the begin of the scan.
  static Coil<double> passed(Coil<double> coil, double begin, double time) {
    while (coil.next() - begin <= time) coil.pass(coil.next());
    return coil;
  }

  /// Time of the next switching that is due, s.
  double command() const { return given_ < pending_.size() ? pending_[given_] : infinity; }
  void give_command() {
    coil_.command(!coil_.state().command, pending_[given_]);
    if (2 * ++given_ <= pending_.size()) return;  // so each switching is moved once on average
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(given_));
    given_ = 0;
  }
  /// Time of the next row or switching, s since the begin.
  double next(const ScanInputs& scan) const {
    return std::min(std::min(command(), coil_.next()) - begin_, scan.next_row(passed_));
  }

  /// Sets the inputs from their rows until a time, s since the begin. A change of the coil comes after a command
  /// at the same time.
  void pass(const ScanInputs& scan, double time, Sink sink) {
    InputCurves<double> lines = stepper_.inputs();
    bool pulls = passed_ == -infinity;  // a piece of another scan may have ended
    for (double at; (at = std::min(command(), coil_.next())) - begin_ <= time; pulls = true) {
      if (at == command())
        give_command();
      else
        coil_.pass(at);
    }
    const bool rows = scan.next_row(passed_) <= time;
    if (rows) {
      const PlateVelocity& plate = scan.plate;
      lines.plate_velocity = plate.along().from(time);
      lines.across_velocity = plate.across().from(time);
      lines.finger_load = scan.finger_load.given_from(time);
    }
    const bool turns =
        !pulls && device_->pressing.touch != 0 && rows && scan.finger_load.turns(passed_, time);
    if (pulls || turns) lines.plate_load = load(scan, time, turns).from(time);
    passed_ = time;
    // A switching that is due may be known or not, by the times at which the caller pauses.
    const double horizon = std::min(coil_.next() - begin_, scan.next_row(passed_));
    stepper_.set(lines, horizon, sink);
  }

  const Device* device_;
  double begin_;  ///< of the scan, s
  Coil<double> coil_;
  OwnedPiece<double> load_;  ///< last load that was given to the stepper
  double sampled_, passed_{-infinity};
  bool decision_;
  std::vector<double> pending_;
  std::size_t given_{0};  ///< number of the pending switchings that were given to the coil
  Stepper<double> stepper_;
};

}  // namespace pindrive::device
