/// Elementary functions of the scalar types of the core: for a double from elementary.hpp, so that
/// a motion has identical bits on every system; for a float or long double from the standard
/// library. Further types define their own.
#pragma once

#include <cmath>
#include <utility>

#include "pindrive/numbers/elementary.hpp"

namespace pindrive {

/// Value of a number without its derivative.
inline float plain(float x) { return x; }
inline double plain(double x) { return x; }
inline long double plain(long double x) { return x; }

namespace detail {

// Further functions of a double; those of other scalar types are found beside their type.
using std::abs, std::floor, std::isfinite, std::isnan, std::sqrt;

/// Type of the value of a number.
template <class T>
using Real = decltype(plain(T{}));

#define PINDRIVE_OF_OTHERS(name)                      \
  inline float name(float x) { return std::name(x); } \
  inline long double name(long double x) { return std::name(x); }
#define PINDRIVE_OF_OTHER_PAIRS(name)                             \
  inline float name(float a, float b) { return std::name(a, b); } \
  inline long double name(long double a, long double b) { return std::name(a, b); }

PINDRIVE_OF_OTHERS(exp)
PINDRIVE_OF_OTHERS(expm1)
PINDRIVE_OF_OTHERS(log)
PINDRIVE_OF_OTHERS(log1p)
PINDRIVE_OF_OTHERS(sin)
PINDRIVE_OF_OTHERS(cos)
PINDRIVE_OF_OTHER_PAIRS(atan2)
PINDRIVE_OF_OTHER_PAIRS(hypot)
#undef PINDRIVE_OF_OTHERS
#undef PINDRIVE_OF_OTHER_PAIRS

inline double exp(double x) {
  return std::abs(x) <= 700 ? exponential_in_range(x) : exponential(x);
}
inline double expm1(double x) {
  return std::abs(x) < 50 ? exponential_minus_1_in_range(x) : exp(x) - 1;
}
inline double log(double x) { return logarithm(x); }
inline double log1p(double x) { return logarithm_of_1_plus(x); }
inline double atan2(double y, double x) { return angle_of(y, x); }
inline double hypot(double a, double b) {
  double more = std::abs(a), less = std::abs(b);
  if (more < less) std::swap(more, less);
  if (more == 0 || !std::isfinite(more)) return more;
  const double part = less / more;
  return more * std::sqrt(1 + part * part);
}

/// Sine and cosine of an angle of any size, rad.
template <class T>
Circular<T> sine_and_cosine_of(T angle) {
  return {sin(angle), cos(angle)};
}
inline Circular<double> sine_and_cosine_of(double angle) {
  constexpr double turn = 0x1.921fb54442d18p+2;
  if (std::abs(angle) <= turn) return sine_and_cosine_in_turn(angle);
  // Beyond, neighbouring angles are 6e-8 rad apart: any multiple of nearly a turn may go.
  if (!(std::abs(angle) <= largest_angle)) angle = std::remainder(angle, turn);
  return sine_and_cosine(angle);
}
inline double sin(double angle) { return sine_and_cosine_of(angle).sine; }
inline double cos(double angle) { return sine_and_cosine_of(angle).cosine; }

/// e^x and e^x − 1, each without cancellation.
template <class T>
struct Exponential {
  T value, change;
};
template <class T>
Exponential<T> exponential_and_change(T x) {
  if (abs(x) < T(0.5)) {
    const T change = expm1(x);
    return {1 + change, change};
  }
  const T value = exp(x);
  return {value, value - 1};
}

}  // namespace detail

}  // namespace pindrive
