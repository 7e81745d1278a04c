// Largest hand speed over two lines: its borders, the settled lines, an end on request.
#include "pindrive/device/speed_limit.hpp"

#include <cmath>

#include "check.hpp"
#include "scanned_page.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;

namespace {

constexpr device::Criteria criteria{45e-6, 5e-5, 2e-4, 2e-3, 0.5, 0.25};
constexpr auto go_on = [] { return true; };

void borders() {
  const device::Device reader = scanned::device_with();
  device::TwoLines lines(reader, 0.004, 0.002, criteria);
  int trials = 0;
  const device::SpeedLimit limit =
      device::SpeedLimitSearch(lines, criteria.direction, {{0.01, 2}}).found(go_on, [&](int done) {
        trials = done;
      });
  expect(limit.status == pd::Status::ok && trials > 32, "each speed of the grid is tried");
  const double fastest = limit.distinct.at(0).fastest;
  expect(limit.distinct[0].slowest == 0.01, "distinct from the slowest hand on");
  expect(lines.at(fastest, go_on).distinct(criteria.direction), "up to a speed");
  expect(!lines.at(1.001 * fastest, go_on).distinct(criteria.direction), "and not beyond");
  expect(limit.beyond && limit.beyond->speed > fastest && limit.beyond->speed <= 1.001 * fastest,
         "with the failure just beyond");
  expect(!limit.settled.empty() && limit.settled[0].fastest <= fastest,
         "settled lines are distinct");
}

void no_speed() {
  device::TwoLines lines(scanned::device_with(), 0.004, 0.002, criteria);
  const device::SpeedLimit limit =
      device::SpeedLimitSearch(lines, 1.0, {{0.01, 2}, 8}).found(go_on, [](int) {});
  expect(limit.distinct.empty() && !limit.beyond, "no hand moves the skin by a metre");
}

void an_end_on_request() {
  device::TwoLines lines(scanned::device_with(), 0.004, 0.002, criteria);
  int trials = 0;
  const device::SpeedLimit limit =
      device::SpeedLimitSearch(lines, criteria.direction, {{0.01, 2}})
          .found([] { return false; }, [&](int done) { trials = done; });
  expect(limit.status == pd::Status::stopped && trials < 20, "stopped on request");
}

}  // namespace

int main() {
  borders();
  no_speed();
  an_end_on_request();
  return check::status();
}
