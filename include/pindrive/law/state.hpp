/// State of the pin at an instant, with the errors of its parts.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Guard that is exactly zero at an instant.
///
/// `lower`, `upper`: end of the branch of the friction curve; of an elastic stick, `upper` is the
/// stick limit. `edge`: end of the travel. `push`: zero force of an end stop.
enum class ActiveGuard : signed char { none, lower, upper, edge, push };

/// Position and velocity of the pin, and the state of its compliant finger.
template <class T>
struct State {
  T x, v;  ///< position, m; velocity, m/s
  /// Tension of the skin while its slider sticks, N; of skin with damping, in slip too, the tension
  /// that it would have if the slider stuck now: stiffness · stretch + damping · x'.
  T skin{0};
  T position_scale{0};   ///< largest term of the position since the release, m
  T force_error{0};      ///< error bound of a sum of forces, N
  T slider_velocity{0};  ///< slider velocity of a compliant finger that has one, m/s

  /// Advances the state to the end of a segment in closed form.
  void move(const Segment<T>& along, bool elastic) {
    const Path<T>& position = along.flow.position;
    const Propagator<T> moved = along.moved;
    x = position.at(moved);
    v = along.flow.velocity.at(moved);
    position_scale =
        std::max(std::max(position_scale, abs(x)),
                 std::max(abs(position.value * moved.decline), abs(position.slope * moved.gain)));
    if (elastic) skin = -along.finger_force.at(moved);
  }
};

/// True if a guard with zero value falls below zero by at most its error.
template <class T>
bool grazes(T rate, T curvature, T force_error) {
  return rate < 0 && rate * rate <= 2 * curvature * force_error;
}

/// True if a guard stays within its error of zero: by its decrease at the present rate, and by its
/// value at the end.
template <class T>
bool stays_at_bound(T fall, T value, T force_error) {
  return fall >= -2 * force_error && abs(value) <= force_error;
}

}  // namespace pindrive::detail
