/// Number with a bound of its rounding error, which follows every operation.
#pragma once

#include <cmath>

#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Value within a radius of the true one. Factors and divisors are exact.
template <class T>
struct Uncertain {
  using Real = detail::Real<T>;

  T value{0};
  Real radius{0};

  Uncertain() = default;
  Uncertain(const T& exact) : value(exact) {}  // NOLINT: an exact number is a number
  Uncertain(const T& of, Real within) : value(of), radius(within) {}

  friend Uncertain operator+(const Uncertain& a, const Uncertain& b) {
    return rounded(a.value + b.value, a.radius + b.radius);
  }
  friend Uncertain operator-(const Uncertain& a, const Uncertain& b) {
    return rounded(a.value - b.value, a.radius + b.radius);
  }
  friend Uncertain operator*(const T& factor, const Uncertain& a) {
    using std::abs;
    return rounded(factor * a.value, abs(plain(factor)) * a.radius);
  }
  friend Uncertain operator/(const Uncertain& a, const T& divisor) {
    using std::abs;
    return rounded(a.value / divisor, a.radius / abs(plain(divisor)));
  }
  friend Uncertain operator-(const Uncertain& a) { return {-a.value, a.radius}; }
  Uncertain& operator+=(const Uncertain& b) { return *this = *this + b; }
  Uncertain& operator-=(const Uncertain& b) { return *this = *this - b; }

  /// True if it may be zero.
  bool may_vanish() const {
    using std::abs;
    return abs(plain(value)) <= radius;
  }

 private:
  static Uncertain rounded(const T& result, Real radius) {
    using std::abs;
    return {result, radius + rounding<Real> * abs(plain(result))};
  }
};

/// Widens the error of a number by a count of roundings.
template <class T>
void widen(Uncertain<T>& number, Real<T> roundings) {
  using std::abs;
  number.radius += roundings * rounding<Real<T>> * abs(plain(number.value));
}
template <class T>
void widen(T&, Real<T>) {}

}  // namespace pindrive::detail
