// The functions that the core calls: of a double to 2 units in the last place of the long double's answer,
// whichever branch serves the argument; of a long double the standard library's; of a dual both parts.
#include "pindrive/numbers/functions.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "cases.hpp"
#include "check.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
namespace functions = pd::detail;
using check::expect;

/// Distance of a number from a reference, in units in the last place.
double units_off(double number, long double answer) {
  const double nearest = static_cast<double>(answer);
  if (number == nearest) return 0;
  const double unit = std::nextafter(std::abs(nearest), std::numeric_limits<double>::infinity()) -
                      std::abs(nearest);
  return static_cast<double>(std::abs(static_cast<long double>(number) - answer)) / unit;
}

int main() {
  std::mt19937_64 random(20261122);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  // Of either sign, with any power of two between.
  const auto any = [&](int low, int high) {
    const double size = std::ldexp(between(1, 2), static_cast<int>(between(low, high)));
    return between(-1, 1) < 0 ? -size : size;
  };
  double worst = 0;
  const auto compare = [&](const char* name, double argument, double number, long double answer) {
    const double off = units_off(number, answer);
    if (off > worst) std::printf("%s(%.17g): %.3g units\n", name, argument, worst = off);
  };
  for (int i = 0; i < cases(200000); ++i) {
    const double x = any(-60, 9), turned = any(-40, 28), y = any(-1000, 1000), z = any(-1000, 1000);
    const long double l = x;
    compare("exp", x, functions::exp(x), std::exp(l));
    compare("expm1", x, functions::expm1(x), std::expm1(l));
    compare("log", y, functions::log(std::abs(y)), std::log(std::abs(static_cast<long double>(y))));
    compare("log1p", x, functions::log1p(std::abs(x)), std::log1p(std::abs(l)));
    compare("atan2", y, functions::atan2(y, z), std::atan2(static_cast<long double>(y), z));
    compare("hypot", y, functions::hypot(y, z), std::hypot(static_cast<long double>(y), z));
    const auto both = functions::sine_and_cosine_of(turned);
    compare("sin", turned, both.sine, std::sin(static_cast<long double>(turned)));
    compare("cos", turned, both.cosine, std::cos(static_cast<long double>(turned)));
    const auto grown = functions::exponential_and_change(x);
    compare("e^x", x, grown.value, std::exp(l));
    compare("e^x - 1", x, grown.change, std::expm1(l));
  }
  expect(worst <= 2, "each is within 2 units in the last place");

  constexpr double infinite = std::numeric_limits<double>::infinity();
  expect(functions::exp(-800.0) == 0 && functions::exp(800.0) == infinite &&
             functions::expm1(-800.0) == -1 && functions::expm1(800.0) == infinite,
         "exponentials end in 0, -1 and infinity");
  expect(functions::hypot(3e-300, 4e-300) == 5e-300 && functions::hypot(0.0, 0.0) == 0 &&
             functions::hypot(-infinite, 1.0) == infinite &&
             std::isnan(functions::hypot(1.0, std::nan(""))) &&
             std::isnan(functions::hypot(std::nan(""), 1.0)),
         "a length neither overflows nor loses what is not a number");
  bool on_circle = true;
  for (const double angle : {5e8, -3e12, 1e300}) {
    const auto [sine, cosine] = functions::sine_and_cosine_of(angle);
    on_circle = on_circle && std::abs(sine * sine + cosine * cosine - 1) < 1e-15;
  }
  expect(on_circle, "an angle beyond all phase is an angle");
  expect(functions::sin(0.5L) == std::sin(0.5L) && functions::exp(0.5F) == std::exp(0.5F),
         "other numbers have the functions of the standard library");

  using D = pd::Dual<double>;
  const D angle{0.7, 2};
  const auto turned = sine_and_cosine_of(angle);
  expect(turned.sine.value == functions::sin(0.7) && turned.sine.slope == 2 * functions::cos(0.7) &&
             turned.cosine.slope == -2 * functions::sin(0.7) && sin(angle) == turned.sine,
         "a dual carries the derivative");
  return check::status();
}
