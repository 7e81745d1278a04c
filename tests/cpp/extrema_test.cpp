// The extrema of a quantity in a segment against samples: none lies outside those that are next to it.
#include "pindrive/motion/extrema.hpp"

#include <vector>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

struct Point {
  double tau, value;
};

}  // namespace

int main() {
  bool bounded = true, same = true, ends = true;
  int turns = 0;
  for (const double ratio : {0.0, 0.02, 0.6, 1.0, 1.8, -0.01})
    for (const double drift : {0.0, 0.02, -0.3})
      for (const double from : {0.0, 0.013}) {
        pd::Segment<double> segment{};
        segment.end = 0.5;
        segment.flow.oscillator = {0.01, 2 * ratio, 100};
        const auto& o = segment.flow.oscillator;
        const pd::Path<double> path{1e-3, 2e-3, 0.05, drift};
        segment.flow.velocity = path;
        segment.moved = o.after(segment.end);
        const pd::detail::ClosedForm<double> along(segment);
        std::vector<Point> found;
        const auto add = [&](double tau, double value) { found.push_back({tau, value}); };
        pd::detail::extrema(along, path, from, segment.end, add);
        turns += static_cast<int>(found.size()) - 2;
        ends = ends && found.front().tau == from && found.back().tau == segment.end;
        double low = 1, high = -1;
        for (std::size_t i = 0; i + 1 < found.size(); ++i) {
          low = std::min({low, found[i].value, found[i + 1].value});
          high = std::max({high, found[i].value, found[i + 1].value});
          const auto [least, most] = std::minmax(found[i].value, found[i + 1].value);
          for (int j = 1; j < 30; ++j) {
            const double tau = found[i].tau + (found[i + 1].tau - found[i].tau) * j / 30;
            const double value = path.at(o, tau), slack = 1e-12 * (1e-3 + most - least);
            bounded = bounded && value >= least - slack && value <= most + slack;
          }
        }
        pd::detail::highest_and_lowest(along, path, from, segment.end, [&](double, double value) {
          low = std::min(low, value + 1e-15);
          high = std::max(high, value - 1e-15);
        });
        double least = 1, most = -1;
        pd::detail::highest_and_lowest(along, path, from, segment.end, [&](double, double value) {
          least = std::min(least, value);
          most = std::max(most, value);
        });
        same = same && std::abs(least - low) < 1e-12 && std::abs(most - high) < 1e-12;
      }
  std::printf("%d extrema\n", turns);
  expect(turns > 100, "the paths turn");
  expect(ends, "both ends are visited, first and last");
  expect(bounded, "between neighbouring extrema a path stays between their values");
  expect(same, "the highest and the lowest value are among those near the ends");
  return check::status();
}
