// What contacts that slip from rest could have carried: nothing where they had to slip, what is left where
// they could stick, also where one may stick without the other.
#include "pindrive/certificate/breakaway.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;

namespace {

const pd::Drive<double> drive{0.01, 100, 0, {0.2, 0.2}, {0.05, 0.05}};
constexpr auto backward = ContactState::slip_backward, absent = ContactState::absent;

/// A pin at x, at rest on the plate, or on both.
pd::detail::Beginning<double> at(double x, bool on_finger, double acceleration = 0,
                                 double load = 1) {
  return {x,         0,    0.2 * load, on_finger ? 0.05 : 0, {0, acceleration}, load, 1, 0, true,
          on_finger, true, true};
}

}  // namespace

int main() {
  const pd::Mode plate{backward, absent}, both{backward, backward};
  expect(pd::detail::spare_stick_limit(drive, plate, at(3e-3, false)) == 0,
         "a spring beyond the stick limit leaves nothing");
  expect(near(pd::detail::spare_stick_limit(drive, plate, at(1.5e-3, false)), 0.05, 1e-15),
         "one within it leaves the difference");
  expect(pd::detail::spare_stick_limit(drive, plate, at(1.5e-3, false, 0, 0.5)) == 0,
         "half the load carries half");
  expect(near(pd::detail::spare_stick_limit(drive, both, at(2.2e-3, true)), 0.03, 1e-14),
         "two contacts at one velocity carry together");
  // The plate sets off with 30 or 1 m/s²: of what the pin would need to stay, the finger has 0.1 N.
  const pd::Drive<double> smooth{0.01, 100, 0, {0.05, 0.05}, {0.1, 0.1}};
  expect(pd::detail::spare_stick_limit(smooth, both, at(0, true, 30)) == 0,
         "surfaces that part fast: neither holds beside the other's kinetic friction");
  expect(near(pd::detail::spare_stick_limit(smooth, both, at(0, true, 1)), 0.1 - 0.06, 1e-15),
         "slowly: the finger could have");
  expect(pd::detail::spare_stick_limit(drive, {ContactState::stick, backward}, at(0, true, 1)) == 0,
         "while one sticks the other is not asked");
  pd::detail::Beginning<double> before = at(1.5e-3, false);
  before.plate_began = false;
  expect(pd::detail::spare_stick_limit(drive, plate, before) == 0,
         "a contact that slipped before is not asked");
  return check::status();
}
