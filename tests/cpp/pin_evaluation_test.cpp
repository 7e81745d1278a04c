// Evaluation of a pin over two lines: its numbers against samples of its motion, outcomes, false lines.
#include "pindrive/device/pin_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"
#include "scanned_pin.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two lines under a hand at 80 mm/s, 4 ms before the magnet is switched.
struct Scan {
  scanned::Pin pin;
  std::vector<double> times{0, 0.2}, vx{0.08, 0.08}, vy{0, 0}, x{0, 0.016}, y{0, 0};
  std::vector<double> turnings;
  pd::Motion<double> motion;
  device::Way way;
  device::ScanSetting setting;
  device::ScannedPin scanned;

  explicit Scan(double skin = infinity, std::vector<double> touch_times = {0, 0.2},
                std::vector<double> touches = {1, 1})
      : pin(skin, std::move(touch_times), std::move(touches)),
        motion(pin.motion()),
        way(path()),
        setting{path(), device::Axis(0),
                &way,   &turnings,
                0.004,  {1},
                0,      {45e-6, 5e-5, 2e-4, 2e-3, 0.5, 0.25}},
        scanned{3,
                {0.001, 0},
                &motion,
                {{0.010, 0.030}, {0.090, 0.110}},
                {{0.006, 0.026, true}, {0.086, 0.106, true}}} {}
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  device::HandPath path() const {
    return {times.data(), vx.data(), vy.data(), x.data(), y.data(), times.size()};
  }
  std::vector<device::EvaluatedLine> lines() const {
    std::vector<device::EvaluatedLine> found;
    device::PinEvaluation(setting, scanned).add_lines(found);
    return found;
  }
  double deflection(double t) const {
    const auto [segment, tau] = motion.locate(t, pd::Side::right);
    return motion.value(*segment, tau, pd::Quantity::position);
  }
};

void numbers_of_a_line() {
  const Scan scan;
  const auto lines = scan.lines();
  expect(lines.size() == 2, "each whole line is evaluated");
  const device::EvaluatedLine& line = lines[0];
  expect(line.pin == 3 && line.outcome == device::LineOutcome::shown, "the first is shown");
  double response = 0, peak = -1, peak_time = 0, low = 1;
  constexpr double step = 1e-6, until = 0.090;
  for (double t = 0.010; t < until; t += step) {
    const double now = scan.deflection(t);
    if (response == 0 && now >= 45e-6) response = t;
    if (now > peak) {
      peak = now;
      peak_time = t;
      low = now;
    }
    low = std::min(low, now);
  }
  expect(std::abs(line.begin.response - response) < 2 * step, "response at 45 µm");
  expect(std::abs(line.begin.lag - 0.08 * (line.begin.response - 0.006)) < 1e-15,
         "its lag is the way of the hand");
  expect(line.begin.command == 0.010 && line.end.command == 0.030, "commands of the magnet");
  expect(std::abs(line.stroke - peak) < 1e-9 && std::abs(line.height - peak) < 1e-9, "stroke");
  expect(std::abs(line.returned - (peak - low)) < 1e-8, "return before the next line");
  expect(line.release > 0.030 && line.release <= peak_time + step,
         "it breaks away with its magnet");
  expect(line.settled > line.release && line.settled < until, "and settles");
  expect(std::abs(line.smear - 0.08 * (line.settled - line.release)) < 1e-15, "smear");
  expect(std::abs(line.begin.spot.x - (0.08 * 0.006 + 0.001)) < 1e-18, "place of the spot");
  expect(line.begin.cue == device::Cue::sure, "a rigid finger feels the pin itself");
}

void outcomes() {
  Scan unseen;
  unseen.scanned.lines[1] = {0.150, 0.160, true};
  const auto lines = unseen.lines();
  expect(lines[1].outcome == device::LineOutcome::unseen && std::isnan(lines[1].stroke),
         "a line without a command is unseen");
  Scan strict;
  strict.setting.criteria.distinct = 1.5;
  expect(strict.lines()[1].outcome == device::LineOutcome::merged,
         "a pin that must come back further than it went merges the lines");
  Scan merged;
  merged.scanned.lines.push_back({0.1055, 0.1058, true});
  expect(merged.lines()[2].outcome == device::LineOutcome::merged,
         "one under a pull of another merges");
  Scan partial;
  partial.scanned.lines[0].whole = false;
  expect(partial.lines().size() == 1, "a line that is not whole is left out");
  Scan faint;
  faint.setting.criteria.felt = 1;
  expect(faint.lines()[0].outcome == device::LineOutcome::faint,
         "one below the criterion is faint");
  const Scan lifted(infinity, {0, 0.008, 0.009, 0.2}, {1, 1, 0, 0});
  expect(
      lifted.lines()[0].outcome == device::LineOutcome::faint && lifted.lines()[0].begin.skin == 0,
      "a lifted finger feels nothing");
}

void false_lines() {
  Scan scan;
  std::vector<device::FalseLine> found;
  device::PinEvaluation(scan.setting, scan.scanned).add_false_lines(found);
  expect(found.empty(), "swings of a magnet are no false lines");
  scan.scanned.energised = {{0.010, 0.030}};
  device::PinEvaluation(scan.setting, scan.scanned).add_false_lines(found);
  expect(found.size() == 1 && found[0].time > 0.110 && found[0].time < 0.112,
         "a swing forward without a magnet is");
  expect(std::abs(found[0].height - scan.lines()[0].stroke) < 1e-4, "as high as the line before");
}

}  // namespace

int main() {
  numbers_of_a_line();
  outcomes();
  false_lines();
  return check::status();
}
