// Root isolation against dense scanning: no sign change is missed, invented or misplaced, for
// oscillations with a constant and with a line, decaying, steady and growing, in every regime.
#include "pindrive/flow/roots.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include "cases.hpp"

namespace pd = pindrive;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

template <int Degree>
std::vector<double> isolated(const pd::Oscillator<double>& oscillator, const pd::Path<double>& path,
                             int side, double horizon) {
  std::vector<double> roots;
  pd::detail::Roots<double, Degree> search(oscillator, path, side, horizon);
  for (;;) {
    const double root = search.next();
    if (!(root <= horizon)) return roots;
    roots.push_back(root);
  }
}

/// Sign changes on a fine grid, skipping values that are rounding.
std::vector<double> scanned(const pd::Oscillator<double>& oscillator, const pd::Path<double>& path,
                            int side, double horizon, double noise) {
  std::vector<double> roots;
  const int steps = 20000;
  for (int i = 1; i <= steps; ++i) {
    const double tau = horizon * i / steps;
    const double value = path.at(oscillator, tau);
    if (side * value >= 0 || std::abs(value) < noise) continue;
    roots.push_back(tau);
    side = -side;
  }
  return roots;
}

}  // namespace

int main() {
  std::mt19937_64 random(298);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double ratios[] = {0, 1e-3, 0.1, 0.7, 1 - 1e-9, 1, 1 + 1e-9, 1.5, 20, -0.02, -0.3, -1.2};
  int failures = 0, roots_seen = 0;
  for (int i = 0; i < cases(6000); ++i) {
    const double ratio = ratios[i % 12];
    const double omega0 = std::pow(10, 2 * uniform(random));
    const pd::Oscillator<double> oscillator(1, 2 * ratio * omega0, omega0 * omega0);
    const double horizon = (ratio < 0 ? 8 : 40) * std::abs(uniform(random)) / omega0;
    pd::Path<double> path{uniform(random), uniform(random), omega0 * uniform(random), 0};
    const bool line = i % 2 == 1;
    if (line) path.drift = 0.2 * omega0 * uniform(random);
    if (i % 5 == 0) path.start = 0;             // leaves its zero
    if (i % 15 == 0) path.slope = -path.drift;  // tangentially
    int side = path.start > 0 ? 1 : -1;
    if (path.start == 0) side = path.slope + path.drift > 0 ? 1 : -1;
    if (path.start == 0 && path.slope + path.drift == 0)
      side = oscillator.bend(path.value, path.slope) > 0 ? 1 : -1;
    if (i % 30 == 15)  // or so nearly that it dips by rounding
      path.slope -= side * std::sqrt(2e-15 * std::abs(oscillator.bend(path.value, path.slope)));

    const double growth = std::exp(std::max(0.0, oscillator.slowest_rate() * horizon));
    const auto found = line ? isolated<2>(oscillator, path, side, horizon)
                            : isolated<1>(oscillator, path, side, horizon);
    const auto seen = scanned(oscillator, path, side, horizon, 1e-12 * growth);
    roots_seen += static_cast<int>(found.size());
    const double step = horizon / 20000;
    // Two roots within one grid step are seen by isolation alone; all seen must have been found.
    std::size_t k = 0;
    for (const double tau : seen) {
      while (k < found.size() && found[k] < tau - step * 1.01 - 1e-6 / omega0) ++k;
      if (k == found.size() || found[k] > tau + step * 0.01) {
        std::printf("missed: case %d, sign change by %.17g\n", i, tau);
        ++failures;
        break;
      }
    }
    // Without an end: what is found is the first of all, also far beyond.
    if (ratio >= 1) {
      const double first = pd::detail::first_root(oscillator, path, side, never);
      const double far = found.empty() ? never : found[0];
      const bool beyond = first > horizon && first < never;
      if (far < never ? std::abs(first - far) > 1e-9 * far
          : beyond    ? !(side * path.at(oscillator, 1.01 * first) < 0)
                      : line && side * path.drift < 0) {
        std::printf("without an end: case %d, %.17g instead of %.17g\n", i, first, far);
        ++failures;
      }
    }
    for (const double root : found) {
      if (std::abs(path.at(oscillator, root)) <= 4e-12 * growth * (1 + horizon * omega0)) continue;
      std::printf("invented: case %d, %.17g has value %g\n", i, root, path.at(oscillator, root));
      ++failures;
    }
  }
  std::printf("%d roots in %d paths, %d failures\n", roots_seen, cases(6000), failures);
  return failures == 0 ? 0 : 1;
}
