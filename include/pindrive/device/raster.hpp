/// The page as a raster of luminance, linear between the middles of pixels.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pindrive::device {

/// Place on the page, or offset of one place from another: x to the right, y down, m.
struct Place {
  double x, y;

  friend Place operator+(Place a, Place b) { return {a.x + b.x, a.y + b.y}; }
  friend Place operator-(Place a, Place b) { return {a.x - b.x, a.y - b.y}; }
};

/// Raster of luminance from 0 (black) to 1 (white). Owns no memory.
struct Raster {
  const double* luminance;  ///< row by row, the first row on top
  std::int64_t rows, columns;
  double pixel;  ///< size of a pixel, m; > 0
  Place corner;  ///< top left corner of the page, m

  /// Distance beyond the border within which a place still counts as on the page, m.
  static constexpr double border = 1e-9;

  double right() const { return corner.x + static_cast<double>(columns) * pixel; }
  double bottom() const { return corner.y + static_cast<double>(rows) * pixel; }

  bool contains(Place at) const {
    return corner.x - border <= at.x && at.x <= right() + border && corner.y - border <= at.y &&
           at.y <= bottom() + border;
  }

  /// Luminance at a place: constant in the outer half of the outermost pixels, 1 (blank paper)
  /// beyond the page.
  double at(Place place) const {
    if (!contains(place)) return 1;
    const auto [i, u] =
        between((std::clamp(place.x, corner.x, right()) - corner.x) / pixel, columns);
    const auto [j, w] = between((std::clamp(place.y, corner.y, bottom()) - corner.y) / pixel, rows);
    const std::int64_t next = std::min(i + 1, columns - 1);
    const double* const upper = luminance + j * columns;
    const double* const lower = luminance + std::min(j + 1, rows - 1) * columns;
    const double above = upper[i] * (1 - u) + upper[next] * u;
    const double below = lower[i] * (1 - u) + lower[next] * u;
    return above * (1 - w) + below * w;
  }

 private:
  struct Between {
    std::int64_t pixel;
    double part;
  };
  /// Pixel whose middle is at or before a place, in pixels from the border, and the part of the way
  /// to the middle of the next.
  static Between between(double place, std::int64_t count) {
    const double middle = std::clamp(place - 0.5, 0.0, static_cast<double>(count - 1));
    const std::int64_t i =
        std::min(static_cast<std::int64_t>(middle), std::max(count - 2, std::int64_t{0}));
    return {i, middle - static_cast<double>(i)};
  }
};

}  // namespace pindrive::device
