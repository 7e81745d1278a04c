/// Closed form of one mode: between two events the pin follows a damped sinusoid plus a line.
///
/// Every mode obeys  m x'' + c x' + κ x = f + g τ  with constant coefficients, so
///
///     x(τ) = x₀ + y (Φ(τ) − 1) + y' Ψ(τ) + p τ,
///
/// where y and y' are value and slope of the free oscillation at τ = 0, p is the slope of the line,
/// and Φ, Ψ are the responses of the free oscillator to a unit displacement and a unit velocity.
/// Each derivative of x has this form too. Written as a change from the start, a quantity that is
/// set exactly at an event (a velocity equal to that of a surface) stays exact there.
#pragma once

#include <cmath>

#include "pindrive/flow/oscillator.hpp"
#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/inlining.hpp"

namespace pindrive {

/// Quantity along a mode: start + value·(Φ − 1) + slope·Ψ + drift·τ + curvature·τ²/2.
template <class T>
struct Path {
  T start;         ///< value at τ = 0
  T value;         ///< value of the oscillating part at τ = 0
  T slope;         ///< derivative of the oscillating part at τ = 0
  T drift{0};      ///< slope of the line
  T curvature{0};  ///< second derivative, of a pin stuck to an accelerating plate

  /// Change since τ = 0.
  T change(const Propagator<T>& moved) const {
    const T tau = moved.tau;
    return value * moved.decline + slope * moved.gain + (drift + curvature * tau / 2) * tau;
  }
  T change(const Oscillator<T>& oscillator, T tau) const {
    return change(oscillates() ? oscillator.after(tau) : Propagator<T>::still(tau));
  }
  T at(const Propagator<T>& moved) const { return start + change(moved); }
  T at(const Oscillator<T>& oscillator, T tau) const { return start + change(oscillator, tau); }

  Path derivative(const Oscillator<T>& oscillator) const {
    return {slope + drift, slope, oscillator.bend(value, slope), curvature, T(0)};
  }
  struct Rates {
    T first, second, third;
  };
  /// First three derivatives at a propagator.
  Rates rates(const Oscillator<T>& oscillator, const Propagator<T>& moved) const {
    const T wave = value + value * moved.decline + slope * moved.gain;
    const T rate = slope + slope * moved.decline + oscillator.bend(value, slope) * moved.gain;
    const T bend = oscillator.bend(wave, rate);
    return {rate + drift + curvature * moved.tau, bend + curvature, oscillator.bend(rate, bend)};
  }
  /// Path with its time counted from τ on.
  Path from(const Oscillator<T>& oscillator, T tau) const {
    const Propagator<T> moved = oscillator.after(tau);
    const T wave = value + value * moved.decline + slope * moved.gain;
    const T bend = oscillator.bend(value, slope);
    return {at(moved), wave, slope + slope * moved.decline + bend * moved.gain,
            drift + curvature * tau, curvature};
  }
  bool oscillates() const { return value != 0 || slope != 0; }
  bool straight() const { return drift == 0 && curvature == 0; }
  bool constant() const { return straight() && !oscillates(); }

  /// Centre of oscillation of a straight path; its limit if it decays.
  T centre() const { return start - value; }

  friend Path operator+(const Path& p, const Path& q) {
    return {p.start + q.start, p.value + q.value, p.slope + q.slope, p.drift + q.drift,
            p.curvature + q.curvature};
  }
  friend Path operator*(T factor, const Path& p) {
    return {factor * p.start, factor * p.value, factor * p.slope, factor * p.drift,
            factor * p.curvature};
  }
};

/// Linear function of time.
template <class T>
struct Line {
  T value{0}, rate{0};

  T at(T tau) const { return value + rate * tau; }
  operator Path<T>() const { return {value, T(0), T(0), rate, T(0)}; }
};

/// Position and velocity in one mode as functions of the time τ since its begin.
template <class T>
struct Flow {
  Oscillator<T> oscillator;
  Path<T> position, velocity;

  /// Flow of a free pin from x, v, at y from an equilibrium that drifts. The acceleration at τ = 0
  /// is given, so that an exactly tangential start is represented.
  static Flow free(const Oscillator<T>& oscillator, T x, T v, T acceleration, T y, T drift) {
    const T y_rate = v - drift;
    return {oscillator, {x, y, y_rate, drift}, {v, y_rate, acceleration}};
  }
  /// Flow of a pin stuck to a surface with the given velocity.
  static Flow stuck(T x, Line<T> velocity) {
    return {{}, {x, T(0), T(0), velocity.value, velocity.rate}, velocity};
  }

  Path<T> acceleration() const { return velocity.derivative(oscillator); }

  /// Propagator after τ; a stuck pin does not oscillate.
  Propagator<T> after(T tau) const {
    return velocity.oscillates() ? oscillator.after(tau) : Propagator<T>::still(tau);
  }

  /// Amplitude about the centre if the oscillation were undamped from now on, m.
  T amplitude() const {
    using detail::hypot;
    const T y = position.value;
    return hypot(y, (position.slope - oscillator.alpha() * y) / oscillator.omega());
  }
};

namespace detail {
/// True if a number and its derivatives are zero.
template <class T>
bool vanishes(T number) {
  return number == 0;
}
}  // namespace detail

/// Force on the pin in one mode: constant − drag x' − stiffness (x − x₀), N.
template <class T>
struct Force {
  Line<T> constant{};
  T drag{0}, stiffness{0};
  T rounding{0};  ///< error of the drag, N s/m

  PINDRIVE_INLINE Path<T> along(const Flow<T>& flow) const {
    using detail::vanishes;
    Path<T> path = constant;
    if (!vanishes(drag)) path = path + (-drag) * flow.velocity;
    Path<T> moved = flow.position;
    moved.start = T(0);
    if (!vanishes(stiffness)) path = path + (-stiffness) * moved;
    return path;
  }
};

}  // namespace pindrive
