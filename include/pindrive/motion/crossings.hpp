/// Where position, velocity and acceleration of a motion cross a level, and their extrema: exactly, from
/// the closed form of each segment, with the cycles of a motion expanded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "pindrive/flow/roots.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/motion/motion.hpp"

namespace pindrive {

namespace detail {

/// Follows the sign of one path, and the value of another, from segment to segment. What comes to zero and
/// stays there changes its sign, when it leaves to the other side, at the time at which it came.
template <class T>
class SignChanges {
 public:
  /// Calls visit(time, value, sign after) at each change along the first `span` of a trajectory that begins
  /// at a time, until it returns false; returns that.
  template <class Trajectory, class Path, class Visitor>
  bool follow(const Trajectory& along, const Path& path, const Path& value, T begin, T span,
              Visitor&& visit) {
    using std::abs;
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
        // What comes to zero where the segment ends, to rounding, is judged by how the next one begins.
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

  /// Forgets the sign, where the path begins anew.
  void restart() { side_ = 0, zero_ = false; }

 private:
  void come(T time, T value) { zero_ = true, zero_time_ = time, zero_value_ = value; }

  int side_{0};
  bool zero_{false};  ///< at zero, since this time, with this value
  T zero_time_{0}, zero_value_{0};
};

}  // namespace detail

/// Calls visit(time, sign after) wherever a quantity changes from one side of a level to the other in
/// [0, until], until it returns false; s. Touching the level is no change.
template <class T, class Visitor>
void crossings(const Motion<T>& motion, Quantity quantity, T level, T until, Visitor&& visit) {
  detail::SignChanges<T> changes;
  motion.expanded(T(0), until, [&](const Segment<T>& segment, T begin, T span) {
    return motion.along(segment, [&](const auto& along) {
      const auto path = along.above(quantity_of(along, quantity), level);
      return changes.follow(along, path, path, begin, span,
                            [&](T time, T, int side) { return goes_on(visit, time, side); });
    });
  });
}

/// Calls visit(time, value) at the extrema of a quantity in [0, until], in order, until it returns false:
/// where the motion begins and ends, where the quantity turns, and on both sides of a jump. Between two
/// neighbours it is continuous and goes one way.
template <class T, class Visitor>
void extrema(const Motion<T>& motion, Quantity quantity, T until, Visitor&& visit) {
  using std::abs;
  const Drive<T>& drive = motion.drive();
  detail::SignChanges<T> changes;
  bool began = false, more = true, struck = false;  // a rigid stop, where the last segment ended
  T time{0}, end{0};  // of the last visit; value where the last segment ended
  const auto add = [&](T at, T value) {
    time = at;
    if (quantity == Quantity::position) value = drive.stops.within(value);
    return more = goes_on(visit, at, value);
  };
  const auto jumps = [&](const Flow<T>& flow, T value) {
    if (quantity == Quantity::velocity) return struck && value != end;
    if (quantity != Quantity::acceleration) return false;
    const T forces =
        drive.stiffness * abs(flow.position.start) + drive.damping * abs(flow.velocity.start);
    const T terms = abs(value) + abs(end) + forces / drive.mass;
    return abs(value - end) > 8 * detail::rounding<T> * terms;
  };
  motion.expanded(T(0), until, [&](const Segment<T>& segment, T begin, T span) {
    return motion.along(segment, [&](const auto& along) {
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

/// Calls visit(time, segment) at the events in [from, to], with the segment that each one ends, until it
/// returns false; s.
template <class T, class Visitor>
void events(const Motion<T>& motion, T from, T to, Visitor&& visit) {
  motion.expanded(from, to, [&](const Segment<T>& segment, T begin, T) {
    const T time = segment.end + (begin - segment.begin);
    return !segment.event.any() || !(time >= from && time <= to) || goes_on(visit, time, segment);
  });
}

}  // namespace pindrive
