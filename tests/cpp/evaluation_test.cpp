// Touches of a finger over time, and the time after which a pin counts as settled.
#include "pindrive/device/evaluation.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void touches_of_a_load() {
  const auto always = device::touches({1.0});
  expect(always.size() == 1 && always[0].begin == -infinity && always[0].end == infinity,
         "a constant load touches always");
  expect(device::touches({0.0}).empty(), "a load of zero never");
  const std::vector<double> t{0, 1, 2, 3, 4, 5}, load{1, 0, 0, 2, 0, 0};
  const auto found = device::touches({t.data(), load.data(), t.size()});
  expect(found.size() == 2 && found[0].begin == -infinity && found[0].end == 1,
         "until the load has fallen to zero");
  expect(found[1].begin == 2 && found[1].end == 4, "and while it rises and falls again");
  const std::vector<double> grazing{1, 0, 1, 1, 0, 1};
  const auto apart = device::touches({t.data(), grazing.data(), t.size()});
  expect(apart.size() == 3 && apart[2].end == infinity, "an instant of zero parts two touches");
}

void patience() {
  const pd::Drive<double> light{0.01, 100, 0.2, {}, {}}, heavy{0.01, 100, 20, {}, {}};
  expect(std::abs(device::settling_patience(light) - 3.141592653589793 / 100) < 1e-15,
         "half a period of a light damping");
  expect(std::abs(device::settling_patience(heavy) - (10 + std::sqrt(99.0)) / 100) < 1e-14,
         "the slowest decay of a heavy damping");
}

}  // namespace

int main() {
  touches_of_a_load();
  patience();
  return check::status();
}
