/// Measurement of the numbers of a motion (docs/theory.md, section 15), from its segments, not from samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/flow/roots.hpp"
#include "pindrive/motion/contact_use.hpp"
#include "pindrive/motion/extrema.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/settling.hpp"
#include "pindrive/motion/steady_numbers.hpp"
#include "pindrive/motion/steady_since.hpp"
#include "pindrive/motion/transient_numbers.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

/// Measures a motion over [0, duration]; the motion outlives the measurement. Numbers of later
/// events, or of none, are NaN.
template <class T>
class Measurement {
 public:
  Measurement(const Motion<T>& motion, T duration, GoOn go_on = {})
      : motion_(motion), duration_(duration), go_on_(go_on) {}

  Transient<T> transient(T band) const {
    Transient<T> result;
    swing(result);
    first_reversal(result);
    ending(result);
    settle(result, band);
    rest_and_events(result);
    contacts(result);
    afterwards(result);
    return result;
  }

  /// Earliest time after which |x − x_end| stays within the band, a fraction of |x(0) − x_end|; for
  /// a steady oscillation, its begin. The end of a drifting motion is a line.
  T settling_time(T band) const {
    Transient<T> result;
    ending(result);
    settle(result, band);
    return result.settling_time;
  }

  /// End of a decaying or drifting motion: within a thousandth of the initial oscillation, or at the last event
  /// if later.
  T decayed() const {
    using std::abs;
    using std::sqrt;
    Transient<T> result;
    ending(result);
    const Drive<T>& drive = motion_.drive();
    const Path<T>& x = motion_.begin()->flow.position;
    const T speed = motion_.begin()->flow.velocity.start;
    const T size =
        abs(x.start - result.end_position) + abs(speed) / sqrt(drive.stiffness / drive.mass);
    return std::max(settling(result).last_outside(size / 1000), std::prev(motion_.end())->begin);
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  void settle(Transient<T>& result, T band) const {
    const Outcome<T>& outcome = motion_.outcome();
    if (outcome.steady())
      result.settling_time = result.steady_since <= duration_ ? result.steady_since : result.none;
    else if (outcome.end == End::resting || outcome.end == End::decaying ||
             outcome.end == End::drifting)
      result.settling_time = settling(result).within(band);
  }

  detail::Settling<T> settling(const Transient<T>& result) const {
    const bool drifts = motion_.outcome().end == End::drifting;
    const Line<T> goal{result.end_position, drifts ? result.drift_velocity : T(0)};
    return {motion_, goal, duration_, go_on_};
  }

  T length(const Segment<T>& segment) const {
    return std::min(segment.end, duration_) - segment.begin;
  }

  static int sign_of(T value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

  /// Direction of the pin just after the begin of a segment; 0 at rest.
  int heading(const Segment<T>& segment) const {
    return motion_.along(
        segment, [](const auto& along) { return along.side_after_start(along.velocity()); });
  }

  /// Calls visit(time, position) at each turning point in order until visit returns false.
  template <class Visitor>
  void turning_points(Visitor&& visit) const {
    int direction = 0;
    bool more = true;
    for (const Segment<T>& segment : motion_) {
      // A decay that the rest criterion ends does not turn there.
      const bool decays_on = segment.eliminated == EliminatedPart::motion;
      if (segment.begin > duration_ || decays_on || !go_on_()) return;
      const int start = heading(segment);
      if (direction * start < 0 || (direction != 0 && start == 0))
        if (!visit(segment.begin, segment.flow.position.start)) return;
      direction = start;
      if (direction == 0 || !detail::may_turn(segment)) continue;
      // A velocity of zero that ends the segment belongs to the next one.
      const Segment<T>* following = &segment + 1;
      const bool turns_at_end = following != motion_.end() && following->flow.velocity.start == 0;
      const T inside =
          turns_at_end ? length(segment) * (1 - T(detail::turning_at_end)) : length(segment);
      motion_.along(segment, [&](const auto& along) {
        along.each_root(along.velocity(), direction, inside, [&](T tau) {
          direction = -direction;
          const T x = along.at(along.position(), tau);
          more = visit(segment.begin + tau, motion_.drive().stops.within(x));
          return more;
        });
      });
      if (!more) return;
    }
  }

  /// Peak, trough, swing and the extreme velocity between them.
  void swing(Transient<T>& result) const {
    using std::isnan;
    const Inputs<T>& inputs = motion_.inputs();
    int outward = sign_of(inputs.displacement);
    if (outward == 0) outward = sign_of(inputs.velocity);
    if (outward == 0) outward = sign_of(inputs.mouse_velocity.from(T(0)).value);
    if (heading(*motion_.begin()) != outward) {
      result.peak_time = T(0);
      result.peak_displacement = inputs.displacement;
    }
    turning_points([&](T time, T position) {
      if (isnan(result.peak_time)) {
        result.peak_time = time;
        result.peak_displacement = position;
        return true;
      }
      result.trough_time = time;
      result.trough_displacement = position;
      return false;
    });
    if (isnan(result.peak_time)) return;
    if (isnan(result.trough_time) && motion_.outcome().end == End::decaying) {
      result.trough_time = never;
      result.trough_displacement = std::prev(motion_.end())->flow.position.centre();
    }
    const int sign = outward == 0 ? 1 : outward;
    result.swing = (result.peak_displacement - result.trough_displacement) * sign;
    return_velocity(result, sign);
  }

  void return_velocity(Transient<T>& result, int outward) const {
    using std::isnan;
    const T until = std::min(isnan(result.trough_time) ? duration_ : result.trough_time, duration_);
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > until || !go_on_()) break;
      const T from = std::max(result.peak_time - segment.begin, T(0));
      const T to = std::min(segment.end, until) - segment.begin;
      if (from > to || (from > 0 && from == to)) continue;
      // At its end the next mode begins, with the velocity that the event has set exactly.
      const bool ends = segment.end <= until && &segment + 1 != motion_.end();
      const auto compare = [&](T tau, T velocity) {
        if (-outward * velocity <= 0 || (ends && tau == to && !stops(segment.event.stop))) return;
        if (outward * velocity >= outward * result.return_velocity) return;
        result.return_velocity = velocity;
        result.return_velocity_time = segment.begin + tau;
      };
      motion_.along(segment, [&](const auto& along) {
        detail::highest_and_lowest(along, along.velocity(), from, to, compare);
      });
    }
  }

  void first_reversal(Transient<T>& result) const {
    for (const Segment<T>& segment : motion_) {
      if (segment.end > duration_) return;
      if (!stops(segment.event.plate)) continue;
      result.first_reversal_time = segment.end;
      return;
    }
  }

  void ending(Transient<T>& result) const {
    const Outcome<T>& outcome = motion_.outcome();
    const Path<T>& last = std::prev(motion_.end())->flow.position;
    result.steady_since = steady_since(motion_, go_on_);
    result.steady = steady_numbers(motion_, go_on_);
    result.end_position = outcome.end == End::resting    ? last.start
                          : outcome.end == End::decaying ? last.centre()
                                                         : result.steady.centre;
    if (outcome.end == End::drifting) drift(result);
    result.growth = T(outcome.growth);
  }

  /// Line that a drifting pin follows, and its distance behind the position at which the spring balances the
  /// inputs.
  void drift(Transient<T>& result) const {
    const Drive<T>& drive = motion_.drive();
    const Segment<T>& last = *std::prev(motion_.end());
    const Path<T>& x = last.flow.position;
    result.drift_velocity = x.drift;
    result.end_position = x.centre() - x.drift * last.begin;
    const auto inputs = InputCurves<T>::of(drive, motion_.inputs(), last);
    const T force = inputs.force.value + drive.mass * inputs.plate_velocity.rate;
    const T rate = inputs.force.rate / drive.stiffness;
    using std::abs;
    // Beside a load that grows the distance grows, too.
    if (abs(rate - x.drift) <= detail::difference_error<T> * abs(rate))
      result.lag = (force / drive.stiffness - x.centre()) * (x.drift < 0 ? -1 : 1);
  }

  /// Times of endings without settling: rest, steady oscillation, last event.
  void rest_and_events(Transient<T>& result) const {
    const Outcome<T>& outcome = motion_.outcome();
    if (!outcome.known() && outcome.end != End::irregular) return;
    result.rest_time = outcome.end == End::resting ? rest_begin() : never;
    result.last_event_time = T(0);
    const Segment<T>* segment = motion_.end();
    while (segment != motion_.begin() && go_on_()) {
      --segment;
      if (!segment->event.any()) continue;
      const bool repeats = (outcome.cycles() || outcome.end == End::irregular) &&
                           !(segment->begin < outcome.cycle_begin);
      result.last_event_time = repeats ? never : segment->end;
      return;
    }
  }

  /// Use of the contacts in the transient, and their peaks in the whole motion.
  void contacts(Transient<T>& result) const {
    const Outcome<T>& outcome = motion_.outcome();
    T end = duration_;
    if (outcome.end == End::resting) end = result.rest_time;
    if (outcome.end == End::decaying || outcome.end == End::drifting) end = result.last_event_time;
    if (outcome.steady()) end = result.steady_since;
    result.end_time = std::min({end, duration_, motion_.known_until()});
    const detail::ContactMeasurement<T> measurement(motion_, go_on_);
    const ContactsUse<T> used = measurement.measure(T(0), result.end_time);
    result.plate = used.plate;
    result.finger = used.finger;
    result.peak_stretch = used.peak_stretch;
    result.peak_stretch_rate = used.peak_stretch_rate;
    // The peaks of a steady motion are in its first period, those of a decay soon after it begins.
    if (result.end_time < duration_) peaks(result, measurement.measure(result.end_time, duration_));
  }
  static void peaks(Transient<T>& result, const ContactsUse<T>& used) {
    result.plate.peak_force = std::max(result.plate.peak_force, used.plate.peak_force);
    result.finger.peak_force = std::max(result.finger.peak_force, used.finger.peak_force);
    result.peak_stretch = std::max(result.peak_stretch, used.peak_stretch);
    result.peak_stretch_rate = std::max(result.peak_stretch_rate, used.peak_stretch_rate);
  }

  /// Numbers of the motion after the transient, if the transient ends within the duration.
  void afterwards(Transient<T>& result) const {
    const Outcome<T>& outcome = motion_.outcome();
    const Drive<T>& drive = motion_.drive();
    const Segment<T>& last = *std::prev(motion_.end());
    const auto lines = InputCurves<T>::of(drive, motion_.inputs(), last);
    // Beside an input that grows for ever, the work of a contact grows from period to period.
    const bool repeats = outcome.end == End::driven || contacts_last(lines);
    if (outcome.steady() && repeats) {
      const detail::ContactMeasurement<T> measurement(motion_, go_on_);
      const T begin = outcome.cycles() ? outcome.cycle_begin : last.begin;
      const ContactsUse<T> period = measurement.measure(begin, begin + outcome.period);
      result.plate_afterwards.add(period.plate, outcome.period);
      result.finger_afterwards.add(period.finger, outcome.period);
    } else if (outcome.end == End::resting && repeats) {
      // The plate continues to slide under the pin, at constant speed and friction.
      using detail::hypot;
      const T speed = hypot(lines.plate_velocity.value, lines.across_velocity.value);
      const T friction = drive.plate.friction_at(speed) * lines.plate_load.value;
      result.plate_afterwards.power = speed > 0 ? friction * speed : T(0);
      result.finger_afterwards.power = T(0);
    } else if (outcome.end == End::decaying) {
      T stiffness = drive.stiffness;
      if (last.mode.finger == ContactState::elastic_stick) stiffness += drive.finger.stiffness;
      if (in_contact(last.mode.stop)) stiffness += drive.stops.stiffness;
      const T x = last.flow.position.value, v = last.flow.velocity.start;
      result.decay_energy = (stiffness * x * x + drive.mass * v * v) / 2;
    }
    // The first extrema of a motion that is steady already are those of the steady motion.
    if (!outcome.steady()) return;
    if (result.peak_time > result.steady_since)
      result.peak_time = result.peak_displacement = result.none;
    if (!(result.peak_time <= result.steady_since) || result.trough_time > result.steady_since) {
      result.trough_time = result.trough_displacement = result.swing = result.none;
      result.return_velocity = result.return_velocity_time = result.none;
    }
  }

  /// True if velocities and loads of the contacts are constant.
  bool contacts_last(const InputCurves<T>& lines) const {
    const Drive<T>& drive = motion_.drive();
    const bool of_plate = lines.plate_velocity.steady() && lines.across_velocity.steady() &&
                          lines.plate_load.steady();
    return (of_plate || !drive.plate.present()) &&
           (lines.finger_load.steady() || !drive.finger.present());
  }

  /// Begin of permanent rest, which breakpoints of the inputs may divide into several segments.
  T rest_begin() const {
    const Segment<T>* segment = std::prev(motion_.end());
    const auto still = [](const Segment<T>& before) {
      const Path<T>& v = before.flow.velocity;  // a series has but its start
      const bool rests = v.constant() && v.start == 0 && before.flow.position.constant();
      return rests || !(before.end > before.begin);
    };
    while (segment != motion_.begin() && still(*std::prev(segment))) --segment;
    return segment->begin;
  }

  const Motion<T>& motion_;
  T duration_;
  GoOn go_on_;
};

/// Returns the numbers of a motion over [0, duration], s; `band` is the settling band, a fraction of
/// |x(0) − x_end|.
template <class T>
Transient<T> transient_of(const Motion<T>& motion, T duration, T band, GoOn go_on = {}) {
  return Measurement<T>(motion, duration, go_on).transient(band);
}

}  // namespace pindrive
