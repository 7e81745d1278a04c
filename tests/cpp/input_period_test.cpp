// Periods of inputs, and the periodic responses to them.
#include "pindrive/model/input_period.hpp"

#include <cmath>
#include <complex>
#include <vector>

#include "check.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/steady_numbers.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

constexpr double pi = 3.14159265358979323846, never = std::numeric_limits<double>::infinity();

pd::Inputs<double> under(const pd::InputPiece<double>& velocity,
                         const pd::InputPiece<double>& push) {
  pd::Inputs<double> inputs{pd::Profile<double>(&velocity, 1), 0, 0};
  inputs.force = pd::Profile<double>(&push, 1);
  return inputs;
}

void periods() {
  const pd::InputTerm<double> slow{0, 1, 0, 2 * pi * 6}, fast{1, 0, 0, 2 * pi * 15};
  const pd::InputTerm<double> other{1, 0, 0, 40}, dies{1, 0, 3, 20};
  const pd::InputPiece<double> still{0, {1}, nullptr, 0}, ramp{0, {1, 2}, nullptr, 0};
  const pd::InputPiece<double> six{0, {1}, &slow, 1}, fifteen{0, {}, &fast, 1};
  const pd::InputPiece<double> forty{0, {}, &other, 1}, dying{0, {}, &dies, 1};
  expect(std::abs(pd::period_of(under(six, fifteen)).period - 1.0 / 3) < 1e-15,
         "6 and 15 Hz repeat three times a second");
  expect(!pd::period_of(under(six, forty)).repeats(), "frequencies without a common period do not");
  expect(!pd::period_of(under(six, ramp)).repeats() && !pd::period_of(under(ramp, six)).constant,
         "nor do inputs that grow");
  const auto later = pd::period_of(under(six, dying));
  expect(later.since == pd::detail::term_duration / 3.0 && later.repeats() &&
             pd::period_of(under(still, dying)).constant,
         "an exponential that has decayed is constant");
  expect(pd::period_of(under(still, still)).constant && !pd::period_of(under(six, still)).constant,
         "constant inputs are known");
}

/// A pin without friction has the amplitude of the linear oscillator.
void response() {
  const double mass = 0.01, stiffness = 100, damping = 0.4, push = 0.02;
  for (const double frequency : {3.0, 15.9, 40.0}) {
    const pd::InputTerm<double> term{0, push, 0, 2 * pi * frequency};
    const pd::InputPiece<double> force{0, {}, &term, 1}, still{0, {0}, nullptr, 0};
    const pd::Drive<double> drive{mass, stiffness, damping, {}, {}};
    std::vector<pd::Segment<double>> segments;
    const pd::Inputs<double> inputs = under(still, force);
    const auto outcome =
        pd::simulate(drive, inputs, [&](const pd::Segment<double>& s) { segments.push_back(s); });
    const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
    const double omega = 2 * pi * frequency;
    const double amplitude =
        push / std::abs(std::complex<double>(stiffness - mass * omega * omega, damping * omega));
    expect(outcome.end == pd::End::driven, "a pin under a sinusoid has a periodic response");
    if (!outcome.cycles()) continue;
    const auto range = pd::detail::SteadyMeasurement<double>(motion).range();
    expect(std::abs(outcome.period * frequency - 1) < 1e-13, "... of the period of the sinusoid");
    expect(std::abs(range.half() / amplitude - 1) < 1e-10, "... with the amplitude of the formula");
    expect(pd::Certifier<double>(motion, 2 * outcome.until).certify().worst() < 1e-10,
           "... which keeps every law");
  }
}

/// A stick force that stays within its limit holds the pin for ever.
void rest() {
  const pd::InputTerm<double> term{0, 0.01, 0, 50};
  const pd::InputPiece<double> force{0, {}, &term, 1}, still{0, {0}, nullptr, 0};
  const pd::Drive<double> drive{0.01, 100, 0.4, {0.02, 0.03}, {}};
  const auto outcome = pd::simulate(drive, under(still, force), [](const auto&) {});
  expect(outcome.end == pd::End::driven && outcome.status == pd::Status::ok,
         "a pin that a periodic force does not move has a known ending");
}

}  // namespace

int main() {
  periods();
  response();
  rest();
  return check::status();
}
