/// Lines printed along the path of a pin: intervals of time with the spot on dark paper.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/device/sign_change.hpp"

namespace pindrive::device {

/// Line printed across the path of a pin.
struct PrintedLine {
  double begin, end;  ///< time at which the spot enters and leaves the line, s
  bool whole;         ///< no begin, end or turn of the path on the line
};

/// Page along the path of the hand, with what is common to all pins.
struct PageAlongPath {
  Raster raster;
  HandPath path;
  double threshold;  ///< luminance below which paper is dark
  Way way;
  std::vector<double> turnings;

  /// Samples of the luminance per pixel of the path.
  static constexpr double samples_per_pixel = 4;
  /// Parts of a stretch with bends, and bound of the speed in one over that at its ends and its middle.
  static constexpr int parts_of_bend = 16;
  static constexpr double over_known_speed = 1.0625;
  /// Part of a pixel below which a crossing is a grazed edge, neither line nor gap.
  static constexpr double grazed = 0.5;

  PageAlongPath(const Raster& of, const HandPath& along, const Axis& axis, double dark_below)
      : raster(of),
        path(along),
        threshold(dark_below),
        way(path),
        turnings(device::turnings(path, axis)) {}

  /// Luminance of a spot above the threshold, in a stretch of the path.
  double lightness(Place spot, double t, std::size_t stretch) const {
    return raster.at(path.position(t, stretch) + spot) - threshold;
  }

  double speed_at(double t, std::size_t stretch) const {
    const Vector v = path.velocity(t, stretch);
    return std::sqrt(v.x * v.x + v.y * v.y);
  }

  /// Times at which a spot enters dark paper, and leaves it, by turns: edges between samples, s. At
  /// most `most` of them.
  std::vector<double> edges(Place spot, std::size_t most) const {
    std::vector<double> found;
    bool dark = false;
    double before = path.begin();
    const auto sample = [&](double t, std::size_t i) {
      if (const bool now = lightness(spot, t, i) < 0; now != dark) {
        const double sign = dark ? 1 : -1;
        const auto beyond = [&](double at) { return sign * lightness(spot, at, i); };
        found.push_back(t > before ? device::sign_change(beyond, before, t) : t);
        dark = now;
      }
      before = t;
      return found.size() < most;
    };
    // The begin of a part was sampled as the end of the one before.
    if (!sample(path.begin(), 0)) return found;
    for (std::size_t i = 0; i < path.stretches(); ++i) {
      const int parts = path.bend_x ? parts_of_bend : 1;
      const double lasts = (path.times[i + 1] - path.times[i]) / parts;
      for (int part = 0; part < parts; ++part) {
        const double begin = path.times[i] + part * lasts;
        const double speed = std::max(
            {speed_at(begin, i), speed_at(begin + 0.5 * lasts, i), speed_at(begin + lasts, i)});
        const double farthest = speed * lasts * (path.bend_x ? over_known_speed : 1);
        const double count = 1 + std::ceil(farthest * samples_per_pixel / raster.pixel);
        for (double k = 1; k < count; ++k)
          if (!sample(begin + lasts * k / count, i)) return found;
        if (!sample(part + 1 < parts ? begin + lasts : path.times[i + 1], i)) return found;
      }
    }
    if (dark) found.push_back(path.end());
    return found;
  }

  /// Lines along the path of a spot. Adds the number of its edges to `count`, until it exceeds
  /// `most`.
  std::vector<PrintedLine> lines(Place spot, std::size_t most, std::size_t& count) const {
    const std::vector<double> at = edges(spot, most);
    count += at.size();
    const double shortest = grazed * raster.pixel;
    std::vector<PrintedLine> found;
    for (std::size_t i = 0; i + 1 < at.size(); i += 2) {
      if (found.empty() || way.between(found.back().end, at[i]) > shortest)
        found.push_back({at[i], at[i + 1], false});
      else
        found.back().end = at[i + 1];
    }
    const auto is_grazed = [&](const PrintedLine& line) {
      return !(way.between(line.begin, line.end) > shortest);
    };
    found.erase(std::remove_if(found.begin(), found.end(), is_grazed), found.end());
    for (PrintedLine& line : found) {
      const auto on_line = [&](double t) { return line.begin < t && t < line.end; };
      line.whole = path.begin() < line.begin && line.end < path.end() &&
                   std::none_of(turnings.begin(), turnings.end(), on_line);
    }
    return found;
  }
};

}  // namespace pindrive::device
