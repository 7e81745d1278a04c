// A number with its error: the true value stays within the radius through sums and products.
#include "pindrive/bodies/uncertain.hpp"

#include <cmath>
#include <random>

#include "check.hpp"

using check::expect;
using Number = pindrive::detail::Uncertain<double>;

int main() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  int outside = 0;
  double widest = 0;
  for (int i = 0; i < 2000; ++i) {
    Number sum = number(random);
    long double truth = sum.value;
    for (int k = 0; k < 40; ++k) {
      const double factor = number(random), term = number(random);
      sum = k % 3 == 0 ? factor * sum : k % 3 == 1 ? sum - Number(term) : sum / (2 + factor);
      truth = k % 3 == 0 ? factor * truth : k % 3 == 1 ? truth - term : truth / (2 + factor);
    }
    outside += std::abs(static_cast<double>(truth - sum.value)) > sum.radius;
    widest = std::max(widest, sum.radius);
  }
  expect(outside == 0, "the true value is within the radius");
  expect(widest < 1e-13, "which is a few roundings");
  const Number third = Number(1) / 3.0, none = third + third + third - Number(1);
  expect(none.may_vanish() && !third.may_vanish(), "what may be zero is known");
  return check::status();
}
