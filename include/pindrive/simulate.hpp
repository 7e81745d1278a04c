/// The event loop: mode → closed form → earliest event → next mode. No step, no tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/flow.hpp"
#include "pindrive/friction.hpp"
#include "pindrive/model.hpp"
#include "pindrive/roots.hpp"

namespace pindrive {

/// Follows one pin from its release and hands each segment to the sink, in order of time.
template <class T>
class Simulation {
 public:
  Simulation(const Drive<T>& drive, const Inputs<T>& inputs)
      : drive_(drive),
        friction_(drive, inputs.mouse_velocity),
        oscillator_(drive.mass, drive.damping, drive.stiffness),
        duration_(inputs.duration),
        x_(inputs.displacement),
        v_(inputs.velocity),
        mode_(friction_.starting(x_, v_)) {}

  template <class Sink>
  Outcome<T> run(Sink&& sink) {
    for (long long events = 0; events < event_limit; ++events) {
      const Segment<T> segment = mode_.stuck() ? hold() : slide();
      sink(segment);
      outcome_.until = segment.end;
      if (segment.event.kind == Kind::none || outcome_.end == End::stick_slip) return outcome_;
      time_ = segment.end;
    }
    outcome_.status = Status::too_many_events;
    return outcome_;
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  /// Stuck at a level until the force needed outgrows the static friction.
  Segment<T> hold() {
    const T level = friction_.level(mode_);
    const Flow<T> flow = Flow<T>::stuck(oscillator_, x_, level);
    if (level == 0) return last(flow, End::resting);

    const int pull = level > 0 ? 1 : -1;
    const T limit = pull * friction_.capacity(mode_);
    const T x_break = friction_.position_needing(mode_, limit);
    const T tau = std::max(T(0), (x_break - x_) / level);
    const Event event{Kind::slip, mode_.plate == Slide::stuck, mode_.finger == Slide::stuck};
    if (time_ + tau >= duration_) return cut(flow);
    const Segment<T> segment{time_, time_ + tau, mode_, flow, event};
    note_release(segment);

    x_ = x_break;
    v_ = level;
    mode_ = Friction<T>::released(mode_, -pull);
    tangential_ = drive_.plate.kinetic == drive_.plate.static_limit;
    return segment;
  }

  /// Sliding everywhere until a sliding velocity reaches zero.
  Segment<T> slide() {
    const T rest = friction_.sliding_force(mode_) / drive_.stiffness;
    const T pull = friction_.sliding_force(mode_) - drive_.stiffness * x_ - drive_.damping * v_;
    const T acceleration = tangential_ ? T(0) : pull / drive_.mass;
    const Flow<T> flow = Flow<T>::sliding(oscillator_, x_, v_, acceleration, rest);

    const T plate = arrival(flow, mode_.plate, friction_.plate_velocity());
    const T finger = arrival(flow, mode_.finger, T(0));
    const T tau = std::min(plate, finger);
    if (tau == never) return last(flow, ending(flow));
    if (time_ + tau >= duration_) return cut(flow);

    Event event{Kind::cross, plate == tau, finger == tau};
    x_ = flow.position.at(oscillator_, tau);
    v_ = event.plate ? friction_.plate_velocity() : T(0);
    const Mode next = friction_.arriving(mode_, event, x_);
    if (next.stuck()) event.kind = Kind::stick;
    const Segment<T> segment{time_, time_ + tau, mode_, flow, event};
    mode_ = next;
    tangential_ = false;
    return segment;
  }

  /// When the sliding velocity at a contact next reaches zero.
  T arrival(const Flow<T>& flow, Slide sliding, T level) const {
    if (sliding == Slide::absent) return never;
    Path<T> guard = flow.velocity;
    guard.start -= level;
    return first_root(oscillator_, guard, sign(sliding), never);
  }

  /// How a slide without a further event ends.
  End ending(const Flow<T>& flow) const {
    if (flow.position.value == 0 && flow.position.slope == 0) return End::resting;
    if (oscillator_.alpha() < 0) return End::decaying;
    return tangential_ ? End::grazing : End::free;
  }

  Segment<T> last(const Flow<T>& flow, End end) {
    outcome_.end = end;
    outcome_.since = time_;
    if (end == End::free || end == End::grazing)
      outcome_.period = oscillator_.zeros(T(0), T(1)).spacing * 2;
    return {time_, never, mode_, flow, {}};
  }

  Segment<T> cut(const Flow<T>& flow) const { return {time_, duration_, mode_, flow, {}}; }

  /// Every release from the plate starts from the same state, so the second one closes a cycle.
  /// It began where the first carried phase joined the one that the cycle repeats.
  void note_release(const Segment<T>& carried) {
    if (released_before_) {
      outcome_.end = End::stick_slip;
      outcome_.period = carried.end - first_release_;
      outcome_.cycle_begin = first_release_;
      outcome_.since = std::max(first_hold_, first_release_ - (carried.end - carried.begin));
    }
    released_before_ = true;
    first_release_ = carried.end;
    first_hold_ = carried.begin;
  }

  Drive<T> drive_;
  Friction<T> friction_;
  Oscillator<T> oscillator_;
  T duration_;

  T time_{0}, x_, v_;
  Mode mode_;
  bool tangential_{false};  ///< the pin has just left the plate with no relative acceleration

  bool released_before_{false};
  T first_release_{}, first_hold_{};
  Outcome<T> outcome_{};
};

template <class T, class Sink>
Outcome<T> simulate(const Drive<T>& drive, const Inputs<T>& inputs, Sink&& sink) {
  return Simulation<T>(drive, inputs).run(sink);
}

}  // namespace pindrive
