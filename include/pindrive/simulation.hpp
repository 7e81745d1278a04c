/// The event loop: mode → closed form → earliest event → next mode. No step, no tolerance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow.hpp"
#include "pindrive/friction.hpp"
#include "pindrive/model.hpp"
#include "pindrive/recurrence.hpp"
#include "pindrive/roots.hpp"

namespace pindrive {

/// Follows one pin from its release and hands each segment to the sink, in order of time.
template <class T, class Surface = Contact<T>, class Input = Profile<T>>
class Simulation {
 public:
  Simulation(const Drive<T, Surface>& drive, const Inputs<T, Input>& inputs)
      : drive_(drive),
        inputs_(inputs),
        friction_(drive),
        plain_(drive.mass, drive.damping, drive.stiffness),
        half_period_(plain_.half_period()),
        half_turn_(plain_.oscillates() ? plain_.half_turn() : Transition<T>{}),
        state_{inputs.displacement, inputs.velocity, T(0), {}, {}} {
    using std::abs;
    using std::isnan;
    x_size_ = abs(state_.x);
    look_ahead();
    const T v = state_.v, u = v - state_.plate_velocity.value;
    Mode mode{touch(drive.plate, u), touch(drive.finger, v)};
    const bool given = !isnan(inputs.skin_stretch);
    if (given) state_.skin = drive.finger.stiffness * inputs.skin_stretch;
    if (drive.finger.present() && !drive.finger.rigid() && (given || v == 0))
      mode.finger = Slide::gripping;
    if (slides(mode.plate)) mode.plate_region = drive.plate.region_of(along(mode.plate, u));
    if (slides(mode.finger)) mode.finger_region = drive.finger.region_of(along(mode.finger, v));
    select(mode);
  }

  template <class Sink>
  Outcome<T> run(Sink&& sink) {
    int standing = 0;
    for (long long events = 0; events < event_limit; ++events) {
      if (!consistent_) {
        outcome_.status = Status::inconsistent;
        return outcome_;
      }
      Segment<T> segment = begin();
      const T tau = earliest(segment.flow);
      const bool finished = !(time_ + tau < inputs_.duration);
      if (finished) {
        if (tau == never) outcome_.end = ending(segment);
        if (outcome_.end == End::moving && inputs_.duration < never) {
          segment.end = inputs_.duration;
          segment.moved = segment.flow.after(segment.end - segment.begin);
        }
      } else {
        jump(segment, tau);
        select(segment.mode);
        const Mode after = next_.mode();
        segment.event = {change(segment.mode.plate, after.plate),
                         change(segment.mode.finger, after.finger)};
        note_recurrence(segment);
      }
      sink(segment);
      outcome_.until = segment.end;
      if (finished || outcome_.cycles()) return outcome_;
      standing = segment.end > segment.begin ? 0 : standing + 1;
      if (standing > standstill_limit) {
        outcome_.status = Status::standstill;
        return outcome_;
      }
    }
    outcome_.status = Status::too_many_events;
    return outcome_;
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  /// What stays positive while a mode lasts.
  struct Guard {
    Path<T> path;
    Bound bound;  ///< of the branch of a sliding contact; none: of what can be carried …
    bool plate, finger;
    int side;  ///< … to this side
    T root{never};
  };

  static Slide touch(const Surface& contact, T u) {
    if (!contact.present()) return Slide::absent;
    return u > 0 ? Slide::forward : u < 0 ? Slide::backward : Slide::stuck;
  }

  // ---- which mode follows ------------------------------------------------------------------------

  void select(const Mode& before) {
    Selection<T, Surface> selection(drive_, state_, x_size_, before, reached_);
    consistent_ = selection.next(next_, start_);
  }

  // ---- one mode ----------------------------------------------------------------------------------

  /// The segment of the mode that follows, and its guards.
  Segment<T> begin() {
    const Mode mode = next_.mode();
    Segment<T> segment;
    segment.begin = time_;
    segment.end = never;
    segment.mode = mode;
    segment.event = {};
    segment.flow = mode.stuck() ? Flow<T>::stuck(state_.x, friction_.level(mode, state_))
                                : free_flow(mode);
    segment.plate_velocity = state_.plate_velocity;
    segment.plate_force = friction_.plate_force(mode, state_, start_, segment.flow);
    segment.finger_force = friction_.finger_force(mode, state_, start_, segment.flow);
    guards_count_ = 0;
    const auto sliding = [&](const Surface& contact, const Option& option, Line<T> surface,
                             bool plate) {
      if (!slides(option.slide)) return;
      const Region<T> region = contact.region(option.region);
      const Path<T> level = surface;
      Path<T> above = along(option.slide, T(1)) * (segment.flow.velocity + T(-1) * level);
      Path<T> below = T(-1) * above;
      above.start = option.at == Bound::lower ? T(0) : above.start - region.from;
      guards_[guards_count_++] = {above, Bound::lower, plate, !plate, 0};
      if (!(region.to < never)) return;
      below.start = option.at == Bound::upper ? T(0) : below.start + region.to;
      guards_[guards_count_++] = {below, Bound::upper, plate, !plate, 0};
    };
    sliding(drive_.finger, next_.finger, {}, false);
    sliding(drive_.plate, next_.plate, state_.plate_velocity, true);
    for (const int side : {1, -1}) {
      const Line<T> skin{drive_.finger.static_limit, T(0)};
      if (!Surface::plain && mode.finger == Slide::gripping)
        guards_[guards_count_++] = {Path<T>(skin) + T(side) * segment.finger_force, Bound::none,
                                    false, true, side};
      if (mode.stuck())
        guards_[guards_count_++] = {start_.left[side > 0 ? 0 : 1], Bound::none,
                                    mode.plate == Slide::stuck, mode.finger == Slide::stuck, side};
    }
    return segment;
  }

  Flow<T> free_flow(const Mode& mode) const {
    const Equation<T> equation = friction_.equation(mode, state_);
    const Oscillator<T> oscillator =
        friction_.constant(mode)
            ? plain_
            : Oscillator<T>(drive_.mass, equation.damping, equation.stiffness);
    const T drift = equation.pull.rate / equation.stiffness;
    const T pull = start_.tangential
                       ? drive_.mass * start_.acceleration + equation.damping * (state_.v - drift)
                       : equation.pull.value - equation.damping * drift;
    return Flow<T>::free(oscillator, state_.x, state_.v, start_.acceleration,
                         -pull / equation.stiffness, drift);
  }

  /// The time to the earliest event. What happens at the row of an input to rounding happens there.
  T earliest(const Flow<T>& flow) {
    const T row = row_ - time_;
    T first = row;
    if (flow.velocity.oscillates()) first = std::min(first, flow.oscillator.serves_for());
    for (int i = 0; i < guards_count_; ++i) {
      Guard& guard = guards_[i];
      guard.root = never;
      if (guard.path.start >= 0 && guard.path.constant()) continue;
      if (hidden(guard)) continue;
      const T horizon = first < never ? first + rounding<T> * (time_ + first) : never;
      guard.root = guard.path.straight() && guard.path.centre() == 0
                       ? zero(flow.oscillator, guard.path)
                       : first_root(flow.oscillator, guard.path, 1, horizon);
      first = std::min(first, guard.root);
    }
    return row < never && row - first <= rounding<T> * (time_ + row) ? row : first;
  }

  /// The first zero of a pure oscillation.
  static T zero(const Oscillator<T>& oscillator, const Path<T>& path) {
    return Rooted<T>::at(oscillator, path, oscillator.zeros(path.start, path.slope).first);
  }

  /// Whether another guard comes to zero first for certain: it runs below this one, at a constant
  /// distance beyond rounding, or falls to the middle of its oscillation while this one rises.
  bool hidden(const Guard& guard) const {
    using std::abs;
    const Path<T>& p = guard.path;
    const T farther = p.start - rounding<T> * (p.start + abs(state_.v));
    for (int i = 0; i < guards_count_; ++i) {
      const Path<T>& q = guards_[i].path;
      if (q.start < farther && q.value == p.value && q.slope == p.slope && q.drift == p.drift &&
          q.curvature == p.curvature)
        return true;
      if (q.slope < 0 && q.value == -p.value && q.slope == -p.slope && q.centre() == 0 &&
          q.straight() && p.straight())
        return true;
    }
    return false;
  }

  // ---- to the event ------------------------------------------------------------------------------

  /// Ends a segment and brings the state to the event: what has reached its end is exactly there.
  void jump(Segment<T>& segment, T tau) {
    using std::abs;
    const Mode mode = segment.mode;
    const Flow<T>& flow = segment.flow;
    const T coincident = tau + rounding<T> * (time_ + tau);
    const bool half_turn = tau == half_period_ && flow.velocity.value == 0 && friction_.constant(mode);
    segment.moved = half_turn ? half_turn_ : flow.after(tau);
    state_.x = flow.position.at(segment.moved, tau);
    state_.v = flow.velocity.at(segment.moved, tau);
    x_size_ = std::max({x_size_, abs(state_.x), abs(flow.position.value * segment.moved.decline),
                        abs(flow.position.slope * segment.moved.gain)});
    if (!Surface::plain && mode.finger == Slide::gripping)
      state_.skin = -segment.finger_force.at(segment.moved, tau);
    else if (!Surface::plain && slides(mode.finger))
      state_.skin = sign(mode.finger) * drive_.finger.kinetic;
    const bool row = tau == row_ - time_;
    segment.end = time_ = row ? row_ : time_ + tau;
    if (row) {
      look_ahead();
    } else {
      state_.plate_velocity.value = state_.plate_velocity.at(tau);
      state_.load.value = state_.load.at(tau);
    }
    reached_ = {};
    bool at_plate = mode.plate == Slide::stuck, at_finger = mode.finger == Slide::stuck;
    for (int i = 0; i < guards_count_; ++i) {
      const Guard& guard = guards_[i];
      if (!(guard.root <= coincident)) continue;
      if (guard.bound == Bound::none) {
        if (mode.finger == Slide::gripping && guard.finger)
          state_.skin = guard.side * drive_.finger.static_limit;
        else if (!row)
          reached_.limit = guard.side;
        continue;
      }
      (guard.plate ? reached_.plate : reached_.finger) = guard.bound;
      const int index = guard.plate ? mode.plate_region : mode.finger_region;
      if (guard.bound == Bound::lower && index == 0) {
        (guard.plate ? at_plate : at_finger) = true;
      } else {
        const Region<T> region = (guard.plate ? drive_.plate : drive_.finger).region(index);
        const T speed = guard.bound == Bound::lower ? region.from : region.to;
        state_.v = guard.plate ? state_.plate_velocity.value + sign(mode.plate) * speed
                               : sign(mode.finger) * speed;
      }
    }
    if (at_plate && at_finger) state_.plate_velocity.value = T(0);
    if (at_finger)
      state_.v = T(0);
    else if (at_plate)
      state_.v = state_.plate_velocity.value;
  }

  void look_ahead() {
    state_.plate_velocity = inputs_.mouse_velocity.from(time_);
    state_.load = inputs_.plate_load.from(time_);
    row_ = std::min(inputs_.mouse_velocity.next_row(time_), inputs_.plate_load.next_row(time_));
  }

  // ---- how the motion ends -----------------------------------------------------------------------

  /// How a mode that lasts for ever ends.
  End ending(const Segment<T>& segment) {
    const Flow<T>& flow = segment.flow;
    outcome_.since = time_;
    if (!flow.position.oscillates())
      return flow.velocity.start == 0 && flow.velocity.straight() ? End::resting : End::moving;
    const T alpha = flow.oscillator.alpha();
    if (alpha < 0) return End::decaying;
    if (alpha > 0) return End::moving;
    outcome_.period = flow.oscillator.period();
    const bool tangential = flow.velocity.slope == 0 && next_.plate.at == Bound::lower;
    return tangential ? End::grazing : End::free;
  }

  void note_recurrence(const Segment<T>& segment) {
    const Mode before = segment.mode, after = next_.mode();
    const bool release = before.plate == Slide::stuck && after.plate != Slide::stuck;
    if (release) hold_begin_ = segment.begin;
    if (row_ < never || !(release || after.plate_region > before.plate_region)) return;
    const Visit<T> now{time_, state_.x, state_.v, state_.skin, hold_begin_, after, release};
    const Visit<T>* earlier = recurrence_.earlier(drive_, now);
    if (!earlier) return;
    outcome_.end = release || earlier->released ? End::stick_slip : End::limit_cycle;
    outcome_.period = time_ - earlier->time;
    outcome_.cycle_begin = outcome_.since = earlier->time;
    if (release && after.finger != Slide::gripping)
      outcome_.since = std::max(earlier->hold_begin, earlier->time - (time_ - hold_begin_));
  }

  const Drive<T, Surface>& drive_;
  const Inputs<T, Input>& inputs_;
  Friction<T, Surface> friction_;
  Oscillator<T> plain_;      ///< of a pin on which no contact acts but with a constant force,
  T half_period_;            ///< from one zero of its velocity to the next,
  Transition<T> half_turn_;  ///< and how it has moved on there

  T time_{0};
  State<T> state_;
  T x_size_;      ///< the largest that the position is a sum of, m
  T row_{never};  ///< time of the next row of an input, s

  Reached reached_;
  Candidate next_;
  Start<T> start_;
  bool consistent_{true};
  std::array<Guard, 6> guards_;
  int guards_count_{0};

  Recurrence<T> recurrence_;
  T hold_begin_{0};
  Outcome<T> outcome_{};
};

}  // namespace pindrive
