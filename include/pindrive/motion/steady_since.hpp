/// Beginning of a steady motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/model/model.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/steady_numbers.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

namespace detail {

/// Time of the last breakpoint of the inputs, s; 0 without breakpoints. No motion is steady before.
template <class T>
T last_breakpoint(const Inputs<T>& inputs) {
  T last{0};
  for (T breakpoint;
       (breakpoint = inputs.next_breakpoint(last)) < std::numeric_limits<T>::infinity();)
    last = breakpoint;
  return last;
}

/// Beginning of a steady motion: the first event from which the motion agrees with its periodic
/// continuation into the past.
///
/// Motion and continuation are compared backwards from event to event of both. The comparison at
/// equal times, not at equal events, also serves phases that vanish as a cycle is approached, and
/// motions that join within a phase.
template <class T>
class FirstRepeat {
 public:
  explicit FirstRepeat(const Motion<T>& motion, GoOn go_on = {})
      : motion_(motion),
        go_on_(go_on),
        known_(motion.outcome().cycles() ? motion.outcome().cycle_begin
                                         : std::prev(motion.end())->begin),
        period_(motion.outcome().period),
        last_breakpoint_(last_breakpoint(motion.inputs())) {}

  T find() const {
    const T tolerance = T(repeat_tolerance) * amplitude();
    const Segment<T>* own = motion_.locate(known_, Side::right).segment;
    const Segment<T>*const first = own, *const last = std::prev(motion_.end());
    const Segment<T>* continued = last;
    T periods{1};
    for (T since = known_; since > last_breakpoint_ && go_on_();) {
      const T before = own == motion_.begin() ? T(0) : std::prev(own)->begin;
      const T before_too =
          motion_.outcome().cycles() ? continued->begin - periods * period_ : last_breakpoint_;
      const T next = std::max({before, before_too, last_breakpoint_});
      const int parts = comparisons(since - next);
      for (int i = 0; i < parts; ++i)
        if (next < since && !agrees(next + T(i) / T(parts) * (since - next), tolerance))
          return since;
      since = std::min(since, next);
      if (before >= next && own != motion_.begin()) --own;
      if (!(before_too >= next)) continue;
      if (continued == first) periods += T(1);
      continued = continued == first ? last : std::prev(continued);
    }
    return last_breakpoint_;
  }

 private:
  /// Comparisons between two events: four in a natural period, but at least four.
  int comparisons(T length) const {
    const Drive<T>& drive = motion_.drive();
    const auto quarters = plain(length * sqrt(drive.stiffness / drive.mass)) / 1.5707963267948966;
    return quarters > 4 ? static_cast<int>(std::min(quarters, decltype(quarters)(64))) : 4;
  }
  /// True if motion and continuation have equal positions at a time; for an oscillation without
  /// events, which begins in finite time, also equal modes.
  bool agrees(T time, T tolerance) const {
    const Mode mode = motion_.locate(time, Side::right).segment->mode;
    if (!motion_.outcome().cycles() && !same_mode(mode, std::prev(motion_.end())->mode))
      return false;
    const T one = position(time);
    const T other = position(time - floor((time - known_) / period_) * period_);
    return abs(one - other) <= tolerance + rounding<T> * std::max(abs(one), abs(other));
  }
  T position(T time) const {
    const auto place = motion_.locate(time, Side::right);
    return motion_.value(*place.segment, place.tau, Quantity::position);
  }
  /// Amplitude of the steady motion, m.
  T amplitude() const {
    if (!motion_.outcome().cycles()) return std::prev(motion_.end())->flow.amplitude();
    return SteadyMeasurement<T>(motion_, go_on_).range().half();
  }

  const Motion<T>& motion_;
  GoOn go_on_;
  T known_;                     ///< time from which the motion is steady in any case, s
  T period_, last_breakpoint_;  ///< s
};

}  // namespace detail

/// Time from which a motion that ends in a steady one is periodic, to `repeat_tolerance` of its amplitude, s;
/// NaN of any other motion.
template <class T>
T steady_since(const Motion<T>& motion, GoOn go_on = {}) {
  return motion.outcome().steady() ? detail::FirstRepeat<T>(motion, go_on).find()
                                   : std::numeric_limits<T>::quiet_NaN();
}

}  // namespace pindrive
