// Skin with its slider: what stretches it, when it grips and slips, and what becomes of it as its load changes.
#include "pindrive/law/skin.hpp"

#include <cmath>
#include <limits>

#include "check.hpp"
#include "pindrive/law/contact_point.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;
using pd::detail::ActiveGuard;

namespace {

using ContactMode = pd::detail::ContactMode<double>;
using ContactPoint = pd::detail::ContactPoint<double>;
using State = pd::detail::State<double>;

constexpr double never = std::numeric_limits<double>::infinity();
const pd::Contact<double> skin{0.2, 0.3, 1000};
/// Rises by 1 N s/m from 0.2 N.
const pd::Branch<double> viscous[] = {{0, never, 0.2, 1, 0}};
const pd::Contact<double> lagging{0.2, 0.3, 1000, viscous, 1};

/// Falls by 100 N s/m from 0.3 N at rest to 0.2 N at 1 mm/s.
const pd::Branch<double> falling[] = {{0, 1e-3, 0.3, -100, 0}, {1e-3, never, 0.2, 0, 0}};
/// Rises from nothing to 0.02 N at 10 mm/s, and falls to nothing at 30 mm/s.
const pd::Branch<double> peak[] = {
    {0, 0.01, 0, 2, 0}, {0.01, 0.03, 0.02, -1, 0}, {0.03, never, 0, 0, 0}};

State at(double v, double force) { return {1e-3, v, force, 1e-3, 1e-16}; }

ContactPoint sticking(const pd::Contact<double>& contact, double load = 1) {
  ContactPoint point(contact);
  point.load = {load, 0};
  point.mode = {ContactState::elastic_stick, ActiveGuard::none, 0, 0};
  return point;
}

void sticks() {
  ContactPoint point = sticking(skin);
  point.enumerate_candidates(at(0.1, -0.25));
  expect(
      point.candidates.size() == 1 && point.candidates[0].mode.state == ContactState::elastic_stick,
      "within its limit skin grips");
  expect(near(point.force(at(0.1, -0.25)), 0.25, 1e-15), "with the force that it has");
  point.enumerate_candidates(at(-0.1, -0.3));
  expect(
      point.candidates.size() == 2 && point.candidates[1].mode.state == ContactState::slip_backward,
      "at its limit, stretched further, it may slip");
  ContactPoint falling_load = sticking(skin);
  falling_load.load.rate = -7;
  falling_load.enumerate_candidates(at(0, -0.3));
  const double level = 7 * 0.3 / 1000, rounded = std::nextafter(level, 1);
  expect(
      falling_load.excess_velocity(rounded) == 0 && falling_load.excess_velocity(1.001 * level) > 0,
      "released just as fast as its limit falls, to rounding, it stays there");
  ContactPoint light = sticking(skin, 0.5);
  light.enumerate_candidates(at(-0.1, -0.25));
  expect(
      light.candidates.size() == 1 && light.candidates[0].mode.state == ContactState::slip_backward,
      "where its load has jumped to half it cannot but slip");
  light.choose(0);
  State state = at(-0.1, -0.25);
  light.apply_jump(state);
  expect(light.start.shortens_skin && near(state.skin, -0.1, 1e-15),
         "and is as short as its friction at once");
}

void is_slip() {
  ContactPoint point = sticking(lagging);
  point.mode = ContactMode::slip(1, ActiveGuard::none);
  State state = at(0.08, 0.25);
  state.slider_velocity = 0.05;
  point.enumerate_candidates(state);
  expect(point.has_slider_state() && near(point.start.slider_speed, 0.05, 1e-15) &&
             near(point.relative_speed(0.08), 0.03, 1e-15),
         "on a rising curve its slider has a speed of its own");
  expect(near(point.skin_force(state, 2), 0.5, 1e-15), "its skin carries the friction of that");
  point.load = {0.5, 0};
  State before = state;
  pd::detail::keep_force(point, before, 0.50001);
  expect(near(point.skin_force(before, 0.5), point.skin_force(state, 0.50001), 1e-12),
         "within the rounding of a time it keeps its force as the load changes");
  ContactPoint even = sticking(skin);
  even.mode = ContactMode::slip(1, ActiveGuard::none);
  expect(!even.has_slider_state(), "under Coulomb friction it slides with the pin");
  even.load = {1, 2};
  expect(near(even.stretch_rate(0.2), 4e-4, 1e-15), "less what it stretches as its load grows");
}

void runs_away_at_rest() {
  ContactPoint point(pd::Contact<double>{0, 0, 1000, peak, 3});
  point.load = {1, 0};
  point.mode = ContactMode::slip(1, ActiveGuard::none);
  point.reached_guard = ActiveGuard::upper;
  State state = at(0, 0.02);
  state.slider_velocity = 0.01;
  point.enumerate_candidates(state);
  expect(point.candidates.size() == 4 &&
             point.candidates[1].mode.state == ContactState::elastic_stick &&
             point.candidates[2].mode.state == ContactState::slip_forward &&
             point.candidates[3].mode.state == ContactState::slip_backward,
         "skin that has lost its force beside a pin at rest may set out either way");
  const auto holds = [&](int option, double acceleration) {
    point.choose(option);
    return point.is_admissible(state, acceleration);
  };
  expect(holds(1, 0) && !holds(1, 1), "it rests with a pin that rests");
  expect(holds(2, 1) && !holds(2, -1) && holds(3, -1) && !holds(3, 1),
         "and follows one that does not");
  point.choose(2);
  point.apply_jump(state);
  expect(state.skin == 0 && state.slider_velocity == 0, "without force");

  ContactPoint lifted = sticking({0, 0, 1000, peak, 3});
  lifted.load = {0, 5};
  State pressed = at(0, -0.1);
  lifted.enumerate_candidates(pressed);
  expect(lifted.candidates.size() == 3 &&
             lifted.candidates[0].mode.state == ContactState::elastic_stick &&
             lifted.candidates[1].mode.state == ContactState::slip_forward &&
             lifted.candidates[2].mode.state == ContactState::slip_backward,
         "as it may where its load has jumped to none and grows");
  lifted.choose(2);
  lifted.apply_jump(pressed);
  expect(pressed.skin == 0 && pressed.slider_velocity == 0, "from where it has no force either");

  ContactPoint turned(pd::Contact<double>{0, 0, 1000, peak, 3});
  turned.load = {1, 0};
  turned.mode = ContactMode::slip(1, ActiveGuard::none);
  State back = at(-0.01, 0);
  back.slider_velocity = 0.005;
  turned.enumerate_candidates(back);
  expect(
      turned.candidates[0].mode.state == ContactState::slip_backward,
      "where a load jumps from none under a slider ahead of a pin that turned, it follows the pin");
}

void lifts() {
  ContactPoint point = sticking(skin);
  point.load = {0, 5};
  State state = at(0.01, 0);
  point.enumerate_candidates(state);
  expect(pd::detail::defer_first_grip(point, state.v, 1.0, 2.0) == 2 && point.load.rate == 5,
         "a load that grows from zero is followed by skin without a curve");
  ContactPoint falls(pd::Contact<double>{0.2, 0.3, 1000, falling, 2});
  falls.load = {0, 5};  // its limit grows as fast as a pin of 1.5 mm/s stretches it
  State slow = at(1.4e-3, 0), just = at(1.5e-3, 0);
  expect(pd::detail::defer_first_grip(falls, slow.v, 1.0, 2.0) == 2 && falls.load.rate == 5,
         "by one that it can grip under, too");
  const double asked = pd::detail::defer_first_grip(falls, just.v, 1.0, 2.0);
  expect(asked > 1 && asked < 1 + 1e-9 && falls.load.rate == 0,
         "where it could grip at its limit only, it waits until its rounds have times");
  // 0 N up to 1 mm/s, from there 1 N for each 10 mm/s.
  const pd::Branch<double> rising[] = {{0, 1e-3, 0, 0, 0}, {1e-3, never, 0, 100, 0}};
  ContactPoint rises(pd::Contact<double>{0, 0, 1000, rising, 2});
  rises.load = {0, 5};
  State level = at(1e-3, 0);
  const double rising_from = pd::detail::defer_first_grip(rises, level.v, 1.0, 2.0);
  expect(rising_from > 1 && rising_from < 1 + 1e-9 && rises.load.rate == 0,
         "at the speed at which a curve begins to rise it waits no longer than it carries nothing");
  const pd::Branch<double> flat[] = {{0, 1, 1.4e-6, 0, 0}, {1, never, 1.4e-6, 0, 0}};
  ContactPoint even(pd::Contact<double>{1.4e-6, 1.4e-6, 11.200000000000001, flat, 2});
  even.load = {0, 800};  // its limit grows as fast as a pin of 0.1 mm/s stretches it, to rounding
  State as_fast = at(-1e-4, 0);
  even.enumerate_candidates(as_fast);
  expect(even.candidates[0].mode.state == ContactState::elastic_stick,
         "where it can just grip at its limit, to rounding, it may");
  point.load = {1, -1};
  expect(pd::detail::defer_first_grip(point, state.v, 1.0, 2.0) == 2 && point.load.value == 1,
         "one far from zero is followed until its row");
  point.load = {1e-20, -1e-6};
  pd::detail::defer_first_grip(point, state.v, 1.0, 1 + 1e-14);
  expect(point.load.value == 0 && point.load.rate == 0, "the last of one that ends is none");
  ContactPoint rigid(pd::Contact<double>{0.2, 0.3});
  rigid.load = {1e-20, -1e-6};
  expect(pd::detail::defer_first_grip(rigid, state.v, 1.0, 1 + 1e-14) == 1 + 1e-14 &&
             rigid.load.rate == -1e-6,
         "a rigid contact needs none of this");
}

}  // namespace

int main() {
  sticks();
  is_slip();
  runs_away_at_rest();
  lifts();
  return check::status();
}
