/// Use of the contacts in a stretch of a motion: sliding, sticking, dissipation and peak forces.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "pindrive/motion/extrema.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/quadrature.hpp"
#include "pindrive/motion/skin_along.hpp"

namespace pindrive {

/// Use of one contact in a stretch of a motion.
template <class T>
struct ContactUse {
  T reversals{0};   ///< zeros of the sliding velocity
  T time_stuck{0};  ///< time in stick or elastic stick, s
  /// distance that the pin slides over the surface, also in the transverse direction, m
  T distance_slid{0};
  T dissipated{0};  ///< friction work, also in the transverse direction, J
  T peak_force{0};  ///< largest friction force, N
};

/// Use of both contacts; the stretch of a rigid finger is NaN.
template <class T>
struct ContactsUse {
  ContactUse<T> plate, finger;
  T across_dissipated{0};  ///< transverse part of the friction work of the plate, J
  /// largest stretch of a compliant finger, m
  T peak_stretch{std::numeric_limits<T>::quiet_NaN()};
  T peak_stretch_rate{std::numeric_limits<T>::quiet_NaN()};  ///< m/s
};

namespace detail {

/// Measures the use of the contacts of a motion, which outlives the measurement.
template <class T>
class ContactMeasurement {
 public:
  explicit ContactMeasurement(const Motion<T>& motion, GoOn go_on = {})
      : motion_(motion), go_on_(go_on) {}

  /// Use of the contacts in [begin, end], s.
  ContactsUse<T> measure(T begin, T end) const {
    ContactsUse<T> result;
    if (skin()) result.peak_stretch = result.peak_stretch_rate = T(0);
    motion_.stretches(begin, end, [&](const Segment<T>& segment, T from, T to, T times) {
      motion_.along(segment,
                    [&](const auto& along) { stretch(result, along, segment, from, to, times); });
      return go_on_();
    });
    return result;
  }

 private:
  bool skin() const { return motion_.drive().finger.present() && !motion_.drive().finger.rigid(); }

  /// Displacement between two times of a segment. Computed as a change, with full relative
  /// precision however short beside x.
  template <class Trajectory>
  static T moved(const Trajectory& along, T from, T to) {
    const T change = along.change(along.position(), to);
    return from > 0 ? change - along.change(along.position(), from) : change;
  }

  template <class Trajectory>
  void stretch(ContactsUse<T>& result, const Trajectory& along, const Segment<T>& segment, T from,
               T to, T times) const {
    const bool whole = to >= segment.end - segment.begin;
    const T distance = moved(along, from, to);
    const Curve<T>& plate = segment.plate_velocity;
    const T carried = plate.straight() ? (plate.at(from) + plate.at(to)) / 2 * (to - from)
                                       : along.product_integral(along.input({T(1), T(0)}),
                                                                along.input(plate), from, to);
    use(result.plate, along, segment, segment.mode.plate,
        along.velocity() + T(-1) * along.input(plate), along.plate_force(),
        whole && stops(segment.event.plate), from, to, distance - carried, times);
    const auto finger = [&](const auto& sliding, T slid) {
      use(result.finger, along, segment, segment.mode.finger, sliding, along.finger_force(),
          whole && stops(segment.event.finger), from, to, slid, times);
    };
    if (!skin())
      finger(along.velocity(), distance);
    else {
      const auto in_skin = stretch_force_along(motion_.drive(), segment, along);
      const T stretched = along.at(in_skin, from) - along.at(in_skin, to);
      finger(sliding_along(motion_.drive(), segment, along),
             distance - stretched / motion_.drive().finger.stiffness);
    }
    across(result, along, segment, from, to, times);
    if (segment.mode.both_stuck())
      for (const T tau : {from, to}) {
        const auto friction = motion_.friction(segment, tau);
        result.plate.peak_force = std::max(result.plate.peak_force, abs(friction.plate));
        result.finger.peak_force = std::max(result.finger.peak_force, abs(friction.finger));
      }
    if (!skin()) return;
    if (whole) result.finger.dissipated += times * skin_loss(along, segment, to);
    const auto in_skin = (-1 / motion_.drive().finger.stiffness) *
                         stretch_force_along(motion_.drive(), segment, along);
    peak(result.peak_stretch, along, in_skin, from, to);
    peak(result.peak_stretch_rate, along, stretch_rate_along(motion_.drive(), segment, along), from,
         to);
  }

  /// Adds the distance and the friction work of a plate that also slides in the transverse
  /// direction.
  template <class Trajectory>
  void across(ContactsUse<T>& result, const Trajectory& along, const Segment<T>& segment, T from,
              T to, T times) const {
    if (segment.mode.plate != ContactState::slip_oblique) return;
    const Drive<T>& drive = motion_.drive();
    const auto lines = InputCurves<T>::of(drive, motion_.inputs(), segment);
    const auto speed = [&](T tau) {
      const T u = along.at(along.velocity(), tau) - lines.plate_velocity.at(tau);
      return hypot(u, lines.across_velocity.at(tau));
    };
    result.plate.distance_slid += times * gauss<T>(speed, from, to);
    const T work = gauss<T>(
        [&](T tau) {
          const T s = speed(tau), w = lines.across_velocity.at(tau);
          return s > 0 ? drive.plate.friction_at(s) * lines.plate_load.at(tau) * w * w / s : T(0);
        },
        from, to);
    result.plate.dissipated += times * work;
    result.across_dissipated += times * work;
  }

  template <class Trajectory, class Quantity>
  static void peak(T& largest, const Trajectory& along, const Quantity& path, T from, T to) {
    const auto compare = [&](T, T value) { largest = std::max(largest, abs(value)); };
    if (along.constant(path))
      compare(from, along.start(path));
    else
      highest_and_lowest(along, path, from, to, compare);
  }

  template <class Trajectory, class Quantity>
  void use(ContactUse<T>& contact, const Trajectory& along, const Segment<T>& segment,
           ContactState does, const Quantity& sliding, const Quantity& force, bool came_to_zero,
           T from, T to, T distance, T times) const {
    if (does == ContactState::absent) return;
    if (!segment.mode.both_stuck()) peak(contact.peak_force, along, force, from, to);
    if (!is_slip(does)) {
      contact.time_stuck += times * (to - from);
      return;
    }
    const T slid = abs(distance);
    if (does != ContactState::slip_oblique) contact.distance_slid += times * slid;
    if (came_to_zero) contact.reversals += times;
    if (along.constant(force)) {
      contact.dissipated += times * abs(along.start(force)) * slid;
    } else {
      contact.dissipated -= times * along.product_integral(force, sliding, from, to);
    }
  }

  /// Energy that a stretched skin loses as it shortens at once, at the end of a segment, J.
  template <class Trajectory>
  T skin_loss(const Trajectory& along, const Segment<T>& segment, T to) const {
    const Segment<T>* next = motion_.after(segment);
    if (segment.event.finger != Transition::slip || next == nullptr) return T(0);
    if (motion_.drive().finger.damped()) return T(0);  // damped skin does not jump
    const auto energy = [&](T force) {
      return force * force / (2 * motion_.drive().finger.stiffness);
    };
    return energy(along.at(along.finger_force(), to)) - energy(next->finger_force.start);
  }

  const Motion<T>& motion_;
  GoOn go_on_;
};

}  // namespace detail

}  // namespace pindrive
