// Plain releases as the kernel sees them: their plates move forward, and what the kernel cannot follow is marked.
#include "pindrive/kernel/plain_release.hpp"

#include <array>
#include <cmath>

#include "check.hpp"
#include "pindrive/numbers/pack.hpp"

namespace pk = pindrive::detail;
using check::expect;
using check::near;
using Release = pk::PlainRelease<double>;
using Forward = pk::ForwardRelease<double>;

namespace {

constexpr double inf = __builtin_inf();

Release release() {
  return {0.01, 100, 0.4, 0.02, 0.03, 0.005, 0.006, inf, 0.1, 1.5e-3, 0.05, inf, 0.05};
}

void mirrored() {
  Release other = release();
  other.mouse_velocity = -0.1;
  other.displacement = -1.5e-3;
  other.velocity = -0.05;
  const Forward one(release()), two(other);
  expect(one.mirror == 1 && two.mirror == -1, "the mirror says which way the plate moves");
  expect(one.vp == two.vp && one.start == two.start && one.start_velocity == two.start_velocity &&
             one.drag == two.drag && one.size == two.size,
         "a drive and its mirror image are one seen from the plate");
}

void centres() {
  const Forward r(release());
  expect(
      near(r.between, (0.02 - 0.005) / 100, 1e-16) && near(r.outside, (0.02 + 0.005) / 100, 1e-16),
      "the centres are where the spring balances what both surfaces do");
  expect(near(r.carrying(1e-3), 100 * 1e-3 + 0.4 * 0.1 + 0.005, 1e-16),
         "a plate that carries the pin holds spring, damper and finger");
}

void plain() {
  const auto follows = [](double Release::* given, double value) {
    Release r = release();
    r.*given = value;
    return Forward(r).plain;
  };
  expect(follows(&Release::mass, 0.01), "the kernel follows a plain release");
  expect(!follows(&Release::finger_stiffness, 1000), "... none on skin,");
  expect(!follows(&Release::mouse_velocity, 0), "... none of a mouse at rest,");
  expect(!follows(&Release::plate_static, 0) && !follows(&Release::finger_static, 0),
         "... none without friction,");
  expect(!follows(&Release::damping, 2 * std::sqrt(0.01 * 100.0)) &&
             follows(&Release::damping, 1.9 * std::sqrt(0.01 * 100.0)),
         "... and none that hardly oscillates");
}

void ties() {
  const Forward r(release());
  const double bit = 1e-13 * r.size;
  expect(r.tie(0.02, 0.02 + bit) && !r.tie(0.02, 0.02 + 100 * bit),
         "two forces tie that differ by rounding of the largest");
  expect(near(r.slack() / (1e-12 * r.size / 100), 1, 1e-15),
         "... and positions by what that moves");
}

void parity() {
  bool right = true;
  for (double n = 0; n < 20; ++n) right = right && pk::one_or_minus_one(n) == std::pow(-1.0, n);
  expect(right && pk::one_or_minus_one(0x1p51 + 1) == -1, "even numbers give 1, odd ones −1");
  const std::array<double, 2> two{6, 7};
  double found[2];
  pk::store(pk::one_or_minus_one(pk::load<pk::Pack<2>>(two.data())), found);
  expect(found[0] == 1 && found[1] == -1, "... in packs too");
}

}  // namespace

int main() {
  mirrored();
  centres();
  plain();
  ties();
  parity();
  return check::status();
}
