// The swing about a centre against itself a little later, and its inverse against its values.
#include "pindrive/kernel/oscillation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace pk = pindrive::detail;

int main() {
  constexpr double pi = 3.14159265358979323846;
  std::mt19937_64 random(4);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  // The worst of: a root's value, its slope; and of the oscillation, parts of its size.
  double value = 0, slope = 0, turn = 0, extreme = 0, place = 0, half_turn = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double damping_ratio = uniform(0, 0.985),
                 root = std::sqrt(1 - damping_ratio * damping_ratio);
    const double rho = (i % 2 == 0 ? 1 : -1) * damping_ratio / root, angle = uniform(0, pi);
    const auto part = [&](double d) {
      return std::exp(-rho * d) * (std::cos(d) + rho * std::sin(d));
    };
    const auto right_slope = -(1 + rho * rho) * std::exp(-rho * angle) * std::sin(angle);
    const auto found = pk::past_turn(part(angle), rho);
    const double scale = std::max(1.0, std::exp(-rho * pi)) * (1 + rho * rho);
    value = std::max(value, std::abs(part(found.angle) - part(angle)) / scale);
    const double off = std::abs(found.slope - right_slope) * std::sin(angle) / scale;
    slope = std::max(slope, off);

    const double mass = uniform(1e-3, 1), stiffness = uniform(1, 1000);
    const double omega0 = std::sqrt(stiffness / mass);
    const pk::Oscillation<double> swing(mass, stiffness, 2 * damping_ratio * mass * omega0);
    if (!swing.oscillates) continue;
    const double distance = uniform(-1, 1), velocity = omega0 * uniform(-1, 1);
    const double acceleration = 2 * swing.alpha * velocity - swing.omega0_squared * distance;
    const double size = std::abs(distance) + std::abs(velocity) / swing.omega;
    place = std::max(place, std::abs(swing.distance_at(velocity, acceleration) - distance) / size);
    const auto next = swing.next_turn(velocity, acceleration);
    const auto there = swing.after(next.angle, distance, velocity);
    turn = std::max(turn, std::abs(there.velocity) / (omega0 * size));
    turn = std::max(turn, std::abs(there.distance - next.distance) / size);
    const double side = i % 3 == 0 ? -1 : 1;
    const auto most = swing.extreme_velocity(velocity, acceleration, side);
    if (most.angle >= 0) {
      const auto then = swing.after(most.angle, distance, velocity);
      const double remaining =
          2 * swing.alpha * then.velocity - swing.omega0_squared * then.distance;
      extreme = std::max(extreme, std::abs(then.velocity - most.velocity) / (omega0 * size));
      extreme = std::max(extreme, std::abs(remaining) / (omega0 * omega0 * size));
      if (most.velocity * side < 0) extreme = 1;
    }
    const auto opposite = swing.after(pi, distance, 0);
    half_turn = std::max(half_turn, std::abs(opposite.distance + swing.shrink * distance));
    const auto fastest = swing.after(swing.extreme_angle, distance, 0);
    half_turn = std::max(half_turn, std::abs(fastest.velocity + swing.extreme * distance) / omega0);
  }
  std::printf("part %.1e, its slope %.1e, turn %.1e, extreme %.1e, place %.1e, half turn %.1e\n",
              value, slope, turn, extreme, place, half_turn);
  const double worst = std::max({value, slope, turn, extreme, place, half_turn});
  return worst < 2e-13 ? 0 : 1;
}
