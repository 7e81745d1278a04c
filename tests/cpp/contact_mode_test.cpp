// Modes of a contact and the list of candidates.
#include "pindrive/law/contact_mode.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using pd::ContactState;
using pd::detail::ActiveGuard;
using ContactMode = pd::detail::ContactMode<double>;

int main() {
  const auto forward = ContactMode::slip(1, ActiveGuard::upper, 2),
             backward = ContactMode::slip(-1, ActiveGuard::none);
  expect(forward.state == ContactState::slip_forward && forward.slip_sign == 1 &&
             forward.guard == ActiveGuard::upper && forward.branch == 2,
         "a positive slip sign is forward slip");
  expect(backward.state == ContactState::slip_backward && backward.branch == 0,
         "a negative slip sign is backward slip, by default on the first branch");

  pd::detail::Candidates<double> candidates;
  expect(candidates.size() == 0, "there are no candidates at first");
  candidates.add(forward, {0.2, 0.1, false, false});
  candidates.add(backward, {0.3, 0, false, true});
  candidates.swap(0, 1);
  expect(candidates.size() == 2 && candidates[1].mode.slip_sign == 1 &&
             candidates[1].start.friction == 0.2 && candidates[0].start.shortens_skin,
         "swapped candidates keep their friction and slider");
  candidates.clear();
  expect(candidates.size() == 0, "a cleared list is empty");
  return check::status();
}
