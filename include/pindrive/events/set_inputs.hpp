/// Inputs that are set during a simulation: how they differ from their continuation, and what their
/// jumps do to the pin.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include "pindrive/events/evolution.hpp"
#include "pindrive/events/stepper_state.hpp"
#include "pindrive/law/contact_point.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Load from a time on. A falling load ends at zero, since a contact does not pull.
template <class T>
Held<T> load_from(T now, const Line<T>& given) {
  Held<T> load(now, given);
  if (given.rate < 0) load.ends = now - given.value / given.rate;
  return load;
}

/// Input from a time on, by a line or by a piece that outlives the input.
template <class T>
Held<T> held_from(T now, const Curve<T>& given) {
  return given.straight() ? Held<T>(now, given.line()) : Held<T>(*given.piece);
}

/// Ends a velocity at a horizon at which it reaches zero within rounding
/// (rounding: set_inputs_test).
template <class T>
void end_at(Held<T>& velocity, const T& now, const T& horizon) {
  constexpr T never = std::numeric_limits<T>::infinity();
  const Line<T>& line = velocity.line;
  const T lasts = horizon - velocity.since;
  if (now >= velocity.ends) return;
  const bool ends = horizon < never && line.rate != 0 &&
                    abs(line.at(lasts)) <= rounding<T> * (abs(line.value) + abs(line.rate * lasts));
  velocity.ends = ends ? horizon : never;
}

/// Inputs without an end, whose falling loads stop at zero.
template <class T>
Inputs<T> without_end(Inputs<T> inputs) {
  constexpr T never = std::numeric_limits<T>::infinity();
  inputs.duration = never;
  for (Held<T>* load : {&inputs.plate_load.held(), &inputs.finger_load.held()})
    if (!(load->ends < never) && load->piece == nullptr) *load = load_from(load->since, load->line);
  return inputs;
}

/// Inputs of a state: those that were set, and those of `begun` that are functions of time.
template <class T>
Inputs<T> continued(const StepperState<T>& state, const Inputs<T>& begun) {
  const auto input = [](const Profile<T>& of_release, const Held<T>& set) {
    return of_release.has_breakpoints() ? of_release : Profile<T>(set);
  };
  constexpr T never = std::numeric_limits<T>::infinity();
  return without_end<T>(
      {input(begun.mouse_velocity, state.mouse_velocity), state.pin.x, state.pin.v, never,
       input(begun.plate_load, state.plate_load), std::numeric_limits<T>::quiet_NaN(),
       input(begun.force, state.force), input(begun.across_velocity, state.across_velocity),
       input(begun.finger_load, state.finger_load).to_the(begun.finger_load.power())});
}

/// True if a number and its derivative are zero.
template <class T>
bool is_zero(const T& x) {
  if constexpr (std::is_floating_point_v<T>)
    return x == 0;
  else
    return x.value == 0 && x.slope == 0;
}

/// Difference between an input and its continuation; zero within rounding
/// (rounding: set_inputs_test).
template <class T>
T change_to(const T& given, const Held<T>& held, T now) {
  const Curve<T> line = held.from(now);
  const T change = given - line.value;
  const T size = abs(held.line.value) + abs(line.rate * (now - held.since)) + abs(given);
  const T error = line.straight() ? rounding<T> * size : T(line.rounding());
  return abs(change) <= error ? change - plain(change) : change;
}

/// True if an input differs from its continuation in value or rate. Functions of time cannot be set.
template <class T>
bool differs(const Curve<T>& given, const Profile<T>& input, T now) {
  if (input.has_breakpoints()) return false;
  const Curve<T> continued = input.given_from(now);
  if (!given.straight() || !continued.straight()) return given.piece != continued.piece;
  return !is_zero(change_to(given.value, input.held(), now)) ||
         !is_zero(given.rate - continued.rate);
}

/// Value after a change: the given value, or the value before where only the derivative changes.
template <class T>
T moved(const T& from, const T& change, const T& given) {
  return plain(change) == 0 ? from + change : given;
}

/// Applies a jump of the mouse velocity: the pin keeps its velocity relative to the housing, and so
/// to the plate, whose velocity is `given` afterwards. Only a rigid stop moves the pin along.
template <class T>
void shift(Evolution<T>& evolution, const T& jump, const T& given) {
  ContactPoint<T>&plate = evolution.pin.plate, &finger = evolution.pin.finger;
  auto& stop = evolution.pin.stop;
  T& v = evolution.pin.state.v;
  const T arrives = v;
  plate.surface.value = moved(plate.surface.value, jump, given);
  if (plate.stuck() && !stop.is_holding())
    v = plate.surface.value;
  else if (!(finger.stuck() || stop.is_holding()) || plain(jump) != 0)
    v += jump;
  const T pulls = finger.contact.damping * (v - arrives);
  if (finger.contact.damped()) evolution.pin.state.skin += pulls;
  if (plain(jump) == 0) {
    if (finger.contact.damped() && finger.has_slider_state())
      evolution.pin.state.slider_velocity += finger.slider_change(pulls);
    return;
  }
  evolution.struck = false;
  const T moves = v;
  if (stop.initialize(evolution.pin.state)) return evolution.begin_at_stop(moves);
  finger.reached_guard = ActiveGuard::none;
  const T sign = finger.mode.slip_sign;
  if (finger.sliding() && finger.contact.may_lag()) return;
  if (finger.sliding() && sign * v > 0) {
    finger.mode = {finger.mode.state, ActiveGuard::none, finger.contact.branch_of(abs(v)), sign};
  } else {
    finger.mode = {};
    finger.initialize(evolution.pin.state, true);
  }
}

/// Applies a jump of the transverse velocity, which changes the sliding speed of the plate.
template <class T>
void turn(ContactPoint<T>& plate, const T& v) {
  plate.reached_guard = ActiveGuard::none;
  if (!plate.oblique()) return;
  plate.mode.branch = plate.contact.branch_of(hypot(v - plate.surface.value, plate.across.value));
}

}  // namespace pindrive::detail
