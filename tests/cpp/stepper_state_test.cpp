// State of a stepper on another clock.
#include "pindrive/events/stepper_state.hpp"

#include <limits>

#include "check.hpp"
#include "pindrive/events/stepper.hpp"

namespace pd = pindrive;
using check::expect;

int main() {
  constexpr double never = std::numeric_limits<double>::infinity();
  const pd::Drive<double> drive{0.010, 100, 0.40, {0.020, 0.020}, {0.005, 0.005}};
  const pd::Inputs<double> release{{0, {0.10, 0}}, 1.5e-3, 0.10, never, {0, {1, 0}}};
  pd::Stepper<double> stepper(drive, release), whole(drive, release);
  stepper.step(0.0625);
  const pd::StepperState<double> later = stepper.state().on_clock_from(0.0625);
  expect(later.now == 0 && later.mouse_velocity.since == -0.0625 && !(later.horizon < never),
         "all times are those of the other clock");
  const pd::StepperState<double> ended = stepper.hand_over();
  expect(ended.now == 0 && ended.since == 0, "a state that is handed over begins a segment");
  pd::Stepper<double> again(drive, ended);
  again.step(0.0625);
  whole.step(0.125);
  expect(
      check::near(again.pin().x, whole.pin().x, 1e-15) && again.mode().plate == whole.mode().plate,
      "from which the motion goes on");
  return check::status();
}
