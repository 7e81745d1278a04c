/// Guards of a mode and the earliest of their zeros.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow/roots.hpp"
#include "pindrive/law/contact_point.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Quantity that is positive while a mode lasts: distance of a sliding speed from the end of its
/// branch or, with `ActiveGuard::none`, margin of a stick force to its limit on one side.
template <class T, class Quantity = Path<T>>
struct Guard {
  Quantity path;
  ActiveGuard bound;
  bool plate;  ///< plate or finger; the joint stick force of both belongs to the plate
  int side;
  T zero{std::numeric_limits<T>::infinity()};  ///< s; infinite without one
  Real<T> error{0};  ///< of a function: a path that only touches zero within it has no zero
};

/// Sign of the first part of a path that is not zero. Of two mirrored guards the approached one is
/// evaluated first; a mirrored motion then has identical zeros, to the bit.
template <class T>
int leading_sign(const Path<T>& path) {
  for (const T part : {path.start, path.slope + path.drift, path.value, path.curvature})
    if (part != 0) return part < 0 ? -1 : 1;
  return 1;
}

/// List of the guards of a mode: at most two for a sliding contact or an elastic stick, for a stick
/// force and for the end stops.
template <class T>
class Guards {
 public:
  void clear() {
    count_ = forces_ = 0;
    below_ = above_ = -1;
  }

  /// Adds the margin of a stick force on one side; called before the guards of speeds are added.
  void add_force(const Path<T>& margin, bool plate, int side) {
    add(margin, ActiveGuard::none, plate, side);
    forces_ = count_;
  }
  /// Adds a guard, unless it neither oscillates nor falls.
  void add(const Path<T>& path, ActiveGuard bound, bool plate, int side = 0) {
    if (path.oscillates() || path.drift < 0 || path.curvature < 0)
      list_[count_++] = {path, bound, plate, side};
  }
  /// Adds a guard by its zero alone, s; guards of a stick force are added first.
  void add_known(T zero, ActiveGuard bound, bool plate, int side, bool stick_force) {
    list_[count_++] = {{}, bound, plate, side, zero};
    if (stick_force) forces_ = count_;
  }
  /// Adds the guards of a contact: of speeds along the segment, and of the skin tension in an
  /// elastic stick.
  void add(const ContactPoint<T>& side, const Segment<T>& segment, bool plate) {
    if (side.elastic()) {
      const Path<T> limit = Line<T>{side.stick_limit(), side.contact.static_limit * side.load.rate};
      const int near = -leading_sign(segment.finger_force);
      for (const int to : {near, -near}) {
        Path<T> margin = limit + T(to) * segment.finger_force;
        if (limit.drift != 0 && side.mode.guard == ActiveGuard::upper && to == near) {
          margin.start = T(0);
          // rounding: tests/hard/skin-at-limit-falling-at-rate-of-force.txt
          if (abs(margin.slope + margin.drift) < rounding<T> * abs(margin.slope))
            margin.drift = -margin.slope;
        }
        add(margin, ActiveGuard::none, plate, to);
      }
    }
    if (!side.sliding()) return;
    const Branch<T> range = side.branch();
    const Path<T>& v = segment.flow.velocity;
    const T to = side.mode.slip_sign;
    const T speed = to * (v.start - side.surface.value) -
                    (side.contact.rigid() ? T(0) : side.stretch_rate(range.force));
    const Path<T> above{side.mode.guard == ActiveGuard::lower ? T(0) : speed - range.from,
                        to * v.value, to * v.slope, to * (v.drift - side.surface.rate)};
    add_nearer(above, ActiveGuard::lower, plate, to > 0);
    if (!(range.to < std::numeric_limits<T>::infinity())) return;
    Path<T> below = T(-1) * above;
    below.start = side.mode.guard == ActiveGuard::upper ? T(0) : range.to - speed;
    add_nearer(below, ActiveGuard::upper, plate, to < 0);
  }

  const Guard<T>* begin() const { return list_.data(); }
  const Guard<T>* end() const { return list_.data() + count_; }

  /// Earliest zero, or the limit if there is none before.
  ///
  /// Times count from the start of the mode, which is at `since`. Times that differ by less than
  /// the time resolution are equal.
  T earliest(const Oscillator<T>& oscillator, T since, T limit) {
    const Path<T>* falls = nullptr;     // falls to the centre of its oscillation
    for (int n = 0; n < count_; ++n) {  // speeds, then stick forces
      Guard<T>& guard = list_[n + forces_ < count_ ? n + forces_ : n + forces_ - count_];
      const Path<T>& path = guard.path;
      if (path.oscillates() && path.straight()) {
        if (path.centre() == 0) {  // in closed form
          guard.zero =
              Rooted<T>::at(oscillator, path, oscillator.zeros(path.start, path.slope).first);
          limit = std::min(limit, guard.zero);
          if (path.slope < 0) falls = &path;
          continue;
        }
        // The mirrored guard turns only after the falling guard has reached zero.
        if (falls != nullptr && path.value == -falls->value && path.slope == -falls->slope)
          continue;
      }
      const bool ends = limit < std::numeric_limits<T>::infinity();
      guard.zero =
          first_root(oscillator, path, 1, ends ? limit + rounding<T> * (since + limit) : limit);
      limit = std::min(limit, guard.zero);
    }
    return limit;
  }

  /// Earliest of the zeros already known, or the limit if there is none before.
  T earliest_known(T limit) const {
    for (const Guard<T>& guard : *this) limit = std::min(limit, guard.zero);
    return limit;
  }

  /// Defers grazing zeros: a guard that reaches zero and stays there within its error until a later
  /// zero of a speed, or until the breakpoint, acts there. A stick force may turn where a speed is
  /// zero. `stays(guard, τ)` returns true for such a guard.
  template <class Stays>
  T defer_grazing(T earliest, T breakpoint, Stays&& stays) const {
    T next = breakpoint;
    if (forces_ > 0)
      for (int i = forces_; i < count_; ++i)
        if (list_[i].zero > earliest) next = std::min(next, list_[i].zero);
    const bool late =
        earliest < next && next < std::numeric_limits<T>::infinity() &&
        std::all_of(
            begin(), end(),
            [&](const Guard<T>& guard) { return !(guard.zero < next) || stays(guard, next); });
    return late ? next : earliest;
  }

  /// Time of the first event of a mode in closed form, up to a limit, which may be a breakpoint.
  T first_event(const Oscillator<T>& oscillator, T since, T limit, bool is_breakpoint,
                T force_error) {
    const T breakpoint = is_breakpoint ? limit : std::numeric_limits<T>::infinity();
    const T first = earliest(oscillator, since, limit);
    T counts = defer_grazing(first, breakpoint, [&](const Guard<T>& guard, T tau) {
      return stays(guard, oscillator, tau, force_error);
    });
    if (counts > first)  // later guards are not evaluated yet
      for (int i = 0; i < count_; ++i)
        if (list_[i].zero > counts) {
          list_[i].zero = first_root(oscillator, list_[i].path, 1, counts);
          counts = std::min(counts, list_[i].zero);
        }
    return counts;
  }

  /// True if a guard in closed form stays at zero from its zero until τ, within its error.
  bool stays(const Guard<T>& guard, const Oscillator<T>& oscillator, T tau,
             T force_roundoff) const {
    const Path<T>& path = guard.path;
    const T force_error = guard.bound == ActiveGuard::none || guard.bound == ActiveGuard::push
                              ? force_roundoff
                              : rounding<T> * (abs(path.start) + abs(path.value));
    const T rate = path.rates(oscillator, oscillator.after(guard.zero)).first;
    return stays_at_bound(rate * (tau - guard.zero), path.at(oscillator, tau), force_error);
  }

 private:
  /// Adds the distance of a speed from the end of its branch; `falls` if it decreases with the
  /// velocity v. Of two parallel distances only the smaller is kept, as its zero comes first.
  void add_nearer(const Path<T>& path, ActiveGuard bound, bool plate, bool falls) {
    int& nearest = falls ? below_ : above_;
    if (nearest >= 0 && list_[nearest].path.drift == path.drift) {
      Guard<T>& other = list_[nearest];
      if (path.start > other.path.start) return;
      if (path.start < other.path.start) {
        other = {path, bound, plate, 0};
        return;
      }
    }
    const int index = count_;
    add(path, bound, plate);
    if (count_ > index) nearest = index;
  }

  std::array<Guard<T>, 8> list_;
  int count_{0}, forces_{0};   ///< number of guards; number of guards of a stick force
  int below_{-1}, above_{-1};  ///< nearest guards of the velocity below and above
};

}  // namespace pindrive::detail
