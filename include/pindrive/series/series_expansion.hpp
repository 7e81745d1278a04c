/// Expansion of a series: orders of the given forces and of friction, length and order of the step.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/falling_series.hpp"
#include "pindrive/series/series_equation.hpp"
#include "pindrive/series/series_inputs.hpp"
#include "pindrive/series/series_step.hpp"

namespace pindrive::detail {

/// Step while its series is expanded, with all that the recurrences need.
template <class T>
class SeriesExpansion : public SeriesStep<T> {
 public:
  using typename SeriesStep<T>::Real;
  using SeriesStep<T>::position, SeriesStep<T>::velocity, SeriesStep<T>::skin, SeriesStep<T>::speed;
  using SeriesStep<T>::plate_force, SeriesStep<T>::stick_force;
  using SeriesStep<T>::x_bound, SeriesStep<T>::v_bound, SeriesStep<T>::skin_bound;
  using SeriesStep<T>::speed_bound;

 protected:
  static constexpr int N = series_order;

  /// Sets all polynomials to order N over a length of time, and expands the inputs.
  void begin(const SeriesEquation<T>& e, Real step) {
    pushes_ = {e.pushes, step};
    plate_velocity_ = {e.plate_velocity, step};
    load_ = {e.load, step};
    across_ = {e.across, step};
    finger_load_ = {e.finger_load, step};
    surface_ = {e.surface, step};
    each([&](Polynomial<T>& p) {
      p.span = step;
      p.degree = N;
    });
    position.degree = N + 1;
    for (Polynomial<T>& p : inner_) p.degree = e.side == 0 ? N : 0;
    if (!e.held) stick_force.degree = 0;
    if (e.skin_stiffness == 0) skin.degree = 0;
    falling_plate_.begin(e.plate_falling, step);
    falling_finger_.begin(e.finger_falling, step);
  }

  /// Part of the step at which the last terms are within the rounding of the first terms.
  Real suggested_part() const {
    constexpr Real never = std::numeric_limits<Real>::infinity();
    // Least ratio of the rounding to the last terms, from order N − 2 on.
    std::array<Real, 3> ratios{never, never, never};
    for (const Polynomial<T>* p : {&velocity, &skin, &speed}) {
      const auto size = [&](int n) { return abs(plain(p->c[n])); };
      const Real error = truncation_error<Real> * std::max({size(0), size(1), size(2)});
      for (int i = 0; i < 3 && error > 0; ++i)
        if (size(N - 2 + i) > 0) ratios[i] = std::min(ratios[i], error / size(N - 2 + i));
    }
    Real least = never;
    for (int i = 0; i < 3; ++i)
      if (ratios[i] < never) least = std::min(least, log(ratios[i]) / (N - 2 + i));
    return least < never ? exp(least) : never;
  }

  void rescale(Real part) {
    const Powers<Real> powers = powers_of(part);
    each([&](Polynomial<T>& p) { p.rescale(powers); });
    falling_plate_.rescale(powers);
    falling_finger_.rescale(powers);
    for (InputSeries<T>* input :
         {&pushes_, &plate_velocity_, &load_, &across_, &finger_load_, &surface_})
      input->rescale(powers);
  }

  /// Order n of the inertial and given forces, N.
  T given_force(const SeriesEquation<T>& e, int n, Real step) const {
    if (n == 0) return e.force.value;
    if (n == 1) return e.force.rate * step;
    return pushes_[n] + e.mass * plate_velocity_.rate(n) - e.finger_force * finger_load_[n];
  }
  /// Order n + 1 of the state of the skin, without the part of its damping.
  template <class Coefficients>
  void follow_skin(const SeriesEquation<T>& e, Coefficients& y, const Coefficients& v, int n,
                   Real step) const {
    T drift = n == 0 ? e.skin_drift : T(0);
    if (e.skin_decay != 0 && !e.finger_load.straight())
      drift = e.finger_force * finger_load_.rate(n);
    e.follow(y, v, n, T(step), drift);
  }
  /// Order n of the forces of the damper and of the slope of friction at a rigid finger, N.
  T damper_force(const SeriesEquation<T>& e, int n, Real step) const {
    T force = e.damping * velocity.c[n];
    if (e.damping_rate != 0 && n > 0) force += step * e.damping_rate * velocity.c[n - 1];
    return force + bent_damper_force(e, n);
  }
  /// Part by a load of the finger beyond its tangent, N.
  T bent_damper_force(const SeriesEquation<T>& e, int n) const {
    if (e.finger_load.straight()) return T(0);
    return e.finger_slope * finger_load_.times(velocity.c, n, 2);
  }
  /// Order n of the falling friction of a rigid finger, in the direction of x', N.
  T falling_finger_force(const SeriesEquation<T>& e, int n) {
    const T side = T(e.finger_side);
    falling_finger_.extend(e.finger_falling, velocity.c, side, n);
    return side * finger_load_.times(falling_finger_.friction().c, n);
  }
  /// Bound of the change of the damping by that load, N s/m.
  Real bent_damping(const SeriesEquation<T>& e) const {
    return std::abs(plain(e.finger_slope)) * finger_load_.bend();
  }
  /// Bound of the residual from the terms of the inputs beyond the last order, N.
  Real missed_inputs(const SeriesEquation<T>& e) const {
    Real missed = pushes_.missed() + plain(e.mass) * plate_velocity_.missed_rate();
    missed += std::abs(plain(e.finger_force)) * finger_load_.missed();
    if (!e.finger_load.straight()) {
      const Sums v = sums_of(velocity.c);
      missed += std::abs(plain(e.finger_slope)) * finger_load_.beyond(v);
    }
    return missed;
  }

  /// Bound of the load beyond its tangent in the equation of the skin, N/s.
  Real missed_drift(const SeriesEquation<T>& e) const {
    return e.skin_decay == 0 ? Real(0)
                             : std::abs(plain(e.finger_force)) * finger_load_.missed_rate();
  }

  using Sums = detail::Sums<Real>;
  /// Sum of the absolute coefficients over a part of the step.
  static Real size_of(const Polynomial<T>& p, Real part) {
    Real sum{0}, power{1};
    for (int n = 0; n <= N; ++n, power *= part) sum += std::abs(plain(p.c[n])) * power;
    return sum;
  }

  /// Removes the last terms that are within rounding of the sums that they enter: for velocity and
  /// skin, within rounding of their rates.
  void trim() {
    int needed = 1;
    Real dropped{0};
    for (const Polynomial<T>* p : {&velocity, &skin, &speed, &plate_force, &stick_force}) {
      const bool by_rate = p == &velocity || p == &skin;
      const auto size = [&](int n) { return abs(plain(p->c[n])) * (by_rate ? n : 1); };
      Real total{0}, tail{0};
      for (int n = 0; n <= p->degree; ++n) total += size(n);
      int n = std::min(p->degree, N);
      while (n > needed && tail + size(n) <= removed_terms<Real> * total) tail += size(n--);
      needed = std::max(needed, n);
    }
    const auto drop = [&](Polynomial<T>& p, int degree, Real& bound) {
      for (dropped = 0; p.degree > degree; --p.degree) {
        dropped += abs(plain(p.c[p.degree]));
        p.c[p.degree] = T(0);
      }
      bound += dropped;
    };
    Real unused{0};
    drop(position, needed + 1, x_bound);
    drop(velocity, needed, v_bound);
    drop(skin, needed, skin_bound);
    drop(speed, needed, speed_bound);
    drop(plate_force, needed, unused);
    drop(stick_force, needed, unused);
    if (falling_finger_.friction().degree > 0) this->falling_at_finger = falling_finger_.friction();
  }

  /// Falling parts of the friction at a load factor of 1, without their direction.
  FallingSeries<T> falling_plate_, falling_finger_;
  std::array<Polynomial<T>, 3> inner_;  // auxiliary series of the recurrences
  InputSeries<T> pushes_, plate_velocity_, load_, across_, finger_load_, surface_;

 private:
  template <class Visitor>
  void each(Visitor&& visit) {
    for (Polynomial<T>* p : {&position, &velocity, &skin, &plate_force, &stick_force, &speed})
      visit(*p);
    for (Polynomial<T>& p : inner_) visit(p);
  }
};

}  // namespace pindrive::detail
