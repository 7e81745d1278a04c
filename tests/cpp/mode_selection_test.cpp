// The next mode of a system: stick where it can be, and each decision by the first coefficient beyond its error.
#include "pindrive/bodies/mode_selection.hpp"

#include <vector>

#include "check.hpp"

namespace bodies = pindrive::bodies;
using bodies::Slip;
using check::expect;
using Mode = std::vector<Slip>;

namespace {

/// A body between a plate and a finger at rest, pulled by a spring.
Mode selected(double displacement, double plate, double finger) {
  bodies::System<double> system;
  system.bodies = {{0.01}};
  system.links.push_back({0, bodies::ground, 100, 0.4});
  system.contacts = {{0, bodies::ground, plate, plate}, {0, bodies::ground, finger, finger}};
  pindrive::detail::ModeSelection<double> selection(system);
  pindrive::detail::InputsAt<double> inputs;
  inputs.read(system, 0);
  Mode mode{Slip::forward, Slip::forward};
  const bool found = selection.select({0, {displacement}, {0}, {0, 0}}, inputs, {0, 1}, 1e-3, mode);
  expect(found, "a mode is found");
  return mode;
}

}  // namespace

int main() {
  expect(selected(1e-3, 0.08, 0.03) == Mode{Slip::stick, Slip::stick}, "both hold together");
  expect(selected(2e-3, 0.08, 0.03) == Mode{Slip::backward, Slip::backward}, "or both slip");
  expect(selected(1.1e-3, 0.08, 0.03) == Mode{Slip::stick, Slip::stick},
         "a force that equals friction to rounding holds");
  expect(selected(-1.1000001e-3, 0.08, 0.03) == Mode{Slip::forward, Slip::forward},
         "one that exceeds it does not");
  return check::status();
}
