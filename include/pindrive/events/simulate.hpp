/// Simulation of one motion of a pin.
#pragma once

#include "pindrive/events/simulation.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive {

/// Simulates one pin and passes each segment to the sink, in order of time; a sink may return false
/// to stop.
template <class T>
Outcome<T> simulate(const Drive<T>& drive, const Inputs<T>& inputs,
                    detail::Given<SegmentSink<T>> sink) {
  return detail::Simulation<T>(drive, inputs).run(sink);
}

}  // namespace pindrive
