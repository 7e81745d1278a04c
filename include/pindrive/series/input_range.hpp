/// Lowest value and jumps of an input, for its checks.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/series_inputs.hpp"

namespace pindrive {

/// Input at a time, s.
struct InputPoint {
  double time, value;
};

/// Jump of an input at a time, s.
struct InputJump {
  double time, before, after;
};

namespace detail {

/// Returns the time since the begin of a piece, s, after which every value exceeds the value at the begin; infinite if
/// the polynomial falls for ever, zero without a polynomial (Cauchy's bound of the roots).
inline double growing_after(const InputPiece<double>& piece) {
  int order = InputPiece<double>::degree;
  while (order > 0 && piece.polynomial[order] == 0) --order;
  const double leading = piece.polynomial[order];
  if (order == 0) return 0;
  if (leading < 0) return std::numeric_limits<double>::infinity();
  double terms{0}, time{0};
  for (std::size_t j = 0; j < piece.count; ++j)
    terms += 2 * (std::abs(piece.terms[j].cosine) + std::abs(piece.terms[j].sine));
  for (int n = 0; n < order; ++n) {
    const double size = n == 0 ? terms : std::max(-piece.polynomial[n], 0.0);
    if (size > 0)
      time = std::max(time, detail::exp(detail::log(order * size / leading) / (order - n)));
  }
  return time;
}

}  // namespace detail

/// Lowest value of a function in [0, until], within rounding of its largest value; of its last piece in the first 64
/// of its slowest time constants, or as long as the piece does not grow for ever.
///
/// Bernstein coefficients of its series enclose the values between two steps.
inline InputPoint lowest_value(const Profile<double>& input, double until) {
  constexpr double never = std::numeric_limits<double>::infinity();
  constexpr int most_steps = 1'000'000;
  InputPoint lowest{0, input.from(0).value};
  double time = 0;
  for (int steps = 0; time < until && steps < most_steps; ++steps) {
    const Curve<double> curve = input.from(time);
    const double breakpoint = std::min(input.next_breakpoint(time), until);
    double end = breakpoint;
    if (!curve.straight()) {
      const double fastest = curve.piece->fastest(), slowest = curve.piece->slowest();
      if (fastest > 0) end = std::min(end, time + detail::longest_input / fastest);
      if (!(breakpoint < never)) {
        const double grows = detail::growing_after(*curve.piece);
        if (!(grows < never)) return {never, -never};
        until = curve.piece->begin + std::max(grows, slowest > 0 ? 64 / slowest : 0);
        end = std::min(end, std::max(until, time));
      }
      if (!(end > time)) break;
    }
    if (!(end < never)) {
      if (curve.rate < 0) lowest = {never, -never};
      break;
    }
    const double span = end - time;
    auto polynomial = detail::polynomial_of(curve, span);
    const double size = detail::largest_size(polynomial);
    for (const double tau : {0.0, span}) {
      const double value = polynomial.at(tau);
      if (value < lowest.value) lowest = {time + tau, value};
    }
    // Lower values within the step, each found where the distance above the last one is negative.
    polynomial.c[0] -= lowest.value;
    const double error = 4 * detail::rounding<double> * size;
    for (;;) {
      const double least = detail::lowest(polynomial, error);
      if (!(least < -error)) break;
      lowest = {time + detail::first_zero(polynomial), lowest.value + least};
      polynomial.c[0] -= least;
    }
    time = end;
  }
  return lowest;
}

/// First jump of a function, beyond rounding; none if `time` is infinite.
inline InputJump first_jump(const Profile<double>& input) {
  constexpr double never = std::numeric_limits<double>::infinity();
  double time = -never;
  for (;;) {
    const double next = input.next_breakpoint(time);
    if (!(next < never)) return {never, 0, 0};
    const Curve<double> curve = time > -never ? input.from(time) : Curve<double>{input.first(), 0};
    const double before = curve.at(next - time), after = input.from(next).value;
    const double size = curve.size(next - time) + std::abs(after);
    const double error = 64 * detail::rounding<double> * size;
    if (std::abs(after - before) > error) return {next, before, after};
    time = next;
  }
}

}  // namespace pindrive
