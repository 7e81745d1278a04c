// Inputs that are set during a simulation: their differences and their jumps.
#include "pindrive/events/set_inputs.hpp"

#include <limits>

#include "check.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;
using Held = pd::Held<double>;
using Line = pd::Line<double>;

int main() {
  constexpr double never = std::numeric_limits<double>::infinity();
  expect(pd::detail::load_from(2.0, Line{1, -4}).ends == 2.25, "a falling load ends at zero");
  expect(!(pd::detail::load_from(2.0, Line{1, 4}).ends < never), "a growing load does not end");
  Held slows(1, Line{0.3, -2}), turns(1, Line{0.3, -2});
  pd::detail::end_at(slows, 1.0, 1.15);
  pd::detail::end_at(turns, 1.0, 1.2);
  expect(slows.ends == 1.15 && !(turns.ends < never), "a velocity ends where it reaches zero");
  pd::detail::end_at(slows, 1.05, 1.1);
  expect(!(slows.ends < never), "a horizon before that is not its end");
  pd::detail::end_at(slows, 1.1, 1.15);
  pd::detail::end_at(slows, 1.15, 1.3);
  expect(slows.ends == 1.15, "an end that is reached remains");

  const Held held(1, Line{0.3, 2});
  const pd::Profile<double> input(held);
  expect(!pd::detail::differs(pd::Curve<double>{0.5, 2}, input, 1.1),
         "an input within rounding is continued");
  expect(pd::detail::differs(pd::Curve<double>{0.5, 1}, input, 1.1),
         "an input with another rate differs");
  const double times[]{0, 2}, values[]{0.3, 4.3};
  expect(!pd::detail::differs(pd::Curve<double>{9, 9}, pd::Profile<double>(times, values, 2), 1.1),
         "an input in rows is not set");
  expect(near(pd::detail::change_to(0.6, held, 1.1), 0.1, 1e-15), "a jump is a difference");
  using Dual = pd::Dual<double>;
  expect(!pd::detail::is_zero(Dual{0, 1}) && pd::detail::is_zero(Dual{0, 0}),
         "a number with a derivative is not zero");

  const pd::Drive<double> drive{0.01, 100, 0, {0.1, 0.1}, {}};
  const pd::Inputs<double> inputs{{0, {0.05, 0}}, 1e-4, 0.05, never};
  pd::detail::Evolution<double> evolution(drive, inputs, 0);
  evolution.select();
  pd::detail::shift(evolution, 0.02, 0.07);
  expect(evolution.pin.plate.stuck() && evolution.pin.plate.surface.value == 0.07 &&
             evolution.pin.state.v == 0.07,
         "a pin that sticks to the plate takes part in a jump of the mouse velocity");
  evolution.pin.plate.mode.state = ContactState::slip_forward;
  pd::detail::shift(evolution, 0.01, 0.08);
  expect(near(evolution.pin.state.v, 0.08, 1e-15) && evolution.pin.plate.surface.value == 0.08,
         "a sliding pin keeps its velocity relative to the housing");
  return check::status();
}
