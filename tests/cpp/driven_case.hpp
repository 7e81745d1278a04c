// Random drives under random inputs, with stops and friction curves, for the tests of steps and instants.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pindrive/events/stepper.hpp"

namespace driven {

namespace pd = pindrive;

using Random = std::mt19937_64;
constexpr double infinity = std::numeric_limits<double>::infinity();

inline double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline bool one_of(Random& random, int count) {
  return random() % static_cast<unsigned>(count) == 0;
}

struct Case {
  std::vector<pd::Branch<double>> curve{5};
  pd::Drive<double> drive{};
  std::vector<double> times{0}, velocities, loads, forces, across, touches;
  double displacement, duration;

  explicit Case(Random& random) {
    drive.mass = between(random, 2e-3, 2e-2);
    drive.stiffness = between(random, 20, 400);
    drive.damping = one_of(random, 4) ? 0 : between(random, 0, 1);
    const double plate = between(random, 1e-3, 0.1), finger = between(random, 1e-3, 0.05);
    drive.plate = {plate, plate * (one_of(random, 2) ? 1 : between(random, 1, 2))};
    drive.finger = {finger, finger * (one_of(random, 2) ? 1 : between(random, 1, 2))};
    if (one_of(random, 3)) {
      const double speeds[]{0, 0.05, 0.3}, rows[]{plate, plate * between(random, 0.5, 1), plate};
      drive.plate.branches = pd::branches_of(speeds, rows, 3, curve.data());
      drive.plate.curve = curve.data();
    }
    if (one_of(random, 3)) drive.finger.stiffness = drive.stiffness * between(random, 1, 50);
    if (!drive.finger.rigid() && one_of(random, 2))
      drive.finger.damping = drive.finger.stiffness * std::pow(10, between(random, -4, -2));
    for (int i = 0; i < 4; ++i) times.push_back(times.back() + between(random, 0.005, 0.08));
    const bool forced = one_of(random, 2), oblique = one_of(random, 3);
    for (std::size_t i = 0; i < times.size(); ++i) {
      velocities.push_back(i > 1 && one_of(random, 3) ? velocities.back()
                                                      : between(random, -0.3, 0.3));
      loads.push_back(one_of(random, 2) ? 1 : between(random, 0, 2));
      forces.push_back(forced ? between(random, -0.1, 0.1) : 0);
      touches.push_back(drive.finger.rigid() && forced ? between(random, 0, 2) : 1);
      across.push_back(oblique && !one_of(random, 3) ? between(random, -0.2, 0.2) : 0);
    }
    displacement = between(random, -3e-3, 3e-3);
    duration = times.back() + 0.1;
    if (one_of(random, 2)) return;
    drive.stops.travel = std::abs(displacement) * (one_of(random, 4) ? 1 : between(random, 1, 2));
    if (one_of(random, 2)) return;
    drive.stops.stiffness = drive.stiffness * std::pow(10, between(random, 0, 3));
    if (one_of(random, 2)) return;
    drive.stops.damping = between(random, 0, 1) * std::sqrt(drive.mass * drive.stops.stiffness);
  }
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  /// The inputs from a row on.
  pd::InputCurves<double> from(double t) const {
    const auto line = [&](const std::vector<double>& values) {
      return pd::Profile<double>(times.data(), values.data(), times.size()).from(t);
    };
    return {line(velocities), line(loads), line(across), line(forces), line(touches)};
  }
};

}  // namespace driven
