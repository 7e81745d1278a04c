/// Motion of a pin as pieces on which deflection and skin stretch are monotone: searches for levels and
/// extrema miss nothing between samples, as there are none.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/device/sign_change.hpp"
#include "pindrive/motion/extrema.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/skin_along.hpp"

namespace pindrive::device {

/// Deflection of the pin, or stretch of the skin under it, counted forward: in the direction in which
/// the plate moves.
struct Signal {
  bool skin;
  double sign;  ///< 1, or −1 where the plate moves backward

  Signal operator-() const { return {skin, -sign}; }
};

/// Time and value.
struct Point {
  double time, value;
};

/// Rise of a signal from a lowest to the next highest value.
struct Swing {
  Point low, high;
  double height() const { return high.value - low.value; }
};

/// Pieces of the motion of one pin.
class MonotonePieces {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

  /// Deflection and skin stretch; both the deflection under a rigid finger, whose skin moves as far as
  /// the pin at most.
  struct Values {
    double x, skin;
  };
  /// Begin of a piece, which lasts to the next knot.
  struct Knot {
    double time;
    Values before, after;  ///< one-sided limits
    const Segment<double>* segment;
    double segment_begin;  ///< of this round of a cycle, s
  };

  static double value(const Signal& of, const Values& values) {
    return of.sign * (of.skin ? values.skin : values.x);
  }

  /// Stretch of the skin in a segment, m; the deflection of the pin under a rigid finger.
  template <class Trajectory>
  auto stretch_in(const Segment<double>& segment, const Trajectory& along) const {
    const Drive<double>& drive = motion_->drive();
    return rigid_
               ? 1.0 * along.position()
               : -1 / drive.finger.stiffness * detail::stretch_force_along(drive, segment, along);
  }
  template <class Trajectory, class Quantity>
  Values values_of(const Trajectory& along, const Quantity& in_skin, double tau, double x) const {
    x = motion_->drive().stops.within(x);
    return {x, rigid_ ? x : along.at(in_skin, tau)};
  }

  void begin_piece(double time, const Values& now, const Segment<double>& segment, double begin) {
    begin_piece(time, now, segment, begin, knots_.empty() ? now : end_);
  }
  void begin_piece(double time, const Values& now, const Segment<double>& segment, double begin,
                   const Values& before) {
    const Knot knot{time, before, now, &segment, begin};
    if (!knots_.empty() && knots_.back().time == time) {
      const Values first = knots_.back().before;
      knots_.back() = knot;
      knots_.back().before = first;
    } else {
      knots_.push_back(knot);
    }
  }

  /// Piece that contains a time or, on the left side, ends with it.
  std::size_t place(double t, Side side) const {
    const auto last = knots_.end() - 1;
    const auto after =
        side == Side::right
            ? std::upper_bound(knots_.begin() + 1, last, t,
                               [](double time, const Knot& knot) { return time < knot.time; })
            : std::lower_bound(knots_.begin() + 1, last, t,
                               [](const Knot& knot, double time) { return knot.time < time; });
    return static_cast<std::size_t>(after - knots_.begin()) - 1;
  }

  /// Calls f with a signal as a function of the time in a piece, whose trajectory is expanded once.
  template <class Function>
  auto in_piece(const Signal& of, std::size_t i, Function&& f) const {
    const Knot& knot = knots_[i];
    return motion_->along(*knot.segment, [&](const auto& along) {
      const bool skin = of.skin && !rigid_;
      const auto signal = skin ? stretch_in(*knot.segment, along) : 1.0 * along.position();
      return f([&](double t) {
        const double found = along.at(signal, t - knot.segment_begin);
        return of.sign * (skin ? found : motion_->drive().stops.within(found));
      });
    });
  }

  /// First time in a piece at which f of a signal is no longer negative.
  template <class Function>
  double change(const Signal& of, std::size_t i, double low, double high, Function&& f) const {
    return in_piece(of, i, [&](const auto& at) {
      return sign_change([&](double t) { return f(at(t)); }, low, high);
    });
  }

  /// Calls visit(begin, end, piece) for each part of a piece in [from, to], with the one-sided limits of
  /// a signal, until visit returns false.
  template <class Visitor>
  void each(const Signal& of, double from, double to, Visitor&& visit) const {
    Point begin{from, at(of, from)};
    std::size_t i = place(from, Side::right);
    for (; i + 2 < knots_.size() && knots_[i + 1].time < to; ++i) {
      const Knot& knot = knots_[i + 1];
      if (!visit(begin, Point{knot.time, value(of, knot.before)}, i)) return;
      begin = {knot.time, value(of, knot.after)};
    }
    visit(begin, Point{to, at(of, to, Side::left)}, i);
  }

 public:
  /// Replaces the pieces by those of a motion in [0, duration]; the motion must outlive them.
  void read(const Motion<double>& motion, double duration) {
    motion_ = &motion;
    rigid_ = motion.drive().finger.rigid();
    knots_.clear();
    motion.expanded(0.0, duration, [&](const Segment<double>& segment, double begin, double span) {
      if (begin > 0 && !(begin < duration)) return false;
      span = std::min(span, duration - begin);
      motion.along(segment, [&](const auto& along) {
        const auto in_skin = stretch_in(segment, along);
        bool first = true;
        const auto add = [&](double tau, double x) {
          const Values now = values_of(along, in_skin, tau, x);
          if (first)
            begin_piece(begin, now, segment, begin);
          else if (tau < span)
            begin_piece(begin + tau, now, segment, begin, now);
          first = false;
        };
        if (detail::has_damped_skin(motion.drive(), segment) && is_slip(segment.mode.finger)) {
          turns_.clear();
          const auto keep = [&](double tau, double) { turns_.push_back(tau); };
          detail::extrema(along, along.position(), 0.0, span, keep);
          detail::extrema(along, in_skin, 0.0, span, keep);
          std::sort(turns_.begin(), turns_.end());
          turns_.erase(std::unique(turns_.begin(), turns_.end()), turns_.end());
          for (const double tau : turns_) add(tau, along.at(along.position(), tau));
        } else {
          detail::extrema(along, along.position(), 0.0, span, add);
        }
        end_ = values_of(along, in_skin, span, along.at(along.position(), span));
      });
      return true;
    });
    knots_.push_back({duration, end_, end_, knots_.back().segment, knots_.back().segment_begin});
  }

  /// End of the pieces, s.
  double end() const { return knots_.back().time; }

  double at(const Signal& of, double t, Side side = Side::right) const {
    const std::size_t i = place(t, side);
    if (const Knot& knot = knots_[i + (side == Side::left ? 1 : 0)]; knot.time == t)
      return value(of, side == Side::left ? knot.before : knot.after);
    return in_piece(of, i, [&](const auto& at) { return at(t); });
  }

  /// Largest value in [from, to], and its time.
  Point highest(const Signal& of, double from, double to) const {
    Point start{from, -infinity}, end = start;  // largest at the begin and at the end of a piece
    each(of, from, to, [&](Point a, Point b, std::size_t) {
      if (a.value > start.value) start = a;
      if (b.value > end.value) end = b;
      return true;
    });
    return start.value >= end.value ? start : end;
  }

  /// First time in [from, to] at which a signal is at a level or above; NaN without one.
  double first_at(const Signal& of, double level, double from, double to) const {
    double found = nan;
    each(of, from, to, [&](Point a, Point b, std::size_t i) {
      if (a.value >= level)
        found = a.time;
      else if (b.value >= level)
        found = change(of, i, a.time, b.time, [&](double y) { return y - level; });
      return std::isnan(found);
    });
    return found;
  }

  /// Last time in [from, to] at which a signal without jumps is `band` or more from `middle`; `from`
  /// without one.
  double last_beyond(const Signal& of, double middle, double band, double from, double to) const {
    const auto beyond = [&](double y) { return std::abs(y - middle) >= band; };
    if (beyond(at(of, to))) return to;
    double low = nan, high = nan;
    std::size_t piece = 0;
    each(of, from, to, [&](Point a, Point b, std::size_t i) {
      if (beyond(a.value)) low = a.time, high = b.time, piece = i;
      return true;
    });
    if (std::isnan(low)) return from;
    return change(of, piece, low, high, [&](double y) { return band - std::abs(y - middle); });
  }

  /// First time in [from, to] at which a signal without jumps exceeds its lowest value by a height, NaN
  /// without one; and the time of that lowest value, the last one if it lies there for a while.
  struct Climb {
    double time, low_time;
    bool found() const { return !std::isnan(time); }
  };
  Climb climb(const Signal& of, double height, double from, double to) const {
    Point low{from, infinity}, last{to, infinity};
    double found = nan;
    each(of, from, to, [&](Point a, Point b, std::size_t i) {
      // A segment ends within rounding of where the next begins, which is exact.
      if (a.value <= low.value) low = a;
      if (b.value - low.value >= height)
        found = change(of, i, a.time, b.time, [&](double y) { return y - low.value - height; });
      last = b;
      return std::isnan(found);
    });
    return {found, last.value <= low.value ? last.time : low.time};
  }

  /// Rises of a signal without jumps in [from, to], in order.
  std::vector<Swing> swings(const Signal& of, double from, double to) const {
    std::vector<Swing> found;
    bool rising = false;
    each(of, from, to, [&](Point a, Point b, std::size_t) {
      if (b.value > a.value) {
        if (rising)
          found.back().high = b;
        else
          found.push_back({a, b});
      }
      rising = b.value > a.value;
      return true;
    });
    return found;
  }

  /// True if the finger holds the pin at rest just before a time.
  bool rests(double t) const {
    const Knot& knot = knots_[place(t, Side::left)];
    const Segment<double>& segment = *knot.segment;
    const bool still = segment.flow.velocity.start == 0 && segment.flow.acceleration().start == 0;
    const bool held = segment.mode.stuck() || segment.mode.stop != StopState::apart;
    const bool resting = segment.mode.finger == ContactState::stick || (held && still);
    if (!resting) return false;
    return motion_->value(segment, t - knot.segment_begin, Quantity::velocity) == 0;
  }

  /// Calls visit(begin, end) for each stretch of time in which the plate holds the pin.
  template <class Visitor>
  void each_hold(Visitor&& visit) const {
    double begin = nan;
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
      const bool held = knots_[i].segment->mode.plate == ContactState::stick;
      if (held && std::isnan(begin)) begin = knots_[i].time;
      if (!held && !std::isnan(begin)) {
        visit(begin, knots_[i].time);
        begin = nan;
      }
    }
    if (!std::isnan(begin)) visit(begin, end());
  }

 private:
  const Motion<double>* motion_{nullptr};
  bool rigid_{false};
  std::vector<Knot> knots_;
  Values end_{};               ///< at the end of the last segment read
  std::vector<double> turns_;  ///< of one segment, s
};

}  // namespace pindrive::device
