/// What the event loop needs of a segment whose mode has no closed form: a step of its series.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pindrive/law/friction.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/series/series_mode.hpp"

namespace pindrive::detail {

/// The step of a series that the present segment is; none where its mode has a closed form.
template <class T>
class SeriesSegment {
 public:
  bool used() const { return step_.has_value(); }

  /// Whether a slider has the velocity at which its skin stretches as it has to: its force follows the load.
  bool follows() const { return step_ && step_->without == FastPart::of_slider; }

  void reset() { step_.reset(); }

  /// Begins a segment of a mode without a closed form (that, its begin and its plate velocity are set). Its
  /// flow says how it begins, with its acceleration as a drift of the velocity.
  /// `at_limit` is the side on which a stick force is at its limit, `no_push` says that a stop's push is
  /// exactly zero, `span` the time until the next row or the end, s. Its guards come with their zeros.
  template <class Side>
  void begin(Segment<T>& segment, Guards<T>& guards, const Drive<T>& drive, const Side& plate,
             const Side& finger, const Line<T>& force, const State<T>& state, T acceleration,
             int at_limit, bool no_push, T span) {
    using std::abs;
    const SeriesMode<T> mode(
        drive, segment.mode,
        {segment.plate_velocity, plate.load, plate.across, force, finger.load});
    const SeriesEquation<T> equation = mode.equation();
    const bool lags = finger.lags();
    const SeriesState<T> start{state.x, state.v, lags ? state.slide : state.skin, acceleration,
                               segment.begin};
    const SeriesStep<T>& step = step_.emplace(series_step(equation, start, span));
    segment.without = step.without;
    const auto paths = mode.guards(step, {plate.does.at, finger.does.at, at_limit, no_push});
    const bool held = held_by_stop(drive, segment.mode);
    guards.clear();
    for (const auto& guard : paths)
      guards.add_known(guard.zero, guard.bound, guard.plate, guard.side,
                       segment.mode.stuck() && !held && &guard - paths.begin() < 2);
    const T turns = abs(equation.across.rate) + abs(equation.plate_velocity.rate);
    const T left = abs(equation.across.at(span)) + abs(equation.plate_velocity.at(span));
    stops_ = equation.held && equation.side == 0 &&
             left <= 4 * rounding<T> * (segment.begin + span) * turns;
    first_ = guards.earliest_known(step.span());
    // What ends it at once may do so as late as where its step ends, as at a row.
    const T row = step.span() < span && first_ > 0 ? never : step.span();
    const auto speed_of = [&](bool on_plate) {
      return abs((on_plate ? step.speed : lags ? step.skin : step.velocity).c[0]);
    };
    first_ = guards.put_off(first_, row, [&](const Guard<T>& guard, T tau) {
      const Polynomial<T>& path = paths.begin()[&guard - guards.begin()].path;
      const T roundoff = guard.bound == Bound::none || guard.bound == Bound::push
                             ? state.roundoff
                             : rounding<T> * (path.size() + speed_of(guard.plate));
      const T fall = path.derivative().at(guard.zero) * (tau - guard.zero);
      return stays_at_bound(fall, path.at(tau), roundoff);
    });
    const T stick = step.stick_force.c[0];
    const T of_plate = plate.stuck() && !held ? stick : plate.force(state);
    const T of_finger = !finger.stuck() || held ? finger.force(state)
                        : plate.stuck()         ? T(0)
                                                : stick;
    const T rate = equation.held ? equation.surface.rate : acceleration;
    segment.flow = {{}, {state.x, T(0), T(0)}, {step.velocity.c[0], T(0), T(0), rate}};
    segment.plate_force = {of_plate, T(0), T(0)};
    segment.finger_force = {of_finger, T(0), T(0)};
    // Of skin whose slider lags, with the rate at which it stretches.
    if (lags) segment.finger_force.drift = finger.force_rate(state.v, T(0)).value;
  }

  /// The time to the earliest event, the end of the step or the row; what happens at the row to the rounding
  /// of a time happens there. So does what is some roundings before a row at which the plate comes to rest, along
  /// and across: the direction in which it slides under a pin that is held is not known there.
  T earliest(T since, T row) const {
    const T known = (stops_ ? 128 : 1) * rounding<T> * (since + row);
    return row < never && row - first_ <= known ? row : first_;
  }

  /// The time at which a moving pin turns; infinite if it does not within the step.
  T turning_point() const {
    if (!step_ || step_->velocity.c[0] == 0) return never;
    const Polynomial<T>& velocity = step_->velocity;
    return first_zero(velocity.c[0] > 0 ? velocity : T(-1) * velocity);
  }

  /// Brings the state on by τ, unless the mode has a closed form.
  template <class Side>
  void move(State<T>& state, const Drive<T>& drive, const Side& finger, T tau) const {
    using std::abs;
    using std::sqrt;
    if (!step_) return;
    const SeriesStep<T>& step = *step_;
    const SeriesState<T> now = step.at(tau);
    state.x = now.x;
    state.v = now.v;
    state.x_size = std::max(state.x_size, abs(state.x));
    if (finger.elastic()) state.skin = now.skin;
    if (!finger.lags()) return;
    state.slide = now.skin;
    // A pin and a slider whose velocities have faded into the rounding of the position are at rest, which is
    // known no better than by what these still carry.
    const T size = std::max(abs(state.x), abs(step.position.c[0]));
    const T still = rounding<T> * size * sqrt(drive.stiffness / drive.mass);
    const T pull = drive.mass * step.velocity.derivative().at(tau) + drive.damping * state.v +
                   finger.branch().slope * finger.load.at(tau) * state.slide;
    const T known = 2 * abs(pull) / (rounding<T> * drive.stiffness);
    if (finger.does.branch != 0 || abs(state.v) > still || abs(state.slide) > still) return;
    if (known > 64 * (1 + drive.damping * still / state.roundoff) * size) return;
    state.v = state.slide = T(0);
    state.x_size = std::max(state.x_size, known);
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  std::optional<SeriesStep<T>> step_;
  bool stops_{
      false};   ///< whether the plate comes to rest under a pin that is held, at the next row
  T first_{0};  ///< the time to its first guard's zero, or its end, s
};

}  // namespace pindrive::detail
