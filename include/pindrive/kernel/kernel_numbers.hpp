/// Numbers of a standard release, accumulated from event to event.
#pragma once

#include "pindrive/kernel/plain_release.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

template <class V>
struct TransientNumbers {
  using Mask = MaskOf<V>;
  static constexpr double none = __builtin_nan("");

  V outward, inward;  ///< outward direction ±1; 1 if the pin starts inward, else 0
  V turns;            ///< turning points; the start counts if the pin starts inward
  V peak, peak_time{none}, trough{none}, trough_time{none};
  V return_speed{0.0}, return_time{none}, first_reversal{none};
  V plate_reversals{0.0}, plate_stuck{0.0}, plate_slid{0.0}, plate_peak{0.0};
  V finger_slid{0.0}, moved{0.0};  ///< slid distance, m; 1 if the pin moved

  explicit TransientNumbers(const ForwardRelease<V>& r) {
    const V zero(0.0), x = r.start, v = r.start_velocity;
    const V first = select(x == zero, select(v == zero, V(1.0), v), x);
    outward = with_sign(V(1.0), first);
    const V net = r.fp - r.stiffness * x;
    const V heading = select(v == zero, select(absolute(net) <= r.sf, zero, net), v);
    // If it does not set out outward, its start is the peak.
    const Mask start_is_peak = !(zero < heading * outward);
    turns = inward = select(start_is_peak, V(1.0), zero);
    peak = select(start_is_peak, x, V(none));
    peak_time = select(start_is_peak, zero, V(none));
  }

  /// Calls f with all members that change.
  template <class F>
  void columns(const F& f) {
    f(turns), f(peak), f(peak_time), f(trough), f(trough_time), f(return_speed), f(return_time);
    f(first_reversal), f(plate_reversals), f(plate_stuck), f(plate_slid), f(plate_peak);
    f(finger_slid), f(moved);
  }
  static constexpr int column_count = 14;

  /// Includes a velocity, relevant on the return from the peak.
  void consider(const Mask& which, const V& time, const V& velocity) {
    consider_way_back(which & (turns == V(1.0)), time, velocity);
  }
  void consider_way_back(const Mask& which, const V& time, const V& velocity) {
    const V speed = V(0.0) - outward * velocity;
    const Mask better = which & (return_speed < speed);
    return_speed = select(better, speed, return_speed);
    return_time = select(better, time, return_time);
  }
  void slides(const Mask& which, const V& distance, const V& time, const ForwardRelease<V>& r) {
    const V zero(0.0);
    finger_slid = finger_slid + select(which, absolute(distance), zero);
    plate_slid = plate_slid + select(which, absolute(distance - r.vp * time), zero);
    plate_peak = select(which, larger(plate_peak, r.fp), plate_peak);
    moved = select(which, V(1.0), moved);
  }
  /// Includes stick on the plate from one position to another.
  void carries(const Mask& which, const V& from, const V& to, const V& begin, const V& time,
               const ForwardRelease<V>& r) {
    const V zero(0.0);
    consider(which, begin, r.vp);
    plate_stuck = plate_stuck + select(which, time, zero);
    finger_slid = finger_slid + select(which, to - from, zero);
    const V force = larger(absolute(r.carrying(from)), absolute(r.carrying(to)));
    plate_peak = select(which, larger(plate_peak, force), plate_peak);
    moved = select(which, V(1.0), moved);
  }
  /// Includes an instant at the plate velocity.
  void reaches_plate(const Mask& which, const V& time) {
    first_reversal = select(which & (plate_reversals == V(0.0)), time, first_reversal);
    plate_reversals = plate_reversals + select(which, V(1.0), V(0.0));
  }
  /// Includes a turning point.
  void turns_at(const Mask& which, const V& position, const V& time) {
    const Mask at_peak = which & (turns == V(0.0)), at_trough = which & (turns == V(1.0));
    peak = select(at_peak, position, peak);
    peak_time = select(at_peak, time, peak_time);
    trough = select(at_trough, position, trough);
    trough_time = select(at_trough, time, trough_time);
    turns = turns + select(which, V(1.0), V(0.0));
  }

  /// Passes all numbers but the settling time to `give(name, number)`, for a motion with a final
  /// position. `released`: 1 after stick on the plate.
  template <class Give>
  void give(const ForwardRelease<V>& r, const Mask& resting, const V& position, const V& time,
            const V& released, const Give& give) const {
    using Name = PlainNumber;
    const V zero(0.0), period = V(0x1.921fb54442d18p+2) / r.swing.omega0;
    give(Name::peak_displacement, peak * r.mirror);
    give(Name::peak_time, peak_time);
    give(Name::trough_displacement, trough * r.mirror);
    give(Name::trough_time, trough_time);
    give(Name::swing, (peak - trough) * outward);
    const Mask returned = zero < return_speed;
    give(Name::return_velocity,
         select(returned, zero - outward * return_speed * r.mirror, V(none)));
    give(Name::return_velocity_time, select(returned, return_time, V(none)));
    give(Name::first_reversal_time, first_reversal);
    const V shown =
        larger(V(1.25) * time, period);  // numbers of a motion that is followed until rest
    const V duration = select(r.until < V(__builtin_inf()), r.until, shown);
    const V held = absolute(r.fp - r.stiffness * position);
    give(Name::end_time, select(resting, time, duration));
    give(Name::plate_reversals, plate_reversals);
    give(Name::plate_time_stuck, plate_stuck);
    give(Name::plate_distance_slid, plate_slid);
    give(Name::plate_dissipated, r.fp * plate_slid);
    give(Name::plate_peak_force, select(resting, larger(plate_peak, r.fp), plate_peak));
    const V stops = turns - inward, sliding = select(moved == zero, zero, r.ff);
    give(Name::finger_reversals, stops);
    give(Name::finger_time_stuck, zero);
    give(Name::finger_distance_slid, finger_slid);
    give(Name::finger_dissipated, r.ff * finger_slid);
    give(Name::finger_peak_force, select(resting, larger(sliding, held), sliding));
    give(Name::plate_power, select(resting, r.fp * r.vp, V(none)));
    give(Name::finger_power, select(resting, zero, V(none)));
    give(Name::duration, duration);
    give(Name::events, stops + plate_reversals + released);
  }
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
