// The core is templated on its scalar: the same motions in double and in long double agree to the
// rounding of the double, event for event. It is templated on contacts and inputs too: those that know
// what they lack give the same motions to the last bit.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "cases.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/transient.hpp"

namespace pd = pindrive;

template <class T>
std::vector<pd::Segment<T>> run(const double (&p)[9], bool general = false) {
  const pd::Drive<T> drive{T(p[0]), T(p[1]), T(p[2]), {T(p[3]), T(p[4])}, {T(p[5]), T(p[6])}};
  const pd::Inputs<T> inputs{T(p[7]), T(p[8]), T(p[7])};
  std::vector<pd::Segment<T>> segments;
  const auto keep = [&](const pd::Segment<T>& segment) { segments.push_back(segment); };
  if (general)
    pd::detail::Simulation<T>(drive, inputs).run(keep);
  else
    pd::simulate(drive, inputs, keep);
  return segments;
}

bool equal(const pd::Segment<double>& one, const pd::Segment<double>& other) {
  const auto &f = one.flow, &g = other.flow;
  return one.begin == other.begin && one.end == other.end && one.mode.plate == other.mode.plate &&
         one.mode.finger == other.mode.finger && f.position.start == g.position.start &&
         f.velocity.start == g.velocity.start && f.velocity.slope == g.velocity.slope &&
         one.plate_force.start == other.plate_force.start &&
         one.finger_force.start == other.finger_force.start;
}

int main() {
  std::mt19937_64 random(298);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double worst_time = 0, worst_position = 0;
  for (int i = 0; i < cases(20000); ++i) {
    const double mass = between(2e-3, 2e-2), stiffness = between(20, 400);
    const double ratio = i % 4 == 0 ? 0 : i % 4 == 1 ? between(0.01, 0.9) : between(0, 3);
    const double plate = between(5e-3, 0.1), finger = i % 3 == 0 ? 0 : between(1e-3, 0.05);
    const double excess = i % 2 == 0 ? 1 : between(1, 2);
    const double p[9] = {mass,
                         stiffness,
                         2 * ratio * std::sqrt(mass * stiffness),
                         plate,
                         plate * excess,
                         finger,
                         finger * excess,
                         between(-0.3, 0.3),
                         between(-3e-3, 3e-3)};
    const auto one = run<double>(p);
    const auto general = run<double>(p, true);
    if (!std::equal(one.begin(), one.end(), general.begin(), general.end(), equal)) {
      std::printf("case %d: another motion by the general types\n", i);
      return 1;
    }
    const auto other = run<long double>(p);
    if (one.size() != other.size()) {
      std::printf("case %d: %zu and %zu segments\n", i, one.size(), other.size());
      return 1;
    }
    for (std::size_t k = 0; k < one.size(); ++k) {
      const long double x = other[k].flow.position.start;
      worst_time = std::max(worst_time, double(std::abs(one[k].begin - other[k].begin)));
      worst_position = std::max(worst_position, double(std::abs(one[k].flow.position.start - x)));
    }
  }
  std::printf("%d motions: times within %.1e s, positions within %.1e m\n", cases(20000),
              worst_time, worst_position);
  return worst_time < 1e-11 && worst_position < 1e-13 ? 0 : 1;
}
