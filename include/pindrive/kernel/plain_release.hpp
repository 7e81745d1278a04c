/// What the kernel takes and gives of plain releases.
#pragma once

#include "pindrive/kernel/oscillation.hpp"

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
    end_time,
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
    plate_power,
    finger_power,
    duration,
    events,
    count
  };
};

/// 1 of an even whole number below 2^52, −1 of an odd one.
template <class V>
V one_or_minus_one(const V& n) {
  const BitsOf<V> low = bits(n + V(0x1p52));
  return from_bits<V>((low << 63) | bits(V(1.0)));
}

/// Two numbers that differ by less than this part of what they are computed from may be equal: a
/// thousand times what rounding adds up to over the turns that are followed.
inline constexpr double near_tie = 1e-12;

/// A plain release, seen so that its plate moves forward, with what follows from it.
template <class V>
struct ForwardRelease {
  V mirror;                 ///< ±1, which brings its positions and velocities here and back
  V stiffness, per_mass;    ///< N/m, 1/kg
  V flexibility;            ///< m/N
  V fp, sp, ff, sf;         ///< kinetic and static friction of plate and finger, N
  V vp, drag;               ///< the plate's velocity, and the damper's force at it
  V start, start_velocity;  ///< x(0), x'(0)
  V until, band;
  V between, outside;  ///< the centre while it slides slower than the plate, and backward, m
  V size;              ///< of the forces, N
  Oscillation<V> swing;
  MaskOf<V> plain;  ///< those that the kernel follows: what loses no energy never comes to rest

  explicit ForwardRelease(const PlainRelease<V>& r) noexcept
      : mirror(with_sign(V(1.0), r.mouse_velocity)),
        stiffness(r.stiffness),
        fp(r.plate_kinetic),
        sp(r.plate_static),
        ff(r.finger_kinetic),
        sf(r.finger_static),
        vp(absolute(r.mouse_velocity)),
        start(r.displacement * mirror),
        start_velocity(r.velocity * mirror),
        until(r.duration),
        band(r.settling_band),
        swing(r.mass, r.stiffness, r.damping) {
    const V zero(0.0), speed = absolute(start_velocity);
    per_mass = V(1.0) / r.mass;
    flexibility = V(1.0) / stiffness;
    drag = r.damping * vp;
    between = (fp - ff) * flexibility;
    outside = (fp + ff) * flexibility;
    const V reach = absolute(start) + (speed + vp) * swing.per_omega;
    size = stiffness * reach + fp + sp + ff + sf + drag + r.damping * speed;
    plain = (r.finger_stiffness == V(__builtin_inf())) & (zero < vp) & (zero < sp) & (zero < sf) &
            (zero < fp + ff + r.damping) & swing.oscillates;
  }

  /// The force on the plate while it carries the pin.
  V carrying(const V& position) const { return stiffness * position + drag + ff; }
  /// Whether rounding could decide which of two forces is larger.
  MaskOf<V> tie(const V& one, const V& other) const {
    return !(V(near_tie) * size < absolute(one - other));
  }
  /// The same of positions.
  V slack() const { return V(near_tie) * size * flexibility; }
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
