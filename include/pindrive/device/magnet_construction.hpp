/// Parameters of an electromagnet from its construction, or from the times of its pull.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "pindrive/device/electromagnet.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive::device {

/// Construction of an electromagnet with two poles on a steel plate, SI. The iron has no reluctance up to
/// the saturation field, and no flux leaks (Fitzgerald, Kingsley and Umans, "Electric Machinery",
/// chapters 1 and 3).
template <class T>
struct CoilConstruction {
  T turns, pole_area, gap, wire_diameter, turn_length, supply_voltage;
  T release_resistance;  ///< of the decay path beside the winding, ohm
  T saturation_field;    ///< T

  static constexpr double pi = 0x1.921fb54442d18p+1;
  static constexpr double magnetic_constant = 1.25663706127e-6;  ///< N/A², CODATA 2022
  static constexpr double copper = 1 / 58e6;  ///< resistivity at 20 °C, ohm m (IEC 60028)

  /// Resistance of the winding at 20 °C, ohm.
  T resistance() const {
    return copper * turns * turn_length / (pi / 4 * wire_diameter * wire_diameter);
  }
  /// Inductance with the closed gap, H.
  T inductance() const { return magnetic_constant * turns * turns * pole_area / (2 * gap); }
  /// Full current, A.
  T current() const { return supply_voltage / resistance(); }
  /// Field in the gap at full current if the iron did not saturate, T.
  T field() const { return magnetic_constant * turns * current() / (2 * gap); }
  /// Part of the full current at which the iron saturates, at most 1.
  T saturation() const { return std::min(T(1), saturation_field / field()); }
  /// Pull at full current or saturation, N.
  T pull() const {
    const T reached = std::min(field(), saturation_field);
    return reached * reached * pole_area / magnetic_constant;
  }
  T power() const { return supply_voltage * current(); }  ///< at full current, W
};

/// Time constants of a flux whose pull reaches 90 % of the hold force, and falls to 10 %, after a time.
template <class T>
T rise_constant(T rise_time, T saturation) {
  return -rise_time / log(1 - saturation * std::sqrt(0.9));
}
template <class T>
T fall_constant(T fall_time, T saturation) {
  return -fall_time / log(saturation * std::sqrt(0.1));
}

/// Flux linkage at which the gap of a magnet closes against a force (N).
template <class T>
T closing_flux(const MagnetParameters<T>& magnet, T force) {
  return magnet.saturation *
         sqrt((force - magnet.residual) / (magnet.hold_force - magnet.residual));
}

/// Returns the construction that a device file gives; `number` returns the value of a key.
template <class Number, class T = std::decay_t<std::invoke_result_t<Number, const char*>>>
CoilConstruction<T> construction_by_keys(const Number& number) {
  return {number("magnet.turns"),
          number("magnet.pole_area"),
          number("magnet.gap"),
          number("magnet.wire_diameter"),
          number("magnet.turn_length"),
          number("magnet.supply_voltage"),
          number("magnet.release_resistance"),
          number("magnet.saturation_field")};
}

/// Sets the numbers of an electromagnet by its data sheet: the winding, and the pull at a current.
template <class Number, class T>
void set_by_data_sheet(const Number& number, MagnetParameters<T>& found) {
  const T resistance = number("magnet.resistance"), inductance = number("magnet.inductance");
  const T voltage = number("magnet.supply_voltage"), current = voltage / resistance;
  const T at = number("magnet.hold_current"), share = isnan(at) ? T(1) : current / at;
  found.hold_force = share * share * number("magnet.hold_force");
  found.saturation = number("magnet.saturation");
  found.winding_resistance = resistance;
  found.outer_resistance = number("magnet.release_resistance");
  found.rise_constant = inductance / resistance;
  found.fall_constant = inductance / (resistance + found.outer_resistance);
  found.power = voltage * current;
  found.thermal_resistance = number("magnet.thermal_resistance");
  const T capacity = number("magnet.heat_capacity");
  if (!isnan(capacity)) found.heat_capacity = capacity;
}

/// Electromagnet by the keys of a device file: by its construction, its data sheet, or its hold force and times.
///
/// `number` returns the value of a key, or the usual one; NaN without any.
template <class Number, class T = std::decay_t<std::invoke_result_t<Number, const char*>>>
MagnetParameters<T> magnet_by_keys(const Number& number) {
  const auto given = [&](const char* key) { return !isnan(number(key)); };
  MagnetParameters<T> found{};
  if (given("magnet.turns")) {
    const CoilConstruction<T> coil = construction_by_keys(number);
    found.hold_force = coil.pull();
    found.saturation = coil.saturation();
    found.rise_constant = coil.inductance() / coil.resistance();
    found.fall_constant = coil.inductance() / (coil.resistance() + coil.release_resistance);
    found.winding_resistance = coil.resistance();
    found.outer_resistance = coil.release_resistance;
    found.power = coil.power();
    found.thermal_resistance = number("magnet.thermal_resistance");
    if (given("magnet.heat_capacity")) found.heat_capacity = number("magnet.heat_capacity");
  } else if (given("magnet.resistance")) {
    set_by_data_sheet(number, found);
  } else {
    found.hold_force = number("magnet.hold_force");
    found.saturation = number("magnet.saturation");
    found.rise_constant = rise_constant(number("magnet.rise_time"), found.saturation);
    found.fall_constant = fall_constant(number("magnet.fall_time"), found.saturation);
  }
  found.residual = number("magnet.residual");
  if (given("magnet.lift")) {
    const T gap = number("magnet.gap"), force = number("magnet.closing_force");
    found.open_inductance = gap / (gap + number("magnet.lift"));
    found.closing_flux = closing_flux(found, force);
  }
  if (given("magnet.pwm_frequency")) {
    found.pulse_frequency = number("magnet.pwm_frequency");
    found.pulse_duty = number("magnet.pwm_duty");
  }
  return found;
}

}  // namespace pindrive::device
