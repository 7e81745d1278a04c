// What a system of bodies is made of, and when its inputs change.
#include "pindrive/bodies/system.hpp"

#include "check.hpp"

namespace bodies = pindrive::bodies;
using check::expect;

int main() {
  bodies::System<double> system;
  system.bodies = {{0.5}, {0.001}};
  system.links.push_back({1, 0, 250, 0.5});
  const bodies::Contact<double> plate{1, bodies::ground, 0.02, 0.03};
  system.contacts.push_back(plate);
  constexpr double never = std::numeric_limits<double>::infinity();
  expect(plate.rigid() && system.next_breakpoint(0) == never, "a contact without skin is rigid");
  const double times[] = {0.1, 0.3}, values[] = {1, 2}, earlier[] = {0.2, 0.4};
  system.contacts[0].load = {times, values, 2};
  system.links[0].length = {earlier, values, 2};
  expect(system.next_breakpoint(0) == 0.1 && system.next_breakpoint(0.1) == 0.2 &&
             system.next_breakpoint(0.3) == 0.4 && system.next_breakpoint(0.4) == never,
         "the next row of any input is known");
  return check::status();
}
