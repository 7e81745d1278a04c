// Inputs of a scan: velocity of the plate along and across the axis, luminance under a pin, rows.
#include "pindrive/device/scan_inputs.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"
#include "scanned_page.hpp"

namespace device = pindrive::device;
using check::expect;
using scanned::Page;

namespace {

void oblique_hands() {
  Page page;
  page.vy = {0.02, 0.02};
  const device::PlateVelocity turned(page.path(), device::Axis(0));
  expect(turned.oblique() && turned.across().from(0).value == 0.02,
         "a hand across the axis is oblique");
  const double angle = std::atan2(0.02, 0.1);
  const device::PlateVelocity along(page.path(), device::Axis(angle));
  expect(!along.oblique(), "one along the axis is not, to rounding");
  expect(std::abs(along.along().from(0).value - std::hypot(0.1, 0.02)) < 1e-16,
         "and has its whole speed");
}

void what_pins_share() {
  const Page page;
  const device::Device device = scanned::device_with(500);
  const device::PlateVelocity plate(page.path(), device.axis);
  const std::vector<double> times{0.05, 0.1}, loads{1, 0.5};
  const pindrive::Profile<double> touch(times.data(), loads.data(), times.size());
  const device::ScanInputs inputs{device, page.raster(), page.path(), plate, touch, 0};
  expect(inputs.luminance(0, 0.0395) == 1 && inputs.luminance(1, 0.0395) == 0,
         "a spot ahead reaches a line before");
  expect(inputs.next_row(0) == 0.05 && inputs.next_row(0.05) == 0.1 && inputs.next_row(0.1) == 0.2,
         "rows are those of the hand and of the touch");
  expect(!(inputs.next_row(0.2) < std::numeric_limits<double>::infinity()), "and end");
  expect(inputs.held_stretch(1) == 0.008 / 500 && inputs.held_stretch(-1) == -0.008 / 500,
         "skin beyond static friction has slipped");
  expect(inputs.held_stretch(1e-6) == 1e-6, "up to it, it keeps its stretch");
}

}  // namespace

int main() {
  oblique_hands();
  what_pins_share();
  return check::status();
}
