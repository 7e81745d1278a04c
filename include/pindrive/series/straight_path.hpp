/// Plate that moves along a straight path, as under the stroke of a hand: its sliding direction under a held pin is
/// constant, also where the plate comes to rest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pindrive/model/input_function.hpp"
#include "pindrive/numbers/dual.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Velocity with the components along and across the axis, m/s or a coefficient of their functions.
template <class T>
struct Slant {
  T along, across;
};

/// True if two velocities are parallel within rounding
/// (rounding: straight_path_test).
template <class T>
bool parallel(const Slant<T>& a, const Slant<T>& b) {
  using std::abs;
  const T one = a.along * b.across, other = a.across * b.along;
  return abs(one - other) <= difference_error<T> * (abs(one) + abs(other));
}
/// True if two velocities are parallel within rounding, with their derivatives.
template <class T>
bool parallel(const Slant<Dual<T>>& a, const Slant<Dual<T>>& b) {
  const auto value = [](const Slant<Dual<T>>& v) {
    return Slant<T>{v.along.value, v.across.value};
  };
  if (!parallel(value(a), value(b))) return false;
  using std::abs;
  const T terms[]{a.along.slope * b.across.value, a.along.value * b.across.slope,
                  -a.across.slope * b.along.value, -a.across.value * b.along.slope};
  T sum{0}, size{0};
  for (const T& each : terms) {
    sum += each;
    size += abs(each);
  }
  return abs(sum) <= difference_error<T> * size;
}

/// Constant direction of a pair of functions: unit vector (cos φ, sin φ), of which along and across are multiples by a
/// common function; zero without a constant direction.
template <class T>
Slant<T> straight_path(const Curve<T>& along, const Curve<T>& across) {
  const Slant<T> none{T(0), T(0)};
  if (along.straight() && vanishes(along.value) && vanishes(along.rate)) return {T(0), T(1)};
  if (along.straight() || across.straight()) return none;
  const InputPiece<T>&a = *along.piece, &b = *across.piece;
  if (a.begin != b.begin || a.count != b.count) return none;
  Slant<T> largest = none;
  bool constant = true;
  const auto each = [&](auto&& visit) {
    for (std::size_t n = 0; n < a.polynomial.size(); ++n) visit(a.polynomial[n], b.polynomial[n]);
    for (std::size_t j = 0; j < a.count; ++j) {
      visit(a.terms[j].cosine, b.terms[j].cosine);
      visit(a.terms[j].sine, b.terms[j].sine);
    }
  };
  each([&](const T& x, const T& y) {
    if (hypot(x, y) > hypot(largest.along, largest.across)) largest = {x, y};
  });
  each([&](const T& x, const T& y) { constant = constant && parallel(Slant<T>{x, y}, largest); });
  for (std::size_t j = 0; j < a.count; ++j)
    constant = constant && a.terms[j].decay == b.terms[j].decay &&
               a.terms[j].frequency == b.terms[j].frequency;
  const T size = hypot(largest.along, largest.across);
  return constant && size > 0 ? Slant<T>{largest.along / size, largest.across / size} : none;
}

}  // namespace pindrive::detail
