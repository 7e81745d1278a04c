/// Parameters of a device by the keys of a device file, and what they describe.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "pindrive.h"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/electromagnet.hpp"
#include "pindrive/device/pressing.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pindrive_c {

/// Key of rows, with the names of both columns: "plate.curve.speed[1]", "plate.curve.force[1]".
struct RowsKey {
  const char *key, *first, *second;
};
inline constexpr RowsKey keys_of_rows[] = {{"plate.curve", "speed", "force"},
                                           {"plate.coefficient_curve", "speed", "coefficient"},
                                           {"finger.curve", "speed", "force"},
                                           {"finger.coefficient_curve", "speed", "coefficient"},
                                           {"magnet.voltage", "time", "value"}};

/// Values by key in SI units, with their derivatives along a direction. Keeps the keys by reference.
class DeviceParameters {
 public:
  using Number = pindrive::Dual<double>;

  void add(const char* key, Number value) { rows_.push_back({key, value}); }

  bool has(const char* key) const { return find(key) < rows_.size(); }
  /// Value of a key; `otherwise` without one.
  Number of(const char* key, Number otherwise = 0) const;
  /// Value of a key, or the usual one; NaN without any.
  double number(const char* key) const;
  /// Values of "key[1]", "key[2]" …
  std::vector<Number> list(const char* key) const;

  /// What presses the magnet on the plate without pull: weight, preload and a share of the touch.
  pindrive::device::Pressing<Number> pressing() const;
  Number finger_normal_force() const;
  /// Plate load without a current: that of the residual pull.
  Number residual_load() const;

  /// Checks the parameters, each by itself and together; `whole`: as those of a device with a magnet.
  pindrive_error check(bool whole) const;
  /// Sets the numbers of a drive, or, by `part`, their derivatives.
  pindrive_error fill(pindrive_drive* drive, double Number::* part) const;
  bool has_magnet() const { return has("magnet.hold_force") || has("magnet.turns"); }
  /// The electromagnet of checked parameters, and the control block.
  std::unique_ptr<const pindrive::device::Electromagnet<double>> magnet() const;
  pindrive::device::Controller controller() const;

 private:
  std::size_t find(const char* key) const;
  pindrive_error fill_friction(pindrive_drive* drive, const char* contact, Number normal_force,
                               double Number::* part) const;

  std::vector<std::pair<const char*, Number>> rows_;
};

}  // namespace pindrive_c
