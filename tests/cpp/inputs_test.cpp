// Table of the inputs of a device: bounds, values that are allowed, keys.
#include "pindrive/device/inputs.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

int main() {
  constexpr double infinity = std::numeric_limits<double>::infinity(),
                   nan = std::numeric_limits<double>::quiet_NaN();
  static constexpr const device::InputQuantity& mass = *device::find_input("drive.mass");
  expect(mass.allows(0.01) && !mass.allows(0) && !mass.allows(infinity) && !mass.allows(nan),
         "a mass is finite and greater than 0");
  expect(mass.violated(-1) == &mass.bounds && mass.violated(1e13) == &mass.computable_bounds() &&
             mass.violated(1) == nullptr,
         "the bounds of what may be come before those of what can be computed");
  const device::InputQuantity& ratio = *device::find_input("drive.damping_ratio");
  expect(ratio.allows(0) && !ratio.allows(1e-12) && ratio.allows(1e-11), "a single value beside");
  const device::InputQuantity& duty = *device::find_input("magnet.pwm_duty");
  expect(!duty.allows(0) && duty.allows(1), "an end that is open, and one that is closed");
  expect(
      device::find_input("drive.mas") == nullptr && device::find_input("drive.masses") == nullptr,
      "a key is whole");
  for (const device::InputQuantity& input : device::input_quantities) {
    const bool first = device::find_input(input.key) == &input;
    if (!first || !(std::isnan(input.absent) || input.allows(input.absent)))
      expect(false, input.key);
  }
  expect(std::strcmp(device::find_input("control.latency")->unit, "s") == 0, "units are SI");
  return check::status();
}
