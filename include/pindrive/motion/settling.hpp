/// Settling time of a motion: last time with a distance from a position larger than a width.
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

/// Settling of a motion over [0, duration]; the motion outlives the measurement.
template <class T>
class Settling {
 public:
  Settling(const Motion<T>& motion, T duration, GoOn go_on = {})
      : motion_(motion), duration_(duration), go_on_(go_on) {}

  /// Earliest time after which |x − x_end| stays within the band, a fraction of |x(0) − x_end|, for
  /// a motion that rests or decays; if |x(0) − x_end| is zero, the time of rest. NaN if later than
  /// the duration, or never.
  T within(T x_end, T band) const {
    const T way = motion_.begin()->flow.position.start - x_end;
    T size = abs(x_end);
    for (const Segment<T>& segment : motion_)
      size = std::max(size, abs(segment.flow.position.start));
    // A motion that turns at the edge of the band, to its error, stays within.
    const bool by_criterion = std::prev(motion_.end())->eliminated == EliminatedPart::motion;
    const T part = by_criterion ? T(band_error_at_rest) : band_error<T>;
    const T error = part * size;
    const bool returns = !(abs(way) > error);  // ends at its start: the band has no width
    const bool rests = motion_.outcome().end == End::resting;
    const T since =
        returns && !rests ? never : last_outside(x_end, returns ? error : band * abs(way) + error);
    return since <= duration_ && since < never ? since : none;
  }

  /// Last time at which |x − x_end| exceeds the width: 0 if never, infinite if always.
  T last_outside(T x_end, T width) const {
    T since{0};
    for (const Segment<T>* segment = motion_.end();
         since == 0 && segment != motion_.begin() && go_on_();)
      since = motion_.along(
          *--segment, [&](const auto& along) { return entry(along, *segment, x_end, width); });
    return since;
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();
  static constexpr T none = std::numeric_limits<T>::quiet_NaN();

  /// Time in a segment from which |x − x_end| stays within the width, evaluated from extremum to
  /// extremum: 0 if never outside, infinite if outside at the end.
  template <class Trajectory>
  T entry(const Trajectory& along, const Segment<T>& segment, T x_end, T width) const {
    T since{0};
    // Beyond the width on either side: where it comes within for good, or infinite.
    for (const int side : {1, -1}) {
      const auto beyond = T(side) * along.above(along.position(), x_end + side * width);
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
  T entry(const ClosedForm<T>& along, const Segment<T>& segment, T x_end, T width) const {
    T since{0};
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const Path<T>& x = segment.flow.position;
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
        const T guess = x.oscillates() ? high - turn : low;
        const T root = root_between(oscillator, distance, low, high, side, guess);
        since = segment.begin + Rooted<T>::at(oscillator, distance, root);
      }
      low = high;
      before = after;
    };
    if (abs(before) > width) since = never;
    if (isfinite(segment.end)) {
      if (may_turn(segment)) {
        const Stretch last = last_stretch_outside(along, segment, x_end, width);
        before = x.at(segment.after(last.from)) - x_end;
        extrema(along, x, last.from, last.to, follow_to);
      } else {
        const T to = segment.end - segment.begin;
        follow_to(to, x.at(segment.after(to)));
      }
      return since;
    }
    if (!x.oscillates()) return since;  // at x_end
    if (!(width > 0)) return never;     // approached for ever
    const Zeros<T> turns = oscillator.zeros(x.slope, segment.flow.velocity.slope);
    if (turns.first < never) follow_to(turns.first, x.at(oscillator, turns.first));
    if (turns.spacing < never && abs(before) > width) {
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
  /// Part of a finite segment to be evaluated: until |x − x_end| stays within the width. A long
  /// oscillation is bisected until only the last few periods outside the band remain.
  static Stretch last_stretch_outside(const ClosedForm<T>& along, const Segment<T>& segment,
                                      T x_end, T width) {
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const Path<T>& x = segment.flow.position;
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
  T duration_;
  GoOn go_on_;
};

}  // namespace pindrive::detail
