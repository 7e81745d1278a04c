/// Inputs of a mode as Taylor coefficients along a step of its series.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/input_function.hpp"

namespace pindrive::detail {

/// Coefficients of an input in the time σ = τ/step: up to the degree of a polynomial or, with terms, the order of a
/// series.
template <class T>
class InputSeries {
 public:
  using Real = detail::Real<T>;
  static constexpr int N = series_order;

  InputSeries() = default;
  /// A function has the orders up to one at most.
  InputSeries(const Curve<T>& curve, Real step, int order = N + 1) : curve_(curve), step_(step) {
    if (!curve.straight()) {
      degree_ =
          std::min(order, curve.raised || curve.terms() > 0 ? N + 1 : int{InputPiece<T>::degree});
      curve.expand(T(0), T(step), c_, degree_);
    }
    c_[0] = curve.value;
    c_[1] = curve.rate * step;
  }

  T operator[](int n) const { return n <= degree_ ? c_[n] : T(0); }
  int degree() const { return degree_; }
  void rescale(const Powers<Real>& part) {
    step_ *= part[1];
    for (int n = 1; n <= degree_; ++n) c_[n] *= part[n];
  }

  /// Order n of the derivative by time, per second.
  T rate(int n) const {
    if (n == 0) return curve_.rate;
    return n + 1 <= degree_ ? T(n + 1) * c_[n + 1] / step_ : T(0);
  }
  /// Order n of the product with a series, without the orders of the input below the first.
  template <class Coefficients>
  T times(const Coefficients& c, int n, int first = 0) const {
    return sum_of_products(c_, c, n, first, std::min(n, degree_));
  }
  /// Order n of the square.
  T square(int n) const {
    return sum_of_products(c_, c_, n, std::max(0, n - degree_), std::min(n, degree_));
  }
  /// Its coefficients from an order on, without those before, with zeros beyond the highest.
  std::array<T, N + 2> from_order(int first) const {
    std::array<T, N + 2> c{};
    for (int n = first; n <= degree_; ++n) c[n - first] = c_[n];
    return c;
  }
  void negate() {
    curve_.value = -curve_.value;
    curve_.rate = -curve_.rate;
    for (int n = 0; n <= degree_; ++n) c_[n] = -c_[n];
  }

  /// Bound of the absolute value over the step.
  Real most() const {
    using std::abs;
    const Real a = plain(c_[0]), b = plain(c_[1]);
    return degree_ == 1 ? std::max(abs(a), abs(a + b)) : abs(a) + change();
  }
  /// Bound from below over the step.
  Real least() const {
    const Real a = plain(c_[0]);
    return degree_ == 1 ? std::min(a, a + plain(c_[1])) : a - change();
  }
  /// Bound of the distance from its tangent over the step.
  Real bend() const {
    using std::abs;
    Real sum{0};
    for (int n = 2; n <= degree_; ++n) sum += abs(plain(c_[n]));
    return sum;
  }
  /// Bound of the change over the step.
  Real change() const {
    using std::abs;
    Real sum{0};
    for (int n = 1; n <= degree_; ++n) sum += abs(plain(c_[n]));
    return sum;
  }
  /// Bound of the terms from the last order on of the product with a series of known tail sums.
  Real beyond(const Sums<Real>& sums) const {
    using std::abs;
    Real sum = most() * sums[N] + abs(plain(c_[1])) * (sums[N - 1] - sums[N]);
    for (int n = 2; n <= std::min(degree_, N); ++n) sum += abs(plain(c_[n])) * sums[N - n];
    return sum + missed() * sums[0];
  }
  /// Bounds beyond the last order: of the terms of the input, and of the terms of its rate (1/s).
  Real missed() const {
    if (curve_.straight()) return Real(0);
    return curve_.beyond(step_, N);
  }
  Real missed_rate() const { return curve_.fastest() * missed(); }

 private:
  Curve<T> curve_{};
  Real step_{1};
  int degree_{1};
  std::array<T, N + 2> c_;
};

/// Polynomial of an input over a step.
template <class T>
Polynomial<T> polynomial_of(const Curve<T>& curve, Real<T> span) {
  const InputSeries<T> series(curve, span);
  Polynomial<T> p;
  p.span = span;
  p.degree = std::min(series.degree(), series_order);
  for (int n = 0; n <= p.degree; ++n) p.c[n] = series[n];
  return p;
}

}  // namespace pindrive::detail
