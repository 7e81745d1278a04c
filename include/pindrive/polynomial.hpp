/// A quantity along a step as a polynomial, and its first zero with certainty: by its Bernstein
/// coefficients, which enclose it. Nothing is sampled and nothing can be stepped over.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "pindrive/flow.hpp"
#include "pindrive/model.hpp"

namespace pindrive {

/// The highest order of a series. A step is then about a fifth of the radius of convergence.
inline constexpr int series_order = 24;

namespace detail {

/// A number as it is compared, and how many numbers a scalar consists of (a Dual: two).
template <class T>
using Real = decltype(plain(T{}));
template <class T>
constexpr int parts_of() {
  if constexpr (std::is_class_v<T>)
    return T::parts;
  else
    return 1;
}
template <class T>
Real<T> part(T x, int index) {
  if constexpr (std::is_class_v<T>)
    return index == 0 ? x.value : x.slope;
  else
    return x;
}

}  // namespace detail

/// A quantity along a step: c₀ + c₁ σ + … of σ = τ/span, 0 <= σ <= 1.
template <class T>
struct Polynomial {
  using Real = detail::Real<T>;

  std::array<T, series_order + 2> c{};
  int degree{0};
  Real span{1};  ///< s

  /// Its value τ after the step began.
  T at(T tau) const {
    const T s = tau / span;
    T sum = c[degree];
    for (int n = degree; n-- > 0;) sum = sum * s + c[n];
    return sum;
  }
  /// Its rate, per second.
  Polynomial derivative() const {
    Polynomial rate;
    rate.span = span;
    rate.degree = std::max(degree - 1, 0);
    for (int n = 0; n < degree; ++n) rate.c[n] = c[n + 1] * (n + 1) / span;
    return rate;
  }

  Polynomial& operator+=(const Polynomial& other) {
    degree = std::max(degree, other.degree);
    for (int n = 0; n <= other.degree; ++n) c[n] += other.c[n];
    return *this;
  }
  Polynomial& operator+=(const Line<T>& line) {
    degree = std::max(degree, 1);
    c[0] += line.value;
    c[1] += line.rate * span;
    return *this;
  }
  friend Polynomial operator*(T factor, Polynomial p) {
    for (int n = 0; n <= p.degree; ++n) p.c[n] *= factor;
    return p;
  }
};

namespace detail {

/// Where a polynomial on [0, 1] first becomes negative, by its Bernstein coefficients, which enclose its
/// values: nowhere while none is, once where they change sign once; else the interval is halved.
template <class Real>
class FirstZero {
 public:
  using Coefficients = std::array<Real, series_order + 2>;
  static constexpr Real never = std::numeric_limits<Real>::infinity();

  /// The powers' coefficients of a polynomial.
  FirstZero(const Coefficients& powers, int degree) : powers_(powers), degree_(degree) {}

  Real find() const {
    Real rest{0};
    for (int n = 1; n <= degree_; ++n) rest += std::abs(powers_[n]);
    if (powers_[0] > rest) return never;
    Coefficients b{};
    for (int i = 0; i <= degree_; ++i) {
      Real ratio{1};  // of binomials: (i over j) / (degree over j)
      for (int j = 0; j <= i; ++j) {
        b[i] += ratio * powers_[j];
        ratio *= Real(i - j) / Real(degree_ - j);
      }
    }
    Real left{0};
    return search(b, Real(0), Real(1), left);
  }

 private:
  static constexpr Real narrowest = 4 * std::numeric_limits<Real>::epsilon();

  Real value(Real s) const {
    Real sum = powers_[degree_];
    for (int n = degree_; n-- > 0;) sum = sum * s + powers_[n];
    return sum;
  }

  /// In [low, low + width]; the polynomial is not negative at `left`, the last place where that is known.
  Real search(const Coefficients& b, Real low, Real width, Real& left) const {
    int changes = 0;
    for (int i = 0; i < degree_; ++i) changes += (b[i] < 0) != (b[i + 1] < 0);
    if (changes == 0 && !(b[0] < 0)) {
      left = low + width;
      return never;
    }
    if (b[0] < 0) return left < low ? root(left, low) : low;
    if (changes == 1 || width <= narrowest * (low + width))
      return b[degree_] < 0 ? root(low, low + width) : never;  // else a touch, to rounding
    Coefficients lower{}, upper = b;                           // de Casteljau
    for (int k = 0; k <= degree_; ++k) {
      lower[k] = upper[0];
      for (int i = 0; i < degree_ - k; ++i) upper[i] = (upper[i] + upper[i + 1]) / 2;
    }
    const Real half = width / 2, found = search(lower, low, half, left);
    return found < never ? found : search(upper, low + half, half, left);
  }

  /// The zero in a bracket, negative at `high` alone: Newton's iteration, kept inside.
  Real root(Real low, Real high) const {
    Real s = low + (high - low) / 2;
    for (int tries = 0; tries < 200 && low < s && s < high; ++tries) {
      Real sum = powers_[degree_], rate{0};
      for (int n = degree_; n-- > 0;) {
        rate = rate * s + sum;
        sum = sum * s + powers_[n];
      }
      if (sum == 0) return s;
      (sum < 0 ? high : low) = s;
      const Real newton = s - sum / rate;
      const bool inside = newton > low && newton < high && tries % 4 != 3;
      const Real next = inside ? newton : low + (high - low) / 2;
      if (std::abs(next - s) <= std::numeric_limits<Real>::epsilon() * s) return next;
      s = next;
    }
    return s;
  }

  Coefficients powers_;
  int degree_;
};

}  // namespace detail

/// The earliest τ in (0, span] at which a guard becomes negative; infinity if there is none. A guard
/// that is zero at τ = 0, or that rounding has put below, leaves that zero to its positive side, which
/// the mode has chosen; so does one whose rate is then zero or below.
template <class T>
T first_zero(const Polynomial<T>& guard) {
  using Real = detail::Real<T>;
  std::array<Real, series_order + 2> powers{};
  int zeros = 0;
  while (zeros <= guard.degree && zeros < 2 && !(plain(guard.c[zeros]) > 0)) ++zeros;
  while (zeros <= guard.degree && plain(guard.c[zeros]) == 0) ++zeros;
  if (zeros > guard.degree) return std::numeric_limits<T>::infinity();
  for (int n = zeros; n <= guard.degree; ++n) powers[n - zeros] = plain(guard.c[n]);
  const Real s = detail::FirstZero<Real>(powers, guard.degree - zeros).find();
  if (!(s <= 1)) return std::numeric_limits<T>::infinity();
  // A zero moves so that the guard stays zero; of plain numbers there is nothing to say.
  const T root = s * guard.span, value = guard.at(root);
  const Real rate = plain(guard.derivative().at(root));
  return rate == 0 ? root : root - (value - plain(value)) / rate;
}

}  // namespace pindrive
