// Time of one transient in the core alone, on the drives of benchmarks/batch.py: followed to its last
// state, and measured; µs.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "pindrive/engine.hpp"
#include "pindrive/motion/batch.hpp"

namespace {

using Clock = std::chrono::steady_clock;

struct Point {
  pindrive::Drive<double> drive;
  pindrive::Inputs<double> inputs;
};

std::vector<Point> drawn(std::size_t count, unsigned seed) {
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  std::vector<Point> points;
  points.reserve(count);
  while (points.size() < count) {
    const double mass = uniform(2e-3, 20e-3), stiffness = uniform(20, 400);
    const double damping = 2 * uniform(0.01, 0.5) * std::sqrt(mass * stiffness);
    const double plate = uniform(5e-3, 100e-3), finger = uniform(1e-3, 50e-3);
    const double speed = uniform(20e-3, 300e-3), displacement = uniform(0.5e-3, 3e-3);
    points.push_back({{mass, stiffness, damping, {plate, plate}, {finger, finger}},
                      {speed, displacement, speed, 0.3}});
  }
  return points;
}

/// Best of a few rounds, µs a point.
template <class Work>
double time_of(const std::vector<Point>& points, Work&& work) {
  double best = INFINITY;
  for (int round = 0; round < 5; ++round) {
    const auto begin = Clock::now();
    for (const Point& point : points) work(point);
    best = std::min(best, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  return 1e6 * best / static_cast<double>(points.size());
}

}  // namespace

struct State {
  double x, v;
};

/// Follows a pin and keeps its last state. Not in main, which compilers make small, not fast: it
/// runs once.
[[gnu::noinline]] State last_state(const Point& point) {
  State last{};
  pindrive::simulate(point.drive, point.inputs, [&](const pindrive::Segment<double>& segment) {
    if (segment.end < point.inputs.duration) return;
    const double tau = point.inputs.duration - segment.begin;
    const pindrive::Propagator<double> moved = segment.after(tau);
    last = {segment.flow.position.at(moved), segment.flow.velocity.at(moved)};
  });
  return last;
}

int main(int argc, char** argv) {
  const auto points = drawn(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100'000, 1);
  double sum = 0;  // printed, so that no work can be left out
  const double simulated = time_of(points, [&](const Point& point) {
    const State last = last_state(point);
    sum += last.x + last.v;
  });
  std::vector<pindrive::Segment<double>> segments;
  const double measured = time_of(points, [&](const Point& point) {
    const auto summary =
        pindrive::summarise(point.drive, point.inputs, pindrive::settling_band, segments);
    sum += summary.transient.peak_displacement;
  });
  std::printf("%.3f us to its last state, %.3f us with all its numbers; checksum %.17g\n",
              simulated, measured, sum);
}
