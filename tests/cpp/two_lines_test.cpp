// Trial of two lines: the pin at rest before it, phases of the samples, return and merging.
#include "pindrive/device/two_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "check.hpp"
#include "scanned_page.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;

namespace {

constexpr device::Criteria criteria{45e-6, 5e-5, 2e-4, 2e-3, 0.5, 0.25};
constexpr auto go_on = [] { return true; };

void slow_and_fast_hands() {
  device::TwoLines lines(scanned::device_with(), 0.004, 0.002, criteria);
  const device::LineTrial slow = lines.at(0.05, go_on), fast = lines.at(0.43, go_on);
  expect(slow.status == pd::Status::ok && slow.back > 0.9 && slow.distinct(5e-5),
         "under a slow hand the pin comes back");
  expect(!fast.shown && !fast.distinct(5e-5), "under a fast one the lines merge");
  expect(lines.settling(slow, go_on).in_time,
         "under the slow hand it settles before the second line");
  expect(lines.at(0.05, go_on).back == slow.back, "a trial leaves nothing behind");
}

void phases_of_the_samples() {
  device::TwoLines lines(scanned::device_with(), 0.004, 0.002, criteria);
  for (const double speed : {0.03, 0.0711, 0.2, 0.9}) {
    const device::LineTrial trial = lines.at(speed, go_on);
    const double step = speed / 1000;
    const auto within = [&](double ahead) { return 0 <= ahead && ahead < step; };
    expect(!trial.ahead.empty() && trial.ahead.size() <= 4, "one to four phases");
    expect(std::all_of(trial.ahead.begin(), trial.ahead.end(), within), "within a sample");
    expect(trial.until.size() == trial.ahead.size(), "each with its second line");
  }
}

/// Return of a pin between two lines on a drawn page, with its spot ahead by a distance.
double back_on_a_page(double speed, double ahead) {
  constexpr double pixel = 5e-5, left = -0.01;
  std::vector<double> paper(6000, 1.0);
  for (const int first : {200, 280}) std::fill_n(paper.begin() + first, 40, 0.0);
  const double begin = -speed * (0.002 + 0.001), lasts = 0.1;
  const std::vector<double> times{0, lasts}, vx{speed, speed}, vy{0, 0}, y{0, 0};
  const std::vector<double> x{begin, begin + speed * lasts};
  const device::HandPath path{times.data(), vx.data(), vy.data(), x.data(), y.data(), 2};
  device::Device reader = scanned::device_with();
  reader.spots = {{ahead, 0}};
  const device::PlateVelocity plate(path, reader.axis);
  const device::ScanInputs inputs{
      reader, {paper.data(), 1, 6000, pixel, {left, 0}}, path, plate, {1.0}, 0};
  const device::PinState steady = device::steady_state(reader);
  device::PinRun run;
  run.energise(inputs, 0, steady, 1000);
  run.simulate(inputs, steady, go_on);
  const device::PageAlongPath page(inputs.raster, path, reader.axis, 0.5);
  std::size_t edges = 0;
  device::Evaluation found;
  device::ScanEvaluation(inputs, criteria)
      .add(0, run, run.motion(inputs, steady), page.lines(reader.spots[0], 100, edges), found);
  return found.lines.at(0).returned / found.lines[0].height;
}

void the_worst_phase() {
  device::TwoLines lines(scanned::device_with(), 0.004, 0.002, criteria);
  bool equal = true, differ = false;
  for (const double speed : {0.16, 0.2, 0.23, 0.25, 0.27}) {
    const device::LineTrial trial = lines.at(speed, go_on);
    std::vector<double> backs;
    backs.reserve(trial.ahead.size());
    for (const double ahead : trial.ahead) backs.push_back(back_on_a_page(speed, ahead));
    const double least = *std::min_element(backs.begin(), backs.end());
    equal = equal && std::abs(trial.back - least) < 1e-9;
    differ = differ || backs.back() > least + 1e-3;
  }
  expect(equal && differ, "as on a drawn page, at the worst phase");
}

void a_pin_at_rest() {
  for (const double skin : {std::numeric_limits<double>::infinity(), 500.0}) {
    device::Device device = scanned::device_with(skin);
    device.drive.plate.kinetic = 0.012;
    device.drive.finger = {0.008, 0.009, skin};
    const device::PinState steady = device::steady_state(device);
    expect(std::abs(steady.position - 0.004 / 200) < 1e-18, "spring, plate and finger balance");
    expect(std::isnan(steady.stretch) == std::isinf(skin), "skin is stretched where it gives");
    device.drive.plate.kinetic = 0.0085;
    expect(device::steady_state(device).position == 0, "a finger may hold it where it is");
  }
}

void an_end_on_request() {
  device::TwoLines lines(scanned::device_with(), 0.004, 0.002, criteria);
  const auto stop = [] { return false; };
  expect(lines.at(0.05, stop).status == pd::Status::stopped, "stopped on request");
  const auto alone = lines.settling(lines.at(0.05, go_on), stop);
  expect(alone.status == pd::Status::stopped && !alone.in_time, "so is a line alone");
}

}  // namespace

int main() {
  slow_and_fast_hands();
  phases_of_the_samples();
  the_worst_phase();
  a_pin_at_rest();
  an_end_on_request();
  return check::status();
}
