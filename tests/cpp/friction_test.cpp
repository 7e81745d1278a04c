// What a contact may do next, and the force that it carries: by its state, its speed and its branch.
#include "pindrive/law/friction.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using pd::ContactState;
using pd::detail::ActiveGuard;

namespace {

using ContactPoint = pd::detail::ContactPoint<double>;
using State = pd::detail::State<double>;

constexpr double never = std::numeric_limits<double>::infinity();

State at(double v, double skin = 0) { return {1e-3, v, skin, 1e-3, 1e-16}; }

ContactPoint begun(const pd::Contact<double>& contact, double v, double surface = 0) {
  ContactPoint touch(contact);
  touch.surface.value = surface;
  State state = at(v);
  touch.initialize(state, false);
  return touch;
}

void options() {
  const pd::Contact<double> absent{}, rigid{0.2, 0.3};
  ContactPoint none = begun(absent, 0.1);
  none.enumerate_options(at(0.1));
  expect(none.count == 1 && none.mode.state == ContactState::absent && none.force(at(0.1)) == 0,
         "an absent contact stays so and carries nothing");

  ContactPoint touch = begun(rigid, 0.1, 0.02);
  touch.enumerate_options(at(0.1));
  expect(touch.count == 1 && touch.mode.state == ContactState::slip_forward,
         "one that slips inside its branch goes on");
  expect(touch.force(at(0.1)) == -0.2, "... against its sliding");

  touch.enumerate_options(at(0.02));
  expect(
      touch.count == 3 && touch.may_stick() && touch.option(1).state == ContactState::slip_backward,
      "one that comes to its surface velocity may stick, cross or turn back, in this order");
  ContactPoint lighter = begun(rigid, 0.1, 0.02);
  lighter.load = {0.5, 0};
  lighter.enumerate_options(at(0.02));
  lighter.mode = lighter.option(1);
  expect(lighter.force(at(0.02)) == 0.1, "its force is in proportion to the load");
}

void breakpoints() {
  const pd::Branch<double> curve[] = {{0, 0.1, 0.3, -1, 0}, {0.1, never, 0.2, 2, 0}};
  const pd::Contact<double> contact{0.3, 0.3, never, curve, 2};
  ContactPoint touch = begun(contact, -0.04);
  touch.enumerate_options(at(-0.04));
  expect(touch.mode.state == ContactState::slip_backward && touch.force(at(-0.04)) == 0.26,
         "on a branch the force follows the speed");
  touch.reached_guard = ActiveGuard::upper;
  touch.enumerate_options(at(-0.1));
  expect(touch.count == 2 && touch.option(0).branch == 0 && touch.option(1).branch == 1 &&
             touch.option(1).guard == ActiveGuard::lower,
         "at a breakpoint it stays on its branch or goes to the next");
  const double one = touch.force(at(-0.1));
  touch.mode = touch.option(1);
  expect(one == 0.2 && touch.force(at(-0.1)) == 0.2, "... with one force");
  expect(touch.is_admissible(at(-0.1), -1.0) && !touch.is_admissible(at(-0.1), 1.0),
         "the branch beyond is entered by a speed that grows");
  const auto law = touch.force_law(at(-0.1));
  expect(law.drag == 2 && law.constant.value == 0.2 - 2 * 0.1, "its slope is a drag");
}

void elastic_sticks() {
  const pd::Contact<double> skin{0.2, 0.3, 1000};
  ContactPoint touch = begun(skin, 0);
  expect(touch.elastic(), "compliant skin at rest sticks elastically");
  touch.enumerate_options(at(0.1, 0.25));
  expect(touch.count == 1 && touch.force(at(0.1, 0.25)) == -0.25, "below its limit it stays");
  touch.enumerate_options(at(0.1, 0.3));
  expect(touch.count == 2 && touch.option(1).state == ContactState::slip_forward,
         "at its limit and stretching it may slip");
  touch.enumerate_options(at(-0.1, 0.3));
  expect(touch.count == 1, "... on its way back it stays");
  const auto law = touch.force_law(at(-0.1, 0.3));
  expect(law.stiffness == 1000 && law.constant.value == -0.3, "it is a spring from where it is");
}

void continuity() {
  const pd::Contact<double> even{0.2, 0.2}, more{0.2, 0.3};
  for (const auto* contact : {&even, &more}) {
    ContactPoint touch = begun(*contact, 0);
    touch.enumerate_options(at(0));
    touch.mode = touch.option(2);  // backward
    expect(touch.is_continuous(1) == (contact == &even) && !touch.is_continuous(-1),
           "a force at its limit goes on where static is kinetic friction, to the other side");
  }
}

}  // namespace

int main() {
  options();
  breakpoints();
  elastic_sticks();
  continuity();
  return check::status();
}
