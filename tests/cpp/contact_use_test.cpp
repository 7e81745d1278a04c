// What the contacts did, on a pin that slides over the plate and sticks to it, in numbers known beforehand.
#include "pindrive/motion/contact_use.hpp"

#include <vector>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;

int main() {
  // It slides to a halt at a constant friction of 0.2 N without spring forces that matter, and then sticks.
  const pd::Drive<double> drive{0.01, 1e-9, 0, {0.2, 0.3}, {0.1, 0.1, 500}};
  const pd::Inputs<double> inputs{0.0, 0, 0.1};
  std::vector<pd::Segment<double>> segments(2);
  segments[0].end = 0.4;
  segments[0].mode = {ContactState::slip_forward, ContactState::elastic_stick};
  segments[0].event.plate = pd::Transition::stick;
  segments[0].flow = pd::Flow<double>::stuck(0, {0.1, -0.25});
  segments[0].moved = segments[0].flow.after(0.4);
  segments[0].plate_force = pd::Line<double>{-0.2, 0};
  segments[0].finger_force = pd::Line<double>{0.05, -0.2};
  segments[1].begin = 0.4;
  segments[1].end = 1;
  segments[1].mode = {ContactState::stick, ContactState::elastic_stick};
  segments[1].flow = pd::Flow<double>::stuck(0.02, {});
  segments[1].moved = segments[1].flow.after(1 - 0.4);
  segments[1].plate_force = pd::Line<double>{-0.25, 0};
  segments[1].finger_force = pd::Line<double>{-0.03, 0};
  pd::Outcome<double> outcome;
  outcome.until = 1;
  const pd::Motion<double> motion(drive, inputs, segments.data(), 2, outcome);

  const auto used = pd::detail::ContactMeasurement<double>(motion).measure(0, 1);
  expect(near(used.plate.distance_slid, 0.02, 1e-15), "it slid 20 mm");
  expect(near(used.plate.dissipated, 0.2 * 0.02, 1e-15), "friction took force times distance");
  expect(used.plate.reversals == 1 && near(used.plate.time_stuck, 0.6, 1e-15),
         "its sliding came to zero once, and it stuck for the rest");
  expect(near(used.plate.peak_force, 0.25, 1e-15), "the largest force is that of the stick");
  expect(
      near(used.peak_stretch, 0.05 / 500, 1e-15) && near(used.peak_stretch_rate, 0.2 / 500, 1e-15),
      "skin stretches by force over stiffness");
  expect(used.finger.distance_slid == 0 && near(used.finger.time_stuck, 1, 1e-15),
         "an elastic stick does not slide");

  const auto half = pd::detail::ContactMeasurement<double>(motion).measure(0, 0.2);
  expect(half.plate.reversals == 0 && near(half.plate.distance_slid, 0.015, 1e-15),
         "no more than until the duration");

  const pd::Drive<double> rigid{0.01, 1e-9, 0, {0.2, 0.3}, {}};
  const pd::Motion<double> other(rigid, inputs, segments.data(), 2, outcome);
  expect(std::isnan(pd::detail::ContactMeasurement<double>(other).measure(0, 1).peak_stretch),
         "a finger that is not compliant has no stretch");
  return check::status();
}
