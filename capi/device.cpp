// The C interface: a device by the keys of a device file.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "contradictions.hpp"
#include "device_parameters.hpp"
#include "interface.hpp"
#include "pindrive.h"
#include "pindrive/device/inputs.hpp"
#include "scan.hpp"

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

/// True if a device has a number of a key. The keys of page and hand are none.
bool has_number(const char* key) {
  const auto in_table = [&](const char* table) {
    return std::strncmp(key, table, std::strlen(table)) == 0;
  };
  return pd::device::find_input(key) &&
         (in_table("drive.") || in_table("plate.") || in_table("finger.") || in_table("magnet.") ||
          in_table("control.") || in_table("criteria.") || std::strcmp(key, "array.axis") == 0);
}

/// Sets the value of a key in a list.
template <class Value>
void put(std::vector<std::pair<std::string, Value>>& list, const char* key, Value value) {
  const auto at =
      std::find_if(list.begin(), list.end(), [&](const auto& each) { return each.first == key; });
  if (at == list.end())
    list.emplace_back(key, std::move(value));
  else
    at->second = std::move(value);
}

/// Parameters of a device; `names` keeps the keys of its rows.
DeviceParameters parameters_of(const pindrive_device& device, std::vector<std::string>& names) {
  DeviceParameters found;
  for (const auto& [key, value] : device.numbers) found.add(key.c_str(), value);
  std::size_t count = 0;
  for (const auto& [key, rows] : device.rows) count += 2 * rows.size();
  names.reserve(count);  // the parameters refer to them
  for (const RowsKey& of : keys_of_rows)
    for (const auto& [key, rows] : device.rows)
      for (std::size_t i = 0; key == of.key && i < rows.size(); ++i)
        for (const auto& [column, value] :
             {std::pair(of.first, rows[i].first), std::pair(of.second, rows[i].second)}) {
          names.push_back(key + "." + column + "[" + std::to_string(i + 1) + "]");
          found.add(names.back().c_str(), value);
        }
  static constexpr const char pull[] = "magnet.hold_force";  // kept by reference
  if (!found.has(pull) && !found.has("magnet.turns"))
    found.add(pull, pd::device::find_input(pull)->absent);
  return found;
}

}  // namespace

pindrive_error pindrive_c::made_of(const pindrive_device& device,
                                   std::shared_ptr<const OwnedDevice>& made) {
  std::vector<std::string> names;
  const DeviceParameters parameters = parameters_of(device, names);
  pindrive_drive drive;
  pindrive_error error = parameters.check(true);
  if (!error) error = parameters.fill(&drive, &DeviceParameters::Number::value);
  if (!error) error = check(drive, pindrive_release());
  if (!error && drive.plate.kinetic == 0)
    error = fail(PINDRIVE_BAD_VALUE, "plate.kinetic must be given, as a magnet holds by friction");
  if (error) return error;
  const auto number = [&](const char* key) { return parameters.number(key); };
  const pd::device::Criteria criteria{
      number("criteria.felt"),           number("criteria.direction"),
      number("criteria.direction_sure"), number("criteria.direction_speed"),
      number("criteria.false_line"),     number("criteria.distinct")};
  const pd::OwnedContact<double> plate(drive.plate, drive.plate),
      finger(drive.finger, drive.finger);
  const auto owned = std::make_shared<OwnedDevice>(
      OwnedDevice{plate, finger,
                  pd::device::Device{
                      {},
                      {parameters.pressing().normal_force.value, parameters.pressing().touch.value},
                      parameters.number("finger.load_exponent"),
                      *parameters.magnet(),
                      parameters.controller(),
                      pd::device::Axis(number("array.axis")),
                      device.spots},
                  criteria});
  owned->plate.contact.curve = owned->plate.branches.data();
  owned->finger.contact.curve = owned->finger.branches.data();
  owned->device.drive = {drive.mass,           drive.stiffness,       drive.damping,
                         owned->plate.contact, owned->finger.contact, {}};
  owned->device.drive.stops = pd::stops<double>(drive.stops, drive.stops);
  made = owned;
  return PINDRIVE_OK;
}

extern "C" {

size_t pindrive_check_values(const pindrive_given* given, size_t count, int whole, char* text,
                             size_t size) {
  std::size_t found = 0;
  if (text && size > 0) *text = 0;
  guarded([&]() -> pindrive_error {
    std::size_t used = 0;
    for (const Problem& problem : problems_of(given, count, whole != 0)) {
      const char* const between = found++ == 0 ? "" : "\n";
      if (!text || used >= size) continue;
      char* const end = text + used;
      used += static_cast<std::size_t>(std::snprintf(end, size - used, "%s%s%s must be %s, got %s",
                                                     between, problem.key, problem.part.get(),
                                                     problem.required.get(), problem.given.get()));
      if (used >= size) *end = 0;  // no part of a line
    }
    return PINDRIVE_OK;
  });
  return found;
}

void pindrive_direction(double angle, double* x, double* y) {
  const pd::device::Vector direction = pd::device::Axis(angle).direction();
  *x = direction.x;
  *y = direction.y;
}

pindrive_device* pindrive_device_new(void) {
  pindrive_device* device = nullptr;
  guarded([&]() -> pindrive_error {
    device = new pindrive_device;
    return PINDRIVE_OK;
  });
  return device;
}
void pindrive_device_free(pindrive_device* device) { delete device; }

pindrive_error pindrive_device_set(pindrive_device* device, const char* key, double value) {
  if (!device) return null_pointer("device");
  if (!key) return null_pointer("key");
  if (!has_number(key))
    return fail(PINDRIVE_BAD_NAME, "a device has no number %.40s; its keys are those of pindrive.h",
                key);
  return guarded([&]() -> pindrive_error {
    put(device->numbers, key, value);
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_device_set_rows(pindrive_device* device, const char* key,
                                        const double* first, const double* second, size_t count) {
  if (!device) return null_pointer("device");
  if (!key) return null_pointer("key");
  if (count > 0 && (!first || !second)) return null_pointer("first and second");
  if (std::none_of(std::begin(keys_of_rows), std::end(keys_of_rows),
                   [&](const RowsKey& each) { return std::strcmp(each.key, key) == 0; }))
    return fail(PINDRIVE_BAD_NAME,
                "a device has no rows %.40s, but plate.curve, plate.coefficient_curve, "
                "finger.curve, finger.coefficient_curve, magnet.voltage",
                key);
  return guarded([&]() -> pindrive_error {
    pd::Rows rows;
    for (std::size_t i = 0; i < count; ++i) rows.emplace_back(first[i], second[i]);
    put(device->rows, key, std::move(rows));
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_device_set_pins(pindrive_device* device, const double* x, const double* y,
                                        size_t count) {
  if (!device) return null_pointer("device");
  if (!x || !y) return null_pointer("x and y");
  if (count == 0) return fail(PINDRIVE_BAD_VALUE, "a device must have at least one pin, not 0");
  for (std::size_t i = 0; i < count; ++i)
    if (const bool near = std::abs(x[i]) <= 10 && std::abs(y[i]) <= 10; !near)
      return fail(PINDRIVE_BAD_VALUE, "pin %zu must be from -10 m to 10 m, not at %.17g, %.17g", i,
                  x[i], y[i]);
  return guarded([&]() -> pindrive_error {
    std::vector<pd::device::Place> spots;
    spots.reserve(count);
    for (std::size_t i = 0; i < count; ++i) spots.push_back({x[i], y[i]});
    device->spots = std::move(spots);
    return PINDRIVE_OK;
  });
}

}  // extern "C"
