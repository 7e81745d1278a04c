/// One point of a study: a drive and its release in, its numbers out, and no way between them kept.
#pragma once

#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/transient.hpp"

namespace pindrive {

/// Everything asked of a motion (docs/theory.md, 6), over [0, duration].
template <class T>
struct Summary {
  Transient<T> transient;
  Outcome<T> outcome;
  T duration;           ///< that was asked for, or long enough to see the ending, s
  long long events{0};  ///< changes at a contact; of a cycle, those of one round
};

/// How many events end a segment: one for each contact, or one that plate and finger share.
template <class T>
int events_at_end(const Segment<T>& segment) {
  const Event event = segment.event;
  const auto one = [](Transition transition) { return transition == Transition::none ? 0 : 1; };
  const int rubbing = event.plate == event.finger ? 0 : one(event.finger);
  return one(event.plate) + rubbing + one(event.stop);
}

/// Follows one pin and measures its motion. `segments` is a container that the caller lends for the
/// meantime: what it held is lost, and once it has grown large enough nothing is allocated.
template <class T, class Segments, class GoOn = Unattended>
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
  summary.transient = Measurement<T, GoOn>(motion, summary.duration, go_on).transient(band);
  return summary;
}

}  // namespace pindrive
