// Sums of a polynomial and damped sinusoids: values, derivatives, Taylor polynomials and their reach.
#include "pindrive/series/term_sum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using Sum = pd::detail::TermSum<double>;

namespace {

double direct(double t) {
  return 1 + 2 * t - 3 * t * t +
         std::exp(-4 * t) * (0.3 * std::cos(7 * t) - 0.2 * std::sin(7 * t)) +
         0.1 * std::exp(-200 * t);
}
Sum example() {
  static const std::array<pd::InputTerm<double>, 2> terms{{{0.3, -0.2, 4, 7}, {0.1, 0, 200, 0}}};
  static const pd::InputPiece<double> piece{0, {1, 2, -3}, terms.data(), terms.size()};
  return pd::Curve<double>(piece, 0.0);
}

void values() {
  const Sum sum = example(), rate = sum.derivative(), twice = sum + sum;
  double worst = 0;
  for (const double t : {0.0, 0.01, 0.3, 2.0}) {
    const double h = 1e-4;
    worst = std::max({worst, std::abs(sum.at(t) - direct(t)), std::abs(twice.at(t) - 2 * direct(t)),
                      std::abs((-2.0 * sum).at(t) + 2 * direct(t))});
    const double slope = (direct(t + h) - direct(t - h)) / (2 * h);
    expect(std::abs(rate.at(t) - slope) < 2e-3, "a sum has its derivative");
    expect(sum.size(t) >= std::abs(direct(t)), "... and its bound");
  }
  expect(worst < 1e-14, "... and its values");
  expect(twice.end() - twice.begin() == 2, "terms of one rate are one term");
  expect(Sum(pd::Line<double>{3, 0}).constant() && !sum.constant(), "a constant is known as such");
  expect(sum.hurry_squared() == 4e4, "the fastest rate is known");
}

void steps() {
  const Sum sum = example();
  double worst = 0, end = 0;
  int count = 0;
  pd::detail::each_step(
      0.0, 2.0, [&](double t) { return sum.from(t).reach(); },
      [&](double t, double next) {
        const double length = next - t;
        const auto p = sum.from(t).expanded(length);
        for (const double part : {0.0, 0.4, 1.0})
          worst = std::max(worst, std::abs(p.at(part * length) - direct(t + part * length)));
        expect(t == end, "steps follow each other");
        end = next;
        ++count;
        return true;
      });
  expect(worst < 1e-14, "a Taylor polynomial has the values of the sum within its reach");
  expect(end == 2 && count < 25, "steps become long as a fast term dies away");
  expect(sum.reach() < 0.02 && sum.from(1).reach() > 0.2, "... and no longer counts");
}

/// Lower bounds over parts of two seconds, long and short, beside the lowest of many values.
void bounds() {
  static const std::array<pd::InputTerm<double>, 4> terms{
      {{0.3, -0.2, 4, 7}, {0.1, 0, 200, 0}, {0.02, 0.03, -1.5, 300}, {-0.4, 0, 3, 0}}};
  static const pd::InputPiece<double> piece{0, {1, 2, -3, 1, 0.5}, terms.data(), terms.size()};
  const Sum sum = pd::Curve<double>(piece, 0.0);
  double spare = 0;
  for (double length = 2; length > 5e-4; length /= 2)
    for (double begin = 0; begin < 2; begin += length) {
      double lowest = sum.at(begin);
      for (int i = 1; i <= 64; ++i) lowest = std::min(lowest, sum.at(begin + i * length / 64));
      const double least = sum.from(begin).least(length);
      expect(least <= lowest, "a sum does not fall below its lower bound");
      if (length < 1e-3) spare = std::max(spare, lowest - least);
    }
  expect(spare < 0.02, "... which is close over a short time");
}

}  // namespace

int main() {
  values();
  bounds();
  steps();
  return check::status();
}
