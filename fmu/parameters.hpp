/// The parameters of a unit, by the keys of a device file, and the drive and release that they describe.
#pragma once

#include <memory>
#include <vector>

#include "pindrive.h"
#include "pindrive/device/electromagnet.hpp"
#include "pindrive/numbers/dual.hpp"
#include "variables.hpp"

namespace pindrive_fmu {

using Number = pindrive::Dual<double>;

/// The values of all variables, with how they change along a direction.
class Given {
 public:
  /// `seeds` may be null: nothing changes then. All are kept by the caller.
  Given(const std::vector<Variable>& variables, const double* values, const double* seeds)
      : variables_(variables), values_(values), seeds_(seeds) {}

  const std::vector<Variable>& variables() const { return variables_; }
  Number at(std::size_t i) const { return {values_[i], seeds_ ? seeds_[i] : 0}; }
  bool has(const char* name) const { return find(name) < variables_.size(); }
  /// Value of a name; `otherwise` if the name is unknown.
  Number of(const char* name, Number otherwise = 0) const;
  /// Values of "name[1]", "name[2]" …
  std::vector<Number> rows(const char* name) const;

  /// Normal force of the magnet on the plate without pull, N: weight and preload.
  Number plate_normal_force() const;

 private:
  std::size_t find(const char* name) const;

  const std::vector<Variable>& variables_;
  const double* values_;
  const double* seeds_;
};

struct FreeDrive {
  void operator()(pindrive_drive* drive) const { pindrive_drive_free(drive); }
};
struct FreeRelease {
  void operator()(pindrive_release* release) const { pindrive_release_free(release); }
};
using Drive = std::unique_ptr<pindrive_drive, FreeDrive>;
using Release = std::unique_ptr<pindrive_release, FreeRelease>;

/// Reads the electromagnet of a unit; null without one. Refused where a parameter is out of its range.
pindrive_error read_magnet(const Given& given,
                           std::unique_ptr<const pindrive::device::Electromagnet>& magnet);

/// Plate load without a current: that of the residual pull.
Number residual_load(const Given& given);

/// Gives a drive and a release what is given, or, by `part`, how that changes.
pindrive_error fill(pindrive_drive* drive, pindrive_release* release, const Given& given,
                    double Number::* part);

}  // namespace pindrive_fmu
