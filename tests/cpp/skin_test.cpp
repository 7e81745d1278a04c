// Skin with its slider: what stretches it, when it grips and slips, and what becomes of it as its load changes.
#include "pindrive/law/skin.hpp"

#include <cmath>
#include <limits>

#include "check.hpp"
#include "pindrive/law/friction.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;
using pd::detail::Bound;

namespace {

using Touch = pd::detail::Touch<double>;
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

Touch gripping(const pd::Contact<double>& contact, double load = 1) {
  Touch touch(contact);
  touch.load = {load, 0};
  touch.does = {ContactState::elastic_stick, Bound::none, 0, 0};
  return touch;
}

void grips() {
  Touch touch = gripping(skin);
  touch.ask(at(0.1, -0.25));
  expect(touch.count == 1 && touch.option(0).state == ContactState::elastic_stick,
         "within its limit skin grips");
  expect(near(touch.force(at(0.1, -0.25)), 0.25, 1e-15), "with the force that it has");
  touch.ask(at(-0.1, -0.3));
  expect(touch.count == 2 && touch.option(1).state == ContactState::slip_backward,
         "at its limit, stretched further, it may slip");
  Touch falling_load = gripping(skin);
  falling_load.load.rate = -7;
  falling_load.ask(at(0, -0.3));
  const double level = 7 * 0.3 / 1000, rounded = std::nextafter(level, 1);
  expect(falling_load.off_level(rounded) == 0 && falling_load.off_level(1.001 * level) > 0,
         "released just as fast as its limit falls, to rounding, it stays there");
  Touch light = gripping(skin, 0.5);
  light.ask(at(-0.1, -0.25));
  expect(light.count == 1 && light.option(0).state == ContactState::slip_backward,
         "where its load has jumped to half it cannot but slip");
  light.does = light.option(0);
  State state = at(-0.1, -0.25);
  light.land(state);
  expect(light.drops() && near(state.skin, -0.1, 1e-15), "and is as short as its friction at once");
}

void slips() {
  Touch touch = gripping(lagging);
  touch.does = Touch::slip(1, Bound::none);
  State state = at(0.08, 0.25);
  state.slide = 0.05;
  touch.ask(state);
  expect(touch.lags() && near(touch.slide(), 0.05, 1e-15) && near(touch.gap(0.08), 0.03, 1e-15),
         "on a rising curve its slider has a speed of its own");
  expect(near(touch.skin_force(state, 2), 0.5, 1e-15), "its skin carries the friction of that");
  touch.load = {0.5, 0};
  State before = state;
  touch.keeps_force(before, 0.50001);
  expect(near(touch.skin_force(before, 0.5), touch.skin_force(state, 0.50001), 1e-12),
         "within the rounding of a time it keeps its force as the load changes");
  Touch even = gripping(skin);
  even.does = Touch::slip(1, Bound::none);
  expect(!even.lags(), "under Coulomb friction it slides with the pin");
  even.load = {1, 2};
  expect(near(even.stretching(0.2), 4e-4, 1e-15), "less what it stretches as its load grows");
}

void runs_away_at_rest() {
  Touch touch(pd::Contact<double>{0, 0, 1000, peak, 3});
  touch.load = {1, 0};
  touch.does = Touch::slip(1, Bound::none);
  touch.reached = Bound::upper;
  State state = at(0, 0.02);
  state.slide = 0.01;
  touch.ask(state);
  expect(touch.count == 4 && touch.option(1).state == ContactState::elastic_stick &&
             touch.option(2).state == ContactState::slip_forward &&
             touch.option(3).state == ContactState::slip_backward,
         "skin that has lost its force beside a pin at rest may set out either way");
  const auto holds = [&](int option, double acceleration) {
    touch.does = touch.option(option);
    return touch.goes_inside(state, acceleration);
  };
  expect(holds(1, 0) && !holds(1, 1), "it rests with a pin that rests");
  expect(holds(2, 1) && !holds(2, -1) && holds(3, -1) && !holds(3, 1),
         "and follows one that does not");
  touch.does = touch.option(2);
  touch.land(state);
  expect(state.skin == 0 && state.slide == 0, "without force");

  Touch lifted = gripping({0, 0, 1000, peak, 3});
  lifted.load = {0, 5};
  State pressed = at(0, -0.1);
  lifted.ask(pressed);
  expect(lifted.count == 3 && lifted.option(0).state == ContactState::elastic_stick &&
             lifted.option(1).state == ContactState::slip_forward &&
             lifted.option(2).state == ContactState::slip_backward,
         "as it may where its load has jumped to none and grows");
  lifted.does = lifted.option(2);
  lifted.land(pressed);
  expect(pressed.skin == 0 && pressed.slide == 0, "from where it has no force either");

  Touch turned(pd::Contact<double>{0, 0, 1000, peak, 3});
  turned.load = {1, 0};
  turned.does = Touch::slip(1, Bound::none);
  State back = at(-0.01, 0);
  back.slide = 0.005;
  turned.ask(back);
  expect(
      turned.option(0).state == ContactState::slip_backward,
      "where a load jumps from none under a slider ahead of a pin that turned, it follows the pin");
}

void lifts() {
  Touch touch = gripping(skin);
  touch.load = {0, 5};
  State state = at(0.01, 0);
  touch.ask(state);
  expect(touch.keeps_off_zero(state, 1, 2) == 2 && touch.load.rate == 5,
         "a load that grows from zero is followed by skin without a curve");
  Touch falls(pd::Contact<double>{0.2, 0.3, 1000, falling, 2});
  falls.load = {0, 5};  // its limit grows as fast as a pin of 1.5 mm/s stretches it
  State slow = at(1.4e-3, 0), just = at(1.5e-3, 0);
  expect(falls.keeps_off_zero(slow, 1, 2) == 2 && falls.load.rate == 5,
         "by one that it can grip under, too");
  const double asked = falls.keeps_off_zero(just, 1, 2);
  expect(asked > 1 && asked < 1 + 1e-9 && falls.load.rate == 0,
         "where it could grip at its limit only, it waits until its rounds have times");
  // 0 N up to 1 mm/s, from there 1 N for each 10 mm/s.
  const pd::Branch<double> rising[] = {{0, 1e-3, 0, 0, 0}, {1e-3, never, 0, 100, 0}};
  Touch rises(pd::Contact<double>{0, 0, 1000, rising, 2});
  rises.load = {0, 5};
  State level = at(1e-3, 0);
  const double rising_from = rises.keeps_off_zero(level, 1, 2);
  expect(rising_from > 1 && rising_from < 1 + 1e-9 && rises.load.rate == 0,
         "at the speed at which a curve begins to rise it waits no longer than it carries nothing");
  const pd::Branch<double> flat[] = {{0, never, 1.4e-6, 0, 0}};
  Touch even(pd::Contact<double>{1.4e-6, 1.4e-6, 11.200000000000001, flat, 1});
  even.load = {0, 800};  // its limit grows as fast as a pin of 0.1 mm/s stretches it, to rounding
  State as_fast = at(-1e-4, 0);
  even.ask(as_fast);
  expect(even.option(0).state == ContactState::elastic_stick,
         "where it can just grip at its limit, to rounding, it may");
  touch.load = {1, -1};
  expect(touch.keeps_off_zero(state, 1, 2) == 2 && touch.load.value == 1,
         "one far from zero is followed until its row");
  touch.load = {1e-20, -1e-6};
  touch.keeps_off_zero(state, 1, 1 + 1e-14);
  expect(touch.load.value == 0 && touch.load.rate == 0, "the last of one that ends is none");
  Touch rigid(pd::Contact<double>{0.2, 0.3});
  rigid.load = {1e-20, -1e-6};
  expect(rigid.keeps_off_zero(state, 1, 1 + 1e-14) == 1 + 1e-14 && rigid.load.rate == -1e-6,
         "a rigid contact needs none of this");
}

}  // namespace

int main() {
  grips();
  slips();
  runs_away_at_rest();
  lifts();
  return check::status();
}
