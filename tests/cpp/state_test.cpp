// What counts as exact at an instant.
#include "pindrive/law/state.hpp"

#include "check.hpp"

using check::expect;
using pindrive::detail::stays_at_bound, pindrive::detail::grazes;

int main() {
  // A parabola of slope r and curvature c dips by r²/2c.
  expect(grazes(-1e-3, 1.0, 1e-6) && !grazes(-2e-3, 1.0, 1e-6),
         "a guard touches zero if it dips by no more than its roundoff");
  expect(!grazes(1e-9, 1.0, 1e-6) && !grazes(0.0, 1.0, 1e-6) && !grazes(-1e-9, -1.0, 1e-6),
         "one that rises, stands or bends down does not touch");
  expect(stays_at_bound(-2e-9, -1e-9, 1e-9) && stays_at_bound(1e-9, 0.0, 1e-9),
         "what falls by rounding stays");
  expect(!stays_at_bound(-3e-9, 0.0, 1e-9), "what falls farther and comes back does not");
  expect(!stays_at_bound(0.0, -2e-9, 1e-9) && !stays_at_bound(0.0, 2e-9, 1e-9),
         "nor does what ends elsewhere");
  return check::status();
}
