// Path of a hand: place and velocity between rows, length of the way, stops and turns along an axis.
#include "pindrive/device/hand_path.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

/// Rows of a path from rest, with the places that the velocity leads to.
struct Rows {
  std::vector<double> times, vx, vy, x{0}, y{0};

  Rows(std::vector<double> t, std::vector<double> u, std::vector<double> w)
      : times(std::move(t)), vx(std::move(u)), vy(std::move(w)) {
    for (std::size_t i = 1; i < times.size(); ++i) {
      const double half = 0.5 * (times[i] - times[i - 1]);
      x.push_back(x.back() + half * (vx[i] + vx[i - 1]));
      y.push_back(y.back() + half * (vy[i] + vy[i - 1]));
    }
  }
  device::HandPath path() const {
    return {times.data(), vx.data(), vy.data(), x.data(), y.data(), times.size()};
  }
};

void places_are_the_integral_of_velocities() {
  const Rows curved({0, 0.1, 0.3, 0.4, 0.6}, {0, 0.2, -0.1, -0.1, 0}, {0.1, 0.05, 0.1, -0.2, 0});
  const device::HandPath path = curved.path();
  constexpr int count = 60000;
  double x = 0, y = 0, length = 0, worst = 0;
  const device::Way way(path);
  for (int i = 0; i < count; ++i) {
    const double lasts = path.end() / count, t = (i + 0.5) * lasts;
    const device::Vector v = path.velocity(t);
    x += v.x * lasts;
    y += v.y * lasts;
    length += std::hypot(v.x, v.y) * lasts;
    const device::Place at = path.position((i + 1) * lasts);
    worst = std::max({worst, std::abs(at.x - x), std::abs(at.y - y),
                      std::abs(way((i + 1) * lasts) - length) * 0.01});
  }
  expect(worst < 1e-8, "places and lengths are integrals");
  expect(path.position(path.end()).x == path.x[path.count - 1], "the end is the last place");
  expect(way.between(0.2, 0.5) == -way.between(0.5, 0.2), "backwards the length is negative");
  expect(std::isnan(way.between(0.1, std::nan(""))), "NaN for a NaN");
}

void a_straight_way_is_exact() {
  const Rows straight({0, 0.5, 1}, {0, 0.06, 0}, {0, 0.08, 0});
  const device::Way way(straight.path());
  expect(std::abs(way(1) - 0.05) < 1e-17 && std::abs(way(0.5) - 0.025) < 1e-17, "of length 50 mm");
}

void strokes_are_exact() {
  // 50 mm in 1 s along (3, 4), a rest, and back along x.
  Rows rows({0, 1, 1.5, 2}, {0, 0, 0, 0}, {0, 0, 0, 0});
  rows.x = {0, 0.03, 0.03, 0};
  rows.y = {0, 0.04, 0.04, 0.04};
  const auto stroke = [](double mean) { return device::Bend{{0, 30 * mean, -30 * mean}}; };
  const std::vector<device::Bend> x{stroke(0.03), {}, stroke(-0.06)}, y{stroke(0.04), {}, {}};
  device::HandPath path = rows.path();
  path.bend_x = x.data();
  path.bend_y = y.data();
  expect(std::abs(path.velocity(0.5).x - 1.875 * 0.03) < 1e-16, "a stroke has its peak speed");
  expect(std::abs(path.position(0.5).y - 0.02) < 1e-17, "half-way at half its time");
  const device::Way way(path);
  expect(std::abs(way(1) - 0.05) < 1e-16 && std::abs(way(2) - 0.08) < 1e-16, "its length is exact");
  const std::vector<double> found = device::turnings(path, device::Axis(0));
  expect(found.size() == 2 && found[0] == 1 && found[1] == 1.5, "stops are those between strokes");
}

void stops_and_turns() {
  const Rows rows({0, 0.1, 0.2, 0.3, 0.4}, {0.06, -0.02, 0, 0, 0.1}, {0, 0, 0, 0, 0});
  const std::vector<double> found = device::turnings(rows.path(), device::Axis(0));
  expect(found.size() == 3 && std::abs(found[0] - 0.075) < 1e-15, "a turn within a stretch");
  expect(found[1] == 0.2 && found[2] == 0.3, "the begin and the end of a rest");
  const Rows across({0, 0.1, 0.2}, {1e-12, -1e-12, 1e-12}, {0.1, 0.1, 0.1});
  expect(device::turnings(across.path(), device::Axis(0)).empty(),
         "rounding of a hand across the axis is no turn");
}

}  // namespace

int main() {
  places_are_the_integral_of_velocities();
  a_straight_way_is_exact();
  strokes_are_exact();
  stops_and_turns();
  return check::status();
}
