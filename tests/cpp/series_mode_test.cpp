// Modes as their series have them: which have no closed form, the terms of their equations, and their guards.
#include "pindrive/series/series_mode.hpp"

#include "check.hpp"
#include "pindrive/series/series.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState, pd::Mode;
using pd::detail::ActiveGuard;
using Line = pd::Line<double>;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const pd::Branch<double> curve[] = {{0, 0.05, 0.03, -0.2, 0}, {0.05, inf, 0.02, 0.1, 0}};

pd::Drive<double> drive(double skin = inf) {
  pd::Drive<double> d{0.01, 100, 0.4, {0.03, 0.03}, {0.03, 0.03, skin}};
  for (pd::Contact<double>* contact : {&d.plate, &d.finger}) {
    contact->curve = curve;
    contact->branches = 2;
  }
  return d;
}
constexpr auto forward = ContactState::slip_forward, backward = ContactState::slip_backward,
               stick = ContactState::stick, elastic = ContactState::elastic_stick;

bool closed(const pd::Drive<double>& d, const Mode& mode, const pd::InputCurves<double>& inputs) {
  return pd::detail::SeriesMode<double>(d, mode, inputs).has_closed_form();
}

void closed_forms() {
  const pd::InputCurves<double> still{{0.1, 0}};
  pd::InputCurves<double> loaded = still, touched = still, oblique = still, unloaded;
  loaded.plate_load = {1, 2};
  touched.finger_load = {1, 2};
  oblique.across_velocity = {0, 0.1};
  unloaded = oblique;
  unloaded.plate_load = {0, 0};
  const auto rigid = drive(), soft = drive(400),
             coulomb = pd::Drive<double>{0.01, 100, 0.4, {0.03, 0.03}, {0.03, 0.03, 400}};
  expect(closed(rigid, {forward, backward, 0, 1}, still),
         "sloped branches under constant loads are linear");
  expect(!closed(rigid, {forward, stick, 1, 0}, loaded) &&
             closed(rigid, {stick, forward, 0, 1}, loaded),
         "... a plate's under a load that changes is not, where it slips");
  expect(
      !closed(rigid, {stick, forward, 0, 1}, touched) && closed(rigid, {forward, stick}, touched),
      "... nor a finger's");
  expect(closed(coulomb, {forward, backward}, loaded),
         "friction that no speed changes follows its load");
  expect(!closed(coulomb, {ContactState::slip_oblique, stick}, oblique) &&
             closed(coulomb, {stick, stick}, oblique) &&
             closed(coulomb, {forward, stick}, unloaded),
         "a plate that slides across has none, unless it carries nothing");
  expect(!closed(soft, {stick, forward, 0, 1}, still) && closed(soft, {stick, elastic}, still),
         "nor has skin that slips on a slope");
}

void equations() {
  pd::InputCurves<double> inputs{{0.1, 0.5}, {2, 1}, {}, {0.3, -1}, {3, -2}};
  const auto rigid = drive();
  const auto e =
      pd::detail::SeriesMode<double>(rigid, {backward, forward, 0, 1}, inputs).equation();
  expect(
      e.side == -1 && near(e.plate_force, 0.03, 1e-15) && e.plate_slope == -0.2 && e.load.rate == 1,
      "the plate's branch is continued to no speed");
  const double finger = 0.02 - 0.1 * 0.05;  // to no speed
  expect(near(e.damping, 0.4 + 0.1 * 3, 1e-15) && near(e.damping_rate, 0.1 * -2, 1e-15),
         "a rigid finger's slope damps with its load");
  expect(near(e.force.value, 0.3 + 0.01 * 0.5 - 3 * finger, 1e-15) &&
             near(e.force.rate, -1 + 2 * finger, 1e-15),
         "... and its friction opposes, beside inertia and the force from outside");
  const auto soft = drive(400);
  const auto sticks =
      pd::detail::SeriesMode<double>(soft, {forward, elastic, 1, 0}, inputs).equation();
  expect(sticks.skin_factor.value == 1 && sticks.skin_stiffness == 400 && sticks.skin_decay == 0,
         "skin that sticks pulls with its force");
  const auto has_slider_state =
      pd::detail::SeriesMode<double>(soft, {forward, forward, 1, 1}, inputs).equation();
  expect(near(has_slider_state.skin_factor.value, 0.3, 1e-15) &&
             near(has_slider_state.skin_factor.rate, -0.2, 1e-15) &&
             has_slider_state.skin_decay == 400 &&
             near(has_slider_state.skin_drift, -2 * finger, 1e-15),
         "skin that slips on a slope pulls with what its slider's velocity makes of that");
  pd::Drive<double> stopped = rigid;
  stopped.stops = {1e-3, 5000, 2};
  const auto pushed =
      pd::detail::SeriesMode<double>(stopped, {stick, stick, 0, 0, pd::StopState::lower}, inputs)
          .equation();
  expect(pushed.held && pushed.surface.value == 0.1 && pushed.stiffness == 5100 &&
             pushed.damping == 2.4 && near(pushed.force.value, 0.3 + 0.005 - 5, 1e-15),
         "a plate holds the pin at its velocity; an elastic stop is a spring from its edge on");
}

void guards() {
  // A plate that slides ever slower on its upper branch, from 0.06 m/s, comes to the breakpoint.
  pd::Drive<double> d = drive();
  d.damping = 0;
  d.stiffness = 1e-12;
  d.finger = {};
  pd::InputCurves<double> inputs{{0, 0}, {1, 1}};
  const pd::detail::SeriesMode<double> mode(d, {forward, ContactState::absent, 1, 0}, inputs);
  const auto step = pd::detail::series_step(mode.equation(), {0, 0.06}, 0.01);
  const auto found = mode.guards(step, {});
  expect(found.end() - found.begin() == 1 && found.begin()->bound == ActiveGuard::lower &&
             found.begin()->plate,
         "a slide on the last branch ends at its lower end");
  // m u' = −(1 + τ) (0.015 + 0.1 u): u + 0.15 falls as e^(−10 (τ + τ²/2)), from 0.21 to 0.2.
  const double tau = std::sqrt(1 + 2 * std::log(0.21 / 0.2) / 10) - 1;
  expect(found.earliest() != nullptr && near(found.earliest()->zero / tau, 1, 1e-12),
         "... at the time of the closed form");
  const auto held = drive();
  const pd::detail::SeriesMode<double> stuck(held, {stick, stick}, inputs);
  const auto rest = stuck.guards(pd::detail::series_step(stuck.equation(), {1e-4, 0}, 0.01), {});
  expect(rest.end() - rest.begin() == 2 && near(rest.begin()->path.at(0), 0.06 - 0.01, 1e-15) &&
             near((rest.begin() + 1)->path.at(0), 0.06 + 0.01, 1e-15),
         "two surfaces that hold the pin have the sum of their limits left, on both sides");
}

}  // namespace

int main() {
  closed_forms();
  equations();
  guards();
  return check::status();
}
