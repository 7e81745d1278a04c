// Irregular motions: no period, no growth and no decay, told from durations and ranges of many events.
#include "pindrive/events/irregularity.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

/// Ending of events whose positions and durations repeat after `period` events, but for a factor each period.
template <class Duration>
pd::Outcome<double> ending(int period, double factor, Duration&& duration) {
  pd::detail::IrregularityDetector<double> detector;
  pd::Outcome<double> outcome;
  double time = 0;
  for (int i = 0; i < 2 * pd::detail::irregular_window * pd::detail::irregular_windows; ++i) {
    const int within = i % period;
    const double size = std::pow(factor, i / period) * (1 + (within * 7) % period);
    pd::Segment<double> segment{};
    segment.begin = time;
    segment.end = time += duration(i, within);
    detector.visit(segment, time, {1e-3 * size, 0, 0, 1e-3, 0}, outcome);
    if (outcome.end == pd::End::irregular) return outcome;
  }
  return outcome;
}

}  // namespace

int main() {
  const auto same = [](int, int within) { return 1e-3 * (1 + within % 5); };
  const auto quasi_periodic = [](int i, int) { return 1e-3 * (1.5 + std::sin(i / 17.3)); };
  const auto irregular = ending(1, 1, quasi_periodic);
  expect(irregular.end == pd::End::irregular, "durations that vary without a period are irregular");
  expect(irregular.cycle_begin > 0, "from the middle of the windows on");
  expect(ending(30, 1 - 1e-5, same).end != pd::End::irregular,
         "a slow decay with 30 events in a period is not: the windows hold whole periods");
  expect(ending(30, 1 + 1e-5, same).end != pd::End::irregular, "nor is a slow growth");
  expect(ending(30, 1 - 1e-5, quasi_periodic).end != pd::End::irregular,
         "nor a decay whose durations vary");
  return check::status();
}
