/// The numbers asked of a motion (MODEL.md §6), from its segments, exactly; never from samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/motion.hpp"
#include "pindrive/roots.hpp"

namespace pindrive {

/// What one contact did during the motion.
template <class T>
struct ContactUse {
  T reversals{0};      ///< how often its sliding velocity came to zero
  T time_stuck{0};     ///< s
  T distance_slid{0};  ///< m
  T dissipated{0};     ///< J
  T peak_force{0};     ///< largest friction force, N
};

template <class T>
struct Transient {
  static constexpr T none = std::numeric_limits<T>::quiet_NaN();

  T peak_displacement{none}, peak_time{none};  ///< x_m,a at t_a: m, s
  T trough_displacement{none},
      trough_time{none};  ///< x_m,c at t_c; t_c infinite if only approached
  T swing{none};          ///< (17), m
  T return_velocity{none}, return_velocity_time{none};  ///< v_m,b at t_b: m/s, s
  T first_reversal_time{none};                          ///< t_1, s
  T settling_time{none};                                ///< s
  T end_position{none};  ///< x_end: where it rests, or the middle of the final oscillation, m
  T amplitude{none};     ///< of the final oscillation, m
  ContactUse<T> plate, finger;
};

/// Measures a motion over [0, duration]; what happens later, or never, is NaN.
template <class T>
class Measurement {
 public:
  Measurement(const Motion<T>& motion, T duration) : motion_(motion), duration_(duration) {}

  Transient<T> transient(T band) const {
    Transient<T> result;
    swing(result);
    first_reversal(result);
    ending(result);
    result.settling_time = settled_after(result.end_position, band);
    contacts(result);
    return result;
  }

  /// Earliest time after which |x − x_end| stays within the band, a part of |x(0) − x_end|; for a
  /// steady oscillation, when that begins.
  T settling_time(T band) const {
    Transient<T> result;
    ending(result);
    return settled_after(result.end_position, band);
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  T settled_after(T x_end, T band) const {
    using std::abs;
    const Outcome<T>& outcome = motion_.outcome();
    T since = Transient<T>::none;
    if (outcome.end == End::moving) return since;
    if (outcome.end != End::resting && outcome.end != End::decaying) {
      since = outcome.since;
    } else {
      const T width = band * abs(motion_.begin()->flow.position.start - x_end);
      since = T(0);
      for (const Segment<T>& segment : motion_) follow_band(segment, x_end, width, since);
    }
    return since <= duration_ && since < never ? since : Transient<T>::none;
  }

  T length(const Segment<T>& segment) const {
    return std::min(segment.end, duration_) - segment.begin;
  }

  static int sign_of(T value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

  /// The direction in which the pin moves just after a segment begins; 0 at rest.
  static int heading(const Flow<T>& flow) {
    const Path<T>& v = flow.velocity;
    if (v.start != 0) return sign_of(v.start);
    if (v.slope + v.drift != 0) return sign_of(v.slope + v.drift);
    return sign_of(flow.oscillator.bend(v.value, v.slope));
  }

  /// Calls visit(time, position) at each turning point in order until it returns false.
  template <class Visitor>
  void turning_points(Visitor&& visit) const {
    int direction = 0;
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > duration_) return;
      const Flow<T>& flow = segment.flow;
      const int start = heading(flow);
      if (direction * start < 0 || (direction != 0 && start == 0))
        if (!visit(segment.begin, flow.position.start)) return;
      direction = start;
      if (direction == 0 || segment.mode.stuck() || turns_end_it(segment)) continue;
      Roots<T, 1> turns(flow.oscillator, flow.velocity, direction, length(segment));
      for (T tau = turns.next(); tau < never; tau = turns.next()) {
        if (!visit(segment.begin + tau, flow.position.at(flow.oscillator, tau))) return;
        direction = -direction;
      }
    }
  }

  /// Whether a velocity of zero is an event, so that no turning point lies inside the segment.
  bool turns_end_it(const Segment<T>& segment) const {
    return segment.mode.finger != Slide::absent ||
           (segment.mode.plate != Slide::absent && motion_.inputs().mouse_velocity == 0);
  }

  /// Peak, trough, swing and the extreme velocity between them.
  void swing(Transient<T>& result) const {
    const Inputs<T>& inputs = motion_.inputs();
    int outward = sign_of(inputs.displacement);
    if (outward == 0) outward = sign_of(inputs.velocity);
    if (outward == 0) outward = sign_of(inputs.mouse_velocity);
    if (heading(motion_.begin()->flow) != outward) {
      result.peak_time = T(0);
      result.peak_displacement = inputs.displacement;
    }
    turning_points([&](T time, T position) {
      if (std::isnan(result.peak_time)) {
        result.peak_time = time;
        result.peak_displacement = position;
        return true;
      }
      result.trough_time = time;
      result.trough_displacement = position;
      return false;
    });
    if (std::isnan(result.peak_time)) return;
    if (std::isnan(result.trough_time) && motion_.outcome().end == End::decaying) {
      result.trough_time = never;
      result.trough_displacement = std::prev(motion_.end())->flow.position.centre();
    }
    result.swing =
        (result.peak_displacement - result.trough_displacement) * (outward == 0 ? 1 : outward);
    return_velocity(result, outward == 0 ? 1 : outward);
  }

  void return_velocity(Transient<T>& result, int outward) const {
    const T until = std::isnan(result.trough_time) ? duration_ : result.trough_time;
    const auto consider = [&](T time, T velocity) {
      if (time < result.peak_time || time > until || -outward * velocity <= 0) return;
      if (outward * velocity >= outward * result.return_velocity) return;
      result.return_velocity = velocity;
      result.return_velocity_time = time;
    };
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > until || segment.begin > duration_) break;
      const Flow<T>& flow = segment.flow;
      consider(segment.begin, flow.velocity.start);
      if (segment.mode.stuck()) continue;
      const Zeros<T> level =
          flow.oscillator.zeros(flow.acceleration.start, flow.acceleration.slope);
      const T stop = std::min(length(segment), until - segment.begin);
      for (T tau = level.first; tau <= stop; tau += level.spacing)
        consider(segment.begin + tau, flow.velocity.at(flow.oscillator, tau));
    }
  }

  void first_reversal(Transient<T>& result) const {
    for (const Segment<T>& segment : motion_) {
      if (segment.end > duration_) return;
      if (!segment.event.plate || segment.event.kind == Kind::slip) continue;
      result.first_reversal_time = segment.end;
      return;
    }
  }

  void ending(Transient<T>& result) const {
    const Outcome<T>& outcome = motion_.outcome();
    const Flow<T>& last = std::prev(motion_.end())->flow;
    switch (outcome.end) {
      case End::moving:
        return;
      case End::resting:
        result.end_position = last.position.start;
        return;
      case End::decaying:
        result.end_position = last.position.centre();
        return;
      case End::free:
      case End::grazing:
        result.end_position = last.position.centre();
        result.amplitude = last.amplitude();
        return;
      case End::stick_slip:
        break;
    }
    T low = never, high = -never;
    const auto widen = [&](T time, T position) {
      if (time < outcome.cycle_begin) return true;
      low = std::min(low, position);
      high = std::max(high, position);
      return true;
    };
    Measurement(motion_, never).turning_points(widen);
    result.end_position = (low + high) / 2;
    result.amplitude = (high - low) / 2;
  }

  /// Follows |x − x_end| against the width through one segment, from extremum to extremum.
  void follow_band(const Segment<T>& segment, T x_end, T width, T& since) const {
    using std::abs;
    using std::log;
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const Path<T>& x = segment.flow.position;
    const bool lasts = !std::isfinite(segment.end);
    if (segment.mode.stuck() && lasts) return;  // at x_end

    const T length = segment.end - segment.begin;
    const Zeros<T> turns = segment.mode.stuck()
                               ? Zeros<T>{never, never}
                               : oscillator.zeros(x.slope, segment.flow.velocity.slope);
    T low = T(0), high = std::min(turns.first, length);
    T before = x.start - x_end;
    if (abs(before) > width) since = never;
    if (lasts && !(width > 0)) {  // approached for ever
      since = never;
      return;
    }
    const bool shrinks = lasts && turns.spacing < never;
    const T extremum = shrinks ? abs(x.at(oscillator, high) - x_end) : T(0);
    if (extremum > width) {
      // The extrema of a free decay shrink by one factor, so the last one outside is known.
      const T count = std::floor(log(extremum / width) / (-oscillator.alpha() * turns.spacing));
      low = high + count * turns.spacing;
      high = low + turns.spacing;
      before = x.at(oscillator, low) - x_end;
      since = never;
    }
    for (;;) {
      const bool tail = !std::isfinite(high);
      if (tail) high = settled_by(oscillator, x, x_end, width, low);
      const T after = x.at(oscillator, high) - x_end;
      if (abs(after) > width) {
        since = never;
      } else if (abs(before) > width) {
        const int side = sign_of(before);
        Path<T> distance = x;
        distance.start -= x_end + side * width;
        since = segment.begin + root_between(oscillator, distance, low, high, side);
      }
      if (tail || high >= length || (shrinks && abs(after) <= width)) return;
      low = high;
      before = after;
      high = std::min(low + turns.spacing, length);
    }
  }

  /// A time by which a monotone decay towards x_end has come within the width.
  static T settled_by(const Oscillator<T>& oscillator, const Path<T>& x, T x_end, T width, T from) {
    using std::abs;
    T step = -1 / oscillator.slowest_rate();
    while (abs(x.at(oscillator, from + step) - x_end) > width && step < T(1e300)) step *= 2;
    return from + step;
  }

  void contacts(Transient<T>& result) const {
    motion_.stretches(duration_, [&](const Segment<T>& segment, T from, T to, T times) {
      const Oscillator<T>& oscillator = segment.flow.oscillator;
      const T x_from = segment.flow.position.at(oscillator, from);
      const T x_to = segment.flow.position.at(oscillator, to);
      const T moved = segment.flow.position.change(oscillator, to) -
                      segment.flow.position.change(oscillator, from);
      const auto use = [&](ContactUse<T>& contact, Slide slide, const Contact<T>& law, T surface,
                           bool arrived, T force_from, T force_to) {
        using std::abs;
        if (slide == Slide::absent) return;
        if (slide == Slide::stuck) {
          contact.time_stuck += times * (to - from);
        } else {
          const T distance = abs(moved - surface * (to - from));
          contact.distance_slid += times * distance;
          contact.dissipated += times * law.kinetic * distance;
          const bool stopped = arrived && to >= segment.end - segment.begin;
          if (stopped && segment.event.kind != Kind::slip) contact.reversals += times;
        }
        contact.peak_force = std::max({contact.peak_force, abs(force_from), abs(force_to)});
      };
      const auto at_from = motion_.friction().forces(segment.mode, x_from);
      const auto at_to = motion_.friction().forces(segment.mode, x_to);
      use(result.plate, segment.mode.plate, motion_.drive().plate, motion_.inputs().mouse_velocity,
          segment.event.plate, at_from.plate, at_to.plate);
      use(result.finger, segment.mode.finger, motion_.drive().finger, T(0), segment.event.finger,
          at_from.finger, at_to.finger);
    });
  }

  const Motion<T>& motion_;
  T duration_;
};

/// The duration that was asked for or, without one, long enough to see the ending: the decay of the
/// slowest mode to a thousandth and until settled, or a few periods of what lasts.
template <class T>
T duration_of(const Motion<T>& motion) {
  using std::log;
  using std::sqrt;
  if (std::isfinite(motion.inputs().duration)) return motion.inputs().duration;
  constexpr T never = std::numeric_limits<T>::infinity();
  const Outcome<T>& outcome = motion.outcome();
  const T period = T(6.283185307179586) / sqrt(motion.drive().stiffness / motion.drive().mass);
  switch (outcome.end) {
    case End::resting:
      return std::max(outcome.since * T(1.25), period);
    case End::decaying: {
      const T rate = -std::prev(motion.end())->flow.oscillator.slowest_rate();
      const T settled = Measurement<T>(motion, never).settling_time(T(settling_band));
      return std::fmax(outcome.since + period + log(T(1000)) / rate, settled * T(1.25));
    }
    case End::free:
    case End::grazing:
      return outcome.since + 3 * outcome.period;
    case End::stick_slip:
      return outcome.until + 3 * outcome.period;
    case End::moving:
      break;
  }
  return outcome.until;
}

}  // namespace pindrive
