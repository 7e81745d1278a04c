// Quantities at given times: equal in a list and one by one, and of a stepper equal to those of the motion.
#include "pindrive/motion/sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::Sampled;

int main() {
  // A compliant finger and elastic stops, which the pin meets.
  pd::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.030}, {0.005, 0.008, 300.0}};
  drive.stops = {1.2e-3, 5e3, 0.2};
  const pd::Inputs<double> release{0.10, 1.0e-3, 0.10, 0.1};
  std::vector<pd::Segment<double>> segments;
  const auto outcome =
      pd::simulate(drive, release, [&](const auto& segment) { segments.push_back(segment); });
  const pd::Motion<double> motion(drive, release, segments.data(), segments.size(), outcome);

  const Sampled all[] = {Sampled::position,     Sampled::velocity,      Sampled::acceleration,
                         Sampled::plate_force,  Sampled::finger_force,  Sampled::stretch,
                         Sampled::stretch_rate, Sampled::housing_force, Sampled::stop_force};
  std::vector<double> times;
  for (int i = 0; i <= 400; ++i) times.push_back(0.1 * i / 400);
  bool same = true, balanced = true, in_order = true;
  std::size_t visits = 0;
  double pushed = 0;
  pd::sample<double>(motion, times.data(), times.size(), pd::Side::right, all, pd::sampled_count,
                     [&](std::size_t i, const double* values) {
                       in_order = in_order && i == visits++;
                       const auto [segment, tau] = motion.locate(times[i], pd::Side::right);
                       for (std::size_t k = 0; k < pd::sampled_count; ++k)
                         same = same && values[k] == pd::sampled_in(motion, *segment, tau, all[k]);
                       std::array<double, pd::sampled_count> at;
                       std::copy_n(values, at.size(), at.begin());
                       const auto [x, v, a, plate, finger, stretch, rate, housing, stop] = at;
                       const double balance = drive.mass * a + drive.damping * v +
                                              drive.stiffness * x - plate - finger - stop;
                       balanced = balanced && std::abs(balance) < 1e-12 &&
                                  near(housing, plate - drive.mass * a, 1e-12) &&
                                  near(stretch, -finger / drive.finger.stiffness, 1e-15) &&
                                  std::isfinite(rate);
                       pushed = std::max(pushed, std::abs(stop));
                     });
  expect(in_order && visits == times.size(), "each time is visited once, in order");
  expect(same, "a quantity in a list is that of its segment");
  expect(balanced && pushed > 0, "the forces balance, at the stops too");

  std::size_t few = 0;
  pd::sample<double>(motion, times.data(), times.size(), pd::Side::right, all, 1,
                     [&](std::size_t, const double*) { return ++few < 3; });
  expect(few == 3, "a visitor ends the sampling");

  pd::Stepper<double> stepper(drive, release);
  bool follows = true;
  for (const double time : {0.0, 0.003, 0.011, 0.05}) {
    stepper.step(time);
    const auto [segment, tau] = motion.locate(time, pd::Side::right);
    for (const Sampled quantity : all)
      follows = follows && near(pd::sampled_now(stepper, quantity),
                                pd::sampled_in(motion, *segment, tau, quantity), 1e-12);
  }
  expect(follows, "a stepper has the values of the motion");
  const auto& first = segments[0];
  expect(pd::start_acceleration(motion, first) ==
             pd::sampled_in(motion, first, 0.0, Sampled::acceleration),
         "a segment starts with its acceleration");
  expect(std::isnan(pd::acceleration_bound(motion, first)), "a closed form needs no bound");
  return check::status();
}
