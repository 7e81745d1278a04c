/// What ends a mode: its guards, and the earliest of their zeros.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow/roots.hpp"
#include "pindrive/law/friction.hpp"
#include "pindrive/model/limits.hpp"

namespace pindrive::detail {

/// What stays positive while a mode lasts: the distance of a sliding speed from a bound, or (none) what
/// contacts that stick could carry beyond what they do, to a side.
template <class T>
struct Guard {
  Path<T> path;
  Bound bound;
  bool plate;  ///< whose it is, or the finger's; the force of both that stick is the plate's
  int side;
  T zero{std::numeric_limits<T>::infinity()};  ///< s
};

/// The sign of what a quantity begins with. Of two guards that are images of each other, the one that it
/// approaches is looked at first: a mirrored motion then has the same zeros, to the bit.
template <class T>
int sense(const Path<T>& path) {
  for (const T part : {path.start, path.slope + path.drift, path.value, path.curvature})
    if (part != 0) return part < 0 ? -1 : 1;
  return 1;
}

/// The guards of a mode; at most two of a sliding contact or an elastic stick, of a stick force and of the
/// end stops.
template <class T>
class Guards {
 public:
  void clear() {
    count_ = forces_ = 0;
    below_ = above_ = -1;
  }

  /// Adds what contacts that stick could carry to a side, before the guards of speeds.
  void add_force(const Path<T>& left, bool plate, int side) {
    add(left, Bound::none, plate, side);
    forces_ = count_;
  }
  /// Adds a guard that may come to zero: it oscillates or falls.
  void add(const Path<T>& path, Bound bound, bool plate, int side = 0) {
    if (path.oscillates() || path.drift < 0 || path.curvature < 0)
      list_[count_++] = {path, bound, plate, side};
  }
  /// Adds one of which only the zero is needed, s; those of a stick force come first.
  void add_known(T zero, Bound bound, bool plate, int side, bool stick_force) {
    list_[count_++] = {{}, bound, plate, side, zero};
    if (stick_force) forces_ = count_;
  }
  /// Adds those of a contact in a mode, of speeds along the segment and of the force in an elastic stick.
  void add(const Touch<T>& side, const Segment<T>& segment, bool plate) {
    if (side.elastic()) {
      const Path<T> most = Line<T>{side.stick_limit(), side.contact.static_limit * side.load.rate};
      const int near = -sense(segment.finger_force);
      for (const int to : {near, -near}) {
        Path<T> left = most + T(to) * segment.finger_force;
        if (most.drift != 0 && side.does.at == Bound::upper && to == near) {
          left.start = T(0);
          if (side.off_level(segment.flow.velocity.start) == 0) left.drift = -left.slope;
        }
        add(left, Bound::none, plate, to);
      }
    }
    if (!side.sliding()) return;
    const Branch<T> range = side.branch();
    const Path<T>& v = segment.flow.velocity;
    const T to = side.does.sense;
    const T speed = to * (v.start - side.surface.value) -
                    (side.contact.rigid() ? T(0) : side.stretching(range.force));
    const Path<T> above{side.does.at == Bound::lower ? T(0) : speed - range.from, to * v.value,
                        to * v.slope, to * (v.drift - side.surface.rate)};
    add_nearer(above, Bound::lower, plate, to > 0, v.start);
    if (!(range.to < std::numeric_limits<T>::infinity())) return;
    Path<T> below = T(-1) * above;
    below.start = side.does.at == Bound::upper ? T(0) : range.to - speed;
    add_nearer(below, Bound::upper, plate, to < 0, v.start);
  }

  const Guard<T>* begin() const { return list_.data(); }
  const Guard<T>* end() const { return list_.data() + count_; }

  /// The earliest zero, or the limit if none comes before it. Times are `since` the start of the mode, and
  /// those that differ by less than the rounding of a time are one.
  T earliest(const Oscillator<T>& oscillator, T since, T limit, T force_error) {
    const Path<T>* falls = nullptr;     // to the middle of its oscillation
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
        // What rises as another falls turns only after that has come to zero.
        if (falls != nullptr && path.value == -falls->value && path.slope == -falls->slope)
          continue;
      }
      const bool ends = limit < std::numeric_limits<T>::infinity();
      guard.zero = first_crossing(guard, oscillator, force_error,
                                  ends ? limit + rounding<T> * (since + limit) : limit);
      limit = std::min(limit, guard.zero);
    }
    return limit;
  }

  /// Of zeros that are known, the earliest, or the limit if none comes before it.
  T earliest_known(T limit) const {
    for (const Guard<T>& guard : *this) limit = std::min(limit, guard.zero);
    return limit;
  }

  /// The earliest zero, or when it counts: what has come to its bound and stays there to rounding until a
  /// speed comes to its own after a stick force's, or until the row, does so there: a stick force may turn
  /// where a speed is zero. stays(guard, τ) says whether one does.
  template <class Stays>
  T put_off(T earliest, T row, Stays&& stays) const {
    T next = row;
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

  /// When the first of those in closed form counts: up to a limit, which may be a row, and with stick forces
  /// that are known to their roundoff.
  T first_event(const Oscillator<T>& oscillator, T since, T limit, bool is_row, T roundoff) {
    const T row = is_row ? limit : std::numeric_limits<T>::infinity();
    const T first = earliest(oscillator, since, limit, roundoff);
    T counts = put_off(first, row, [&](const Guard<T>& guard, T tau) {
      return stays(guard, oscillator, tau, roundoff);
    });
    if (counts > first)  // until then the others have not been looked at
      for (int i = 0; i < count_; ++i)
        if (list_[i].zero > counts) {
          list_[i].zero = first_crossing(list_[i], oscillator, roundoff, counts);
          counts = std::min(counts, list_[i].zero);
        }
    return counts;
  }

  /// Whether one in closed form stays at its bound from its zero until τ, to rounding.
  bool stays(const Guard<T>& guard, const Oscillator<T>& oscillator, T tau,
             T force_roundoff) const {
    using std::abs;
    const Path<T>& path = guard.path;
    const T roundoff = guard.bound == Bound::none || guard.bound == Bound::push
                           ? force_roundoff
                           : rounding<T> * (abs(path.start) + abs(path.value));
    const T rate = path.rates(oscillator, oscillator.after(guard.zero)).first;
    return stays_at_bound(rate * (tau - guard.zero), path.at(oscillator, tau), roundoff);
  }

 private:
  /// The first zero of a guard until a limit; infinite if the stick force of skin only grazes its limit. A force
  /// that does not grow and exceeds its limit by no more than its error never exceeds the limit: the same
  /// drive in other units has another error, and does not slip.
  static T first_crossing(const Guard<T>& guard, const Oscillator<T>& oscillator, T force_error,
                          T limit) {
    const Path<T>& path = guard.path;
    const T zero = first_root(oscillator, path, 1, limit);
    const bool skin = guard.bound == Bound::none && !guard.plate;
    if (!skin || !(zero < std::numeric_limits<T>::infinity())) return zero;
    if (oscillator.alpha() > 0 || !path.oscillates() || !path.straight()) return zero;
    const auto rates = path.rates(oscillator, oscillator.after(zero));
    return touches(rates.first, rates.second, 2 * force_error) ? std::numeric_limits<T>::infinity()
                                                               : zero;
  }
  /// Adds the distance of a speed from a bound: one that falls as the velocity v does (or rises). Of two that
  /// run at a constant distance beyond the rounding of v only the one below: it comes to zero first.
  void add_nearer(const Path<T>& path, Bound bound, bool plate, bool falls, T v) {
    using std::abs;
    int& nearest = falls ? below_ : above_;
    if (nearest >= 0 && list_[nearest].path.drift == path.drift) {
      Guard<T>& other = list_[nearest];
      const T apart = path.start - other.path.start;
      const T one = rounding<T> * (std::max(path.start, other.path.start) + abs(v));
      if (apart > one) return;
      if (apart < -one) {
        other = {path, bound, plate, 0};
        return;
      }
    }
    const int index = count_;
    add(path, bound, plate);
    if (count_ > index) nearest = index;
  }

  std::array<Guard<T>, 8> list_;
  int count_{0}, forces_{0};   ///< of them, those of a stick force
  int below_{-1}, above_{-1};  ///< those of the velocity, from below and from above
};

}  // namespace pindrive::detail
