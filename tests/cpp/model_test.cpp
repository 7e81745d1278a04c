// What goes into the core: friction curves as branches, inputs over time, and the transitions of a contact.
#include "pindrive/model/model.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using pd::ContactState;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

void curves() {
  const double speeds[] = {0, 0.1, 0.2, 0.4}, forces[] = {1, 0.8, 0.6, 0.5};
  pd::Branch<double> branches[5];
  int count = pd::branches_of(speeds, forces, 4, branches);
  expect(count == 3 && branches[0].to == 0.2 && branches[1].from == 0.2,
         "rows on one line, to rounding, make one branch");
  expect(branches[1].to > 1.399 && branches[1].to < 1.401 && branches[2].force == 0 &&
             branches[2].to == never,
         "the last slope falls to zero and stays there: friction never pushes");
  const double rising[] = {1, 0.8, 0.6, 0.9};
  count = pd::branches_of(speeds, rising, 4, branches);
  expect(count == 2 && branches[1].to == never && branches[1].at(0.6) > 1.199,
         "a last slope that rises goes on");
  expect(pd::branches_of(speeds, forces, 1, branches) == 0, "one row is Coulomb friction");

  const pd::Contact<double> contact{1, 1, never, branches, count};
  expect(contact.branch_of(0.1) == 0 && contact.branch_of(0.2) == 1,
         "a speed at a breakpoint lies on the branch beyond");
  expect(contact.present() && contact.rigid() && !pd::Contact<double>{}.present(),
         "a contact without friction is absent");
}

void inputs() {
  const double times[] = {1, 2, 2, 4}, values[] = {5, 7, 1, 1};
  const pd::Profile<double> profile(times, values, 4);
  expect(profile.from(0.0).value == 5 && profile.from(0.0).rate == 0, "constant before its rows");
  expect(profile.from(1.5).value == 6 && profile.from(1.5).rate == 2, "linear between them");
  expect(profile.from(2.0).value == 1, "after a step at the step");
  expect(profile.next_breakpoint(1.0) == 2 && profile.next_breakpoint(4.0) == never,
         "rows are after a time");
  expect(pd::Profile<double>(3).constant() && pd::Profile<double>(3).from(9.0).value == 3,
         "a number is a profile");
}

void raised_inputs() {
  const double times[] = {1, 2, 3}, values[] = {1, 0, 4}, power = 2.0 / 3;
  const pd::Profile<double> profile = pd::Profile<double>(times, values, 3).to_the(power);
  const pd::Curve<double> falling = profile.from(1.5);
  expect(check::near(falling.value, std::pow(0.5, power), 1e-15) && falling.raised &&
             !falling.straight() && !profile.straight(),
         "a line between rows is raised to a power");
  expect(check::near(falling.at(0.25), std::pow(0.25, power), 1e-15) &&
             check::near(falling.from(0.25).rate, -power * std::pow(0.25, power - 1), 1e-14),
         "at later times too");
  expect(check::near(falling.second(), power * (power - 1) * std::pow(0.5, power - 2), 1e-14),
         "with its derivatives");
  const double chord = profile.next_breakpoint(1.5);
  expect(chord < 2 && 2 - chord < 2e-10 && profile.from(chord).straight() &&
             profile.next_breakpoint(chord) == 2,
         "close to zero it is a chord");
  expect(profile.from(2.0).value == 0 && profile.from(2.0).straight() &&
             profile.next_breakpoint(2.0) - 2 < 1e-10,
         "and from zero on");
  const double least = std::pow(pd::RaisedLine<double>::least, power);
  expect(std::abs(profile.from(chord).value - least) < 1e-6 * least, "which begins at the power");
  expect(profile.from(3.0).value == profile.from(9.0).value && profile.from(3.0).steady() &&
             check::near(profile.first(), 1, 1e-15) &&
             check::near(profile.from(3.0).value, std::pow(4, power), 1e-15),
         "a constant is raised as well");
  expect(profile.given_from(1.5).value == 0.5 && profile.turns(1.5, 2.5) && !profile.turns(1, 1.9),
         "what it is made of is known");
  const pd::Profile<double> one = pd::Profile<double>(times, values, 3).to_the(1);
  expect(one.straight() && one.from(1.5).straight(), "a power of 1 is a line");
}

void transitions() {
  const auto stick = ContactState::stick, back = ContactState::slip_backward,
             on = ContactState::slip_forward, skin = ContactState::elastic_stick;
  expect(
      pd::change(on, on) == pd::Transition::none && pd::change(on, back) == pd::Transition::cross,
      "a slip that reverses crosses");
  expect(pd::change(on, stick) == pd::Transition::stick &&
             pd::change(stick, back) == pd::Transition::slip &&
             pd::change(skin, on) == pd::Transition::slip,
         "a slip ends in a stick, a stick in a slip");
  expect(pd::stops(pd::Transition::cross) && !pd::stops(pd::Transition::slip),
         "a sliding velocity comes to zero where a contact crosses or sticks");
}

}  // namespace

int main() {
  curves();
  inputs();
  raised_inputs();
  transitions();
  return check::status();
}
