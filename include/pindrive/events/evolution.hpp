/// Evolution of one pin from mode to mode: closed form or series → earliest event → next mode.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/events/mode_flow.hpp"
#include "pindrive/events/series_segment.hpp"
#include "pindrive/flow/flow.hpp"
#include "pindrive/law/contact_point.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/law/oblique.hpp"
#include "pindrive/law/pin.hpp"
#include "pindrive/law/selection.hpp"
#include "pindrive/model/input_period.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Pin between two events, and the operations that lead from one event to the next: select a mode,
/// begin its segment, find the earliest event, jump to it.
template <class T>
class Evolution {
 public:
  /// Release at a time, s, before the first mode is selected.
  Evolution(const Drive<T>& drive, const Inputs<T>& inputs, T begin)
      : pin(drive, begin, inputs.displacement, inputs.velocity),
        inputs_(inputs),
        plain_(drive.mass, drive.damping, drive.stiffness),
        half_period_(plain_.zeros(T(0), T(1)).first),
        half_turn_(plain_.oscillates() ? plain_.half_turn() : Propagator<T>{}) {
    if (!inputs.straight()) repetition_ = period_of(inputs);
    look_ahead();
    const bool given = !isnan(inputs.skin_stretch);
    if (given) pin.state.skin = drive.finger.stiffness * inputs.skin_stretch;
    pin.stop.initialize(pin.state);
    if (given && drive.finger.damped()) pin.state.skin += drive.finger.damping * pin.state.v;
    pin.plate.initialize(pin.state, false);
    pin.finger.initialize(pin.state, given);
  }
  Evolution(const Evolution&) = delete;
  Evolution& operator=(const Evolution&) = delete;

  /// Selects the mode that follows; false if no mode is consistent.
  bool select() {
    next_breakpoint = defer_first_grip(pin.finger, pin.state.v, pin.time, next_breakpoint);
    const bool consistent = Selection<T>(pin, selected).select();
    pin.finger.apply_jump(pin.state);
    return consistent;
  }

  /// Begins the segment of the selected mode, with its guards.
  void begin(Segment<T>& segment) {
    if (pin.plate.oblique())
      pin.plate.across =
          InputCurves<T>::across_from(inputs_, pin.time, pin.plate.surface, pin.held());
    const Force<T> plate = pin.plate.force_law(pin.state), finger = pin.finger.force_law(pin.state);
    segment.begin = pin.time;
    segment.end = never;
    segment.mode = pin.mode();
    segment.event = {};
    segment.moved = {};
    segment.plate_velocity = pin.plate.surface;
    segment.eliminated = EliminatedPart::none;
    segment.driven = false;
    segment.slider_velocity = T(0);
    series.reset();
    if (!SeriesMode<T>::closed_form(
            pin.drive, segment.mode,
            {pin.plate.surface, pin.plate.load, pin.plate.across, pin.force, pin.finger.load})) {
      if (in_equilibrium()) return stay(segment, plate, finger);
      series.begin(segment, selected.guards, pin.drive, pin.plate, pin.finger, pin.force, pin.state,
                   selected.acceleration, pin.stays_at_limit() ? pin.stick_limit_side : 0,
                   pin.no_push(), std::min(until_breakpoint(), inputs_.duration - pin.time),
                   repetition_.repeats() ? repetition_.period / driven_in_period : never);
      return;
    }
    segment.flow = mode_flow(pin, selected, plain_, plate, finger);
    segment.plate_force = plate.along(segment.flow);
    segment.finger_force = finger.along(segment.flow);
    if (pin.plate.stuck() && !pin.stop.is_holding())
      segment.plate_force = selected.stick_force;
    else if (pin.finger.stuck() && !pin.stop.is_holding())
      segment.finger_force = selected.stick_force;
    selected.guards.add(pin.finger, segment, false);
    selected.guards.add(pin.plate, segment, true);
    if (!pin.stop.is_holding()) pin.stop.add_guards(selected.guards, pin.state, segment.flow);
  }

  /// Transitions from the mode before to the selected one.
  Event transitions(const Mode& before) const {
    const Mode after = pin.mode();
    Event event{change(before.plate, after.plate), change(before.finger, after.finger),
                change(before.stop, after.stop, struck)};
    if (pin.finger.start.shortens_skin) event.finger = Transition::slip;
    return event;
  }

  /// Time to the next turning point of a pin over a plate that slides across, or under a friction law that is not linear,
  /// with constant inputs; infinite elsewhere. Such a pin may oscillate without events, and a cycle is detected at the
  /// turning points.
  T turning_point() const {
    const bool turns =
        pin.plate.oblique() || !pin.drive.plate.linear() || !pin.drive.finger.linear();
    return series.used() && turns && !pin.held() && has_constant_inputs() ? series.turning_point()
                                                                          : never;
  }
  /// Time after τ, s, with the rounding of earlier sums.
  T time_after(T tau) const { return pin.time + (tau + time_error); }
  /// Time to the next breakpoint of an input, s.
  T until_breakpoint() const { return next_breakpoint - pin.time - time_error; }

  /// Time to the earliest event. An event within the time resolution of a breakpoint happens at the
  /// breakpoint.
  T earliest(const Flow<T>& flow) {
    const T breakpoint = until_breakpoint();
    if (series.used()) return series.earliest(pin.time, breakpoint);
    const T serves = flow.oscillator.serves_for();
    const T limit = serves < breakpoint && flow.velocity.oscillates() ? serves : breakpoint;
    const T end = selected.guards.first_event(flow.oscillator, pin.time, limit, limit == breakpoint,
                                              pin.state.force_error);
    return breakpoint < never && breakpoint - end <= rounding<T> * (pin.time + breakpoint)
               ? breakpoint
               : end;
  }

  /// Ends a segment and advances the state to the event: each guard at its zero is exactly zero
  /// there.
  void jump(Segment<T>& segment, T tau) {
    // rounding: tests/hard/two-events-within-the-time-resolution.txt
    const T coincident = tau + rounding<T> * (pin.time + tau);
    const bool breakpoint = tau == until_breakpoint();
    const T end = breakpoint ? next_breakpoint : time_after(tau);
    time_error = breakpoint ? T(0) : tau + time_error - (end - pin.time);
    const T lasts = pin.finger.is_sensitive_to_time() && end > pin.time ? end - pin.time : tau;
    series.move(pin.state, pin.drive, pin.finger, lasts);
    if (!series.used()) {
      const bool turns =
          tau == half_period_ && segment.flow.velocity.value == 0 && has_plain_flow(pin);
      segment.moved = turns ? half_turn_ : segment.flow.after(tau);
      pin.state.move(segment, pin.finger.elastic());
    }
    segment.end = pin.time = end;
    const T across = pin.plate.across.at(tau),
            stationary = pin.finger.sliding() ? pin.finger.stationary_velocity() : T(0);
    const T loaded = load_before(pin.finger.load.at(lasts), pin.finger.load.rate);
    pin.stick_limit_side = 0;
    pin.neglected_force = T(0);
    struck = false;
    if (breakpoint) come_to_rest();
    const T arrives = pin.state.v;
    bool on_plate = pin.plate.stuck(), on_finger = pin.finger.stuck() || pin.stop.is_holding(),
         known = on_finger;
    T rest{0};  // velocity at the finger or at an end of its branch, if known
    for (const Guard<T>& guard : selected.guards) {
      if (!(guard.zero <= coincident) || apply_stop_guard(guard, breakpoint)) continue;
      ContactPoint<T>& side = guard.plate ? pin.plate : pin.finger;
      if (guard.bound != ActiveGuard::none) {
        side.reached_guard = guard.bound;
        if (side.oblique()) continue;
        const T speed = guard.bound == ActiveGuard::lower ? side.branch().from : side.branch().to;
        if (side.has_slider_state()) {
          pin.state.slider_velocity = side.mode.slip_sign * speed;
          continue;
        }
        pin.state.v = (guard.plate ? side.surface.value : stationary) + side.mode.slip_sign * speed;
        if (guard.bound == ActiveGuard::lower && side.mode.branch == 0)
          (guard.plate ? on_plate : on_finger) = true;
        known = known || !guard.plate;
        if (!guard.plate) rest = pin.state.v;
      } else if (side.elastic()) {
        pin.state.skin = guard.side * pin.drive.finger.static_limit * loaded;
      } else if (!breakpoint) {
        pin.stick_limit_side = guard.side;
      }
    }
    if (on_plate && known) pin.plate.surface.value = rest;
    if (on_finger || on_plate) pin.state.v = on_finger ? rest : pin.plate.surface.value;
    if (pin.finger.sliding() && !pin.drive.finger.rigid())
      pin.state.skin = pin.finger.skin_force(pin.state, loaded);
    end_oblique_slip(pin.state, pin.plate, on_finger, across, pin.drive.mass, pin.time);
    if (pin.stop.snap(pin.state) || struck) begin_at_stop(arrives);
  }

  /// Sets the contacts of a pin that has struck a rigid stop at a velocity.
  void begin_at_stop(const T& arrives) {
    struck = true;
    pin.state.v = T(0);
    if (pin.drive.finger.damped()) pin.state.skin -= pin.drive.finger.damping * arrives;
    for (ContactPoint<T>* side : {&pin.plate, &pin.finger}) {
      side->reached_guard = ActiveGuard::none;
      if (side->has_slider_state()) continue;
      side->mode = {};
      side->initialize(pin.state, side == &pin.finger);
    }
    pin.stick_limit_side = 0;
  }

  Pin<T> pin;
  SelectedMotion<T> selected;
  SeriesSegment<T> series;
  T time_error{0};  ///< rounding error of the time of the pin (Kahan 1965), s
  /// True if the pin is at the begin of a period of the inputs.
  bool begins_period() const { return begins_period_; }
  /// State exactly at the begin of the period of the inputs, whose time is rounded.
  State<T> state_at_begin_of_period() const {
    State<T> exact = pin.state;
    const Real<T> time = plain(pin.time), period = plain(repetition_.period);
    // A product of half the digits of the period is exact, and so is its difference from the time.
    const Real<T> count(periods_ - 1), half(static_cast<float>(period));
    const Real<T> late = time - count * half - plain(repetition_.since) - count * (period - half);
    exact.x -= late * exact.v;
    if (!pin.held()) exact.v -= late * selected.acceleration;
    return exact;
  }
  /// True if no input changes from now on.
  bool has_constant_inputs() const {
    return !(next_breakpoint < never) && pin.plate.surface.steady() && pin.plate.across.steady() &&
           pin.force.steady() && pin.plate.load.steady() && pin.finger.load.steady();
  }

  /// True if no load of a contact falls: a function that falls for ever would become negative.
  bool has_lasting_loads() const {
    const auto lasts = [](const ContactPoint<T>& side) {
      return !side.contact.present() || !(side.load.rate < 0);
    };
    return lasts(pin.plate) && lasts(pin.finger);
  }

  T next_breakpoint{never};  ///< time of the next breakpoint of an input, s
  bool struck{false};        ///< the pin has just struck a rigid stop

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();
  /// Least number of segments in a period of the inputs: a cycle is compared at their ends.
  static constexpr int driven_in_period = 8;

  /// Speed below which a pin is at rest, m/s. The scale is the largest term of x, as the position
  /// of rest may be 0.
  T rest_speed() const {
    return T(rest_tolerance) * pin.state.position_scale *
           sqrt(pin.drive.stiffness / pin.drive.mass);
  }
  /// True if a pin that no contact holds is at rest by the rest criterion (MODEL, section 10), for ever: under
  /// constant inputs forces balance and the speed has decayed.
  bool in_equilibrium() const {
    const State<T>& s = pin.state;
    if (!has_constant_inputs() || pin.held()) return false;
    if (pin.finger.has_slider_state() &&
        !(pin.drive.finger.damped() && abs(s.slider_velocity) <= rest_speed()))
      return false;
    // Slow by strong damping is not at rest.
    const T damping =
        pin.drive.damping - pin.plate.force_by_speed(s.v) - pin.finger.force_by_speed(s.v);
    const T net = pin.drive.mass * abs(selected.acceleration) + abs(damping * s.v);
    return abs(s.v) <= rest_speed() &&
           net <= T(rest_tolerance) * pin.drive.stiffness * s.position_scale;
  }
  /// Begins the segment of a pin in equilibrium.
  void stay(Segment<T>& segment, const Force<T>& plate, const Force<T>& finger) {
    selected.guards.clear();
    pin.state.v = pin.state.slider_velocity = T(0);
    segment.eliminated = EliminatedPart::motion;
    segment.flow = Flow<T>::stuck(pin.state.x, Line<T>{});
    segment.plate_force = plate.along(segment.flow);
    segment.finger_force = finger.along(segment.flow);
  }

  /// Applies the rest criterion (MODEL, section 10) where an input changes: a pin that slides so slowly on a
  /// rigid surface at rest is at rest, and its friction may hold it; so is a slider of damped skin under such a pin.
  void come_to_rest() {
    State<T>& s = pin.state;
    if (!(abs(s.v) <= rest_speed())) return;
    for (ContactPoint<T>* side : {&pin.plate, &pin.finger}) {
      if (!side->sliding() || side->oblique()) continue;
      T& speed = side->contact.rigid() ? s.v : s.slider_velocity;
      if (!side->contact.rigid() && !side->contact.damped()) continue;
      if (!side->surface.is_zero() || speed == 0 || !(abs(speed) <= rest_speed())) continue;
      speed = T(0);
      pin.neglected_force = T(rest_tolerance) * pin.drive.stiffness * s.position_scale;
      side->reached_guard = ActiveGuard::lower;
    }
  }

  /// True if a guard belongs to a stop; the stop is then exactly at the zero of the guard.
  bool apply_stop_guard(const Guard<T>& guard, bool breakpoint) {
    if (guard.bound == ActiveGuard::push) pin.stop.released = !breakpoint || !pin.stop.is_holding();
    if (guard.bound != ActiveGuard::edge) return guard.bound == ActiveGuard::push;
    if (pin.stop.reach_end(pin.state, guard.side)) struck = true;
    return true;
  }
  /// Reads the inputs from here on. Returns the finger load until now, which continued to `value`
  /// at `rate`, if the load jumps; the present load if the difference is within the time
  /// resolution.
  T load_before(T value, T rate) {
    if (inputs_.constant())
      pin.plate.surface = inputs_.mouse_velocity.from(pin.time);
    else
      look_ahead();
    // rounding: tests/hard/load-step-from-zero-with-skin-at-rest.txt
    const T now = pin.finger.load.value,
            error = rounding<T> * (abs(value) + 2 * abs(rate) * pin.time);
    if (abs(value - now) > error) return abs(value) > error ? value : T(0);
    if (!series.has_eliminated_slider()) keep_force(pin.finger, pin.state, value);
    return now;
  }
  /// Reads the inputs from here on from their breakpoints: continued from event to event they would
  /// accumulate rounding. Breakpoints within the time resolution are one, the last of them.
  void look_ahead() {
    for (;; pin.time = next_breakpoint) {
      pin.plate.surface = inputs_.mouse_velocity.from(pin.time);
      pin.plate.load = inputs_.plate_load.from(pin.time);
      pin.finger.load = inputs_.finger_load.from(pin.time);
      pin.force = inputs_.force.from(pin.time);
      InputCurves<T>::stop_at_rest(pin.plate.surface, inputs_.across_velocity.from(pin.time),
                                   pin.time);
      pin.plate.across =
          InputCurves<T>::across_from(inputs_, pin.time, pin.plate.surface, pin.held());
      next_breakpoint = std::min(inputs_.next_breakpoint(pin.time), next_period());
      // rounding: tests/hard/load-steps-separated-by-rounding.txt
      if (next_breakpoint - pin.time > rounding<T> * pin.time) return;
    }
  }

  /// Begin of the next period of the inputs, s.
  T next_period() {
    begins_period_ = false;
    if (!repetition_.repeats() || pin.time < repetition_.since) return never;
    const auto begin = [&] { return repetition_.since + T(periods_) * repetition_.period; };
    for (; begin() - pin.time <= rounding<T> * pin.time; ++periods_) begins_period_ = true;
    return begin();
  }

  const Inputs<T>& inputs_;
  InputPeriod<T> repetition_;
  long long periods_{0};  ///< periods of the inputs that have begun
  bool begins_period_{false};
  Oscillator<T> plain_;      ///< oscillator of a pin on which contacts exert constant forces only
  T half_period_;            ///< time between two zeros of its velocity, s
  Propagator<T> half_turn_;  ///< propagator over this time
};

}  // namespace pindrive::detail
