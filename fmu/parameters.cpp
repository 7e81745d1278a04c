#include "parameters.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "interface.hpp"

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

}  // namespace pindrive_fmu
