/// Taylor series of the part of friction that falls with the sliding speed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Falling part φ = excess·g(s) along a step, for a speed r and s = r/velocity, in the time
/// σ = τ/span. With q = s²:
///
///     φ' = −s' φ (exponential),   φ' = −q' φ (gaussian),   (1 + q) φ = excess (rational).
template <class T>
class FallingSeries {
 public:
  using Real = detail::Real<T>;

  const Polynomial<T>& friction() const { return friction_; }  ///< φ, N

  void begin(const FallingFriction<T>& law, Real step) {
    friction_.span = square_.span = step;
    friction_.degree = law.present() ? series_order : 0;
    square_.degree = law.shape == FallingShape::exponential ? 0 : friction_.degree;
  }
  void rescale(const Powers<Real>& part) {
    friction_.rescale(part);
    square_.rescale(part);
  }

  /// Computes order n, from the orders of the speed up to n, and returns it, N.
  template <class Coefficients>
  T extend(const FallingFriction<T>& law, const Coefficients& speed, T sign, int n) {
    auto &phi = friction_.c, &q = square_.c;
    const T scale = sign / law.velocity;
    if (law.shape != FallingShape::exponential) {
      const T ends = n == 0 ? speed[0] * speed[0] : 2 * speed[0] * speed[n];
      q[n] = scale * scale * (ends + inner_square(speed, n));
    }
    if (n == 0) return phi[0] = law.at(sign * speed[0]);
    if (law.shape == FallingShape::rational)
      return phi[n] = -sum_of_products(q, phi, n, 1, n) / (1 + q[0]);
    exponent_rate_[n] = T(n) * (law.shape == FallingShape::gaussian ? q[n] : scale * speed[n]);
    return phi[n] = -sum_of_products(exponent_rate_, phi, n, 1, n) / T(n);
  }

  /// Bounds over a step.
  struct Bounds {
    Sums<Real> friction{};  ///< tail sums of φ, N
    Real slope{0};          ///< largest |dφ/dr|, N s/m
    Real error{0};          ///< largest error of φ, N
  };
  /// Bounds over the step for the tail sums of the speed. The error is from the terms of the equation of φ beyond the
  /// last order, and from the error of the speed (m/s).
  Bounds bounds(const FallingFriction<T>& law, const Sums<Real>& speed, Real of_speed) const {
    const Sums<Real> phi = sums_of(friction_.c);
    const Real slope = steepest(law, speed[0], phi[0]);
    return {phi, slope, unknown(law, speed, phi) + slope * of_speed};
  }

 private:
  /// Bound of |dφ/dr| for the largest speed and the largest φ, N s/m.
  static Real steepest(const FallingFriction<T>& law, Real speed, Real largest) {
    const Real v = plain(law.velocity), excess = plain(law.excess), s = speed / v;
    if (!(excess > 0)) return Real(0);
    const Real phi = std::min(largest, excess);
    if (law.shape == FallingShape::exponential) return phi / v;
    const Real flat = law.shape == FallingShape::gaussian ? Real(1) : phi / excess;
    return std::min(2 * s * phi * flat, excess) / v;  // |g'| < 1
  }
  /// Bound of the error of φ for an exact speed, N.
  Real unknown(const FallingFriction<T>& law, const Sums<Real>& speed,
               const Sums<Real>& phi) const {
    const Real v = plain(law.velocity);
    if (law.shape == FallingShape::exponential)
      return grown(beyond(speed, phi) / v, speed[1] / v) +
             underflow(law, plain(speed[0] - 2 * speed[1]) / v);
    const Sums<Real> q = sums_of(square_.c);
    const Real cut = beyond(speed, speed) / (v * v), residual = beyond(q, phi) + phi[0] * cut;
    if (law.shape == FallingShape::rational) return residual;
    return grown(residual, q[1] + cut) + underflow(law, q[0] - 2 * q[1] - cut);
  }
  static Real grown(Real residual, Real exponent) {
    return residual > 0 ? residual * exp(exponent) : Real(0);
  }
  /// Bound of φ = excess·e^(−p) over a step with p >= `least`, if it underflows at the begin, so that all its orders
  /// are lost, N; else 0.
  Real underflow(const FallingFriction<T>& law, Real least) const {
    constexpr Real smallest = std::numeric_limits<Real>::min() / rounding<Real>;
    const Real excess = plain(law.excess);
    if (!(excess > 0) || abs(plain(friction_.c[0])) > smallest * std::max(excess, Real(1)))
      return Real(0);
    return excess * exp(-std::max(least, Real(0)));
  }

  Polynomial<T> friction_, square_;                  // φ, q
  std::array<T, series_order + 1> exponent_rate_{};  // n p_n of φ = excess·e^(−p)
};

}  // namespace pindrive::detail
