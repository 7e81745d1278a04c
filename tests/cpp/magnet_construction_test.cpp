// Electromagnet from its construction: resistance, field, pull and time constants of a coil by hand.
#include "pindrive/device/magnet_construction.hpp"

#include <cmath>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

bool close(double one, double other) { return std::abs(one / other - 1) < 1e-12; }

void a_coil() {
  const device::CoilConstruction coil{250, 3e-6, 5e-5, 1e-4, 8.5e-3, 1, 2, 1.6};
  const double pi = 3.141592653589793, mu = 1.25663706127e-6;
  const double resistance = 250 * 8.5e-3 / (58e6 * pi / 4 * 1e-8), current = 1 / resistance;
  const double field = mu * 250 * current / 1e-4;
  expect(close(coil.resistance(), resistance), "resistance of the copper");
  expect(close(coil.inductance(), mu * 62500 * 3e-6 / 1e-4), "inductance of two gaps in series");
  expect(close(coil.field(), field) && coil.saturation() == 1, "field in the gap");
  expect(close(coil.pull(), field * field * 3e-6 / mu), "pull of two poles");
  const auto magnet = coil.magnet();
  expect(close(magnet.rise_constant, coil.inductance() / resistance), "rise constant");
  expect(close(magnet.fall_constant, coil.inductance() / (resistance + 2)), "fall constant");
  device::CoilConstruction weak = coil;
  weak.saturation_field = 0.25 * field;
  expect(close(weak.saturation(), 0.25) && close(weak.pull(), coil.pull() / 16), "saturation");
}

void times_of_a_pull() {
  for (const double sigma : {1.0, 0.6}) {
    const device::Electromagnet<double> magnet(
        {1, 0.1, sigma, device::rise_constant(0.003, sigma), device::fall_constant(0.005, sigma)});
    const double rises = magnet.piece(0, 0, 0, true, 1).flux_after(0.003);
    const double falls = magnet.piece(0, 1, 0, false, 1).flux_after(0.005);
    expect(close(magnet.pull(rises), 0.1 + 0.9 * 0.9), "90 % after the rise time");
    expect(close(magnet.pull(falls), 0.1 + 0.1 * 0.9), "10 % after the fall time");
    const double edge = device::closing_flux(magnet.given(), 0.3);
    expect(close(magnet.pull(edge), 0.3), "the gap closes where the pull is its force");
  }
}

}  // namespace

int main() {
  a_coil();
  times_of_a_pull();
  return check::status();
}
