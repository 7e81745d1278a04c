/// Period of inputs that repeat.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

/// Inputs after their last breakpoint: constant, periodic, or neither.
template <class T>
struct InputPeriod {
  T since{0};  ///< time of the last breakpoint, s; 0 without breakpoints
  /// s; infinite if the inputs are constant or do not repeat
  T period{std::numeric_limits<T>::infinity()};
  bool constant{true};

  bool repeats() const { return period < std::numeric_limits<T>::infinity(); }
};

namespace detail {

/// Largest number of periods of the slowest sinusoid in a common period.
inline constexpr int most_periods = 64;

/// Sinusoids of the last pieces of inputs.
template <class T>
class Sinusoids {
 public:
  /// Adds those of an input from a time on; false if the input neither repeats nor is constant.
  bool add(const Curve<T>& input) {
    constant_ = constant_ && input.steady();
    if (input.piece == nullptr) return input.rate == 0;
    const InputPiece<T>& piece = *input.piece;
    for (int n = 1; n <= InputPiece<T>::degree; ++n)
      if (piece.polynomial[n] != 0) return false;
    for (std::size_t j = 0; j < piece.count; ++j) {
      const InputTerm<T>& term = piece.terms[j];
      if (term.cosine == 0 && term.sine == 0) continue;
      if (term.decay != 0) return false;
      if (term.frequency == 0) continue;
      if (slowest_ == 0 || term.frequency < slowest_) slowest_ = term.frequency;
    }
    return true;
  }
  bool constant() const { return constant_; }
  T slowest() const { return slowest_; }  ///< rad/s; 0 without any

  /// True if an input repeats after a number of periods of the slowest sinusoid.
  bool repeats(const Curve<T>& input, int periods) const {
    for (std::size_t j = 0; j < input.terms(); ++j) {
      const Real<T> turns = plain(input.piece->terms[j].frequency / slowest_) * periods;
      if (std::abs(turns - std::round(turns)) > 16 * rounding<Real<T>> * turns) return false;
    }
    return true;
  }

 private:
  bool constant_{true};
  T slowest_{0};
};

}  // namespace detail

/// Period of inputs after their last breakpoint.
template <class T>
InputPeriod<T> period_of(const Inputs<T>& inputs) {
  constexpr T never = std::numeric_limits<T>::infinity();
  InputPeriod<T> found;
  for (T next; (next = inputs.next_breakpoint(found.since)) < never;) found.since = next;
  const Curve<T> curves[] = {inputs.mouse_velocity.from(found.since),
                             inputs.plate_load.from(found.since), inputs.force.from(found.since),
                             inputs.across_velocity.from(found.since),
                             inputs.finger_load.from(found.since)};
  detail::Sinusoids<T> sinusoids;
  bool repeats = true;
  for (const Curve<T>& curve : curves) repeats = sinusoids.add(curve) && repeats;
  found.constant = sinusoids.constant();
  if (!repeats || sinusoids.slowest() == 0) return found;
  for (int periods = 1; periods <= detail::most_periods; ++periods) {
    const auto alike = [&](const Curve<T>& curve) { return sinusoids.repeats(curve, periods); };
    if (!std::all_of(std::begin(curves), std::end(curves), alike)) continue;
    found.period = T(periods) * T(6.283185307179586476925286766559L) / sinusoids.slowest();
    break;
  }
  return found;
}

}  // namespace pindrive
