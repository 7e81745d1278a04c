/// Free oscillator of a mode: propagator and zeros in every damping regime (docs/theory.md, section 9).
#pragma once

#include <cmath>
#include <limits>

#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

/// Response of the free oscillator after a time τ.
template <class T>
struct Propagator {
  T decline;  ///< Φ(τ) − 1: change of a unit displacement; dimensionless
  T gain;     ///< Ψ(τ): response to a unit velocity, s
  T tau;      ///< s

  /// Propagator of a path that does not oscillate.
  static Propagator still(T tau) { return {T(0), T(0), tau}; }
};

/// Zeros of a free oscillation at τ > 0: first, first + spacing, …; infinite if there are none.
template <class T>
struct Zeros {
  T first;
  T spacing;

  T at(T index) const { return index == 0 ? first : first + index * spacing; }
};

/// Free oscillator  y'' = 2α y' − ω₀² y  of a mode, in every damping regime.
template <class T>
class Oscillator {
 public:
  /// y'' = −y
  Oscillator() = default;

  /// m x'' + c x' + κ x; mass and stiffness > 0, damping of either sign.
  Oscillator(T mass, T damping, T stiffness)
      : alpha_(-damping / (2 * mass)), omega0_squared_(stiffness / mass) {
    using std::abs;
    using std::sqrt;
    const T omega0 = sqrt(omega0_squared_);
    discriminant_ = (omega0 - abs(alpha_)) * (omega0 + abs(alpha_));
    omega_ = sqrt(abs(discriminant_));
  }

  T alpha() const { return alpha_; }                    ///< α = −c/2m, 1/s
  T omega0_squared() const { return omega0_squared_; }  ///< ω₀² = κ/m, 1/s²
  T omega() const { return omega_; }                    ///< |ω₀² − α²|^½, rad/s
  bool oscillates() const { return discriminant_ > 0; }
  /// Square of a rate, 1/s²; no part of the motion changes faster than twice this rate.
  T hurry_squared() const { return omega0_squared_ + alpha_ * alpha_; }
  T period() const { return 2 * half_period(); }
  T half_period() const { return oscillates() ? pi / omega_ : std::numeric_limits<T>::infinity(); }

  /// Modulus of the fastest eigenvalue, 1/s.
  T fastest_rate() const {
    using std::abs;
    using std::sqrt;
    return oscillates() ? sqrt(omega0_squared_) : abs(alpha_) + omega_;
  }
  /// Rate at which the slowest part of the motion grows (> 0) or decays (< 0), 1/s.
  T slowest_rate() const { return oscillates() ? alpha_ : alpha_ < 0 ? gentle() : alpha_ + omega_; }

  /// Time within the range of doubles, s: until the slowest part has decayed to e^−700 of its
  /// start, or has grown by e^700. Later zeros are not searched.
  T lasts_for() const {
    using std::abs;
    return extinct / abs(slowest_rate());
  }

  /// Time for which rounded initial values suffice, s: where two growing exponentials separate,
  /// rounding of the faster one grows by e⁶ in this time.
  T serves_for() const {
    return alpha_ > 0 && discriminant_ < 0 ? 3 / omega_ : std::numeric_limits<T>::infinity();
  }

  /// Second derivative of a free oscillation from its value and slope.
  T bend(T value, T slope) const { return 2 * alpha_ * slope - omega0_squared_ * value; }

  /// Φ(τ) − 1 and Ψ(τ) for finite τ ≥ 0.
  Propagator<T> after(T tau) const {
    using detail::expm1;
    using detail::sine_and_cosine_of;
    using std::abs;
    if (tau == 0) return {T(0), tau, tau};
    if (hurry_squared() * tau * tau < early * early) return soon_after(tau);
    const T z = discriminant_ * tau * tau;
    if (abs(z) < series_reach && alpha_ * alpha_ < 2 * omega0_squared_)
      return damped(tau, cosine_series(z), tau * sine_series(z));
    if (oscillates()) {
      const auto [sine, cosine] = sine_and_cosine_of(omega_ * tau);
      return damped(tau, cosine - 1, sine / omega_);
    }
    const T rate = gentle(), apart = to_other_root();
    const auto [decay, decay_change] = detail::exponential_and_change(rate * tau);
    const T gain = decay * expm1(apart * tau) / apart;
    return {decay_change - rate * gain, gain, tau};
  }

  /// Propagator of half a period, from one zero of the velocity to the next.
  Propagator<T> half_turn() const {
    using detail::exp;
    return {-1 - exp(alpha_ * half_period()), T(0), half_period()};
  }

  /// Amplitude of a free oscillation from the value and slope of its rate at τ = 0: the turning
  /// points have this distance from zero, times e^(ατ).
  T reach(T rate, T rate_slope) const {
    using detail::hypot;
    return hypot(omega_ * rate, rate_slope - alpha_ * rate) / omega0_squared_;
  }

  /// Zeros of a free oscillation with a value and slope at τ = 0, within `lasts_for`.
  Zeros<T> zeros(T value, T slope) const {
    using detail::atan2;
    constexpr T never = std::numeric_limits<T>::infinity();
    const auto lasting = [&](T tau) { return tau <= lasts_for() ? tau : never; };
    if (!oscillates()) return {lasting(only_zero(value, slope)), never};
    // The phase in (0, π], by one formula for an oscillation and its mirror image.
    const T cosine = slope - alpha_ * value;
    const int mirror = cosine < 0 ? -1 : 1;
    T angle = value == 0 ? T(0) : atan2(-mirror * value * omega_, mirror * cosine);
    if (angle <= 0) angle += pi;
    return {lasting(angle / omega_), lasting(pi / omega_)};
  }

 private:
  static constexpr T pi = T(3.141592653589793238462643383279502884L);
  static constexpr T series_reach = T(0.1);
  static constexpr T early = T(0.2);
  static constexpr T extinct = T(700);  ///< e^−700 is close to the smallest double

  /// Power series of Ψ and of Φ − 1 = −ω₀² ∫Ψ: first moments without cancellation.
  Propagator<T> soon_after(T tau) const {
    const T damp = 2 * alpha_ * tau, pull = omega0_squared_ * tau * tau;
    T before{0}, term = tau;
    T gain = tau, integral = tau * tau / 2;
    for (int n = 2; n <= 14; ++n) {
      const T next = (damp * T(n - 1) * term - pull * before) / T(n * (n - 1));
      before = term;
      term = next;
      gain += term;
      integral += term * tau / T(n + 1);
    }
    return {-omega0_squared_ * integral, gain, tau};
  }

  /// cos √z − 1 and sin √z / √z as entire functions of z: valid through ω² = 0.
  static T cosine_series(T z) {
    return -z / 2 *
           (1 -
            z / 12 * (1 - z / 30 * (1 - z / 56 * (1 - z / 90 * (1 - z / 132 * (1 - z / 182))))));
  }
  static T sine_series(T z) {
    return 1 - z / 6 *
                   (1 - z / 20 *
                            (1 - z / 42 *
                                     (1 - z / 72 * (1 - z / 110 * (1 - z / 156 * (1 - z / 210))))));
  }

  /// Zero of the sum of two real exponentials; a single one has no zero.
  T only_zero(T value, T slope) const {
    using detail::log1p;
    using std::abs;
    constexpr T never = std::numeric_limits<T>::infinity();
    const T steady = gentle() * value, apart = to_other_root(), other = steady + apart * value;
    if (steady == slope || other == slope) return never;
    const T ratio = value / (steady - slope);
    if (!(ratio > 0) || apart * ratio <= -1) return never;
    return omega_ > 0 ? log1p(apart * ratio) / apart : ratio;
  }

  /// Smaller of two real rates, from the larger one, which needs no subtraction, and ω₀².
  T gentle() const { return omega0_squared_ / (alpha_ < 0 ? alpha_ - omega_ : alpha_ + omega_); }
  /// Difference of the two rates: −2ω in a decay, 2ω in a growth.
  T to_other_root() const { return alpha_ < 0 ? -2 * omega_ : 2 * omega_; }

  Propagator<T> damped(T tau, T cosine_change, T sine) const {
    const auto [decay, decay_change] = detail::exponential_and_change(alpha_ * tau);
    const T gain = decay * sine;
    return {decay_change + decay * cosine_change - alpha_ * gain, gain, tau};
  }

  T alpha_{0}, omega0_squared_{1}, discriminant_{1}, omega_{1};
};

}  // namespace pindrive
