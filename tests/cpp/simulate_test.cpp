// One motion: what its sink sees, how it is stopped, and the limits that end it.
#include "pindrive/events/simulate.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

const pd::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.020}, {0.005, 0.005}};
const pd::Inputs<double> inputs{0.10, 1.5e-3, 0.10};

}  // namespace

int main() {
  int segments = 0;
  double until = 0;
  bool joined = true;
  const auto outcome = pd::simulate(drive, inputs, [&](const pd::Segment<double>& segment) {
    joined = joined && segment.begin == until;
    until = segment.end;
    ++segments;
  });
  expect(outcome.status == pd::Status::ok && outcome.end == pd::End::resting && segments == 6,
         "the example comes to rest after five events");
  expect(joined && until == outcome.until, "its segments join");

  int seen = 0;
  const auto stopped = pd::simulate(drive, inputs, [&](const auto&) { return ++seen < 3; });
  expect(stopped.status == pd::Status::stopped && seen == 3, "a sink that has enough stops it");

  pd::Inputs<double> brief = inputs;
  brief.duration = 0.02;
  const auto cut = pd::simulate(drive, brief, [&](const auto& segment) { until = segment.end; });
  expect(cut.end == pd::End::moving && cut.until == 0.02 && until == 0.02,
         "a duration ends it there, to the bit");

  // Without damping they would be events for ever.
  pd::Drive<double> undamped = drive;
  undamped.damping = 0;
  pd::Inputs<double> unloaded{0.10, 5e-3, 0.10};
  unloaded.plate_load = unloaded.finger_load = 0.0;
  unloaded.force = 0.01;
  const auto free = pd::simulate(undamped, unloaded, [&](const pd::Segment<double>& segment) {
    seen =
        segment.mode.plate == segment.mode.finger && segment.mode.plate == pd::ContactState::absent;
  });
  expect(free.end == pd::End::free && seen, "contacts that are never loaded are absent");
  return check::status();
}
