/// Closed form of the motion in a mode (docs/theory.md, sections 2 and 9).
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/flow/flow.hpp"
#include "pindrive/law/pin.hpp"
#include "pindrive/law/selection.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// True if contacts and stops add neither damping nor stiffness.
template <class T>
bool has_plain_flow(const Pin<T>& pin) {
  return !pin.finger.elastic() && !pin.stop.is_pushing() && pin.drive.plate.branches == 0 &&
         pin.drive.finger.branches == 0;
}

/// Motion of a pin in its mode, from the forces of its contacts. `plain_oscillator` is that of a pin
/// on which contacts exert constant forces only.
template <class T>
Flow<T> mode_flow(const Pin<T>& pin, const SelectedMotion<T>& selected,
                  const Oscillator<T>& plain_oscillator, const Force<T>& plate,
                  const Force<T>& finger) {
  const State<T>& s = pin.state;
  if (pin.stop.is_holding()) return Flow<T>::stuck(s.x, Line<T>{});
  if (pin.plate.stuck() || pin.finger.stuck())
    return Flow<T>::stuck(s.x, pin.plate.stuck() ? pin.plate.surface.line() : Line<T>{});
  T damping = pin.drive.damping + plate.drag + finger.drag;
  T stiffness = pin.drive.stiffness + plate.stiffness + finger.stiffness;
  T pull = selected.applied_force - pin.drive.stiffness * s.x + plate.constant.value +
           finger.constant.value;
  T rate = plate.constant.rate + finger.constant.rate;
  rate += pin.force.rate;
  damping += pin.stop.damping();
  stiffness += pin.stop.stiffness();
  pull += pin.stop.spring_force(s);
  Oscillator<T> oscillator = plain_oscillator;
  if (!has_plain_flow(pin)) {
    // rounding: damping that falling friction cancels is zero (cancelled_damping_test).
    const T error = rounding<T> / 2 * pin.drive.damping + plate.rounding + finger.rounding;
    if (abs(damping) <= error) damping -= plain(damping);
    oscillator = Oscillator<T>(pin.drive.mass, damping, stiffness);
  }
  // A pin with zero speed and balanced forces, within rounding or the rest criterion, is at rest.
  const T balanced = std::max(s.force_error, T(rest_tolerance) * pin.drive.stiffness * abs(s.x));
  if (abs(pull) <= balanced && s.v == 0 && rate == 0)
    return Flow<T>::free(oscillator, s.x, s.v, T(0), T(0), T(0));
  const T drift = rate / stiffness;
  const T from_rest = selected.tangential
                          ? pin.drive.mass * selected.acceleration + damping * (s.v - drift)
                          : pull - damping * drift;
  return Flow<T>::free(oscillator, s.x, s.v, selected.acceleration, -from_rest / stiffness, drift);
}

}  // namespace pindrive::detail
