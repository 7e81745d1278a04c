// A cycle repeats from its begin on, and samples see where a period or a begin is wrong.
#include "pindrive/motion/period_samples.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

/// Slides about F/k until the load of the plate is there, and sticks and slips then.
struct StickSlip {
  pd::Drive<double> drive{1, 100, 0, {1, 2}, {}};
  pd::Inputs<double> inputs{0.1, 0.03, -0.2};
  std::vector<pd::Segment<double>> segments;
  pd::Outcome<double> outcome;

  StickSlip()
      : outcome(pd::simulate(drive, inputs, [&](const auto& s) { segments.push_back(s); })) {}
  pd::Motion<double> motion() const {
    return {drive, inputs, segments.data(), segments.size(), outcome};
  }
};

void cycle() {
  const StickSlip found;
  const pd::Motion<double> motion = found.motion();
  const double since = pd::steady_since(motion), period = found.outcome.period;
  const pd::detail::PeriodSamples<double> samples(motion);
  expect(found.outcome.end == pd::End::stick_slip && since > 0.2 * period, "it begins in between");
  expect(samples.difference_since(since) < 1e-12, "it repeats from its begin on");
  expect(samples.difference_since(since - 0.2 * period) > 1e-3, "and not before");
  expect(std::abs(samples.begin(1e-8) - since) <= samples.step(), "which the samples find");
}

void certified() {
  StickSlip found;
  const auto certificate = [&] {
    const pd::Motion<double> motion = found.motion();
    return pd::Certifier<double>(motion, 10.0).certify();
  };
  expect(certificate().period == 0 && certificate().steady_since == 0, "the certificate agrees");
  found.outcome.period *= 1.001;
  expect(certificate().period > 1e-4, "but not with a longer period");
}

}  // namespace

int main() {
  cycle();
  certified();
  return check::status();
}
