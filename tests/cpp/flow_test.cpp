// The propagator of a mode in every damping regime: exact at the start, two steps are one, the equation of
// motion holds, zeros are zeros; and the force of a contact along a flow.
#include "pindrive/flow/flow.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

namespace {

using Oscillator = pd::Oscillator<double>;

/// Damping ratios: none, weak, nearly critical from both sides, strong, and growing.
constexpr double ratios[] = {0, 0.05, 0.7, 1 - 1e-12, 1, 1 + 1e-12, 1.2, 40, -0.1, -1.5};
constexpr double mass = 0.01, stiffness = 100, omega0 = 100;

Oscillator oscillator(double ratio) { return {mass, 2 * ratio * mass * omega0, stiffness}; }

void steps_compose() {
  bool starts = true, composes = true, obeys = true;
  for (const double ratio : ratios) {
    const Oscillator o = oscillator(ratio);
    const pd::Path<double> x{0.3e-3, 1e-3, 0.02};
    starts = starts && x.at(o, 0.0) == x.start;
    for (const double a : {1e-6, 1e-4, 3e-3, 0.02, 0.05}) {
      const double b = 0.7 * a;
      composes = composes && near(1e3 * x.at(o, a + b), 1e3 * x.from(o, a).at(o, b), 1e-12);
      const auto moved = o.after(a);
      const auto rates = x.rates(o, moved);
      const double y = x.at(moved) - x.centre();
      const double rest = rates.second - 2 * o.alpha() * rates.first + o.omega0_squared() * y;
      const double size = std::abs(rates.second) + std::abs(2 * o.alpha() * rates.first) +
                          std::abs(o.omega0_squared() * y);
      obeys = obeys && std::abs(rest) <= 1e-12 * (size + omega0 * omega0 * 1e-3);
    }
  }
  expect(starts, "at the start nothing has changed, to the bit");
  expect(composes, "two steps are one step as long as both");
  expect(obeys, "y'' = 2 alpha y' - omega0^2 y");
}

void zeros_are_zeros() {
  bool zero = true, none_before = true;
  for (const double ratio : ratios)
    for (const double slope : {-0.3, -0.05, 0.1}) {
      const Oscillator o = oscillator(ratio);
      const pd::Path<double> y{1e-3, 1e-3, slope};
      const double first = o.zeros(y.value, y.slope).first;
      const double until = std::min(first, 0.05);
      if (first < 1) zero = zero && std::abs(y.at(o, first)) <= 1e-14 * std::exp(o.alpha() * first);
      for (int i = 0; i < 100; ++i) none_before = none_before && y.at(o, until * i / 100) > 0;
    }
  expect(zero, "a free oscillation vanishes at its zeros");
  expect(none_before, "... and not before the first");
  const Oscillator o = oscillator(0.3);
  const auto turn = o.half_turn(), moved = o.after(o.half_period());
  expect(near(turn.decline, moved.decline, 1e-14) && std::abs(moved.gain) <= 1e-17,
         "half a turn is that after half a period");
}

void forces_along() {
  const Oscillator o = oscillator(0.2);
  const auto flow = pd::Flow<double>::free(o, 1e-3, 0.1, -7, 0.5e-3, 0.01);
  const pd::Force<double> force{{0.3, 2.0}, 1.5, 40, 0};
  const auto path = force.along(flow);
  bool holds = path.start == 0.3 - 1.5 * 0.1;
  for (const double t : {1e-3, 0.01, 0.04}) {
    const double x = flow.position.at(o, t) - 1e-3, v = flow.velocity.at(o, t);
    holds = holds && near(path.at(o, t), 0.3 + 2 * t - 1.5 * v - 40 * x, 1e-14);
  }
  expect(holds, "a force along a flow is constant - drag x' - stiffness (x - x0)");
  const pd::Force<double> spring{{0.3, 0.0}, 0, 40, 0};
  expect(spring.along(flow).start == 0.3, "an elastic force starts as it is, to the bit");
}

}  // namespace

int main() {
  steps_compose();
  zeros_are_zeros();
  forces_along();
  return check::status();
}
