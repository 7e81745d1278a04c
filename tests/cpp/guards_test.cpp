// The earliest guard of a mode, and which of two at a constant distance is kept.
#include "pindrive/law/guards.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::detail::ActiveGuard;

namespace {

using ContactPoint = pd::detail::ContactPoint<double>;
using Guards = pd::detail::Guards<double>;

constexpr double never = std::numeric_limits<double>::infinity();
const pd::Contact<double> coulomb{0.1, 0.1};

ContactPoint slipping(double v, double surface, double rate = 0) {
  ContactPoint point(coulomb);
  point.surface = {surface, rate};
  pd::detail::State<double> state{0, v};
  point.initialize(state, false);
  return point;
}

/// A pin without damping at v that slows down as v cos(100 t), past a finger at rest and a plate.
pd::Segment<double> swing(double v) {
  const pd::Oscillator<double> o(0.01, 0, 100);
  pd::Segment<double> segment{};
  segment.flow = pd::Flow<double>::free(o, 0.0, v, 0.0, 0.0, 0.0);
  return segment;
}

int count_of(const Guards& guards) { return static_cast<int>(guards.end() - guards.begin()); }

void nearest_surface() {
  const auto segment = swing(0.1);
  Guards guards;
  guards.add(slipping(0.1, 0), segment, false);
  guards.add(slipping(0.1, 0.04), segment, true);
  expect(count_of(guards) == 1 && guards.begin()->plate,
         "of two constant surface velocities below, the one that is reached first is kept");
  const double tau = guards.earliest(segment.flow.oscillator, 0.0, never);
  expect(near(tau, std::acos(0.4) / 100, 1e-14), "... and when that is");

  guards.clear();
  guards.add(slipping(0.1, 0), segment, false);
  guards.add(slipping(0.1, 0.3), segment, true);
  expect(count_of(guards) == 2, "one above and one below are both kept");
  expect(near(guards.earliest(segment.flow.oscillator, 0.0, never), std::asin(1.0) / 100, 1e-14),
         "what the pin never reaches ends nothing");

  guards.clear();
  guards.add(slipping(0.1, 0), segment, false);
  guards.add(slipping(0.1, -0.04, 0.5), segment, true);
  expect(count_of(guards) == 2, "a surface that accelerates is kept beside the other");
}

void limits() {
  Guards guards;
  const pd::Oscillator<double> o(0.01, 0, 100);
  guards.add({0.3, 0, 0, -0.6}, ActiveGuard::none, true, 1);
  guards.add({0.3, 0, 0, 0.6}, ActiveGuard::none, true, -1);
  expect(count_of(guards) == 1, "what only grows is no guard");
  expect(guards.earliest(o, 0.0, 0.4) == 0.4, "a row of an input before it comes first");
  expect(near(guards.earliest(o, 0.0, never), 0.5, 1e-15), "a line comes to zero");
  const auto defer_grazing = [&](double row) {
    return guards.defer_grazing(0.5, row, [&](const auto& guard, double tau) {
      return guards.stays(guard, o, tau, 1e-12);
    });
  };
  expect(defer_grazing(0.6) == 0.5, "what falls on comes to zero where it does");
  expect(defer_grazing(0.5 + 1e-14) == 0.5 + 1e-14,
         "what falls by rounding until a row does so there");
  expect(defer_grazing(never) == 0.5, "without a row there is nothing to wait for");
}

void known() {
  Guards guards;
  guards.add_known(0.5, ActiveGuard::none, true, 1, true);
  guards.add_known(0.8, ActiveGuard::lower, false, 0, false);
  expect(guards.earliest_known(0.4) == 0.4 && guards.earliest_known(never) == 0.5,
         "the earliest of known zeros, up to a limit");
  const auto defer_grazing = [&](bool stays) {
    return guards.defer_grazing(0.5, never, [&](const auto& guard, double tau) {
      expect(guard.zero == 0.5 && tau == 0.8, "it is asked of what came to zero alone");
      return stays;
    });
  };
  expect(defer_grazing(true) == 0.8 && defer_grazing(false) == 0.5,
         "a stick force that stays at its limit waits for the next speed that comes to zero");
}

}  // namespace

int main() {
  nearest_surface();
  limits();
  known();
  return check::status();
}
