/// A finished motion: the state at any time, from the segments and the cycle that repeats them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "pindrive/model/model.hpp"
#include "pindrive/motion/trajectory.hpp"

namespace pindrive {

/// Which limit is asked for at an event.
enum class Side : signed char { left, right };

/// Calls visit with the quantities of a segment, whose inputs go on from its begin along lines: a ClosedForm
/// or, where it has none, BySeries; what that returns.
template <class T, class Visitor>
auto visit_trajectory(const Drive<T>& drive, const Segment<T>& segment, const InputLines<T>& lines,
                      Visitor&& visit) {
  if (!(segment.end > segment.begin) || segment.without == FastPart::motion ||
      SeriesMode<T>(drive, segment.mode, lines).has_closed_form())
    return visit(ClosedForm<T>(segment));
  return visit(BySeries<T>(drive, segment, lines));
}

/// Friction of each contact on the pin, N.
template <class T>
struct Friction {
  T plate, finger;
};

/// That along the quantities of a segment after τ, where lines() are its inputs from its begin on.
/// Two stuck contacts share in proportion to their static friction: how they really do is not determined.
template <class Trajectory, class T, class Lines>
Friction<T> friction_along(const Trajectory& along, const Drive<T>& drive,
                           const Segment<T>& segment, Lines&& lines, T tau) {
  const Friction<T> found{along.at(along.plate_force(), tau), along.at(along.finger_force(), tau)};
  if (!segment.mode.both_stuck()) return found;
  const InputLines<T> inputs = lines();
  const T at_plate = drive.plate.static_limit * inputs.plate_load.at(tau);
  const T at_finger = drive.finger.static_limit * inputs.finger_load.at(tau);
  const T part = at_plate > 0 ? at_plate / (at_plate + at_finger) : T(0);
  return {part * found.plate, (1 - part) * found.plate};
}

/// Force of the end stops on the pin along the quantities of a segment after τ, where a force from outside
/// goes on from its begin along a line, N: of elastic ones by their law, of rigid ones what keeps it there.
template <class Trajectory, class T>
T stop_force_along(const Trajectory& along, const Drive<T>& drive, const Segment<T>& segment,
                   const Line<T>& force, T tau) {
  if (!touches(segment.mode.stop)) return T(0);
  const Stops<T>& stops = drive.stops;
  const T x = along.at(along.position(), tau);
  if (stops.rigid())
    return drive.stiffness * x - drive.mass * segment.plate_velocity.rate - force.at(tau) -
           along.at(along.plate_force(), tau) - along.at(along.finger_force(), tau);
  return stops.stiffness * (side(segment.mode.stop) * stops.travel - x) -
         stops.damping * along.at(along.velocity(), tau);
}

/// What a simulation was given and what it found. It owns nothing: the segments live elsewhere.
template <class T>
class Motion {
 public:
  Motion(const Drive<T>& drive, const Inputs<T>& inputs, const Segment<T>* first, std::size_t count,
         const Outcome<T>& outcome)
      : drive_(drive), inputs_(inputs), first_(first), count_(count), outcome_(outcome) {}

  const Drive<T>& drive() const { return drive_; }
  const Inputs<T>& inputs() const { return inputs_; }
  const Outcome<T>& outcome() const { return outcome_; }

  const Segment<T>* begin() const { return first_; }
  const Segment<T>* end() const { return first_ + count_; }

  /// The last time at which the state is known: for ever once the ending is.
  T known_until() const {
    return outcome_.known() ? std::numeric_limits<T>::infinity() : outcome_.until;
  }

  /// The segment that follows one, in a cycle its first one after the last; null without one.
  const Segment<T>* after(const Segment<T>& segment) const {
    if (&segment + 1 != end()) return &segment + 1;
    return outcome_.cycles() ? locate(outcome_.cycle_begin, Side::right).segment : nullptr;
  }

  struct Place {
    const Segment<T>* segment;
    T tau;
  };

  /// The segment that holds time t in [0, known_until()], and the time since it began.
  Place locate(T t, Side side) const {
    t = folded(t, side);
    const auto before = [&](const Segment<T>& segment) {
      return side == Side::right ? segment.end <= t : segment.end < t;
    };
    const Segment<T>* low = first_;
    std::size_t length = count_ - 1;  // the last segment holds whatever the others do not
    while (length > 0) {
      const std::size_t half = length / 2;
      if (before(low[half])) {
        low += half + 1;
        length -= half + 1;
      } else {
        length = half;
      }
    }
    return {low, std::min(std::max(t - low->begin, T(0)), low->end - low->begin)};
  }

  /// Calls visit with the quantities of a segment, a ClosedForm or, where it has none, BySeries; what
  /// that returns.
  template <class Visitor>
  auto along(const Segment<T>& segment, Visitor&& visit) const {
    const bool bilinear = (drive_.plate.branches > 0 && !inputs_.plate_load.constant()) ||
                          (drive_.finger.branches > 0 && !inputs_.finger_load.constant());
    if (!bilinear && !drive_.finger.may_lag() && segment.mode.plate != ContactState::slip_oblique)
      return visit(ClosedForm<T>(segment));
    return visit_trajectory(drive_, segment, InputLines<T>::of(drive_, inputs_, segment), visit);
  }

  /// Position, velocity or acceleration, after τ in a segment.
  T value(const Segment<T>& segment, T tau, Quantity quantity) const {
    return along(segment, [&](const auto& t) { return value_of(t, tau, quantity); });
  }
  Friction<T> friction(const Segment<T>& segment, T tau) const {
    return along(segment, [&](const auto& t) { return friction_of(t, segment, tau); });
  }
  /// Force of the end stops on the pin, N.
  T stop_force(const Segment<T>& segment, T tau) const {
    if (!touches(segment.mode.stop)) return T(0);
    return along(segment, [&](const auto& t) { return stop_force_of(t, segment, tau); });
  }

  /// The same of the quantities of a segment, which `along` hands over.
  template <class Trajectory>
  T value_of(const Trajectory& t, T tau, Quantity quantity) const {
    const T found = t.at(quantity_of(t, quantity), tau);
    return quantity == Quantity::position ? drive_.stops.within(found) : found;
  }
  template <class Trajectory>
  Friction<T> friction_of(const Trajectory& t, const Segment<T>& segment, T tau) const {
    const auto lines = [&] { return InputLines<T>::of(drive_, inputs_, segment); };
    return friction_along(t, drive_, segment, lines, tau);
  }
  template <class Trajectory>
  T stop_force_of(const Trajectory& t, const Segment<T>& segment, T tau) const {
    return stop_force_along(t, drive_, segment, inputs_.force.from(segment.begin), tau);
  }
  /// What elastic stops store, J; also while they come back behind a pin.
  T stop_energy(T x) const {
    using std::abs;
    const Stops<T>& stops = drive_.stops;
    const T depth = abs(x) - stops.travel;
    return depth > 0 && !stops.rigid() ? stops.stiffness * depth * depth / 2 : T(0);
  }

  /// Hands over each stretch of the motion in [from, until] as (segment, from τ, to τ, how often), until
  /// the visitor returns false; `from` lies in what was simulated.
  template <class Visitor>
  void stretches(T from, T until, Visitor&& visit) const {
    if (!stretch(from, std::min(until, outcome_.until), T(1), visit)) return;
    if (!outcome_.cycles() || until <= outcome_.until) return;
    using std::floor;
    const T repeats = floor((until - outcome_.until) / outcome_.period);
    const T rest = until - outcome_.until - repeats * outcome_.period;
    if (repeats > 0 && !stretch(outcome_.cycle_begin, outcome_.until, repeats, visit)) return;
    stretch(outcome_.cycle_begin, outcome_.cycle_begin + rest, T(1), visit);
  }

  /// Hands over each segment that lies in part in [from, to], in order and with cycles expanded, as
  /// (segment, when it begins, how much of it lies before `to`), until the visitor returns false; s.
  template <class Visitor>
  void expanded(T from, T to, Visitor&& visit) const {
    using std::floor;
    T round{-1};  // as simulated
    if (outcome_.cycles() && from > outcome_.until)
      round = std::max(floor((from - outcome_.until) / outcome_.period) - 1, T(-1));
    do {
      const bool again = round >= 0;
      const T later =
          again ? outcome_.until - outcome_.cycle_begin + round * outcome_.period : T(0);
      for (const Segment<T>& segment : *this) {
        if (again && segment.begin < outcome_.cycle_begin) continue;
        const T begin = segment.begin + later;
        if (begin > to) return;
        if (segment.end + later < from) continue;
        if (!goes_on(visit, segment, begin, std::min(segment.end, to - later) - segment.begin))
          return;
      }
      round += 1;
    } while (outcome_.cycles() && round + 1 > round);
  }

 private:
  /// Time in a cycle is brought back to the cycle that was simulated.
  T folded(T t, Side side) const {
    if (!outcome_.cycles() || t < outcome_.until) return t;
    using std::floor;
    const T cycles = floor((t - outcome_.until) / outcome_.period);
    const T rest = t - outcome_.until - cycles * outcome_.period;
    return rest > 0 || side == Side::right ? outcome_.cycle_begin + rest : outcome_.until;
  }

  template <class Visitor>
  bool stretch(T from, T to, T times, Visitor& visit) const {
    for (const Segment<T>& segment : *this) {
      if (segment.begin > to || segment.end <= from) continue;
      if (!goes_on(visit, segment, std::max(from - segment.begin, T(0)),
                   std::min(to, segment.end) - segment.begin, times))
        return false;
    }
    return true;
  }

  Drive<T> drive_;
  Inputs<T> inputs_;
  const Segment<T>* first_;
  std::size_t count_;
  Outcome<T> outcome_;
};

}  // namespace pindrive
