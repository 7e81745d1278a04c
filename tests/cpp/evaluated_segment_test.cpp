// A segment evaluated at an instant: the pin as the motion has it, the force of a stop, the sliding velocity on
// skin, and how far a force is from that of a plate that slides across too.
#include "pindrive/certificate/evaluated_segment.hpp"

#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;

namespace {

using Drive = pd::Drive<double>;
using Scales = pd::detail::Scales<double>;

/// Calls visit with one segment of a motion, evaluated; the first in which a condition holds.
template <class Holds, class Visitor>
void in_segment(const Drive& drive, const pd::Inputs<double>& inputs, Holds&& holds,
                Visitor&& visit) {
  std::vector<pd::Segment<double>> segments;
  const auto outcome = pd::simulate(
      drive, inputs, [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
  const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
  const Scales scales{2e-3, 0.2, 0.2, 0.2};
  for (const auto& segment : motion) {
    if (!holds(segment)) continue;
    motion.along(segment, [&](const auto& along) {
      using Along = std::decay_t<decltype(along)>;
      visit(
          pd::detail::EvaluatedSegment<double, Along>(drive, scales, inputs, 0.1, segment, along));
    });
    return;
  }
  expect(false, "the motion has such a segment");
}
bool any(const pd::Segment<double>&) { return true; }

void free_of_stops() {
  const Drive drive{0.01, 100, 0.4, {0.02, 0.02}, {0.005, 0.005}};
  const pd::Inputs<double> inputs{pd::Profile<double>(0.1), 1.5e-3, 0};  // NOLINT: cannot throw
  in_segment(drive, inputs, any, [&](const auto& first) {
    const auto s = first.at(0);
    expect(s.x == 1.5e-3 && s.v == 0, "it begins at the release");
    const double force = drive.mass * s.a + drive.stiffness * s.x - s.plate_force - s.finger_force;
    expect(near(force, 0, 1e-15), "with the acceleration of its forces");
    expect(first.stop_force(s) == 0 && first.on_finger(s) == s.v && first.unsure(s) == 0,
           "without a stop, skin or an oblique plate there is nothing of them");
    expect(near(first.span, first.segment.end, 1e-15), "it ends with the segment");
  });
}

void stops() {
  const auto held = [](const pd::Segment<double>& s) { return pd::in_contact(s.mode.stop); };
  Drive drive{0.01, 100, 0.4, {}, {}, {1e-3}};
  const pd::Inputs<double> pushed{pd::Profile<double>(0.0),
                                  0,
                                  0.3,
                                  1,  // NOLINT: cannot throw
                                  pd::Profile<double>(1.0),
                                  0,
                                  pd::Profile<double>(0.5)};
  in_segment(drive, pushed, held, [&](const auto& there) {
    expect(near(there.stop_force(there.at(0)), 0.1 - 0.5, 1e-14),
           "a rigid stop carries what the spring does not");
  });
  drive.stops.stiffness = 1e4;
  drive.stops.damping = 2;
  in_segment(drive, pushed, held, [&](const auto& there) {
    const auto s = there.at(there.span / 2);
    expect(s.x > 1e-3 && near(there.stop_force(s), 1e4 * (1e-3 - s.x) - 2 * s.v, 1e-14),
           "an elastic one pushes by its depth and its damping");
  });
}

void skin() {
  const Drive drive{0.01, 100, 0.4, {0.02, 0.02}, {0.005, 0.006, 300}};
  const pd::Inputs<double> inputs{pd::Profile<double>(0.1), 1.5e-3, 0};  // NOLINT: cannot throw
  const auto grips = [](const pd::Segment<double>& s) {
    return s.mode.finger == ContactState::elastic_stick;
  };
  in_segment(drive, inputs, grips, [&](const auto& there) {
    const auto s = there.at(there.span / 2);
    expect(s.v != 0 && near(there.on_finger(s), 0, 1e-14), "skin that grips does not slide");
    expect(there.slider_unsure == 0, "under a constant load nothing is unsure");
  });
}

/// The force of a steep branch is a difference of terms far larger.
void steep_skin() {
  const pd::Branch<double> curve[] = {{0, 0.05, 0.02, 0, 0}, {0.05, 1e9, 0.02, 1e4, 0}};
  Drive drive{0.01, 100, 0.4, {0.02, 0.02}, {0.02, 0.02, 300}};
  drive.finger.curve = curve;
  drive.finger.branches = 2;
  pd::Inputs<double> inputs{pd::Profile<double>(0.1), 0, 0.1};  // NOLINT: cannot throw
  const double times[] = {0, 0.01}, loads[] = {1, 0.1};
  inputs.finger_load = {times, loads, 2};
  inputs.duration = 0.01;
  const auto steep = [](const pd::Segment<double>& s) { return s.mode.finger_branch == 1; };
  in_segment(drive, inputs, steep, [&](const auto& there) {
    const double load = there.finger_load.at(there.span), terms = 2 * load * (1e4 * 0.05 - 0.02);
    expect(there.slider_unsure > 1e-16 * terms / (300 * there.span) &&
               there.slider_unsure < 1e-13 * terms / (300 * there.span),
           "the speed of a slider is known to the rounding of the terms of its force");
    using Segment = std::decay_t<decltype(there)>;
    const Segment empty(drive, there.scales, inputs, 0, there.segment, there.along);
    expect(empty.span == 0 && empty.slider_unsure >= 0 && empty.slider_unsure < 1e-9,
           "nothing follows from a segment of zero length");
  });
}

void oblique() {
  const Drive drive{0.01, 100, 0.4, {0.02, 0.02}, {}};
  pd::Inputs<double> inputs{pd::Profile<double>(0.03), 1e-4, 0};  // NOLINT: cannot throw
  inputs.across_velocity = pd::Profile<double>(0.04);
  inputs.duration = 0.01;
  const auto slides = [](const pd::Segment<double>& s) {
    return s.mode.plate == ContactState::slip_oblique;
  };
  in_segment(drive, inputs, slides, [&](const auto& first) {
    auto s = first.at(0);
    expect(near(s.plate_force, 0.02 * 0.6, 1e-13), "three of five parts of the friction are axial");
    expect(first.oblique_error(s) < 1e-16, "that is the law");
    s.plate_force *= 1.01;
    expect(near(first.oblique_error(s), 0.02 * 0.006, 1e-6), "a hundredth more is found");
    expect(first.unsure(s) > 0 && first.unsure(s) < 1e-15, "its direction is known to rounding");
  });
}

}  // namespace

int main() {
  const pd::Branch<double> curve[] = {{0, 0.05, 0.03, -0.2, 0}, {0.05, 1e9, 0.02, 0.1, 0}};
  pd::Contact<double> contact{0.03, 0.04};
  expect(pd::detail::kinetic_friction(contact, 0.7) == 0.03, "Coulomb friction has no speed");
  contact.curve = curve;
  contact.branches = 2;
  expect(near(pd::detail::kinetic_friction(contact, 0.02), 0.026, 1e-15) &&
             near(pd::detail::kinetic_friction(contact, 0.15), 0.03, 1e-15),
         "a curve is read between its rows");
  free_of_stops();
  stops();
  skin();
  steep_skin();
  oblique();
  return check::status();
}
