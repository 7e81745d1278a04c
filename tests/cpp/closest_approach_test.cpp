// Closest approach of two pins against dense samples: in closed form, by series, and in cycles.
#include "pindrive/device/closest_approach.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
namespace device = pindrive::device;
using check::expect;

namespace {

/// Pin under a plate that moves at an even speed, or also across.
struct Pin {
  pd::Drive<double> drive;
  std::vector<double> times{0, 1}, across{0.03, 0.03};
  pd::Inputs<double> inputs;
  std::vector<pd::Segment<double>> segments;
  pd::Outcome<double> outcome;

  Pin(const pd::Drive<double>& with, double displacement, bool oblique)
      : drive(with), inputs{0.05, displacement, 0.05, 1} {
    if (oblique) inputs.across_velocity = {times.data(), across.data(), 2};
    outcome = pd::simulate(drive, inputs, [&](const auto& s) { segments.push_back(s); });
  }
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;
  pd::Motion<double> motion() const {
    return {drive, inputs, segments.data(), segments.size(), outcome};
  }
};

void compare(const Pin& behind, const Pin& ahead, const char* what) {
  constexpr double duration = 0.6;
  const pd::Motion<double> one = behind.motion(), other = ahead.motion();
  const auto at = [](const pd::Motion<double>& motion, double t) {
    const auto [segment, tau] = motion.locate(t, pd::Side::right);
    return motion.value(*segment, tau, pd::Quantity::position);
  };
  const device::BoundedPieces first(one, duration), second(other, duration);
  const device::Approach found = device::ClosestApproach(first, second, duration).found();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 60000; ++i) {
    const double t = duration * i / 60000;
    least = std::min(least, at(one, t) - at(other, t));
  }
  std::printf("# %s: %.9e m at %.6f s, sampled %.9e\n", what, found.difference, found.time, least);
  expect(found.difference <= least + 1e-15, "no sample is smaller");
  expect(found.difference > least - 1e-9, "and the samples come close");
  expect(std::abs(at(one, found.time) - at(other, found.time) - found.difference) < 1e-15,
         "it is the difference at its time");
}

}  // namespace

int main() {
  const pd::Drive<double> slow{0.01, 100, 0.2, {0.006, 0.007}, {0.002, 0.002}};
  const pd::Drive<double> fast{0.005, 300, 0.1, {0.01, 0.02}, {}};
  const Pin released(slow, 2e-3, false), other(slow, -1.5e-3, false), cycling(fast, 0, false);
  compare(released, other, "two releases");
  compare(other, released, "the other way round");
  compare(released, cycling, "beside stick-slip");
  const Pin oblique(slow, 2e-3, true), askew(fast, 1e-3, true);
  compare(oblique, askew, "by series");
  compare(oblique, released, "series beside closed forms");
  const device::BoundedPieces pieces(cycling.motion(), 0.6);
  double worst = 0;
  for (int i = 0; i < 6000; ++i) {
    const double t = 1e-4 * i;
    const auto [segment, tau] = cycling.motion().locate(t, pd::Side::right);
    const double now = cycling.motion().value(*segment, tau, pd::Quantity::acceleration);
    worst = std::max(worst, std::abs(now) / (pieces.bound(pieces.place(t)) + 1e-9));
  }
  expect(worst <= 1 + 1e-9 && worst > 0.9,
         "no acceleration is beyond its bound, and one attains it");
  return check::status();
}
