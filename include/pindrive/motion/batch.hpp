/// One point of a study: numbers of the motion of one drive and release; the motion itself is not
/// kept.
#pragma once

#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/duration.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/transient.hpp"

namespace pindrive {

/// Numbers of a motion over [0, duration] (docs/theory.md, section 15).
template <class T>
struct Summary {
  Transient<T> transient;
  Outcome<T> outcome;
  T duration;           ///< requested duration, or long enough to see the ending, s
  long long events{0};  ///< contact events; in a cycle, events of one period
};

/// Number of events at the end of a segment: one for each contact, or one that plate and finger
/// share.
template <class T>
int events_at_end(const Segment<T>& segment) {
  const Event event = segment.event;
  const auto one = [](Transition transition) { return transition == Transition::none ? 0 : 1; };
  const int rubbing = event.plate == event.finger ? 0 : one(event.finger);
  return one(event.plate) + rubbing + one(event.stop);
}

/// Simulates one pin and measures its motion. `segments` is a container lent by the caller: its
/// content is overwritten, and once it is large enough nothing is allocated.
template <class T, class Segments>
Summary<T> summarise(const Drive<T>& drive, const Inputs<T>& inputs, T band, Segments& segments,
                     GoOn go_on = {}) {
  Summary<T> summary;
  segments.clear();
  summary.outcome = simulate(drive, inputs, [&](const Segment<T>& segment) {
    segments.push_back(segment);
    summary.events += events_at_end(segment);
    return go_on();
  });
  const Motion<T> motion(drive, inputs, segments.data(), segments.size(), summary.outcome);
  summary.duration = duration_of(motion, band, go_on);
  summary.transient = transient_of(motion, summary.duration, band, go_on);
  return summary;
}

}  // namespace pindrive
