/// Inputs of a device by the keys of a device file, and the values they may take: one table for all interfaces.
#pragma once

#include <limits>

namespace pindrive::device {

/// An interval of values, and a single value beside it; NaN: none.
struct Bounds {
  double lower, upper;
  bool lower_closed, upper_closed;
  double also;

  constexpr bool contains(double value) const {
    return (lower < value && value < upper) || (lower_closed && value == lower) ||
           (upper_closed && value == upper) || value == also;
  }
};

/// Values far outside of any device, between which nothing overflows.
enum class Computable : signed char { any, either_way, from_zero, above_zero, ratio };

/// An input, in SI units. A table of its kind needs no relocations.
struct InputQuantity {
  char key[32];
  char unit[8];   ///< "1": dimensionless
  Bounds bounds;  ///< possible values
  Computable computable;
  double absent;  ///< value that holds where a device file leaves the key out; NaN: none

  /// True if the value is allowed.
  constexpr bool allows(double value) const {
    return bounds.contains(value) && computable_bounds().contains(value);
  }
  /// The bounds that a value violates first; null if it is allowed.
  constexpr const Bounds* violated(double value) const {
    return !bounds.contains(value)               ? &bounds
           : computable_bounds().contains(value) ? nullptr
                                                 : &computable_bounds();
  }
  constexpr const Bounds& computable_bounds() const;
};

namespace ranges {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr Bounds between(double lower, double upper) { return {lower, upper, true, true, none}; }

constexpr Bounds finite{-infinity, infinity, false, false, none};
constexpr Bounds positive{0, infinity, false, false, none};
constexpr Bounds non_negative{0, infinity, true, false, none};
constexpr Bounds share{0, 1, false, true, none};

// Inputs of the core stay within 1e12 SI. Then rates, sqrt(k/m) and b/m, stay within 1e24, forces under load
// below 1e24, lengths F/k below 1e36, energies below 1e84, and what the certificate bounds, the fifth derivative
// of a length, below 1e156: in doubles nothing overflows, and nothing that matters vanishes.
// Beyond the ratios the two rates of a mode lie so far apart that a velocity loses four of its digits.
inline constexpr Bounds computable[] = {between(-infinity, infinity),
                                        between(-1e12, 1e12),
                                        between(0, 1e12),
                                        between(1e-12, 1e12),
                                        {1e-11, 1e6, true, true, 0}};
constexpr Computable any = Computable::any, either_way = Computable::either_way,
                     from_zero = Computable::from_zero, above_zero = Computable::above_zero,
                     ratios = Computable::ratio;

inline constexpr InputQuantity input_quantities[] = {
    {"drive.mass", "kg", positive, above_zero, none},
    {"drive.stiffness", "N/m", positive, above_zero, none},
    {"drive.damping", "N*s/m", non_negative, from_zero, none},
    {"drive.damping_ratio", "1", non_negative, ratios, none},
    {"drive.travel", "m", positive, above_zero, none},
    {"drive.stop_stiffness", "N/m", positive, above_zero, none},
    {"drive.stop_damping", "N*s/m", non_negative, from_zero, none},
    {"plate.kinetic", "N", non_negative, from_zero, none},
    {"plate.static", "N", non_negative, from_zero, none},
    {"plate.curve", "N", non_negative, from_zero, none},
    {"plate.coefficient", "1", non_negative, from_zero, none},
    {"plate.static_coefficient", "1", non_negative, from_zero, none},
    {"plate.coefficient_curve", "1", non_negative, from_zero, none},
    {"plate.law", "1", between(0, 3), any, none},
    {"plate.breakaway", "N", non_negative, from_zero, none},
    {"plate.breakaway_coefficient", "1", non_negative, from_zero, none},
    {"plate.stribeck_velocity", "m/s", positive, above_zero, none},
    {"plate.exponent", "1", between(1, 2), any, none},
    {"plate.viscous", "N*s/m", non_negative, from_zero, none},
    {"plate.viscous_coefficient", "s/m", non_negative, from_zero, none},
    {"plate.preload", "N", non_negative, from_zero, 0},
    {"plate.touch_share", "1", between(0, 1), any, 1},
    {"finger.kinetic", "N", non_negative, from_zero, none},
    {"finger.static", "N", non_negative, from_zero, none},
    {"finger.curve", "N", non_negative, from_zero, none},
    {"finger.coefficient", "1", non_negative, from_zero, none},
    {"finger.static_coefficient", "1", non_negative, from_zero, none},
    {"finger.coefficient_curve", "1", non_negative, from_zero, none},
    {"finger.law", "1", between(0, 3), any, none},
    {"finger.breakaway", "N", non_negative, from_zero, none},
    {"finger.breakaway_coefficient", "1", non_negative, from_zero, none},
    {"finger.stribeck_velocity", "m/s", positive, above_zero, none},
    {"finger.exponent", "1", between(1, 2), any, none},
    {"finger.viscous", "N*s/m", non_negative, from_zero, none},
    {"finger.viscous_coefficient", "s/m", non_negative, from_zero, none},
    {"finger.touch_force", "N", non_negative, from_zero, none},
    {"finger.load_exponent", "1", between(0.1, 2), any, 1},
    {"finger.reference_touch", "N", positive, above_zero, none},
    {"finger.stiffness", "N/m", positive, above_zero, none},
    {"finger.damping", "N*s/m", non_negative, from_zero, none},
    {"motion.mouse_velocity", "m/s", finite, either_way, none},
    {"motion.plate_load", "1", non_negative, from_zero, 1},
    {"motion.force", "N", finite, either_way, 0},
    {"motion.across_velocity", "m/s", finite, either_way, 0},
    {"motion.finger_load", "1", non_negative, from_zero, 1},
    {"motion.displacement", "m", finite, either_way, 0},
    {"motion.velocity", "m/s", finite, either_way, none},
    {"motion.skin_stretch", "m", finite, either_way, none},
    {"motion.support", "1", between(0, 1), any, 0},
    {"motion.duration", "s", positive, above_zero, none},
    {"motion.settling_band", "1", share, any, 0.05},
    {"magnet.hold_force", "N", between(1e-6, 10000), any, 1},
    {"magnet.rise_time", "s", between(1e-7, 100), any, 0.003},
    {"magnet.fall_time", "s", between(1e-7, 100), any, 0.005},
    {"magnet.saturation", "1", between(0.001, 1), any, 1},
    {"magnet.residual", "N", between(0, 10000), any, 0},
    {"magnet.pwm_frequency", "Hz", between(1, 20000), any, none},
    {"magnet.pwm_duty", "1", share, any, none},
    {"magnet.outer_diameter", "m", between(1e-6, 1), any, none},
    {"magnet.height", "m", between(1e-6, 1), any, none},
    {"magnet.spring_height", "m", between(0, 1), any, none},
    {"magnet.pin_height", "m", between(0, 1), any, none},
    {"magnet.hold_current", "A", between(1e-9, 1e6), any, none},
    {"magnet.resistance", "ohm", between(1e-6, 1e9), any, none},
    {"magnet.inductance", "H", between(1e-12, 1e6), any, none},
    {"magnet.turns", "1", between(1, 1e6), any, none},
    {"magnet.pole_area", "m^2", between(1e-10, 1), any, none},
    {"magnet.gap", "m", between(1e-9, 0.1), any, none},
    {"magnet.lift", "m", between(0, 0.1), any, none},
    {"magnet.closing_force", "N", between(1e-9, 10000), any, none},
    {"magnet.wire_diameter", "m", between(1e-7, 0.1), any, none},
    {"magnet.turn_length", "m", between(1e-5, 10), any, none},
    {"magnet.supply_voltage", "V", between(0.001, 100000), any, none},
    {"magnet.voltage", "V", between(0, 100000), any, none},
    {"magnet.release_resistance", "ohm", between(0, 1e9), any, 0},
    {"magnet.saturation_field", "T", between(0.001, 100), any, 1.6},
    {"magnet.thermal_resistance", "K/W", between(0.0001, 1e7), any, 430},
    {"magnet.heat_capacity", "J/K", between(1e-7, 1e7), any, none},
    {"magnet.temperature_rise", "K", between(0.01, 1000), any, 20},
    {"control.sample_rate", "Hz", between(0.1, 1e6), any, 1000},
    {"control.latency", "s", between(0, 100), any, 0.005},
    {"control.threshold", "1", between(0, 1), any, 0.5},
    {"control.hysteresis", "1", between(0, 1), any, 0.1},
    {"array.columns", "1", between(1, 1000), any, 1},
    {"array.rows", "1", between(1, 1000), any, 1},
    {"array.pitch", "m", between(1e-6, 1), any, 0.005},
    {"array.pin_diameter", "m", between(1e-6, 1), any, 0.0015},
    {"array.slot_length", "m", between(1e-6, 1), any, none},
    {"array.places", "m", between(-10, 10), any, none},
    {"array.spot_scale", "1", between(0, 1000), any, 1},
    {"array.axis", "rad", between(-12.566370614359172, 12.566370614359172), any, 0},
    {"scan.hand_speed", "m/s", between(0.0001, 100), any, 0.06},
    {"scan.return_speed", "m/s", between(0.0001, 100), any, 0.1},
    {"scan.pause", "s", between(0, 3600), any, 0.2},
    {"scan.touch", "N", non_negative, any, none},
    {"scan.line_pitch", "m", between(1e-5, 10), any, none},
    {"scan.text_height", "m", between(1e-5, 10), any, 0.01},
    {"scan.pixel", "m", between(1e-7, 1), any, none},
    {"scan.max_angle", "rad", between(0, 1.5707963267948966), any, 0.3490658503988659},
    {"scan.hand_acceleration", "m/s^2", between(0.001, 1e6), any, 30},
    {"scan.mouse_resolution", "1/m", between(100, 1e8), any, 39370.07874015748},
    {"scan.smoothing_cutoff", "Hz", between(0.1, 100000), any, 20},
    {"hand.mass", "kg", positive, above_zero, none},
    {"hand.stiffness", "N/m", non_negative, from_zero, 0},
    {"hand.damping", "N*s/m", non_negative, from_zero, 0},
    {"hand.kinetic", "N", non_negative, from_zero, 0},
    {"hand.static", "N", non_negative, from_zero, none},
    {"criteria.felt", "m", between(1e-9, 1), any, 4.5e-5},
    {"criteria.direction", "m", between(1e-9, 1), any, 5e-5},
    {"criteria.direction_sure", "m", between(1e-9, 1), any, 0.0002},
    {"criteria.direction_speed", "m/s", between(1e-9, 1000), any, 0.002},
    {"criteria.false_line", "1", between(1e-6, 1), any, 0.5},
    {"criteria.distinct", "1", between(1e-6, 1), any, 0.25},
};

}  // namespace ranges

using ranges::input_quantities;

/// Names of the friction laws, in the order of their numbers.
inline constexpr const char* law_names[] = {"coulomb", "stribeck", "hess-soom", "table"};

constexpr const Bounds& InputQuantity::computable_bounds() const {
  return ranges::computable[static_cast<int>(computable)];
}

namespace ranges {

constexpr bool same_text(const char* one, const char* other) {
  while (*one != 0 && *one == *other) {
    ++one;
    ++other;
  }
  return *one == *other;
}

}  // namespace ranges

/// The input of a key; null without one.
constexpr const InputQuantity* find_input(const char* key) {
  for (const InputQuantity& input : input_quantities)
    if (ranges::same_text(input.key, key)) return &input;
  return nullptr;
}

}  // namespace pindrive::device
