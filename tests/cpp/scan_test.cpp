// Scan of one pin: commands from samples, the load from its coil, inputs of its motion, states that are kept.
#include "pindrive/device/scan.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t unlimited = 1U << 20;

/// Hand at 0.1 m/s over two lines of 2 mm.
struct Page {
  std::vector<double> paper;
  std::vector<double> times{0, 0.2}, vx{0.1, 0.1}, vy{0, 0}, x{0, 0.02}, y{5e-5, 5e-5};

  Page() : paper(200, 1.0) {
    for (const int first : {40, 120})
      for (int i = first; i < first + 20; ++i) paper[i] = 0;
  }
  device::Raster raster() const { return {paper.data(), 1, 200, 1e-4, {0, 0}}; }
  device::HandPath path() const {
    return {times.data(), vx.data(), vy.data(), x.data(), y.data(), times.size()};
  }
};

device::Device device_with(double skin = std::numeric_limits<double>::infinity()) {
  pd::Drive<double> drive{0.005, 200, 1.2, {0.006, 0.007}, {0.008, 0.009}};
  drive.finger.stiffness = skin;
  return {drive,
          0.05,
          device::Electromagnet({2, 0, 1, 1e-3, 2e-3, 1e-4}),
          {1000, 0.002, 0.5, 0.1},
          device::Axis(0),
          {{0, 0}, {0.001, 0}}};
}

void commands_and_load() {
  const Page page;
  const device::Device device = device_with();
  const device::ScanInputs inputs(device, page.raster(), page.path(), {1.0});
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
  const auto load = device::profile_of(run.load_times, run.loads);
  expect(load.from(0.01).value == 1, "without a current the plate has its own friction");
  expect(std::abs(load.from(energised[0].end).value - 41) < 1e-2, "with 2 N 41 times as much");
}

void a_blank_page() {
  Page page;
  page.paper.assign(200, 1.0);
  const device::Device device = device_with();
  const device::ScanInputs inputs(device, page.raster(), page.path(), {1.0});
  device::PinRun run;
  run.energise(inputs, 0, {}, unlimited);
  expect(run.switchings.empty() && run.loads.size() == 1, "a coil that is never on is a constant");
  expect(run.inputs(inputs, {}).constant(), "and the hand's even speed, too");
}

void a_pending_switching() {
  Page page;
  for (int i = 198; i < 200; ++i) page.paper[i] = 0;
  const device::Device device = device_with();
  const device::ScanInputs inputs(device, page.raster(), page.path(), {1.0});
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
    const device::ScanInputs inputs(device, page.raster(), page.path(), {1.0});
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
    expect(ended.segments.size() == 3 && ended.outcome.status == pd::Status::stopped,
           "a simulation may be ended");
  }
}

void oblique_hands() {
  Page page;
  page.vy = {0.02, 0.02};
  const device::PlateVelocity turned(page.path(), device::Axis(0));
  expect(turned.oblique && turned.across[0] == 0.02, "a hand across the axis is oblique");
  const double angle = std::atan2(0.02, 0.1);
  const device::PlateVelocity along(page.path(), device::Axis(angle));
  expect(!along.oblique, "one along the axis is not, to rounding");
  expect(std::abs(along.along[0] - std::hypot(0.1, 0.02)) < 1e-16, "and has its whole speed");
}

}  // namespace

int main() {
  commands_and_load();
  a_blank_page();
  a_pending_switching();
  motions_and_states();
  oblique_hands();
  return check::status();
}
