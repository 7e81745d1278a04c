/// Proof that a quantity of a mode does not become negative, without its roots.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/flow/flow.hpp"

namespace pindrive::detail {

/// Quantity that must stay positive along a mode: distance of a speed from the end of its branch,
/// margin to the stick limit.
template <class T>
class PositivityBound {
 public:
  PositivityBound() = default;
  PositivityBound(const Oscillator<T>& oscillator, const Path<T>& path)
      : path_(path), rate_(path.derivative(oscillator)) {}

  /// Value and slope at a time.
  struct Sample {
    T tau, value, slope;
  };
  Sample at(const Propagator<T>& moved) const {
    return {moved.tau, path_.at(moved), rate_.at(moved)};
  }

  /// Bounds of the third and fourth derivative.
  struct Flatness {
    T third{0}, fourth{0};
  };
  /// Bounds over a length from a time on. Both derivatives are free oscillations, and a free
  /// oscillation y stays below (|y| + |y'| min(τ, 1/ω₀)) e^(2ατ), without the growth where α <= 0:
  /// its energy (y'² + ω₀² y²)/2 changes by 2α y'². Where two real rates lie far apart, each
  /// exponential is bounded separately, as rounding of their sum would be amplified by the fast
  /// one.
  Flatness flatness(const Oscillator<T>& oscillator, const Propagator<T>& moved, T from,
                    T length) const {
    if (!path_.oscillates()) return {};
    if (!oscillator.oscillates() && 2 * oscillator.omega() > abs(oscillator.alpha())) {
      const T one = oscillator.slowest_rate(), other = oscillator.omega0_squared() / one;
      Flatness found;
      const auto add = [&](T rate, T wave) {
        const T largest = abs(wave) * exp(rate * (rate < 0 ? from : from + length));
        found.third += abs(rate * rate * rate) * largest;
        found.fourth += abs(rate * rate * rate * rate) * largest;
      };
      add(one, (path_.slope - other * path_.value) / (one - other));
      add(other, (path_.slope - one * path_.value) / (other - one));
      return found;
    }
    const T bend = oscillator.bend(path_.value, path_.slope);
    const T y = path_.value + path_.value * moved.decline + path_.slope * moved.gain;
    const T y1 = path_.slope + path_.slope * moved.decline + bend * moved.gain;
    const T y2 = oscillator.bend(y, y1), y3 = oscillator.bend(y1, y2);
    const T y4 = oscillator.bend(y2, y3), y5 = oscillator.bend(y3, y4);
    const T reach = std::min(length, 1 / sqrt(oscillator.omega0_squared()));
    const T growth = oscillator.alpha() > 0 ? exp(2 * oscillator.alpha() * length) : T(1);
    return {(abs(y3) + abs(y4) * reach) * growth, (abs(y4) + abs(y5) * reach) * growth};
  }

  /// Lowest value found between two times, or at either. The true minimum is no lower below zero
  /// than this value or `unseen`. Proven if the quantity is monotone, or if the cubic through both
  /// ends (by its Bernstein coefficients) minus the interpolation error is above; else bisected.
  /// After the last bisection that bound is returned.
  T lowest(const Oscillator<T>& oscillator, const Sample& a, const Sample& b,
           const Flatness& flatness, T unseen) const {
    int halvings = most_halvings;
    return lowest(oscillator, a, b, flatness, unseen, halvings);
  }

 private:
  static constexpr int most_halvings = 4096;
  static constexpr T never = std::numeric_limits<T>::infinity();

  T lowest(const Oscillator<T>& oscillator, const Sample& a, const Sample& b,
           const Flatness& flatness, T unseen, int& halvings) const {
    const T least = std::min(a.value, b.value), h = b.tau - a.tau;
    if (!(least >= -unseen)) return least;
    const T turn = h * h / 8 * flatness.third;
    if ((a.slope >= turn && b.slope >= turn) || (a.slope <= -turn && b.slope <= -turn))
      return least;
    const T cubic = std::min({least, a.value + h * a.slope / 3, b.value - h * b.slope / 3});
    const T bound = cubic - h * h * h * h / 384 * flatness.fourth;
    if (bound >= -unseen) return least;
    const T tau = a.tau + h / 2;
    if (--halvings < 0 || !(tau > a.tau && tau < b.tau) || !(bound > -never))
      return bound > -never ? bound : -never;
    const Sample middle =
        at(path_.oscillates() ? oscillator.after(tau) : Propagator<T>::still(tau));
    return std::min(lowest(oscillator, a, middle, flatness, unseen, halvings),
                    lowest(oscillator, middle, b, flatness, unseen, halvings));
  }

  Path<T> path_{}, rate_{};
};

}  // namespace pindrive::detail
