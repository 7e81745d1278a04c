/// The differential equation of a mode that has no closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/flow/polynomial.hpp"

namespace pindrive {

/// The pin, and what is known of its skin: see SeriesEquation.
template <class T>
struct SeriesState {
  T x, v;     ///< m, m/s
  T skin{0};  ///< N, or m/s
  /// Of a pin that is not held, where it is known, so that a tangential departure is one exactly; m/s².
  T acceleration{std::numeric_limits<T>::quiet_NaN()};
  T time{0};  ///< s; its rounding is one of the inputs too
};

/// A mode without a closed form:
///
///     m x'' + b x' + k x = force + R − f y,   R = −λ (F d + S u),   u = x' − v_p,   (f y)' = K x' − D y − E,
///
/// where d is the sign of u or, with a velocity w across, u / √(u² + w²); u and w are then never both 0, and
/// b, λ and f are lines. y is the state of a compliant finger of stiffness K: its force (f = 1, D = E = 0) while
/// it sticks elastically; while it slips under a load λ_f on a branch F_c + S_c |y|, its sliding velocity
/// (f = S_c λ_f, D = K, E = ±F_c λ_f'), and its constant part is in `force`. Where f begins at 0, y begins at
/// its one value that stays finite. A pin that is held moves as the surface that holds it, and a stick force
/// makes up for what is missing.
template <class T>
struct SeriesEquation {
  T mass, damping, stiffness;          ///< the damping may be negative
  T damping_rate{0};                   ///< N s/m per s
  Line<T> force{T(0), T(0)};           ///< inertia and all that is given over time, N
  Line<T> plate_velocity{T(0), T(0)};  ///< v_p, m/s
  Line<T> load{T(1), T(0)};            ///< λ >= 0
  T plate_force{0};                    ///< F: the branch's friction force, continued to no speed, N
  T plate_slope{0};                    ///< S, N s/m
  int side{0};                         ///< the sign of u; 0: the plate slides across too
  Line<T> across{T(0), T(0)};          ///< w, m/s
  Line<T> skin_factor{T(0), T(0)};     ///< f: 1, or N s/m
  T skin_stiffness{0}, skin_decay{0};  ///< K and D, N/m
  T skin_drift{0};                     ///< E, N/s
  const T* stretching{nullptr};        ///< the orders of (f y)', where that is known, N/s
  bool held{false};                    ///< by a surface of this velocity, m/s
  Line<T> surface{T(0), T(0)};

  /// The same with time counted from τ on.
  SeriesEquation from(T tau) const {
    SeriesEquation later = *this;
    later.damping += damping_rate * tau;
    for (Line<T> SeriesEquation::* line :
         {&SeriesEquation::force, &SeriesEquation::plate_velocity, &SeriesEquation::load,
          &SeriesEquation::across, &SeriesEquation::skin_factor, &SeriesEquation::surface})
      (later.*line).value = (this->*line).at(tau);
    return later;
  }

  /// The order n + 1 of y from those of y and x' up to n or, where f begins at 0, the order n, in the time
  /// τ/step.
  template <class Coefficients>
  void follow(Coefficients& y, const Coefficients& v, int n, T step) const {
    const T turns = skin_factor.rate * T(n + 1);
    if (stretching != nullptr) {
      y[n] = (skin_stiffness * v[n] - (n == 0 ? skin_drift : T(0)) - stretching[n]) / skin_decay;
    } else if (skin_factor.value != 0) {
      const T stretches = skin_stiffness * v[n] - skin_decay * y[n] - (n == 0 ? skin_drift : T(0));
      y[n + 1] = step / T(n + 1) * (stretches - turns * y[n]) / skin_factor.value;
    } else if (skin_factor.rate != 0) {
      y[n] = (skin_stiffness * v[n] - (n == 0 ? skin_drift : T(0))) / (skin_decay + turns);
    }
  }
  /// The most that y is off over a step of length h, where f y is off by no more than `pull`, x' by `faster`
  /// and the equation of y by `missed`: f grows from 0 only.
  template <class Real>
  Real skin_error(Real h, Real pull, Real faster, Real missed) const {
    using std::abs;
    constexpr Real never = std::numeric_limits<Real>::infinity();
    if (skin_stiffness == 0) return Real(0);
    const Real f = plain(skin_factor.value), f_end = f + plain(skin_factor.rate) * h;
    const Real stays = plain(skin_decay) + plain(skin_factor.rate);
    const Real least = f * f_end > 0 ? std::min(abs(f), abs(f_end)) : Real(0);
    const Real by_force = least > 0 ? pull / least : never;
    // Where y is off by the most, either it turns or what pulls it back has not yet.
    const bool falls_back = plain(skin_decay) > 0 && stays > 0 && f >= 0 && f_end >= 0;
    const Real by_rate = falls_back ? (plain(skin_stiffness) * faster + missed) / stays : never;
    return std::min(by_force, by_rate);
  }
};

}  // namespace pindrive
