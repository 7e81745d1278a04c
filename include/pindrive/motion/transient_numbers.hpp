/// Numbers of a motion and their names (docs/theory.md, section 15).
#pragma once

#include <limits>

#include "pindrive/motion/contact_use.hpp"
#include "pindrive/motion/steady_numbers.hpp"
#include "pindrive/numbers/named_number.hpp"

namespace pindrive {

/// Use of one contact after the transient: in each period of a steady motion, and in the mean.
template <class T>
struct Afterwards {
  static constexpr T none = std::numeric_limits<T>::quiet_NaN();

  T reversals{none}, time_stuck{none}, distance_slid{none}, dissipated{none};  ///< in one period
  T power{none};  ///< mean power of the friction of a steady motion or under a pin at rest, W

  void add(const ContactUse<T>& period, T time) {
    reversals = period.reversals;
    time_stuck = period.time_stuck;
    distance_slid = period.distance_slid;
    dissipated = period.dissipated;
    power = period.dissipated / time;
  }
};

/// Numbers of a motion; NaN where a number does not exist.
template <class T>
struct Transient {
  static constexpr T none = std::numeric_limits<T>::quiet_NaN();

  T peak_displacement{none}, peak_time{none};  ///< x_m,a at t_a: m, s
  /// x_m,c at t_c; t_c infinite if only approached
  T trough_displacement{none}, trough_time{none};
  T swing{none};                                        ///< (17), m
  T return_velocity{none}, return_velocity_time{none};  ///< v_m,b at t_b: m/s, s
  T first_reversal_time{none};                          ///< t_1, s
  T settling_time{none};                                ///< start of the time within the band, s
  T rest_time{none};  ///< start of permanent rest, s; infinite if the pin never comes to rest
  T last_event_time{
      none};  ///< last contact event, s; 0 without any after the release, infinite in a cycle
  T steady_since{none};  ///< start of a steady oscillation, s
  /// largest stretch (m) and stretch rate (m/s) of a compliant finger
  T peak_stretch{none}, peak_stretch_rate{none};
  /// x_end: position of rest, centre of the final oscillation, or of a drift the position of its line at t = 0, m
  T end_position{none};
  T drift_velocity{none};  ///< of the line that a drifting pin follows, m/s
  /// Distance of a drifting pin behind the balance of spring and inputs, m; NaN if it grows.
  T lag{none};
  /// Factor in a period of a growing range, or of the distance from the limit that is approached.
  T growth{none};
  T end_time{none};             ///< t*: end of the transient, s
  ContactUse<T> plate, finger;  ///< in the transient; peak forces of the whole motion

  SteadyNumbers<T> steady;  ///< numbers of the final oscillation
  T decay_energy{none};     ///< energy that a final decay has yet to dissipate, J
  Afterwards<T> plate_afterwards, finger_afterwards;
};

/// Numbers by their names in the table of quantities.
template <class T>
inline constexpr NamedNumber<T, Transient<T>> transient_numbers[] = {
    {"transient.peak_displacement", [](const Transient<T>& t) { return t.peak_displacement; }},
    {"transient.peak_time", [](const Transient<T>& t) { return t.peak_time; }},
    {"transient.trough_displacement", [](const Transient<T>& t) { return t.trough_displacement; }},
    {"transient.trough_time", [](const Transient<T>& t) { return t.trough_time; }},
    {"transient.swing", [](const Transient<T>& t) { return t.swing; }},
    {"transient.return_velocity", [](const Transient<T>& t) { return t.return_velocity; }},
    {"transient.return_velocity_time",
     [](const Transient<T>& t) { return t.return_velocity_time; }},
    {"transient.first_reversal_time", [](const Transient<T>& t) { return t.first_reversal_time; }},
    {"transient.settling_time", [](const Transient<T>& t) { return t.settling_time; }},
    {"transient.rest_time", [](const Transient<T>& t) { return t.rest_time; }},
    {"transient.last_event_time", [](const Transient<T>& t) { return t.last_event_time; }},
    {"transient.peak_stretch", [](const Transient<T>& t) { return t.peak_stretch; }},
    {"transient.peak_stretch_rate", [](const Transient<T>& t) { return t.peak_stretch_rate; }},
    {"transient.end_time", [](const Transient<T>& t) { return t.end_time; }},
    {"transient.plate.reversals", [](const Transient<T>& t) { return t.plate.reversals; }},
    {"transient.plate.time_stuck", [](const Transient<T>& t) { return t.plate.time_stuck; }},
    {"transient.plate.distance_slid", [](const Transient<T>& t) { return t.plate.distance_slid; }},
    {"transient.plate.dissipated", [](const Transient<T>& t) { return t.plate.dissipated; }},
    {"transient.plate.peak_force", [](const Transient<T>& t) { return t.plate.peak_force; }},
    {"transient.finger.reversals", [](const Transient<T>& t) { return t.finger.reversals; }},
    {"transient.finger.time_stuck", [](const Transient<T>& t) { return t.finger.time_stuck; }},
    {"transient.finger.distance_slid",
     [](const Transient<T>& t) { return t.finger.distance_slid; }},
    {"transient.finger.dissipated", [](const Transient<T>& t) { return t.finger.dissipated; }},
    {"transient.finger.peak_force", [](const Transient<T>& t) { return t.finger.peak_force; }},
    {"ending.position", [](const Transient<T>& t) { return t.end_position; }},
    {"ending.steady_since", [](const Transient<T>& t) { return t.steady_since; }},
    {"ending.amplitude", [](const Transient<T>& t) { return t.steady.amplitude; }},
    {"ending.period", [](const Transient<T>& t) { return t.steady.period; }},
    {"ending.least_amplitude", [](const Transient<T>& t) { return t.steady.least_amplitude; }},
    {"ending.peak_velocity", [](const Transient<T>& t) { return t.steady.peak_velocity; }},
    {"ending.rounds", [](const Transient<T>& t) { return t.steady.rounds; }},
    {"ending.decay_energy", [](const Transient<T>& t) { return t.decay_energy; }},
    {"ending.drift_velocity", [](const Transient<T>& t) { return t.drift_velocity; }},
    {"ending.lag", [](const Transient<T>& t) { return t.lag; }},
    {"ending.growth", [](const Transient<T>& t) { return t.growth; }},
    {"ending.plate.reversals", [](const Transient<T>& t) { return t.plate_afterwards.reversals; }},
    {"ending.plate.time_stuck",
     [](const Transient<T>& t) { return t.plate_afterwards.time_stuck; }},
    {"ending.plate.distance_slid",
     [](const Transient<T>& t) { return t.plate_afterwards.distance_slid; }},
    {"ending.plate.dissipated",
     [](const Transient<T>& t) { return t.plate_afterwards.dissipated; }},
    {"ending.plate.power", [](const Transient<T>& t) { return t.plate_afterwards.power; }},
    {"ending.finger.reversals",
     [](const Transient<T>& t) { return t.finger_afterwards.reversals; }},
    {"ending.finger.time_stuck",
     [](const Transient<T>& t) { return t.finger_afterwards.time_stuck; }},
    {"ending.finger.distance_slid",
     [](const Transient<T>& t) { return t.finger_afterwards.distance_slid; }},
    {"ending.finger.dissipated",
     [](const Transient<T>& t) { return t.finger_afterwards.dissipated; }},
    {"ending.finger.power", [](const Transient<T>& t) { return t.finger_afterwards.power; }},
};

}  // namespace pindrive
