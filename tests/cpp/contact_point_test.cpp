// What a contact may do next, and the force that it carries: by its state, its speed and its branch.
#include "pindrive/law/contact_point.hpp"

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
  ContactPoint point(contact);
  point.surface.value = surface;
  State state = at(v);
  point.initialize(state, false);
  return point;
}

void options() {
  const pd::Contact<double> absent{}, rigid{0.2, 0.3};
  ContactPoint none = begun(absent, 0.1);
  none.enumerate_candidates(at(0.1));
  expect(none.candidates.size() == 1 && none.mode.state == ContactState::absent &&
             none.force(at(0.1)) == 0,
         "an absent contact stays so and carries nothing");

  ContactPoint point = begun(rigid, 0.1, 0.02);
  point.enumerate_candidates(at(0.1));
  expect(point.candidates.size() == 1 && point.mode.state == ContactState::slip_forward,
         "one that slips inside its branch goes on");
  expect(point.force(at(0.1)) == -0.2, "... against its sliding");

  point.enumerate_candidates(at(0.02));
  expect(point.candidates.size() == 3 && point.may_stick() &&
             point.candidates[1].mode.state == ContactState::slip_backward,
         "one that comes to its surface velocity may stick, cross or turn back, in this order");
  ContactPoint lighter = begun(rigid, 0.1, 0.02);
  lighter.load = {0.5, 0};
  lighter.enumerate_candidates(at(0.02));
  lighter.choose(1);
  expect(lighter.force(at(0.02)) == 0.1, "its force is in proportion to the load");
}

void breakpoints() {
  const pd::Branch<double> curve[] = {{0, 0.1, 0.3, -1, 0}, {0.1, never, 0.2, 2, 0}};
  const pd::Contact<double> contact{0.3, 0.3, never, curve, 2};
  ContactPoint point = begun(contact, -0.04);
  point.enumerate_candidates(at(-0.04));
  expect(point.mode.state == ContactState::slip_backward && point.force(at(-0.04)) == 0.26,
         "on a branch the force follows the speed");
  point.reached_guard = ActiveGuard::upper;
  point.enumerate_candidates(at(-0.1));
  expect(point.candidates.size() == 2 && point.candidates[0].mode.branch == 0 &&
             point.candidates[1].mode.branch == 1 &&
             point.candidates[1].mode.guard == ActiveGuard::lower,
         "at a breakpoint it stays on its branch or goes to the next");
  const double one = point.force(at(-0.1));
  point.choose(1);
  expect(one == 0.2 && point.force(at(-0.1)) == 0.2, "... with one force");
  expect(point.is_admissible(at(-0.1), -1.0) && !point.is_admissible(at(-0.1), 1.0),
         "the branch beyond is entered by a speed that grows");
  const auto law = point.force_law(at(-0.1));
  expect(law.drag == 2 && law.constant.value == 0.2 - 2 * 0.1, "its slope is a drag");
}

void elastic_sticks() {
  const pd::Contact<double> skin{0.2, 0.3, 1000};
  ContactPoint point = begun(skin, 0);
  expect(point.elastic(), "compliant skin at rest sticks elastically");
  point.enumerate_candidates(at(0.1, 0.25));
  expect(point.candidates.size() == 1 && point.force(at(0.1, 0.25)) == -0.25,
         "below its limit it stays");
  point.enumerate_candidates(at(0.1, 0.3));
  expect(
      point.candidates.size() == 2 && point.candidates[1].mode.state == ContactState::slip_forward,
      "at its limit and stretching it may slip");
  point.enumerate_candidates(at(-0.1, 0.3));
  expect(point.candidates.size() == 1, "... on its way back it stays");
  const auto law = point.force_law(at(-0.1, 0.3));
  expect(law.stiffness == 1000 && law.constant.value == -0.3, "it is a spring from where it is");
}

void continuity() {
  const pd::Contact<double> even{0.2, 0.2}, more{0.2, 0.3};
  for (const auto* contact : {&even, &more}) {
    ContactPoint point = begun(*contact, 0);
    point.enumerate_candidates(at(0));
    point.choose(2);  // backward
    expect(point.is_continuous(1) == (contact == &even) && !point.is_continuous(-1),
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
