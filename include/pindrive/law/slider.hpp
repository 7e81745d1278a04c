/// The slider of a compliant contact: a point without mass between the skin, which stretches, and the pin, on
/// which it slides (docs/theory.md, section 11).
///
/// Its skin asks of it one friction. Where its curve rises that is one speed, and a plateau leaves it the
/// speed of the pin; where its curve falls, no speed lasts.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/law/state.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Where a slider is after it has come to an end of what it can do, at once.
template <class T>
struct Landing {
  int branch{0};
  T speed{0};             ///< along the slip, m/s
  T friction{0};          ///< under a load of 1, N
  Bound at{Bound::none};  ///< the end of the branch that it is at
  bool grips{false};      ///< it does not slide …
  bool drops{false};      ///< or it slid so fast that the skin has become shorter
  bool turns{false};      ///< it slides the other way
};

/// The landings of a slider on a curve, of a pin with a speed along the slip. Its skin stretches by `follows`
/// for each newton of friction under a load of 1, as its load changes, m/s.
template <class T>
class Slider {
 public:
  Slider(const Contact<T>& contact, T speed, T follows)
      : contact_(contact), speed_(speed), follows_(follows) {}

  /// The speed that it has where its friction stays this, m/s; none to rounding is none.
  T pin(T friction) const {
    using std::abs;
    const T pin = follows_ == 0 ? speed_ : speed_ - follows_ * friction;
    return abs(pin) < rounding<T> * abs(speed_) ? T(0) : pin;
  }

  /// By how much that is faster than a speed at this friction; none to rounding is none.
  T misses(T speed, T friction) const {
    using std::abs;
    const T left = pin(friction) - speed;
    return abs(left) < rounding<T> * abs(speed_) ? T(0) : left;
  }

  /// The first speed from the begin of a branch on at which its curve carries the friction asked of it. If
  /// none does, it is infinitely fast until the skin asks no more than the last.
  [[gnu::noinline]] Landing<T> faster(int branch, T asked) const {
    for (int j = branch;; ++j) {
      const Branch<T> range = contact_.branch(j);
      const bool last = !(range.to < never);
      if (range.slope > 0) {
        const T most = last ? never : contact_.branch(j + 1).force;
        if (!(asked > range.force) || same(asked, range.force))
          return {j, range.from, range.force, Bound::lower};
        if (same(asked, most)) {
          if (!(pin(most) > range.to)) return {j, range.to, most, Bound::upper};
        } else if (asked < most) {
          return {j, range.from + (asked - range.force) / range.slope, asked};
        }
      }
      const bool drops = range.force < asked && !same(asked, range.force);
      if (range.slope != 0 || (drops && !last)) continue;
      const T speed = pin(range.force);
      if (speed < range.from && drops) {
        Landing<T> back = slower(j, range.force);
        back.drops = true;
        return back;
      }
      if (!(speed > range.from)) return {j, range.from, range.force, Bound::lower, false, drops};
      if (speed < range.to) return {j, speed, range.force, Bound::none, false, drops};
    }
  }

  /// The first speed below the begin of a branch at which its curve carries no more than the friction asked of
  /// it; without one it grips.
  [[gnu::noinline]] Landing<T> slower(int branch, T asked) const {
    for (int j = branch - 1; j >= 0; --j) {
      const Branch<T> range = contact_.branch(j);
      const bool start = same(asked, range.force);
      if (range.slope > 0 && asked > range.force && !start) {
        const T most = j + 1 < contact_.branches ? contact_.branch(j + 1).force : never;
        if (asked > most || same(asked, most)) return {j, range.to, most, Bound::upper};
        return {j, range.from + (asked - range.force) / range.slope, asked};
      }
      const T speed = pin(range.force);
      const bool holds = j == 0 && asked < contact_.static_limit;
      if (range.slope > 0 && start && speed > range.from && !holds)
        return {j, range.from, range.force, Bound::lower};
      if (range.slope != 0 || (range.force > asked && !start)) continue;
      if (!(speed > range.from)) continue;
      if (speed < range.to) return {j, speed, range.force};
      return {j, range.to, range.force, Bound::upper};
    }
    return {0, T(0), asked, Bound::none, true};
  }
  /// The same of one that has become slower at once, and would be at rest on a plateau.
  Landing<T> gripping(const Landing<T>& rests) const {
    Landing<T> grips = slower(rests.branch, rests.friction);
    grips.drops = true;
    return grips;
  }

  /// The largest speed that lasts as a load grows from zero, at which friction grows as the skin stretches; it
  /// grips if none does.
  [[gnu::noinline]] Landing<T> from_zero() const {
    for (int j = speed_ > 0 ? contact_.branch_of(speed_) : -1; j >= 0; --j) {
      const Branch<T> range = contact_.branch(j);
      const T left = misses(range.from, range.force);
      const bool last = !(range.to < never);
      if (range.slope < 0 || left < 0 || (left == 0 && j == 0)) continue;
      if (left == 0) return {j, range.from, range.force, Bound::lower};
      if (!last && misses(range.to, contact_.branch(j + 1).force) >= 0) continue;
      const T speed = std::min(range.from + left / (1 + follows_ * range.slope), range.to);
      return {j, speed, range.at(speed)};
    }
    return {0, T(0), T(0), Bound::none, true};
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();
  /// Whether two frictions differ by rounding only.
  static bool same(T one, T other) {
    using std::abs;
    return one == other || abs(one - other) < rounding<T> * other;
  }

  const Contact<T>& contact_;
  T speed_, follows_;
};

}  // namespace pindrive::detail
