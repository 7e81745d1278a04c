/// Parameters of a device by the keys of a device file, and what they describe.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "pindrive.h"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/electromagnet.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pindrive_c {

/// Values by key in SI units, with their derivatives along a direction. Keeps the keys by reference.
class DeviceParameters {
 public:
  using Number = pindrive::Dual<double>;

  void add(const char* key, Number value) { rows_.push_back({key, value}); }

  bool has(const char* key) const { return find(key) < rows_.size(); }
  /// Value of a key; `otherwise` without one.
  Number of(const char* key, Number otherwise = 0) const;
  /// Values of "key[1]", "key[2]" …
  std::vector<Number> list(const char* key) const;

  /// Normal force of the magnet on the plate without pull, N: weight and preload.
  Number plate_normal_force() const;
  /// Plate load without a current: that of the residual pull.
  Number residual_load() const;

  /// Checks that the parameters, each in its range, do not contradict each other.
  pindrive_error check_together() const;
  /// Sets the numbers of a drive, or, by `part`, their derivatives.
  pindrive_error fill(pindrive_drive* drive, double Number::* part) const;
  /// Reads the electromagnet; null without one. Refused where a parameter is out of its range.
  pindrive_error read(std::unique_ptr<const pindrive::device::Electromagnet>& magnet) const;
  pindrive_error read(pindrive::device::Controller& controller) const;

 private:
  std::size_t find(const char* key) const;
  pindrive_error fill_friction(pindrive_drive* drive, const char* contact, Number normal_force,
                               double Number::* part) const;

  std::vector<std::pair<const char*, Number>> rows_;
};

}  // namespace pindrive_c
