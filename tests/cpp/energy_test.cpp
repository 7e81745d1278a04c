// The ledger of energies on a damped swing between two stops of the pin, term by term.
#include "pindrive/motion/energy.hpp"

#include <string>
#include <vector>

#include "check.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

namespace {

/// Ledger of a pin of a mass under a hand that moves back and forth, whose pull decays.
template <class T>
pd::Ledger<T> under_functions(T mass) {
  const pd::Drive<T> drive{mass, 100, 0.32, {T(0.022), T(0.0265)}, {T(0.005), T(0.0075)}};
  const pd::InputTerm<T> wave{0, 0.05, 0, 31}, pull{4, 0, 20, 0};
  const pd::InputPiece<T> hand{0, {T(0.06)}, &wave, 1}, load{0, {T(1)}, &pull, 1};
  pd::Inputs<T> inputs{pd::Profile<T>(&hand, 1), T(0), T(0.06), T(0.6)};
  inputs.plate_load = {&load, 1};
  std::vector<pd::Segment<T>> segments;
  const auto outcome = pd::simulate(
      drive, inputs, [&](const pd::Segment<T>& segment) { segments.push_back(segment); });
  expect(segments.size() > 5, "there are events");
  const pd::Motion<T> motion(drive, inputs, segments.data(), segments.size(), outcome);
  return pd::energy_ledger(motion, T(0.6));
}

/// A term changes with the times of events: the ledger closes in its derivative, too.
void derivatives() {
  const auto found = under_functions(pd::Dual<double>(0.01, 1));
  const double h = 1e-8;
  const auto more = under_functions(0.01 + h), less = under_functions(0.01 - h);
  const double largest = std::abs(found.inertia_work.slope);
  expect(std::abs(found.residual().slope) < 1e-12 * largest, "a derivative closes the ledger");
  for (const auto& [name, of] : pd::ledger_numbers<pd::Dual<double>>) {
    if (std::string(name) == "residual") continue;
    const auto at = [&, key = std::string(name)](const pd::Ledger<double>& ledger) {
      for (const auto& [other, value] : pd::ledger_numbers<double>)
        if (key == other) return value(ledger);
      return std::numeric_limits<double>::quiet_NaN();
    };
    const double slope = (at(more) - at(less)) / (2 * h);
    expect(std::abs(of(found).slope - slope) < 1e-5 * largest, name);
  }
}

}  // namespace

int main() {
  derivatives();
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
