/// Path of the hand over the page: place, velocity, length, stops and turns.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pindrive/device/raster.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive::device {

/// Velocity, or direction, on the page.
using Vector = Place;

/// Path of the hand with a velocity that is linear between its rows. Owns no memory.
struct HandPath {
  const double* times;    ///< s, increasing
  const double *vx, *vy;  ///< velocity at each time, m/s
  const double *x, *y;    ///< place at each time, m
  std::size_t count;      ///< number of rows, >= 2

  double begin() const { return times[0]; }
  double end() const { return times[count - 1]; }
  std::size_t stretches() const { return count - 1; }

  /// Stretch between two rows that contains time t in [begin(), end()].
  std::size_t stretch_of(double t) const {
    const double* const after = std::upper_bound(times + 1, times + count - 1, t);
    return static_cast<std::size_t>(after - times) - 1;
  }

  Place position(double t) const { return position(t, stretch_of(t)); }
  Vector velocity(double t) const { return velocity(t, stretch_of(t)); }

  /// Place at a time in a stretch.
  Place position(double t, std::size_t i) const {
    const double since = t - times[i], part = since / (times[i + 1] - times[i]);
    const auto along = [&](const double* place, const double* v) {
      return place[i] + since * (v[i] + 0.5 * ((v[i + 1] - v[i]) * part));
    };
    return {along(x, vx), along(y, vy)};
  }
  Vector velocity(double t, std::size_t i) const {
    const double part = (t - times[i]) / (times[i + 1] - times[i]);
    return {vx[i] + (vx[i + 1] - vx[i]) * part, vy[i] + (vy[i + 1] - vy[i]) * part};
  }
};

/// Axis of the drives on the page.
class Axis {
 public:
  /// Direction from x towards y, rad.
  explicit Axis(double angle) : direction_{detail::cos(angle), detail::sin(angle)} {}

  Vector direction() const { return direction_; }
  double along(Vector v) const { return v.x * direction_.x + v.y * direction_.y; }
  double across(Vector v) const { return v.y * direction_.x - v.x * direction_.y; }

 private:
  Vector direction_;
};

/// Length of the way of a hand.
class Way {
 public:
  explicit Way(const HandPath& path) : path_(path), lengths_(path.count) {
    for (std::size_t i = 0; i < path.stretches(); ++i)
      lengths_[i + 1] = lengths_[i] + length(i, path.times[i + 1]);
  }

  /// Length from the begin of the path to time t, m.
  double operator()(double t) const {
    const std::size_t i = path_.stretch_of(t);
    return lengths_[i] + length(i, t);
  }
  /// Length from one time to another, m; negative backwards, NaN for a NaN.
  double between(double from, double to) const {
    if (std::isnan(from) || std::isnan(to)) return from + to;
    return (*this)(to) - (*this)(from);
  }
  double of_stretch(std::size_t i) const { return lengths_[i + 1] - lengths_[i]; }

 private:
  /// Length from the begin of a stretch, by Gauss-Legendre quadrature: exact on a straight way.
  double length(std::size_t i, double until) const {
    static constexpr double nodes[] = {0x1.77ac94f3c7344p-3, 0x1.0d129583284b4p-1,
                                       0x1.97e4ab249f41ep-1, 0x1.ebab1cb0acc66p-1};
    static constexpr double weights[] = {0x1.736360b19933dp-2, 0x1.413c50a25560ep-2,
                                         0x1.c76fb531d2b94p-3, 0x1.9ea1d04ca03aep-4};
    const double begin = path_.times[i], half = 0.5 * (until - begin);
    const auto speed = [&](double node) {
      const Vector v = path_.velocity(begin + half * (1 + node), i);
      return detail::hypot(v.x, v.y);
    };
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum += weights[k] * (speed(-nodes[k]) + speed(nodes[k]));
    return half * sum;
  }

  HandPath path_;
  std::vector<double> lengths_;
};

/// Times at which the hand stops or turns back along the axis, s, in order.
inline std::vector<double> turnings(const HandPath& path, const Axis& axis) {
  constexpr double across = 1e-9;  // part of the largest velocity that is rounding of a hand across
  std::vector<double> v(path.count), found;
  double most = 0;
  for (std::size_t i = 0; i < path.count; ++i) {
    v[i] = axis.along({path.vx[i], path.vy[i]});
    most = std::max(most, std::abs(v[i]));
  }
  for (double& each : v)
    if (std::abs(each) < across * most) each = 0;
  for (std::size_t i = 0; i < path.stretches(); ++i) {
    if (i > 0 && v[i] == 0 && (v[i - 1] != 0 || v[i + 1] != 0)) found.push_back(path.times[i]);
    if (v[i] * v[i + 1] < 0)
      found.push_back(path.times[i] +
                      v[i] / (v[i] - v[i + 1]) * (path.times[i + 1] - path.times[i]));
  }
  return found;
}

}  // namespace pindrive::device
