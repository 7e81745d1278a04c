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
  T time_stuck{0};     ///< or gripping, s
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
void extrema(const ClosedForm<T>& along, const Path<T>& path, T from, T to, Visitor&& visit) {
  visit(from, along.at(path, from));
  if (path.constant() || !(to > from)) return;
  const Oscillator<T>& oscillator = along.oscillator();
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
  visit(to, along.at(path, to));
}
template <class T, class Visitor>
void extrema(const BySeries<T>& along, const Polynomial<T>& path, T from, T to, Visitor&& visit) {
  visit(from, path.at(from));
  if (!(to > from)) return;
  const Polynomial<T> slope = path.derivative();
  const int side = along.side_after_start(slope);
  if (side != 0)
    along.each_root(slope, side, to, [&](T tau) {
      if (tau > from) visit(tau, path.at(tau));
      return true;
    });
  visit(to, path.at(to));
}

/// The same for a path on which only the highest and the lowest value are asked for: a vibration on
/// a line has them within a period of an end, so what lies between need not be followed.
template <class T, class Visitor>
void highest_and_lowest(const ClosedForm<T>& along, const Path<T>& path, T from, T to,
                        Visitor&& visit) {
  const T period = along.oscillator().period();
  if (!path.oscillates() || !(to - from > 2 * period)) {
    extrema(along, path, from, to, visit);
    return;
  }
  extrema(along, path, from, from + period, visit);
  extrema(along, path, to - period, to, visit);
}
template <class T, class Visitor>
void highest_and_lowest(const BySeries<T>& along, const Polynomial<T>& path, T from, T to,
                        Visitor&& visit) {
  extrema(along, path, from, to, visit);
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
  template <class Trajectory>
  static T moved(const Trajectory& along, T from, T to) {
    const T change = along.change(along.position(), to);
    return from > 0 ? change - along.change(along.position(), from) : change;
  }

  static int sign_of(T value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

  /// The direction in which the pin moves just after a segment begins; 0 at rest.
  int heading(const Segment<T>& segment) const {
    return motion_.along(
        segment, [](const auto& along) { return along.side_after_start(along.velocity()); });
  }

  /// Calls visit(time, position) at each turning point in order until it returns false.
  template <class Visitor>
  void turning_points(Visitor&& visit) const {
    int direction = 0;
    bool more = true;
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > duration_ || !go_on_()) return;
      const int start = heading(segment);
      if (direction * start < 0 || (direction != 0 && start == 0))
        if (!visit(segment.begin, segment.flow.position.start)) return;
      direction = start;
      if (direction == 0 || !may_turn(segment)) continue;
      // A velocity of zero that ends the segment belongs to the next one.
      const Segment<T>* following = &segment + 1;
      const bool turns_at_end = following != motion_.end() && following->flow.velocity.start == 0;
      const T inside = turns_at_end ? length(segment) * (1 - T(1e-9)) : length(segment);
      motion_.along(segment, [&](const auto& along) {
        along.each_root(along.velocity(), direction, inside, [&](T tau) {
          direction = -direction;
          more = visit(segment.begin + tau, along.at(along.position(), tau));
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
      // Where it ends the next mode begins, with the velocity that the event has set exactly.
      const bool ends = segment.end <= until && &segment + 1 != motion_.end();
      const auto compare = [&](T tau, T velocity) {
        if (-outward * velocity <= 0 || (ends && tau == to)) return;
        if (outward * velocity >= outward * result.return_velocity) return;
        result.return_velocity = velocity;
        result.return_velocity_time = segment.begin + tau;
      };
      motion_.along(segment, [&](const auto& along) {
        highest_and_lowest(along, along.velocity(), from, to, compare);
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
      motion_.along(segment, [&](const auto& along) {
        highest_and_lowest(along, along.position(), T(0), segment.end - segment.begin,
                           [&](T, T position) {
                             low = std::min(low, position);
                             high = std::max(high, position);
                           });
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
      if (segment->event.plate == Kind::none && segment->event.finger == Kind::none) continue;
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
      since = motion_.along(
          *--segment, [&](const auto& along) { return entry(along, *segment, x_end, width); });
    return since;
  }

  /// When, in a segment, |x − x_end| comes within the width to stay there, followed from extremum
  /// to extremum: 0 if it is never outside, infinite if it is outside at the end.
  T entry(const BySeries<T>& along, const Segment<T>& segment, T x_end, T width) const {
    T since{0};
    // Beyond the width on either side: where it comes within for good, or infinite.
    for (const int side : {1, -1}) {
      Polynomial<T> beyond = T(side) * along.above(along.position(), x_end + side * width);
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
        const Stretch last = last_stretch_outside(along, segment, x_end, width);
        before = x.at(segment.after(last.from), last.from) - x_end;
        extrema(along, x, last.from, last.to, follow_to);
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
  static Stretch last_stretch_outside(const ClosedForm<T>& along, const Segment<T>& segment,
                                      T x_end, T width) {
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const Path<T>& x = segment.flow.position;
    Stretch last{T(0), segment.end - segment.begin};
    const auto strays = [&](T from, T to) {
      bool outside = false;
      highest_and_lowest(along, x, from, to, [&](T, T position) {
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
    if (drive.finger.present() && !drive.finger.rigid())
      result.peak_stretch = result.peak_stretch_rate = T(0);
    motion_.stretches(duration_, [&](const Segment<T>& segment, T from, T to, T times) {
      motion_.along(segment,
                    [&](const auto& along) { stretch(result, along, segment, from, to, times); });
      return go_on_();
    });
  }

  template <class Trajectory>
  void stretch(Transient<T>& result, const Trajectory& along, const Segment<T>& segment, T from,
               T to, T times) const {
    const bool whole = to >= segment.end - segment.begin;
    const T distance = moved(along, from, to);
    use(result.plate, along, segment, segment.mode.plate, segment.plate_velocity,
        along.plate_force(), whole && stops(segment.event.plate), from, to, distance, times);
    use(result.finger, along, segment, segment.mode.finger, {}, along.finger_force(),
        whole && stops(segment.event.finger), from, to, distance, times);
    if (segment.mode.both_stuck())
      for (const T tau : {from, to}) {
        using std::abs;
        const auto friction = motion_.friction(segment, tau);
        result.plate.peak_force = std::max(result.plate.peak_force, abs(friction.plate));
        result.finger.peak_force = std::max(result.finger.peak_force, abs(friction.finger));
      }
    const Contact<T>& finger = motion_.drive().finger;
    if (!finger.present() || finger.rigid()) return;
    result.finger.dissipated += times * skin_loss(along, segment, from, to, whole);
    const auto in_skin = (-1 / finger.stiffness) * along.finger_force();
    peak(result.peak_stretch, along, in_skin, from, to);
    peak(result.peak_stretch_rate, along, along.derivative(in_skin), from, to);
  }

  template <class Trajectory, class Quantity>
  static void peak(T& largest, const Trajectory& along, const Quantity& path, T from, T to) {
    const auto compare = [&](T, T value) {
      using std::abs;
      largest = std::max(largest, abs(value));
    };
    if (along.constant(path))
      compare(from, along.start(path));
    else
      highest_and_lowest(along, path, from, to, compare);
  }

  template <class Trajectory, class Quantity>
  void use(ContactUse<T>& contact, const Trajectory& along, const Segment<T>& segment,
           ContactState slide, Line<T> surface, const Quantity& force, bool came_to_zero, T from,
           T to, T distance, T times) const {
    using std::abs;
    if (slide == ContactState::absent) return;
    if (!segment.mode.both_stuck()) peak(contact.peak_force, along, force, from, to);
    if (!slips(slide)) {
      contact.time_stuck += times * (to - from);
      return;
    }
    const T slid = abs(distance - (surface.at(from) + surface.at(to)) / 2 * (to - from));
    contact.distance_slid += times * slid;
    if (came_to_zero) contact.reversals += times;
    if (along.constant(force)) {
      contact.dissipated += times * abs(along.start(force)) * slid;
    } else {
      auto sliding = T(-1) * along.line(surface);
      sliding = along.velocity() + sliding;
      contact.dissipated -= times * along.product_integral(force, sliding, from, to);
    }
  }

  /// What a stretched skin gives to its slider, or takes from it, beside the pin's own sliding, J.
  template <class Trajectory>
  T skin_loss(const Trajectory& along, const Segment<T>& segment, T from, T to, bool whole) const {
    const Contact<T>& finger = motion_.drive().finger;
    const auto energy = [&](T force) { return force * force / (2 * finger.stiffness); };
    const T start = energy(along.at(along.finger_force(), from));
    const T end = energy(along.at(along.finger_force(), to));
    if (slips(segment.mode.finger)) return start - end;
    if (!whole || segment.event.finger != Kind::slip) return T(0);
    using std::abs;
    const T speed = abs(along.at(along.velocity(), to));
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
