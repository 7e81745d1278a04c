/// Simulation of one pin: segments from event to event until the motion ends. There is no time step
/// and no tolerance of integration; tolerances of rest and of cycles are in limits.hpp.
#pragma once

#include <algorithm>
#include <limits>

#include "pindrive/events/evolution.hpp"
#include "pindrive/events/recurrence.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Simulation of one pin from its release. Each segment is passed to the sink, in order of time; a
/// sink may return false to stop.
template <class T>
class Simulation {
 public:
  Simulation(const Drive<T>& drive, const Inputs<T>& inputs)
      : inputs_(inputs), evolution_(drive, inputs, T(0)), cycles_(drive) {
    evolution_.pin.plate.remove_unloaded(inputs.plate_load);
    evolution_.pin.finger.remove_unloaded(inputs.finger_load);
    select();
  }

  Outcome<T> run(SegmentSink<T> sink) {
    Pin<T>& pin = evolution_.pin;
    const bool unlimited = !(inputs_.duration < never);
    int standing = 0;
    Segment<T> segment;
    for (long long events = 1;; ++events) {
      evolution_.begin(segment);
      const T event = evolution_.earliest(segment.flow), turn = evolution_.turning_point();
      const T tau = std::min(event, turn);
      const bool finished = !(evolution_.time_after(tau) < inputs_.duration);
      if (!finished) {
        evolution_.jump(segment, tau);
        const bool by_series = evolution_.series.used();
        if (turn < event) pin.state.v = T(0);
        select();
        const Mode after = pin.mode();
        segment.event = evolution_.transitions(segment.mode);
        const bool changes = segment.event.any() || !same_mode(segment.mode, after);
        if (evolution_.begins_period())
          cycles_.visit(segment, after, pin.time, evolution_.time_error,
                        evolution_.state_at_begin_of_period(), outcome_, true, by_series);
        else if (evolution_.has_constant_inputs() && (changes || turn < event))
          cycles_.visit(segment, after, pin.time, evolution_.time_error, pin.state, outcome_, false,
                        by_series);
        else
          cycles_.pass(segment, pin.state);
      } else if (tau == never && evolution_.has_lasting_loads()) {
        end_with(segment, outcome_);
      }
      if (finished && !outcome_.known() && inputs_.duration < never) {
        segment.end = inputs_.duration;
        segment.moved = segment.flow.after(segment.end - segment.begin);
      }
      outcome_.until = segment.end;
      standing = segment.end > segment.begin ? 0 : standing + 1;
      if (!sink(segment))
        outcome_.status = Status::stopped;
      else if (finished || outcome_.cycles() || (outcome_.unbounded() && unlimited))
        return outcome_;
      else if (unlimited && cycles_.is_too_long())
        return cycles_.terminated(outcome_);
      else if (events == event_limit)
        outcome_.status = Status::too_many_events;
      else if (standing > standstill_limit)
        outcome_.status = Status::standstill;
      if (outcome_.status != Status::ok) return outcome_;
    }
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  void select() {
    if (!evolution_.select()) outcome_.status = Status::inconsistent;
  }

  const Inputs<T>& inputs_;
  Evolution<T> evolution_;
  CycleDetector<T> cycles_;
  Outcome<T> outcome_{};
};

}  // namespace pindrive::detail
