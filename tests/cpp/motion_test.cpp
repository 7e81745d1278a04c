// A finished motion as a function of time: both limits at an event, cycles folded and expanded, and how two
// contacts that stick share their force.
#include "pindrive/motion/motion.hpp"

#include <vector>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;

namespace {

using Segment = pd::Segment<double>;

/// A pin that goes on at 1 m/s for a second and back for the next.
Segment stretch(double begin, double x, double v) {
  Segment segment{};
  segment.begin = begin;
  segment.end = begin + 1;
  segment.mode = {ContactState::stick, ContactState::stick};
  segment.flow = pd::Flow<double>::stuck(x, {v, 0});
  segment.plate_force = pd::Line<double>{0.6, 0.1};
  return segment;
}

const pd::Drive<double> drive{0.01, 100, 0, {0.2, 0.2}, {0.1, 0.1}};
const pd::Inputs<double> inputs{0.0, 0, 0};

double position(const pd::Motion<double>& motion, double t, pd::Side side = pd::Side::right) {
  const auto [segment, tau] = motion.locate(t, side);
  return segment->flow.position.at(segment->flow.oscillator, tau);
}

}  // namespace

int main() {
  const std::vector<Segment> segments{stretch(0, 5, -5), stretch(1, 0, 1), stretch(2, 1, -1)};
  pd::Outcome<double> outcome;
  outcome.end = pd::End::stick_slip;
  outcome.cycle_begin = 1;
  outcome.until = 3;
  outcome.period = 2;
  const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);

  const auto left = motion.locate(2, pd::Side::left), right = motion.locate(2, pd::Side::right);
  expect(left.segment == &segments[1] && left.tau == 1 && right.segment == &segments[2] &&
             right.tau == 0,
         "an event has a limit from either side");
  expect(near(position(motion, 0.2), 4, 1e-15), "before the cycle it is as simulated");
  bool repeats = true;
  for (int n = 0; n < 5; ++n)
    repeats = repeats && near(position(motion, 1.25 + 2 * n), 0.25, 1e-13) &&
              near(position(motion, 2.25 + 2 * n), 0.75, 1e-13);
  expect(repeats, "a cycle goes on for ever");
  expect(motion.known_until() > 1e300, "... so all of it is known");

  double time = 0, counted = 0;
  motion.stretches(0, 9.5, [&](const Segment&, double from, double to, double times) {
    time += times * (to - from);
    counted += times;
  });
  expect(near(time, 9.5, 1e-14) && counted == 3 + 2 * 3 + 1, "stretches cover the time asked for");

  std::vector<double> begins;
  motion.expanded(4.5, 7.5, [&](const Segment&, double begin, double) { begins.push_back(begin); });
  expect(begins == std::vector<double>({4, 5, 6, 7}), "cycles are expanded in order");

  const auto friction = motion.friction(segments[0], 0.5);
  expect(near(friction.plate, 0.65 * 2 / 3, 1e-15) && near(friction.finger, 0.65 / 3, 1e-15),
         "two that stick share in proportion to their static friction");
  return check::status();
}
