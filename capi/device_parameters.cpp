// Parameters of a device by the keys of a device file.
#include "device_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "interface.hpp"
#include "pindrive/device/inputs.hpp"
#include "pindrive/device/magnet_construction.hpp"
#include "wording.hpp"

namespace pindrive_c {

namespace {

namespace device = pindrive::device;

constexpr double gravity = 9.80665;  // m/s^2, as in the Python package

bool begins(const char* text, const char* with) {
  return std::strncmp(text, with, std::strlen(with)) == 0;
}

/// A key of a contact, "plate.kinetic".
struct Key {
  Key(const char* contact, const char* name) {
    std::snprintf(text, sizeof text, "%s.%s", contact, name);
  }
  char text[48];
};

/// Setters of a contact: each force, or the coefficient of a force.
struct Friction {
  const char *kinetic, *limit, *speeds, *values;
};
constexpr Friction by_force = {"kinetic", "static", "curve.speed", "curve.force"};
constexpr Friction by_coefficient = {"coefficient", "static_coefficient", "coefficient_curve.speed",
                                     "coefficient_curve.coefficient"};
// The magnet by its behaviour, or by its construction.
constexpr const char* by_times[] = {"hold_force", "rise_time", "fall_time", "saturation"};
constexpr const char* by_coil[] = {"turns",
                                   "pole_area",
                                   "gap",
                                   "wire_diameter",
                                   "turn_length",
                                   "supply_voltage",
                                   "release_resistance",
                                   "saturation_field",
                                   "thermal_resistance",
                                   "heat_capacity",
                                   "lift",
                                   "closing_force"};

}  // namespace

using Number = DeviceParameters::Number;

std::size_t DeviceParameters::find(const char* key) const {
  std::size_t i = 0;
  while (i < rows_.size() && std::strcmp(rows_[i].first, key) != 0) ++i;
  return i;
}

Number DeviceParameters::of(const char* key, Number otherwise) const {
  const std::size_t i = find(key);
  return i < rows_.size() ? rows_[i].second : otherwise;
}

std::vector<Number> DeviceParameters::list(const char* key) const {
  std::vector<Number> found;
  for (const auto& [name, value] : rows_)
    if (begins(name, key) && name[std::strlen(key)] == '[') found.push_back(value);
  return found;
}

Number DeviceParameters::plate_normal_force() const {
  return of("drive.mass") * gravity + of("plate.preload");
}

Number DeviceParameters::residual_load() const {
  return 1 + of("magnet.residual") / plate_normal_force();
}

/// Sets the friction of a contact: kinetic friction before static friction, which it sets.
pindrive_error DeviceParameters::fill_friction(pindrive_drive* drive, const char* contact,
                                               Number normal_force, double Number::* part) const {
  const bool coefficients = has(Key(contact, by_coefficient.kinetic).text) ||
                            has(Key(contact, by_coefficient.limit).text) ||
                            !list(Key(contact, by_coefficient.speeds).text).empty();
  const Friction& names = coefficients ? by_coefficient : by_force;
  const Number factor = coefficients ? normal_force : Number(1);
  std::vector<double> speeds, values;
  for (const Number speed : list(Key(contact, names.speeds).text)) speeds.push_back(speed.*part);
  for (const Number value : list(Key(contact, names.values).text))
    values.push_back((value * factor).*part);
  const Number kinetic = of(Key(contact, names.kinetic).text) * factor;
  pindrive_error error =
      speeds.empty()
          ? pindrive_drive_set(drive, Key(contact, "kinetic").text, kinetic.*part)
          : pindrive_drive_set_curve(drive, contact, speeds.data(), values.data(), speeds.size());
  const Key limit(contact, names.limit), stiffness(contact, "stiffness");
  if (!error && has(limit.text))
    error = pindrive_drive_set(drive, Key(contact, "static").text, (of(limit.text) * factor).*part);
  if (!error && has(stiffness.text))
    error = pindrive_drive_set(drive, stiffness.text, of(stiffness.text).*part);
  return error;
}

pindrive_error DeviceParameters::check_together() const {
  const auto refused = [](const char* key, const char* required, const char* given) {
    return fail(PINDRIVE_BAD_VALUE, "%s must be %s, got %s", key, required, given);
  };
  const auto shown = [&](const char* key) {
    Text given;
    given.add_number(of(key).value, unit_of(*device::find_input(key)));
    return given;
  };
  for (const char* const contact : {"plate", "finger"}) {
    const char* const forces[] = {"kinetic", "static", "curve"};
    const char* const coefficients[] = {"coefficient", "static_coefficient", "coefficient_curve"};
    const auto first = [&](const char* const(&names)[3]) -> const char* {
      for (const char* const name : names) {
        const Key key(contact, name);
        if (has(key.text) || !list(Key(key.text, "speed").text).empty()) return name;
      }
      return nullptr;
    };
    const char *const force = first(forces), *const coefficient = first(coefficients);
    const bool by_coefficient = coefficient != nullptr;
    if (force && coefficient)
      return fail(PINDRIVE_BAD_VALUE,
                  "%s.%s must be left out where %s.%s gives the friction as a force, got both, "
                  "%s.%s and %s.%s",
                  contact, coefficient, contact, force, contact, coefficient, contact, force);
    const Key limit(contact, by_coefficient ? "static_coefficient" : "static");
    const Key kinetic(contact, by_coefficient ? "coefficient" : "kinetic");
    if (has(limit.text) && has(kinetic.text))
      if (const pindrive_error error = pindrive_c::check(
              limit.text, of(limit.text).value, of(limit.text).value >= of(kinetic.text).value,
              by_coefficient ? "at least the kinetic friction coefficient"
                             : "at least the kinetic friction",
              of(kinetic.text).value, unit_of(*device::find_input(limit.text))))
        return error;
    if (std::strcmp(contact, "plate") == 0) continue;
    constexpr const char touch[] = "finger.touch_force";
    if (by_coefficient && !has(touch))
      return refused(touch, "given where a coefficient gives the finger's friction", "none");
    if (force && has(touch))
      return refused(touch, "left out where the finger's friction is given as a force",
                     shown(touch).get());
  }
  for (const char* const key : {"drive.stop_stiffness", "drive.stop_damping"})
    if (has(key) && !has("drive.travel"))
      return refused(key, "left out without travel, as there are no end stops", shown(key).get());
  if (of("drive.stop_damping").value != 0 && !has("drive.stop_stiffness"))
    return refused("drive.stop_damping", "left out for rigid end stops; give stop_stiffness too",
                   shown("drive.stop_damping").get());
  const auto first_of_magnet = [&](const auto& names) -> const char* {
    for (const char* const name : names)
      if (has(Key("magnet", name).text)) return name;
    return nullptr;
  };
  const char *const direct = first_of_magnet(by_times), *const made = first_of_magnet(by_coil);
  if (direct && made)
    return fail(PINDRIVE_BAD_VALUE,
                "magnet.%s must be left out where %s describes the coil, got both, %s and %s",
                direct, made, direct, made);
  const bool lift = has("magnet.lift"), closing = has("magnet.closing_force");
  if (lift != closing)
    return refused(lift ? "magnet.lift" : "magnet.closing_force",
                   lift ? "given with closing_force" : "given with lift", "it alone");
  return PINDRIVE_OK;
}

pindrive_error DeviceParameters::fill(pindrive_drive* drive, double Number::* part) const {
  pindrive_error error = PINDRIVE_OK;
  constexpr const char table[] = "drive.";
  for (const auto& [key, value] : rows_) {
    const device::InputQuantity* const input = device::find_input(key);
    if (!error && input && part == &Number::value) error = check(key, *input, value.value);
    if (error || !begins(key, table)) continue;
    if (std::strcmp(key, "drive.damping_ratio") == 0)
      error = pindrive_drive_set(
          drive, "damping",
          (2 * value * sqrt(of("drive.mass")) * sqrt(of("drive.stiffness"))).*part);
    else
      error = pindrive_drive_set(drive, key + std::strlen(table), value.*part);
  }
  if (!error) error = fill_friction(drive, "plate", plate_normal_force(), part);
  if (!error) error = fill_friction(drive, "finger", of("finger.touch_force"), part);
  return error;
}

// ---- electromagnet -----------------------------------------------------------------------------

namespace {

/// Checked parameters, until one is refused.
struct Checks {
  const DeviceParameters& given;
  pindrive_error error{PINDRIVE_OK};

  /// Value of a key, or the one that holds without the key.
  double number(const char* key) {
    const device::InputQuantity& input = *device::find_input(key);
    const double value = given.of(key, input.absent).value;
    if (!error && !given.has(key) && std::isnan(value))
      error = fail(PINDRIVE_BAD_VALUE, "%s must be given", key);
    if (!error) error = check(key, input, value);
    return value;
  }
  double number_or(const char* key, double otherwise) {
    return given.has(key) ? number(key) : otherwise;
  }
  void allow(const char* name, double value, bool good, const char* allowed) {
    if (!error) error = check(name, value, good, allowed);
  }
};

device::MagnetParameters from_coil(Checks& checks, double deviation) {
  const device::CoilConstruction coil{checks.number("magnet.turns"),
                                      checks.number("magnet.pole_area"),
                                      checks.number("magnet.gap"),
                                      checks.number("magnet.wire_diameter"),
                                      checks.number("magnet.turn_length"),
                                      checks.number("magnet.supply_voltage"),
                                      checks.number("magnet.release_resistance"),
                                      checks.number("magnet.saturation_field")};
  device::MagnetParameters found = coil.magnet(deviation);
  found.thermal_resistance = checks.number("magnet.thermal_resistance");
  found.heat_capacity = checks.number_or("magnet.heat_capacity", 0);
  return found;
}

device::MagnetParameters from_times(Checks& checks, double deviation) {
  device::MagnetParameters found{};
  found.saturation = checks.number("magnet.saturation");
  found.rise_constant = device::rise_constant(checks.number("magnet.rise_time"), found.saturation);
  found.fall_constant = device::fall_constant(checks.number("magnet.fall_time"), found.saturation);
  found.hold_force = checks.number("magnet.hold_force");
  found.deviation = deviation;
  return found;
}

void read_gap(Checks& checks, device::MagnetParameters& magnet) {
  if (!checks.given.has("magnet.lift")) return;
  const double lift = checks.number("magnet.lift"), gap = checks.number("magnet.gap");
  const double force = checks.number("magnet.closing_force");
  magnet.open_inductance = gap / (gap + lift);
  magnet.closing_flux = device::closing_flux(magnet, force);
  const double open = magnet.open_inductance / magnet.saturation;
  const double most =
      magnet.residual + (magnet.hold_force - magnet.residual) * std::min(open * open, 1.0);
  if (!checks.error)
    checks.error = check("magnet.closing_force", force, force > magnet.residual,
                         "more than the residual pull", magnet.residual, "N");
  if (!checks.error)
    checks.error = check("magnet.closing_force", force,
                         force < most && magnet.closing_flux < magnet.open_inductance,
                         "less than the pull of full current with the open gap", most, "N");
}

void read_voltage(Checks& checks, std::vector<device::VoltageStep>& steps) {
  const double full = checks.number("magnet.supply_voltage");
  const auto times = checks.given.list("magnet.voltage.time");
  const auto volts = checks.given.list("magnet.voltage.value");
  for (std::size_t i = 0; i < times.size() && !checks.error; ++i) {
    const device::VoltageStep step{times[i].value, volts[i].value / full};
    const bool later = i == 0 ? step.time == 0 : step.time > steps[i - 1].time;
    const bool within = step.level >= 0 && step.level <= 1;
    if (!later || !within)
      checks.error = fail(
          PINDRIVE_BAD_VALUE,
          "magnet.voltage must begin at 0 s, its times increase, and be from 0 V to %.17g V", full);
    steps.push_back(step);
  }
}

}  // namespace

pindrive_error DeviceParameters::read(std::unique_ptr<const device::Electromagnet>& magnet) const {
  magnet.reset();
  if (!has("magnet.hold_force") && !has("magnet.turns")) return PINDRIVE_OK;
  Checks checks{*this};
  const double deviation = checks.number("magnet.deviation");
  device::MagnetParameters found =
      has("magnet.turns") ? from_coil(checks, deviation) : from_times(checks, deviation);
  found.residual = checks.number("magnet.residual");
  if (!checks.error)
    checks.error = check("magnet.residual", found.residual, found.residual < found.hold_force,
                         "less than the hold force", found.hold_force, "N");
  if (const bool frequency = has("magnet.pwm_frequency"), duty = has("magnet.pwm_duty");
      !checks.error && frequency != duty)
    checks.error =
        fail(PINDRIVE_BAD_VALUE, "magnet.%s must be given with %s, got it alone",
             frequency ? "pwm_frequency" : "pwm_duty", frequency ? "pwm_duty" : "pwm_frequency");
  read_gap(checks, found);
  found.pulse_duty = checks.number_or("magnet.pwm_duty", 1);
  found.pulse_frequency = checks.number_or("magnet.pwm_frequency", 1);
  checks.number("plate.preload");
  const double normal_force = plate_normal_force().value;
  checks.allow("weight and plate.preload", normal_force,
               normal_force > 0 && normal_force < infinity, "above 0 and finite");
  std::vector<device::VoltageStep> steps;
  if (has("magnet.turns")) read_voltage(checks, steps);
  if (!checks.error)
    magnet = std::make_unique<const device::Electromagnet>(found, std::move(steps));
  return checks.error;
}

pindrive_error DeviceParameters::read(device::Controller& controller) const {
  Checks checks{*this};
  controller = {checks.number("control.sample_rate"), checks.number("control.latency"),
                checks.number("control.threshold"), checks.number("control.hysteresis")};
  const double threshold = controller.threshold, band = controller.hysteresis;
  const double widest = 2 * std::min(threshold, 1 - threshold);
  if (!checks.error && band > widest) {
    Text given;
    given.add_number(band);
    checks.error = fail(PINDRIVE_BAD_VALUE,
                        "control.hysteresis must be at most %g about a threshold of %g, got %s",
                        widest, threshold, given.get());
  }
  return checks.error;
}

}  // namespace pindrive_c
