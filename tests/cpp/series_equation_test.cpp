// The equation of a mode without a closed form at a later time, and how a pin sets out from a plate that
// begins to slide across.
#include "pindrive/series/series_equation.hpp"

#include <array>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

void later() {
  pd::SeriesEquation<double> e{0.01, 0.4, 100};
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

void sets_out() {
  double worst = 0;
  bool odd = true, grows = true;
  for (const double mass : {1e-3, 1.0})
    for (const double friction : {0.0, 1e-4, 1.0, 1e4})
      for (const double across : {1e-3, -1.0, 1e3}) {
        double before = 0;
        for (const double pull : {1e-6, 1e-2, 1.0, 1e3}) {
          const double p = pd::setting_out(mass, friction, across, pull);
          const double force = mass * p + friction * p / std::hypot(p, across);
          worst = std::max(worst, std::abs(force - pull) / pull);
          odd = odd && pd::setting_out(mass, friction, across, -pull) == -p;
          grows = grows && p > before;
          before = p;
        }
      }
  expect(worst < 1e-14, "the acceleration that sets out needs the force that pulls");
  expect(odd, "... to either side alike");
  expect(grows, "... and grows with the pull");
  expect(pd::setting_out(1.0, 0.5, 1.0, 0.0) == 0, "without a pull it is zero");
}

/// (f y)' = K x' − D y − E with f = 2 τ, K = D = 7 and E = 3, of a pin of x' = 5 + 4 τ.
void grows_from_nothing() {
  pd::SeriesEquation<double> e{0.01, 0.4, 100};
  e.skin_factor = {0, 2};
  e.skin_stiffness = e.skin_decay = 7;
  e.skin_drift = 3;
  const std::array<double, 3> v{5, 4, 0};
  std::array<double, 3> y{0.1, 0, 0};
  for (int n = 0; n < 2; ++n) e.follow(y, v, n, 1.0);
  expect(y[0] == (7.0 * 5 - 3) / (7 + 2), "skin begins with its one velocity that stays finite");
  expect(y[1] == 7.0 * 4 / (7 + 4), "... and goes on from there");
}

}  // namespace

int main() {
  later();
  grows_from_nothing();
  sets_out();
  return check::status();
}
