/// Simulation from one time to the next under inputs that are set during the simulation, for
/// coupling to other simulators.
///
/// Nothing is integrated again at a step: a segment continues from its event until the next event,
/// or until an input changes, and any time in the segment is evaluated from its begin. The division
/// into steps does not change the results. An input that changes by itself (rows, or a function of time) is
/// followed over its breakpoints, and cannot be set.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "pindrive/events/evolution.hpp"
#include "pindrive/events/set_inputs.hpp"
#include "pindrive/events/stepper_state.hpp"
#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

template <class T>
class Stepper {
  static constexpr T never = std::numeric_limits<T>::infinity();

 public:
  using State = StepperState<T>;
  /// Receives each segment that ends, and the state of the pin after.
  using Sink = Callback<const Segment<T>&, const detail::State<T>&>;

  /// Release at the time `begin`, s. The duration of the inputs is ignored. The friction curves of
  /// the drive, and the rows and pieces of inputs, are referenced, not copied.
  Stepper(const Drive<T>& drive, const Inputs<T>& inputs, T begin = T(0))
      : drive_(drive),
        inputs_(detail::without_end(inputs)),
        evolution_(drive_, inputs_, begin),
        now_(begin),
        before_(evolution_.pin.mode()) {
    if (const InputPiece<T>* const piece = inputs_.plate_load.held().piece) {
      load_by(OwnedPiece<T>(*piece));
      evolution_.pin.plate.load = inputs_.plate_load.from(begin);
    }
    select(false, {});
  }
  /// From a state of a stepper. Of `begun`, the inputs of that stepper's release, those that change by
  /// themselves are read.
  Stepper(const Drive<T>& drive, const State& state, const Inputs<T>& begun = {T(0), T(0), T(0)})
      : drive_(drive),
        inputs_(detail::continued(state, begun)),
        evolution_(drive_, inputs_, state.since),
        now_(state.now),
        horizon_(state.horizon) {
    if (!state.load_piece.piece.straight()) load_by(state.load_piece);
    restore(state);
    select(false, {});
    event_ = state.event;
  }
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  State state() const {
    State found = with_inputs(last_);
    found.now = now_;
    return found;
  }
  /// Ends the present segment now; returns the state on a clock that begins now, for another stepper.
  State hand_over() {
    restart();
    State found = with_inputs(kept());
    found.plate_velocity = evolution_.pin.plate.surface.line();
    for (Held<T>* velocity : {&found.mouse_velocity, &found.across_velocity})
      if (velocity->piece != nullptr) *velocity = {now_, velocity->from(now_).line()};
    return found.on_clock_from(now_);
  }

  /// Advances to the time `until` (s, >= now) or, with `stop_at_event`, to the first contact event
  /// before. `go_on` is called after each event, and `sink` with each segment that ends and the state of the pin after. With a horizon,
  /// `until` is not beyond it.
  ///
  /// Returns false if the step is incomplete: `status` is not ok, or go_on() returned false, and
  /// now() is the time of the last event; the next step continues from there.
  bool step(T until, bool stop_at_event = false, GoOn go_on = {}, Sink sink = {}) {
    int standing = 0;
    bool stopped = false;
    while (status() == Status::ok && !stopped && !(next() > until) && next() < horizon_) {
      const bool together = !(tau_ > 0);
      if (stop_at_event && !together && happens_after(now_)) break;
      before_ = segment_.mode;
      evolution_.jump(segment_, tau_);
      const Event event = select(true, sink);
      if (!together || event.plate != Transition::none) event_.plate = event.plate;
      if (!together || event.finger != Transition::none) event_.finger = event.finger;
      if (!together || event.stop != Transition::none) event_.stop = event.stop;
      standing = together ? standing + 1 : 0;
      if (standing > detail::standstill_limit) status_ = Status::standstill;
      stopped = !go_on();
    }
    if (status() != Status::ok) return false;
    const bool at_event = stopped || (stop_at_event && happens_after(now_));
    now_ = at_event ? T(plain(evolution_.pin.time)) : until;
    if (now_ > evolution_.pin.time) event_ = {};
    return !stopped;
  }

  /// Sets the inputs from now on, values and rates; a falling load stops at zero. The finger load is that before it
  /// is raised to the power of the release's. The plate load may be a
  /// piece of a function with at most two terms, and so may a velocity, whose piece must outlive the stepper.
  ///
  /// A jump of the mouse velocity moves the housing in no time: the pin keeps its velocity relative
  /// to the housing, which no finite force could change. A jump of the transverse velocity acts
  /// likewise. A value that differs from the continued input by rounding changes nothing.
  ///
  /// `horizon` is the time (s) at which the inputs are set next at the latest: events are not sought
  /// beyond it, as if the inputs had a breakpoint there. `sink` is called as in a step.
  void set(const InputCurves<T>& given, T horizon = never, Sink sink = {}) {
    Held<T>&velocity = inputs_.mouse_velocity.held(), &load = inputs_.plate_load.held();
    Held<T>&across = inputs_.across_velocity.held(), &force = inputs_.force.held();
    Held<T>& touch = inputs_.finger_load.held();
    const bool turns = detail::differs(given.plate_velocity, inputs_.mouse_velocity, now_),
               loads = detail::differs(given.plate_load, inputs_.plate_load, now_);
    const bool drifts = detail::differs(given.across_velocity, inputs_.across_velocity, now_),
               pushes = detail::differs(given.force, inputs_.force, now_);
    const bool touches = detail::differs(given.finger_load, inputs_.finger_load, now_);
    if (!turns && !loads && !drifts && !pushes && !touches && horizon == horizon_) return;
    horizon_ = horizon;
    const T jump = turns ? detail::change_to(given.plate_velocity.value, velocity, now_) : T(0);
    const bool across_jumps =
        drifts && plain(detail::change_to(given.across_velocity.value, across, now_)) != 0;
    const T from = detail::is_zero(jump) ? given.plate_velocity.value : velocity.from(now_).value;
    const bool jumps = !detail::is_zero(jump);
    if (turns)
      velocity = jumps ? Held<T>(now_, {from, given.plate_velocity.rate})
                       : detail::held_from(now_, given.plate_velocity);
    if (loads && given.plate_load.straight())
      load = detail::load_from(now_, given.plate_load.line());
    else if (loads)
      load_by(OwnedPiece<T>(*given.plate_load.piece));
    if (drifts) across = detail::held_from(now_, given.across_velocity);
    if (pushes) force = {now_, given.force.line()};
    if (touches) touch = detail::load_from(now_, given.finger_load.line());
    for (Held<T>* each : {&velocity, &across}) detail::end_at(*each, now_, horizon);
    const bool ends = restart();
    if (jumps) {
      velocity.line.value = detail::moved(velocity.line.value, jump, given.plate_velocity.value);
      detail::shift(evolution_, jump, velocity.line.value);
      if (!given.plate_velocity.straight()) {
        velocity = Held<T>(*given.plate_velocity.piece);
        evolution_.pin.plate.surface = given.plate_velocity;
      }
    }
    if (across_jumps) detail::turn(evolution_.pin.plate, evolution_.pin.state.v);
    event_ = select(ends, sink);
  }

  Status status() const { return status_; }
  T now() const { return now_; }  ///< s
  /// Time until which no contact changes if the inputs continue unchanged, s; infinite if none ever
  /// changes.
  T next() const {
    const bool at_breakpoint = tau_ == evolution_.until_breakpoint();
    return at_breakpoint ? evolution_.next_breakpoint : evolution_.time_after(tau_);
  }
  const Event& event() const { return event_; }  ///< transitions of the contacts now
  Mode mode() const { return segment_.mode; }    ///< mode of the contacts from now on
  const Drive<T>& drive() const { return drive_; }
  /// Inputs now, as they are set.
  InputCurves<T> inputs() const {
    return {inputs_.mouse_velocity.from(now_), inputs_.plate_load.from(now_),
            inputs_.across_velocity.from(now_), inputs_.force.from(now_),
            inputs_.finger_load.given_from(now_)};
  }

  /// Present segment, its duration until now, and its inputs from its begin on.
  const Segment<T>& segment() const { return segment_; }
  /// Present segment, ended now.
  Segment<T> segment_until_now() const {
    Segment<T> found = segment_;
    found.end = now_;
    found.moved = found.flow.after(tau());
    return found;
  }
  T tau() const { return std::min(std::max(now_ - segment_.begin, T(0)), tau_); }
  /// State of the pin now, without the tension of slipping skin.
  detail::State<T> pin() const {
    detail::State<T> pin = evolution_.pin.state;
    if (!(tau() > 0)) return pin;
    evolution_.series.move(pin, drive_, evolution_.pin.finger, tau());
    if (evolution_.series.used()) return pin;
    Segment<T> along = segment_;
    along.moved = along.flow.after(tau());
    pin.move(along, evolution_.pin.finger.elastic());
    return pin;
  }
  /// Series step of the present segment; null for a mode with a closed form.
  const detail::SeriesStep<T>* series_step() const { return evolution_.series.step(); }
  InputCurves<T> lines() const {
    return {segment_.plate_velocity, evolution_.pin.plate.load, evolution_.pin.plate.across,
            evolution_.pin.force, evolution_.pin.finger.load};
  }

 private:
  /// Sets a plate load that is no line. The piece before keeps its place: the present segment refers to it.
  void load_by(const OwnedPiece<T>& load) {
    present_ = 1 - present_;
    loads_[present_] = load;
    inputs_.plate_load.held() = Held<T>(loads_[present_].piece);
  }
  bool happens_after(const T& time) const { return event_.any() && evolution_.pin.time > time; }

  void restore(const State& state) {
    evolution_.pin.time = state.since;
    evolution_.time_error = state.since_error;
    evolution_.pin.state = state.pin;
    evolution_.pin.plate.mode = state.plate;
    evolution_.pin.finger.mode = state.finger;
    evolution_.pin.plate.reached_guard = state.at_plate;
    evolution_.pin.finger.reached_guard = state.at_finger;
    evolution_.pin.plate.surface = inputs_.mouse_velocity.from(state.since);
    evolution_.pin.plate.surface.value = state.plate_velocity.value;
    evolution_.pin.plate.surface.rate = state.plate_velocity.rate;
    evolution_.pin.stick_limit_side = state.limit;
    evolution_.pin.stop.state = state.stop;
    evolution_.pin.stop.released = state.stop_released;
    evolution_.pin.stop.met = state.stop_met;
    evolution_.struck = state.struck;
    before_ = state.before;
    take_inputs(state.since);
  }
  /// Reads the inputs except for the plate velocity, which may be known to be exactly that of the
  /// pin.
  void take_inputs(const T& time) {
    evolution_.pin.plate.load = inputs_.plate_load.from(time);
    evolution_.pin.plate.across = InputCurves<T>::across_from(
        inputs_, time, evolution_.pin.plate.surface, evolution_.pin.held());
    evolution_.pin.force = inputs_.force.from(time);
    evolution_.pin.finger.load = inputs_.finger_load.from(time);
  }

  /// Advances the pin to now, where an input has a breakpoint; an event within the time resolution
  /// of now happens now. True if the present segment ends.
  bool restart() {
    using std::abs;
    if (abs(now_ - evolution_.pin.time) <= detail::rounding<T> * abs(now_)) {
      restore(last_);
      evolution_.pin.time = now_;
      evolution_.time_error = T(0);
      Curve<T> surface = inputs_.mouse_velocity.from(now_);
      surface.value = evolution_.pin.plate.surface.value;
      evolution_.pin.plate.surface = surface;
      take_inputs(now_);
      evolution_.pin.stick_limit_side = 0;
      if (evolution_.pin.stop.rigid()) evolution_.pin.stop.released = false;  // the push may jump
      return false;
    }
    evolution_.next_breakpoint = now_;
    before_ = segment_.mode;
    evolution_.jump(segment_, evolution_.until_breakpoint());
    return true;
  }

  State with_inputs(State state) const {
    state.mouse_velocity = inputs_.mouse_velocity.held();
    state.plate_load = inputs_.plate_load.held();
    state.load_piece = {};
    if (const InputPiece<T>* const piece = state.plate_load.piece)
      state.load_piece = OwnedPiece<T>(*piece);
    state.plate_load.piece = nullptr;
    state.across_velocity = inputs_.across_velocity.held();
    state.force = inputs_.force.held();
    state.finger_load = inputs_.finger_load.held();
    state.horizon = horizon_;
    state.event = event_;
    return state;
  }
  /// State of the pin without inputs, before the next mode is selected.
  State kept() const {
    const auto& pin = evolution_.pin;
    return {now_,
            pin.time,
            evolution_.time_error,
            pin.state,
            pin.plate.mode,
            pin.finger.mode,
            pin.plate.reached_guard,
            pin.finger.reached_guard,
            pin.stick_limit_side,
            pin.stop.state,
            pin.stop.released,
            pin.stop.met,
            evolution_.struck,
            before_,
            pin.plate.surface.line()};
  }

  /// Begins the next segment; the present one `ends`. Returns the transitions.
  Event select(bool ends, Sink sink) {
    last_ = kept();
    const auto &plate = evolution_.pin.plate, &finger = evolution_.pin.finger;
    // Linear quantities are evaluated over a finite time.
    const bool steady = plate.surface.rate == 0 && plate.load.rate == 0 && finger.load.rate == 0 &&
                        evolution_.pin.force.rate == 0;
    evolution_.next_breakpoint = std::min({inputs_.next_breakpoint(evolution_.pin.time),
                                           steady ? never : evolution_.pin.time + far_, horizon_});
    if (!evolution_.select()) status_ = Status::inconsistent;
    const Event event = evolution_.transitions(before_);
    if (ends) {
      segment_.event = event;
      sink(segment_, evolution_.pin.state);
    } else if (!same_mode(segment_.mode, evolution_.pin.mode())) {
      // Inputs set once more in one instant: the mode that was selected in between ends at once.
      segment_.event = evolution_.transitions(segment_.mode);
      segment_.end = evolution_.pin.time;
      sink(segment_, evolution_.pin.state);
    }
    evolution_.begin(segment_);
    tau_ = evolution_.earliest(segment_.flow);
    if (evolution_.series.used()) segment_.end = evolution_.pin.time + tau_;
    return event;
  }

  static T far_for(const Drive<T>& drive) {
    using std::sqrt;
    return T(detail::longest_segment) * sqrt(drive.mass / drive.stiffness);
  }

  Drive<T> drive_;
  std::array<OwnedPiece<T>, 2> loads_{};  ///< plate load that is no line, and the one before
  std::size_t present_{0};
  T far_{far_for(drive_)};  ///< s
  Inputs<T> inputs_;
  detail::Evolution<T> evolution_;
  T now_;             ///< s
  T horizon_{never};  ///< time at which the inputs are set next at the latest, s
  Mode before_{};     ///< mode until the last event
  State last_;        ///< state at the last event, before the mode was selected
  Segment<T> segment_{};
  T tau_;  ///< duration of the segment if the inputs continue, s
  Event event_{};
  Status status_{Status::ok};
};

}  // namespace pindrive
