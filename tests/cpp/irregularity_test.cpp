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

/// Ending of a response with a position at the begin of each period of its inputs.
template <class Position>
pd::Outcome<double> response(Position&& position) {
  pd::detail::IrregularityDetector<double> detector;
  pd::Outcome<double> outcome;
  for (int n = 0; n < 4 * pd::detail::irregular_periods * pd::detail::irregular_windows; ++n) {
    detector.visit_period(n, {position(n), 0, 0, 0, 0}, outcome);
    if (outcome.end == pd::End::irregular) return outcome;
  }
  return outcome;
}

void responses() {
  constexpr double turn = 6.283185307179586;
  const auto quasi_periodic = [&](double frequency) {
    return response([=](int n) { return 1e-3 * std::sin(turn * frequency * n); });
  };
  const auto found = quasi_periodic(0.382);
  expect(found.end == pd::End::irregular, "a response with two frequencies is irregular");
  expect(found.cycle_begin > 2000 && found.cycle_begin < 4000, "from the middle of the windows on");
  bool all = true;
  for (int n = 1; n < pd::detail::irregular_periods; ++n)
    all =
        all && quasi_periodic((n + 0.02) / pd::detail::irregular_periods).end == pd::End::irregular;
  expect(all, "also if it all but repeats from window to window");
  double x = 0.3;
  expect(response([&](int) { return x = 3.9 * x * (1 - x); }).end == pd::End::irregular,
         "so is a chaotic one");
  const auto is_approached = [](int period, double contraction) {
    return response([=](int n) {
             const double turning = std::pow(contraction, n) * std::sin(2.4 * n);
             return 1e-3 * (n * 5 % period) + 1e-4 * turning;
           }).end != pd::End::irregular;
  };
  expect(is_approached(1, 1 - 1e-5) && is_approached(7, 1 - 1e-4),
         "a response that turns about one that repeats, ever closer, is not");
  expect(is_approached(1, 1 + 1e-5), "nor one that turns away from it");
  const auto passes = [](int n) { return std::pow(0.998, n) + 1e-6 * std::pow(1.002, n); };
  expect(response(passes).end != pd::End::irregular,
         "nor one that comes close to an unstable response and leaves it");
}

}  // namespace

int main() {
  responses();
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
