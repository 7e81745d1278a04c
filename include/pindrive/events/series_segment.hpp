/// Segment of a mode under functions or a law that is not linear: one step of its series, or a closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pindrive/law/contact_point.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/driven_motion.hpp"
#include "pindrive/series/series_mode.hpp"

namespace pindrive::detail {

/// Series step or driven motion of the present segment; empty for a mode whose closed form is a flow.
template <class T>
class SeriesSegment {
 public:
  bool used() const { return step_ || driven_; }
  /// Step of the present segment; null for a closed form.
  const SeriesStep<T>* step() const { return step_ ? &*step_ : nullptr; }

  /// True if the slider has its stationary velocity, so that its force follows the load.
  bool has_eliminated_slider() const {
    return step_ && step_->eliminated == EliminatedPart::of_slider;
  }

  void reset() {
    step_.reset();
    driven_.reset();
  }

  /// Begins a segment of a mode without a closed form, whose mode, begin and plate velocity are
  /// set.
  ///
  /// The flow of the segment holds its initial values, with the acceleration as drift of the
  /// velocity. `at_limit`: side on which a stick force is at its limit. `no_push`: the push of a
  /// stop is exactly zero. `span`: time until the next breakpoint or the end, s. `longest`: longest closed form, s.
  /// Guards are added with their zeros.
  template <class Point>
  [[gnu::noinline]] void begin(Segment<T>& segment, Guards<T>& guards, const Drive<T>& drive,
                               const Point& plate, const Point& finger, const Curve<T>& force,
                               const State<T>& state, T acceleration, int at_limit, bool no_push,
                               T span, T longest = never) {
    const SeriesMode<T> mode(
        drive, segment.mode,
        {segment.plate_velocity, plate.load, plate.across, force, finger.load});
    const SeriesEquation<T> equation = mode.equation();
    const bool has_slider_state = finger.has_slider_state();
    const SeriesState<T> start{state.x, state.v,
                               has_slider_state ? state.slider_velocity : state.skin, acceleration,
                               segment.begin};
    const SeriesStep<T>& step = step_.emplace(series_step(equation, start, span));
    segment.eliminated = step.eliminated;
    const auto paths = mode.guards(step, {plate.mode.guard, finger.mode.guard, at_limit, no_push});
    const bool held = held_by_stop(drive, segment.mode);
    guards.clear();
    for (const auto& guard : paths)
      guards.add_known(guard.zero, guard.bound, guard.plate, guard.side,
                       segment.mode.stuck() && !held && &guard - paths.begin() < 2);
    const T turns = abs(equation.across.rate) + abs(equation.plate_velocity.rate);
    const T left = abs(equation.across.at(span)) + abs(equation.plate_velocity.at(span));
    stops_ = equation.held && equation.side == 0 &&
             left <= difference_error<T> * (segment.begin + span) * turns;
    first_ = guards.earliest_known(step.span());
    // An immediate end may be deferred to the end of the step, as to a breakpoint.
    const bool ends_early = step.span() < (1 - rounding<T>)*span;
    const T breakpoint = ends_early && first_ > 0 ? never : step.span();
    const auto speed_of = [&](bool on_plate) {
      return abs((on_plate ? step.speed : has_slider_state ? step.skin : step.velocity).c[0]);
    };
    // A function has the rounding of its terms; a pin that creeps has it in its velocity.
    const auto unsure = [&](const Curve<T>& input) {
      return input.straight() ? T(0) : T(input.rounding(step.span()));
    };
    const T of_plate_velocity = unsure(equation.plate_velocity) + unsure(equation.across);
    const bool creeps = step.eliminated == EliminatedPart::of_friction;
    first_ = guards.defer_grazing(first_, breakpoint, [&](const Guard<T>& guard, T tau) {
      const Polynomial<T>& path = paths.begin()[&guard - guards.begin()].path;
      const T force_error = guard.bound == ActiveGuard::none || guard.bound == ActiveGuard::push
                                ? state.force_error
                                : rounding<T> * (path.size() + speed_of(guard.plate)) +
                                      (guard.plate || creeps ? of_plate_velocity : T(0));
      const T fall = path.derivative().at(guard.zero) * (tau - guard.zero);
      return stays_at_bound(fall, path.at(tau), force_error);
    });
    if (equation.side == 0 && first_ < step.span() && !ends_early &&
        rests(equation.plate_velocity, first_, span) && rests(equation.across, first_, span))
      first_ = step.span();
    const T stick = step.stick_force.c[0];
    const T of_plate = plate.stuck() && !held ? stick : plate.force(state);
    const T of_finger = !finger.stuck() || held ? finger.force(state)
                        : plate.stuck()         ? T(0)
                                                : stick;
    const T rate = equation.held ? equation.surface.rate : acceleration;
    segment.flow = {{}, {state.x, T(0), T(0)}, {step.velocity.c[0], T(0), T(0), rate}};
    segment.plate_force = {of_plate, T(0), T(0)};
    segment.finger_force = {of_finger, T(0), T(0)};
    // With the stretch rate of skin that has a slider velocity.
    if (has_slider_state) segment.finger_force.drift = finger.force_rate(state.v, T(0)).value;
    if constexpr (uses_driven_motion) {
      const bool passes = first_ == step.span() &&
                          std::none_of(paths.begin(), paths.end(),
                                       [](const auto& guard) { return guard.zero < never; });
      if (passes && step.span() * shortest_driven < span && mode.has_constant_coefficients() &&
          DrivenMotion<T>::holds(equation))
        drive_on(segment, mode, DrivenMotion<T>(equation, start), state.position_scale, step.span(),
                 std::min(span, longest));
    }
  }

  /// Time to the earliest event, the end of the step or the breakpoint.
  ///
  /// An event within the time resolution of the breakpoint happens there. So does an event a few
  /// resolutions before a breakpoint at which the plate comes to rest in both directions: the
  /// sliding direction under a pin that is held is undetermined there.
  T earliest(T since, T breakpoint) const {
    const T known = (stops_ ? before_rest<T> : rounding<T>)*(since + breakpoint);
    return breakpoint < never && breakpoint - first_ <= known ? breakpoint : first_;
  }

  /// Time at which a moving pin turns; infinite if the pin does not turn within the step.
  T turning_point() const {
    if (!step_ || step_->velocity.c[0] == 0) return never;
    const Polynomial<T>& velocity = step_->velocity;
    return first_zero(velocity.c[0] > 0 ? velocity : T(-1) * velocity);
  }

  /// Advances the state by τ, unless the mode has a closed form.
  template <class Point>
  void move(State<T>& state, const Drive<T>& drive, const Point& finger, T tau) const {
    if (!step_ && !driven_) return;
    const SeriesState<T> now = driven_ ? driven_->at(tau)
                               : step_ ? step_->at(tau)
                                       : SeriesState<T>{};
    state.x = now.x;
    state.v = now.v;
    state.position_scale = std::max(state.position_scale, abs(state.x));
    if (finger.elastic()) state.skin = now.skin;
    if (!finger.has_slider_state() || !step_) return;
    state.slider_velocity = now.skin;
    const SeriesStep<T>& step = *step_;
    // Pin and slider are at rest once their velocities are within the rounding of the position; the error of the
    // position of rest then follows from the remaining forces.
    const T size = std::max(abs(state.x), abs(step.position.c[0]));
    const T still = rounding<T> * size * sqrt(drive.stiffness / drive.mass);
    const T pull = drive.mass * step.velocity.derivative().at(tau) + drive.damping * state.v +
                   finger.branch().slope * finger.load.at(tau) * state.slider_velocity;
    const T known = 2 * abs(pull) / (rounding<T> * drive.stiffness);
    if (finger.mode.branch != 0 || abs(state.v) > still || abs(state.slider_velocity) > still)
      return;
    if (known > 64 * (1 + drive.damping * still / state.force_error) * size) return;
    state.v = state.slider_velocity = T(0);
    state.position_scale = std::max(state.position_scale, known);
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  /// Replaces a step at whose end no guard is zero by a motion in closed form: until the first step in which a
  /// guard has a zero, which a series finds.
  void drive_on(Segment<T>& segment, const SeriesMode<T>& mode, const DrivenMotion<T>& motion,
                T largest, T first, T span) {
    const auto reach = [&](Real<T> tau) { return motion.reach(tau); };
    T known = first;
    int steps = 0;
    each_step(first, span, reach, [&](T tau, Real<T> length) {
      const auto guards = mode.from(tau).guards(motion.step(tau, length));
      for (const auto& guard : guards)
        if (!(guard.path.c[0] > 0) || guard.zero < never) return false;
      if (!motion.is_accurate(largest, tau + length)) return false;
      known = tau + length;
      return ++steps < most_driven_steps;
    });
    if (!(known > shortest_driven * first)) return;
    first_ = plain(span - known) <= 0 ? span : known;
    segment.driven = true;
    driven_ = motion;
    step_.reset();
  }

  /// True if an input is zero within rounding from a time to another: at its ends and at a time between them that is
  /// no period.
  static bool rests(const Curve<T>& input, T from, T to) {
    const T known = input.rounding();
    const auto is_zero = [&](T tau) { return abs(input.at(tau)) <= known; };
    return is_zero(from) && is_zero(to) && is_zero(from + T(0.382) * (to - from));
  }

  static constexpr int most_driven_steps = 4096;  ///< between which a simulation can be interrupted

  std::optional<SeriesStep<T>> step_;
  std::optional<DrivenMotion<T>> driven_;
  bool stops_{false};  ///< the plate comes to rest under a pin that is held, at the next breakpoint
  T first_{0};         ///< time to the zero of the first guard, or to the end of the step, s
};

}  // namespace pindrive::detail
