/// Polynomial of a quantity along a step, and its first zero with certainty: Bernstein coefficients
/// enclose the values, so that no zero can be stepped over.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "pindrive/flow/flow.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Highest order of a series. A step is then about a fifth of the radius of convergence.
inline constexpr int series_order = 24;

/// Powers of a part of a step, by which the coefficients of a series are scaled to that part.
template <class Real>
using Powers = std::array<Real, series_order + 2>;
template <class Real>
Powers<Real> powers_of(Real part) {
  Powers<Real> powers{};
  powers[0] = Real(1);
  for (std::size_t n = 1; n < powers.size(); ++n) powers[n] = powers[n - 1] * part;
  return powers;
}

/// Terms p_i q_(n−i) of the product of two series, from i = first to last; two partial sums are added at once.
template <class T>
T sum_of_products(const T* p, const T* q, int n, int first, int last) {
  T even{0}, odd{0};
  if (last < first) return even;
  const T *one = p + first, *other = q + (n - first);
  const T* const end = p + last;
  for (; one < end; one += 2, other -= 2) {
    even += one[0] * other[0];
    odd += one[1] * other[-1];
  }
  if (one == end) even += *one * *other;
  return even + odd;
}
template <class T, std::size_t P, std::size_t Q>
T sum_of_products(const std::array<T, P>& p, const std::array<T, Q>& q, int n, int first,
                  int last) {
  return sum_of_products(p.data(), q.data(), n, first, last);
}
/// Order n of the square of a series without the terms of order 0.
template <class P>
auto inner_square(const P& p, int n) {
  auto sum = 2 * sum_of_products(p, p, n, 1, (n - 1) / 2);
  if (n > 0 && n % 2 == 0) sum += p[n / 2] * p[n / 2];
  return sum;
}

/// Quantity along a step: c₀ + c₁ σ + … with σ = τ/span, 0 <= σ <= 1.
template <class T>
struct Polynomial {
  using Real = detail::Real<T>;

  std::array<T, series_order + 2> c{};
  int degree{0};
  Real span{1};  ///< s

  T start() const { return c[0]; }
  void begin_at(const T& value) { c[0] = value; }
  /// Value τ after the begin of the step.
  T at(T tau) const {
    const T s = tau / span;
    T sum = c[degree];
    for (int n = degree; n-- > 0;) sum = sum * s + c[n];
    return sum;
  }
  /// Bound of the absolute value over the step.
  T size() const {
    T sum{0};
    for (int n = 0; n <= degree; ++n) sum += abs(c[n]);
    return sum;
  }
  bool constant() const {
    return std::all_of(c.begin() + 1, c.end(), [](const T& each) { return each == 0; });
  }
  /// Derivative by time, per second.
  Polynomial derivative() const {
    Polynomial rate;
    rate.span = span;
    rate.degree = std::max(degree - 1, 0);
    for (int n = 0; n < degree; ++n) rate.c[n] = c[n + 1] * (n + 1) / span;
    return rate;
  }

  /// Takes a part of the step as the step, by its powers; with the coefficients beyond the degree.
  void rescale(const Powers<Real>& part) {
    span *= part[1];
    if (degree == 0) return;
    for (std::size_t n = 1; n < c.size(); ++n) c[n] *= part[n];
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
  /// Product over the same span, without the terms beyond the highest order.
  friend Polynomial operator*(const Polynomial& p, const Polynomial& q) {
    Polynomial product;
    product.span = q.span;
    product.degree = std::min(p.degree + q.degree, series_order + 1);
    for (int i = 0; i <= p.degree; ++i)
      for (int j = 0; j <= std::min(q.degree, product.degree - i); ++j)
        product.c[i + j] += p.c[i] * q.c[j];
    return product;
  }
};

/// Tail sums of the absolute coefficients of a series: of all orders from n on.
template <class Real>
using Sums = std::array<Real, series_order + 2>;
template <class T>
Sums<Real<T>> sums_of(const std::array<T, series_order + 2>& c) {
  Sums<Real<T>> sums{};
  for (int n = series_order; n >= 0; --n) sums[n] = sums[n + 1] + std::abs(plain(c[n]));
  return sums;
}
/// Bound of the terms of a product of two series beyond the last order.
template <class Real>
Real beyond(const Sums<Real>& p, const Sums<Real>& q) {
  Real sum{0};
  for (int i = 1; i <= series_order; ++i) sum += (p[i] - p[i + 1]) * q[series_order + 1 - i];
  return sum;
}

/// Bernstein coefficients on [0, 1] of a polynomial in powers. The values lie between the smallest
/// and the largest coefficient; the first and the last are the values at the ends.
template <class Real, std::size_t size>
std::array<Real, size> bernstein(const std::array<Real, size>& powers, int degree) {
  std::array<Real, size> b{};
  Real binomial{1};  // (degree over j)
  for (int j = 0; j <= degree; ++j) {
    b[j] = powers[j] / binomial;
    binomial *= Real(degree - j) / Real(j + 1);
  }
  // Sums of (i over j) b_j, as in Pascal's triangle.
  for (int k = 1; k <= degree; ++k)
    for (int i = degree; i >= k; --i) b[i] += b[i - 1];
  return b;
}

/// Subdivides an interval into halves by its Bernstein coefficients (de Casteljau).
template <class Real>
void halve(std::array<Real, series_order + 2>& upper, std::array<Real, series_order + 2>& lower,
           int degree) {
  for (int k = 0; k <= degree; ++k) {
    lower[k] = upper[0];
    for (int i = 0; i < degree - k; ++i) upper[i] = (upper[i] + upper[i + 1]) / 2;
  }
}

/// Lowest value found on an interval, or at its ends. The true minimum is no lower below zero than
/// this value or `unseen`; after the last bisection the lowest coefficient bounds the minimum.
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

/// Sign changes of a polynomial on [0, 1] from its Bernstein coefficients, which enclose the
/// values: none for coefficients of one sign, one for one change of sign; else the interval is
/// bisected.
template <class Real>
class SignIsolation {
 public:
  using Coefficients = std::array<Real, series_order + 2>;

  /// Takes the coefficients of a polynomial, and its sign just after 0.
  SignIsolation(const Coefficients& powers, int degree, int side)
      : powers_(powers), degree_(degree), side_(side) {}

  /// Calls visit(σ) at each change in order, until visit returns false.
  template <class Visitor>
  void each(Visitor&& visit) {
    Real rest{0};
    for (int n = 1; n <= degree_; ++n) rest += std::abs(powers_[n]);
    if (side_ * powers_[0] > rest) return;
    search(bernstein<Real>(powers_, degree_), Real(0), Real(1), visit);
  }

 private:
  bool beyond(Real value) const { return side_ * value < 0; }

  template <class Visitor>
  bool change(Real at, Real left, Visitor& visit) {
    side_ = -side_;
    left_ = left;
    return visit(at);
  }

  /// Isolates in [low, low + width]; at `left_`, at most `low`, the polynomial was last on its
  /// side.
  template <class Visitor>
  bool search(const Coefficients& b, Real low, Real width, Visitor& visit) {
    if (beyond(b[0]) && !change(left_ < low ? root(left_, low) : low, low, visit)) return false;
    int changes = 0;
    for (int i = 0; i < degree_; ++i) changes += beyond(b[i]) != beyond(b[i + 1]);
    if (changes > 1 && width > rounding<Real> * (low + width)) {
      Coefficients lower, upper = b;
      halve(upper, lower, degree_);
      const Real half = width / 2;
      return search(lower, low, half, visit) && search(upper, low + half, half, visit);
    }
    if (beyond(b[degree_])) return change(root(low, low + width), low + width, visit);
    left_ = low + width;  // two changes of sign in so short a time are a touch, to rounding
    return true;
  }

  /// Zero in a bracket, by Newton's iteration; by bisection where that leaves the bracket or does not halve its steps.
  Real root(Real low, Real high) const {
    Real s = low + (high - low) / 2, last = high - low;  // last step
    bool newton_before = false;
    for (int tries = 0; tries < 200 && low < s && s < high; ++tries) {
      Real sum = powers_[degree_], rate{0};
      for (int n = degree_; n-- > 0;) {
        rate = rate * s + sum;
        sum = sum * s + powers_[n];
      }
      if (sum == 0) return s;
      (beyond(sum) ? high : low) = s;
      const Real newton = s - sum / rate, step = std::abs(newton - s);
      const bool inside = newton > low && newton < high && step < last / 2;
      const Real next = inside ? newton : low + (high - low) / 2;
      const Real ratio = inside && newton_before ? step / last : Real(1);
      newton_before = inside;
      last = inside ? step : high - low;
      // Each ratio of two steps of Newton is the square of that before: the step that is left is below the last digit.
      const bool close = last <= Real(near_root) * next;
      if (close && last * ratio * ratio <= last_digit<Real> * next) return next;
      s = next;
    }
    return s;
  }

  Coefficients powers_;
  int degree_, side_;
  Real left_{0};
};

/// Calls visit(τ) at each sign change of a polynomial in (0, span], in order, until visit returns
/// false. `side` is the sign just after τ = 0: a start at zero, or beyond zero by rounding, belongs
/// to this side and is no change; neither is a start with a rate of zero or of the wrong sign.
template <class T, class Visitor>
void sign_changes(const Polynomial<T>& p, int side, Visitor&& visit) {
  using Real = detail::Real<T>;
  std::array<Real, series_order + 2> powers{};
  int zeros = 0;
  while (zeros <= p.degree && zeros < 2 && !(side * plain(p.c[zeros]) > 0)) ++zeros;
  while (zeros <= p.degree && plain(p.c[zeros]) == 0) ++zeros;
  if (zeros > p.degree) return;
  for (int n = zeros; n <= p.degree; ++n) powers[n - zeros] = plain(p.c[n]);
  SignIsolation<Real>(powers, p.degree - zeros, side).each([&](Real s) {
    // A zero moves so that the polynomial stays zero; of plain numbers there is nothing to say.
    const T root = s * p.span, value = p.at(root);
    const Real rate = plain(p.derivative().at(root));
    return visit(rate == 0 ? root : root - (value - plain(value)) / rate);
  });
}

/// Lowest value of a polynomial over its span, for a quantity that must not be negative: the true
/// minimum is no lower below zero than this value or `unseen`.
template <class T>
T lowest(const Polynomial<T>& p, T unseen) {
  return lowest(bernstein(p.c, p.degree), p.degree, unseen, 40);
}

/// Bound of the absolute value over the span, from the Bernstein coefficients.
template <class T>
T largest_size(const Polynomial<T>& p) {
  const auto b = bernstein(p.c, p.degree);
  T most{0};
  for (int n = 0; n <= p.degree; ++n) most = std::max(most, abs(b[n]));
  return most;
}

/// Zero at which a quantity that begins positive becomes negative by more than its rounding; infinity if none.
///
/// `changes(offset, visit)` calls visit(τ) at each sign change of the quantity plus `offset`, in order, until visit
/// returns false. A quantity that only touches zero, as a velocity at the end of a stroke, has none.
template <class T, class Changes>
T zero_beyond(Real<T> error, Changes&& changes) {
  constexpr T never{std::numeric_limits<Real<T>>::infinity()};
  T beyond = never, last = never;
  bool falls = false;
  const auto visit = [&](const T& tau) {
    if (beyond == never) {
      beyond = tau;
      return false;
    }
    falls = !falls;
    if (falls && (tau <= beyond || last == never)) last = tau;
    return tau < beyond;
  };
  changes(error, visit);
  if (error == 0 || beyond == never) return beyond;
  changes(0, visit);
  return last < never ? last : beyond;
}
template <class T>
T zero_beyond(const Polynomial<T>& p, Real<T> error) {
  return zero_beyond<T>(error, [&](Real<T> offset, const auto& visit) {
    Polynomial<T> raised = p;
    raised.c[0] += offset;
    sign_changes(raised, 1, visit);
  });
}

/// Earliest τ in (0, span] at which a guard becomes negative; infinity if none. The guard is
/// positive just after τ = 0, by the choice of the mode.
template <class T>
T first_zero(const Polynomial<T>& guard) {
  return zero_beyond(guard, Real<T>(0));
}

}  // namespace pindrive::detail
