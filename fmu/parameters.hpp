/// Values of the variables of a unit, and the drive and release that they describe.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "device_parameters.hpp"
#include "pindrive.h"
#include "pindrive/model/named_function.hpp"
#include "variables.hpp"

namespace pindrive_fmu {

using Number = pindrive_c::DeviceParameters::Number;

struct FreeDrive {
  void operator()(pindrive_drive* drive) const { pindrive_drive_free(drive); }
};
struct FreeRelease {
  void operator()(pindrive_release* release) const { pindrive_release_free(release); }
};
using Drive = std::unique_ptr<pindrive_drive, FreeDrive>;
using Release = std::unique_ptr<pindrive_release, FreeRelease>;

/// Values of all variables, with their derivatives along a direction.
class Given {
 public:
  /// `seeds` may be null: nothing changes then. All are kept by the caller.
  Given(const std::vector<Variable>& variables, const double* values, const double* seeds);

  const pindrive_c::DeviceParameters& parameters() const { return parameters_; }
  bool has_luminance() const;  ///< the unit has a control block, which samples it
  /// Sets the numbers of a drive and a release, or, by `part`, their derivatives.
  pindrive_error fill(pindrive_drive* drive, pindrive_release* release,
                      double Number::* part) const;

 private:
  using Function = pindrive::NamedFunction<Number>;

  /// Makes the function of an input from its parameters; false if the unit has none.
  bool make_function(const char* input, Function& function) const;
  /// Parameter of the function of an input; null without.
  const Number* find(const char* input, const char* parameter) const;
  Number at(std::size_t i) const { return {values_[i], seeds_ ? seeds_[i] : 0}; }

  const std::vector<Variable>& variables_;
  const double* values_;
  const double* seeds_;
  pindrive_c::DeviceParameters parameters_;
  std::vector<std::pair<const char*, Number>> of_functions_;  ///< by name, without the table
};

}  // namespace pindrive_fmu
