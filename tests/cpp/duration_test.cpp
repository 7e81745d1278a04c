// The duration over which a motion is measured: as requested or, without, until the ending is seen.
#include "pindrive/motion/duration.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

double duration(const pd::Drive<double>& drive, const pd::Inputs<double>& inputs,
                double band = pd::settling_band) {
  std::vector<pd::Segment<double>> segments;
  const auto outcome =
      pd::simulate(drive, inputs, [&](const auto& segment) { segments.push_back(segment); });
  return pd::duration_of(
      pd::Motion<double>(drive, inputs, segments.data(), segments.size(), outcome), band);
}

}  // namespace

int main() {
  const pd::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.020}, {0.005, 0.005}};
  pd::Inputs<double> inputs{0.10, 1.5e-3, 0.10};
  const double rest = 0.134008;  // of the example in README.md
  expect(check::near(duration(drive, inputs), 1.25 * rest, 1e-6),
         "a motion that rests is seen for a quarter longer");
  inputs.duration = 0.02;
  expect(duration(drive, inputs) == 0.02, "a duration that is requested is taken");

  const pd::Drive<double> decays{0.010, 100.0, 0.40, {}, {}};
  const pd::Inputs<double> free{0.10, 1.5e-3, 0.0};
  const double usual = duration(decays, free);
  expect(usual > std::log(1000) / 20 && usual < 1, "a decay is seen to a thousandth");
  expect(duration(decays, free, 1e-9) >= std::log(1e9) / 20 * 0.9,
         "or until it is within a narrow band");
  const pd::Drive<double> undamped{0.010, 100.0, 0, {}, {}};
  expect(check::near(duration(undamped, free), 3 * 0.0628318530717958648, 1e-12),
         "an oscillation without end is seen for three periods");
  return check::status();
}
