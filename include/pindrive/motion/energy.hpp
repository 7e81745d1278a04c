/// Energy balance of a motion. Each term is integrated separately, so that the terms add up only if
/// the motion is right.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/motion/contact_use.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/quadrature.hpp"
#include "pindrive/motion/skin_along.hpp"
#include "pindrive/numbers/named_number.hpp"

namespace pindrive {

template <class T>
struct Ledger {
  T kinetic_start, kinetic_end;  ///< J
  T spring_start, spring_end;    ///< J
  T skin_start, skin_end;        ///< in a compliant finger, J
  T stop_start, stop_end;        ///< in elastic end stops, J
  T plate_work;                  ///< work of the moving plate through friction, also transverse, J
  T inertia_work;                ///< work of the accelerating housing, J
  T force_work;                  ///< work of the external force, J
  T damper_dissipated, plate_dissipated, finger_dissipated, stop_dissipated;  ///< J
  T skin_dissipated;  ///< in the damper of the skin, J
  T exchanged;        ///< largest energy exchanged with the housing during the motion, J

  T residual() const {
    return (kinetic_end - kinetic_start) + (spring_end - spring_start) + (skin_end - skin_start) +
           (stop_end - stop_start) - plate_work - inertia_work - force_work + damper_dissipated +
           plate_dissipated + finger_dissipated + stop_dissipated + skin_dissipated;
  }
  /// Largest energy in the ledger or during the motion, J; the scale of the residual.
  T scale() const {
    using std::abs;
    return std::max({kinetic_start, kinetic_end, spring_start, spring_end, skin_start, skin_end,
                     stop_start, stop_end, abs(plate_work), abs(inertia_work), abs(force_work),
                     damper_dissipated, plate_dissipated, finger_dissipated, stop_dissipated,
                     skin_dissipated, exchanged});
  }
};

/// Terms by their names in the table of quantities, after "energy.".
template <class T>
inline constexpr NamedNumber<T, Ledger<T>> ledger_numbers[] = {
    {"kinetic_start", [](const Ledger<T>& l) { return l.kinetic_start; }},
    {"kinetic_end", [](const Ledger<T>& l) { return l.kinetic_end; }},
    {"spring_start", [](const Ledger<T>& l) { return l.spring_start; }},
    {"spring_end", [](const Ledger<T>& l) { return l.spring_end; }},
    {"skin_start", [](const Ledger<T>& l) { return l.skin_start; }},
    {"skin_end", [](const Ledger<T>& l) { return l.skin_end; }},
    {"stop_start", [](const Ledger<T>& l) { return l.stop_start; }},
    {"stop_end", [](const Ledger<T>& l) { return l.stop_end; }},
    {"plate_work", [](const Ledger<T>& l) { return l.plate_work; }},
    {"inertia_work", [](const Ledger<T>& l) { return l.inertia_work; }},
    {"force_work", [](const Ledger<T>& l) { return l.force_work; }},
    {"damper_dissipated", [](const Ledger<T>& l) { return l.damper_dissipated; }},
    {"plate_dissipated", [](const Ledger<T>& l) { return l.plate_dissipated; }},
    {"finger_dissipated", [](const Ledger<T>& l) { return l.finger_dissipated; }},
    {"stop_dissipated", [](const Ledger<T>& l) { return l.stop_dissipated; }},
    {"skin_dissipated", [](const Ledger<T>& l) { return l.skin_dissipated; }},
    {"residual", [](const Ledger<T>& l) { return l.residual(); }},
};

namespace detail {

/// Energy dissipated by the end stops in a stretch of a segment with known ∫ v² dτ, and at its end,
/// J.
template <class Trajectory, class T>
T lost_at_stop(const Motion<T>& motion, const Trajectory& along, const Segment<T>& segment, T from,
               T to, T v_squared) {
  const Drive<T>& drive = motion.drive();
  if (!drive.stops.present()) return T(0);
  if (drive.stops.rigid()) {
    const bool meets = stops(segment.event.stop) && to >= segment.end - segment.begin;
    if (!meets) return T(0);
    const T v = along.at(along.velocity(), to);
    return drive.mass * v * v / 2;
  }
  if (in_contact(segment.mode.stop)) return drive.stops.damping * v_squared;
  const auto energy = [&](T tau) { return motion.stop_energy(along.at(along.position(), tau)); };
  return segment.mode.stop == StopState::apart ? T(0) : energy(from) - energy(to);
}

}  // namespace detail

/// Computes the energy ledger of a motion over [0, duration].
template <class T>
Ledger<T> energy_ledger(const Motion<T>& motion, T duration, GoOn go_on = {}) {
  using std::abs;
  using std::sqrt;
  const Drive<T>& drive = motion.drive();
  const bool skin = drive.finger.present() && !drive.finger.rigid();
  const auto& pushes = motion.inputs().force;
  const bool pushed = !pushes.constant() || pushes.first() != 0;
  Ledger<T> ledger{};
  const auto state = [&](T t, T& kinetic, T& spring, T& in_skin, T& in_stop) {
    const auto [segment, tau] = motion.locate(t, Side::left);
    motion.along(*segment, [&, tau = tau](const auto& along) {
      const T x = along.at(along.position(), tau), v = along.at(along.velocity(), tau);
      const T stretched =
          skin ? along.at(detail::stretch_force_along(drive, *segment, along), tau) : T(0);
      kinetic = drive.mass * v * v / 2;
      spring = drive.stiffness * x * x / 2;
      in_stop = motion.stop_energy(x);
      in_skin = skin ? stretched * stretched / (2 * drive.finger.stiffness) : T(0);
    });
  };
  state(T(0), ledger.kinetic_start, ledger.spring_start, ledger.skin_start, ledger.stop_start);
  state(duration, ledger.kinetic_end, ledger.spring_end, ledger.skin_end, ledger.stop_end);

  motion.stretches(T(0), duration, [&](const Segment<T>& segment, T from, T to, T times) {
    motion.along(segment, [&](const auto& along) {
      const auto over = [&](const auto& p, const auto& q) {
        return times * along.product_integral(p, q, from, to);
      };
      const auto plate_velocity = along.input(segment.plate_velocity);
      const auto inertia = drive.mass * along.derivative(plate_velocity);
      const T v_squared = over(along.velocity(), along.velocity());
      const T plate_work = over(along.plate_force(), plate_velocity);
      ledger.damper_dissipated += drive.damping * v_squared;
      ledger.plate_work += plate_work;
      ledger.inertia_work += over(inertia, along.velocity());
      T largest = std::max(abs(along.at(inertia, from)), abs(along.at(inertia, to)));
      if (pushed) {
        const Curve<T> push = pushes.from(segment.begin);
        ledger.force_work += over(along.input(push), along.velocity());
        largest += std::max(abs(push.at(from)), abs(push.at(to)));
      }
      if (drive.finger.damped()) {
        const auto stretching = detail::stretch_rate_along(drive, segment, along);
        ledger.skin_dissipated += drive.finger.damping * over(stretching, stretching);
      }
      ledger.stop_dissipated +=
          times * detail::lost_at_stop(motion, along, segment, from, to, v_squared / times);
      // Energy that enters and leaves within a segment leaves its rounding in the sum: by Schwarz's
      // inequality no part of it is larger.
      ledger.exchanged += abs(plate_work) + largest * sqrt((to - from) * times * v_squared);
    });
    return go_on();
  });
  const ContactsUse<T> used = detail::ContactMeasurement<T>(motion, go_on).measure(T(0), duration);
  ledger.plate_work += used.across_dissipated;
  ledger.plate_dissipated = used.plate.dissipated;
  ledger.finger_dissipated = used.finger.dissipated;
  if (motion.inputs().on_ground) {
    ledger.force_work += ledger.inertia_work;
    ledger.inertia_work = T(0);
  }
  return ledger;
}

}  // namespace pindrive
