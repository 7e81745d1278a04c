/// Input and output of the kernel for standard releases.
#pragma once

#include "pindrive/kernel/oscillation.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// Input of the kernel, SI units. Both contacts have friction and are rigid; all further releases
/// are left to the general core.
template <class V>
struct PlainRelease {
  V mass, stiffness, damping;       ///< kg, N/m, N s/m
  V plate_kinetic, plate_static;    ///< N
  V finger_kinetic, finger_static;  ///< N
  V finger_stiffness;               ///< N/m
  V mouse_velocity;                 ///< m/s
  V displacement, velocity;         ///< x(0), x'(0): m, m/s
  V duration;                       ///< s; infinite: until it rests
  V settling_band;                  ///< band of the settling time, as a fraction of |x(0) − x_end|
};

/// Numbers of docs/theory.md, section 15, of a standard release; a number that does not exist is
/// NaN.
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

/// Standard release, mirrored so that the plate moves forward, with derived values.
template <class V>
struct ForwardRelease {
  V mirror;                 ///< sign ±1 that mirrors positions and velocities
  V stiffness, per_mass;    ///< N/m, 1/kg
  V flexibility;            ///< m/N
  V fp, sp, ff, sf;         ///< kinetic and static friction of plate and finger, N
  V vp, drag;               ///< plate velocity; damper force at this velocity
  V start, start_velocity;  ///< x(0), x'(0)
  V until, band;
  /// centre of oscillation while slower than the plate, and while moving backward, m
  V between, outside;
  V size;  ///< scale of the forces, N
  Oscillation<V> swing;
  MaskOf<V>
      /// mask of releases that the kernel simulates; without energy loss a pin never comes to rest
      plain;

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

  /// Stick force at a position of a pin stuck to the plate, N.
  V carrying(const V& position) const { return stiffness * position + drag + ff; }
  /// Mask: rounding could decide which of two forces is larger.
  MaskOf<V> tie(const V& one, const V& other) const {
    return !(V(near_tie) * size < absolute(one - other));
  }
  /// Difference of positions below which rounding could decide, m.
  V slack() const { return V(near_tie) * size * flexibility; }
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
