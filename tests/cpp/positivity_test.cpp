// What PositivityBound proves against dense scanning: no dip below zero escapes it, however short, and what
// it says is the lowest is nearly so; for paths that are made to touch zero between two times.
#include "pindrive/flow/positivity.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "cases.hpp"
namespace pd = pindrive;

namespace {

using PositivityBound = pd::detail::PositivityBound<double>;

constexpr double unseen = 1e-10;

/// Over the whole of a panel at once, which certify walks in 17 steps.
double lowest(const pd::Oscillator<double>& oscillator, const PositivityBound& guard, double low,
              double high) {
  const auto at = [&](double tau) { return guard.at(oscillator.after(tau)); };
  const auto flatness = guard.flatness(oscillator, oscillator.after(low), low, high - low);
  return guard.lowest(oscillator, at(low), at(high), flatness, unseen);
}

}  // namespace

int main() {
  std::mt19937_64 random(298);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double ratios[] = {0, 1e-3, 0.1, 0.7, 1 - 1e-9, 1, 1 + 1e-9, 1.5, 20, -0.02, -0.3, -1.2};
  int failures = 0, dips = 0;
  for (int i = 0; i < cases(6000); ++i) {
    const double ratio = ratios[i % 12];
    const double omega0 = std::pow(10, 2 * uniform(random));
    const pd::Oscillator<double> oscillator(1, 2 * ratio * omega0, omega0 * omega0);
    const double fastest = omega0 * (1 + std::abs(ratio));
    const double low = 4 * std::abs(uniform(random)) / fastest, high = low + 8 / fastest;
    pd::Path<double> path{0, uniform(random), omega0 * uniform(random), 0};
    if (i % 2 == 1) path.drift = 0.2 * omega0 * uniform(random);
    // The lowest point of the path by a dense scan, then raised so that it dips by very little.
    const auto scan = [&] {
      const int steps = 4000;
      double least = path.at(oscillator, low);
      for (int k = 1; k <= steps; ++k)
        least = std::min(least, path.at(oscillator, low + (high - low) * k / steps));
      return least;
    };
    const double size = std::abs(scan()) + 1;
    const double depth = size * std::pow(10, -5 + 3 * uniform(random));
    path.start -= scan() + (i % 3 == 0 ? -depth : depth);
    const double least = scan(),
                 found = lowest(oscillator, PositivityBound(oscillator, path), low, high);
    // Nothing deeper than `unseen` escapes; a dip is told at all wherever there is one, and what
    // is told is a value that the path has.
    const double noise = 1e-12 * size;
    const bool told = found < 0 || least >= -unseen - noise;
    const bool true_to_it = found >= least - 1e-6 * size;
    if (least < 0) ++dips;
    if (told && true_to_it) continue;
    ++failures;
    std::printf("FAIL %d: ratio %g, least %g, found %g\n", i, ratio, least, found);
  }
  std::printf("%d dips, %d failures\n", dips, failures);
  return failures == 0 && dips > cases(3000) ? 0 : 1;
}
