/// Numbers of the steady motion in which a motion ends: centre, amplitude, period, peak velocity
/// and rounds.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/motion/crossings.hpp"
#include "pindrive/motion/extrema.hpp"
#include "pindrive/motion/motion.hpp"

namespace pindrive {

/// Numbers of a steady or irregular motion. A round is an oscillation about the centre, from one upward
/// crossing of the centre to the next.
template <class T>
struct SteadyNumbers {
  static constexpr T none = std::numeric_limits<T>::quiet_NaN();

  T centre{none};           ///< middle of the range of the position, m
  T amplitude{none};        ///< half of the range of the position, m
  T least_amplitude{none};  ///< half of the range in the smallest round, m
  T peak_velocity{none};    ///< largest |x'|, m/s
  T period{none};  ///< time of one repetition, s; of an irregular motion, mean time of a round
  T rounds{none};  ///< in one repetition; NaN of an irregular motion
};

namespace detail {

template <class T>
struct Range {
  T low{std::numeric_limits<T>::infinity()}, high{-std::numeric_limits<T>::infinity()};

  void add(T value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  T centre() const { return (low + high) / 2; }
  T half() const { return (high - low) / 2; }
};

/// Measures the stretch of a motion, which outlives it, from `cycle_begin` to its end.
template <class T>
class SteadyMeasurement {
 public:
  SteadyMeasurement(const Motion<T>& motion, GoOn go_on = {}) : motion_(motion), go_on_(go_on) {}

  /// Range of the position, m.
  Range<T> range() const {
    Range<T> found;
    each_segment([&](const auto& along, T span) { add_position(found, along, T(0), span); });
    return found;
  }

  SteadyNumbers<T> measure() const {
    const Range<T> position = range();
    SteadyNumbers<T> found;
    found.centre = position.centre();
    found.amplitude = position.half();
    found.peak_velocity = T(0);
    each_segment([&](const auto& along, T span) {
      highest_and_lowest(along, along.velocity(), T(0), span, [&](T, T velocity) {
        found.peak_velocity = std::max(found.peak_velocity, abs(velocity));
      });
    });
    const Rounds rounds = this->rounds(found.centre);
    const bool repeats = motion_.outcome().cycles();
    found.least_amplitude = rounds.count > 1 ? rounds.least : found.amplitude;
    found.period = repeats ? motion_.outcome().period : (rounds.last - rounds.first) / rounds.count;
    if (repeats) found.rounds = std::max(rounds.crossings, T(1));
    return found;
  }

 private:
  /// Upward crossings of the centre, and the rounds between them.
  struct Rounds {
    T crossings{0}, count{0};
    T first{0}, last{0};                          ///< times of the first and the last crossing, s
    T least{std::numeric_limits<T>::infinity()};  ///< smallest half range of a round, m
  };
  Rounds rounds(T centre) const {
    Rounds found;
    SignChanges<T> changes;
    Range<T> round;
    T begin{0};
    each_segment([&](const auto& along, T span) {
      const auto path = along.above(along.position(), centre);
      T from{0};
      changes.follow(along, path, path, begin, span, [&](T time, T, int side) {
        if (side < 0) return true;
        const T tau =
            std::max(time - begin, from);  // an earlier pass through the centre is possible
        add_position(round, along, from, tau);
        from = tau;
        if (found.crossings > 0) {
          found.count += T(1);
          found.least = std::min(found.least, round.half());
        } else {
          found.first = time;
        }
        found.crossings += T(1);
        found.last = time;
        round = {};
        return true;
      });
      add_position(round, along, from, span);
      begin += span;
    });
    return found;
  }

  template <class Trajectory>
  void add_position(Range<T>& range, const Trajectory& along, T from, T to) const {
    highest_and_lowest(along, along.position(), from, to,
                       [&](T, T x) { range.add(motion_.drive().stops.within(x)); });
  }
  /// Calls visit(along, span) for each segment of the stretch.
  template <class Visitor>
  void each_segment(Visitor&& visit) const {
    for (const Segment<T>& segment : motion_) {
      if (!go_on_()) return;
      if (segment.begin < motion_.outcome().cycle_begin) continue;
      motion_.along(segment, [&](const auto& along) { visit(along, segment.end - segment.begin); });
    }
  }

  const Motion<T>& motion_;
  GoOn go_on_;
};

}  // namespace detail

/// Numbers of the motion in which a motion ends; NaN where it is at rest, decays or is not known.
template <class T>
SteadyNumbers<T> steady_numbers(const Motion<T>& motion, GoOn go_on = {}) {
  const Outcome<T>& outcome = motion.outcome();
  if (outcome.cycles() || outcome.end == End::irregular)
    return detail::SteadyMeasurement<T>(motion, go_on).measure();
  SteadyNumbers<T> found;
  if (outcome.end == End::growing || outcome.end == End::approaching) found.period = outcome.period;
  if (!outcome.steady()) return found;
  const Flow<T>& last = std::prev(motion.end())->flow;
  found.centre = last.position.centre();
  found.amplitude = found.least_amplitude = last.amplitude();
  found.peak_velocity = last.amplitude() * last.oscillator.omega();
  found.period = outcome.period;
  found.rounds = T(1);
  return found;
}

}  // namespace pindrive
