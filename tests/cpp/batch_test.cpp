// One point of a study: the numbers of a motion, as when each is asked of the motion itself.
#include "pindrive/motion/batch.hpp"

#include <vector>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using pd::Transition;

namespace {

using Segments = std::vector<pd::Segment<double>>;

void events() {
  const auto at_end = [](Transition plate, Transition finger, Transition stop = {}) {
    pd::Segment<double> segment{};
    segment.event = {plate, finger, stop};
    return pd::events_at_end(segment);
  };
  expect(at_end(Transition::none, Transition::none) == 0, "the row of an input is no event");
  expect(at_end(Transition::slip, Transition::none) == 1 &&
             at_end(Transition::none, Transition::cross) == 1,
         "what happens at one contact is one event");
  expect(at_end(Transition::stick, Transition::stick) == 1, "what both do together is one, too");
  expect(at_end(Transition::slip, Transition::stick) == 2, "what each does by itself are two");
  expect(at_end(Transition::none, Transition::none, Transition::cross) == 1 &&
             at_end(Transition::slip, Transition::slip, Transition::slip) == 2,
         "what happens at an end stop is an event of its own");
}

void summary() {
  const pd::Drive<double> drive{0.01, 100, 0.4, {0.02, 0.02}, {0.005, 0.005}};
  const pd::Inputs<double> inputs{0.1, 1.5e-3, 0.1};
  Segments kept;
  long long events = 0;
  const auto outcome = pd::simulate(drive, inputs, [&](const pd::Segment<double>& segment) {
    kept.push_back(segment);
    events += pd::events_at_end(segment);
  });
  const pd::Motion<double> motion(drive, inputs, kept.data(), kept.size(), outcome);
  const double duration = pd::duration_of(motion, pd::settling_band);
  const auto numbers = pd::Measurement<double>(motion, duration).transient(pd::settling_band);

  Segments lent(7);
  const auto found = pd::summarise(drive, inputs, pd::settling_band, lent);
  expect(lent.size() == kept.size() && lent.back().begin == kept.back().begin,
         "the container holds the segments of this motion alone");
  expect(found.events == events && events == 5, "its events are counted");
  expect(found.duration == duration && found.outcome.end == pd::End::resting,
         "it is followed until its ending is seen");
  expect(found.transient.settling_time == numbers.settling_time &&
             found.transient.peak_displacement == numbers.peak_displacement &&
             found.transient.finger.dissipated == numbers.finger.dissipated,
         "its numbers are those of the motion");

  const auto* memory = lent.data();
  const auto again = pd::summarise(drive, inputs, pd::settling_band, lent);
  expect(lent.data() == memory && again.events == events, "once large enough it is not moved");
}

void ended_early() {
  const pd::Drive<double> drive{0.01, 100, 0.4, {0.02, 0.02}, {0.005, 0.005}};
  const pd::Inputs<double> inputs{0.1, 1.5e-3, 0.1};
  Segments lent;
  const auto found = pd::summarise(drive, inputs, pd::settling_band, lent, [] { return false; });
  expect(found.outcome.status == pd::Status::stopped && lent.size() == 1,
         "a computation that may not go on ends with the segment at hand");
}

}  // namespace

int main() {
  events();
  summary();
  ended_early();
  return check::status();
}
