// The inputs as lines: at a later time, of a segment, and a transverse velocity that is within rounding of zero.
#include "pindrive/model/input_curves.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using Line = pd::Line<double>;

namespace {

void rounded() {
  const pd::Held<double> falls(0.0, Line{1e-3, -1e-2});
  pd::Inputs<double> inputs{0.1, 0, 0};
  inputs.across_velocity = falls;
  const auto lines = [&](double time, const Line& along) {
    return pd::InputCurves<double>::across_from(inputs, time, along, true);
  };
  const auto zero = lines(0.1 * (1 + 1e-16), {0.1, 0}), not_zero = lines(0.09, {0.1, 0});
  expect(zero.value == 0 && zero.rate == -1e-2 && near(not_zero.value, 1e-4, 1e-15),
         "a velocity across that is rounding is zero");

  // Both velocities reach zero at 0.1 s, a breakpoint of the axial one.
  pd::Held<double> stops(0.0, Line{1e-2, -1e-1});
  stops.ends = 0.1;
  inputs.mouse_velocity = stops;
  const double time = 0.1 * (1 - 2e-15);
  const auto both = lines(time, {stops.line.at(time), -1e-1});
  expect(both.value == 1e-2 * (0.1 - time) && both.rate == -1e-2,
         "one that comes to zero with that along the axis keeps its direction until there");
}

void later() {
  const pd::InputCurves<double> lines{{1, 2}, {3, 4}, {5, 6}, {7, 8}, {9, 10}};
  const auto then = lines.from(0.5);
  expect(then.plate_velocity.value == 2 && then.plate_load.value == 5 &&
             then.across_velocity.value == 8 && then.force.value == 11 &&
             then.finger_load.value == 14 && then.force.rate == 8,
         "each line goes on at its rate");
  expect(lines.oblique() && !pd::InputCurves<double>{}.oblique(),
         "a loaded plate with a transverse velocity slides obliquely");
  const pd::InputCurves<double> unloaded{{1, 0}, {0, 0}, {5, 6}};
  expect(!unloaded.oblique(), "an unloaded plate does not");
}

}  // namespace

int main() {
  later();
  rounded();
  return check::status();
}
