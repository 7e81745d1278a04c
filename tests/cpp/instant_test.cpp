// The pin at an instant of a mode beside the motion itself: the equation of motion gives what its solution does.
#include "pindrive/motion/instant.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const pd::Branch<double> curve[] = {{0, 0.05, 0.03, -0.2, 0}, {0.05, inf, 0.02, 0.1, 0}};
const double times[] = {0, 0.02, 0.06}, speeds[] = {0.02, 0.1, 0.05}, loads[] = {1, 1.5, 0.2},
             crossing[] = {0, 0.02, 0.02};

template <class T>
pd::Profile<T> profile(const T* values) {
  static const T at[] = {T(0), T(0.02), T(0.06)};
  return pd::Profile<T>(at, values, 3);
}

struct Case {
  const char* what;
  pd::Drive<double> drive;
  pd::Inputs<double> inputs;
};

std::vector<Case> cases() {
  const pd::Drive<double> rigid{0.01, 100, 0.4, {0.02, 0.03}, {0.005, 0.006}};
  const pd::Inputs<double> steady{0.1, 1.5e-3, 0.1, 0.1};
  std::vector<Case> all;
  all.push_back({"rigid contacts", rigid, steady});
  all.push_back({"skin", rigid, steady});
  all.back().drive.finger.stiffness = 400;
  all.push_back({"a curve under a load that changes", rigid, steady});
  all.back().drive.plate = {0.03, 0.03, inf, curve, 2};
  all.back().inputs.plate_load = profile(loads);
  all.push_back({"a curve on skin", rigid, steady});
  all.back().drive.finger = {0.03, 0.03, 400, curve, 2};
  all.push_back({"a hand that moves across", rigid, steady});
  all.back().inputs.across_velocity = profile(crossing);
  all.push_back({"end stops", rigid, steady});
  all.back().drive.stops = {1.6e-3, inf, 0};
  all.push_back({"elastic end stops", rigid, steady});
  all.back().drive.stops = {1.6e-3, 3000, 1};
  for (Case& c : all) c.inputs.mouse_velocity = profile(speeds);
  return all;
}

/// The largest difference over a motion, within its segments, as a part of what is usual of each number.
double apart(const Case& c, int& count) {
  std::vector<pd::Segment<double>> segments;
  const auto outcome =
      pd::simulate(c.drive, c.inputs, [&](const auto& s) { segments.push_back(s); });
  const pd::Motion<double> motion(c.drive, c.inputs, segments.data(), segments.size(), outcome);
  double worst = 0;
  for (const auto& segment : segments) {
    const double end = std::min(segment.end, c.inputs.duration);
    if (!(end - segment.begin > 1e-9)) continue;
    ++count;
    const double tau = 0.4 * (end - segment.begin);
    pd::detail::State<double> state{motion.value(segment, tau, pd::Quantity::position),
                                    motion.value(segment, tau, pd::Quantity::velocity)};
    const auto friction = motion.friction(segment, tau);
    const auto inputs = pd::InputLines<double>::of(c.drive, c.inputs, segment).from(tau);
    state.skin = -friction.finger;
    const pd::Branch<double> branch = c.drive.finger.branch(segment.mode.finger_branch);
    if (pd::detail::SeriesMode<double>(c.drive, segment.mode, inputs)
            .has_slider_state())  // where its friction is this
      state.slider_velocity =
          pd::along(segment.mode.finger,
                    branch.from + (std::abs(friction.finger) - branch.force) / branch.slope);
    const pd::Instant<double> now(c.drive, segment.mode, inputs, state);
    const double a = motion.value(segment, tau, pd::Quantity::acceleration);
    for (const double part :
         {(now.position() - state.x) / 1e-3, (now.velocity() - state.v) / 0.1,
          (now.acceleration() - a) / 10, (now.friction().plate - friction.plate) / 0.02,
          (now.friction().finger - friction.finger) / 0.02,
          c.drive.finger.rigid()
              ? now.stretch()
              : now.stretch() * c.drive.finger.stiffness / 0.02 + friction.finger / 0.02})
      worst = std::max(worst, std::abs(part));
  }
  return worst;
}

void derivatives() {
  using D = pd::Dual<double>;
  // Along the position of a pin that slides: a' = −k/m, and no friction changes.
  const pd::Drive<D> drive{D(0.01), D(100), D(0.4), {D(0.02), D(0.03)}, {D(0.005), D(0.006)}};
  const pd::Mode mode{pd::ContactState::slip_backward, pd::ContactState::slip_forward};
  pd::InputLines<D> inputs;
  inputs.plate_velocity = {D(0.1), D(0)};
  pd::detail::State<D> state{D(1e-3, 1), D(0.05)};
  const pd::Instant<D> now(drive, mode, inputs, state);
  expect(std::abs(now.acceleration().slope + 1e4) < 1e-9 && now.friction().plate.slope == 0 &&
             now.position().slope == 1 && now.velocity().slope == 0,
         "on dual numbers it gives derivatives with respect to the state");
}

}  // namespace

int main() {
  for (const Case& c : cases()) {
    int count = 0;
    const double worst = apart(c, count);
    if (!(worst < 1e-11)) std::printf("%s: %g\n", c.what, worst);
    expect(count > 3 && worst < 1e-11, c.what);
  }
  derivatives();
  return check::status();
}
