/// Path of the hand over the page: place, velocity, length, stops and turns.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

#include "pindrive/device/raster.hpp"
#include "pindrive/flow/polynomial.hpp"
#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::device {

/// Velocity, or direction, on the page.
using Vector = Place;

/// Velocity in a stretch between two rows, beside the line between them: s (1 − s) (b₀ + b₁ s + b₂ s²) with s from 0
/// to 1, m/s.
struct Bend {
  double b[3];

  bool straight() const { return b[0] == 0 && b[1] == 0 && b[2] == 0; }
  double at(double s) const { return s * (1 - s) * (b[0] + s * (b[1] + s * b[2])); }
  /// Integral from 0 to s.
  double integral(double s) const {
    return s * s *
           (0.5 * b[0] +
            s * ((b[1] - b[0]) * (1.0 / 3) + s * (0.25 * (b[2] - b[1]) - 0.2 * s * b[2])));
  }
};

/// Path of the hand with a velocity that is linear between its rows, or a polynomial. Owns no memory.
struct HandPath {
  const double* times;          ///< s, increasing
  const double *vx, *vy;        ///< velocity at each time, m/s
  const double *x, *y;          ///< place at each time, m
  std::size_t count;            ///< number of rows, >= 2
  const Bend* bend_x{nullptr};  ///< of each stretch; null: linear
  const Bend* bend_y{nullptr};

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
    const auto along = [&](const double* place, const double* v, const Bend* bends) {
      const double line = place[i] + since * (v[i] + 0.5 * ((v[i + 1] - v[i]) * part));
      return bends ? line + (times[i + 1] - times[i]) * bends[i].integral(part) : line;
    };
    return {along(x, vx, bend_x), along(y, vy, bend_y)};
  }
  Vector velocity(double t, std::size_t i) const {
    const double part = (t - times[i]) / (times[i + 1] - times[i]);
    const auto along = [&](const double* v, const Bend* bends) {
      const double line = v[i] + (v[i + 1] - v[i]) * part;
      return bends ? line + bends[i].at(part) : line;
    };
    return {along(vx, bend_x), along(vy, bend_y)};
  }
};

/// Axis of the drives on the page.
class Axis {
 public:
  /// Direction from x towards y, rad.
  explicit Axis(double angle) : direction_{detail::cos(angle), detail::sin(angle)} {}

  Vector direction() const { return direction_; }
  double along(Vector v) const { return significant(v.x * direction_.x + v.y * direction_.y, v); }
  double across(Vector v) const { return significant(v.y * direction_.x - v.x * direction_.y, v); }

 private:
  /// A component that is rounding of the speed is zero.
  static double significant(double component, Vector v) {
    const double error = detail::rounding<double> * detail::hypot(v.x, v.y);
    return std::abs(component) > error ? component : 0;
  }

  Vector direction_;
};

/// Length of the path of a hand.
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
  /// Length from the begin of a stretch, by Gauss-Legendre quadrature: exact on a straight path.
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

/// Velocity of a path along one direction, without the rounding of a hand across it.
class Speed {
 public:
  /// `component(v)`: that of a vector along the direction.
  template <class Component>
  Speed(const HandPath& path, Component&& component) : rows_(path.count), bends_(path.stretches()) {
    for (std::size_t i = 0; i < path.count; ++i) rows_[i] = component({path.vx[i], path.vy[i]});
    if (path.bend_x == nullptr || path.bend_y == nullptr) return;
    for (std::size_t i = 0; i < path.stretches(); ++i)
      for (int k = 0; k < 3; ++k)
        bends_[i].b[k] = component({path.bend_x[i].b[k], path.bend_y[i].b[k]});
  }

  double row(std::size_t i) const { return rows_[i]; }
  const std::vector<double>& rows() const { return rows_; }
  bool bent() const {
    return std::any_of(bends_.begin(), bends_.end(), [](const Bend& b) { return !b.straight(); });
  }
  /// Coefficients in a stretch, of the time over its duration.
  std::array<double, 5> coefficients(std::size_t i) const {
    const auto& b = bends_[i].b;
    return {rows_[i], rows_[i + 1] - rows_[i] + b[0], b[1] - b[0], b[2] - b[1], -b[2]};
  }
  /// Bound of the speed in a stretch, m/s.
  double most(std::size_t i) const {
    const auto& b = bends_[i].b;
    return std::max(std::abs(rows_[i]), std::abs(rows_[i + 1])) +
           0.25 * (std::abs(b[0]) + std::abs(b[1]) + std::abs(b[2]));
  }
  /// Drops what is smaller than a speed.
  void drop(double below) {
    const auto clear = [&](double& v) {
      if (std::abs(v) < below) v = 0;
    };
    std::for_each(rows_.begin(), rows_.end(), clear);
    for (Bend& each : bends_) std::for_each(std::begin(each.b), std::end(each.b), clear);
  }

 private:
  std::vector<double> rows_;
  std::vector<Bend> bends_;
};

/// Times at which the hand stops or turns back along the axis, s, in order.
inline std::vector<double> turnings(const HandPath& path, const Axis& axis) {
  constexpr double across = 1e-9;  // part of the largest speed that is rounding of a hand across
  Speed speed(path, [&](Vector v) { return axis.along(v); });
  const Speed aside(path, [&](Vector v) { return axis.across(v); });
  double most = 0;
  for (std::size_t i = 0; i < path.stretches(); ++i)
    most = std::max({most, speed.most(i), aside.most(i)});
  speed.drop(across * most);
  std::vector<double> found;
  for (std::size_t i = 0; i < path.stretches(); ++i) {
    if (i > 0 && speed.row(i) == 0 && (speed.most(i - 1) > 0 || speed.most(i) > 0))
      found.push_back(path.times[i]);
    detail::Polynomial<double> along;
    const auto c = speed.coefficients(i);
    along.degree = 4;
    along.span = 1;
    std::copy(c.begin(), c.end(), along.c.begin());
    // A part of the stretch between two zeros counts if its speed there is more than rounding.
    const auto first = std::find_if(c.begin(), c.end(), [](double each) { return each != 0; });
    if (first == c.end()) continue;
    double since = 0, way = 0, turn = 0;
    const auto part = [&](double until) {
      const double v = along.at(0.5 * (since + until));
      if (std::abs(v) > across * speed.most(i)) {
        if (v * way < 0)
          found.push_back(path.times[i] + turn * (path.times[i + 1] - path.times[i]));
        way = v;
      }
      since = turn = until;
      return true;
    };
    detail::sign_changes(along, *first > 0 ? 1 : -1, part);
    part(1);
  }
  return found;
}

}  // namespace pindrive::device
