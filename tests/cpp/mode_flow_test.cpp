// Closed form of the motion in the modes of a pin.
#include "pindrive/events/mode_flow.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

namespace {

struct Selected {
  pd::detail::Pin<double> pin;
  pd::detail::SelectedMotion<double> selected;
  pd::Flow<double> flow;

  Selected(const pd::Drive<double>& drive, double x, double v) : pin(drive, 0, x, v) {
    pin.plate.initialize(pin.state, false);
    pin.finger.initialize(pin.state, false);
    pd::detail::Selection<double>(pin, selected).select();
    const pd::Oscillator<double> plain(drive.mass, drive.damping, drive.stiffness);
    flow = pd::detail::mode_flow(pin, selected, plain, pin.plate.force_law(pin.state),
                                 pin.finger.force_law(pin.state));
  }
  double position(double tau) const { return flow.position.at(flow.after(tau)); }
  double velocity(double tau) const { return flow.velocity.at(flow.after(tau)); }
};

}  // namespace

int main() {
  // ω = 100 rad/s; friction of 20 mN displaces the centre of the oscillation by 0.2 mm.
  const pd::Drive<double> coulomb{0.01, 100, 0, {0.02, 0.02}, {}};
  const Selected slides(coulomb, 1e-3, 0);
  const double turn = 4 * std::atan(1.0) / 100;
  expect(pd::detail::has_plain_flow(slides.pin), "Coulomb friction adds no damping");
  expect(near(slides.position(turn), -0.6e-3, 1e-12),
         "half a period later the pin is as far on the other side of the displaced centre");
  const Selected sticks(coulomb, 1e-4, 0);
  expect(sticks.position(1) == 1e-4 && sticks.velocity(1) == 0,
         "a pin that sticks to a plate at rest stays where it is");
  const pd::Drive<double> compliant{0.01, 100, 0, {}, {0.5, 0.5, 300}};
  const Selected stretches(compliant, 1e-3, 0);
  expect(!pd::detail::has_plain_flow(stretches.pin), "skin that sticks adds its stiffness");
  expect(near(stretches.position(turn / 2), 0.5e-3, 1e-12),
         "and halves the period and the displacement at equilibrium");
  return check::status();
}
