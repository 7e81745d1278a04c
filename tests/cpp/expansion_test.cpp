// Series of a system: an oscillator, skin that sticks and slips, and a body on a plate that accelerates.
#include "pindrive/bodies/expansion.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/bodies/uncertain.hpp"

namespace bodies = pindrive::bodies;
namespace pd = pindrive;
using bodies::Slip;
using check::expect;

namespace {

template <class Series>
double end_of(const Series& series) {
  double sum = 0;
  for (int n = pd::detail::series_order; n >= 0; --n) sum += series[n];
  return sum;
}

/// Expands a system in a mode from a state on.
template <class Series>
void expand(Series& series, const bodies::System<double>& system, const std::vector<Slip>& mode,
            const bodies::State<double>& state, double step, int order) {
  pindrive::detail::InputsAt<double> inputs;
  inputs.read(system, state.time);
  series.set(mode, inputs);
  series.read(inputs, state.time, step, order);
  series.expand(state, inputs, order);
}

void an_oscillator() {
  bodies::System<double> system;
  system.bodies = {{0.01}};
  system.links.push_back({0, bodies::ground, 100, 0});
  pd::detail::Expansion<double> series(system);
  expand(series, system, {}, {0, {1e-3}, {0}, {}}, 0.02, pd::detail::series_order);
  expect(check::near(end_of(series.position(0)), 1e-3 * std::cos(2.0), 1e-15),
         "a mass on a spring swings");
}

void skin() {
  bodies::System<double> system;
  system.bodies = {{1e6}};  // hardly moved by the skin
  bodies::Contact<double> finger{0, bodies::ground, 0.03, 0.05};
  finger.stiffness = 300;
  finger.damping = 0.3;
  system.contacts = {finger};
  pd::detail::Expansion<double> series(system);
  const bodies::State<double> state{0, {0}, {0.06}, {2e-5}};
  expand(series, system, {Slip::stick}, state, 1e-3, pd::detail::series_order);
  expect(check::near(end_of(series.stretch(0)), 8e-5, 1e-12) && end_of(series.sliding(0)) == 0,
         "skin that sticks stretches with the body");
  expect(check::near(series.friction(0)[0], -(300 * 2e-5 + 0.3 * 0.06), 1e-15),
         "and pulls by spring and damper");
  expand(series, system, {Slip::forward}, state, 1e-3, pd::detail::series_order);
  expect(check::near(end_of(series.stretch(0)), 1e-4 - 8e-5 * std::exp(-1.0), 1e-15),
         "skin that slips relaxes to kinetic friction over stiffness");
  expect(check::near(series.sliding(0)[0], 0.06 - 0.08, 1e-14) && series.friction(0)[0] == -0.03,
         "while its slider has a speed of its own");
}

void a_plate_that_accelerates() {
  bodies::System<double> system;
  system.bodies = {{0.01}};
  system.links.push_back({0, bodies::ground, 100, 0.4});
  const double times[] = {0, 1}, velocities[] = {0.1, 2.1};
  bodies::Contact<double> plate{0, bodies::ground, 1, 1};
  plate.velocity = {times, velocities, 2};
  system.contacts = {plate};
  using Number = pd::detail::Uncertain<double>;
  pd::detail::Expansion<double, Number> series(system);
  expand(series, system, {Slip::stick}, {0, {1e-3}, {0.1}, {0}}, 0.01, 8);
  expect(check::near(series.velocity(0)[1].value, 0.02, 1e-15) &&
             std::abs(series.sliding(0)[1].value) <= series.sliding(0)[1].radius,
         "a body on a plate moves as the plate");
  expect(check::near(series.friction(0)[0].value, 0.01 * 2 + 100 * 1e-3 + 0.4 * 0.1, 1e-15),
         "which pushes it");
}

}  // namespace

int main() {
  an_oscillator();
  skin();
  a_plate_that_accelerates();
  return check::status();
}
