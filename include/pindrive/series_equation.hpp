/// The differential equation of a mode that has no closed form, and how a pin sets out from a plate that
/// begins to slide across.
#pragma once

#include <cmath>
#include <limits>

#include "pindrive/polynomial.hpp"

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
///     m x'' + b x' + k x = force + R − f y,   R = −λ (F d + S u),   u = x' − v_p,   y' = g x' − h y,
///
/// where d is the sign of u or, with a velocity w across, u / √(u² + w²); u and w are then never both 0.
/// y is the state of a compliant finger of stiffness K: its force (f = 1, g = K, h = 0) while it sticks
/// elastically; while it slips on a sloped branch, kinetic friction F_c + S_c (|y| − from), its sliding
/// velocity (f = S_c, g = h = K/S_c), and its constant part is in `force`. A pin that is held moves as the
/// surface that holds it, and a stick force makes up for what is missing.
template <class T>
struct SeriesEquation {
  T mass, damping, stiffness;          ///< the damping may be negative
  Line<T> force{T(0), T(0)};           ///< inertia and all that is given over time, N
  Line<T> plate_velocity{T(0), T(0)};  ///< v_p, m/s
  Line<T> load{T(1), T(0)};            ///< λ >= 0
  T plate_force{0};                    ///< F: the branch's friction force, continued to no speed, N
  T plate_slope{0};                    ///< S, N s/m
  int side{0};                         ///< the sign of u; 0: the plate slides across too
  Line<T> across{T(0), T(0)};          ///< w, m/s
  T skin_factor{0};                    ///< f: 1, or N s/m
  T skin_gain{0}, skin_decay{0};       ///< g: N/m, or 1/s; h: 1/s
  bool held{false};                    ///< by a surface of this velocity, m/s
  Line<T> surface{T(0), T(0)};

  /// The same with time counted from τ on.
  SeriesEquation from(T tau) const {
    SeriesEquation later = *this;
    for (Line<T> SeriesEquation::* line :
         {&SeriesEquation::force, &SeriesEquation::plate_velocity, &SeriesEquation::load,
          &SeriesEquation::across, &SeriesEquation::surface})
      (later.*line).value = (this->*line).at(tau);
    return later;
  }
};

/// The relative acceleration p with which a pin of mass m sets out from a plate that begins to slide across
/// with the acceleration w': m p + λF p/√(p² + w'²) = what else pulls, N. It grows with the pull: one root.
template <class T>
T setting_out(T mass, T friction, T across_rate, T pull) {
  using std::abs;
  using std::sqrt;
  const T w = abs(across_rate);
  // In t = p/w', from above in size: there the left side bends away from its tangent.
  T t = pull / (mass * w);
  bool converged = false;  // the derivative of a dual number does so one round later
  for (int tries = 0; tries < 200; ++tries) {
    const T root = sqrt(1 + t * t);
    const T missed = mass * w * t + friction * t / root - pull;
    const T move = -missed / (mass * w + friction / (root * root * root));
    const T next = t + move;
    // What falls beyond zero has overshot.
    const T kept = next * t < 0 ? t / 64 : next;
    const bool done = converged;
    converged = abs(kept - t) <= 2 * std::numeric_limits<detail::Real<T>>::epsilon() * abs(t);
    t = kept;
    if (done) break;
  }
  return t * w;
}

}  // namespace pindrive
