// Balance of a pin in creep: friction at the found direction balances the other forces, and the estimated length of a
// step follows the inputs.
#include "pindrive/series/creep_balance.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using Balance = pd::detail::CreepBalance<double>;
using Equation = pd::detail::SeriesEquation<double>;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// A pin at full pull under a hand of 60 mm/s.
Equation pulled() {
  Equation e{0.01, 0.64, 100.0};
  e.force = {-0.02, 0};
  e.plate_velocity = {0.06, 0};
  e.across = {0.01, 0};
  e.plate_force = 0.697;
  return e;
}

/// Sum of all forces at x and x' = v_p + w t, with friction along its sliding direction, N.
double forces(const Equation& e, double x, double t, double acceleration) {
  const double w = e.across.value, root = std::sqrt(1 + t * t);
  const double falling = e.plate_falling.present() ? e.plate_falling.at(w * root) : 0;
  const double friction =
      e.load.value * ((e.plate_force + falling) * t / root + e.plate_slope * w * t);
  return e.force.value - e.stiffness * x - e.damping * (e.plate_velocity.value + w * t) - friction -
         e.mass * acceleration;
}

void friction_balances_the_other_forces() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  bool balanced = true;
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    Equation e = pulled();
    e.across.value = 0.06 * std::pow(10, -3 + 3 * uniform(random));
    e.load.value = 1 + 0.5 * uniform(random);
    e.plate_slope = i % 3 == 0 ? 0.5 * std::abs(uniform(random)) : 0;
    if (i % 4 == 0) e.plate_falling = {pd::FallingShape::gaussian, 0.1, 0.2};
    const double x = 9e-3 * uniform(random), acceleration = 3 * uniform(random);
    Balance balance(e);
    if (!balance.solve(e, {x, 0.06}, acceleration)) continue;
    ++found;
    balanced &= std::abs(forces(e, x, balance.ratio(), acceleration)) < 1e-15;
  }
  expect(found > 600, "most pins have a direction in which friction balances");
  expect(balanced, "... all forces, to rounding");
}

void some_pins_cannot_creep() {
  const pd::detail::SeriesState<double> start{1e-3, 0.06};
  const double whole = pd::detail::creep_span(pulled(), start, never);
  expect(whole > 1e-3 && whole < 0.1, "a step of creep lasts for a part of the way to the limit");
  expect(pd::detail::creep_span(pulled(), start, 1e-4) == 1e-4, "... up to a limit");
  Equation e = pulled();
  e.across = {-0.01, 0};
  expect(pd::detail::creep_span(e, start, never) == whole, "... to either side");
  e.across = {0.01, -100};
  expect(pd::detail::creep_span(e, start, never) <= 1e-4, "... until the plate stops across");
  e = pulled();
  e.held = true;
  expect(pd::detail::creep_span(e, start, never) == 0, "a pin that is held does not creep");
  e = pulled();
  e.side = 1;
  expect(pd::detail::creep_span(e, start, never) == 0, "nor one on an aligned plate");
  e = pulled();
  e.load = {0, 0};
  expect(pd::detail::creep_span(e, start, never) == 0, "nor one without friction");
  e = pulled();
  e.damping = 0;
  expect(pd::detail::creep_span(e, {0.1, 0.06}, never) == 0, "nor one that friction cannot hold");
}

}  // namespace

int main() {
  friction_balances_the_other_forces();
  some_pins_cannot_creep();
  return check::status();
}
