/// Differential equation of a mode without a closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/series_inputs.hpp"

namespace pindrive::detail {

/// State of the pin and its skin; see SeriesEquation.
template <class T>
struct SeriesState {
  T x, v;     ///< m, m/s
  T skin{0};  ///< N, or m/s
  /// Acceleration of a pin that is not held, if known, so that a tangential departure is exact;
  /// m/s².
  T acceleration{std::numeric_limits<T>::quiet_NaN()};
  T time{0};  ///< time, s; its rounding is part of the input error
};

/// Mode without a closed form:
///
///     m x'' + b x' + k x = force + R − g y,   R = −λ (F d + S u),   u = x' − v_p,
///     (f y)' = K x' + B x'' − D y − E,
///
/// where F also has a part that falls with the sliding speed, d is the sign of u or, with a transverse
/// velocity w, u / √(u² + w²); u and w are then never both 0, and f and g are linear in time. y is the state of a
/// compliant finger of stiffness K and damping B. In elastic stick, y is the tension by its stretch (f = g = 1,
/// D = E = 0), and b contains its damping in place of B. In slip under a load λ_f on
/// a branch F_c + S_c |y|, y is the slider velocity (g = S_c λ_f, f = g + B, D = K, E = ±F_c λ_f'), and its
/// constant part belongs to `force`. If f begins at 0, y begins at its only finite value. A pin
/// that is held moves with the surface that holds the pin, and a stick force balances the equation.
template <class T>
struct SeriesEquation {
  T mass, damping, stiffness;           ///< the damping may be negative
  T damping_rate{0};                    ///< N s/m per s
  Line<T> force{T(0), T(0)};            ///< tangent of the inertial and given forces, N
  Curve<T> pushes{T(0), T(0)};          ///< external part of the force
  Curve<T> plate_velocity{T(0), T(0)};  ///< v_p, m/s
  Curve<T> load{T(1), T(0)};            ///< λ >= 0
  T plate_force{0};                     ///< F: friction of the branch extrapolated to zero speed, N
  T plate_slope{0};                     ///< S, N s/m
  FallingFriction<T> plate_falling{};   ///< part of F
  int side{0};                          ///< sign of u; 0: oblique slip
  Curve<T> across{T(0), T(0)};          ///< w, m/s
  Line<T> skin_factor{T(0), T(0)};      ///< f: 1, or N s/m
  Line<T> skin_pull{T(0), T(0)};        ///< g: 1, or N s/m
  T skin_damping{0};                    ///< B, N s/m
  T skin_stiffness{0}, skin_decay{0};   ///< K and D, N/m
  T skin_drift{0};                      ///< E, N/s
  FallingFriction<T> finger_falling{};  ///< of a rigid finger, beside `force` and `damping`
  int finger_side{0};                   ///< sign of x' at that finger
  Curve<T> finger_load{T(1), T(0)};     ///< its load factor
  T finger_force{0}, finger_slope{0};   ///< friction at that finger in `force`, N, and in `damping`
  const T* stretching{nullptr};         ///< Taylor coefficients of (f y − B x')' if known, N/s
  bool held{false};                     ///< true if a surface of this velocity holds the pin, m/s
  Curve<T> surface{T(0), T(0)};

  /// Equation with time counted from τ on.
  SeriesEquation from(T tau) const {
    SeriesEquation later = *this;
    later.damping += damping_rate * tau;
    for (Line<T> SeriesEquation::* line :
         {&SeriesEquation::force, &SeriesEquation::skin_factor, &SeriesEquation::skin_pull})
      (later.*line).value = (this->*line).at(tau);
    for (Curve<T> SeriesEquation::* input :
         {&SeriesEquation::pushes, &SeriesEquation::plate_velocity, &SeriesEquation::load,
          &SeriesEquation::across, &SeriesEquation::surface, &SeriesEquation::finger_load})
      later.*input = (this->*input).from(tau);
    return later;
  }

  /// Damping of the pin by the part of y that follows its velocity, N s/m.
  T skin_drag() const {
    return skin_damping == 0 ? T(0) : skin_pull.value * skin_damping / skin_factor.value;
  }

  /// Rate at which y decays to the stretching of the skin, 1/s.
  Real<T> skin_rate() const {
    const Real<T> f = plain(skin_factor.value);
    return f != 0 ? std::abs(plain(skin_decay) / f) : Real<T>(0);
  }

  /// Time over which the terms of the inputs beyond the last order stay within rounding, s.
  Real<T> input_reach() const {
    Real<T> least = std::numeric_limits<Real<T>>::infinity();
    for (const Curve<T>* input : {&pushes, &plate_velocity, &load, &across, &finger_load, &surface})
      if (!input->straight())
        least = std::min(least, input->reach(T(0), series_order, longest_input));
    return least;
  }

  /// Computes order n + 1 of y, without the part of B, from the orders of y and x' up to n or, if f begins at 0, order
  /// n; in the time τ/step, with order n of E.
  template <class Coefficients>
  void follow(Coefficients& y, const Coefficients& v, int n, T step, T drift) const {
    const T turns = skin_factor.rate * T(n + 1);
    if (stretching != nullptr) {
      y[n] = (skin_stiffness * v[n] - drift - stretching[n]) / skin_decay;
    } else if (skin_factor.value != 0) {
      const T stretches = skin_stiffness * v[n] - skin_decay * y[n] - drift;
      y[n + 1] = step / T(n + 1) * (stretches - turns * y[n]) / skin_factor.value;
    } else if (skin_factor.rate != 0) {
      y[n] = (skin_stiffness * v[n] - drift) / (skin_decay + turns);
    }
  }
  /// Adds the part of B to order n >= 1 of y, once that of x' is known.
  template <class Coefficients>
  void damp(Coefficients& y, const Coefficients& v, int n) const {
    if (skin_damping != 0 && stretching == nullptr) y[n] += skin_damping * v[n] / skin_factor.value;
  }
  /// Error bound of y over a step of length h, from the errors of f y − B x' (`pull`), of x' (`faster`)
  /// and the residual of the equation of y (`missed`); f may grow from 0 only.
  template <class Real>
  Real skin_error(Real h, Real pull, Real faster, Real missed) const {
    constexpr Real never = std::numeric_limits<Real>::infinity();
    if (skin_stiffness == 0) return Real(0);
    const Real f = plain(skin_factor.value), f_end = f + plain(skin_factor.rate) * h;
    const Real stays = plain(skin_decay) + plain(skin_factor.rate);
    const Real least = f * f_end > 0 ? std::min(abs(f), abs(f_end)) : Real(0);
    const Real B = plain(skin_damping);
    const Real by_force = least > 0 ? (pull + B * faster) / least : never;
    if (B > 0) return by_force;
    // At its largest error y turns, or its restoring term is still growing.
    const bool falls_back = plain(skin_decay) > 0 && stays > 0 && f >= 0 && f_end >= 0;
    const Real by_rate = falls_back ? (plain(skin_stiffness) * faster + missed) / stays : never;
    return std::min(by_force, by_rate);
  }
};

}  // namespace pindrive::detail
