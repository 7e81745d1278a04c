/// Detection of steady motions by recurrence (docs/theory.md, section 14).
///
/// A cycle is found in two phases (Brent 1980). `CycleDetector` finds its period during the simulation, by
/// comparing the state after each event with kept states. `steady_since` (steady_since.hpp) finds its
/// beginning afterwards, from the stored segments.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/events/irregularity.hpp"
#include "pindrive/events/trend.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Sets the ending of a motion whose last mode lasts for ever, as far as its inputs continue. A position that
/// follows an accelerating plate has none.
template <class T>
void end_with(const Segment<T>& last, Outcome<T>& outcome) {
  const Flow<T>& flow = last.flow;
  const Path<T>& x = flow.position;
  const T alpha = flow.oscillator.alpha();
  if (x.curvature != 0 || (x.oscillates() && alpha > 0)) return;
  if (x.drift != 0) {
    outcome.end = End::drifting;
  } else if (!x.oscillates()) {
    outcome.end = last.eliminated == EliminatedPart::motion ? End::decaying : End::resting;
  } else if (alpha < 0) {
    outcome.end = End::decaying;
  } else {
    // After a release with zero relative acceleration, the velocity touches that of the plate once a period.
    const bool grazes = is_slip(last.mode.plate) && flow.velocity.slope == 0 &&
                        flow.velocity.start == last.plate_velocity.value;
    outcome.end = grazes ? End::grazing : End::free;
    outcome.period = flow.oscillator.period();
  }
}

/// Detects that a motion between constant inputs has returned to an earlier state. Events of every kind are
/// compared.
///
/// Each state is compared with two kept states. One is renewed after ever more events, so that a period of any
/// length is found, and the other after few events, so that a short period is found soon. The first three events
/// are not kept: most motions come to rest after few. A return within `return_tolerance` closes a cycle. A cycle
/// that is approached geometrically is followed from return to return, and closed when the contraction bounds its
/// remaining distance by `approach_tolerance`.
///
/// A motion that has not returned after many events may be irregular (irregularity.hpp).
///
/// Under periodic inputs, the events are the begins of their periods.
template <class T>
class CycleDetector {
 public:
  explicit CycleDetector(const Drive<T>& drive) : drive_(drive) {}

  /// Compares an event at time + time_error, between a segment and the mode and state after the event. Sets the
  /// ending in the outcome if the event closes a cycle. `driven`: it begins a period of the inputs. `slow`: the segment
  /// takes long to simulate.
  void visit(const Segment<T>& ended, const Mode& mode, T time, T time_error, const State<T>& state,
             Outcome<T>& outcome, bool driven = false, bool slow = false) {
    driven_ = driven;
    if (count_ < first_kept_event) {
      ++count_;
      return;
    }
    const Event now{time, time_error, mode, state};
    const long long memory = driven ? 1 : short_memory;  // most responses repeat each period
    if (count_ > first_kept_event) {
      if (driven && returns_to(recent_, ended, now, outcome)) return;
      // A response that is approached each period is not closed by a longer return.
      if (driven && period_ > 0 && distance_ < T(approach_tolerance))
        extend(kept_, ended, now.state);
      else if (returns_to(kept_, ended, now, outcome))
        return;
      if (!driven && count_ > memory && returns_to(recent_, ended, now, outcome)) return;
      if (period_ > 0 && approaches(ended, now, outcome)) return;
    }
    if (driven && count_ >= irregular_periods)
      irregularity_.visit_period(time, state, outcome);
    else if (count_ >= irregular_window)
      irregularity_.visit(ended, time, state, outcome);
    if (slow && count_ >= irregular_window) {
      trend_.add(ended, state);
      trend_.visit(time, state, outcome);
    }
    if (count_ % memory == 0) keep(recent_, now);
    if (count_ == next_) {
      keep(kept_, now);
      next_ += std::max(next_ / 4, std::min(next_, short_memory)) + 1;
    }
    ++count_;
  }

  /// Includes a segment that ends without an event to be compared in the scales of the motion.
  void pass(const Segment<T>& ended, const State<T>& state) {
    if (count_ <= first_kept_event) return;
    for (Visit* visit : {&kept_, &recent_, &followed_}) extend(*visit, ended, state);
    if (count_ >= irregular_window) trend_.add(ended, state);
  }

  /// True if the motion has taken too many periods.
  bool is_too_long() const { return trend_.is_too_long(); }
  /// Outcome of a motion that has taken too many periods: it grows, approaches a limit, or is terminated.
  Outcome<T> terminated(Outcome<T> outcome) const {
    if (!trend_.conclude(outcome)) outcome.status = Status::too_many_periods;
    return outcome;
  }

 private:
  /// An event: its time, and the mode and the state after it.
  struct Event {
    T time, time_error;  ///< s; their sum is the time
    const Mode& mode;
    const State<T>& state;
  };
  /// A kept event, and the scales of the motion since then.
  struct Visit {
    long long index{0};
    T time{0}, time_error{0};
    Mode mode{};
    State<T> state{};
    Extent<T> extent{};
    T stuck{0};  ///< time of stick on the plate since then, s
  };

  static constexpr T never = std::numeric_limits<T>::infinity();

  void keep(Visit& visit, const Event& now) const {
    visit = {count_, now.time, now.time_error, now.mode, now.state, {}, T(0)};
  }
  /// Includes the segment that an event ends in the scales since a kept event.
  static void extend(Visit& visit, const Segment<T>& ended, const State<T>& state) {
    visit.extent.add(ended, state.x, state.v);
    if (ended.mode.plate == ContactState::stick) visit.stuck += ended.end - ended.begin;
  }

  /// Distance between the states after two events as a fraction of the natural scales; infinite for
  /// different modes, or if the motion in between is within the rounding of its position.
  T separation(const Visit& earlier, const Event& now) const {
    if (!same_mode(earlier.mode, now.mode) || !(now.time > earlier.time)) return never;
    const T length = std::max(earlier.extent.length(), abs(now.state.x - earlier.state.x));
    const bool moves = length > T(rest_tolerance) * abs(now.state.x);
    if (!moves && driven_ && now.mode.stuck()) return T(0);  // periodic inputs that move no pin
    if (!moves) return never;
    const T rounded = rounding<T> * std::max(abs(now.state.x), length);
    const auto apart = [](T one, T other, T error, T scale) {
      const T beyond = abs(one - other) - error;
      return beyond > 0 ? beyond / scale : T(0);
    };
    const State<T>&one = earlier.state, &other = now.state;
    const T displaced = apart(one.x, other.x, rounded, length);
    if (!(displaced < near_return))
      return never;  // most events: the remaining scales need no comparison
    const T omega0 = sqrt(drive_.stiffness / drive_.mass);
    const T speed = earlier.extent.speed();
    T most = std::max(displaced, apart(one.v, other.v, rounded * omega0, speed));
    const Contact<T>& finger = drive_.finger;
    if (finger.may_lag())
      most = std::max(most,
                      apart(one.slider_velocity, other.slider_velocity, rounded * omega0, speed));
    if (finger.may_lag() || now.mode.finger == ContactState::elastic_stick)
      most = std::max(most, apart(one.skin, other.skin, finger.stiffness * rounded,
                                  std::min(finger.stiffness * length, finger.static_limit)));
    return most;
  }

  /// Compares an event with a kept one. True if it closes a cycle; a near return is followed.
  bool returns_to(Visit& earlier, const Segment<T>& ended, const Event& now, Outcome<T>& outcome) {
    extend(earlier, ended, now.state);
    const T distance = separation(earlier, now);
    const long long period = count_ - earlier.index;
    if (distance <= T(return_tolerance) && (period != period_ || converges(distance)))
      return close(earlier, now, outcome);
    // The shorter of two returns of a response that are alike is followed.
    const T factor = !driven_ || period == period_ ? T(1)
                     : period > period_            ? T(near_return)
                                                   : 1 / T(near_return);
    if (distance < near_return && (period_ == 0 || distance < factor * distance_)) {
      period_ = period;
      distance_ = distance;
      ratio_ = T(1);
      keep(followed_, now);
    }
    return false;
  }

  /// Compares the next return of the followed period. True if the remaining returns together, a geometric
  /// series, stay within the tolerance, so that the cycle is closed.
  bool approaches(const Segment<T>& ended, const Event& now, Outcome<T>& outcome) {
    if (count_ == followed_.index) return false;
    extend(followed_, ended, now.state);
    if (count_ != followed_.index + period_) return false;
    const T distance = separation(followed_, now), ratio = distance / distance_;
    const T slower = std::max(ratio, ratio_);
    const bool returns = distance <= T(return_tolerance) && converges(distance);
    ratio_ = ratio;
    distance_ = distance;
    if (!(ratio < 1)) period_ = 0;
    const bool within = slower < 1 && distance <= T(approach_step) &&
                        distance / (1 - slower) <= T(approach_tolerance) && !driven_;
    if (within || returns) return close(followed_, now, outcome);
    keep(followed_, now);
    return false;
  }

  /// True if the returns of the followed period that remain after one at a distance are together within the
  /// tolerance: those of an algebraic approach, whose ratio tends to 1, are not.
  bool converges(T distance) const {
    return !(distance > (1 - distance / distance_) * T(approach_tolerance));
  }

  bool close(const Visit& begin, const Event& now, Outcome<T>& outcome) const {
    outcome.period = (now.time - begin.time) + (now.time_error - begin.time_error);
    const bool sticks = begin.stuck > T(repeat_tolerance) * outcome.period;  // sticks, not grazes
    outcome.end = driven_ ? End::driven : sticks ? End::stick_slip : End::limit_cycle;
    outcome.cycle_begin = begin.time;
    return true;
  }

  const Drive<T>& drive_;
  Visit kept_, recent_, followed_;
  long long count_{0};                ///< events so far
  long long next_{first_kept_event};  ///< count at which the kept visit is renewed
  long long period_{0};               ///< period of the followed approach, in events; 0 without one
  T distance_{0}, ratio_{1};          ///< distance of its last return; ratio to the distance before
  bool driven_{false};                ///< under periodic inputs
  IrregularityDetector<T> irregularity_;
  Trend<T> trend_;
};

}  // namespace pindrive::detail
