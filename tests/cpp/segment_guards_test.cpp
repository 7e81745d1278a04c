// What a mode keeps positive: of a pin that slides its speeds, until the first comes to zero at the event that
// ends the segment; of one that sticks what its limit leaves; of stops the way to them and the push of one.
#include "pindrive/certificate/segment_guards.hpp"

#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;

namespace {

using Drive = pd::Drive<double>;
using Certificate = pd::Certificate<double>;
using Along = pd::detail::ClosedForm<double>;
using Evaluated = pd::detail::EvaluatedSegment<double, Along>;
using Guards = pd::detail::SegmentGuards<double, Along>;

const pd::detail::Scales<double> scales{2e-3, 0.2, 0.3, 7};

double value(const Evaluated& segment, const Guards::Watch& watch, double tau) {
  return watch.guard.at(segment.segment.flow.oscillator.after(tau)).value;
}

/// Calls visit with the n-th segment of a motion and its guards.
template <class Visitor>
void in_segment(const Drive& drive, const pd::Inputs<double>& inputs, std::size_t n,
                Visitor&& visit) {
  std::vector<pd::Segment<double>> segments;
  pd::simulate(drive, inputs,
               [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
  const Along along(segments.at(n));
  const Evaluated evaluated(drive, scales, inputs, 10, segments[n], along);
  visit(evaluated, Guards(evaluated));
}

}  // namespace

int main() {
  const Drive drive{0.01, 100, 0.4, {0.02, 0.02}, {0.005, 0.005}};
  const pd::Inputs<double> inputs{pd::Profile<double>(0.1), 1.5e-3, 0.02};  // NOLINT: cannot throw
  in_segment(drive, inputs, 0, [](const Evaluated& first, const Guards& guards) {
    expect(guards.size() == 2, "a speed on the plate, and one on the finger");
    expect(near(value(first, guards[0], 0), 0.08, 1e-15) &&
               near(value(first, guards[1], 0), 0.02, 1e-15),
           "they are what they were at the release");
    double least = 1;
    for (const auto& watch : guards) {
      const bool on_plate = &watch == guards.begin();
      expect(watch.law == &Certificate::sliding_sign &&
                 watch.scale == (on_plate ? std::max(scales.v, scales.across) : scales.v),
             "of the law of signs, by the velocity, on the plate in both directions");
      least = std::min(least, value(first, watch, first.span));
    }
    expect(near(least, 0, 1e-15), "the segment ends where one is zero");
    expect(value(first, guards[1], 1.01 * first.span) < 0, "after which it would be negative");
  });

  // Carried along at rest on the plate: the spring may pull up to the stick limit on either side.
  const Drive holds{0.01, 100, 0, {0.2, 0.25}, {}};
  const pd::Inputs<double> carried{pd::Profile<double>(0.05), 1e-3, 0.05};  // NOLINT: cannot throw
  in_segment(holds, carried, 0, [](const Evaluated& first, const Guards& guards) {
    expect(first.mode().plate == ContactState::stick && guards.size() == 2,
           "both sides of a limit");
    const double one = value(first, guards[0], 0), other = value(first, guards[1], 0);
    expect(near(std::min(one, other), 0.25 - 0.1, 1e-15) && near(one + other, 0.5, 1e-15),
           "what the spring leaves of it");
    expect(guards[0].law == &Certificate::force_bound && guards[0].scale == scales.force,
           "of the law of the bound, by the force");
  });

  // An elastic stop that the pin is pushed into.
  const Drive stopped{0.01, 100, 0.4, {}, {}, {1e-3, 1e4, 2}};
  const pd::Inputs<double> pushed{pd::Profile<double>(0.0), 0, 0.3};  // NOLINT: cannot throw
  in_segment(stopped, pushed, 0, [](const Evaluated& first, const Guards& guards) {
    expect(guards.size() == 2 && guards[0].law == &Certificate::sliding_sign &&
               near(value(first, guards[0], 0), 1e-3, 1e-18),
           "apart: the way to either stop");
  });
  in_segment(stopped, pushed, 1, [](const Evaluated& there, const Guards& guards) {
    const auto s = there.at(there.span / 2);
    expect(guards.size() == 2 && guards[1].law == &Certificate::force_bound &&
               guards[1].scale == scales.stop &&
               near(value(there, guards[1], there.span / 2), -there.stop_force(s), 1e-14) &&
               near(value(there, guards[0], there.span / 2), s.x - 1e-3, 1e-16),
           "at one: its depth, and its push");
  });
  return check::status();
}
