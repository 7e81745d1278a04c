// Quantities along a step as polynomials: their arithmetic, what encloses them, and their zeros with certainty.
#include "pindrive/flow/polynomial.hpp"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "check.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using P = pd::detail::Polynomial<double>;

namespace {

/// The product of (σ − root) over a step of a length, times a factor.
P with_zeros(const std::vector<double>& roots, double factor = 1, double span = 1) {
  P p;
  p.span = span;
  p.c[0] = factor;
  for (const double root : roots) {
    p.c[++p.degree] = 0;
    for (int n = p.degree; n > 0; --n) p.c[n] = p.c[n - 1] - root * p.c[n];
    p.c[0] *= -root;
  }
  return p;
}

void arithmetic() {
  const P p = with_zeros({0.25, 2}, 4, 0.5);  // 4 (σ − 1/4) (σ − 2), σ = 2 τ
  expect(p.at(0.25) == 4 * 0.25 * -1.5, "a value is that of the part of the step");
  expect(near(p.derivative().at(0.25), 4 * 2 * (2 * 0.5 - 2.25), 1e-15), "a rate is per second");
  const pd::Line<double> line{3, -2};
  const P sum = p + 2.0 * p;
  P shifted = p, straight;
  straight.span = p.span;
  straight += line;
  shifted += line;
  const P product = straight * p;
  expect(near(sum.at(0.1), 3 * p.at(0.1), 4e-15) && near(shifted.at(0.1), p.at(0.1) + 2.8, 4e-15) &&
             near(product.at(0.1), p.at(0.1) * 2.8, 4e-15) && product.degree == 3,
         "sums and products have the values of their parts");
  expect(p.size() == 2 + 9 + 4, "the sizes of its coefficients bound it");
}

void encloses() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  bool inside = true, ends = true, halves = true, lowest = true;
  for (int i = 0; i < 200; ++i) {
    P p;
    p.degree = i % 12 + 1;
    for (int n = 0; n <= p.degree; ++n) p.c[n] = draw(random);
    const auto b = pd::detail::bernstein(p.c, p.degree);
    ends = ends && b[0] == p.c[0] && near(b[p.degree], p.at(1), 1e-14);
    const auto [least, most] = std::minmax_element(b.begin(), b.begin() + p.degree + 1);
    double dips = p.at(0);
    for (double s = 0; s <= 1; s += 1.0 / 512) {
      const double value = p.at(s);
      inside = inside && value >= *least - 1e-14 && value <= *most + 1e-14 &&
               std::abs(value) <= pd::detail::largest_size(p) + 1e-14;
      dips = std::min(dips, value);
    }
    auto upper = b, lower = b;
    pd::detail::halve(upper, lower, p.degree);
    halves = halves && near(upper[0], p.at(0.5), 1e-14) && lower[p.degree] == upper[0];
    const double bound = pd::detail::lowest(p, 1e-3);
    const bool says = bound < -1e-3;
    lowest = lowest && (says ? dips <= -0.99e-3 : dips >= -1e-3);
  }
  expect(ends, "the first and the last Bernstein coefficient are the values at both ends");
  expect(inside, "... and all of them enclose the values between");
  expect(halves, "halving meets the value in the middle");
  expect(lowest, "a dip below zero is found where there is one, and only there");
  expect(pd::detail::lowest(with_zeros({0.4, 0.6}, 10), 1e-6) <= -0.099,
         "a dip between two positive ends is found");
}

std::vector<double> changes(const P& p, int side) {
  std::vector<double> found;
  pd::detail::sign_changes(p, side, [&](double tau) {
    found.push_back(tau);
    return true;
  });
  return found;
}

void zeros() {
  const std::vector<double> roots{0.1, 0.1001, 0.35, 0.7, 0.999};
  const auto found = changes(with_zeros(roots, 1, 2), -1);
  bool right = found.size() == roots.size();
  for (std::size_t i = 0; right && i < roots.size(); ++i)
    right = near(found[i], 2 * roots[i], 1e-12);
  expect(right, "each change of sign is found, in order, two of them close to each other");
  expect(changes(with_zeros({0.3, 0.3}), 1).empty(), "a touch is none");
  expect(changes(with_zeros({-0.2, 1.3}), -1).empty(), "what lies outside of the step is none");
  expect(changes(with_zeros({0.0, 0.5}, -1), 1).size() == 1,
         "a start at zero is left to the side that is given, and is none");
  expect(pd::detail::first_zero(with_zeros({0.25, 0.75}, 1, 4)) == 1, "the first zero of a guard");
  expect(
      near(pd::detail::first_zero(with_zeros({0.500001, -0.7, -0.7, -0.7}, -1)), 0.500001, 1e-15),
      "and so it is close to the middle of a step, where iterations begin");
  expect(std::isinf(pd::detail::first_zero(with_zeros({1.5}, -1))),
         "... is never where it stays positive");
}

void derivative_of_zero() {
  using D = pd::Dual<double>;
  pd::detail::Polynomial<D> p;  // a − σ², whose zero √a moves by 1/(2 √a)
  p.degree = 2;
  p.c[0] = D(0.25, 1);
  p.c[2] = D(-1);
  const D root = pd::detail::first_zero(p);
  expect(near(root.value, 0.5, 1e-15) && near(root.slope, 1, 1e-14),
         "a zero moves with the coefficients");
}

/// A geometric series: sums of its coefficients, and of the terms of its square beyond the last order.
void series_products() {
  constexpr int N = pd::detail::series_order;
  std::array<double, N + 2> c{};
  for (int n = 0; n <= N; ++n) c[n] = std::pow(0.5, n);
  const auto sums = pd::detail::sums_of(c);
  expect(near(sums[0], 2, 1e-7) && sums[N] == std::pow(0.5, N),
         "the sizes of the coefficients are summed from each on");
  double beyond = 0;
  for (int i = 0; i <= N; ++i)
    for (int j = 0; j <= N; ++j)
      if (i + j > N) beyond += c[i] * c[j];
  expect(near(pd::detail::beyond(sums, sums) / beyond, 1, 1e-12),
         "a product comes to what its terms beyond the order add up to");
  P p;
  p.degree = N;
  p.span = 2;
  for (int n = 0; n <= N; ++n) p.c[n] = c[n];
  P part = p;
  part.rescale(pd::detail::powers_of(0.25));
  expect(part.span == 0.5 && near(part.at(0.3), p.at(0.3), 1e-15), "a part of a step is a step");
}

}  // namespace

int main() {
  arithmetic();
  encloses();
  zeros();
  derivative_of_zero();
  series_products();
  return check::status();
}
