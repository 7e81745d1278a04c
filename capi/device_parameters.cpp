// Parameters of a device by the keys of a device file.
#include "device_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "contradictions.hpp"
#include "interface.hpp"
#include "pindrive/device/inputs.hpp"
#include "pindrive/device/magnet_construction.hpp"

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
  const char *kinetic, *limit, *speeds, *values, *breakaway, *viscous;
};
constexpr Friction by_force = {"kinetic",     "static",    "curve.speed",
                               "curve.force", "breakaway", "viscous"};
constexpr Friction by_coefficient = {"coefficient",
                                     "static_coefficient",
                                     "coefficient_curve.speed",
                                     "coefficient_curve.coefficient",
                                     "breakaway_coefficient",
                                     "viscous_coefficient"};

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

double DeviceParameters::number(const char* key) const {
  return of(key, device::find_input(key)->absent).value;
}

std::vector<Number> DeviceParameters::list(const char* key) const {
  std::vector<Number> found;
  for (const auto& [name, value] : rows_)
    if (begins(name, key) && name[std::strlen(key)] == '[') found.push_back(value);
  return found;
}

device::Pressing<Number> DeviceParameters::pressing() const {
  const Number touch = of("plate.touch_share", 1) * of("finger.touch_force");
  return {of("drive.mass") * gravity + of("plate.preload") + touch, touch};
}

/// The touch force N by which coefficients are multiplied, N: N₀ (N/N₀)ⁿ.
Number DeviceParameters::finger_normal_force() const {
  const Number touch = of("finger.touch_force"), exponent = of("finger.load_exponent", 1);
  const Number reference = of("finger.reference_touch", touch);
  if (vanishes(exponent - 1) || touch == 0) return touch;
  return reference * exp(exponent * log(touch / reference));
}

Number DeviceParameters::residual_load() const {
  return 1 + of("magnet.residual") / pressing().normal_force;
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
  const auto set = [&](const char* name, const char* as, Number times) {
    const Key key(contact, name);
    if (!error && has(key.text))
      error = pindrive_drive_set(drive, Key(contact, as).text, (of(key.text) * times).*part);
  };
  set("law", "law", 1);
  set(names.breakaway, "breakaway", factor);
  set("stribeck_velocity", "stribeck_velocity", 1);
  set("exponent", "exponent", 1);
  set(names.viscous, "viscous", factor);
  set(names.limit, "static", factor);
  set("stiffness", "stiffness", 1);
  set("damping", "damping", 1);
  set("load_exponent", "load_exponent", 1);
  return error;
}

pindrive_error DeviceParameters::check(bool whole) const {
  std::vector<pindrive_given> given;
  std::vector<double> numbers;
  numbers.reserve(rows_.size());
  for (const auto& [key, value] : rows_)
    if (!std::strchr(key, '[')) {
      numbers.push_back(value.value);
      given.push_back({key, &numbers.back(), 0});
    }
  for (const RowsKey& of : keys_of_rows) {
    const std::vector<Number> first = list(Key(of.key, of.first).text),
                              second = list(Key(of.key, of.second).text);
    if (first.empty()) continue;
    const double* const rows = numbers.data() + numbers.size();
    for (std::size_t i = 0; i < first.size(); ++i) {
      numbers.push_back(first[i].value);
      numbers.push_back(second[i].value);
    }
    given.push_back({of.key, rows, first.size()});
  }
  const std::vector<Problem> problems = problems_of(given.data(), given.size(), whole);
  if (problems.empty()) return PINDRIVE_OK;
  const Problem& first = problems.front();
  return fail(PINDRIVE_BAD_VALUE, "%s%s must be %s, got %s", first.key, first.part.get(),
              first.required.get(), first.given.get());
}

pindrive_error DeviceParameters::fill(pindrive_drive* drive, double Number::* part) const {
  pindrive_error error = PINDRIVE_OK;
  constexpr const char table[] = "drive.";
  for (const auto& [key, value] : rows_) {
    if (error || !begins(key, table)) continue;
    if (std::strcmp(key, "drive.damping_ratio") == 0)
      error = pindrive_drive_set(
          drive, "damping",
          (2 * value * sqrt(of("drive.mass")) * sqrt(of("drive.stiffness"))).*part);
    else
      error = pindrive_drive_set(drive, key + std::strlen(table), value.*part);
  }
  if (!error) error = fill_friction(drive, "plate", pressing().normal_force, part);
  if (!error) error = fill_friction(drive, "finger", finger_normal_force(), part);
  return error;
}

// ---- electromagnet -----------------------------------------------------------------------------

std::unique_ptr<const device::Electromagnet<double>> DeviceParameters::magnet() const {
  if (!has_magnet()) return nullptr;
  const auto found = device::magnet_by_keys([&](const char* key) { return number(key); });
  std::vector<device::VoltageStep<double>> steps;
  const auto times = list("magnet.voltage.time"), volts = list("magnet.voltage.value");
  steps.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    steps.push_back({times[i].value, volts[i].value / number("magnet.supply_voltage")});
  return std::make_unique<const device::Electromagnet<double>>(found, std::move(steps));
}

device::Controller DeviceParameters::controller() const {
  return {number("control.sample_rate"), number("control.latency"), number("control.threshold"),
          number("control.hysteresis")};
}

}  // namespace pindrive_c
