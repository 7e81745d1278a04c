// Inputs along a step of a series: coefficients, products and bounds, of lines and of functions.
#include "pindrive/series/series_inputs.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using Series = pd::detail::InputSeries<double>;
using Polynomial = pd::detail::Polynomial<double>;

namespace {

constexpr int N = pd::detail::series_order;

void lines() {
  Series line(pd::Curve<double>{3, -2}, 0.5);
  expect(line[0] == 3 && line[1] == -1 && line[2] == 0 && line.degree() == 1,
         "a line has two coefficients");
  expect(line.most() == 3 && line.change() == 1 && line.missed() == 0, "... which bound it");
  Polynomial p;
  p.c[0] = 1;
  p.c[1] = 4;
  expect(line.times(p.c, 0) == 3 && line.times(p.c, 1) == 11 && line.times(p.c, 2) == -4,
         "a product has the orders of the product");
  line.rescale(pd::detail::powers_of(0.5));
  expect(line[1] == -0.5 && line.rate(0) == -2 && line.rate(1) == 0, "a part has the same rate");
}

void functions() {
  const pd::InputTerm<double> term{0.4, 0.1, 3, 20};
  const pd::InputPiece<double> piece{0, {1, 0, 5}, &term, 1};
  const pd::Curve<double> curve(piece, 0.02);
  const double h = 0.09;
  Series series(curve, h);
  double sum = 0, rate = 0;
  for (int n = 0; n <= N; ++n) {
    sum += series[n];
    rate += series.rate(n);
  }
  expect(std::abs(sum - piece.at(0.02 + h)) <= series.missed() + 4e-16,
         "a function has the values of its series");
  expect(std::abs(rate - curve.rate_at(h)) <= series.missed_rate() + 1e-14, "... and its rate");
  expect(series.missed() < 1e-16, "... within rounding over the longest step of an input");
  bool within = true;
  for (double tau = 0; tau <= h; tau += h / 64)
    within = within && std::abs(curve.at(tau)) <= series.most() &&
             std::abs(curve.at(tau) - curve.value) <= series.change();
  expect(within, "its bounds hold");
  const Polynomial p = pd::detail::polynomial_of(curve, h);
  expect(p.degree == N && std::abs(p.at(h / 3) - curve.at(h / 3)) < 1e-15,
         "a polynomial of an input has its values");
  const pd::detail::Sums<double> ones = pd::detail::sums_of(Polynomial{{1, 1}, 1, 1}.c);
  double tail = 0;
  for (int n = N - 1; n <= N; ++n) tail += std::abs(series[n]);
  expect(series.beyond(ones) >= tail, "the terms that a product drops are bounded");
}

}  // namespace

int main() {
  lines();
  functions();
  return check::status();
}
