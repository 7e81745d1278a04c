/// The pin at an instant: what is known of it exactly, and what counts as exact there.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Which end of its range a contact is at exactly: of the branch of its friction curve or, an elastic
/// stick at its stick limit, the upper one. Of an end stop: the end of the travel, or no push.
enum class Bound : signed char { none, lower, upper, edge, push };

/// The pin at an instant.
template <class T>
struct State {
  T x, v;         ///< m, m/s
  T skin{0};      ///< force in an elastic stick, N
  T x_size{0};    ///< the largest that the position is a sum of, m
  T roundoff{0};  ///< forces that differ by less are one, N
  T slide{0};     ///< velocity of the slider of a compliant finger on a sloped branch, m/s

  /// Brings it to the end of a segment in closed form.
  void move(const Segment<T>& along, bool elastic) {
    using std::abs;
    const Path<T>& position = along.flow.position;
    const Propagator<T> moved = along.moved;
    x = position.at(moved);
    v = along.flow.velocity.at(moved);
    x_size = std::max(std::max(x_size, abs(x)), std::max(abs(position.value * moved.decline),
                                                         abs(position.slope * moved.gain)));
    if (elastic) skin = -along.finger_force.at(moved);
  }
};

/// Whether a guard at its zero dips below it by no more than its roundoff.
template <class T>
bool touches(T rate, T curvature, T roundoff) {
  return rate < 0 && rate * rate <= 2 * curvature * roundoff;
}

/// Whether what has come to zero stays there to its roundoff: by what it would fall at the rate that it has
/// there, and by its value at the end.
template <class T>
bool stays_at_bound(T fall, T value, T roundoff) {
  using std::abs;
  return fall >= -2 * roundoff && abs(value) <= roundoff;
}

}  // namespace pindrive::detail
