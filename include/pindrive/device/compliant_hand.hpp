/// Hand that a spring and a damper lead along its path, and that the pins of the device slow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/bodies/follow.hpp"
#include "pindrive/bodies/system.hpp"
#include "pindrive/device/coil.hpp"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/scan_inputs.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/callback.hpp"

namespace pindrive::device {

/// Hand and mouse without their pins, and the arm that leads them.
struct Hand {
  double mass;                         ///< kg; > 0
  double stiffness, damping;           ///< arm about the intended path, N/m and N s/m; >= 0
  double kinetic{0}, static_limit{0};  ///< friction of the mouse on the page, N
};

/// Rows of the path that a hand takes, along the drive axis.
struct HandRows {
  std::vector<double> times;     ///< s
  std::vector<double> velocity;  ///< m/s
  std::vector<Bend> bends;       ///< bend of each stretch
};

/// Hand and pins as bodies on the drive axis, from the begin of the intended path to its end. The control block of each
/// pin samples the page where the hand is.
class CompliantHand {
 public:
  /// `intended` is a path along the drive axis.
  CompliantHand(const Hand& hand, const ScanInputs& intended, const std::vector<PinState>& begins)
      : scan_(&intended),
        pins_(begins.size()),
        system_(built(hand, begins)),
        following_(system_, initial(begins)) {}
  CompliantHand(const CompliantHand&) = delete;
  CompliantHand& operator=(const CompliantHand&) = delete;

  /// Follows the hand to the end of its path; false if `go_on` or the status ended it before.
  bool advance(GoOn go_on = {}) {
    const double end = scan_->plate.end();
    add_row(0, following_.state().velocity[0]);
    const auto keep = [&](const bodies::Step<double>& step) {
      add_rows(step);
      return go_on();
    };
    const auto sample = [&](const bodies::Step<double>& step, double& tau) {
      return sample_until(step, tau);
    };
    while (following_.status() == Status::ok && following_.state().time < end) {
      following_.advance(std::min(end, next_change()), keep, sample);
      pass(following_.state().time);
      following_.resume();
    }
    end_rows(end);
    return following_.status() == Status::ok;
  }

  Status status() const { return following_.status(); }
  const HandRows& rows() const { return rows_; }
  /// Sampling times at which the place of the hand, within its rounding, decides about a coil, s.
  const std::vector<double>& ambiguous() const { return ambiguous_; }
  long steps() const { return following_.steps(); }
  /// Deflection of a pin in the mouse at the end, m.
  double deflection(std::size_t pin) const {
    return following_.state().position[0] - following_.state().position[1 + pin];
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  /// Largest error of the velocity in a stretch over the largest intended speed.
  static constexpr double fine = 1e-10;
  /// Shortest stretch of a path, s: a shorter step changes no velocity.
  static constexpr double shortest = 1e-9;

  struct Pin {
    Coil<double> coil;
    bool decision;
    std::vector<double> due;  ///< times of the switchings to come, s
    OwnedPiece<double> load;  ///< load of the plate
  };

  // ---- hand and pins as bodies ------------------------------------------------------------------

  bodies::System<double> built(const Hand& hand, const std::vector<PinState>& begins) {
    bodies::System<double> system;
    const Device& device = scan_->device;
    const Drive<double>& drive = device.drive;
    intend(hand);
    system.bodies.push_back({hand.mass, {led_.data(), led_.size()}});
    system.links.push_back(
        {0, bodies::ground, hand.stiffness, hand.damping, {intended_.data(), intended_.size()}});
    held_.reserve(pins_);
    for (std::size_t i = 0; i < pins_; ++i) {
      const int pin = static_cast<int>(i) + 1;
      system.bodies.push_back({drive.mass});
      system.links.push_back({pin, 0, drive.stiffness, drive.damping});
      const PinState& from = begins[i];
      held_.push_back({Coil<double>::begun(device.magnet, from.coil, scan_->begin),
                       from.decision,
                       from.pending,
                       {}});
      system.contacts.push_back(
          {pin, bodies::ground, drive.plate.kinetic, drive.plate.static_limit});
    }
    if (drive.finger.present())
      for (std::size_t i = 0; i < pins_; ++i)
        system.contacts.push_back({static_cast<int>(i) + 1, 0, drive.finger.kinetic,
                                   drive.finger.static_limit, drive.finger.stiffness,
                                   drive.finger.damping, scan_->finger_load});
    for (std::size_t i = 0; drive.stops.present() && i < pins_; ++i)
      for (const int side : {-1, 1})
        system.stops.push_back({static_cast<int>(i) + 1, 0, side * drive.stops.travel, side,
                                drive.stops.stiffness, drive.stops.damping});
    if (hand.static_limit > 0)
      system.contacts.push_back({0, bodies::ground, hand.kinetic, hand.static_limit});
    for (std::size_t i = 0; i < pins_; ++i) system.contacts[i].load = pressed(i, 0);
    return system;
  }
  /// Place along the axis that the arm intends, and the force that would give the hand alone this motion: its inertia,
  /// and the friction of the mouse while it slides.
  void intend(const Hand& hand) {
    const PlateVelocity::Component& along = scan_->plate.along_axis();
    const std::vector<double>& times = scan_->plate.times();
    std::vector<double> turns = turnings(scan_->path, scan_->device.axis);
    double place = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const bool last = i + 1 == times.size();
      InputPiece<double> velocity{times[i], {along.rows[i]}};
      if (!along.pieces.empty())
        velocity.polynomial = along.pieces[i].polynomial;
      else if (!last)
        velocity.polynomial[1] = (along.rows[i + 1] - along.rows[i]) / (times[i + 1] - times[i]);
      fastest_ = std::max(fastest_, std::abs(along.rows[i]));
      std::vector<double> begins{times[i]};
      for (const double turn : turns)
        if (const double at = turn - scan_->begin; !last && times[i] < at && at < times[i + 1])
          begins.push_back(at);
      for (std::size_t k = 0; k < begins.size(); ++k) {
        const double end = k + 1 < begins.size() ? begins[k + 1] : last ? begins[k] : times[i + 1];
        place += intend(hand, velocity, begins[k], end, place);
      }
    }
  }
  /// Adds the intended position and the force for it between two times, s; returns the displacement, m.
  double intend(const Hand& hand, const InputPiece<double>& velocity, double begin, double end,
                double place) {
    constexpr int degree = InputPiece<double>::degree;
    std::array<double, degree + 1> v;
    velocity.expand(begin - velocity.begin, 1.0, v, degree);
    InputPiece<double>&place_of = intended_.emplace_back(), &force = led_.emplace_back();
    place_of.begin = force.begin = begin;
    place_of.polynomial[0] = place;
    for (int n = 0; n < degree; ++n) {
      place_of.polynomial[n + 1] = v[n] / (n + 1);
      force.polynomial[n] = hand.mass * (n + 1) * v[n + 1];
    }
    const double speed = velocity.at(0.5 * (begin + end) - velocity.begin);
    if (speed != 0) force.polynomial[0] += std::copysign(hand.kinetic, speed);
    return place_of.at(end - begin) - place;
  }
  bodies::State<double> initial(const std::vector<PinState>& begins) const {
    bodies::State<double> state;
    const double speed = scan_->plate.along().from(0).value;
    state.position.push_back(0);
    state.velocity.push_back(speed);
    const Contact<double>& finger = scan_->device.drive.finger;
    state.stretch.assign(system_.contacts.size(), 0.0);
    for (std::size_t i = 0; i < begins.size(); ++i) {
      const PinState& from = begins[i];
      const double within = std::isnan(from.velocity) ? speed : from.velocity;
      state.position.push_back(-from.position);
      state.velocity.push_back(speed - within);
      if (!finger.compliant()) continue;
      const double held = scan_->held_stretch(from.stretch);
      const double slid = finger.kinetic * scan_->finger_load.from(0).value / finger.stiffness;
      const double slides = within == 0 ? 0 : std::copysign(slid, within);
      state.stretch[begins.size() + i] = -(std::isnan(held) ? slides : held);
    }
    return state;
  }

  // ---- magnets -----------------------------------------------------------------------------------

  double next_change() const {
    double next = infinity;
    for (const Pin& pin : held_) {
      next = std::min(next, pin.coil.next());
      if (!pin.due.empty()) next = std::min(next, pin.due.front());
    }
    return next - scan_->begin;
  }
  /// Gives commands and changes of the coils until a time, s since the begin.
  void pass(double time) {
    for (std::size_t i = 0; i < pins_; ++i) {
      Pin& pin = held_[i];
      bool changes = false;
      for (;;) {
        const double command = pin.due.empty() ? infinity : pin.due.front();
        const double at = std::min(command, pin.coil.next());
        if (at - scan_->begin > time) break;
        changes = true;
        if (at == command) {
          pin.coil.command(!pin.coil.state().command, at);
          pin.due.erase(pin.due.begin());
        } else {
          pin.coil.pass(at);
        }
      }
      if (changes) system_.contacts[i].load = pressed(i, time);
    }
  }
  /// Load of a plate from a time on, s since the begin.
  Profile<double> pressed(std::size_t i, double time) {
    Pin& pin = held_[i];
    pin.load =
        scan_->device.pressing.load_under(pin.coil.pull_piece(), scan_->begin, scan_->touch(time));
    const InputPiece<double>& piece = pin.load.piece;
    if (!piece.straight()) return Held<double>(piece);
    return Held<double>(piece.begin, {piece.polynomial[0], piece.polynomial[1]});
  }
  /// Samples the page during a step; shortens the step to a switching that is due before its end.
  bool sample_until(const bodies::Step<double>& step, double& tau) {
    const Controller& controller = scan_->device.controller;
    const double begin = scan_->begin + step.begin(), end = begin + tau;
    double due =
        scan_->begin + next_change();  // a switching may have become due in the step before
    controller.each_sample(std::max(begin, sampled_), end, [&](double time) {
      if (time >= due) return false;
      const double place = step.position(0, time - begin);
      for (std::size_t i = 0; i < pins_; ++i) {
        Pin& pin = held_[i];
        const bool before = pin.decision;
        const std::size_t count = pin.due.size();
        controller.sample(time, luminance(i, place), pin.decision, pin.due);
        if (pin.due.size() > count) due = std::min(due, pin.due.back());
        for (const double side : {-place_error, place_error})
          if (controller.decides(before, luminance(i, place + side)) != pin.decision)
            ambiguous_.push_back(time);
      }
      return true;
    });
    sampled_ = std::min(end, due);
    if (due >= end) return true;
    tau = due - begin;
    return false;
  }
  /// Luminance under a pin where the hand is at a place along the axis since the begin, m.
  double luminance(std::size_t pin, double place) const {
    const Vector way = scan_->device.axis.direction();
    const Place at{scan_->path.x[0] + way.x * place, scan_->path.y[0] + way.y * place};
    return scan_->raster.at(at + scan_->device.spots[pin]);
  }
  /// Rounding of a place along a path, m.
  static constexpr double place_error = 1e-15;

  // ---- path --------------------------------------------------------------------------------------

  void add_row(double time, double velocity) {
    rows_.times.push_back(scan_->begin + time);
    rows_.velocity.push_back(velocity);
  }
  /// Velocity of the hand, zero within the rounding of the fastest: pins at their stops may lock a hand.
  double velocity_at(const bodies::Step<double>& step, double tau) const {
    const double velocity = step.velocity(0, tau);
    return std::abs(velocity) > 1e-15 * fastest_ ? velocity : 0;
  }
  /// Adds stretches of degree 4 that leave less than `fine` of the velocity of a step.
  void add_rows(const bodies::Step<double>& step) {
    if (step.length() < shortest) return;
    const double before = rows_.velocity.back(), now = velocity_at(step, 0);
    if (std::abs(now - before) >
        fine * fastest_) {  // a pin struck a rigid stop: a ramp just before
      rows_.times.back() -= 0.5 * shortest;
      add_row(step.begin(), now);
      rows_.bends.push_back({});
    }
    const auto& series = step.velocity_series(0);
    const double part = step.length() / step.span();
    double rest = 0, power = std::pow(part, 5);
    for (int n = 5; n <= step.order(); ++n, power *= part) rest += std::abs(series[n]) * power;
    const double allowed = fine * std::max(fastest_, std::abs(series[0]));
    const int count =
        std::max(1, static_cast<int>(std::ceil(std::pow(rest / (256 * allowed), 0.2))));
    for (int k = 0; k < count; ++k) {
      const double from = step.length() * k / count, lasts = step.length() / count;
      add_stretch(step, from, lasts);
    }
  }
  /// Adds a stretch whose velocity is that of a step at five points.
  void add_stretch(const bodies::Step<double>& step, double from, double lasts) {
    const double before = rows_.velocity.back(), after = velocity_at(step, from + lasts);
    // The bend over s (1 − s) at three points, as a polynomial b₀ + b₁ s + b₂ s².
    const double s[3] = {0.17267316464601143, 0.5, 0.8273268353539887};
    double f[3];
    for (int i = 0; i < 3; ++i)
      f[i] = (velocity_at(step, from + lasts * s[i]) - before - (after - before) * s[i]) /
             (s[i] * (1 - s[i]));
    const double first = (f[1] - f[0]) / (s[1] - s[0]), second = (f[2] - f[1]) / (s[2] - s[1]);
    const double bend = (second - first) / (s[2] - s[0]);
    rows_.bends.push_back(
        {{f[0] - first * s[0] + bend * s[0] * s[1], first - bend * (s[0] + s[1]), bend}});
    add_row(step.begin() + from + lasts, after);
  }
  /// Ends the last stretch exactly at the end of the path.
  void end_rows(double end) {
    if (rows_.times.size() > 1) rows_.times.back() = scan_->begin + end;
  }

  const ScanInputs* scan_;
  std::size_t pins_;
  double fastest_{0};                               ///< largest intended speed, m/s
  std::vector<InputPiece<double>> intended_, led_;  ///< place and force of the arm
  std::vector<Pin> held_;  ///< never resized: the system refers to their loads
  bodies::System<double> system_;
  double sampled_{-infinity};
  std::vector<double> ambiguous_;
  HandRows rows_;
  bodies::Following<double> following_;
};

}  // namespace pindrive::device
