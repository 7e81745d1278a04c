/// Dual number: a number with its derivative along one parameter. The core evaluated with dual
/// numbers gives exact derivatives through events, without steps or differences.
///
/// Comparisons use the value alone, so the motion takes the events of the plain numbers. The caller
/// is responsible for results that hold only for this sequence of events.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include "pindrive/numbers/functions.hpp"

namespace pindrive {

template <class T>
struct Dual {
  T value{0};
  T slope{0};  ///< derivative of the value along the parameter

  constexpr Dual() = default;
  template <class N, class = std::enable_if_t<std::is_arithmetic_v<N>>>
  constexpr Dual(N number) : value(static_cast<T>(number)) {}  // NOLINT: a constant is a number
  constexpr Dual(T number, T derivative) : value(number), slope(derivative) {}

  friend constexpr Dual operator-(Dual a) { return {-a.value, -a.slope}; }
  friend constexpr Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
  friend constexpr Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.slope - b.slope}; }
  friend constexpr Dual operator*(Dual a, Dual b) {
    return {a.value * b.value, times(a.slope, b.value) + times(b.slope, a.value)};
  }
  friend constexpr Dual operator/(Dual a, Dual b) {
    const T quotient = a.value / b.value;
    return {quotient, times(a.slope - times(b.slope, quotient), 1 / b.value)};
  }
  Dual& operator+=(Dual b) { return *this = *this + b; }
  Dual& operator-=(Dual b) { return *this = *this - b; }
  Dual& operator*=(Dual b) { return *this = *this * b; }
  Dual& operator/=(Dual b) { return *this = *this / b; }

  friend constexpr bool operator==(Dual a, Dual b) { return a.value == b.value; }
  friend constexpr bool operator!=(Dual a, Dual b) { return a.value != b.value; }
  friend constexpr bool operator<(Dual a, Dual b) { return a.value < b.value; }
  friend constexpr bool operator>(Dual a, Dual b) { return a.value > b.value; }
  friend constexpr bool operator<=(Dual a, Dual b) { return a.value <= b.value; }
  friend constexpr bool operator>=(Dual a, Dual b) { return a.value >= b.value; }

  friend constexpr T plain(Dual a) { return a.value; }
  friend constexpr bool vanishes(Dual a) { return a.value == 0 && a.slope == 0; }
  friend bool isfinite(Dual a) { return std::isfinite(a.value); }
  friend bool isnan(Dual a) { return std::isnan(a.value); }
  friend Dual floor(Dual a) { return std::floor(a.value); }
  friend Dual abs(Dual a) { return std::signbit(a.value) ? -a : a; }

  friend Dual sqrt(Dual a) {
    const T root = std::sqrt(a.value);
    return {root, times(a.slope, 1 / (2 * root))};
  }
  friend Dual hypot(Dual a, Dual b) {
    const T length = detail::hypot(a.value, b.value);
    return {length, times(a.slope, a.value / length) + times(b.slope, b.value / length)};
  }
  friend Dual exp(Dual a) {
    const T power = detail::exp(a.value);
    return {power, times(a.slope, power)};
  }
  friend Dual expm1(Dual a) {
    return {detail::expm1(a.value), times(a.slope, detail::exp(a.value))};
  }
  friend Dual log(Dual a) { return {detail::log(a.value), times(a.slope, 1 / a.value)}; }
  friend Dual log1p(Dual a) { return {detail::log1p(a.value), times(a.slope, 1 / (1 + a.value))}; }
  friend detail::Circular<Dual> sine_and_cosine_of(Dual a) {
    const auto [sine, cosine] = detail::sine_and_cosine_of(a.value);
    return {{sine, times(a.slope, cosine)}, {cosine, times(a.slope, -sine)}};
  }
  friend Dual sin(Dual a) { return sine_and_cosine_of(a).sine; }
  friend Dual cos(Dual a) { return sine_and_cosine_of(a).cosine; }
  friend Dual atan2(Dual y, Dual x) {
    const T square = x.value * x.value + y.value * y.value;
    return {detail::atan2(y.value, x.value),
            times(y.slope, x.value / square) - times(x.slope, y.value / square)};
  }

 private:
  /// Product with zero slope preserved, even for an infinite factor.
  static constexpr T times(T slope, T factor) { return slope == 0 ? T(0) : slope * factor; }
};

}  // namespace pindrive

namespace std {

template <class T>
struct numeric_limits<pindrive::Dual<T>> : numeric_limits<T> {
  static constexpr pindrive::Dual<T> infinity() noexcept { return numeric_limits<T>::infinity(); }
  static constexpr pindrive::Dual<T> quiet_NaN() noexcept { return numeric_limits<T>::quiet_NaN(); }
  static constexpr pindrive::Dual<T> epsilon() noexcept { return numeric_limits<T>::epsilon(); }
};

}  // namespace std
