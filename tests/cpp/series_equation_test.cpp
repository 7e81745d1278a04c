// The equation of a mode without a closed form at a later time, and its start from a load of zero.
#include "pindrive/series/series_equation.hpp"

#include <array>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

void later() {
  pd::detail::SeriesEquation<double> e{0.01, 0.4, 100};
  e.force = {1, 2};
  e.plate_velocity = {3, 4};
  e.load = {5, 6};
  e.across = {7, 8};
  e.surface = {9, 10};
  e.plate_force = 0.02;
  const auto f = e.from(0.5);
  expect(f.force.value == 2 && f.plate_velocity.value == 5 && f.load.value == 8 &&
             f.across.value == 11 && f.surface.value == 14,
         "what is given over time goes on from its value at the later time");
  expect(f.force.rate == 2 && f.plate_velocity.rate == 4 && f.load.rate == 6 &&
             f.across.rate == 8 && f.surface.rate == 10,
         "... at its rate");
  expect(f.mass == 0.01 && f.damping == 0.4 && f.stiffness == 100 && f.plate_force == 0.02,
         "... and the constants stay");
}

/// (f y)' = K x' − D y − E, without damping, with f = 2 τ, K = D = 7 and E = 3, of a pin of x' = 5 + 4 τ.
void grows_from_nothing() {
  pd::detail::SeriesEquation<double> e{0.01, 0.4, 100};
  e.skin_factor = {0, 2};
  e.skin_stiffness = e.skin_decay = 7;
  e.skin_drift = 3;
  const std::array<double, 3> v{5, 4, 0};
  std::array<double, 3> y{0.1, 0, 0};
  for (int n = 0; n < 2; ++n) e.follow(y, v, n, 1.0, n == 0 ? 3.0 : 0.0);
  expect(y[0] == (7.0 * 5 - 3) / (7 + 2), "skin begins with its one velocity that stays finite");
  expect(y[1] == 7.0 * 4 / (7 + 4), "... and goes on from there");
}

}  // namespace

int main() {
  later();
  grows_from_nothing();
  return check::status();
}
