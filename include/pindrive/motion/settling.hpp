/// Settling time of a motion: last time with a distance from a position, or from a line, larger than a width.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/flow/roots.hpp"
#include "pindrive/motion/extrema.hpp"
#include "pindrive/motion/motion.hpp"

namespace pindrive::detail {

/// True if a pin slides on a finger at rest, and therefore does not turn back.
template <class T>
bool may_turn(const Segment<T>& segment) {
  return !is_slip(segment.mode.finger);
}

/// Settling of a motion over [0, duration] about a goal: a line over time, whose rate is zero for a motion that
/// rests or decays. The motion outlives the measurement.
template <class T>
class Settling {
 public:
  Settling(const Motion<T>& motion, const Line<T>& goal, T duration, GoOn go_on = {})
      : motion_(motion), goal_(goal), duration_(duration), go_on_(go_on) {}

  /// Earliest time after which the distance from the goal stays within the band, a fraction of the
  /// distance at the start; if that is zero, the time of rest. NaN if later than the duration, or
  /// never.
  T within(T band) const {
    const T way = motion_.begin()->flow.position.start - goal_.value;
    T size = abs(goal_.value);
    for (const Segment<T>& segment : motion_)
      size = std::max(size, abs(segment.flow.position.start));
    // A motion that turns at the edge of the band, to its error, stays within.
    const bool by_criterion = std::prev(motion_.end())->eliminated == EliminatedPart::motion;
    const T part = by_criterion ? T(band_error_at_rest) : band_error<T>;
    const T error = part * size;
    const bool returns = !(abs(way) > error);  // ends at its start: the band has no width
    const bool rests = motion_.outcome().end == End::resting;
    const T since =
        returns && !rests ? never : last_outside(returns ? error : band * abs(way) + error);
    return since <= duration_ && since < never ? since : none;
  }

  /// Last time at which the distance from the goal exceeds the width: 0 if never, infinite if always.
  T last_outside(T width) const {
    T since{0};
    for (const Segment<T>* segment = motion_.end();
         since == 0 && segment != motion_.begin() && go_on_();)
      since = motion_.along(*--segment,
                            [&](const auto& along) { return entry(along, *segment, width); });
    return since;
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();
  static constexpr T none = std::numeric_limits<T>::quiet_NaN();

  /// The goal from the begin of a segment on.
  Line<T> goal_from(const Segment<T>& segment) const {
    return {goal_.at(segment.begin), goal_.rate};
  }

  /// Time in a segment from which the distance from the goal stays within the width, evaluated from
  /// extremum to extremum: 0 if never outside, infinite if outside at the end.
  template <class Trajectory>
  T entry(const Trajectory& along, const Segment<T>& segment, T width) const {
    T since{0};
    const Line<T> goal = goal_from(segment);
    // Beyond the width on either side: where it comes within for good, or infinite.
    for (const int side : {1, -1}) {
      const auto beyond =
          T(side) * along.above(along.position(), Line<T>{goal.value + side * width, goal.rate});
      int sign = along.side_after_start(beyond);
      T last = sign > 0 ? never : T(0);
      along.each_root(beyond, sign, segment.end - segment.begin, [&](T tau) {
        sign = -sign;
        last = sign > 0 ? never : segment.begin + tau;
        return true;
      });
      since = std::max(since, last);
    }
    return since;
  }
  T entry(const ClosedForm<T>& along, const Segment<T>& segment, T width) const {
    T since{0};
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const Line<T> goal = goal_from(segment);
    Path<T> x = segment.flow.position;  // from the moving goal, plus its value at the begin
    x.drift -= goal.rate;
    const T x_end = goal.value;
    T low{0}, before = x.start - x_end;
    const auto follow_to = [&](T high, T position) {
      const T after = position - x_end;
      if (abs(after) > width) {
        since = never;
      } else if (abs(before) > width) {
        const int side = before > 0 ? 1 : -1;
        Path<T> distance = x;
        distance.start -= x_end + side * width;
        // Before a turning point it is near a cosine whose swing the damping widens.
        const T part = (side * width - after) / (2 * (x.centre() - position));
        const T angle = 2 * sqrt(part) * (1 + part / 6 + part * part * T(0.075));
        const T damping_ratio = -oscillator.alpha() / oscillator.omega();
        const T turn = angle * (1 - damping_ratio * angle / 3) / oscillator.omega();
        // A pin that is carried has no oscillator of its own, whose period could be asked.
        const T guess = x.oscillates() && x.straight() ? high - turn : low;
        const T root = root_between(oscillator, distance, low, high, side, guess);
        since = segment.begin + Rooted<T>::at(oscillator, distance, root);
      }
      low = high;
      before = after;
    };
    if (abs(before) > width) since = never;
    if (isfinite(segment.end)) {
      if (goal.rate != 0 || may_turn(segment)) {
        const Stretch last = last_stretch_outside(along, segment, x, x_end, width);
        before = x.at(segment.after(last.from)) - x_end;
        extrema(along, x, last.from, last.to, follow_to);
      } else {
        const T to = segment.end - segment.begin;
        follow_to(to, x.at(segment.after(to)));
      }
      return since;
    }
    if (!x.oscillates()) return since;  // at the goal
    if (!(width > 0)) return never;     // approached for ever
    const Zeros<T> turns = oscillator.zeros(x.slope, segment.flow.velocity.slope);
    if (turns.first < never) follow_to(turns.first, x.at(oscillator, turns.first));
    if (turns.spacing < never && abs(before) > width) {
      if (oscillator.alpha() == 0) return never;
      // The extrema of a free decay shrink by one factor, so the last one outside is known.
      const T count = floor(log(abs(before) / width) / (-oscillator.alpha() * turns.spacing));
      low = turns.first + count * turns.spacing;
      before = x.at(oscillator, low) - x_end;
      while (abs(before) > width)
        follow_to(low + turns.spacing, x.at(oscillator, low + turns.spacing));
    } else if (turns.spacing == never) {
      T step = -1 / oscillator.slowest_rate();
      while (abs(x.at(oscillator, low + step) - x_end) > width && isfinite(2 * step)) step *= 2;
      follow_to(low + step, x.at(oscillator, low + step));
    }
    return since;
  }

  struct Stretch {
    T from, to;
  };
  /// Part of a finite segment to be evaluated: until |x − x_end| stays within the width, for its position x. A long
  /// oscillation is bisected until only the last few periods outside the band remain.
  static Stretch last_stretch_outside(const ClosedForm<T>& along, const Segment<T>& segment,
                                      const Path<T>& x, T x_end, T width) {
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    Stretch last{T(0), segment.end - segment.begin};
    const auto strays = [&](T from, T to) {
      bool outside = false;
      highest_and_lowest(along, x, from, to, [&](T, T position) {
        outside = outside || abs(position - x_end) > width;
      });
      return outside;
    };
    while (x.oscillates() && last.to - last.from > 8 * oscillator.period()) {
      const T middle = last.from + (last.to - last.from) / 2;
      (strays(middle, last.to) ? last.from : last.to) = middle;
    }
    return last;
  }

  const Motion<T>& motion_;
  Line<T> goal_;
  T duration_;
  GoOn go_on_;
};

}  // namespace pindrive::detail
