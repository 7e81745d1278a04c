// Inputs of a system at a time: the curves of all parts, in their order.
#include "pindrive/bodies/inputs_at.hpp"

#include "check.hpp"

namespace bodies = pindrive::bodies;
using check::expect;

int main() {
  const double times[] = {0, 1}, values[] = {0, 2};
  bodies::System<double> system;
  system.bodies = {{1}, {2, {times, values, 2}}};
  system.links = {{0, 1, 100, 0, 1e-3}};
  system.contacts = {{1, bodies::ground, 0.1, 0.1}};
  system.contacts[0].velocity = 0.05;
  pindrive::detail::InputsAt<double> inputs;
  inputs.read(system, 0.5);
  expect(inputs.force[0].is_zero() && inputs.force[1].value == 1 && inputs.force[1].rate == 2,
         "forces of the bodies");
  expect(inputs.length[0].value == 1e-3, "lengths of the links");
  expect(inputs.load[0].value == 1 && inputs.surface[0].value == 0.05,
         "loads and surfaces of the contacts");
  int count = 0, steady = 0;
  inputs.each([&](const pindrive::Curve<double>& curve) {
    ++count;
    steady += curve.steady();
  });
  expect(count == 5 && steady == 4, "each input is visited once");
  return check::status();
}
