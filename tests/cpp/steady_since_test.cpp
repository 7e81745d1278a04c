// The beginning of a steady motion.
#include "pindrive/motion/steady_since.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

namespace {

/// Beginning of the steady motion of a drive, its period and its ending.
struct Found {
  double since, period;
  pd::End end;
  double repeats;  ///< largest difference of position over two periods, m
};

Found found(const pd::Drive<double>& drive, const pd::Inputs<double>& inputs) {
  std::vector<pd::Segment<double>> segments;
  const auto outcome =
      pd::simulate(drive, inputs, [&](const auto& segment) { segments.push_back(segment); });
  const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
  const double since = pd::steady_since(motion);
  double repeats = 0;
  const auto position = [&](double time) {
    const auto place = motion.locate(time, pd::Side::right);
    return motion.value(*place.segment, place.tau, pd::Quantity::position);
  };
  for (int i = 0; since >= 0 && i < 50; ++i) {
    const double time = since + i * outcome.period / 25;
    repeats = std::fmax(repeats, std::abs(position(time + outcome.period) - position(time)));
  }
  return {since, outcome.period, outcome.end, repeats};
}

}  // namespace

int main() {
  const pd::Drive<double> sticky{0.01, 100, 0, {0.1, 0.2}, {}};
  const Found cycle = found(sticky, {0.1, 0, 0.1});
  expect(cycle.end == pd::End::stick_slip && cycle.since >= 0 && cycle.since < cycle.period,
         "stick-slip without damping is steady within a period");
  expect(cycle.repeats < 1e-12, "from there on it repeats");

  const double times[] = {0, 1}, loads[] = {1, 1};
  pd::Inputs<double> loaded{0.1, 0, 0};
  loaded.plate_load = {times, loads, 2};
  expect(found(sticky, loaded).since >= 1, "no motion is steady before the last row of its inputs");

  const Found free = found({0.01, 100, 0, {}, {}}, {0.1, 1e-3, 0});
  expect(free.since == 0 && near(free.period, 0.0628318530717958648, 1e-14),
         "an oscillation without friction and damping is steady from the start");
  const Found decays = found({0.01, 100, 0.2, {}, {}}, {0.1, 1e-3, 0});
  expect(decays.end == pd::End::decaying && std::isnan(decays.since), "a decay is not steady");
  return check::status();
}
