/// The slider of a compliant contact: a point without mass between the skin, which stretches, and the pin, on
/// which it slides (docs/theory.md, section 11).
///
/// Its skin asks of it one friction. Where its curve rises that is one speed, and a plateau leaves it the
/// speed of the pin; where its curve falls, no speed lasts.
#pragma once

#include <limits>

#include "pindrive/model.hpp"
#include "pindrive/state.hpp"

namespace pindrive::detail {

/// Where a slider is after it has come to an end of what it can do, at once.
template <class T>
struct Landing {
  int branch{0};
  T speed{0};              ///< along the slip, m/s
  T friction{0};           ///< under a load of 1, N
  Bound at{Bound::none};   ///< the end of the branch that it is at
  bool grips{false};       ///< it does not slide …
  bool drops{false};       ///< or it slid so fast that the skin has become shorter
};

/// The landings of a slider on a curve. `pin(F)` is the speed that it has where its friction stays F.
template <class T, class Pin>
class Slider {
 public:
  Slider(const Contact<T>& contact, Pin pin) : contact_(contact), pin_(pin) {}

  /// The first speed from the begin of a branch on at which its curve carries the friction asked of it. If
  /// none does, it is infinitely fast until the skin asks no more than the last.
  Landing<T> faster(int branch, T asked) const {
    for (int j = branch;; ++j) {
      const Branch<T> range = contact_.branch(j);
      const bool last = !(range.to < never);
      if (range.slope > 0) {
        const T most = last ? never : contact_.branch(j + 1).force;
        if (asked < most) {
          const T beyond = (asked - range.force) / range.slope;
          if (beyond > 0) return {j, range.from + beyond, asked};
          return {j, range.from, range.force, Bound::lower};
        }
        if (asked == most && !(pin_(asked) > range.to)) return {j, range.to, asked, Bound::upper};
      }
      if (range.slope != 0 || !(last || range.force >= asked)) continue;
      const bool drops = range.force < asked;
      const T speed = pin_(range.force);
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
  Landing<T> slower(int branch, T asked) const {
    for (int j = branch - 1; j >= 0; --j) {
      const Branch<T> range = contact_.branch(j);
      if (range.slope > 0 && asked > range.force) {
        const bool whole = j + 1 < contact_.branches && asked >= contact_.branch(j + 1).force;
        if (whole) return {j, range.to, asked, Bound::upper};
        return {j, range.from + (asked - range.force) / range.slope, asked};
      }
      const T speed = pin_(range.force);
      const bool holds = j == 0 && asked < contact_.static_limit;
      if (range.slope > 0 && asked == range.force && speed > range.from && !holds)
        return {j, range.from, range.force, Bound::lower};
      if (range.slope != 0 || range.force > asked) continue;
      if (!(speed > range.from)) continue;
      if (speed < range.to) return {j, speed, range.force};
      return {j, range.to, range.force, Bound::upper};
    }
    return {0, T(0), asked, Bound::none, true};
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  const Contact<T>& contact_;
  Pin pin_;
};

/// That of a contact without skin.
struct NoLanding {
  static constexpr int speed = 0, friction = 0;
  static constexpr bool drops = false;
};

}  // namespace pindrive::detail
