/// What the kernel takes and gives of plain releases, and the one equation that it solves.
#pragma once

#include "pindrive/elementary.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// What goes in, SI units. Both contacts have friction and are rigid; others are given up.
template <class V>
struct PlainRelease {
  V mass, stiffness, damping;       ///< kg, N/m, N s/m
  V plate_kinetic, plate_static;    ///< N
  V finger_kinetic, finger_static;  ///< N
  V finger_stiffness;               ///< N/m
  V mouse_velocity;                 ///< m/s
  V displacement, velocity;         ///< x(0), x'(0): m, m/s
  V duration;                       ///< s; infinite: until it rests
  V settling_band;                  ///< of the settling time, a part of |x(0) − x_end|
};

/// Where it ends: at rest, or moving at the end of the duration.
template <class V>
struct LastState {
  V position, velocity;  ///< m, m/s
  V time;                ///< since when it rests, s; NaN while it moves
  MaskOf<V> given_up;    ///< the general core is asked
  MaskOf<V> put_off;     ///< it meets the plate again, which was not to be followed
};

/// The numbers of docs/theory.md, section 6, that a plain release has; what it has not is NaN.
struct PlainNumber {
  enum Name : signed char {
    peak_displacement,
    peak_time,
    trough_displacement,
    trough_time,
    swing,
    return_velocity,
    return_velocity_time,
    first_reversal_time,
    settling_time,
    plate_reversals,
    plate_time_stuck,
    plate_distance_slid,
    plate_dissipated,
    plate_peak_force,
    finger_reversals,
    finger_time_stuck,
    finger_distance_slid,
    finger_dissipated,
    finger_peak_force,
    duration,
    events,
    count
  };
};
template <class V>
struct PlainNumbers {
  V of[PlainNumber::count];
  MaskOf<V> unsure;  ///< the general core is asked for the settling time
};

/// The δ in (0, π) with e^(−ρδ) (cos δ + ρ sin δ) = part: how far past its turning point an oscillation
/// has only this part of its distance from the centre; with −ρ, how far before it. part < 1.
template <class V>
V angle_from_turn(const V& part, const V& rho) {
  using Mask = MaskOf<V>;
  const V zero(0.0), pi(0x1.921fb54442d18p+1);
  const V scale = V(1.0) + rho * rho, lack = larger(V(1.0) - part, zero);
  // Of the first terms of its power series.
  const V arc = root(V(2.0) * lack / scale);
  const V bend_of_arc = rho * rho * V(11.0 / 72) + (V(1.0 / 24) + arc * arc * V(3.0 / 640));
  const V arched = arc * (V(1.0) + arc * (rho * V(1.0 / 3) + arc * bend_of_arc));
  V low = zero, high = pi;
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
    const V change_of_bend = V(-2.0) * rho * bend - scale * slope;
    const Mask before = zero < excess;
    low = select(before, angle, low);
    high = select(before, high, angle);
    const V squared = slope * slope, product = excess * bend;
    const V above = V(3.0) * excess * (V(2.0) * squared - product);
    const V below = V(6.0) * slope * (squared - product) + excess * excess * change_of_bend;
    const V tried = angle - above / below;
    const Mask inside = (low <= tried) & (tried <= high);
    const V next = select(inside, tried, V(0.5) * (low + high));
    const V change = absolute(next - angle);
    angle = select(open, next, angle);
    open = open & !(change <= V(1e-4) * smaller(next, pi - next));
  }
  return select(zero < lack, angle, zero);
}

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
