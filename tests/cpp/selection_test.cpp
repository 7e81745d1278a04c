// The mode that follows an event, from the state of a pin on a plate that moves and a finger at rest.
#include "pindrive/law/selection.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;

namespace {

using Drive = pd::Drive<double>;

/// A pin at x that has the velocity of the plate, and the mode that follows.
struct Carried {
  pd::detail::Pin<double> pin;
  pd::detail::SelectedMotion<double> selected;
  bool found;

  Carried(const Drive& drive, double x, pd::Line<double> plate, int at_limit = 0)
      : pin(drive, 0, x, plate.value) {
    pin.stick_limit_side = at_limit;
    pin.plate.surface = plate;
    pin.plate.initialize(pin.state, false);
    pin.finger.initialize(pin.state, false);
    found = pd::detail::Selection<double>(pin, selected).select();
  }
  pd::Mode mode() const { return pin.mode(); }
};

/// 10 g on 100 N/m without a damper: at 1 mm the spring pulls with 0.1 N.
Drive drive(pd::Contact<double> plate, pd::Contact<double> finger) {
  return {0.01, 100, 0, plate, finger};
}
const pd::Contact<double> absent{}, strong{0.1, 0.3}, even{0.1, 0.1}, weak{0.02, 0.04};
constexpr double x = 1e-3, v = 0.05;

void sticks() {
  const Drive d = drive(strong, absent);
  const Carried carried(d, x, {v, 0});
  expect(carried.found && carried.mode().plate == ContactState::stick,
         "a plate whose stick limit is enough takes the pin along");
  expect(near(carried.selected.stick_force.start, 0.1, 1e-15) &&
             near(carried.selected.stick_force.drift, 5, 1e-15),
         "... with the force of the spring, that grows as it is stretched");
  expect(carried.selected.guards.end() - carried.selected.guards.begin() == 1 &&
             carried.selected.guards.begin()->side == 1 &&
             near(carried.selected.guards.begin()->path.start, 0.2, 1e-15),
         "... until what is left of its limit is used up, on one side");
  const Drive drags = drive(strong, weak);
  const Carried dragged(drags, x, {v, 0});
  expect(dragged.mode().plate == ContactState::stick &&
             dragged.mode().finger == ContactState::slip_forward &&
             near(dragged.selected.stick_force.start, 0.12, 1e-15),
         "... and carries what the finger takes too");
  const Carried rests(drags, x, {0, 0});
  expect(rests.mode().plate == ContactState::stick && rests.mode().finger == ContactState::stick,
         "two surfaces at rest hold it together");
}

void is_slip() {
  const Drive d = drive(weak, absent);
  const Carried ahead(d, -x, {v, 0}), behind(d, x, {v, 0});
  expect(ahead.mode().plate == ContactState::slip_forward &&
             behind.mode().plate == ContactState::slip_backward,
         "what a plate cannot hold slips to the side that it is pulled to");
  expect(
      near(ahead.selected.acceleration, 8, 1e-14) && near(behind.selected.acceleration, -8, 1e-14),
      "... with what kinetic friction leaves of the pull");
  const Drive between = drive(weak, strong);
  const Carried left(between, 0, {0, 1}), thrown(between, 0, {0, 100});
  expect(
      left.mode().plate == ContactState::slip_backward && left.mode().finger == ContactState::stick,
      "a pin on two surfaces that part stays on the one that can hold it");
  expect(thrown.mode().plate == ContactState::slip_backward &&
             thrown.mode().finger == ContactState::slip_forward &&
             near(thrown.selected.acceleration, 92, 1e-14),
         "... or on neither, between both");
}

void at_limit() {
  const Drive d = drive(even, absent);
  const Carried released(d, x, {v, 0}, 1);
  expect(released.mode().plate == ContactState::slip_backward && released.selected.tangential &&
             released.selected.acceleration == 0,
         "a stick force at its limit, no force jumping, lets the pin go along with the plate");
  const Carried held(d, x, {-v, 0}, 1);
  expect(held.mode().plate == ContactState::stick &&
             held.selected.guards.end() - held.selected.guards.begin() == 1 &&
             held.selected.guards.begin()->side == -1,
         "... and holds it where the force falls from there: only the other side is left to watch");
}

}  // namespace

int main() {
  sticks();
  is_slip();
  at_limit();
  return check::status();
}
