// Scan of one pin: commands from samples, the load from its coil, inputs of its motion, states that are kept.
#include "pindrive/device/scan.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"
#include "scanned_page.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;
using scanned::device_with;
using scanned::Page;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t unlimited = 1U << 20;

void commands_and_load() {
  const Page page;
  const device::Device device = device_with();
  const device::PlateVelocity plate(page.path(), device.axis);
  const device::ScanInputs inputs{device, page.raster(), page.path(), plate, {1.0}, 0};
  device::PinRun run, ahead;
  run.energise(inputs, 0, {}, unlimited);
  ahead.energise(inputs, 1, {}, unlimited);
  // Samples at which the spot is 4 mm and 6 mm on are the first beyond the edges.
  expect(run.switchings.size() == 4 && std::abs(run.switchings[0] - 0.043) < 1.1e-3,
         "a line switches the coil on after the latency");
  expect(std::abs(run.switchings[1] - run.switchings[0] - 0.02) < 1.1e-3,
         "for as long as it lasts");
  expect(std::abs(run.switchings[0] - ahead.switchings[0] - 0.01) < 1.1e-3, "a spot ahead before");
  const auto energised = run.energised(inputs);
  expect(energised.size() == 2 && energised[0].end == run.switchings[1], "two times with it on");
  const pd::Profile<double> load(run.loads.data(), run.loads.size());
  expect(load.from(0.01).value == 1, "without a current the plate has its own friction");
  expect(std::abs(load.from(energised[0].end).value - 41) < 1e-6, "with 2 N 41 times as much");
}

void a_blank_page() {
  Page page;
  page.paper.assign(200, 1.0);
  const device::Device device = device_with();
  const device::PlateVelocity plate(page.path(), device.axis);
  const device::ScanInputs inputs{device, page.raster(), page.path(), plate, {1.0}, 0};
  device::PinRun run;
  run.energise(inputs, 0, {}, unlimited);
  expect(run.switchings.empty() && run.loads.size() == 1, "a coil that is never on is a constant");
  expect(run.inputs(inputs, {}).constant(), "and the hand's even speed, too");
}

void a_pending_switching() {
  Page page;
  for (int i = 198; i < 200; ++i) page.paper[i] = 0;
  const device::Device device = device_with();
  const device::PlateVelocity plate(page.path(), device.axis);
  const device::ScanInputs inputs{device, page.raster(), page.path(), plate, {1.0}, 0};
  device::PinState from;
  from.pending = {0.001};
  device::PinRun run;
  run.energise(inputs, 0, from, unlimited);
  expect(run.switchings[0] == 0.001, "a switching that is due happens in the path");
  expect(run.pending.size() == 1 && run.pending[0] > 0.2, "or stays pending at its end");
}

void motions_and_states() {
  const Page page;
  for (const double skin : {std::numeric_limits<double>::infinity(), 500.0}) {
    const device::Device device = device_with(skin);
    const device::PlateVelocity plate(page.path(), device.axis);
    const device::ScanInputs inputs{device, page.raster(), page.path(), plate, {1.0}, 0};
    device::PinRun run;
    run.energise(inputs, 0, {}, unlimited);
    run.simulate(inputs, {}, [] { return true; });
    expect(run.outcome.status == pd::Status::ok && run.segments.size() > 8, "a pin is simulated");
    double farthest = 0;
    for (const auto& segment : run.segments)
      farthest = std::max(farthest, segment.flow.position.start);
    expect(farthest > 1e-3, "and carried by its magnet");
    device::PinState carried;
    carried.velocity = nan;
    expect(run.inputs(inputs, carried).velocity == 0.1, "a carried pin has the plate's velocity");
    device::PinState stretched;
    stretched.stretch = 1;
    if (std::isfinite(skin))
      expect(run.inputs(inputs, stretched).skin_stretch == 0.008 / 500,
             "skin beyond static friction has slipped");
    device::PinRun ended;
    ended.energise(inputs, 0, {}, unlimited);
    int count = 0;
    ended.simulate(inputs, {}, [&] { return ++count < 3; });
    expect(ended.segments.size() < 6 && ended.outcome.status == pd::Status::stopped,
           "a simulation may be ended");
  }
}

}  // namespace

int main() {
  commands_and_load();
  a_blank_page();
  a_pending_switching();
  motions_and_states();
  return check::status();
}
