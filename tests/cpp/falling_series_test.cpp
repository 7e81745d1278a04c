// The series of falling friction beside the functions themselves: within the bound of their error, which is
// not much larger than the error, and below the bound of the slope.
#include "pindrive/series/falling_series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using Shape = pd::FallingShape;

namespace {

int failures = 0;

void expect(bool holds, const char* what, double found) {
  if (holds) return;
  ++failures;
  std::printf("%s: %.17g\n", what, found);
}

long double exact(const pd::FallingFriction<double>& law, long double speed) {
  const long double s = speed / law.velocity;
  if (law.shape == Shape::exponential) return law.excess * std::exp(-s);
  return law.excess * (law.shape == Shape::gaussian ? std::exp(-s * s) : 1 / (1 + s * s));
}

/// A speed along a step: random coefficients that fall by a factor from order to order.
pd::detail::Polynomial<double> speed_of(std::mt19937& random, double start, double change,
                                        double ratio) {
  std::uniform_real_distribution<double> any(-1, 1);
  pd::detail::Polynomial<double> speed;
  speed.degree = pd::detail::series_order;
  speed.c[0] = start;
  for (int n = 1; n <= speed.degree; ++n, change *= ratio) speed.c[n] = change * any(random);
  return speed;
}

void within_bounds() {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> part(0, 1);
  int tight = 0, known = 0;
  for (const Shape shape : {Shape::exponential, Shape::gaussian, Shape::rational})
    for (int i = 0; i < 300; ++i) {
      const pd::FallingFriction<double> law{shape, 0.02, 0.01};
      const double change = 0.02 * part(random) * part(random);
      const auto speed = speed_of(random, 0.05 * part(random), change, 0.2 * part(random));
      pd::detail::FallingSeries<double> series;
      series.begin(law, 1);
      for (int n = 0; n <= pd::detail::series_order; ++n) series.extend(law, speed.c, 1.0, n);
      const auto sums = pd::detail::sums_of(speed.c);
      const auto [parts, steep, bound] = series.bounds(law, sums, 0);
      expect(parts[0] >= std::abs(series.friction().at(0.5)), "friction beyond its sum", parts[0]);
      double most = 0;
      for (int k = 0; k <= 16; ++k) {
        const double r = speed.at(k / 16.0);
        const double error = std::abs(
            static_cast<double>(series.friction().at(k / 16.0) - exact(law, speed.at(k / 16.0))));
        most = std::max(most, error);
        expect(error <= bound + 1e-16, "error beyond its bound", error - bound);
        if (bound < 1e-16 && r >= 0)
          expect(std::abs(law.slope(r)) <= steep * (1 + 1e-12), "steeper", law.slope(r) / steep);
      }
      known += bound < 1e-14 * law.excess;
      tight += bound < 1e-14 * law.excess || bound < 1e3 * most;
    }
  expect(known > 300, "bounds at rounding", known);
  expect(tight > 700, "bounds near the error", tight);
}

/// First and second derivatives beside differences, and that of a dual number.
void derivatives() {
  const double h = 1e-5;
  for (const Shape shape : {Shape::exponential, Shape::gaussian, Shape::rational})
    for (const double speed : {0.001, 0.007, 0.02, 0.05}) {
      const pd::FallingFriction<double> law{shape, 2.0, 0.01};
      const double slope = (law.at(speed + h) - law.at(speed - h)) / (2 * h);
      const double bend = (law.slope(speed + h) - law.slope(speed - h)) / (2 * h);
      expect(std::abs(law.slope(speed) - slope) < 1e-3, "slope", law.slope(speed) - slope);
      expect(std::abs(law.curvature(speed) - bend) < 1, "curvature", law.curvature(speed) - bend);
      using D = pd::Dual<double>;
      const pd::FallingFriction<D> along{shape, D(2.0), D(0.01)};
      const double dual = along.at(D(speed, 1)).slope;
      expect(std::abs(dual - law.slope(speed)) < 1e-12, "dual", dual);
    }
}

/// A law that underflows at the begin of a step loses all orders: the bound is the largest value of the law.
void underflows() {
  for (const Shape shape : {Shape::exponential, Shape::gaussian}) {
    const pd::FallingFriction<double> law{shape, 0.02, shape == Shape::gaussian ? 1e-3 : 3e-5};
    pd::detail::Polynomial<double> speed;
    speed.degree = pd::detail::series_order;
    speed.c[0] = 0.03;
    for (const double slows_by : {0.03, 0.02, 1e-3}) {
      speed.c[1] = -slows_by;
      pd::detail::FallingSeries<double> series;
      series.begin(law, 1);
      for (int n = 0; n <= pd::detail::series_order; ++n) series.extend(law, speed.c, 1.0, n);
      const double bound = series.bounds(law, pd::detail::sums_of(speed.c), 0).error;
      const auto missed = static_cast<double>(exact(law, 0.03L - slows_by));
      expect(series.friction().size() == 0 && bound >= 0.999 * missed, "an underflow is no error",
             bound);
      if (slows_by == 1e-3) expect(bound < 1e-200, "an error where a law remains zero", bound);
    }
  }
}

}  // namespace

int main() {
  underflows();
  within_bounds();
  derivatives();
  return failures == 0 ? 0 : 1;
}
