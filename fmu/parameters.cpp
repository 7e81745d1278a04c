#include "parameters.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "interface.hpp"
#include "pindrive/device/magnet_construction.hpp"

namespace pindrive_fmu {

namespace {

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

/// The friction of a contact: kinetic friction before static friction, which it sets.
pindrive_error fill_friction(pindrive_drive* drive, const char* contact, const Given& given,
                             Number normal_force, double Number::* part) {
  const bool forces = given.has(Key(contact, by_force.limit).text);
  const Friction& names = forces ? by_force : by_coefficient;
  const Number factor = forces ? Number(1) : normal_force;
  const auto number = [&](const char* name) { return given.of(Key(contact, name).text) * factor; };
  std::vector<double> speeds, values;
  for (const Number speed : given.rows(Key(contact, names.speeds).text))
    speeds.push_back(speed.*part);
  for (const Number value : given.rows(Key(contact, names.values).text))
    values.push_back((value * factor).*part);
  pindrive_error error =
      speeds.empty()
          ? pindrive_drive_set(drive, Key(contact, "kinetic").text, number(names.kinetic).*part)
          : pindrive_drive_set_curve(drive, contact, speeds.data(), values.data(), speeds.size());
  if (!error)
    error = pindrive_drive_set(drive, Key(contact, "static").text, number(names.limit).*part);
  const Key stiffness(contact, "stiffness");
  if (!error && given.has(stiffness.text))
    error = pindrive_drive_set(drive, stiffness.text, given.of(stiffness.text).*part);
  return error;
}

}  // namespace

std::size_t Given::find(const char* name) const {
  std::size_t i = 0;
  while (i < variables_.size() && std::strcmp(variables_[i].name, name) != 0) ++i;
  return i;
}

Number Given::of(const char* name, Number otherwise) const {
  const std::size_t i = find(name);
  return i < variables_.size() ? at(i) : otherwise;
}

std::vector<Number> Given::rows(const char* name) const {
  std::vector<Number> found;
  const std::size_t length = std::strlen(name);
  for (std::size_t i = 0; i < variables_.size(); ++i)
    if (begins(variables_[i].name, name) && variables_[i].name[length] == '[')
      found.push_back(at(i));
  return found;
}

Number Given::plate_normal_force() const {
  return of("drive.mass") * gravity + of("plate.preload");
}

pindrive_error fill(pindrive_drive* drive, pindrive_release* release, const Given& given,
                    double Number::* part) {
  pindrive_error error = fill_friction(drive, "plate", given, given.plate_normal_force(), part);
  if (!error) error = fill_friction(drive, "finger", given, given.of("finger.touch_force"), part);
  for (std::size_t i = 0; i < given.variables().size() && !error; ++i) {
    const Variable& variable = given.variables()[i];
    const char* const name = variable.name;
    const double value = given.at(i).*part;
    if (variable.kind == Variable::input && variable.place % 2 == 0)
      error = pindrive_release_set(release, name, value);
    if (variable.kind != Variable::parameter) continue;
    if (std::strcmp(name, "drive.damping_ratio") == 0)
      error = pindrive_drive_set(
          drive, "damping",
          (2 * given.at(i) * sqrt(given.of("drive.mass")) * sqrt(given.of("drive.stiffness"))).*
              part);
    else if (begins(name, "drive."))
      error = pindrive_drive_set(drive, name + std::strlen("drive."), value);
    else if (begins(name, "motion."))
      error = pindrive_release_set(release, name + std::strlen("motion."), value);
  }
  return error;
}

// ---- electromagnet -----------------------------------------------------------------------------

namespace {

namespace device = pindrive::device;
using pindrive_c::check;
using pindrive_c::fail;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Checks of parameters, until one is refused.
struct Checks {
  const Given& given;
  pindrive_error error{PINDRIVE_OK};

  double number(const char* name, double otherwise = 0) const {
    return given.of(name, otherwise).value;
  }
  void allow(const char* name, double value, bool good, const char* allowed) {
    if (!error) error = check(name, value, good, allowed);
  }
  double positive(const char* name) {
    const double value = number(name);
    allow(name, value, value > 0 && value < infinity, "above 0 and finite");
    return value;
  }
  double not_negative(const char* name) {
    const double value = number(name);
    allow(name, value, value >= 0 && value < infinity, "at least 0 and finite");
    return value;
  }
};

device::MagnetParameters from_coil(Checks& checks, double deviation) {
  const device::CoilConstruction coil{checks.positive("magnet.turns"),
                                      checks.positive("magnet.pole_area"),
                                      checks.positive("magnet.gap"),
                                      checks.positive("magnet.wire_diameter"),
                                      checks.positive("magnet.turn_length"),
                                      checks.positive("magnet.supply_voltage"),
                                      checks.not_negative("magnet.release_resistance"),
                                      checks.positive("magnet.saturation_field")};
  device::MagnetParameters found = coil.magnet(deviation);
  found.thermal_resistance = checks.positive("magnet.thermal_resistance");
  found.heat_capacity = checks.not_negative("magnet.heat_capacity");
  return found;
}

device::MagnetParameters from_times(Checks& checks, double deviation) {
  device::MagnetParameters found{};
  found.saturation = checks.number("magnet.saturation");
  checks.allow("magnet.saturation", found.saturation, found.saturation > 0 && found.saturation <= 1,
               "above 0 and at most 1");
  found.rise_constant =
      device::rise_constant(checks.positive("magnet.rise_time"), found.saturation);
  found.fall_constant =
      device::fall_constant(checks.positive("magnet.fall_time"), found.saturation);
  found.hold_force = checks.positive("magnet.hold_force");
  found.deviation = deviation;
  return found;
}

void read_gap(Checks& checks, device::MagnetParameters& magnet) {
  if (!checks.given.has("magnet.lift")) return;
  const double lift = checks.not_negative("magnet.lift"), gap = checks.number("magnet.gap");
  const double force = checks.number("magnet.closing_force");
  magnet.open_inductance = gap / (gap + lift);
  magnet.closing_flux = device::closing_flux(magnet, force);
  const double open = magnet.open_inductance / magnet.saturation;
  const double most =
      magnet.residual + (magnet.hold_force - magnet.residual) * std::min(open * open, 1.0);
  checks.allow(
      "magnet.closing_force", force,
      force > magnet.residual && force < most && magnet.closing_flux < magnet.open_inductance,
      "more than the residual pull and less than that with the open gap");
}

void read_voltage(Checks& checks, std::vector<device::VoltageStep>& steps) {
  const double full = checks.number("magnet.supply_voltage");
  const auto times = checks.given.rows("magnet.voltage.time");
  const auto volts = checks.given.rows("magnet.voltage.value");
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

Number residual_load(const Given& given) {
  return 1 + given.of("magnet.residual") / given.plate_normal_force();
}

pindrive_error read_magnet(const Given& given,
                           std::unique_ptr<const device::Electromagnet>& magnet) {
  magnet.reset();
  if (!given.has("magnet.residual")) return PINDRIVE_OK;
  Checks checks{given};
  const double deviation = checks.number("magnet.deviation", 1e-4);
  checks.allow("magnet.deviation", deviation, deviation >= 1e-8 && deviation <= 0.1,
               "from 1e-8 to 0.1");
  device::MagnetParameters found =
      given.has("magnet.turns") ? from_coil(checks, deviation) : from_times(checks, deviation);
  found.residual = checks.number("magnet.residual");
  checks.allow("magnet.residual", found.residual,
               found.residual >= 0 && found.residual < found.hold_force,
               "at least 0 and less than the full pull");
  read_gap(checks, found);
  found.pulse_duty = checks.number("magnet.pwm_duty", 1);
  checks.allow("magnet.pwm_duty", found.pulse_duty, found.pulse_duty > 0 && found.pulse_duty <= 1,
               "above 0 and at most 1");
  found.pulse_frequency = checks.number("magnet.pwm_frequency", 1);
  checks.allow("magnet.pwm_frequency", found.pulse_frequency,
               found.pulse_frequency >= 1 && found.pulse_frequency <= 2e4, "from 1 to 20000");
  const double normal_force = given.plate_normal_force().value;
  checks.allow("weight and plate.preload", normal_force,
               normal_force > 0 && normal_force < infinity, "above 0 and finite");
  std::vector<device::VoltageStep> steps;
  if (given.has("magnet.turns")) read_voltage(checks, steps);
  if (!checks.error)
    magnet = std::make_unique<const device::Electromagnet>(found, std::move(steps));
  return checks.error;
}

}  // namespace pindrive_fmu
