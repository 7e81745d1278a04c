/// Balance of forces in creep: the sliding direction at which friction balances all further forces, and how long the
/// motion that follows is smooth (see creep.hpp).
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/series_equation.hpp"

namespace pindrive::detail {

/// Ratio t = (x' − v_p)/w of a pin in creep, for a transverse velocity w >= 0.
template <class T>
class CreepBalance {
 public:
  using Real = detail::Real<T>;

  explicit CreepBalance(const SeriesEquation<T>& e) : side_(begins_with(e.across)) {
    across_ = {T(side_) * e.across.value, T(side_) * e.across.rate};
  }

  /// Sign of w, or that with which w begins; by symmetry, the balance takes w >= 0.
  int side() const { return side_; }
  /// |w| and its rate, m/s.
  const Line<T>& across() const { return across_; }

  /// Time until the inputs, the skin or the zero of a linear w end a step, up to a limit, s.
  Real farthest(const SeriesEquation<T>& e, Real limit) const {
    const Real reach = std::min({limit, e.input_reach(), Real(longest_step) / e.skin_rate()});
    const bool ends = across_.rate < 0 && e.across.straight();
    return ends ? std::min(reach, -plain(across_.value) / plain(across_.rate)) : reach;
  }

  /// Length of a first step of creep from a state, up to a limit, s; 0 for a pin that cannot creep.
  Real span(const SeriesEquation<T>& e, const SeriesState<T>& s, Real limit) {
    if (e.held || e.side != 0) return Real(0);
    const bool drags = e.plate_force > 0 || e.plate_falling.present();
    if (!(drags && e.load.value > 0) || !solve(e, s, e.plate_velocity.rate)) return Real(0);
    return std::min(time_scale(e, s), farthest(e, limit));
  }

  /// Computes t at a state, for an acceleration (m/s²); true if friction can balance all further forces.
  bool solve(const SeriesEquation<T>& e, const SeriesState<T>& s, const T& acceleration) {
    const T needed = (e.force.value - e.mass * acceleration - e.damping * e.plate_velocity.value -
                      e.stiffness * s.x - e.skin_pull.value * s.skin) /
                     e.load.value;
    const T linear = (e.plate_slope + e.damping / e.load.value) * across_.value;
    T t = ratio_;
    for (int tries = 0; tries < 60; ++tries) {
      const T root = sqrt(1 + t * t), along = t / root;
      T friction = e.plate_force, falls{0}, others{0};
      if (e.plate_falling.present()) {
        friction += e.plate_falling.at(across_.value * root);
        falls = e.plate_falling.slope(across_.value * root) * across_.value * along * along;
      }
      if (e.finger_falling.present()) {
        const T side = T(e.finger_side), pressed = e.finger_load.value / e.load.value;
        const T v = side * (e.plate_velocity.value + across_.value * t);
        others = side * pressed * e.finger_falling.at(v);
        falls += pressed * e.finger_falling.slope(v) * across_.value;
      }
      const T at_plate = friction * along;
      const T slope = friction / (root * root * root) + falls + linear;
      const T missing = needed - at_plate - others - linear * t, move = missing / slope;
      // rounding: tests/hard/creep-at-begin-of-slow-stroke.txt, and most drives with creep
      const bool balanced = abs(missing) <= rounding<Real> * (abs(needed) + abs(at_plate) +
                                                              abs(others) + abs(linear * t));
      const T most = 1 + abs(t);  // a longer move overshoots near the friction limit
      t += move > most ? most : move < -most ? -most : move;
      if (!(slope > 0 && abs(t) < Real(steepest_creep)))
        return false;  // falling friction balances nothing
      if (!balanced) continue;
      ratio_ = t;
      return true;
    }
    return false;
  }

  const T& ratio() const { return ratio_; }
  /// Friction of the plate at a load factor of 1, without its part that grows with the speed, N.
  T friction(const SeriesEquation<T>& e) const {
    return e.plate_force + e.plate_falling.at(across_.value * sqrt(1 + ratio_ * ratio_));
  }

 private:
  /// Estimate of the time scale of creep, s.
  Real time_scale(const SeriesEquation<T>& e, const SeriesState<T>& s) const {
    const Real t = plain(ratio_), load = plain(e.load.value), F = plain(friction(e));
    const Real w = plain(across_.value), v = plain(e.plate_velocity.value) + w * t;
    const Real root = sqrt(1 + t * t), k = plain(e.stiffness);
    const Real changes = k * abs(v) + abs(plain(e.force.rate)) + abs(plain(e.load.rate)) * F +
                         abs(plain(e.skin_stiffness) * v) +
                         abs(plain(e.skin_decay) * plain(s.skin)) + abs(plain(e.skin_drift)) +
                         abs(plain(e.damping_rate) * v);
    const Real left = load * F * (1 - abs(t) / root);
    return 1 / (changes / left + k * w * root * root * root / (load * F) + e.skin_rate() +
                abs(plain(across_.rate)) * k / (load * F) + sqrt(k / plain(e.mass)) / 64);
  }

  /// Sign of the first coefficient that is not zero.
  static int begins_with(const Curve<T>& across) {
    if (across.value != 0 || across.rate != 0)
      return (across.value != 0 ? across.value : across.rate) < 0 ? -1 : 1;
    for (const T& each : across.template coefficients<beginning_orders>())
      if (each != 0) return each < 0 ? -1 : 1;
    return 1;
  }

  int side_;
  Line<T> across_{T(0), T(0)};
  T ratio_{0};
};

/// Length of a first step of creep from a state, up to a limit, s; 0 for a pin that cannot creep.
template <class T>
Real<T> creep_span(const SeriesEquation<T>& e, const SeriesState<T>& start, T limit) {
  return CreepBalance<T>(e).span(e, start, plain(limit));
}

}  // namespace pindrive::detail
