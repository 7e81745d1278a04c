// The highest and lowest value of a vibration on a line, looked for near the ends alone, against a
// walk along all its extrema: decaying, steady and growing, over many periods.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "pindrive/motion/transient.hpp"

namespace pd = pindrive;

namespace {

struct Range {
  double low{HUGE_VAL}, high{-HUGE_VAL};
  int visits{0};

  void operator()(double, double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    ++visits;
  }
};

}  // namespace

int main() {
  std::mt19937_64 random(298);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double ratios[] = {0, 1e-5, 1e-3, 0.1, 0.9, 1, 3, -1e-5, -1e-3, -0.02};
  int failures = 0, longest = 0, most = 0;
  for (int i = 0; i < 4000; ++i) {
    const double ratio = ratios[i % 10];
    const double omega0 = std::pow(10, 2 * uniform(random));
    const pd::Oscillator<double> oscillator(1, 2 * ratio * omega0, omega0 * omega0);
    pd::Path<double> path{uniform(random), uniform(random), omega0 * uniform(random), 0};
    // From a line that hardly rises in all this time to one that hides the vibration.
    if (i % 3 > 0) path.drift = uniform(random) * omega0 * std::pow(10, 2 * uniform(random) - 3);
    pd::Segment<double> segment{};
    segment.end = HUGE_VAL;
    segment.flow = {oscillator, path, path.derivative(oscillator)};
    const double to = std::pow(10, 1.5 + 1.2 * uniform(random)) / omega0;
    const double from = i % 4 > 0 ? 0 : to * std::abs(uniform(random));

    Range walk, ends;
    const pd::detail::ClosedForm<double> along(segment);
    pd::detail::extrema(along, path, from, to, walk);
    pd::detail::highest_and_lowest(along, path, from, to, ends);
    const double rounding = 1e-15 * (10 + omega0 * to) * std::max(walk.high, -walk.low);
    longest = std::max(longest, walk.visits);
    most = std::max(most, ends.visits);
    if (std::abs(walk.low - ends.low) <= rounding && std::abs(walk.high - ends.high) <= rounding)
      continue;
    std::printf("case %d: [%.17g, %.17g] along the way, [%.17g, %.17g] from the ends\n", i,
                walk.low, walk.high, ends.low, ends.high);
    ++failures;
  }
  std::printf("4000 paths of up to %d extrema, at most %d looked at, %d failures\n", longest, most,
              failures);
  return failures == 0 && most <= 12 ? 0 : 1;
}
