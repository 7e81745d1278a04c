/// Oscillation of a pin about a fixed centre, between two events: the closed form of turning
/// points, extreme velocities and given velocities for the kernel.
#pragma once

#include "pindrive/numbers/elementary.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// Phase of a damped oscillation past a turning point.
template <class V>
struct PastTurn {
  V angle;  ///< δ in [0, π)
  V slope;  ///< derivative of e^(−ρδ) (cos δ + ρ sin δ) at δ
};

/// Phase δ with e^(−ρδ) (cos δ + ρ sin δ) = part: the phase past a turning point at which the
/// distance from the centre has decreased to this part; with −ρ, the phase before. 0 for part >= 1.
template <class V>
PastTurn<V> past_turn(const V& part, const V& rho) {
  using Mask = MaskOf<V>;
  const V zero(0.0), pi(0x1.921fb54442d18p+1);
  const V scale = V(1.0) + rho * rho, lack = larger(V(1.0) - part, zero);
  // From the first terms of the power series.
  const V arc = root(V(2.0) * lack / scale);
  const V bend_of_arc = rho * rho * V(11.0 / 72) + (V(1.0 / 24) + arc * arc * V(3.0 / 640));
  const V arched = arc * (V(1.0) + arc * (rho * V(1.0 / 3) + arc * bend_of_arc));
  V low = zero, high = pi, last_slope = zero;
  V angle = select((zero < arched) & (arched < V(3.0)), arched, V(1.5));
  Mask open = zero < lack;
  // Householder's iteration of the third order, which has four times the digits after each step; or a
  // bisection where it leaves the bracket.
  for (int i = 0; i < 60 && any(open); ++i) {
    const Circular<V> turned = sine_and_cosine_in_turn(angle);
    const V decay = exponential_in_range(V(0.0) - rho * angle);
    const V value = decay * (turned.cosine + rho * turned.sine), excess = value - part;
    const V slope = V(0.0) - scale * decay * turned.sine;
    const V bend = V(-2.0) * rho * slope - scale * value;
    const V third = V(-2.0) * rho * bend - scale * slope;
    const Mask before = zero < excess;
    low = select(before, angle, low);
    high = select(before, high, angle);
    const V squared = slope * slope, product = excess * bend;
    const V above = V(3.0) * excess * (V(2.0) * squared - product);
    const V below = V(6.0) * slope * (squared - product) + excess * excess * third;
    const V tried = angle - above / below;
    const Mask inside = (low <= tried) & (tried <= high);
    const V next = select(inside, tried, V(0.5) * (low + high));
    const V change = next - angle;
    // The slope at the next angle, by its own power series; the last change is small.
    const V fourth = V(-2.0) * rho * third - scale * bend;
    const V rest = change * (third * V(0.5) + change * fourth * V(1.0 / 6));
    last_slope = select(open, slope + change * (bend + rest), last_slope);
    angle = select(open, next, angle);
    open = open & !(absolute(change) <= V(last_change) * smaller(next, pi - next));
  }
  return {select(zero < lack, angle, zero), last_slope};
}

/// Oscillation of mass, spring and damper: x'' − 2α x' + ω0² (x − c) = 0 with α <= 0; the phase is
/// the angle ωt.
template <class V>
struct Oscillation {
  V omega0_squared, per_omega0_squared, omega0, alpha, omega, per_omega;
  V rho;           ///< −α/ω
  V half, shrink;  ///< half period, s; factor of the amplitude over a half period
  /// phase from rest to the extreme velocity; extreme velocity per metre, 1/s
  V extreme_angle, extreme;
  MaskOf<V> oscillates;  ///< mask: damping so small that the sine of a half period keeps its digits

  Oscillation(const V& mass, const V& stiffness, const V& damping) {
    const V zero(0.0), per_mass = V(1.0) / mass;
    omega0_squared = stiffness * per_mass;
    per_omega0_squared = mass * (V(1.0) / stiffness);
    omega0 = root(omega0_squared);
    alpha = V(-0.5) * damping * per_mass;
    const V squared = (omega0 + alpha) * (omega0 - alpha);
    oscillates = V(least_discriminant) * omega0_squared < squared;
    omega = root(larger(squared, zero));
    per_omega = V(1.0) / omega;
    rho = zero - alpha * per_omega;
    half = V(0x1.921fb54442d18p+1) * per_omega;
    shrink = exponential_in_range(alpha * half);
    extreme_angle = angle_of(omega, zero - alpha);
    extreme = omega0 * exponential_in_range(zero - rho * extreme_angle);
  }

  struct Extreme {
    V angle, velocity;
  };
  /// Nearest phase at which the velocity is extreme in the direction of a side; < 0 if past.
  Extreme extreme_velocity(const V& velocity, const V& acceleration, const V& side) const {
    const V cosine = side * omega * acceleration;
    const V sine = side * (alpha * acceleration - omega0_squared * velocity);
    const V angle = angle_of(cosine, V(0.0) - sine);
    const V speed = root(cosine * cosine + sine * sine) * per_omega0_squared;
    return {angle, side * speed * exponential_in_range(V(0.0) - rho * angle)};
  }

  struct Turn {
    V angle, distance;  ///< phase; distance from the centre, m
  };
  /// Next turning point.
  Turn next_turn(const V& velocity, const V& acceleration) const {
    const V side = with_sign(V(1.0), velocity);
    const V sine = acceleration - alpha * velocity, cosine = omega * velocity;
    const V angle = angle_of(absolute(cosine), V(0.0) - side * sine);
    const V distance = root(cosine * cosine + sine * sine) * per_omega0_squared;
    return {angle, side * distance * exponential_in_range(V(0.0) - rho * angle)};
  }

  /// Distance from the centre for a velocity and an acceleration, m.
  V distance_at(const V& velocity, const V& acceleration) const {
    return (V(2.0) * alpha * velocity - acceleration) * per_omega0_squared;
  }

  struct State {
    V distance, velocity;
  };
  /// State after a phase, from a distance from the centre and a velocity.
  State after(const V& angle, const V& distance, const V& velocity) const {
    const Circular<V> turned = sine_and_cosine_in_turn(angle);
    const V decay = exponential_in_range(V(0.0) - rho * angle);
    const V gain = decay * turned.sine * per_omega;
    const V stay = decay * turned.cosine - alpha * gain;
    return {distance * stay + velocity * gain,
            velocity * (stay + V(2.0) * alpha * gain) - omega0_squared * distance * gain};
  }
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
