/// Root of a path in a bracket where the path is monotone, and the exact start that a mode implies.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/flow/flow.hpp"
#include "pindrive/numbers/dual.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Derivative of a root; plain numbers have none.
template <class T>
struct Rooted {
  static T at(const Oscillator<T>&, const Path<T>&, T root) { return root; }
};

/// Derivative of a root from its path: dτ = −dG / G'.
template <class T>
struct Rooted<Dual<T>> {
  static Dual<T> at(const Oscillator<Dual<T>>& oscillator, const Path<Dual<T>>& path,
                    Dual<T> root) {
    if (!isfinite(root)) return root;
    const Dual<T> tau = root.value;
    const T slope = path.derivative(oscillator).at(oscillator, tau).value;
    return {root.value, -path.at(oscillator, tau).slope / slope};
  }
};

/// Root in a bracket where the path is monotone, with sign `side` at `low` and not at `high`, by
/// Newton's iteration and, close to the root, Householder's of order 3: the derivatives of a damped
/// sinusoid are cheap beside its value.
template <class T>
T root_between(const Oscillator<T>& oscillator, const Path<T>& path, T low, T high, int side,
               T guess) {
  T tau = guess > low && guess < high ? guess : low + (high - low) / 2;
  T step = high - low, step_before = step;
  for (;;) {
    const Propagator<T> moved = oscillator.after(tau);
    const T value = path.at(moved);
    (side * value > 0 ? low : high) = tau;
    const auto rates = path.rates(oscillator, moved);
    const T newton = value / rates.first;
    const T bend = newton * rates.second / (2 * rates.first);
    const T twist = newton * newton * rates.third / (6 * rates.first);
    const bool near = abs(bend) < T(0.25) && abs(twist) < T(0.25);
    T next = tau - (near ? newton * (1 - bend) / (1 - 2 * bend + twist) : newton);
    if (abs(newton) <= root_error<T> * tau) return next;
    if (near && next > low && next < high) {
      // The error of such a step is of third order in the curvature of the path.
      const T curved =
          std::max({bend * bend, abs(twist), oscillator.hurry_squared() * newton * newton});
      if (8 * curved * sqrt(curved) * abs(newton) <= root_error<T> * tau) return next;
    }
    // Steps that do not shrink creep through rounding: halving the bracket comes to an end.
    const bool creeps = 2 * abs(next - tau) > step_before;
    if (creeps || !(next > low && next < high)) next = low + (high - low) / 2;
    if (next <= low || next >= high) return next;
    step_before = step;
    step = abs(next - tau);
    tau = next;
  }
}
template <class T>
T root_between(const Oscillator<T>& oscillator, const Path<T>& path, T low, T high, int side) {
  return root_between(oscillator, path, low, high, side, low);
}

/// Path with exact zeros as its side implies, with the least change: a slope of the wrong sign is
/// rounding, or the start is and the path turns back within its rounding.
template <class T>
Path<T> exact_at_start(const Oscillator<T>& oscillator, Path<T> path, int side) {
  if (!(side * path.start > 0)) path.start = T(0);
  const T slope = path.slope + path.drift;
  if (path.start != 0 || side * slope > 0) return path;
  const T bend = side * oscillator.bend(path.value, path.slope);
  if (!path.oscillates())
    path.drift = T(0);
  else if (bend > -side * slope * sqrt(oscillator.omega0_squared()))
    path.start = side * slope * slope / bend;  // twice as deep as it dips
  else
    path.slope = -path.drift;
  return path;
}

/// Earliest τ > 0 at which start + drift·τ + curvature·τ²/2 leaves its side.
template <class T>
T parabola_root(Path<T> path, int side) {
  constexpr T never = std::numeric_limits<T>::infinity();
  const T a = side * path.curvature, c = std::max(side * path.start, T(0));
  const T b = c > 0 || side * path.drift > 0 ? side * path.drift : T(0);
  const T square = b * b - 2 * a * c;
  if (a == 0) return b < 0 ? -c / b : never;
  if (!(square > 0)) return never;  // stays, or touches
  const T root = b > 0 ? -(b + sqrt(square)) / a : 2 * c / (sqrt(square) - b);
  return root > 0 ? root : never;
}

}  // namespace pindrive::detail
