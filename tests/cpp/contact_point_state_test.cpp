// A contact at an instant: which way an option slips, and what is asked of what it does.
#include "pindrive/law/contact_point_state.hpp"

#include <limits>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using pd::ContactState;
using pd::detail::ActiveGuard;
using ContactPointState = pd::detail::ContactPointState<double>;

int main() {
  const auto forward = ContactPointState::slip(1, ActiveGuard::upper, 2),
             backward = ContactPointState::slip(-1, {});
  expect(forward.state == ContactState::slip_forward && forward.slip_sign == 1 &&
             forward.guard == ActiveGuard::upper && forward.branch == 2,
         "a slip with a sense of 1 is forward, at an end of its branch");
  expect(backward.state == ContactState::slip_backward && backward.branch == 0,
         "one with −1 backward, on the first");

  constexpr double never = std::numeric_limits<double>::infinity();
  const pd::Branch<double> curve[] = {{0, 0.1, 0.3, -1, 0}, {0.1, never, 0.2, 2, 0}};
  ContactPointState point(pd::Contact<double>{0.3, 0.4, never, curve, 2});
  expect(!point.sliding() && !point.elastic() && point.stick_limit() == 0.4,
         "it begins absent, under its own load");
  point.load = {0.5, 3};
  point.mode = ContactPointState::slip(-1, ActiveGuard::none, 1);
  expect(point.sliding() && point.branch().slope == 2 && point.stick_limit() == 0.2,
         "it slips on a branch, and half the load sticks half as well");
  point.mode = {ContactState::elastic_stick, ActiveGuard::none, 0, 0};
  expect(point.elastic() && !point.sliding(), "skin that grips does not slide");
  return check::status();
}
