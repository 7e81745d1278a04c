// A hand that gives way: as intended without pins that pull, slowed by a pin that is clamped.
#include "pindrive/device/compliant_hand.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"

namespace pd = pindrive;
namespace device = pd::device;
using check::expect;

namespace {

/// A pin under a hand that moves at 60 mm/s for half a second over a page with or without a black line.
struct Case {
  std::vector<double> page = std::vector<double>(200, 1.0);
  double times[2] = {0, 0.5}, vx[2] = {0.06, 0.06}, vy[2] = {0, 0}, x[2] = {0, 0.03}, y[2] = {0, 0};
  device::Device reader{
      {0.001, 250, 0.5, {0.0022, 0.0026}, {0.03, 0.045}},
      {0.01},
      1,
      device::Electromagnet<double>(device::MagnetParameters<double>{1.0, 0, 1, 0.001, 0.001}, {}),
      {1000, 0.002, 0.5, 0.1},
      device::Axis(0),
      {{0, 0}}};
  device::HandPath path{times, vx, vy, x, y, 2};
  device::PlateVelocity plate{path, reader.axis};

  explicit Case(bool printed) {
    reader.drive.finger.stiffness = 300;
    reader.drive.finger.damping = 0.3;
    if (printed) std::fill(page.begin() + 100, page.begin() + 110, 0.0);
  }
  device::ScanInputs inputs() const {
    return {reader, {page.data(), 1, 200, 2e-4, {0, 0}}, path, plate, {1.0}, 0};
  }
};

struct Found {
  device::HandRows rows;
  double slowest, deflection;
  bool ended;
};
Found followed(const Case& of, const device::Hand& hand) {
  const device::ScanInputs inputs = of.inputs();
  device::CompliantHand moving(hand, inputs, {device::at_rest(0)});
  const bool ended = moving.advance();
  const auto& v = moving.rows().velocity;
  return {moving.rows(), *std::min_element(v.begin(), v.end()), moving.deflection(0), ended};
}

}  // namespace

int main() {
  const device::Hand arm{0.55, 135, 6.5}, heavy{1e12, 135, 6.5};
  const Found blank = followed(Case(false), arm), line = followed(Case(true), arm),
              held = followed(Case(true), heavy);
  expect(blank.ended && line.ended && held.ended, "a hand comes to the end of its path");
  expect(line.rows.times.back() == 0.5 && line.rows.bends.size() + 1 == line.rows.times.size(),
         "its path has a bend for each stretch, and ends with the intended one");
  expect(std::abs(held.slowest - 0.06) < 1e-13, "nothing slows a heavy hand");
  expect(blank.slowest > 0.0595, "blank paper slows a hand by the drag of a pin alone");
  expect(line.slowest < 0.056 && line.slowest > 0.04, "a line slows the hand");
  expect(std::abs(line.deflection) < 1e-3, "and its pin is back at the end");

  Case rough(true);
  const Found sliding = followed(rough, {0.55, 135, 6.5, 0.3, 0.4});
  expect(std::abs(sliding.slowest - line.slowest) < 1e-6,
         "friction that the arm overcomes changes nothing while the mouse slides");
  return check::status();
}
