/// Slider of a compliant contact: a massless point between the skin, which stretches, and the pin,
/// on which the slider slides (docs/theory.md, section 4).
///
/// The skin tension determines the friction of the slider. On a rising branch one speed has that
/// friction; on a plateau the slider has the speed of the pin; on a falling branch no speed is
/// stable.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// State of a slider after an instantaneous change of its speed.
template <class T>
struct SliderJump {
  int branch{0};
  T speed{0};                            ///< in the direction of slip, m/s
  T friction{0};                         ///< for a load factor of 1, N
  ActiveGuard guard{ActiveGuard::none};  ///< active guard: an end of the branch
  bool sticks{false};                    ///< the slider sticks
  bool shortens_skin{false};             ///< the skin shortens during the jump
  bool reverses{false};                  ///< the slip direction reverses
};

/// Jumps of a slider on a friction curve, for a pin with a speed in the direction of slip (m/s).
///
/// `stretch_rate` is the rate at which the skin stretches per newton of friction at load factor 1,
/// as the load changes, m/(s N).
template <class T>
class Slider {
 public:
  Slider(const Contact<T>& contact, T speed, T stretch_rate)
      : contact_(contact), speed_(speed), stretch_rate_(stretch_rate) {}

  /// Slider speed at which a friction stays constant, m/s.
  T stationary_speed(T friction) const {
    const T pin = stretch_rate_ == 0 ? speed_ : speed_ - stretch_rate_ * friction;
    // rounding: a pin as fast as the skin stretches leaves the slider without a speed (slider_test).
    return abs(pin) < rounding<T> * abs(speed_) ? T(0) : pin;
  }

  /// Stationary speed at a friction, minus a speed, m/s; zero within its error.
  T excess(T speed, T friction) const {
    const T left = stationary_speed(friction) - speed;
    // rounding: tests/hard/slip-at-curve-point-within-rounding-under-load-growing-from-zero.txt
    return abs(left) < rounding<T> * abs(speed_) ? T(0) : left;
  }

  /// Smallest speed from the begin of a branch upwards at which the friction curve has the given
  /// friction. If there is none, the speed is infinite for an instant until the skin tension equals
  /// the last friction.
  [[gnu::noinline]] SliderJump<T> next_faster(int branch, T friction) const {
    for (int j = branch;; ++j) {
      const Branch<T> range = contact_.branch(j);
      const bool last = j + 1 >= contact_.branches;
      if (range.slope > 0) {
        const T largest = last ? unbounded : contact_.branch(j + 1).force;
        if (!(friction > range.force) || same(friction, range.force))
          return {j, range.from, range.force, ActiveGuard::lower};
        if (same(friction, largest)) {
          if (!(stationary_speed(largest) > range.to))
            return {j, range.to, largest, ActiveGuard::upper};
        } else if (friction < largest) {
          return {j, range.from + (friction - range.force) / range.slope, friction};
        }
      }
      const bool shortens_skin = range.force < friction && !same(friction, range.force);
      if (!last && (range.slope != 0 || shortens_skin)) continue;
      const T speed = stationary_speed(range.force);
      if (speed < range.from && shortens_skin) {
        SliderJump<T> back = next_slower(j, range.force);
        back.shortens_skin = true;
        return back;
      }
      if (!(speed > range.from))
        return {j, range.from, range.force, ActiveGuard::lower, false, shortens_skin};
      if (last || speed < range.to)
        return {j, speed, range.force, ActiveGuard::none, false, shortens_skin};
    }
  }

  /// Largest speed below the begin of a branch at which the friction does not exceed the given
  /// friction; without one the slider sticks.
  [[gnu::noinline]] SliderJump<T> next_slower(int branch, T friction) const {
    for (int j = branch - 1; j >= 0; --j) {
      const Branch<T> range = contact_.branch(j);
      const bool at_start = same(friction, range.force);
      if (range.slope > 0 && friction > range.force && !at_start) {
        const T largest = j + 1 < contact_.branches ? contact_.branch(j + 1).force : unbounded;
        if (friction > largest || same(friction, largest))
          return {j, range.to, largest, ActiveGuard::upper};
        return {j, range.from + (friction - range.force) / range.slope, friction};
      }
      const T speed = stationary_speed(range.force);
      const bool static_suffices = j == 0 && friction < contact_.static_limit;
      if (range.slope > 0 && at_start && speed > range.from && !static_suffices)
        return {j, range.from, range.force, ActiveGuard::lower};
      if (range.slope != 0 || (range.force > friction && !at_start)) continue;
      if (!(speed > range.from)) continue;
      if (speed < range.to) return {j, speed, range.force};
      return {j, range.to, range.force, ActiveGuard::upper};
    }
    return {0, T(0), friction, ActiveGuard::none, true};
  }
  /// Jump of a slider that has slowed down at once and would rest on a plateau.
  SliderJump<T> sticking(const SliderJump<T>& rests) const {
    SliderJump<T> sticks = next_slower(rests.branch, rests.friction);
    sticks.shortens_skin = true;
    return sticks;
  }

  /// Largest stable speed as a load grows from zero, at which friction grows as the skin stretches.
  /// Without one the slider sticks.
  [[gnu::noinline]] SliderJump<T> at_first_load() const {
    for (int j = speed_ > 0 ? contact_.branch_of(speed_) : -1; j >= 0; --j) {
      const Branch<T> range = contact_.branch(j);
      const T left = excess(range.from, range.force);
      const bool last = j + 1 >= contact_.branches;
      if (range.slope < 0 || left < 0 || (left == 0 && j == 0)) continue;
      if (left == 0) return {j, range.from, range.force, ActiveGuard::lower};
      if (!last && excess(range.to, contact_.branch(j + 1).force) >= 0) continue;
      const T speed = std::min(range.from + left / (1 + stretch_rate_ * range.slope), range.to);
      return {j, speed, range.at(speed)};
    }
    return {0, T(0), T(0), ActiveGuard::none, true};
  }

 private:
  static constexpr T unbounded = std::numeric_limits<T>::infinity();
  /// True if two frictions are equal within their error.
  static bool same(T one, T other) {
    // rounding: tests/hard/skin-force-at-curve-point-within-rounding.txt
    return one == other || abs(one - other) < rounding<T> * other;
  }

  const Contact<T>& contact_;
  T speed_, stretch_rate_;
};

}  // namespace pindrive::detail
