// Bounds of the rates of free motions: of an oscillator, of what does not hold a body, and of skin that has settled.
#include "pindrive/bodies/free_rates.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "check.hpp"
#include "pindrive/bodies/follow.hpp"
#include "pindrive/bodies/step_certificate.hpp"

namespace pd = pindrive;
namespace bodies = pd::bodies;
using bodies::Slip;
using check::expect;

int main() {
  bodies::System<double> system;
  system.bodies = {{0.5}};
  system.links = {{0, bodies::ground, 200, 3}};
  const auto never = [](std::size_t) { return false; };
  {
    pd::detail::FreeRates<double> rates(system);
    const double bound = 3 + std::sqrt(9 + 400);
    expect(std::abs(rates.largest() - bound) < 1e-12,
           "an oscillator has the bound of its equation");
    expect(rates.in({}, never) == rates.largest(), "in its only mode");
  }
  system.contacts = {{0, bodies::ground, 0.02, 0.02, 9000, 0.3}};
  system.stops = {{0, bodies::ground, 1, 1, 1e5}};
  pd::detail::FreeRates<double> rates(system);
  const double stick = rates.in({Slip::stick, Slip::backward}, never);
  const double slip = rates.in({Slip::forward, Slip::backward}, never);
  const double settled =
      rates.in({Slip::forward, Slip::backward}, [](std::size_t) { return true; });
  expect(stick > 100 && stick < 200, "skin that sticks is a spring");
  expect(std::abs(slip - 30'000) < 1e-9, "skin that slips has its own rate");
  expect(settled < 25, "until it has settled");
  expect(rates.in({Slip::forward, Slip::stick}, never) >= slip && rates.largest() >= slip,
         "a stop holds the body where it pushes");

  // Skin of 30 000 per second slips for 20 ms: some steps until it has settled, and few more.
  system.bodies[0].force = 1.5;
  bodies::Following<double> following(system, {0, {0}, {0}, {0}});
  bodies::StepCertificate<double> certificate(system);
  long after = 0;
  following.advance(0.02, [&](const bodies::Step<double>& step) {
    certificate.add(step);
    after += step.begin() > 5e-3;
  });
  std::printf("# %ld steps, of them %ld after 5 ms\n", following.steps(), after);
  expect(following.status() == pd::Status::ok && after <= 1, "few steps follow settled skin");
  expect(certificate.violations().worst() < 1e-12, "whose motion keeps its laws");
  return check::status();
}
