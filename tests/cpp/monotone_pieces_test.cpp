// Searches in the monotone pieces of a motion against dense samples of the motion.
#include "pindrive/device/monotone_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "check.hpp"
#include "scanned_pin.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;

namespace {

constexpr int samples = 10000;

/// Largest deviations of the results from samples between two times.
struct Worst {
  double highest{0}, level{0}, climb{0}, beyond{0}, swing{0};
};

void compare(const device::MonotonePieces& pieces, const device::Signal& of, double from, double to,
             Worst& worst) {
  const double step = (to - from) / samples;
  const auto at = [&](int i) { return pieces.at(of, from + step * i); };
  double most = at(0), least = most, lowest_since = most, largest_climb = 0;
  for (int i = 1; i <= samples; ++i) {
    most = std::max(most, at(i));
    least = std::min(least, at(i));
    lowest_since = std::min(lowest_since, at(i));
    largest_climb = std::max(largest_climb, at(i) - lowest_since);
  }
  const device::Point top = pieces.highest(of, from, to);
  worst.highest = std::max(
      {worst.highest, std::abs(top.value - most), std::abs(pieces.at(of, top.time) - top.value)});
  const double level = 0.5 * (most + least), height = 0.5 * largest_climb;
  const double first = pieces.first_at(of, level, from, to);
  const double last = pieces.last_beyond(of, pieces.at(of, to), 0.3 * (most - least), from, to);
  const auto climb = pieces.climb(of, height, from, to);
  int sampled_first = -1, sampled_last = -1, sampled_climb = -1;
  lowest_since = at(0);
  for (int i = 0; i <= samples; ++i) {
    lowest_since = std::min(lowest_since, at(i));
    if (sampled_first < 0 && at(i) >= level) sampled_first = i;
    if (sampled_climb < 0 && at(i) - lowest_since >= height) sampled_climb = i;
    if (std::abs(at(i) - pieces.at(of, to)) >= 0.3 * (most - least)) sampled_last = i;
  }
  const auto off = [&](double t, int i) { return std::abs(t - from - step * i) / step; };
  worst.level = std::max(worst.level, off(first, sampled_first));
  worst.beyond = std::max(worst.beyond, off(last, std::max(sampled_last, 0)));
  if (height > 0) worst.climb = std::max(worst.climb, off(climb.time, sampled_climb));
  double rises = 0, sampled = 0;
  double before = -1;
  for (const device::Swing& swing : pieces.swings(of, from, to)) {
    rises += swing.low.time > before ? swing.height() : 1;  // neighbours would be one swing
    before = swing.high.time;
  }
  for (int i = 1; i <= samples; ++i) sampled += std::max(0.0, at(i) - at(i - 1));
  worst.swing = std::max(worst.swing, std::abs(rises - sampled));
}

void against_samples() {
  std::mt19937_64 random(11);
  for (const double skin : {std::numeric_limits<double>::infinity(), 600.0}) {
    const scanned::Pin pin(skin);
    const pd::Motion<double> motion = pin.motion();
    device::MonotonePieces pieces;
    pieces.read(motion, 0.2);
    Worst worst;
    for (int i = 0; i < 10; ++i) {
      double from = std::uniform_real_distribution<double>(0, 0.2)(random);
      double to = std::uniform_real_distribution<double>(0, 0.2)(random);
      if (to < from) std::swap(from, to);
      for (const bool of_skin : {false, true})
        for (const double sign : {1.0, -1.0}) compare(pieces, {of_skin, sign}, from, to, worst);
    }
    std::printf("# %.1e %.1e %.1e %.1e %.1e\n", worst.highest, worst.level, worst.climb,
                worst.beyond, worst.swing);
    expect(worst.highest < 4e-9, "the highest value is that of samples");
    expect(worst.level < 1.1 && worst.beyond < 1.1, "levels are found within a sample");
    expect(worst.climb < 1.1, "a climb ends within a sample");
    expect(worst.swing < 2e-8, "the swings rise as far as the samples");
  }
}

void holds_and_rest() {
  const scanned::Pin pin;
  const pd::Motion<double> motion = pin.motion();
  device::MonotonePieces pieces;
  pieces.read(motion, 0.2);
  int holds = 0;
  double held = 0, expected = 0;
  pieces.each_hold([&](double begin, double end) {
    ++holds;
    held += end - begin;
    expect(pd::is_stick(motion.locate(0.5 * (begin + end), pd::Side::right).segment->mode.plate),
           "the plate holds the pin");
  });
  for (const auto& segment : pin.segments)
    if (segment.mode.plate == pd::ContactState::stick)
      expected += std::min(segment.end, 0.2) - segment.begin;
  expect(holds >= 2 && std::abs(held - expected) < 1e-15, "as long as in the segments");
  expect(pieces.rests(0.005) && !pieces.rests(0.02), "at rest on the finger, not while carried");
}

void a_cycle_is_repeated() {
  // Carried and released again and again by the plate: stick-slip.
  const pd::Drive<double> drive{0.01, 100, 0.01, {0.02, 0.04}, {}};
  const pd::Inputs<double> inputs{0.01, 0, 0.01};
  std::vector<pd::Segment<double>> segments;
  const auto outcome = pd::simulate(drive, inputs, [&](const auto& s) { segments.push_back(s); });
  const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
  expect(outcome.cycles(), "the motion ends in a cycle");
  device::MonotonePieces pieces;
  const double until = outcome.until + 5.3 * outcome.period;
  pieces.read(motion, until);
  double worst = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double t = until * i / 1000;
    const auto [segment, tau] = motion.locate(t, pd::Side::right);
    worst = std::max(worst, std::abs(pieces.at({false, 1}, t) -
                                     motion.value(*segment, tau, pd::Quantity::position)));
  }
  expect(worst < 1e-13, "its rounds are pieces, too");
}

}  // namespace

int main() {
  against_samples();
  holds_and_rest();
  a_cycle_is_repeated();
  return check::status();
}
