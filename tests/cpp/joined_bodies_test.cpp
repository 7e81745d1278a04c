// Bodies that stick together: accelerations, and friction forces also where they are not unique.
#include "pindrive/bodies/joined_bodies.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"

namespace bodies = pindrive::bodies;
using check::expect;
using Joined = pindrive::detail::JoinedBodies<double>;

namespace {

bool near(double one, double other) { return check::near(one, other, 1e-14); }

/// A hand of 2 kg with two pins of 1 and 3 kg.
bodies::System<double> hand_and_pins() {
  bodies::System<double> system;
  system.bodies = {{2}, {1}, {3}};
  for (const int pin : {1, 2}) {
    system.contacts.push_back({pin, 0, 1, 1});
    system.contacts.push_back({pin, bodies::ground, 1, 1});
  }
  return system;
}

struct Share {
  int contact;
  double limit;
};
Joined joined_by(const bodies::System<double>& system, const std::vector<Share>& shares) {
  Joined joined(system);
  for (const Share& share : shares) joined.add(share.contact, share.limit);
  joined.join();
  return joined;
}

void a_free_group() {
  const auto system = hand_and_pins();
  const Joined joined = joined_by(system, {{0, 1}, {2, 1}});
  Joined::Order<double> order(3, 4);
  order.force = {12, 0, 0};
  order.surface = {0, 0, 0.5, 0};
  joined.solve(order);
  // Pin 2 gains 0.5 on the others: 2 a + a + 3 (a + 0.5) = 12.
  expect(near(order.acceleration[0], 1.75) && near(order.acceleration[1], 1.75) &&
             near(order.acceleration[2], 2.25),
         "a group moves by the sum of its forces");
  expect(near(order.friction[0], 1.75) && near(order.friction[2], 6.75),
         "friction gives each body what it needs");
}

void a_group_on_the_ground() {
  const auto system = hand_and_pins();
  const Joined joined = joined_by(system, {{0, 1}, {1, 3}});
  Joined::Order<double> order(3, 4);
  order.force = {6, 2, 9};
  joined.solve(order);
  expect(near(order.acceleration[0], 0) && near(order.acceleration[1], 0) &&
             near(order.acceleration[2], 3),
         "a group with the ground rests, another body is free");
  expect(near(order.friction[0], 6) && near(order.friction[1], -8), "the ground holds them all");
}

void friction_that_is_not_unique() {
  bodies::System<double> system;
  system.bodies = {{1}};
  for (int i = 0; i < 2; ++i) system.contacts.push_back({0, bodies::ground, 1, 1});
  const Joined joined = joined_by(system, {{0, 1}, {1, 3}});
  Joined::Order<double> order(1, 2);
  order.force = {-2};
  joined.solve(order);
  expect(near(order.friction[0], 0.5) && near(order.friction[1], 1.5),
         "two contacts share it in proportion to static friction");
}

}  // namespace

int main() {
  a_free_group();
  a_group_on_the_ground();
  friction_that_is_not_unique();
  return check::status();
}
