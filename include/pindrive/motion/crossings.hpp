/// Level crossings and extrema of position, velocity and acceleration: exactly, from the closed
/// form of each segment, with cycles expanded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pindrive/flow/roots.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

namespace detail {

/// Tracks the sign of one path, and the value of another, from segment to segment. A path that
/// reaches zero, stays there and leaves to the opposite side changes its sign at the time at which
/// it reached zero.
template <class T>
class SignChanges {
 public:
  /// Calls visit(time, value, sign after) at each sign change along the first `span` of a
  /// trajectory that begins at a time, until visit returns false; returns the last result.
  template <class Trajectory, class Path, class Visitor>
  bool follow(const Trajectory& along, const Path& path, const Path& value, T begin, T span,
              Visitor&& visit) {
    const int start = along.side_after_start(path);
    if (start == 0) {
      if (!zero_) come(begin, along.start(value));
      return true;
    }
    if (!zero_) come(begin, along.start(value));
    const bool changes = side_ * start < 0;
    side_ = start;
    zero_ = false;
    bool more = !changes || visit(zero_time_, zero_value_, side_);
    const Path slope = along.derivative(path);
    const T terms = along.terms(path, span);
    if (more)
      along.each_root(path, start, span, [&](T tau) {
        // A zero at the end of the segment, to rounding, is decided by the start of the next segment.
        const T rest = span - tau, rate = along.at(slope, tau);
        const bool soon = along.hurry_squared() * rest * rest <= T(at_end * at_end);
        if (rest <= rounding<T> * (begin + span) ||
            (soon && abs(rate) * rest <= rounding<T> * terms))
          return false;
        side_ = -side_;
        return more = visit(begin + tau, along.at(value, tau), side_);
      });
    return more;
  }

  /// Resets the sign, where the path begins anew.
  void restart() { side_ = 0, zero_ = false; }

 private:
  void come(T time, T value) { zero_ = true, zero_time_ = time, zero_value_ = value; }

  int side_{0};
  bool zero_{false};  ///< at zero; since this time, with this value
  T zero_time_{0}, zero_value_{0};
};

}  // namespace detail

/// Calls visit(time, sign after) where a quantity crosses a level in [0, until], s, until visit
/// returns false. A tangency is no crossing. `go_on` is called after each segment.
template <class T>
void crossings(const Motion<T>& motion, Quantity quantity, T level, T until,
               detail::Given<Callback<T, int>> visit, GoOn go_on = {}) {
  detail::SignChanges<T> changes;
  motion.expanded(T(0), until, [&](const Segment<T>& segment, T begin, T span) {
    return go_on() && motion.along(segment, [&](const auto& along) {
      const auto path = along.above(quantity_of(along, quantity), level);
      return changes.follow(along, path, path, begin, span,
                            [&](T time, T, int side) { return visit(time, side); });
    });
  });
}

/// Calls visit(time, value) at the extrema of a quantity in [0, until], s, in order, until visit
/// returns false: at begin and end, at turning points, and on both sides of a jump. Between two
/// neighbours the quantity is continuous and monotone.
template <class T>
void extrema(const Motion<T>& motion, Quantity quantity, T until,
             detail::Given<Callback<T, T>> visit, GoOn go_on = {}) {
  using std::abs;
  const Drive<T>& drive = motion.drive();
  detail::SignChanges<T> changes;
  bool began = false, more = true, struck = false;  // a rigid stop, where the last segment ended
  T time{0}, end{0};  // time of the last visit; value at the end of the last segment
  const auto add = [&](T at, T value) {
    time = at;
    if (quantity == Quantity::position) value = drive.stops.within(value);
    return more = visit(at, value);
  };
  const auto jumps = [&](const Flow<T>& flow, T value) {
    if (quantity == Quantity::velocity) return struck && value != end;
    if (quantity != Quantity::acceleration) return false;
    const T forces =
        drive.stiffness * abs(flow.position.start) + drive.damping * abs(flow.velocity.start);
    const T terms = abs(value) + abs(end) + forces / drive.mass;
    return abs(value - end) > detail::difference_error<T> * terms;
  };
  motion.expanded(T(0), until, [&](const Segment<T>& segment, T begin, T span) {
    return go_on() && motion.along(segment, [&](const auto& along) {
      const auto path = quantity_of(along, quantity);
      const T start = along.start(path);
      if (!began) {
        add(begin, start);
      } else if (jumps(segment.flow, start)) {
        changes.restart();
        if (add(begin, end)) add(begin, start);
      }
      began = true;
      if (more)
        changes.follow(along, along.derivative(path), path, begin, span,
                       [&](T at, T value, int) { return add(at, value); });
      end = along.at(path, span);
      struck = drive.stops.rigid() && stops(segment.event.stop);
      return more;
    });
  });
  if (began && more && time < until) add(until, end);
}

/// Calls visit(time, segment) at the events in [from, to], s, with the segment that each event
/// ends, until visit returns false.
template <class T>
void events(const Motion<T>& motion, T from, T to,
            detail::Given<Callback<T, const Segment<T>&>> visit, GoOn go_on = {}) {
  motion.expanded(from, to, [&](const Segment<T>& segment, T begin, T) {
    if (!go_on()) return false;
    const T time = segment.end + (begin - segment.begin);
    return !segment.event.any() || !(time >= from && time <= to) || visit(time, segment);
  });
}

}  // namespace pindrive
