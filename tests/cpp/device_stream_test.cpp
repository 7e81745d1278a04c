// A device under a live hand: the bits of a scan along the same rows, wherever the caller pauses, and from a state
// that was kept.
#include "pindrive/device/device_stream.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "check.hpp"
#include "pindrive/device/scan.hpp"
#include "scanned_page.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;
using scanned::equal;
using scanned::Segments;

namespace {

using Random = std::mt19937_64;

/// Rows of a hand that shakes, one for each millisecond.
std::vector<device::LiveHand::Row> shaking() {
  std::vector<device::LiveHand::Row> rows;
  for (int i = 0; i <= 200; ++i)
    rows.push_back({i * 1e-3, {0.1 + 0.05 * std::sin(0.3 * i), 0}, i < 100 ? 1.0 : 0.4});
  return rows;
}

/// Segments of the pins under a live hand, with pauses at random times. `kept`: the stream is made anew from its
/// state after each pause.
std::vector<Segments> streamed(const device::Device& device, const scanned::Page& page,
                               const std::vector<device::LiveHand::Row>& rows, Random* pauses,
                               bool kept) {
  std::vector<Segments> found(device.spots.size());
  const auto sink = [&](std::size_t pin, const pd::Segment<double>& s, const auto&) {
    found[pin].push_back(s);
  };
  const device::Raster raster = page.raster();
  auto stream = std::make_unique<device::DeviceStream>(
      device, rows[0], device::Place{0, 5e-5}, std::vector<device::PinState>(device.spots.size()));
  double until = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    stream->move(raster, rows[i]);
    if (pauses && (*pauses)() % 3 != 0) continue;
    const double end = rows[i].time;
    until = pauses ? std::uniform_real_distribution<double>(until, end)(*pauses) : end;
    if (pauses && (*pauses)() % 3 == 0) until = end;
    stream->advance(raster, until, {}, sink);
    if (kept) stream = std::make_unique<device::DeviceStream>(device, raster, stream->state());
  }
  stream->advance(raster, rows.back().time, {}, sink);
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i].push_back(stream->pin(i).stepper().segment_until_now());
  return found;
}

void the_bits_of_a_scan() {
  const scanned::Page page;
  const device::Device device = scanned::device_with();
  const auto rows = shaking();
  device::LiveHand hand(rows[0], {0, 5e-5}, device.axis);
  for (std::size_t i = 1; i < rows.size(); ++i) hand.add(rows[i], device.axis);
  const device::ScanInputs inputs{device,       page.raster(), hand.path(),
                                  hand.plate(), hand.touch(1), hand.begin()};
  Random random(47);
  const auto found = streamed(device, page, rows, nullptr, false);
  for (std::size_t i = 0; i < found.size(); ++i) {
    device::PinRun run;
    run.energise(inputs, i, {}, 1U << 20);
    run.simulate(inputs, {}, [] { return true; });
    expect(run.switchings.size() == 4, "a pin reads two lines");
    expect(equal(found[i], run.segments), "a live hand has the bits of a scan");
  }
  int differing = 0, restored = 0;
  for (int k = 0; k < 20; ++k)
    for (const bool kept : {false, true}) {
      const auto again = streamed(device, page, rows, &random, kept);
      for (std::size_t i = 0; i < found.size(); ++i)
        (kept ? restored : differing) += !equal(found[i], again[i]);
    }
  expect(differing == 0, "wherever the caller pauses");
  expect(restored == 0, "and from each state that was kept");
}

void an_advance_that_is_stopped() {
  const scanned::Page page;
  const device::Device device = scanned::device_with();
  const auto rows = shaking();
  device::DeviceStream one(device, rows[0], {0, 5e-5}, std::vector<device::PinState>(2)),
      other(device, rows[0], {0, 5e-5}, std::vector<device::PinState>(2));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    one.move(page.raster(), rows[i]);
    other.move(page.raster(), rows[i]);
  }
  int calls = 0;
  bool stopped = false;
  while (!one.advance(page.raster(), 0.2, [&] { return ++calls % 7 != 0; }))
    stopped = one.now() == 0 && one.least() == 0.2;
  expect(stopped, "a stopped advance says where it goes on to");
  other.advance(page.raster(), 0.2);
  expect(calls > 100 && one.now() == 0.2, "a stopped advance goes on where it was");
  expect(one.pin(1).stepper().pin().x == other.pin(1).stepper().pin().x, "to the same bits");
  expect(one.status() == pd::Status::ok && one.hand().size() < 5, "rows behind are forgotten");
}

}  // namespace

int main() {
  the_bits_of_a_scan();
  an_advance_that_is_stopped();
  return check::status();
}
