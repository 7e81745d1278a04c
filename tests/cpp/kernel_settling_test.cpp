// When a plain release comes within the settling band to stay: stretches whose times are known by hand.
#include "pindrive/kernel/kernel_settling.hpp"

#include <cmath>

#include "check.hpp"

namespace pk = pindrive::detail;
using check::expect;
using check::near;
using Settling = pk::KernelSettling<double>;
using Forward = pk::ForwardRelease<double>;

namespace {

constexpr double inf = __builtin_inf(), pi = 3.14159265358979323846;

/// 10 g on 100 N/m without a damper, so that a slide is a cosine of 100 rad/s; from 1 mm, with a band of 5 %.
const Forward release(pk::PlainRelease<double>{0.01, 100, 0, 0.02, 0.02, 0.005, 0.005, inf, 0.1,
                                               1e-3, 0, inf, 0.05});
const pk::LastTurns<double> none{};

void carried() {
  // The plate carries it from 0.5 mm to rest at 0, at 0.1 m/s: 5 % of 1 mm are left 4.5 ms later.
  Settling settling(0.0);
  settling.remember(true, -0.5e-3, 0.02, 1, 0, 0);
  settling.weigh(release, true, 0.0);
  const auto found = settling.settled(release, none);
  expect(near(found.time, 0.0245, 1e-15) && !found.unsure && !found.within,
         "a stretch that the plate carries it enters the band at its velocity");
}

void slides() {
  // A half turn from 0.4 mm about 0.2 mm, its turning point at 10 ms, ends at 0 as it comes to rest.
  Settling settling(0.0);
  settling.remember(true, 0.4e-3, 0.01, 0.2e-3, 0.2e-3, 1);
  settling.weigh(release, true, 0.0);
  const auto from_start = settling.settled(release, none);
  expect(near(from_start.time, 0.01 + std::acos((0.05e-3 - 0.2e-3) / 0.2e-3) / 100, 1e-15),
         "a slide from its turning point enters where its cosine does");
  // The same slide counted from the turning point at its end, 10 π ms later.
  Settling backward(0.0);
  backward.remember(true, 0.4e-3, 0.01 + pi / 100, -0.2e-3, 0.2e-3, -1);
  backward.weigh(release, true, 0.0);
  expect(near(backward.settled(release, none).time, from_start.time, 1e-15),
         "... as it does from the one at its end");
}

void order() {
  // The last stretch that begins outside of the band is the one that enters it.
  Settling settling;
  expect(!settling.knows_rest(), "the place of rest is not known before it rests");
  settling.remember(true, 0.8e-3, 0.0, 0.4e-3, 0.4e-3, 1);
  settling.remember(true, -0.5e-3, 0.02, 1, 0, 0);
  settling.remember(true, 0.01e-3, 0.03, 1, 0, 0);
  settling.remember(false, -0.9e-3, 0.04, 1, 0, 0);
  settling.weigh(release, true, 0.0);
  expect(settling.knows_rest() && near(settling.settled(release, none).time, 0.0245, 1e-15),
         "of several stretches the last that begins outside enters it");
  Settling inside(0.0);
  inside.remember(true, 0.02e-3, 0.01, 1, 0, 0);
  inside.weigh(release, true, 0.0);
  expect(inside.settled(release, none).within, "where none does, it was within from the start");
  Settling edge(0.0);
  edge.remember(true, 0.05e-3 * (1 + 1e-14), 0.01, 1, 0, 0);
  edge.weigh(release, true, 0.0);
  expect(edge.settled(release, none).unsure,
         "a stretch that begins on the edge is for rounding to decide");
}

void last_turns() {
  // Half turns about ±F_f/k = ±0.05 mm beside the middle, 0.2 mm: 0.31, −0.21, 0.11 and −0.01 mm, at rest. The
  // third one begins outside of 5 % of what is between 1 mm and the rest, and enters that.
  const double end = 0.01e-3, rest = 0.2e-3 - end, width = 0.05 * (1e-3 - rest);
  Settling settling(rest);
  const pk::LastTurns<double> turns{0.31e-3, 0.02, 3, end};
  const auto found = settling.settled(release, turns);
  const double half = pi / 100, angle = std::acos((width - end - 0.05e-3) / 0.06e-3);
  expect(near(release.swing.half, half, 1e-15) &&
             near(found.time, 0.02 + 2 * half + angle / 100, 1e-13) && !found.unsure,
         "of half turns that end at rest the last that begins outside enters the band");
}

}  // namespace

int main() {
  carried();
  slides();
  order();
  last_turns();
  return check::status();
}
