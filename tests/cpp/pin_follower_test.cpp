// A pin that follows a hand: the same bits wherever the caller pauses and from a state that was kept, and the
// motion that one simulation gives under the rows of its coil.
#include "pindrive/device/pin_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "cases.hpp"
#include "check.hpp"
#include "pindrive/device/coil_course.hpp"
#include "pindrive/device/scan.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"
#include "scanned_page.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;
using scanned::equal;
using scanned::Segments;

namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Random hand that turns back over two lines, with a touch that varies.
struct Hand {
  scanned::Page page;
  std::vector<double> touch_times{0.02, 0.09}, touches{1, 0.3};

  explicit Hand(Random& random) {
    const bool oblique = random() % 2 == 0;
    page.times = {0};
    page.vx = {between(random, 0.05, 0.2)};
    page.vy = {0};
    page.x = {0};
    page.y = {5e-5};
    while (page.times.size() < 12) {
      const double lasts = between(random, 0.003, 0.04), before = page.vx.back();
      const double v = random() % 5 == 0 ? 0 : between(random, -0.1, 0.25);
      page.times.push_back(page.times.back() + lasts);
      page.vx.push_back(v);
      page.vy.push_back(oblique ? between(random, -1e-3, 1e-3) : 0);
      page.x.push_back(page.x.back() + 0.5 * (before + v) * lasts);
      page.y.push_back(5e-5);
    }
  }
};

struct Setting {
  Hand hand;
  device::Device device;
  device::PlateVelocity plate;
  device::ScanInputs inputs;

  explicit Setting(Random& random)
      : hand(random),
        device(scanned::device_with(random() % 3 == 0 ? 500.0
                                                      : std::numeric_limits<double>::infinity())),
        plate(hand.page.path(), device.axis),
        inputs{device,
               hand.page.raster(),
               hand.page.path(),
               plate,
               {hand.touch_times.data(), hand.touches.data(), hand.touches.size()},
               0} {
    if (random() % 2 == 0) device.pressing.touch = 0.02;
    if (!device.drive.finger.rigid() || random() % 2 == 0) return;
    device.load_exponent = random() % 2 == 0 ? 2.0 / 3 : 1.5;
    inputs.finger_load = inputs.finger_load.to_the(device.load_exponent);
  }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;
};

/// Follows a pin to the end, with pauses at random times; if `kept`, from the state at each pause.
Segments follow(const Setting& s, Random* pauses, bool kept) {
  Segments found;
  const auto sink = [&](const pd::Segment<double>& segment, const auto&) {
    found.push_back(segment);
  };
  auto pin = std::make_unique<device::PinFollower>(s.inputs, device::PinState{});
  const double end = s.inputs.path.end();
  for (double until = 0; until < end;) {
    until = pauses ? std::min(end, until + between(*pauses, 0, 0.01)) : end;
    if (pauses && (*pauses)() % 4 == 0)  // at a row or at a sample
      until = std::max(until, std::min(end, std::round(1000 * until) / 1000));
    pin->sample(s.inputs, 0, until);
    pin->advance(s.inputs, until, {}, sink);
    if (kept) pin = std::make_unique<device::PinFollower>(s.inputs, pin->state());
  }
  found.push_back(pin->stepper().segment_until_now());
  return found;
}

void pauses_change_nothing() {
  Random random(45);
  int differing = 0, restored = 0, of_scan = 0, count = 0;
  for (int i = 0; i < cases(300); ++i) {
    const Setting s(random);
    const Segments whole = follow(s, nullptr, false);
    device::PinRun run;
    run.energise(s.inputs, 0, {}, 1U << 20);
    run.simulate(s.inputs, {}, [] { return true; });
    of_scan += !equal(whole, run.segments);
    for (int k = 0; k < 5; ++k) {
      differing += !equal(whole, follow(s, &random, false));
      restored += !equal(whole, follow(s, &random, true));
    }
    count += static_cast<int>(whole.size());
  }
  std::printf("# %d segments\n", count);
  expect(differing == 0, "pauses do not change a bit");
  expect(restored == 0, "nor does a state that is kept");
  expect(of_scan == 0, "and a scan has the same bits");
}

void the_motion_under_the_rows() {
  Random random(46);
  double worst = 0;
  for (int i = 0; i < cases(300); ++i) {
    const Setting s(random);
    const Segments found = follow(s, nullptr, false);
    device::PinRun run;
    run.energise(s.inputs, 0, {}, 1U << 20);
    const pd::Inputs<double> inputs = run.inputs(s.inputs, {});
    Segments expected;
    const auto outcome = pd::simulate(s.device.drive, inputs,
                                      [&](const auto& segment) { expected.push_back(segment); });
    const pd::Motion<double> motion(s.device.drive, inputs, found.data(), found.size(),
                                    {pd::Status::ok, pd::End::moving, 0, found.back().end});
    const pd::Motion<double> whole(s.device.drive, inputs, expected.data(), expected.size(),
                                   outcome);
    for (double t = 0; t <= s.inputs.path.end(); t += 1e-4) {
      const auto at = [&](const pd::Motion<double>& m) {
        const auto [segment, tau] = m.locate(t, pd::Side::left);
        return m.value(*segment, tau, pd::Quantity::position);
      };
      worst = std::max(worst, std::abs(at(motion) - at(whole)));
    }
  }
  std::printf("# positions within %.1e m\n", worst);
  expect(worst < 1e-14, "the motion is that of one simulation under the rows of the coil");
}

/// A scan that goes on from the state at the end of another one is that over both hands.
void a_scan_in_two_parts() {
  Random random(48);
  double worst = 0;
  int moved = 0, differing = 0;
  for (int i = 0; i < cases(300); ++i) {
    const Setting s(random);
    device::PinRun whole;
    whole.energise(s.inputs, 0, {}, 1U << 20);
    whole.simulate(s.inputs, {}, [] { return true; });
    const device::HandPath& path = s.inputs.path;
    const std::size_t cut = 3 + random() % 6;
    const device::HandPath one{path.times, path.vx, path.vy, path.x, path.y, cut + 1};
    const device::HandPath other{path.times + cut, path.vx + cut, path.vy + cut,
                                 path.x + cut,     path.y + cut,  path.count - cut};
    const device::PlateVelocity first(one, s.device.axis), second(other, s.device.axis);
    const double begin = other.begin();
    std::vector<double> later = s.hand.touch_times;
    for (double& time : later) time -= begin;
    const pd::Profile<double> touch =
        pd::Profile<double>(later.data(), s.hand.touches.data(), later.size())
            .to_the(s.device.load_exponent);
    device::PinRun run;
    run.energise({s.device, s.inputs.raster, one, first, s.inputs.finger_load, 0}, 0, {}, 1U << 20);
    run.simulate({s.device, s.inputs.raster, one, first, s.inputs.finger_load, 0}, {},
                 [] { return true; });
    device::PinState from;
    from.motion = run.ended;
    from.coil = run.coil.end;
    from.decision = run.decision;
    from.pending = run.pending;
    const device::ScanInputs rest{s.device, s.inputs.raster, other, second, touch, begin};
    run.energise(rest, 0, from, 1U << 20);
    run.simulate(rest, from, [] { return true; });
    worst = std::max(worst, std::abs(run.ended.pin.x - whole.ended.pin.x));
    moved += std::abs(whole.ended.pin.x) > 1e-5;
    differing += !pd::same_mode(run.segments.back().mode, whole.segments.back().mode);
  }
  std::printf("# in two parts: positions within %.1e m\n", worst);
  expect(worst < 1e-13 && 2 * moved > cases(300),
         "a scan in two parts ends where that in one run does");
  expect(differing == 0, "with the same contacts");
}

}  // namespace

int main() {
  pauses_change_nothing();
  the_motion_under_the_rows();
  a_scan_in_two_parts();
  return check::status();
}
