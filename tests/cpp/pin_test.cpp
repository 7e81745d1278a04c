// A pin with its contacts and end stops at an instant.
#include "pindrive/law/pin.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using pd::ContactState;

int main() {
  const pd::Drive<double> even{0.01, 100, 0, {0.1, 0.1}, {}}, more{0.01, 100, 0, {0.1, 0.3}, {}};
  pd::detail::Pin<double> pin(even, 0.5, -1e-3, 0.05);
  expect(pin.time == 0.5 && pin.state.position_scale == 1e-3 && !pin.held(),
         "before the release no contact has a mode");
  pin.plate.surface = {0.05, 0};
  pin.plate.initialize(pin.state, false);
  pin.finger.initialize(pin.state, false);
  expect(pin.held() && pin.mode().plate == ContactState::stick &&
             pin.mode().finger == ContactState::absent,
         "a plate with the velocity of the pin holds the pin");
  for (const auto* drive : {&even, &more}) {
    pd::detail::Pin<double> at_limit(*drive, 0, 1e-3, 0);
    at_limit.plate.initialize(at_limit.state, false);
    at_limit.finger.initialize(at_limit.state, false);
    at_limit.plate.enumerate_candidates(at_limit.state);
    at_limit.finger.enumerate_candidates(at_limit.state);
    at_limit.plate.choose(2);  // backward
    at_limit.stick_limit_side = 1;
    expect(at_limit.stays_at_limit() == (drive == &even),
           "a stick force stays at its limit if static equals kinetic friction");
  }
  return check::status();
}
