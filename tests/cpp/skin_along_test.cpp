// Stretch and slider of the skin along a motion, with and without a damper.
#include "pindrive/motion/skin_along.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/engine.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

/// A pin that a held plate pulls over a finger, for a damping of its skin.
void along(double damping, const char* what) {
  const pd::Drive<double> drive{0.01, 250, 0.4, {0.05, 0.06}, {0.01, 0.013, 800, {}, {}, damping}};
  const pd::Inputs<double> inputs{0.06, 1e-3, 0, 0.05};
  std::vector<pd::Segment<double>> segments;
  const auto outcome = pd::simulate(drive, inputs, [&](const pd::Segment<double>& segment) {
    segments.push_back(segment);
    return true;
  });
  const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
  double moves = 0, slides = 0, pulls = 0;
  bool slips = false;
  for (const auto& segment : motion) {
    const double length = std::min(segment.end, inputs.duration) - segment.begin;
    if (!(length > 1e-6)) continue;
    slips = slips || pd::is_slip(segment.mode.finger);
    motion.along(segment, [&](const auto& path) {
      for (const double part : {0.2, 0.5, 0.8}) {
        const double tau = part * length, h = 1e-4 * length;
        const auto stretch = [&](double t) {
          return -path.at(pd::detail::stretch_force_along(drive, segment, path), t) / 800;
        };
        const double rate = path.at(pd::detail::stretch_rate_along(drive, segment, path), tau);
        const double slider = path.at(pd::detail::sliding_along(drive, segment, path), tau);
        const double v = path.at(path.velocity(), tau);
        moves = std::max(moves, std::abs((stretch(tau + h) - stretch(tau - h)) / (2 * h) - rate));
        slides = std::max(slides, std::abs(v - rate - slider));
        pulls = std::max(pulls, std::abs(path.at(path.finger_force(), tau) + 800 * stretch(tau) +
                                         damping * rate));
      }
    });
  }
  expect(slips && moves < 1e-7 && slides < 1e-15 && pulls < 1e-15, what);
}

}  // namespace

int main() {
  along(0, "the rate of the stretch is its derivative, and slider and skin make up the velocity");
  along(0.7, "... and with a damper, whose force is part of the finger's");
  return check::status();
}
