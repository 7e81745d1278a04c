// Evaluation of the pins of a scan, its counts, and the spread of its numbers.
#include "pindrive/device/scan_evaluation.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"
#include "pindrive/device/printed_lines.hpp"
#include "scanned_page.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

constexpr device::Criteria criteria{45e-6, 5e-5, 2e-4, 2e-3, 0.5, 0.25};

void lines_of_two_pins() {
  const scanned::Page page;
  const device::Device device = scanned::device_with();
  const device::PlateVelocity plate(page.path(), device.axis);
  const device::ScanInputs inputs{device, page.raster(), page.path(), plate, {1.0}, 0};
  const device::PageAlongPath printed(inputs.raster, inputs.path, device.axis, 0.5);
  const device::ScanEvaluation evaluation(inputs, criteria);
  device::Evaluation found;
  std::size_t edges = 0;
  for (std::size_t pin = 0; pin < 2; ++pin) {
    device::PinRun run;
    run.energise(inputs, pin, {}, 1000);
    run.simulate(inputs, {}, [] { return true; });
    evaluation.add(pin, run, run.motion(inputs, {}), printed.lines(device.spots[pin], 100, edges),
                   found);
  }
  const device::LineCounts counts = found.counts();
  expect(counts.crossed == 4 && counts.shown == 4, "two lines under each of two pins are shown");
  expect(found.lines[0].pin == 0 && found.lines[3].pin == 1, "pin after pin");
  expect(found.dips.size() == 2 && found.dips[0].size() == 2, "a dip before each motion");
  const device::Spread stroke = found.spread(device::LineNumber::stroke);
  expect(0 < stroke.least && stroke.least <= stroke.median && stroke.median <= stroke.largest,
         "least, median and largest stroke");
}

device::EvaluatedLine line_with(device::LineOutcome outcome, double stroke, device::Cue cue) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const device::EvaluatedEdge edge{0, {0, 0}, nan, nan, nan, nan, cue};
  return {0, outcome, edge, edge, stroke, nan, nan, nan, nan, nan, nan, nan};
}

void counts_and_spreads() {
  using device::Cue;
  using device::LineOutcome;
  device::Evaluation found;
  found.lines = {
      line_with(LineOutcome::shown, 3, Cue::sure), line_with(LineOutcome::shown, 1, Cue::direction),
      line_with(LineOutcome::merged, 9, Cue::sure), line_with(LineOutcome::unseen, 9, Cue::none),
      line_with(LineOutcome::faint, 9, Cue::none)};
  const device::LineCounts counts = found.counts();
  expect(counts.crossed == 5 && counts.shown == 2, "lines and lines shown");
  expect(counts.merged == 1 && counts.unseen == 1 && counts.faint == 1, "lines by outcome");
  expect(counts.direction == 2 && counts.sure == 1, "cues of the lines shown");
  expect(counts.unsettled == 2, "no settling time");
  const device::Spread stroke = found.spread(device::LineNumber::stroke);
  expect(stroke.least == 1 && stroke.median == 2 && stroke.largest == 3,
         "the median of two lies between them; lines not shown do not count");
  found.lines.push_back(line_with(LineOutcome::shown, 7, Cue::felt));
  expect(found.spread(device::LineNumber::stroke).median == 3,
         "the median of three is one of them");
  expect(std::isnan(found.spread(device::LineNumber::smear).median), "no line has a smear");
}

}  // namespace

int main() {
  lines_of_two_pins();
  counts_and_spreads();
  return check::status();
}
