// A motion that is kept: its quantities at any time, on both sides of an event, and the range of a position.
#include "pindrive/bodies/stored_motion.hpp"

#include <cmath>

#include "check.hpp"

namespace bodies = pindrive::bodies;
using check::expect;

int main() {
  // A box that slides from 3 m/s to rest in 1.5 s, and a mass that swings freely.
  bodies::System<double> system;
  system.bodies = {{2.0}, {1.0}};
  system.links.push_back({1, bodies::ground, 4.0});
  system.contacts = {{0, bodies::ground, 4.0, 5.0}};
  bodies::Following<double> following(system, {0, {0, 0.5}, {3, 0}, {0}});
  bodies::StoredMotion<double> motion(system);
  following.advance(4.0, [&](const bodies::Step<double>& step) { motion.add(step); });
  expect(following.status() == pindrive::Status::ok && motion.steps() > 3, "a motion is kept");
  expect(motion.end() == 4.0, "to its end");

  bodies::Quantities<double> at;
  motion.at(1.0, true, at);
  expect(std::abs(at.position[0] - 2.0) < 1e-15 && std::abs(at.velocity[0] - 1.0) < 1e-15,
         "the box slides as its formula has it");
  expect(std::abs(at.position[1] - 0.5 * std::cos(2.0)) < 1e-15, "and so swings the mass");
  expect(at.friction[0] == -4.0 && at.slip[0] == bodies::Slip::forward, "under kinetic friction");
  const double event = following.changes()[0].time;
  motion.at(event, false, at);
  expect(std::abs(at.acceleration[0] + 2.0) < 1e-14, "an event has a side before");
  motion.at(event, true, at);
  expect(at.acceleration[0] == 0.0 && at.slip[0] == bodies::Slip::stick, "and one after");

  const auto [least, largest] = motion.range(1);
  expect(std::abs(least + 0.5) < 1e-15 && std::abs(largest - 0.5) < 1e-15,
         "a position has a range");
  expect(std::abs(motion.range(0).second - 2.25) < 1e-15, "that ends where the box rests");
  return check::status();
}
