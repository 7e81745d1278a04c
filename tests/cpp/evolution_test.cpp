// The steps from one event to the next: select, begin, earliest, jump.
#include "pindrive/events/evolution.hpp"

#include <cmath>
#include <limits>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;

int main() {
  // ω = 100 rad/s; a pin released at 1 mm over a plate with 20 mN of friction.
  const pd::Drive<double> drive{0.01, 100, 0, {0.02, 0.02}, {}};
  constexpr double never = std::numeric_limits<double>::infinity();
  const double half = 4 * std::atan(1.0) / 100;
  const pd::Inputs<double> inputs{{0, {0, 0}}, 1e-3, 0, never};
  pd::detail::Evolution<double> evolution(drive, inputs, 0);
  pd::Segment<double> segment;
  double amplitude = 1e-3;
  for (int swing = 0; swing < 2; ++swing) {
    expect(evolution.select(), "a mode is consistent");
    evolution.begin(segment);
    const double tau = evolution.earliest(segment.flow);
    expect(near(tau, half, 1e-15), "a pin under Coulomb friction turns after half a period");
    evolution.jump(segment, tau);
    amplitude -= 0.4e-3;
    expect(near(std::abs(evolution.pin.state.x), amplitude, 1e-15) && evolution.pin.state.v == 0,
           "and each half period takes 4 F/k of the swing");
  }
  expect(evolution.select() && evolution.pin.mode().plate == ContactState::stick,
         "within F/k the plate holds the pin");
  evolution.begin(segment);
  expect(evolution.earliest(segment.flow) == never && evolution.time_after(never) == never &&
             near(segment.begin, 2 * half, 1e-15),
         "for ever");
  return check::status();
}
