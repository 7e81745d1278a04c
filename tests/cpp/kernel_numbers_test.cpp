// The numbers of a plain release as they are taken on the way, event by event, by hand.
#include "pindrive/kernel/kernel_numbers.hpp"

#include <array>
#include <cmath>

#include "check.hpp"
#include "pindrive/numbers/pack.hpp"

namespace pk = pindrive::detail;
using check::expect;
using check::near;
using Numbers = pk::TransientNumbers<double>;
using Release = pk::PlainRelease<double>;
using Forward = pk::ForwardRelease<double>;
using Name = pk::PlainNumber;

namespace {

constexpr double inf = __builtin_inf();

/// 10 g on 100 N/m over a plate of 0.02 N and a finger of 0.005 N, from x and v; the mouse moves at `speed`.
Forward release(double x, double v, double speed = 0.1, double until = inf) {
  return Forward(Release{0.01, 100, 0.4, 0.02, 0.02, 0.005, 0.005, inf, speed, x, v, until, 0.05});
}

std::array<double, Name::count> given(const Numbers& numbers, const Forward& r, bool resting,
                                      double position, double time, double released = 0) {
  std::array<double, Name::count> found;
  found.fill(-77);
  numbers.give(r, resting, position, time, released,
               [&](Name::Name name, double value) { found[name] = value; });
  return found;
}

void starts() {
  expect(Numbers(release(1e-3, 0)).outward == 1 && Numbers(release(-1e-3, 0)).outward == -1,
         "out is the side of the start");
  expect(Numbers(release(0, -0.1)).outward == -1 && Numbers(release(0, 0)).outward == 1,
         "... or of the velocity there");
  const Numbers inward(release(1e-3, 0));
  expect(inward.turns == 1 && inward.peak == 1e-3 && inward.peak_time == 0,
         "the start is the peak where the pin sets out inward");
  const Numbers outward(release(1e-3, 0.05));
  expect(outward.turns == 0 && std::isnan(outward.peak),
         "... and is not where it sets out outward");
  expect(Numbers(release(1e-4, 0)).turns == 0,
         "a plate that pulls more than the spring takes it outward");
}

/// Out to 2 mm at 10 ms, back to −1 mm at 40 ms, fastest at −0.09 m/s after 25 ms, carried 0.3 mm, at rest.
void on_the_way() {
  const Forward r = release(1e-3, 0.1);
  Numbers n(r);
  n.slides(true, 1e-3, 0.01, r);
  n.turns_at(true, 2e-3, 0.01);
  n.consider(true, 0.02, -0.06);
  n.consider(true, 0.025, -0.09);
  n.consider(true, 0.03, -0.05);
  n.slides(true, -3e-3, 0.03, r);
  n.turns_at(true, -1e-3, 0.04);
  n.reaches_plate(true, 0.05);
  n.carries(true, -1e-3, -0.7e-3, 0.05, 0.003, r);
  n.reaches_plate(true, 0.06);
  const auto found = given(n, r, true, -0.5e-3, 0.08, 1);
  expect(found[Name::peak_displacement] == 2e-3 && found[Name::peak_time] == 0.01 &&
             found[Name::trough_displacement] == -1e-3 && found[Name::trough_time] == 0.04 &&
             found[Name::swing] == 3e-3,
         "the first turns are peak and trough, and their distance is the swing");
  expect(found[Name::return_velocity] == -0.09 && found[Name::return_velocity_time] == 0.025,
         "the return velocity is the largest inward after the peak");
  expect(found[Name::first_reversal_time] == 0.05 && found[Name::plate_reversals] == 2,
         "the first time at the plate's velocity is the first reversal");
  expect(found[Name::plate_time_stuck] == 0.003 &&
             near(found[Name::finger_distance_slid] / 4.3e-3, 1, 1e-14),
         "a stretch that the plate carries it slides on the finger alone");
  // 1 mm in 10 ms and 3 mm in 30 ms beside a plate of 0.1 m/s, until it rests.
  const double slid = std::abs(1e-3 - 1e-3) + (3e-3 + 3e-3);
  expect(near(found[Name::plate_distance_slid] / slid, 1, 1e-14) &&
             near(found[Name::plate_dissipated] / (0.02 * slid), 1, 1e-14),
         "the plate slides past the pin until it rests");
  expect(found[Name::duration] == 0.1 && found[Name::end_time] == 0.08 &&
             found[Name::finger_time_stuck] == 0,
         "a pin at rest is shown for a quarter more");
  expect(found[Name::events] == 2 + 2 + 1, "each turn, each reversal and a release is an event");
  // It carried spring, drag and finger at −1 mm; at rest the finger holds it against plate and spring.
  expect(near(found[Name::plate_peak_force], std::max(0.02, std::abs(r.carrying(-1e-3))), 1e-15) &&
             near(found[Name::finger_peak_force], 0.02 + 0.05, 1e-15),
         "peak forces are those of sliding, carrying or resting, the largest");
}

void mirrored() {
  const Forward r = release(-1e-3, -0.1, -0.1);  // the mirror image of a start at 1 mm and 0.1 m/s
  Numbers n(r);
  n.turns_at(true, 2e-3, 0.01);
  n.consider(true, 0.02, -0.06);
  const auto found = given(n, r, false, 0, 0.05);
  expect(found[Name::peak_displacement] == -2e-3 && found[Name::return_velocity] == 0.06,
         "positions and velocities are given back on the side where they are");
  expect(
      std::isnan(found[Name::trough_displacement]) && std::isnan(found[Name::first_reversal_time]),
      "what did not happen has no number");
}

void packs() {
  using V = pk::Pack<2>;
  const std::array<double, 2> x{1e-3, -1e-3};
  const auto all = [&](double value) { return V(value); };
  const pk::PlainRelease<V> given{
      all(0.01),  all(100),   all(0.4), all(0.02), all(0.02),
      all(0.005), all(0.005), all(inf), all(0.1),  pk::load<V>(x.data()),
      all(0.1),   all(inf),   all(0.05)};
  pk::TransientNumbers<V> n{pk::ForwardRelease<V>(given)};
  n.turns_at(V(0.0) < pk::load<V>(x.data()), V(2e-3), V(0.01));
  double peak[2], turns[2];
  pk::store(n.peak, peak);
  pk::store(n.turns, turns);
  expect(peak[0] == 2e-3 && turns[0] == 1 && turns[1] == 1 && peak[1] == -1e-3,
         "an event of one of a pack leaves its neighbour alone");
}

}  // namespace

int main() {
  starts();
  on_the_way();
  mirrored();
  packs();
  return check::status();
}
