/// Inputs as piecewise functions of time (MODEL, section 11).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "pindrive/flow/flow.hpp"
#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/inlining.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

/// Term of an input: (cosine·cos Ωτ + sine·sin Ωτ) e^(−δτ).
template <class T>
struct InputTerm {
  T cosine{0}, sine{0};
  T decay{0};      ///< δ, 1/s; >= 0
  T frequency{0};  ///< Ω, rad/s; >= 0
};

namespace detail {

/// Calls visit(n, c, s) with the Taylor coefficients c of a term in the time σ = τ/step, in order, and with the size s of
/// c and its conjugate, until visit returns false.
template <class T, class Step, class Visitor>
void each_coefficient(const InputTerm<T>& term, Step step, int order, Visitor&& visit) {
  // Real part of (cosine − i·sine) e^((iΩ − δ)τ), whose n-th coefficient follows from the last.
  T real = term.cosine, imaginary = -term.sine;
  const T decay = term.decay * step, turn = term.frequency * step;
  for (int n = 0; n <= order; ++n) {
    if (!visit(n, real, std::abs(plain(real)) + std::abs(plain(imaginary)))) return;
    const Real<T> part = Real<T>(1) / Real<T>(n + 1);
    const T turned = -(decay * real + turn * imaginary) * part;
    imaginary = (turn * real - decay * imaginary) * part;
    real = turned;
  }
}

/// Time over which the Taylor terms beyond an order of a term in a sum stay small beside the sum, s: `longest` over the
/// rate of a term as large as the sum; a smaller term reaches farther.
template <class Real>
Real reach_of(Real amplitude, Real rate, Real sum, int order, Real longest) {
  if (!(amplitude > 0) || !(rate > 0)) return std::numeric_limits<Real>::infinity();
  return longest / rate * exp(log(sum / amplitude) / (order + 1));
}

}  // namespace detail

/// Piece of an input from a time on: p₀ + p₁ τ + … + p₅ τ⁵ and terms. Owns no memory.
template <class T>
struct InputPiece {
  using Real = detail::Real<T>;
  static constexpr int degree = 5;  ///< of the polynomial, at most

  T begin{0};  ///< s
  std::array<T, degree + 1> polynomial{};
  const InputTerm<T>* terms{nullptr};
  std::size_t count{0};

  /// True if the piece is a line.
  bool straight() const {
    return count == 0 &&
           std::all_of(polynomial.begin() + 2, polynomial.end(), [](const T& p) { return p == 0; });
  }
  T at(T tau) const {
    std::array<T, 1> c;
    expand(tau, T(1), c, 0);
    return c[0];
  }

  /// Computes the Taylor coefficients at τ up to an order, in the time σ = (t − τ)/step.
  template <std::size_t size>
  void expand(T tau, T step, std::array<T, size>& c, int order) const {
    expand_to(c.data(), tau, step, order);
  }

  /// Time after which its terms have decayed to the rounding of their amplitudes, s; infinite if a
  /// term lasts, zero without terms.
  T decayed() const {
    T time{0};
    for (std::size_t j = 0; j < count; ++j)
      time = std::max(time, T(detail::term_duration) / terms[j].decay);
    return time;
  }
  /// The polynomial alone.
  InputPiece without_terms() const { return {begin, polynomial, nullptr, 0}; }

  /// Sum of the sizes of what the value at τ is a sum of; rounding is a part of it.
  Real size(T tau) const {
    using std::abs;
    Real sum{0}, power{1}, start = plain(polynomial[0]);
    for (int n = 1; n <= degree; ++n) sum += abs(plain(polynomial[n])) * (power *= abs(plain(tau)));
    for (std::size_t j = 0; j < count; ++j) {
      const Real turned = turned_by(terms[j], tau);
      if (turned < begun) start += plain(terms[j].cosine);
      sum += (abs(plain(terms[j].cosine)) + abs(plain(terms[j].sine))) *
             (turned < begun ? turned : Real(1));
    }
    return sum + abs(start);
  }

  /// Largest rate of the terms, 1/s.
  Real fastest() const {
    Real rate{0};
    for (std::size_t j = 0; j < count; ++j) rate = std::max(rate, rate_of(terms[j]));
    return rate;
  }
  /// Smallest rate of the terms, 1/s; 0 without any.
  Real slowest() const {
    Real rate{0};
    for (std::size_t j = 0; j < count; ++j)
      for (const Real each : {Real(plain(terms[j].decay)), Real(plain(terms[j].frequency))})
        if (each > 0) rate = rate > 0 ? std::min(rate, each) : each;
    return rate;
  }
  /// Time after τ over which the Taylor terms beyond an order stay within a part of the size at τ, s: for a term of
  /// that size `longest` over its rate; a smaller one reaches farther.
  Real reach(T tau, int order, Real longest) const {
    using std::abs;
    Real whole = abs(plain(polynomial[0])), least = std::numeric_limits<Real>::infinity();
    for (std::size_t j = 0; j < count; ++j) whole += amplitude(terms[j], tau);
    for (std::size_t j = 0; j < count; ++j)
      least = std::min(least, detail::reach_of(amplitude(terms[j], tau), rate_of(terms[j]), whole,
                                               order, longest));
    return least;
  }
  /// Bound of the Taylor terms beyond an order >= `degree` at τ, over a step.
  Real beyond(T tau, Real step, int order) const {
    using detail::exp;
    Real sum{0};
    for (std::size_t j = 0; j < count; ++j) {
      const InputTerm<T>& term = terms[j];
      const Real s = rate_of(term) * step;
      Real power{1}, factorial{1};
      for (int n = 1; n <= order + 1; ++n) {
        power *= s;
        factorial *= n;
      }
      sum += amplitude(term, tau) * exp(s) * (power / factorial);
    }
    return sum;
  }

 private:
  /// Bound of a term from τ on.
  static Real amplitude(const InputTerm<T>& term, T tau) {
    using std::abs, detail::exp;
    return (abs(plain(term.cosine)) + abs(plain(term.sine))) * exp(-plain(term.decay * tau));
  }
  static Real rate_of(const InputTerm<T>& term) {
    return detail::hypot(plain(term.decay), plain(term.frequency));
  }
  /// Change of a term until τ over its amplitude, at most; below `begun` the term is expanded from its
  /// value at the begin: values that cancel there, as those of a(1 − e^(−δτ)), then do so exactly.
  static Real turned_by(const InputTerm<T>& term, T tau) {
    return plain((term.decay + term.frequency) * tau);
  }
  static constexpr Real begun{0.5};

  [[gnu::noinline]] void expand_to(T* c, T tau, T step, int order) const {
    using detail::cos, detail::exp, detail::expm1, detail::sin;
    std::array<T, degree + 1> p = polynomial;  // shifted to τ by repeated synthetic division
    T start = p[0], power{1};                  // value at the begin, from which c[0] counts
    p[0] = T(0);
    for (int k = 0; k < degree; ++k)
      for (int i = degree - 1; i >= k; --i) p[i] += tau * p[i + 1];
    for (int n = 0; n <= order; ++n, power *= step) c[n] = n <= degree ? p[n] * power : T(0);
    for (std::size_t j = 0; j < count; ++j) {
      const InputTerm<T>& term = terms[j];
      const T phase = term.frequency * tau, part = exp(-term.decay * tau);
      const T plain_cosine = cos(phase), plain_sine = sin(phase);
      const T cosine = plain_cosine * part, sine = plain_sine * part;
      const InputTerm<T> here{term.cosine * cosine + term.sine * sine,
                              term.sine * cosine - term.cosine * sine, term.decay, term.frequency};
      T value = here.cosine;
      if (turned_by(term, tau) < begun) {
        const T turn = plain_sine * plain_sine / (1 + plain_cosine);  // 1 − cos Ωτ
        value = term.cosine * (expm1(-term.decay * tau) * plain_cosine - turn) + term.sine * sine;
        start += term.cosine;
      }
      detail::each_coefficient(here, step, order, [&](int n, const T& coefficient, Real) {
        c[n] += n > 0 ? coefficient : value;
        return true;
      });
    }
    c[0] += start;
  }
};

/// Piece with at most two terms, which it owns.
template <class T>
struct OwnedPiece {
  InputPiece<T> piece{};
  std::array<InputTerm<T>, 2> terms{};

  OwnedPiece() = default;
  explicit OwnedPiece(const InputPiece<T>& of) : piece(of) {
    std::copy_n(of.terms, of.count, terms.data());
    piece.terms = terms.data();
  }
  OwnedPiece(const OwnedPiece& other) : OwnedPiece(other.piece) {}
  OwnedPiece& operator=(const OwnedPiece& other) {
    piece = other.piece;
    terms = other.terms;
    piece.terms = terms.data();
    return *this;
  }
  ~OwnedPiece() = default;

  void add(const InputTerm<T>& term) {
    terms[piece.count++] = term;
    piece.terms = terms.data();
  }
};

namespace detail {

/// Orders of a motion by which it is decided how it begins.
inline constexpr std::size_t beginning_orders = 9;

}  // namespace detail

/// Input from an instant on, until the next breakpoint: a line, a line that is raised to a power, or a part of a
/// piece.
template <class T>
struct Curve {
  using Real = detail::Real<T>;
  static constexpr Real near_zero{1e-4};  ///< of the size of a function

  T value{0}, rate{0};
  const InputPiece<T>* piece{nullptr};  ///< null for a line
  T since{0};                           ///< time since the begin of the piece, s
  T power{1};                           ///< of a raised line, > 0
  bool raised{false};  ///< true for a line to a power: value·(1 + rate τ/(power·value))^power

  Curve() = default;
  constexpr Curve(T at, T change) noexcept : value(at), rate(change) {}
  constexpr Curve(const Line<T>& line) noexcept  // NOLINT: a line is a curve
      : value(line.value), rate(line.rate) {}
  /// Part of a piece after a time from its begin.
  Curve(const InputPiece<T>& of, T after) : since(after) {
    std::array<T, 4> c;
    of.expand(after, T(1), c, 2);
    value = c[0];
    rate = c[1];
    if (of.straight()) return;
    piece = &of;
    using std::abs;
    const Real relative_error = detail::rounding<Real>, fastest = of.fastest(),
               size = of.size(after);
    const Real time =
        abs(plain(of.begin)) + abs(plain(after)) + (fastest > 0 ? 1 / fastest : Real(0));
    if (abs(plain(value)) < near_zero * size) refine_beside_touch(relative_error * size);
    // rounding: a zero or an extremum within the resolution of time and phase is now; so is a zero that the function
    // only touches (tests/hard/plate-fastest-at-curve-point-by-phase.txt, and five more drives).
    if (abs(plain(value)) <= relative_error * time * abs(plain(rate))) value -= plain(value);
    if (abs(plain(rate)) > relative_error * time * abs(2 * plain(c[2]))) return;
    rate -= plain(rate);
    if (abs(plain(value)) <= relative_error * size) value -= plain(value);
  }

  /// Part of a piece at a time that is so long after its begin; its terms may have decayed.
  [[gnu::noinline]] static Curve part(const InputPiece<T>& of, T after, bool decayed) {
    if (of.count == 0 || !decayed) return {of, after};
    const Curve rest(of.without_terms(), after);
    return rest.straight() ? rest : Curve(of, after);
  }

  bool straight() const { return piece == nullptr && !raised; }
  /// A line, which is not zero, raised to a power.
  [[gnu::noinline]] Curve to_the(T exponent) const {
    using detail::exp, detail::log;
    Curve found;
    found.value = exp(exponent * log(value));
    found.rate = exponent * found.value / value * rate;
    found.power = exponent;
    found.raised = rate != 0;
    return found;
  }
  /// True if the value does not change.
  bool steady() const { return straight() && rate == 0; }
  /// True if the value is and remains zero.
  bool is_zero() const { return steady() && value == 0; }
  /// Tangent at the instant.
  Line<T> line() const { return {value, rate}; }
  PINDRIVE_INLINE T at(T tau) const {
    if (straight()) return value + rate * tau;
    if (piece == nullptr) return value * growth(tau, power);
    return value + (piece->at(since + tau) - piece->at(since));
  }
  T rate_at(T tau) const {
    if (straight()) return rate;
    return piece == nullptr ? rate * growth(tau, power - 1) : derivatives(tau)[1];
  }
  /// Sum of the sizes of its terms after τ.
  detail::Real<T> size(T tau) const {
    using std::abs;
    if (straight()) return abs(plain(value)) + abs(plain(rate * tau));
    return raised ? abs(plain(at(tau))) + abs(plain(rate_at(tau) * tau)) : piece->size(since + tau);
  }
  /// Rounding of the value after τ: the terms of a function may cancel
  /// (tests/hard/both-plate-velocities-touch-zero-at-one-instant.txt).
  detail::Real<T> rounding(T tau = T(0)) const {
    return detail::rounding<detail::Real<T>> * size(tau);
  }
  /// Second and third derivative at the instant.
  T second() const { return straight() ? T(0) : derivatives(T(0))[2]; }
  T third() const { return straight() ? T(0) : derivatives(T(0))[3]; }
  /// Taylor coefficients at the instant.
  template <std::size_t count>
  [[gnu::noinline]] std::array<T, count> coefficients() const {
    std::array<T, count> c{};
    if (!straight()) expand(T(0), T(1), c, static_cast<int>(count) - 1);
    c[0] = value;
    c[1] = rate;
    return c;
  }
  /// Computes the Taylor coefficients after τ up to an order, in the time σ = (t − τ)/step; not of a line.
  template <std::size_t size>
  void expand(T tau, T step, std::array<T, size>& c, int order) const {
    if (piece != nullptr) return piece->expand(since + tau, step, c, order);
    expand_raised(c.data(), tau, step, order);
  }
  /// Time after τ over which the Taylor terms beyond an order stay within rounding, s; not of a line.
  Real reach(T tau, int order, Real longest) const {
    using std::abs;
    if (piece != nullptr) return piece->reach(since + tau, order, longest);
    const Real part = abs(plain(relative_rate() / (1 + relative_rate() * tau)));
    return raised_part / part;
  }
  /// Bound of the Taylor terms beyond an order, over a step within reach; not of a line.
  Real beyond(Real step, int order) const {
    using std::abs;
    if (piece != nullptr) return piece->beyond(since, step, order);
    const Real part = std::min(abs(plain(relative_rate())) * step, 2 * raised_part);
    Real power_of{1};
    for (int n = 0; n <= order; ++n) power_of *= part;
    return abs(plain(value)) * power_of / (1 - part);
  }
  /// Largest rate of its terms, 1/s: bounds the rate of what is `beyond`.
  Real fastest() const {
    using std::abs;
    if (straight()) return Real(0);
    return raised ? most_orders * abs(plain(relative_rate())) / raised_part : piece->fastest();
  }
  /// Number of its terms beside a polynomial.
  std::size_t terms() const { return piece == nullptr ? 0 : piece->count; }
  /// The same input from τ on.
  Curve from(T tau) const {
    Curve later = *this;
    later.value = at(tau);
    later.rate = rate_at(tau);
    later.since += tau;
    return later;
  }

 private:
  static constexpr Real raised_part{0.2};  ///< of the time to the zero of a raised line, in a step
  static constexpr Real most_orders{64};

  [[gnu::noinline]] void expand_raised(T* c, T tau, T step, int order) const {
    const T part = relative_rate() / (1 + relative_rate() * tau) * step;
    c[0] = at(tau);
    for (int n = 0; n < order; ++n) c[n + 1] = c[n] * part * ((power - T(n)) / T(n + 1));
  }
  /// Rate of a raised line over its value, 1/s.
  T relative_rate() const { return rate / (power * value); }
  /// Ratio of a raised line's value after τ to that now, to another power of the line.
  [[gnu::noinline]] T growth(T tau, T exponent) const {
    using detail::exp, detail::log1p;
    return exp(exponent * log1p(relative_rate() * tau));
  }
  /// Corrects the value close to an extremum at which the function only touches zero, as its terms cancel there: the
  /// value follows from its derivatives. `allowed`: the rounding of the value.
  [[gnu::noinline]] void refine_beside_touch(Real allowed) {
    using std::abs;
    auto c = coefficients<detail::beginning_orders>();
    c[0] = T(0);
    Real until{0}, change{0};  // time until the extremum, by Newton; the value there less this one
    for (int round = 0; round < 4; ++round) {
      Real slope{0}, bend{0};
      change = 0;
      for (std::size_t n = c.size(); n-- > 0;) {
        bend = bend * until + slope;
        slope = slope * until + change;
        change = change * until + plain(c[n]);
      }
      until -= slope / (2 * bend);
    }
    const bool close = abs(plain(c[3]) * until) <= near_zero * abs(plain(c[2]));
    const Real error = plain(value) + change;
    if (close && abs(error) <= allowed) value -= error;
  }
  [[gnu::noinline]] std::array<T, 4> derivatives(T tau) const {
    std::array<T, 4> c;
    expand(tau, T(1), c, 3);
    c[2] *= T(2);
    c[3] *= T(6);
    return c;
  }
};

namespace detail {

/// The first coefficient of order 3 or more that is not zero; 0 without one.
template <class T>
T third_or_later(const std::array<T, beginning_orders>& c) {
  const auto first = std::find_if(c.begin() + 3, c.end(), [](const T& each) { return each != 0; });
  return first == c.end() ? T(0) : *first;
}

}  // namespace detail
}  // namespace pindrive
