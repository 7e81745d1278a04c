// A pin over two lines: a magnet that raises the plate's load, a hand at an even speed, and its motion.
#pragma once

#include <limits>
#include <vector>

#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"

namespace scanned {

namespace pd = pindrive;

/// Pin that a magnet carries from 10 to 30 ms and from 90 to 110 ms, released within 0.5 ms.
struct Pin {
  pd::Drive<double> drive{0.005, 200, 1.2, {0.006, 0.007}, {0.008, 0.008}};
  std::vector<double> velocity_times{0, 0.2}, velocities{0.08, 0.08};
  std::vector<double> load_times{0.010, 0.0105, 0.030, 0.0305, 0.090, 0.0905, 0.110, 0.1105};
  std::vector<double> loads{1, 60, 60, 1, 1, 60, 60, 1};
  std::vector<double> touch_times{0, 0.2}, touches{1, 1};
  std::vector<pd::Segment<double>> segments;
  pd::Inputs<double> inputs{0.08, 0, 0, 0.2};
  pd::Outcome<double> outcome;

  explicit Pin(double skin_stiffness = std::numeric_limits<double>::infinity(),
               std::vector<double> times = {0, 0.2}, std::vector<double> pressed = {1, 1})
      : touch_times(std::move(times)), touches(std::move(pressed)) {
    drive.finger.stiffness = skin_stiffness;
    inputs.mouse_velocity = profile(velocity_times, velocities);
    inputs.plate_load = profile(load_times, loads);
    inputs.finger_load = profile(touch_times, touches);
    outcome = pd::simulate(drive, inputs, [&](const auto& s) { segments.push_back(s); });
  }
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;

  pd::Motion<double> motion() const {
    return {drive, inputs, segments.data(), segments.size(), outcome};
  }

 private:
  static pd::Profile<double> profile(const std::vector<double>& t, const std::vector<double>& y) {
    return {t.data(), y.data(), t.size()};
  }
};

}  // namespace scanned
