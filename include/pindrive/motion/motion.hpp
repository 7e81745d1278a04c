/// Finished motion: state at any time, from the segments and the repeated cycle.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "pindrive/model/model.hpp"
#include "pindrive/motion/trajectory.hpp"

namespace pindrive {

/// One-sided limit at an event.
enum class Side : signed char { left, right };

/// Calls visit with the trajectory of a segment with known inputs from its begin on: a
/// `detail::ClosedForm`, else a `detail::ByTerms` or a `detail::BySeries`. Returns the result of visit.
template <class T, class Visitor>
auto visit_trajectory(const Drive<T>& drive, const Segment<T>& segment, const InputCurves<T>& lines,
                      Visitor&& visit) {
  if (!(segment.end > segment.begin) || segment.eliminated == EliminatedPart::motion ||
      detail::SeriesMode<T>(drive, segment.mode, lines).has_closed_form())
    return visit(detail::ClosedForm<T>(segment));
  if constexpr (detail::uses_driven_motion)
    if (segment.driven) return visit(detail::ByTerms<T>(drive, segment, lines));
  return visit(detail::BySeries<T>(drive, segment, lines));
}
/// The same of a segment whose series step is known; null: it has none.
template <class T, class Visitor>
auto visit_trajectory(const Drive<T>& drive, const Segment<T>& segment, const InputCurves<T>& lines,
                      const detail::SeriesStep<T>* step, Visitor&& visit) {
  if (step) return visit(detail::BySeries<T>(drive, segment, lines, *step));
  if constexpr (detail::uses_driven_motion)
    if (segment.driven) return visit(detail::ByTerms<T>(drive, segment, lines));
  return visit(detail::ClosedForm<T>(segment));
}

/// Friction of each contact on the pin, N.
template <class T>
struct Friction {
  T plate, finger;
};

/// Friction along a trajectory after τ; lines() returns the inputs from the begin of the segment.
/// Two stuck contacts share in proportion to their static friction; the true division is statically
/// indeterminate.
template <class Trajectory, class T, class Lines>
Friction<T> friction_along(const Trajectory& along, const Drive<T>& drive,
                           const Segment<T>& segment, Lines&& lines, T tau) {
  const Friction<T> found{along.at(along.plate_force(), tau), along.at(along.finger_force(), tau)};
  if (!segment.mode.both_stuck()) return found;
  const InputCurves<T> inputs = lines();
  const T at_plate = drive.plate.static_limit * inputs.plate_load.at(tau);
  const T at_finger = drive.finger.static_limit * inputs.finger_load.at(tau);
  const T part = at_plate > 0 ? at_plate / (at_plate + at_finger) : T(0);
  return {part * found.plate, (1 - part) * found.plate};
}

/// Force of the end stops on the pin along a trajectory after τ, with an external force, N:
/// of elastic stops by their law, of rigid stops the reaction.
template <class Trajectory, class T>
T stop_force_along(const Trajectory& along, const Drive<T>& drive, const Segment<T>& segment,
                   const Curve<T>& force, T tau) {
  if (!in_contact(segment.mode.stop)) return T(0);
  const Stops<T>& stops = drive.stops;
  const T x = along.at(along.position(), tau);
  if (stops.rigid())
    return drive.stiffness * x - drive.mass * segment.plate_velocity.rate_at(tau) - force.at(tau) -
           along.at(along.plate_force(), tau) - along.at(along.finger_force(), tau);
  return stops.stiffness * (stop_sign(segment.mode.stop) * stops.travel - x) -
         stops.damping * along.at(along.velocity(), tau);
}

/// Inputs and results of a simulation. Owns no memory: the segments belong to the caller.
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

  /// Last time at which the state is known, s; infinite once the ending is known.
  T known_until() const {
    return outcome_.known() ? std::numeric_limits<T>::infinity() : outcome_.until;
  }

  /// Next segment; in a cycle, the first segment after the last; null without one.
  const Segment<T>* after(const Segment<T>& segment) const {
    if (&segment + 1 != end()) return &segment + 1;
    return outcome_.cycles() ? locate(outcome_.cycle_begin, Side::right).segment : nullptr;
  }

  struct Place {
    const Segment<T>* segment;
    T tau;
  };

  /// Segment that contains time t in [0, known_until()], and the time since its begin.
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

  /// Calls visit with the trajectory of a segment; see `visit_trajectory`.
  template <class Visitor>
  auto along(const Segment<T>& segment, Visitor&& visit) const {
    const auto needs_series = [](const Contact<T>& contact, const Profile<T>& load) {
      return contact.branches > 0 && !(contact.linear() && load.constant());
    };
    if (inputs_.straight() && !needs_series(drive_.plate, inputs_.plate_load) &&
        !needs_series(drive_.finger, inputs_.finger_load) && !drive_.finger.may_lag() &&
        segment.mode.plate != ContactState::slip_oblique)
      return visit(detail::ClosedForm<T>(segment));
    return visit_trajectory(drive_, segment, InputCurves<T>::of(drive_, inputs_, segment), visit);
  }

  /// Position, velocity or acceleration, after τ in a segment.
  T value(const Segment<T>& segment, T tau, Quantity quantity) const {
    return along(segment, [&](const auto& t) { return value_of(t, tau, quantity); });
  }
  Friction<T> friction(const Segment<T>& segment, T tau) const {
    return along(segment, [&](const auto& t) { return friction_of(t, segment, tau); });
  }

  /// Position, velocity or acceleration along a trajectory from `along`.
  template <class Trajectory>
  T value_of(const Trajectory& t, T tau, Quantity quantity) const {
    const T found = t.at(quantity_of(t, quantity), tau);
    return quantity == Quantity::position ? drive_.stops.within(found) : found;
  }
  template <class Trajectory>
  Friction<T> friction_of(const Trajectory& t, const Segment<T>& segment, T tau) const {
    const auto lines = [&] { return InputCurves<T>::of(drive_, inputs_, segment); };
    return friction_along(t, drive_, segment, lines, tau);
  }
  /// Energy stored in elastic stops, J; also while they return behind a pin.
  T stop_energy(T x) const {
    using std::abs;
    const Stops<T>& stops = drive_.stops;
    const T depth = abs(x) - stops.travel;
    return depth > 0 && !stops.rigid() ? stops.stiffness * depth * depth / 2 : T(0);
  }

  /// Calls visit(segment, from τ, to τ, repetitions) for each stretch of the motion in [from,
  /// until], until visit returns false; `from` is within the simulated time.
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

  /// Calls visit(segment, begin, part before `to`) for each segment that overlaps [from, to], s, in
  /// order and with cycles expanded, until visit returns false.
  template <class Visitor>
  void expanded(T from, T to, Visitor&& visit) const {
    using std::floor;
    T round{-1};  // simulated part
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
  /// Time mapped into the simulated cycle.
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
