// The ledger of energies on a damped swing between two stops of the pin, term by term.
#include "pindrive/motion/energy.hpp"

#include "check.hpp"
#include "pindrive/certificate/certify.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

int main() {
  // From rest at 1 mm, without friction: what the spring loses the damper takes.
  const pd::Drive<double> drive{0.01, 100, 0.1, {}, {}};
  const pd::Inputs<double> inputs{0.0, 1e-3, 0};
  pd::Segment<double> segment{};
  segment.end = std::numeric_limits<double>::infinity();
  segment.mode = {pd::ContactState::absent, pd::ContactState::absent};
  const pd::Oscillator<double> o(drive.mass, drive.damping, drive.stiffness);
  segment.flow = pd::Flow<double>::free(o, 1e-3, 0.0, -10.0, 1e-3, 0.0);
  pd::Outcome<double> outcome;
  outcome.end = pd::End::decaying;
  outcome.until = segment.end;
  const pd::Motion<double> motion(drive, inputs, &segment, 1, outcome);

  const double half = o.half_period();
  const auto ledger = pd::energy_ledger(motion, half);
  const double start = 100 * 1e-6 / 2, left = start * std::exp(2 * o.alpha() * half);
  expect(near(1e6 * ledger.spring_start, 1e6 * start, 1e-14) &&
             near(1e6 * ledger.spring_end, 1e6 * left, 1e-12),
         "the spring holds k x^2 / 2 at both turning points");
  expect(ledger.kinetic_start == 0 && ledger.kinetic_end < 1e-25, "where the pin does not move");
  expect(near(1e6 * ledger.damper_dissipated, 1e6 * (start - left), 1e-12),
         "the damper takes the difference");
  expect(std::abs(ledger.residual()) <= 1e-14 * ledger.scale(), "the ledger closes");

  // A wrong velocity does not: no term is what the others leave.
  pd::Segment<double> wrong = segment;
  wrong.flow.velocity = 1.01 * wrong.flow.velocity;
  const pd::Motion<double> other(drive, inputs, &wrong, 1, outcome);
  const auto open = pd::energy_ledger(other, half);
  expect(std::abs(open.residual()) > 1e-3 * open.scale(), "... and not for a wrong motion");

  // A free pin that the housing takes along from rest for one whole wave: all that goes in comes out again.
  const pd::Drive<double> free{0.01, 100, 0, {}, {}};
  const double rate = 1e-5, wave = 2 * o.half_period() * o.omega() / 100;
  const double rows[2] = {0, wave}, speeds[2] = {0, rate * wave};
  const pd::Inputs<double> hand{pd::Profile<double>(rows, speeds, 2), 0, 0};
  segment.flow = pd::Flow<double>::free({0.01, 0, 100}, 0.0, 0.0, rate, -rate / 1e4, 0.0);
  segment.plate_velocity = {0, rate};
  const pd::Motion<double> there_and_back(free, hand, &segment, 1, outcome);
  const auto idle = pd::energy_ledger(there_and_back, wave);
  const double on_the_way = 100 * (2e-9 * 2e-9) / 2;  // in the spring, where it turns
  expect(idle.scale() > on_the_way && idle.scale() < 10 * on_the_way,
         "what is held on the way counts");
  expect(std::abs(idle.residual()) <= 1e-14 * idle.scale(), "... and what is left is its rounding");
  const auto certificate = pd::Certifier<double>(there_and_back, wave).certify();
  expect(certificate.energy <= 1e-14, "... for the certificate too");
  return check::status();
}
