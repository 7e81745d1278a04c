// A page with two lines under a hand, a device, and equal motions, for the tests of scans.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "pindrive/device/scan_inputs.hpp"

namespace scanned {

/// Hand at 0.1 m/s over two lines of 2 mm.
struct Page {
  std::vector<double> paper;
  std::vector<double> times{0, 0.2}, vx{0.1, 0.1}, vy{0, 0}, x{0, 0.02}, y{5e-5, 5e-5};

  Page() : paper(200, 1.0) {
    for (const int first : {40, 120})
      for (int i = first; i < first + 20; ++i) paper[i] = 0;
  }
  pindrive::device::Raster raster() const { return {paper.data(), 1, 200, 1e-4, {0, 0}}; }
  pindrive::device::HandPath path() const {
    return {times.data(), vx.data(), vy.data(), x.data(), y.data(), times.size()};
  }
};

inline pindrive::device::Device device_with(double skin = std::numeric_limits<double>::infinity()) {
  pindrive::Drive<double> drive{0.005, 200, 1.2, {0.006, 0.007}, {0.008, 0.009}};
  drive.finger.stiffness = skin;
  return {drive,
          {0.05},
          1,
          pindrive::device::Electromagnet<double>({2, 0, 1, 1e-3, 2e-3}),
          {1000, 0.002, 0.5, 0.1},
          pindrive::device::Axis(0),
          {{0, 0}, {0.001, 0}}};
}

using Segments = std::vector<pindrive::Segment<double>>;

/// True if two motions are equal segment by segment, to the bit.
inline bool equal(const Segments& one, const Segments& other) {
  const auto same = [](const pindrive::Segment<double>& a, const pindrive::Segment<double>& b) {
    return a.begin == b.begin && a.end == b.end && pindrive::same_mode(a.mode, b.mode) &&
           a.flow.position.start == b.flow.position.start &&
           a.flow.velocity.start == b.flow.velocity.start && a.moved.gain == b.moved.gain;
  };
  return std::equal(one.begin(), one.end(), other.begin(), other.end(), same);
}

}  // namespace scanned
