// An overdamped pin under inputs without a closed form: its slow motion beside the Taylor series of the whole motion,
// and what it costs however strong the damping.
#include "pindrive/series/overdamped.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "check.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/series/creep.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

/// A pull that decays from 40 times the weight, within 1 ms.
struct Pull {
  pd::InputTerm<double> term{40, 0, 1e3, 0};
  pd::InputPiece<double> piece{0, {1}, &term, 1};
};

/// A pin in slip behind the plate, under a damping ratio.
pd::detail::SeriesEquation<double> equation(double ratio, const Pull& pull) {
  pd::detail::SeriesEquation<double> e{0.01, 2 * ratio, 100};
  e.plate_velocity = {0.06, 0};
  e.load = {pull.piece, 0};
  e.plate_force = 0.02;
  e.side = -1;
  return e;
}

void beside_the_taylor_series() {
  const Pull pull;
  for (const double ratio : {300.0, 3000.0}) {
    pd::detail::SeriesEquation<double> e = equation(ratio, pull);
    pd::detail::SeriesState<double> slow{1e-3, 0}, whole{1e-3, 0};
    int slow_steps = 0, steps = 0;
    const auto follow = [&](auto& state, int& count, auto step_of) {
      auto at = e;
      for (double t = 0; t < 2e-3 * (1 - 1e-12); ++count) {
        const pd::detail::SeriesStep<double> step = step_of(at, state, 2e-3 - t);
        state = step.at(step.span());
        state.time = 0;
        at = at.from(step.span());
        t += step.span();
      }
    };
    follow(slow, slow_steps,
           [](auto& at, auto& s, double left) { return pd::detail::series_step(at, s, left); });
    follow(whole, steps, [](auto& at, auto& s, double left) {
      return pd::detail::SeriesFlow<double>(at, s, left);
    });
    std::printf("# damping ratio %g: %d steps instead of %d\n", ratio, slow_steps, steps);
    expect(std::abs(slow.x - whole.x) < 1e-17 && std::abs(slow.v - whole.v) < 1e-13 * 0.06,
           "the slow motion is the whole one");
    expect(10 * slow_steps < steps || ratio < 1000, "in fewer steps");
  }
}

void however_strong() {
  const Pull pull;
  std::vector<std::size_t> counts;
  for (const double ratio : {1e3, 1e4, 1e5, 1e6}) {
    const pd::Drive<double> drive{0.01, 100, 2 * ratio, {0.02, 0.026}, {0.005, 0.0075}};
    pd::Inputs<double> inputs{0.06, 1e-3, 0.06, 0.05};
    inputs.plate_load = {&pull.piece, 1};
    std::vector<pd::Segment<double>> segments;
    const auto outcome = pd::simulate(drive, inputs, [&](const auto& s) { segments.push_back(s); });
    expect(outcome.status == pd::Status::ok, "a motion is simulated");
    counts.push_back(segments.size());
    const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
    expect(pd::Certifier<double>(motion, 0.05).certify().worst() < 1e-12, "that obeys the laws");
  }
  std::printf("# segments: %zu %zu %zu %zu\n", counts[0], counts[1], counts[2], counts[3]);
  expect(*std::max_element(counts.begin(), counts.end()) < 200, "in few steps, however strong");
}

}  // namespace

int main() {
  beside_the_taylor_series();
  however_strong();
  return check::status();
}
