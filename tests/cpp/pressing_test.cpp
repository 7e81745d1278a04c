// What presses on a plate: its load under a pull and a touch that changes.
#include "pindrive/device/pressing.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"

namespace pd = pindrive;
namespace device = pd::device;
using check::expect;

namespace {

/// A pull that decays from 0.6 N, and one that is constant.
std::vector<device::PullPiece<double>> pulls() {
  return {{1.0, 0.1, 0.2, 0.3, 50}, {1.2, 0.1, 0, 0, 50}};
}

double pull_at(double time) { return pulls()[time < 1.2 ? 0 : 1].at(time); }

void a_touch_of_which_the_plate_has_a_share() {
  const double times[] = {0.05, 0.15, 0.3}, factors[] = {1, 0.4, 2};
  const pd::Profile<double> touch(times, factors, 3);
  const device::Pressing<double> pressing{0.08, 0.03};
  const auto loads = device::loads_under(pulls(), pressing, 1.0, touch);
  expect(loads.size() == 5,
         "a load has a piece for each line of the touch and each piece of the pull");
  double worst = 0;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const double begin = loads[i].piece.begin,
                 end = i + 1 < loads.size() ? loads[i + 1].piece.begin : 0.4;
    for (const double part : {0.01, 0.3, 0.9}) {
      const double time = begin + part * (end - begin), touched = touch.from(time).value;
      const double normal = 0.08 - 0.03 + 0.03 * touched + pull_at(1 + time);
      worst = std::max(worst, std::abs(loads[i].piece.at(part * (end - begin)) - normal / 0.08));
      worst = std::max(worst, std::abs(pressing.load(pull_at(1 + time), touched) - normal / 0.08));
    }
  }
  expect(worst < 1e-13, "and is the normal force over that of the usual touch");
}

void a_usual_touch() {
  const device::Pressing<double> with{0.08, 0.03}, without{0.08};
  for (const double factor : {1.0, 2.0}) {
    const pd::Profile<double> touch(factor);
    const auto loads = device::loads_under(pulls(), without, 1.0, touch);
    const auto usual = device::loads_under(pulls(), with, 1.0, pd::Profile<double>(1));
    expect(loads.size() == 2 && loads[0].piece.polynomial == usual[0].piece.polynomial,
           "a usual touch, or one without a share, changes nothing to the bit");
  }
}

}  // namespace

int main() {
  a_touch_of_which_the_plate_has_a_share();
  a_usual_touch();
  return check::status();
}
