/// Quantity as a polynomial and damped sinusoids of the time since the begin of a segment.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/input_function.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// p₀ + p₁ τ + … + p₆ τ⁶ + Σ (cosine·cos Ωτ + sine·sin Ωτ) e^(−δτ), 0 <= δ.
template <class T>
class TermSum {
 public:
  using Real = detail::Real<T>;
  static constexpr int degree = InputPiece<T>::degree + 1;  ///< of a position: velocity integrated
  static constexpr int most_terms = 8;

  TermSum() = default;
  TermSum(const Line<T>& line) : polynomial{line.value, line.rate} {}  // NOLINT: a line is a sum
  /// An input from its instant on; its value there is exact.
  TermSum(const Curve<T>& curve) {  // NOLINT: an input is a sum
    if (curve.straight()) {
      polynomial = {curve.value, curve.rate};
      return;
    }
    std::copy(curve.piece->polynomial.begin(), curve.piece->polynomial.end(), polynomial.begin());
    polynomial = moved_polynomial(curve.since);
    for (std::size_t j = 0; j < curve.piece->count; ++j)
      add(moved(curve.piece->terms[j], curve.since));
    begin_at(curve.value);
  }

  std::array<T, degree + 1> polynomial{};
  /// Sets its value at the begin by its constant.
  void begin_at(const T& value) { polynomial[0] += value - start(); }
  const InputTerm<T>* begin() const { return terms_.data(); }
  const InputTerm<T>* end() const { return terms_.data() + count_; }
  /// Adds a term to that of its decay and frequency.
  void add(const InputTerm<T>& term) {
    for (int j = 0; j < count_; ++j)
      if (terms_[j].decay == term.decay && terms_[j].frequency == term.frequency) {
        terms_[j].cosine += term.cosine;
        terms_[j].sine += term.sine;
        return;
      }
    terms_[count_++] = term;
  }

  T start() const {
    T sum = polynomial[0];
    for (const InputTerm<T>& term : *this) sum += term.cosine;
    return sum;
  }
  T at(T tau) const {
    T sum = polynomial[degree];
    for (int n = degree; n-- > 0;) sum = sum * tau + polynomial[n];
    for (const InputTerm<T>& term : *this) sum += moved(term, tau).cosine;
    return sum;
  }
  TermSum derivative() const {
    TermSum rate;
    for (int n = 0; n < degree; ++n) rate.polynomial[n] = T(n + 1) * polynomial[n + 1];
    for (const InputTerm<T>& t : *this)
      rate.terms_[rate.count_++] = {t.frequency * t.sine - t.decay * t.cosine,
                                    -(t.frequency * t.cosine + t.decay * t.sine), t.decay,
                                    t.frequency};
    return rate;
  }
  bool constant() const {
    return std::all_of(polynomial.begin() + 1, polynomial.end(),
                       [](const T& p) { return p == 0; }) &&
           std::all_of(begin(), end(),
                       [](const InputTerm<T>& t) { return t.cosine == 0 && t.sine == 0; });
  }
  /// Bound of the sum of the sizes of its parts from 0 to τ.
  T size(T tau) const {
    T sum{0}, power{1};
    for (const T& p : polynomial) {
      sum += abs(p) * power;
      power *= tau;
    }
    for (const InputTerm<T>& term : *this) sum += abs(term.cosine) + abs(term.sine);
    return sum;
  }
  /// Square of the largest rate of its terms, 1/s².
  T hurry_squared() const {
    T most{0};
    for (const InputTerm<T>& t : *this)
      most = std::max(most, t.decay * t.decay + t.frequency * t.frequency);
    return most;
  }

  /// The sum with its time counted from τ on.
  TermSum from(const T& tau) const {
    TermSum later;
    later.polynomial = moved_polynomial(tau);
    for (const InputTerm<T>& term : *this) later.terms_[later.count_++] = moved(term, tau);
    return later;
  }

  /// Lower bound of the sum over a length of time, s; with a side of −1, of the negative sum. Each term is bounded by its
  /// Taylor polynomial of low order or, if its phase changes too much for that, by its amplitude.
  Real least(Real length, int side = 1) const {
    std::array<Real, degree + 1> p{};
    Real power(side), missed{0}, size{0};
    for (int n = 0; n <= degree; ++n, power *= length) {
      p[n] = plain(polynomial[n]) * power;
      size += std::abs(p[n]);
    }
    for (const InputTerm<T>& term : *this) {
      const Real decay = plain(term.decay), part = rate_of(term) * length;
      // A term that grows, as under friction that falls with the speed, is largest at the end.
      const Real amplitude = amplitude_of(term) * (decay < 0 ? exp(-decay * length) : Real(1));
      size += amplitude;
      Real beyond = amplitude;
      for (int n = 0; n <= degree && beyond > 0; ++n) beyond *= part / Real(n + 1);
      if (beyond < amplitude) {
        missed += beyond;
        add_taylor(InputTerm<Real>{side * plain(term.cosine), side * plain(term.sine), decay,
                                   plain(term.frequency)},
                   length, degree, p);
      } else if (term.frequency == 0) {  // from one value to another
        const Real start = side * plain(term.cosine);
        p[0] += std::min(start, start * exp(-decay * length));
      } else {
        missed += amplitude;
      }
    }
    const auto b = bernstein(p, degree);
    return *std::min_element(b.begin(), b.end()) - missed - rounding<Real> * size;
  }
  /// Time over which its Taylor terms beyond the order of a series are within rounding, s.
  Real reach() const {
    const Real whole = largest();
    Real least = std::numeric_limits<Real>::infinity();
    for (const InputTerm<T>& term : *this)
      if (amplitude_of(term) > negligible * whole)
        least = std::min(least, reach_of(amplitude_of(term), rate_of(term), whole, series_order,
                                         Real(longest_input)));
    return least;
  }
  /// Its Taylor polynomial over a step within its reach.
  Polynomial<T> expanded(Real step) const {
    Polynomial<T> p;
    p.span = step;
    T power{1};
    for (int n = 0; n <= degree; ++n, power *= step) p.c[n] = polynomial[n] * power;
    p.degree = degree;
    const Real whole = largest();
    for (const InputTerm<T>& term : *this) {
      // Not a term that is negligible in the sums by whose reach the step was chosen.
      if (!(amplitude_of(term) > negligible * whole) || rate_of(term) * step > farthest_reach)
        continue;
      add_taylor(term, step, series_order, p.c);
      p.degree = series_order;
    }
    Real tail{0};
    const Real error = removed_terms<Real> * plain(p.size());
    while (p.degree > 1 && (tail += std::abs(plain(p.c[p.degree]))) <= error)
      p.c[p.degree--] = T(0);
    return p;
  }

  /// Adds a multiple of a sum.
  TermSum& add(const T& factor, const TermSum& other) {
    for (int n = 0; n <= degree; ++n) polynomial[n] += factor * other.polynomial[n];
    for (const InputTerm<T>& term : other)
      add({factor * term.cosine, factor * term.sine, term.decay, term.frequency});
    return *this;
  }
  TermSum& operator+=(const TermSum& other) { return add(T(1), other); }
  friend TermSum operator+(TermSum p, const TermSum& q) { return p += q; }
  friend TermSum operator*(const T& factor, const TermSum& p) { return TermSum().add(factor, p); }

 private:
  static constexpr Real negligible = std::numeric_limits<Real>::epsilon() / 64;  ///< part of a sum

  /// Longest step over the time constant of a term that counts, by its reach: that of a negligible one.
  static constexpr Real farthest_reach = 5.1 * longest_input;

  static Real rate_of(const InputTerm<T>& term) {
    return sqrt(plain(term.decay) * plain(term.decay) +
                plain(term.frequency) * plain(term.frequency));
  }
  /// Bound of a term.
  static Real amplitude_of(const InputTerm<T>& term) {
    return std::abs(plain(term.cosine)) + std::abs(plain(term.sine));
  }
  /// Size of the constant and of the terms.
  Real largest() const {
    Real sum = std::abs(plain(polynomial[0]));
    for (const InputTerm<T>& term : *this) sum += amplitude_of(term);
    return sum;
  }

  /// Adds the Taylor coefficients of a term in the time σ = τ/step, up to an order.
  template <class Number, class Coefficients>
  static void add_taylor(const InputTerm<Number>& term, Real step, int order, Coefficients& c) {
    const Real error = negligible * (std::abs(plain(term.cosine)) + std::abs(plain(term.sine)));
    each_coefficient(term, step, order, [&](int n, const Number& coefficient, Real size) {
      c[n] += coefficient;
      return n < farthest_reach || size >= error;  // later ones are smaller
    });
  }
  /// The term with its time counted from τ on.
  static InputTerm<T> moved(const InputTerm<T>& term, const T& tau) {
    const T part = term.decay == 0 ? T(1) : T(exp(-term.decay * tau));
    if (term.frequency == 0) return {term.cosine * part, T(0), term.decay, term.frequency};
    const auto turned = sine_and_cosine_of(term.frequency * tau);
    const T cosine = turned.cosine * part, sine = turned.sine * part;
    return {term.cosine * cosine + term.sine * sine, term.sine * cosine - term.cosine * sine,
            term.decay, term.frequency};
  }
  /// The polynomial with its time counted from τ on, by repeated synthetic division.
  std::array<T, degree + 1> moved_polynomial(const T& tau) const {
    std::array<T, degree + 1> p = polynomial;
    for (int k = 0; k < degree; ++k)
      for (int i = degree - 1; i >= k; --i) p[i] += tau * p[i + 1];
    return p;
  }

  std::array<InputTerm<T>, most_terms> terms_{};
  int count_{0};
};

/// Steps of sums from one time to another, as their Taylor polynomials hold: calls visit(begin, end)
/// with each, in order, until visit returns false. `reach(τ)` is the longest step after τ.
template <class T, class Reach, class Visitor>
void each_step(const T& from, const T& to, Reach&& reach, Visitor&& visit) {
  for (T low = from; low < to;) {
    T high = std::min(T(low + reach(plain(low))), to);
    if (!(high > low)) high = to;  // so late that a step is lost in rounding
    if (!visit(low, high)) return;
    low = high;
  }
}

/// Calls visit(τ) at each sign change of a sum in (from, to], in order, until visit returns false. `side` is the sign just
/// after `from`. Parts in which a bound excludes a zero are passed at once; in others Taylor polynomials isolate it. No
/// part begins at or after `until`, which changes no other part: two mirrored sums have the same zeros, to the bit.
template <class T, class Visitor>
void sign_changes(const TermSum<T>& sum, int side, const T& from, const T& to, const T& until,
                  Visitor&& visit) {
  bool goes_on = true;
  const auto change = [&](const T& tau) {
    side = -side;
    return goes_on = visit(tau);
  };
  T length = to - from;
  for (T low = from; goes_on && low < until;) {
    length = std::min(length, T(to - low));
    const TermSum<T> rest = sum.from(low);
    bool clear = rest.least(plain(length), side) > 0;
    for (const T reach = clear ? length : T(rest.reach()); !clear && length > reach;) {
      length = std::max(T(length / 4), reach);
      clear = rest.least(plain(length), side) > 0;
    }
    if (!clear) {
      const Polynomial<T> p = rest.expanded(plain(length));
      // A change within the rounding of the end of the step before.
      const Real<T> value = side * plain(p.c[0]);
      if (low > from && (value < 0 || (value == 0 && side * plain(p.c[1]) < 0)) && !change(low))
        return;
      sign_changes(p, side, [&](const T& tau) { return change(low + tau); });
    }
    const T high = low + length;
    low = length < to - low && high > low ? high : to;  // so late that a step is lost in rounding
    length *= 4;
  }
}

}  // namespace pindrive::detail
