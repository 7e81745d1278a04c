/// What ends a mode: its guards, and the earliest of their zeros.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/friction.hpp"
#include "pindrive/limits.hpp"
#include "pindrive/roots.hpp"

namespace pindrive::detail {

/// What stays positive while a mode lasts: the distance of a sliding speed from a bound, or (none) what
/// contacts that stick could carry beyond what they do, to a side.
template <class T>
struct Guard {
  Path<T> path;
  Bound bound;
  bool plate, finger;  ///< whose it is
  int side;
  T zero{std::numeric_limits<T>::infinity()};  ///< s
};

/// The guards of a mode; at most two of a sliding contact or an elastic stick, and two of a stick force.
template <class T>
class Guards {
 public:
  void clear() { count_ = 0; }
  void add(const Guard<T>& guard) { list_[count_++] = guard; }

  const Guard<T>* begin() const { return list_.data(); }
  const Guard<T>* end() const { return list_.data() + count_; }

  /// The earliest zero, or the limit if none comes before it. `v` is the velocity at the start, m/s; times
  /// are `since` then, and those that differ by less than the rounding of a time are one.
  T earliest(const Oscillator<T>& oscillator, T v, T since, T limit) {
    for (int i = 0; i < count_; ++i) {
      Guard<T>& guard = list_[i];
      const Path<T>& path = guard.path;
      if ((path.start >= 0 && path.constant()) || comes_later(path, v)) continue;
      if (path.straight() && path.centre() == 0) {  // in closed form
        guard.zero =
            Rooted<T>::at(oscillator, path, oscillator.zeros(path.start, path.slope).first);
      } else {
        const bool ends = limit < std::numeric_limits<T>::infinity();
        const T horizon = ends ? limit + rounding<T> * (since + limit) : limit;
        guard.zero = first_root(oscillator, path, 1, horizon);
      }
      limit = std::min(limit, guard.zero);
    }
    return limit;
  }

 private:
  /// Whether another guard comes to zero before this one for certain: it runs below, at a constant
  /// distance beyond rounding, or falls to the middle of its oscillation while this one rises.
  bool comes_later(const Path<T>& p, T v) const {
    using std::abs;
    const T farther = p.start - rounding<T> * (p.start + abs(v));
    return p.straight() && std::any_of(begin(), end(), [&](const Guard<T>& other) {
             const Path<T>& q = other.path;
             if (!q.straight()) return false;
             return (q.start < farther && q.value == p.value && q.slope == p.slope) ||
                    (q.slope < 0 && q.value == -p.value && q.slope == -p.slope && q.centre() == 0);
           });
  }

  std::array<Guard<T>, 6> list_;
  int count_{0};
};

}  // namespace pindrive::detail
