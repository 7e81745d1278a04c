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
    polynomial[0] += curve.value - at(T(0));
  }

  std::array<T, degree + 1> polynomial{};
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

  /// Time after τ over which its Taylor terms beyond the order of a series are within rounding, s.
  Real reach(Real tau) const {
    const Real whole = largest_after(tau);
    Real least = std::numeric_limits<Real>::infinity();
    for (const InputTerm<T>& term : *this) {
      const Real amplitude = amplitude_after(term, tau);
      const Real rate = std::hypot(plain(term.decay), plain(term.frequency));
      if (amplitude > negligible * whole && rate > 0)
        least = std::min(
            least, Real(longest_input) / rate * exp(log(whole / amplitude) / (series_order + 1)));
    }
    return least;
  }
  /// Its Taylor polynomial from τ on, over a step within its reach.
  Polynomial<T> expanded(T tau, Real step) const {
    Polynomial<T> p;
    p.span = step;
    const std::array<T, degree + 1> later = moved_polynomial(tau);
    T power{1};
    for (int n = 0; n <= degree; ++n, power *= step) p.c[n] = later[n] * power;
    p.degree = degree;
    const Real whole = largest_after(plain(tau));
    for (const InputTerm<T>& term : *this) {
      if (!(amplitude_after(term, plain(tau)) > negligible * whole)) continue;
      const InputTerm<T> now = moved(term, tau);
      // Real part of (cosine − i·sine) e^((iΩ − δ)τ), whose n-th coefficient follows from the last.
      T real = now.cosine, imaginary = -now.sine;
      for (int n = 0; n <= series_order; ++n) {
        p.c[n] += real;
        const T next = step / T(n + 1);
        const T turned = -(term.decay * real + term.frequency * imaginary) * next;
        imaginary = (term.frequency * real - term.decay * imaginary) * next;
        real = turned;
      }
      p.degree = series_order;
    }
    Real tail{0};
    const Real known = removed_terms<Real> * plain(p.size());
    while (p.degree > 1 && (tail += std::abs(plain(p.c[p.degree]))) <= known)
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

  /// Bound of a term from τ on.
  static Real amplitude_after(const InputTerm<T>& term, Real tau) {
    return (std::abs(plain(term.cosine)) + std::abs(plain(term.sine))) *
           exp(-plain(term.decay) * tau);
  }
  /// Size of the polynomial at τ and of the terms from there on.
  Real largest_after(Real tau) const {
    Real sum{0};
    for (int n = degree; n >= 0; --n) sum = sum * tau + plain(polynomial[n]);
    sum = std::abs(sum);
    for (const InputTerm<T>& term : *this) sum += amplitude_after(term, tau);
    return sum;
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

/// Steps of sums from one time to another, as their Taylor polynomials hold: calls visit(begin, length)
/// with each, in order, until visit returns false. `reach(τ)` is the longest step after τ.
template <class T, class Reach, class Visitor>
void each_step(const T& from, const T& to, Reach&& reach, Visitor&& visit) {
  for (T low = from; low < to;) {
    T high = std::min(T(low + reach(plain(low))), to);
    if (!(high > low)) high = to;  // so late that a step is lost in rounding
    if (!visit(low, plain(high - low))) return;
    low = high;
  }
}

}  // namespace pindrive::detail
