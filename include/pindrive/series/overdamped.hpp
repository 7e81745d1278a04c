/// Slow motion of a pin whose damping is strong.
///
/// Inertia delays the velocity by m/B, where B is the damping of damper and contacts. For short m/B a Taylor series
/// of the whole motion would need steps of a few m/B. The slow motion without this fast transient solves
///
///     B v = force − λ F d − k x − f y − m a,   v = x', a = v',
///
/// in which a comes from the series of the preceding iteration (slow_step.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/slow_step.hpp"

namespace pindrive::detail {

/// Step of an overdamped pin under constant damping; valid if the pin has the velocity of the slow motion within
/// rounding.
template <class T>
class OverdampedFlow : public SlowStep<T> {
 public:
  using typename SeriesExpansion<T>::Real;
  using SeriesExpansion<T>::position, SeriesExpansion<T>::velocity, SeriesExpansion<T>::skin,
      SeriesExpansion<T>::speed;
  using SeriesExpansion<T>::plate_force, SeriesExpansion<T>::span;
  using SeriesExpansion<T>::x_bound, SeriesExpansion<T>::v_bound, SeriesExpansion<T>::skin_bound;
  using SeriesExpansion<T>::speed_bound;

  /// True if the fast transient is so much faster than the remaining motion that the iteration converges quickly.
  static bool stiff(const SeriesEquation<T>& e) {
    const bool constant_damping = e.damping_rate == 0 && (e.plate_slope == 0 || e.load.steady()) &&
                                  (e.finger_slope == 0 || e.finger_load.steady());
    const bool linear = !e.plate_falling.present() && !e.finger_falling.present() &&
                        (e.skin_stiffness == 0 || (e.skin_factor.rate == 0 && e.skin_decay == 0));
    return !e.held && e.side != 0 && constant_damping && linear &&
           plain(damping(e)) > 4 * N * plain(e.mass) * slow_rate(e);
  }

  /// Expands the series at a state, up to a limit (s; may be infinite); `within_step`: the limit is known to lie
  /// within one step.
  OverdampedFlow(const SeriesEquation<T>& e, const SeriesState<T>& start, T limit,
                 bool within_step = false) {
    this->eliminated = EliminatedPart::of_inertia;
    const Real step = std::min({1 / slow_rate(e), e.input_reach(), plain(limit)});
    const Real left = plain(limit) / step;
    this->set_small(0, e.plate_velocity.rate);
    this->begin(e, step);
    Real part{1};
    const auto allowed = [&](Real used) {
      return last_digit<Real> * plain(damping(e)) * this->size_of(velocity, used);
    };
    if (!this->iterate(
            within_step, left, e.input_reach() / step, plain(e.mass), part,
            [&] { expand(e, start, step); }, allowed))
      return;
    this->rescale(part);
    if (!within_step && !starts_from(e, start)) return;
    this->hold(within_step, part,
               [&](Real used) { return bound(e, plain(e.mass) * last_change(used)); });
  }

 private:
  using SlowStep<T>::last_change, SlowStep<T>::small_;
  using SeriesExpansion<T>::N, SeriesExpansion<T>::load_, SeriesExpansion<T>::plate_velocity_;
  using typename SeriesExpansion<T>::Sums;

  static T damping(const SeriesEquation<T>& e) { return e.damping + e.load.value * e.plate_slope; }
  /// Estimate of the fastest rate of the slow motion, 1/s.
  static Real slow_rate(const SeriesEquation<T>& e) {
    return (plain(e.stiffness) + plain(e.skin_stiffness)) / plain(damping(e)) +
           1 / e.input_reach() + std::numeric_limits<Real>::min();
  }

  /// One iteration in the time σ = τ/step: the series of the velocity from that of a, and from it a new a.
  void expand(const SeriesEquation<T>& e, const SeriesState<T>& start, Real step) {
    auto &x = position.c, &v = velocity.c, &y = skin.c;
    const T side = T(e.side), slope = e.load.value * e.plate_slope;
    x[0] = start.x;
    y[0] = start.skin;
    for (int n = 0; n <= N; ++n) {
      const T friction = e.plate_force * side * load_[n] - slope * plate_velocity_[n];
      v[n] = (this->given_force(e, n, step) - friction - e.stiffness * x[n] -
              e.skin_pull.value * y[n] - e.mass * small_[n]) /
             damping(e);
      plate_force.c[n] = -friction - slope * v[n];
      speed.c[n] = side * (v[n] - plate_velocity_[n]);
      x[n + 1] = T(step) / T(n + 1) * v[n];
      this->follow_skin(e, y, v, n, step);
    }
    this->take_acceleration(step, N);
  }

  /// Bounds the truncation error; true if within rounding. The error of the velocity decreases where damping times
  /// the error exceeds the residual plus the forces from the errors of position and skin.
  bool bound(const SeriesEquation<T>& e, Real missed) {
    const Real h = span(), k = plain(e.stiffness), K = plain(e.skin_stiffness);
    const auto last = [](const Polynomial<T>& p, int n) { return abs(plain(p.c[n])); };
    const Real slope = abs(plain(e.load.value * e.plate_slope));
    missed += plain(damping(e)) * last(velocity, N) +
              k * (last(position, N) + last(position, N + 1)) + last(skin, N) +
              abs(plain(e.plate_force)) * load_.missed() + slope * plate_velocity_.missed() +
              this->missed_inputs(e);
    const Real left = plain(damping(e)) - (k + K) * h;
    if (!(left > 0)) return false;
    v_bound = (missed + K * h * last(velocity, N)) / left;
    x_bound = h * v_bound;
    skin_bound = K * x_bound;
    speed_bound = v_bound + plate_velocity_.missed();
    return v_bound <= eliminated_error<Real> * sums_of(velocity.c)[0];
  }

  /// True if the pin has the velocity of the slow motion: a deviation within rounding decays at once.
  bool starts_from(const SeriesEquation<T>& e, const SeriesState<T>& start) const {
    const Real forces = abs(plain(e.force.value)) + abs(plain(e.load.value * e.plate_force)) +
                        plain(e.stiffness) * abs(plain(start.x)) +
                        abs(plain(e.skin_pull.value) * plain(start.skin));
    const Real changes = abs(plain(velocity.c[1])) / span();
    return abs(plain(start.v - velocity.c[0])) <=
           difference_error<Real> *
                   (sums_of(velocity.c)[0] + abs(plain(start.v)) + forces / plain(damping(e))) +
               rounding<Real> * plain(start.time) * changes;
  }
};

/// Returns a step of an overdamped pin; none if the pin has a fast transient.
template <class T>
std::optional<OverdampedFlow<T>> overdamped(const SeriesEquation<T>& e, const SeriesState<T>& start,
                                            T limit, bool within_step = false) {
  if (!OverdampedFlow<T>::stiff(e)) return {};
  return valid_step<OverdampedFlow<T>>(e, start, limit, within_step);
}

}  // namespace pindrive::detail
