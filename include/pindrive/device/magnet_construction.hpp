/// Parameters of an electromagnet from its construction, or from the times of its pull.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/device/electromagnet.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive::device {

/// Construction of an electromagnet with two poles on a steel plate, SI. The iron has no reluctance up to
/// the saturation field, and no flux leaks (Fitzgerald, Kingsley and Umans, "Electric Machinery",
/// chapters 1 and 3).
struct CoilConstruction {
  double turns, pole_area, gap, wire_diameter, turn_length, supply_voltage;
  double release_resistance;  ///< of the decay path beside the winding, ohm
  double saturation_field;    ///< T

  /// Construction by the keys of a device file; `number` returns the value of a key.
  template <class Number>
  static CoilConstruction of(Number&& number) {
    return {number("magnet.turns"),
            number("magnet.pole_area"),
            number("magnet.gap"),
            number("magnet.wire_diameter"),
            number("magnet.turn_length"),
            number("magnet.supply_voltage"),
            number("magnet.release_resistance"),
            number("magnet.saturation_field")};
  }

  static constexpr double pi = 0x1.921fb54442d18p+1;
  static constexpr double magnetic_constant = 1.25663706127e-6;  ///< N/A², CODATA 2022
  static constexpr double copper = 1 / 58e6;  ///< resistivity at 20 °C, ohm m (IEC 60028)

  /// Resistance of the winding at 20 °C, ohm.
  double resistance() const {
    return copper * turns * turn_length / (pi / 4 * wire_diameter * wire_diameter);
  }
  /// Inductance with the closed gap, H.
  double inductance() const { return magnetic_constant * turns * turns * pole_area / (2 * gap); }
  /// Full current, A.
  double current() const { return supply_voltage / resistance(); }
  /// Field in the gap at full current if the iron did not saturate, T.
  double field() const { return magnetic_constant * turns * current() / (2 * gap); }
  /// Part of the full current at which the iron saturates, at most 1.
  double saturation() const { return std::min(1.0, saturation_field / field()); }
  /// Pull at full current or saturation, N.
  double pull() const {
    const double reached = std::min(field(), saturation_field);
    return reached * reached * pole_area / magnetic_constant;
  }
  double power() const { return supply_voltage * current(); }  ///< at full current, W

  /// Electromagnet without a residual pull, a temperature or a lift.
  MagnetParameters<double> magnet() const {
    MagnetParameters<double> found{};
    found.hold_force = pull();
    found.saturation = saturation();
    found.rise_constant = inductance() / resistance();
    found.fall_constant = inductance() / (resistance() + release_resistance);
    found.winding_resistance = resistance();
    found.outer_resistance = release_resistance;
    found.power = power();
    return found;
  }
};

/// Time constants of a flux whose pull reaches 90 % of the hold force, and falls to 10 %, after a time.
inline double rise_constant(double rise_time, double saturation) {
  return -rise_time / detail::log(1 - saturation * std::sqrt(0.9));
}
inline double fall_constant(double fall_time, double saturation) {
  return -fall_time / detail::log(saturation * std::sqrt(0.1));
}

/// Flux linkage at which the gap of a magnet closes against a force (N).
inline double closing_flux(const MagnetParameters<double>& magnet, double force) {
  return magnet.saturation *
         std::sqrt((force - magnet.residual) / (magnet.hold_force - magnet.residual));
}

}  // namespace pindrive::device
