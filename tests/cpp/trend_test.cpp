// Growth and decay of motions that neither end nor return in a reasonable number of periods.
#include "pindrive/events/trend.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect, check::near;

namespace {

/// Outcome of an oscillation with two events in a period of 0.1 s, whose amplitude is a function of the number of periods.
template <class Amplitude>
pd::Outcome<double> outcome(Amplitude&& amplitude, double most = 2 * pd::detail::approach_limit) {
  pd::detail::Trend<double> trend;
  pd::Outcome<double> found;
  for (int i = 0; i < 2 * most && !found.unbounded() && !trend.is_too_long(); ++i) {
    const double x = amplitude(0.5 * i) * (i % 2 == 0 ? 1e-3 : -1e-3);
    pd::Segment<double> segment{};
    segment.begin = 0.05 * i;
    segment.end = 0.05 * (i + 1);
    segment.flow.velocity.value = 0.1;
    const pd::detail::State<double> state{x, 0, 0, 1e-3, 0};
    trend.add(segment, state);
    trend.visit(segment.end, state, found);
  }
  if (trend.is_too_long()) trend.conclude(found);
  return found;
}

}  // namespace

int main() {
  const auto linear = outcome([](double n) { return 1 + 0.01 * n; });
  expect(linear.end == pd::End::growing, "an oscillation that grows by a constant grows");
  expect(near(linear.period, 0.1, 1e-9), "... with its period");
  expect(linear.growth > 1 && linear.growth < 1.001, "... by the factor of the last periods");

  const auto limited = outcome([](double n) { return 2 - std::exp(-6e-5 * n); });
  expect(limited.end == pd::End::approaching && near(limited.growth, std::exp(-6e-5), 1e-9),
         "one that tends to a larger amplitude approaches that");
  const auto shrinking = outcome([](double n) { return std::exp(-2e-5 * n); });
  expect(shrinking.end == pd::End::approaching && near(shrinking.growth, std::exp(-2e-5), 1e-9),
         "one that decays by a factor in each period approaches its limit");
  const auto algebraic = outcome([](double n) { return 1 + 100 / (n + 100); });
  expect(algebraic.end == pd::End::approaching && algebraic.growth > 0.999,
         "an algebraic approach has a factor that tends to 1");

  const auto quick = [](double n) { return 1 + std::exp(-1e-3 * n); };
  expect(outcome(quick, 20'000).end == pd::End::moving, "an approach that ends soon is followed");
  const auto linear_decay = [](double n) { return std::max(1 - 5e-5 * n, 0.1); };
  expect(outcome(linear_decay, 15'000).end == pd::End::moving, "so is a linear decay");
  const auto irregular = [](double n) { return 1 + 0.3 * std::sin(n * n); };
  expect(outcome(irregular).end == pd::End::moving,
         "what neither grows nor decays is terminated without an ending");
  return check::status();
}
