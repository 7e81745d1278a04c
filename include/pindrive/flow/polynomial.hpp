/// A quantity along a step as a polynomial, and its first zero with certainty: by its Bernstein
/// coefficients, which enclose it. Nothing is sampled and nothing can be stepped over.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow/flow.hpp"

namespace pindrive {

/// The highest order of a series. A step is then about a fifth of the radius of convergence.
inline constexpr int series_order = 24;

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
  /// A bound of it over the step.
  T size() const {
    using std::abs;
    T sum{0};
    for (int n = 0; n <= degree; ++n) sum += abs(c[n]);
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
  friend Polynomial operator+(Polynomial p, const Polynomial& q) { return p += q; }
  friend Polynomial operator*(T factor, Polynomial p) {
    for (int n = 0; n <= p.degree; ++n) p.c[n] *= factor;
    return p;
  }
  /// Its degree is below the highest that there is.
  friend Polynomial operator*(const Line<T>& line, Polynomial p) {
    if (line.rate != 0) p.c[++p.degree] = T(0);
    for (int n = p.degree; n >= 0; --n)
      p.c[n] = line.value * p.c[n] + (n > 0 ? line.rate * p.span * p.c[n - 1] : T(0));
    return p;
  }
};

namespace detail {

/// The Bernstein coefficients on [0, 1] of a polynomial in powers: its values lie between the least and the
/// largest of them, and at both ends it is the first and the last.
template <class Real>
std::array<Real, series_order + 2> bernstein(const std::array<Real, series_order + 2>& powers,
                                             int degree) {
  std::array<Real, series_order + 2> b{};
  for (int i = 0; i <= degree; ++i) {
    Real ratio{1};  // of binomials: (i over j) / (degree over j)
    for (int j = 0; j <= i; ++j) {
      b[i] += ratio * powers[j];
      ratio *= Real(i - j) / Real(degree - j);
    }
  }
  return b;
}

/// Makes of those of an interval those of its halves, by de Casteljau's scheme.
template <class Real>
void halve(std::array<Real, series_order + 2>& upper, std::array<Real, series_order + 2>& lower,
           int degree) {
  for (int k = 0; k <= degree; ++k) {
    lower[k] = upper[0];
    for (int i = 0; i < degree - k; ++i) upper[i] = (upper[i] + upper[i + 1]) / 2;
  }
}

/// The lowest value found on an interval, or at its ends; it dips no deeper below zero than that, or than
/// `unseen`. What is not proven by so many halvings may dip as deep as its lowest coefficient.
template <class Real>
Real lowest(const std::array<Real, series_order + 2>& b, int degree, Real unseen, int halvings) {
  const Real ends = std::min(b[0], b[degree]);
  const Real bound = *std::min_element(b.begin(), b.begin() + degree + 1);
  if (!(ends >= -unseen) || bound >= -unseen) return ends;
  if (halvings == 0) return bound;
  std::array<Real, series_order + 2> lower, upper = b;
  halve(upper, lower, degree);
  return std::min(lowest(lower, degree, unseen, halvings - 1),
                  lowest(upper, degree, unseen, halvings - 1));
}

/// Where a polynomial on [0, 1] changes its sign, by its Bernstein coefficients, which enclose its values:
/// nowhere while they have one sign, once where they change it once; else the interval is halved.
template <class Real>
class SignIsolation {
 public:
  using Coefficients = std::array<Real, series_order + 2>;

  /// The powers' coefficients of a polynomial, and its sign just after 0.
  SignIsolation(const Coefficients& powers, int degree, int side)
      : powers_(powers), degree_(degree), side_(side) {}

  /// Calls visit(σ) at each change in order, until it returns false.
  template <class Visitor>
  void each(Visitor&& visit) {
    Real rest{0};
    for (int n = 1; n <= degree_; ++n) rest += std::abs(powers_[n]);
    if (side_ * powers_[0] > rest) return;
    search(bernstein<Real>(powers_, degree_), Real(0), Real(1), visit);
  }

 private:
  static constexpr Real narrowest = 4 * std::numeric_limits<Real>::epsilon();

  bool beyond(Real value) const { return side_ * value < 0; }

  template <class Visitor>
  bool change(Real at, Real left, Visitor& visit) {
    side_ = -side_;
    left_ = left;
    return visit(at);
  }

  /// In [low, low + width]; at `left_`, at most `low`, the polynomial was last known to be on its side.
  template <class Visitor>
  bool search(const Coefficients& b, Real low, Real width, Visitor& visit) {
    if (beyond(b[0]) && !change(left_ < low ? root(left_, low) : low, low, visit)) return false;
    int changes = 0;
    for (int i = 0; i < degree_; ++i) changes += beyond(b[i]) != beyond(b[i + 1]);
    if (changes > 1 && width > narrowest * (low + width)) {
      Coefficients lower, upper = b;
      halve(upper, lower, degree_);
      const Real half = width / 2;
      return search(lower, low, half, visit) && search(upper, low + half, half, visit);
    }
    if (beyond(b[degree_])) return change(root(low, low + width), low + width, visit);
    left_ = low + width;  // what changes twice in so short a time is a touch, to rounding
    return true;
  }

  /// The zero in a bracket, beyond at `high` alone: Newton's iteration, kept inside.
  Real root(Real low, Real high) const {
    Real s = low + (high - low) / 2;
    for (int tries = 0; tries < 200 && low < s && s < high; ++tries) {
      Real sum = powers_[degree_], rate{0};
      for (int n = degree_; n-- > 0;) {
        rate = rate * s + sum;
        sum = sum * s + powers_[n];
      }
      if (sum == 0) return s;
      (beyond(sum) ? high : low) = s;
      const Real newton = s - sum / rate;
      const bool inside = newton > low && newton < high && tries % 4 != 3;
      const Real next = inside ? newton : low + (high - low) / 2;
      if (std::abs(next - s) <= std::numeric_limits<Real>::epsilon() * s) return next;
      s = next;
    }
    return s;
  }

  Coefficients powers_;
  int degree_, side_;
  Real left_{0};
};

}  // namespace detail

/// Calls visit(τ) where a polynomial changes its sign in (0, span], in order, until it returns false.
/// `side` is its sign just after τ = 0: a start at zero, or put beyond it by rounding, is left to that
/// side and is no change, and so is one at which the rate is zero or beyond, too.
template <class T, class Visitor>
void sign_changes(const Polynomial<T>& p, int side, Visitor&& visit) {
  using Real = detail::Real<T>;
  std::array<Real, series_order + 2> powers{};
  int zeros = 0;
  while (zeros <= p.degree && zeros < 2 && !(side * plain(p.c[zeros]) > 0)) ++zeros;
  while (zeros <= p.degree && plain(p.c[zeros]) == 0) ++zeros;
  if (zeros > p.degree) return;
  for (int n = zeros; n <= p.degree; ++n) powers[n - zeros] = plain(p.c[n]);
  detail::SignIsolation<Real>(powers, p.degree - zeros, side).each([&](Real s) {
    // A zero moves so that the polynomial stays zero; of plain numbers there is nothing to say.
    const T root = s * p.span, value = p.at(root);
    const Real rate = plain(p.derivative().at(root));
    return visit(rate == 0 ? root : root - (value - plain(value)) / rate);
  });
}

/// The lowest value of a polynomial over its span, for a quantity that must not be negative: it dips no
/// deeper below zero than that, or than `unseen`.
template <class T>
T lowest(const Polynomial<T>& p, T unseen) {
  return detail::lowest(detail::bernstein(p.c, p.degree), p.degree, unseen, 40);
}

/// What its size stays below over its span: its values lie among its Bernstein coefficients.
template <class T>
T largest_size(const Polynomial<T>& p) {
  const auto b = detail::bernstein(p.c, p.degree);
  T most{0};
  for (int n = 0; n <= p.degree; ++n) most = std::max(most, std::abs(b[n]));
  return most;
}

/// The earliest τ in (0, span] at which a guard becomes negative; infinity if there is none. It is
/// positive just after τ = 0, as the mode has chosen.
template <class T>
T first_zero(const Polynomial<T>& guard) {
  T first = std::numeric_limits<T>::infinity();
  sign_changes(guard, 1, [&](T tau) {
    first = tau;
    return false;
  });
  return first;
}

}  // namespace pindrive
