/// The numbers asked of a motion (docs/theory.md, 6), from its segments, exactly; never from samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/motion.hpp"
#include "pindrive/quadrature.hpp"
#include "pindrive/roots.hpp"

namespace pindrive {

/// What one contact did during the motion.
template <class T>
struct ContactUse {
  T reversals{0};      ///< how often its sliding velocity came to zero
  T time_stuck{0};     ///< elastically too, s
  T distance_slid{0};  ///< by the pin over the surface, m
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
  T settling_time{none};                                ///< from then on within the band, s
  T rest_time{none};  ///< from then on at rest, s; infinite if it never comes to rest
  T last_event_time{
      none};             ///< of the last change at a contact, s; 0 without any after the release,
                         ///< infinite where they go on for ever
  T steady_since{none};  ///< when a steady oscillation began, s
  T peak_stretch{none}, peak_stretch_rate{none};  ///< largest of a compliant finger's: m, m/s
  T end_position{none};  ///< x_end: where it rests, or the middle of the final oscillation, m
  T amplitude{none};     ///< of the final oscillation, m
  ContactUse<T> plate, finger;
};

/// Calls visit(τ, value) where a vibration without a line turns between two times. Times and values
/// follow from its start: at `from` what is left of it may have fewer digits.
template <class T, class Visitor>
void turns(const Oscillator<T>& oscillator, const Path<T>& path, T from, T to, Visitor& visit) {
  using std::exp;
  using std::floor;
  const Path<T> slope = path.derivative(oscillator);
  const int side = side_after_start(oscillator, slope);
  const Zeros<T> zeros = oscillator.zeros(slope.value, slope.slope);
  if (side == 0 || !(zeros.first < to)) return;
  const T reach = side * oscillator.reach(slope.value, slope.slope);
  T count = zeros.first > from ? T(0) : floor((from - zeros.first) / zeros.spacing);
  for (T tau; (tau = zeros.at(count)) < to; count += T(1)) {
    if (!(tau > from)) continue;
    const bool even = count / 2 == floor(count / 2);
    visit(tau, path.centre() + (even ? reach : -reach) * exp(oscillator.alpha() * tau));
  }
}

/// Calls visit(τ, value) at both ends of a stretch of a path in a segment and at each extremum between
/// them.
template <class T, class Visitor>
void extrema(const Segment<T>& segment, const Path<T>& path, T from, T to, Visitor&& visit) {
  visit(from, path.at(segment.after(from), from));
  if (path.constant() || !(to > from)) return;
  const Oscillator<T>& oscillator = segment.flow.oscillator;
  if (path.straight() && oscillator.oscillates()) {
    turns(oscillator, path, from, to, visit);
  } else {
    const Path<T> rest = from > 0 ? path.from(oscillator, from) : path;
    const Path<T> slope = rest.derivative(oscillator);
    const int side = side_after_start(oscillator, slope);
    if (side != 0)
      each_root(oscillator, slope, side, to - from, [&](T tau) {
        visit(from + tau, rest.at(oscillator, tau));
        return true;
      });
  }
  visit(to, path.at(segment.after(to), to));
}

/// The same for a path on which only the highest and the lowest value are asked for: a vibration on
/// a line has them within a period of an end, so what lies between need not be followed.
template <class T, class Visitor>
void highest_and_lowest(const Segment<T>& segment, const Path<T>& path, T from, T to,
                        Visitor&& visit) {
  const T period = segment.flow.oscillator.period();
  if (!path.oscillates() || !(to - from > 2 * period)) {
    extrema(segment, path, from, to, visit);
    return;
  }
  extrema(segment, path, from, from + period, visit);
  extrema(segment, path, to - period, to, visit);
}

/// Measures a motion, which outlives it, over [0, duration]; what happens later, or never, is NaN.
template <class T, class GoOn = Unattended>
class Measurement {
 public:
  Measurement(const Motion<T>& motion, T duration, GoOn go_on = {})
      : motion_(motion), duration_(duration), go_on_(go_on) {}

  Transient<T> transient(T band) const {
    Transient<T> result;
    swing(result);
    first_reversal(result);
    ending(result);
    result.settling_time = settled_after(result.end_position, band);
    rest_and_events(result);
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

  /// Until a motion that decays stays within a thousandth of the size of the oscillation that it
  /// began with, or until its last event.
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
    return std::max(last_outside(result.end_position, size / 1000),
                    std::prev(motion_.end())->begin);
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  T length(const Segment<T>& segment) const {
    return std::min(segment.end, duration_) - segment.begin;
  }

  /// A pin that slides on the finger, which is at rest, does not turn back meanwhile.
  static bool may_turn(const Segment<T>& segment) { return !slips(segment.mode.finger); }

  /// How far the pin comes between two times of a segment. As a change it keeps its digits, however
  /// short it is beside x.
  static T moved(const Segment<T>& segment, T from, T to) {
    const Path<T>& x = segment.flow.position;
    const T change = x.change(segment.after(to), to);
    return from > 0 ? change - x.change(segment.after(from), from) : change;
  }

  static int sign_of(T value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

  /// The direction in which the pin moves just after a segment begins; 0 at rest.
  static int heading(const Flow<T>& flow) {
    return side_after_start(flow.oscillator, flow.velocity);
  }

  /// Calls visit(time, position) at each turning point in order until it returns false.
  template <class Visitor>
  void turning_points(Visitor&& visit) const {
    int direction = 0;
    bool more = true;
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > duration_ || !go_on_()) return;
      const Flow<T>& flow = segment.flow;
      const int start = heading(flow);
      if (direction * start < 0 || (direction != 0 && start == 0))
        if (!visit(segment.begin, flow.position.start)) return;
      direction = start;
      if (direction == 0 || !may_turn(segment)) continue;
      // A velocity of zero that ends the segment belongs to the next one.
      const Segment<T>* following = &segment + 1;
      const bool turns_at_end = following != motion_.end() && following->flow.velocity.start == 0;
      const T inside = turns_at_end ? length(segment) * (1 - T(1e-9)) : length(segment);
      each_root(flow.oscillator, flow.velocity, direction, inside, [&](T tau) {
        direction = -direction;
        more = visit(segment.begin + tau, flow.position.at(flow.oscillator, tau));
        return more;
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
    if (heading(motion_.begin()->flow) != outward) {
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
      // Where it ends the next mode begins, with the velocity that the event has set exactly.
      const bool ends = segment.end <= until && &segment + 1 != motion_.end();
      const auto compare = [&](T tau, T velocity) {
        if (-outward * velocity <= 0 || (ends && tau == to)) return;
        if (outward * velocity >= outward * result.return_velocity) return;
        result.return_velocity = velocity;
        result.return_velocity_time = segment.begin + tau;
      };
      highest_and_lowest(segment, segment.flow.velocity, from, to, compare);
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
      case End::limit_cycle:
        break;
    }
    T low = never, high = -never;
    for (const Segment<T>& segment : motion_) {
      if (!go_on_()) return;
      if (segment.begin < outcome.cycle_begin) continue;
      highest_and_lowest(segment, segment.flow.position, T(0), segment.end - segment.begin,
                         [&](T, T position) {
                           low = std::min(low, position);
                           high = std::max(high, position);
                         });
    }
    result.end_position = (low + high) / 2;
    result.amplitude = (high - low) / 2;
  }

  /// The three ends of a motion that are no settling: at rest, steady, without further events.
  void rest_and_events(Transient<T>& result) const {
    const Outcome<T>& outcome = motion_.outcome();
    if (outcome.end == End::moving) return;
    result.steady_since = outcome.steady_since;
    result.rest_time = outcome.end == End::resting ? rest_begin() : never;
    result.last_event_time = T(0);
    const Segment<T>* segment = motion_.end();
    while (segment != motion_.begin() && go_on_()) {
      --segment;
      if (segment->event.plate == Transition::none && segment->event.finger == Transition::none)
        continue;
      const bool repeats = outcome.cycles() && !(segment->begin < outcome.cycle_begin);
      result.last_event_time = repeats ? never : segment->end;
      return;
    }
  }

  /// Rest is one, however many segments the rows of inputs make of it.
  T rest_begin() const {
    const Segment<T>* segment = std::prev(motion_.end());
    const auto still = [](const Segment<T>& before) {
      return before.flow.position.constant() || !(before.end > before.begin);
    };
    while (segment != motion_.begin() && still(*std::prev(segment))) --segment;
    return segment->begin;
  }

  T settled_after(T x_end, T band) const {
    using std::abs;
    const Outcome<T>& outcome = motion_.outcome();
    if (outcome.end == End::moving) return Transient<T>::none;
    T since = outcome.steady_since;
    if (outcome.end == End::resting || outcome.end == End::decaying) {
      const T x = motion_.begin()->flow.position.start, way = x - x_end;
      constexpr T rounding = 4 * std::numeric_limits<T>::epsilon();
      const T width = abs(way) <= rounding * (abs(x) + abs(x_end)) ? T(0) : band * abs(way);
      since = last_outside(x_end, width);
    }
    return since <= duration_ && since < never ? since : Transient<T>::none;
  }

  /// The last time at which |x − x_end| is beyond the width: 0 if it never is, infinite if it always is.
  T last_outside(T x_end, T width) const {
    T since{0};
    for (const Segment<T>* segment = motion_.end();
         since == 0 && segment != motion_.begin() && go_on_();)
      since = entry(*--segment, x_end, width);
    return since;
  }

  /// When, in a segment, |x − x_end| comes within the width to stay there, followed from extremum
  /// to extremum: 0 if it is never outside, infinite if it is outside at the end.
  T entry(const Segment<T>& segment, T x_end, T width) const {
    using std::abs;
    using std::isfinite;
    T since{0};
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const Path<T>& x = segment.flow.position;
    T low{0}, before = x.start - x_end;
    const auto follow_to = [&](T high, T position) {
      const T after = position - x_end;
      if (abs(after) > width) {
        since = never;
      } else if (abs(before) > width) {
        const int side = sign_of(before);
        Path<T> distance = x;
        distance.start -= x_end + side * width;
        // Before a turning point it is near a cosine whose swing the damping widens.
        using std::sqrt;
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
        const Stretch last = last_stretch_outside(segment, x_end, width);
        before = x.at(segment.after(last.from), last.from) - x_end;
        extrema(segment, x, last.from, last.to, follow_to);
      } else {
        const T to = segment.end - segment.begin;
        follow_to(to, x.at(segment.after(to), to));
      }
      return since;
    }
    if (!x.oscillates()) return since;  // at x_end
    if (!(width > 0)) return never;     // approached for ever
    const Zeros<T> turns = oscillator.zeros(x.slope, segment.flow.velocity.slope);
    if (turns.first < never) follow_to(turns.first, x.at(oscillator, turns.first));
    if (turns.spacing < never && abs(before) > width) {
      // The extrema of a free decay shrink by one factor, so the last one outside is known.
      using std::floor;
      using std::log;
      const T count = floor(log(abs(before) / width) / (-oscillator.alpha() * turns.spacing));
      low = turns.first + count * turns.spacing;
      before = x.at(oscillator, low) - x_end;
      while (abs(before) > width)
        follow_to(low + turns.spacing, x.at(oscillator, low + turns.spacing));
    } else if (turns.spacing == never) {
      T step = -1 / oscillator.slowest_rate();
      while (abs(x.at(oscillator, low + step) - x_end) > width && step < T(1e300)) step *= 2;
      follow_to(low + step, x.at(oscillator, low + step));
    }
    return since;
  }

  struct Stretch {
    T from, to;
  };
  /// What need be followed of a finite segment: until |x − x_end| is within the width for good. A
  /// long vibration is halved until the few periods are left in which it leaves the band last.
  static Stretch last_stretch_outside(const Segment<T>& segment, T x_end, T width) {
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const Path<T>& x = segment.flow.position;
    Stretch last{T(0), segment.end - segment.begin};
    const auto strays = [&](T from, T to) {
      bool outside = false;
      highest_and_lowest(segment, x, from, to, [&](T, T position) {
        using std::abs;
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

  void contacts(Transient<T>& result) const {
    const Drive<T>& drive = motion_.drive();
    const bool skin = drive.finger.present() && !drive.finger.rigid();
    if (skin) result.peak_stretch = result.peak_stretch_rate = T(0);
    motion_.stretches(duration_, [&](const Segment<T>& segment, T from, T to, T times) {
      const bool whole = to >= segment.end - segment.begin;
      const T distance = moved(segment, from, to);
      use(result.plate, segment, segment.mode.plate, segment.plate_velocity, segment.plate_force,
          whole && stops(segment.event.plate), from, to, distance, times);
      use(result.finger, segment, segment.mode.finger, {}, segment.finger_force,
          whole && stops(segment.event.finger), from, to, distance, times);
      if (segment.mode.both_stuck())
        for (const T tau : {from, to}) {
          using std::abs;
          const auto friction = motion_.friction(segment, tau);
          result.plate.peak_force = std::max(result.plate.peak_force, abs(friction.plate));
          result.finger.peak_force = std::max(result.finger.peak_force, abs(friction.finger));
        }
      if (!skin) return go_on_();
      result.finger.dissipated += times * skin_loss(segment, from, to, whole);
      const Oscillator<T>& oscillator = segment.flow.oscillator;
      const Path<T> stretch = (-1 / drive.finger.stiffness) * segment.finger_force;
      peak(result.peak_stretch, segment, stretch, from, to);
      peak(result.peak_stretch_rate, segment, stretch.derivative(oscillator), from, to);
      return go_on_();
    });
  }

  static void peak(T& largest, const Segment<T>& segment, const Path<T>& path, T from, T to) {
    const auto compare = [&](T, T value) {
      using std::abs;
      largest = std::max(largest, abs(value));
    };
    if (path.constant())
      compare(from, path.start);
    else
      highest_and_lowest(segment, path, from, to, compare);
  }

  void use(ContactUse<T>& contact, const Segment<T>& segment, ContactState slide, Line<T> surface,
           const Path<T>& force, bool came_to_zero, T from, T to, T distance, T times) const {
    using std::abs;
    if (slide == ContactState::absent) return;
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    if (!segment.mode.both_stuck()) peak(contact.peak_force, segment, force, from, to);
    if (!slips(slide)) {
      contact.time_stuck += times * (to - from);
      return;
    }
    const T slid = abs(distance - (surface.at(from) + surface.at(to)) / 2 * (to - from));
    contact.distance_slid += times * slid;
    if (came_to_zero) contact.reversals += times;
    if (force.constant()) {
      contact.dissipated += times * abs(force.start) * slid;
    } else {
      const Path<T> of_surface = surface;
      contact.dissipated -=
          times *
          product_integral(oscillator, force, segment.flow.velocity + T(-1) * of_surface, from, to);
    }
  }

  /// What a stretched skin gives to its slider, or takes from it, beside the pin's own sliding, J.
  T skin_loss(const Segment<T>& segment, T from, T to, bool whole) const {
    const Contact<T>& finger = motion_.drive().finger;
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const auto energy = [&](T force) { return force * force / (2 * finger.stiffness); };
    const T start = energy(segment.finger_force.at(oscillator, from));
    const T end = energy(segment.finger_force.at(oscillator, to));
    if (slips(segment.mode.finger)) return start - end;
    if (!whole || segment.event.finger != Transition::slip) return T(0);
    using std::abs;
    const T speed = abs(segment.flow.velocity.at(oscillator, to));
    return end - energy(finger.branch(finger.branch_of(speed)).at(speed));
  }

  const Motion<T>& motion_;
  T duration_;
  GoOn go_on_;
};

/// The duration that was asked for or, without one, long enough to see the ending: a decay to a
/// thousandth and until settled within the band or the usual one, or a few periods of what lasts.
template <class T, class GoOn = Unattended>
T duration_of(const Motion<T>& motion, T band, GoOn go_on = {}) {
  using std::isfinite;
  using std::sqrt;
  if (isfinite(motion.inputs().duration)) return motion.inputs().duration;
  constexpr T never = std::numeric_limits<T>::infinity();
  const Outcome<T>& outcome = motion.outcome();
  const T period = T(6.283185307179586) / sqrt(motion.drive().stiffness / motion.drive().mass);
  const T last_begin = std::prev(motion.end())->begin;
  switch (outcome.end) {
    case End::resting:
      return std::max(last_begin * T(1.25), period);
    case End::decaying: {
      const Measurement<T, GoOn> measured(motion, never, go_on);
      const T settled = measured.settling_time(std::min(band, T(settling_band)));
      const T decayed = measured.decayed() + period;  // infinite where there is nothing to decay
      if (!(decayed < never)) return last_begin + period;
      return settled * T(1.25) > decayed ? settled * T(1.25) : decayed;
    }
    case End::free:
    case End::grazing:
      return outcome.steady_since + 3 * outcome.period;
    case End::stick_slip:
    case End::limit_cycle:
      return outcome.until + 3 * outcome.period;
    case End::moving:
      break;
  }
  return outcome.until;
}

}  // namespace pindrive
