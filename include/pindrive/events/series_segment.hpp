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
  const SeriesStep<T>* step() const { return step_ && !driven_ ? &*step_ : nullptr; }

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
    const T damper = finger.elastic() ? drive.finger.damping * state.v : T(0);
    const SeriesState<T> start{state.x, state.v,
                               has_slider_state ? state.slider_velocity : state.skin - damper,
                               acceleration, segment.begin};
    const Reached reached{plate.mode.guard, finger.mode.guard, at_limit, no_push};
    Paths paths;  // guards along the last step
    T since{0};   // begin of that step
    reset();
    if constexpr (uses_driven_motion)
      if (mode.has_constant_coefficients() && DrivenMotion<T>::holds(equation))
        since = drive_on(mode, equation, start, reached, state.position_scale, span,
                         std::min(span, longest), paths);
    if (!used()) {
      step_.emplace(series_step(equation, start, span));
      paths = mode.guards(*step_, reached);
    }
    const SeriesStep<T>* const last = step_ ? &*step_ : nullptr;
    segment.driven = driven_.has_value();
    segment.eliminated = last ? last->eliminated : EliminatedPart::none;
    const bool held = held_by_stop(drive, segment.mode);
    const T end = last ? since + last->span() : since;
    const T late = rounding<T> * (segment.begin + end);
    guards.clear();
    for (const auto& guard : paths) {
      const bool ends = guard.zero == never && last && falls_to_zero(guard.path, late, guard.error);
      guards.add_known(ends ? end : since + guard.zero, guard.bound, guard.plate, guard.side,
                       segment.mode.stuck() && !held && &guard - paths.begin() < 2);
    }
    const T turns = abs(equation.across.rate) + abs(equation.plate_velocity.rate);
    const T left = abs(equation.across.at(span)) + abs(equation.plate_velocity.at(span));
    // A function has the rounding of its terms.
    const auto rounding_at = [&](T tau) {
      T sum{0};
      for (const Curve<T>* input : {&equation.plate_velocity, &equation.across})
        if (!input->straight()) sum += input->rounding(tau);
      return sum;
    };
    // rounding: tests/hard/plate-rest-in-both-directions-with-reversing-axis.txt
    stops_ = equation.held && equation.side == 0 &&
             left <= difference_error<T> * (segment.begin + span) * turns + rounding_at(span);
    first_ = guards.earliest_known(end);
    // An immediate end may be deferred to the end of the step, as to a breakpoint.
    const bool ends_early = end < span;
    const T breakpoint = ends_early && first_ > 0 ? never : end;
    const auto speed_of = [&](bool on_plate) {
      if (!last) return T(0);
      return abs((on_plate ? last->speed : has_slider_state ? last->skin : last->velocity).c[0]);
    };
    // A pin that creeps, or that the plate takes along, has the rounding of the plate in its velocity.
    const T of_plate_velocity = rounding_at(end);
    const bool follows = plate.stuck() || segment.eliminated == EliminatedPart::of_friction;
    first_ = guards.defer_grazing(first_, breakpoint, [&](const Guard<T>& guard, T tau) {
      const Polynomial<T>& path = paths.begin()[&guard - guards.begin()].path;
      // rounding: tests/hard/slider-at-curve-point-under-falling-load.txt
      const T force_error = guard.bound == ActiveGuard::none || guard.bound == ActiveGuard::push
                                ? state.force_error
                                : rounding<T> * (path.size() + speed_of(guard.plate)) +
                                      (guard.plate || follows ? of_plate_velocity : T(0));
      const T fall = path.derivative().at(guard.zero - since) * (tau - guard.zero);
      return stays_at_bound(fall, path.at(tau - since), force_error);
    });
    T velocity = equation.held ? equation.surface.value : start.v, stick{0};
    if (driven_) {
      stick = driven_->stick_force.start();
    } else if (last) {
      velocity = last->velocity.c[0];
      stick = last->stick_force.c[0];
    }
    const T of_plate = plate.stuck() && !held ? stick : plate.force(state);
    const T of_finger = !finger.stuck() || held ? finger.force(state)
                        : plate.stuck()         ? T(0)
                                                : stick;
    const T rate = equation.held ? equation.surface.rate : acceleration;
    segment.flow = {{}, {state.x, T(0), T(0)}, {velocity, T(0), T(0), rate}};
    segment.plate_force = {of_plate, T(0), T(0)};
    segment.finger_force = {of_finger, T(0), T(0)};
    segment.slider_velocity = has_slider_state ? state.slider_velocity : T(0);
  }

  /// Time to the earliest event, the end of the step or the breakpoint.
  ///
  /// An event within the time resolution of the breakpoint happens there. So does an event a few
  /// resolutions before a breakpoint at which the plate comes to rest in both directions: the
  /// sliding direction under a pin that is held is undetermined there.
  T earliest(T since, T breakpoint) const {
    const T resolution = (stops_ ? before_rest<T> : rounding<T>)*(since + breakpoint);
    return breakpoint < never && breakpoint - first_ <= resolution ? breakpoint : first_;
  }

  /// Time at which a moving pin turns; infinite if the pin does not turn within the step.
  T turning_point() const {
    const SeriesStep<T>* const now = step();
    if (now == nullptr || now->velocity.c[0] == 0) return never;
    const Polynomial<T>& velocity = now->velocity;
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
    if (finger.elastic()) state.skin = now.skin + drive.finger.damping * now.v;
    if (!finger.has_slider_state()) return;
    state.slider_velocity = now.skin;
    if (driven_) return;
    const SeriesStep<T>& step = *step_;
    // rounding: pin and slider are at rest once their velocities are within the rounding of the position; the error of
    // the position of rest then follows from the remaining forces (tests/hard/slider-and-pin-at-rest.txt).
    const T size = std::max(abs(state.x), abs(step.position.c[0]));
    const T still = rounding<T> * size * sqrt(drive.stiffness / drive.mass);
    const T pull = drive.mass * step.velocity.derivative().at(tau) + drive.damping * state.v +
                   finger.branch().slope * finger.load.at(tau) * state.slider_velocity;
    // rounding: tests/hard/slider-at-rest-on-damped-skin-without-load.txt
    const T error = 2 * abs(pull) / (rounding<T> * drive.stiffness);
    if (finger.mode.branch != 0 || abs(state.v) > still || abs(state.slider_velocity) > still)
      return;
    if (error > 64 * (1 + drive.damping * still / state.force_error) * size) return;
    state.v = state.slider_velocity = T(0);
    state.position_scale = std::max(state.position_scale, error);
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  using Reached = typename SeriesMode<T>::Reached;
  using Paths = typename SeriesMode<T>::template StepGuards<Polynomial<T>>;

  /// Begins a motion in closed form that lasts until a guard is zero, or for `longest`; nothing where it is not used.
  ///
  /// Sets the guards along a last step, with their zeros, and returns the begin of that step: the zero itself where no
  /// other guard may be zero. Where a guard is zero at the begin, a series step decides how the motion leaves it; the
  /// step is the segment if a guard has a zero in it.
  T drive_on(const SeriesMode<T>& mode, const SeriesEquation<T>& equation,
             const SeriesState<T>& start, const Reached& reached, T largest, T span, T longest,
             Paths& paths) {
    const DrivenMotion<T> motion(equation, start);
    const auto guards = mode.guards(motion);
    T clear{0};  // no guard has a zero until then
    if (reached.any() || std::any_of(guards.begin(), guards.end(),
                                     [](const auto& guard) { return !(guard.path.start() > 0); })) {
      step_.emplace(series_step(equation, start, span));
      paths = mode.guards(*step_, reached);
      const bool ends = paths.earliest() != nullptr || step_->span() * shortest_driven >= span;
      if (ends || step_->eliminated != EliminatedPart::none) return T(0);
      clear = T(0.9375) * step_->span();  // guards are positive there
    }
    const T reach = motion.reach(plain(clear));
    // A pin that no contact holds may be at rest once its motion has decayed.
    const T decayed = equation.held ? never : clear + motion.decay_time();
    const T latest = std::min({longest, T(clear + most_driven_steps * reach), decayed});
    if (!(latest < never)) return T(0);
    T end = clear;
    for (T length = reach; end < latest; length *= 4) {
      const T next = std::min(latest, T(clear + length));
      if (!motion.is_accurate(largest, next)) break;
      end = next;
    }
    if (!(end > clear)) return T(0);
    T zero = never;
    const auto* first = guards.end();
    for (const auto& guard : guards) {
      const T own = zero_beyond<T>(guard.error, [&](T offset, const auto& visit) {
        auto raised = guard.path;
        raised += Line<T>{offset, T(0)};
        sign_changes(raised, 1, clear, end, std::min(zero, end), visit);
      });
      if (own < zero) first = &guard;
      zero = std::min(zero, own);
    }
    step_.reset();
    driven_.emplace(motion);
    if (!(zero < never)) return end;
    // The last step begins before the zero, where all guards are positive.
    const T since = std::max(clear, T(zero - reach / 2));
    const T rest = end - since;
    const T length = std::max(std::min(T(motion.reach(plain(since))), rest), T(zero - since));
    const auto is_alone = [&](const auto& guard) {
      return &guard == first || guard.path.from(since).least(plain(length)) > 0;
    };
    if (length < rest && std::all_of(guards.begin(), guards.end(), is_alone)) {
      paths.assign(guards, first);
      return zero;
    }
    step_.emplace(motion.step(since, plain(length)));
    paths = mode.from(since).guards(*step_);
    return since;
  }

  /// rounding: true if a polynomial that is positive reaches zero within a time after its end, where a mode without
  /// duration would begin (simulation_test).
  static bool falls_to_zero(const Polynomial<T>& path, T late, detail::Real<T> error) {
    const T end(path.span), value = path.at(end);
    if (value * end > late * T(series_order) * path.size()) return false;
    return value + late * path.derivative().at(end) <= -error;
  }

  static constexpr T most_driven_steps{4096};  ///< between which a simulation can be interrupted

  std::optional<SeriesStep<T>> step_;  ///< the segment or, of a driven motion, its last step
  std::optional<DrivenMotion<T>> driven_;
  bool stops_{false};  ///< the plate comes to rest under a pin that is held, at the next breakpoint
  T first_{0};         ///< time to the zero of the first guard, or to the end of the step, s
};

}  // namespace pindrive::detail
