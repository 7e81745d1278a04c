/// What the contacts did during a motion: how they slid and stuck, and what they took from it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/extrema.hpp"
#include "pindrive/motion.hpp"
#include "pindrive/quadrature.hpp"

namespace pindrive {

/// What one contact did during the motion.
template <class T>
struct ContactUse {
  T reversals{0};      ///< how often its sliding velocity came to zero
  T time_stuck{0};     ///< elastically too, s
  T distance_slid{0};  ///< by the pin over the surface, m
  T dissipated{0};     ///< J
  T peak_force{0};     ///< largest friction force, N
};

/// What both did; NaN of the stretch of a rigid finger.
template <class T>
struct ContactsUse {
  ContactUse<T> plate, finger;
  T peak_stretch{std::numeric_limits<T>::quiet_NaN()};       ///< largest of a compliant finger's, m
  T peak_stretch_rate{std::numeric_limits<T>::quiet_NaN()};  ///< m/s
};

/// Measures what the contacts did in a motion, which outlives it, over [0, duration].
template <class T, class GoOn = Unattended>
class ContactMeasurement {
 public:
  ContactMeasurement(const Motion<T>& motion, T duration, GoOn go_on = {})
      : motion_(motion), duration_(duration), go_on_(go_on) {}

  ContactsUse<T> measure() const {
    ContactsUse<T> result;
    const Drive<T>& drive = motion_.drive();
    const bool skin = drive.finger.present() && !drive.finger.rigid();
    if (skin) result.peak_stretch = result.peak_stretch_rate = T(0);
    motion_.stretches(duration_, [&](const Segment<T>& segment, T from, T to, T times) {
      const bool whole = to >= segment.end - segment.begin;
      const T distance = moved(segment, from, to);
      use(result.plate, segment, segment.mode.plate, segment.plate_velocity, segment.plate_force,
          whole && stops(segment.event.plate), from, to, distance, times);
      use(result.finger, segment, segment.mode.finger, {}, segment.finger_force,
          whole && stops(segment.event.finger), from, to, distance, times);
      if (segment.mode.both_stuck())
        for (const T tau : {from, to}) {
          using std::abs;
          const auto friction = motion_.friction(segment, tau);
          result.plate.peak_force = std::max(result.plate.peak_force, abs(friction.plate));
          result.finger.peak_force = std::max(result.finger.peak_force, abs(friction.finger));
        }
      if (!skin) return go_on_();
      result.finger.dissipated += times * skin_loss(segment, from, to, whole);
      const Oscillator<T>& oscillator = segment.flow.oscillator;
      const Path<T> stretch = (-1 / drive.finger.stiffness) * segment.finger_force;
      peak(result.peak_stretch, segment, stretch, from, to);
      peak(result.peak_stretch_rate, segment, stretch.derivative(oscillator), from, to);
      return go_on_();
    });
    return result;
  }

 private:
  /// How far the pin comes between two times of a segment. As a change it keeps its digits, however
  /// short it is beside x.
  static T moved(const Segment<T>& segment, T from, T to) {
    const Path<T>& x = segment.flow.position;
    const T change = x.change(segment.after(to), to);
    return from > 0 ? change - x.change(segment.after(from), from) : change;
  }

  static void peak(T& largest, const Segment<T>& segment, const Path<T>& path, T from, T to) {
    const auto compare = [&](T, T value) {
      using std::abs;
      largest = std::max(largest, abs(value));
    };
    if (path.constant())
      compare(from, path.start);
    else
      highest_and_lowest(segment, path, from, to, compare);
  }

  void use(ContactUse<T>& contact, const Segment<T>& segment, ContactState does, Line<T> surface,
           const Path<T>& force, bool came_to_zero, T from, T to, T distance, T times) const {
    using std::abs;
    if (does == ContactState::absent) return;
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    if (!segment.mode.both_stuck()) peak(contact.peak_force, segment, force, from, to);
    if (!slips(does)) {
      contact.time_stuck += times * (to - from);
      return;
    }
    const T slid = abs(distance - (surface.at(from) + surface.at(to)) / 2 * (to - from));
    contact.distance_slid += times * slid;
    if (came_to_zero) contact.reversals += times;
    if (force.constant()) {
      contact.dissipated += times * abs(force.start) * slid;
    } else {
      const Path<T> of_surface = surface;
      contact.dissipated -=
          times *
          product_integral(oscillator, force, segment.flow.velocity + T(-1) * of_surface, from, to);
    }
  }

  /// What a stretched skin gives to its slider, or takes from it, beside the pin's own sliding, J.
  T skin_loss(const Segment<T>& segment, T from, T to, bool whole) const {
    const Contact<T>& finger = motion_.drive().finger;
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const auto energy = [&](T force) { return force * force / (2 * finger.stiffness); };
    const T start = energy(segment.finger_force.at(oscillator, from));
    const T end = energy(segment.finger_force.at(oscillator, to));
    if (slips(segment.mode.finger)) return start - end;
    if (!whole || segment.event.finger != Transition::slip) return T(0);
    using std::abs;
    const T speed = abs(segment.flow.velocity.at(oscillator, to));
    return end - energy(finger.branch(finger.branch_of(speed)).at(speed));
  }

  const Motion<T>& motion_;
  T duration_;
  GoOn go_on_;
};

}  // namespace pindrive
