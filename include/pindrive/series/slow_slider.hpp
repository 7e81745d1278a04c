/// Slow motion of a slider on stiff skin.
///
/// The slider velocity y reaches its stationary value within a time ε = φ/D. For short ε a Taylor
/// series of the whole motion would need steps of a few ε. The slow motion without this fast
/// transient solves
///
///     D y = K v − E − (φ y − B v)',
///
/// in which (φ y − B v)' comes from the series of the preceding iteration, and the remaining residual is
/// bounded.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/series.hpp"
#include "pindrive/series/slow_step.hpp"

namespace pindrive::detail {

/// Step of a pin on a slow slider; valid if the slider has the velocity of the slow motion within
/// rounding.
template <class T>
class SlowSliderFlow : public SlowStep<T, SeriesFlow<T>> {
 public:
  using typename SeriesExpansion<T>::Real;
  using SeriesExpansion<T>::position, SeriesExpansion<T>::velocity, SeriesExpansion<T>::skin,
      SeriesExpansion<T>::speed;
  using SeriesExpansion<T>::x_bound, SeriesExpansion<T>::v_bound, SeriesExpansion<T>::skin_bound;
  using SeriesExpansion<T>::speed_bound, SeriesExpansion<T>::span;

  /// True if the fast transient is so much faster than the remaining motion that the iteration
  /// converges quickly.
  static bool stiff(const SeriesEquation<T>& e, const SeriesState<T>& start) {
    const Real decay = plain(e.skin_decay), f = plain(e.skin_factor.value);
    return f > 0 && decay > 4 * N * std::abs(plain(e.skin_factor.rate)) &&
           decay > 4 * N * f * slow_rate(e, start);
  }

  /// Expands the series at a state, up to a limit (s; may be infinite); `within_step`: the limit is
  /// known to lie within one step.
  SlowSliderFlow(SeriesEquation<T> e, const SeriesState<T>& start, T limit,
                 bool within_step = false) {
    this->eliminated = EliminatedPart::of_slider;
    const Real step = std::min(1 / slow_rate(e, start), e.input_reach());
    const Real left = plain(limit) / step;
    e.stretching = small_.data();
    Real part{1};
    const auto iteration = [&] {
      this->expand(e, start, step);
      follow(e, step);
    };
    const auto allowed = [&](Real used) {
      return last_digit<Real> * plain(e.skin_decay) * this->size_of(skin, used);
    };
    if (!this->iterate(within_step, left, e.input_reach() / step, Real(1), part, iteration,
                       allowed))
      return;
    this->rescale(part);
    if (!within_step && !starts_from(start)) return;
    this->hold(within_step, part,
               [&](Real used) { return bound(e, start.time, this->last_change(used)); });
  }

 private:
  using SlowStep<T, SeriesFlow<T>>::small_;
  using SeriesExpansion<T>::N, SeriesExpansion<T>::load_;
  using typename SeriesExpansion<T>::Sums;

  /// Estimate of the fastest rate of the slow motion, 1/s; the skin acts as a damper φ.
  static Real slow_rate(const SeriesEquation<T>& e, const SeriesState<T>& start) {
    const Real m = plain(e.mass), f = plain(e.skin_factor.value);
    return (abs(plain(e.damping)) + abs(plain(e.load.value) * plain(e.plate_slope)) + f) / m +
           sqrt((plain(e.stiffness) + abs(plain(e.skin_factor.rate)) + abs(plain(e.damping_rate)) +
                 abs(plain(e.load.rate) * plain(e.plate_slope))) /
                m) +
           SeriesFlow<T>::turning_rate(e, start);
  }

  /// Sets (φ y − B v)' from the series.
  void follow(const SeriesEquation<T>& e, Real step) {
    for (int n = 0; n <= N; ++n) {
      const T next =
          n < N ? e.skin_factor.value * skin.c[n + 1] - e.skin_damping * velocity.c[n + 1] : T(0);
      const T grows = next / T(step);
      this->set_small(n, T(n + 1) * (grows + e.skin_factor.rate * skin.c[n]));
    }
  }
  /// Bounds the truncation errors; true if within rounding. The error of y is at most the restoring
  /// effect of the velocity error and of the residual of its equation, and conversely.
  bool bound(const SeriesEquation<T>& e, T time, Real missed_skin) {
    using std::max;
    using std::min;
    const Real h = span(), m = plain(e.mass), k = plain(e.stiffness), b = plain(e.damping);
    const Real b_change = plain(e.damping_rate) * h, f = plain(e.skin_factor.value);
    const Real f_change = plain(e.skin_factor.rate) * h, g = plain(e.skin_pull.value);
    const Real most_g = max(g, g + f_change);
    const Real S = plain(e.plate_slope), most_load = load_.most();
    const Real load_change = load_.change(), K = plain(e.skin_stiffness);
    const auto last = [](const Polynomial<T>& p, int n) { return abs(plain(p.c[n])); };
    const auto turning = this->bound_turning(e);
    if (!turning.known || (e.held && turning.direction > direction_error<Real>)) return false;
    const Real missed =
        e.held ? Real(0)
               : (max(abs(b), abs(b + b_change)) + most_load * abs(S)) * last(velocity, N) +
                     (abs(b_change) + abs(load_change * S)) * last(velocity, N - 1) +
                     k * (last(position, N) + last(position, N + 1)) + most_g * last(skin, N) +
                     abs(f_change) * last(skin, N - 1) + turning.missed + this->missed_inputs(e);
    missed_skin += this->missed_drift(e);
    const Real stays = plain(e.skin_decay) + plain(e.skin_factor.rate);
    const Real falls =
        min(b, b + b_change) + min(Real(0), S * most_load) - most_load * turning.falling.slope;
    const Real grown = h / m * (k * h + most_g * K / stays + max(Real(0), -falls));
    // May end with its load, within the time resolution.
    const Real ends =
        f + f_change + rounding<Real> * (plain(time) + h) * abs(plain(e.skin_factor.rate));
    if (!(ends >= 0) || (!e.held && grown > Real(0.5))) return false;
    v_bound = e.held ? Real(0) : 2 * h / m * (missed + most_g * missed_skin / stays);
    x_bound = h * v_bound;
    skin_bound = (K * v_bound + missed_skin) / stays;
    speed_bound = v_bound + turning.root;
    // rounding: tests/hard/nearly-flat-curve-on-stiff-skin.txt, and
    // step-with-change-of-acceleration-alone.txt for the turning direction
    return v_bound <= rounding<Real> * sums_of(velocity.c)[0] &&
           turning.root <= rounding<Real> * sums_of(speed.c)[0] &&
           skin_bound <= eliminated_error<Real> * sums_of(skin.c)[0];
  }

  /// True if the slider starts with the slow velocity: a deviation decays at once.
  bool starts_from(const SeriesState<T>& start) const {
    const Real changes = abs(plain(velocity.c[1])) / span() + abs(plain(skin.c[1])) / span();
    return abs(plain(start.skin - skin.c[0])) <= difference_error<Real> * sums_of(skin.c)[0] +
                                                     rounding<Real> * plain(start.time) * changes;
  }
};

/// Returns a step of a pin on a slow slider; none if the slider has a fast transient.
template <class T>
std::optional<SlowSliderFlow<T>> slow_slider(const SeriesEquation<T>& e,
                                             const SeriesState<T>& start, T limit,
                                             bool within_step = false) {
  if (!SlowSliderFlow<T>::stiff(e, start)) return {};
  return valid_step<SlowSliderFlow<T>>(e, start, limit, within_step);
}

}  // namespace pindrive::detail
