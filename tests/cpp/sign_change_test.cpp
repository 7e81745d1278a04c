// Sign change of a function: the first number at which it is not negative, next to one at which it is.
#include "pindrive/device/sign_change.hpp"

#include <cmath>
#include <random>

#include "check.hpp"

using check::expect;
using pindrive::device::sign_change;

namespace {

void neighbours_have_different_signs() {
  std::mt19937_64 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int wrong = 0, most = 0;
  for (int i = 0; i < 20000; ++i) {
    const double root = between(-1, 1), a = std::exp(between(-20, 20)), b = between(0, 5);
    int calls = 0;
    const auto f = [&](double x) {
      ++calls;
      const double d = x - root;
      return a * (d + b * d * d * d);
    };
    const double found = sign_change(f, -2.0, 1.5);
    most = std::max(most, calls);
    const bool changes = f(found) >= 0 && f(std::nextafter(found, -3)) < 0;
    wrong += !changes;
  }
  expect(wrong == 0, "no number in between");
  expect(most < 90, "within a few steps");
}

void ends() {
  expect(sign_change([](double) { return 1.0; }, 2.0, 3.0) == 2.0, "not negative at the begin");
  expect(sign_change([](double) { return -1e-300; }, 2.0, 3.0) == 3.0,
         "an end that is negative to rounding counts as the change");
  const double steep = sign_change([](double x) { return x < 0.3 ? -1.0 : 1e300; }, 0.0, 1.0);
  expect(steep == 0.3, "a jump is found");
}

}  // namespace

int main() {
  neighbours_have_different_signs();
  ends();
  return check::status();
}
