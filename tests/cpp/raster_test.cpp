// Luminance of a raster: linear between the middles of pixels, constant in the outer half pixels, blank beyond.
#include "pindrive/device/raster.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

void a_plane_is_reproduced() {
  constexpr int rows = 7, columns = 11;
  std::vector<double> values;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) values.push_back(0.1 + 0.05 * i + 0.03 * j);
  const device::Raster raster{values.data(), rows, columns, 0.5, {-1, 2}};
  std::mt19937_64 random(3);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const double u = std::uniform_real_distribution<double>(0.5, columns - 0.5)(random);
    const double w = std::uniform_real_distribution<double>(0.5, rows - 0.5)(random);
    const double exact = 0.1 + 0.05 * (u - 0.5) + 0.03 * (w - 0.5);
    worst = std::max(worst, std::abs(raster.at({-1 + 0.5 * u, 2 + 0.5 * w}) - exact));
  }
  expect(worst < 1e-14, "between the middles of pixels the luminance is linear");
}

void borders() {
  const double values[]{0.2, 0.4, 0.6, 0.8};
  const device::Raster raster{values, 2, 2, 1, {0, 0}};
  expect(raster.at({0, 0}) == 0.2 && raster.at({0.5, 0.3}) == 0.2, "the outer half is constant");
  expect(raster.at({2, 2}) == 0.8, "the border belongs to the page");
  expect(raster.at({2 + 5e-10, 1}) < 1 && raster.contains({2 + 5e-10, 1}), "to rounding");
  expect(raster.at({2 + 5e-9, 1}) == 1 && !raster.contains({1, -5e-9}), "blank paper beyond");
  const device::Raster single{values, 1, 1, 1, {0, 0}};
  expect(single.at({0.9, 0.1}) == 0.2, "a single pixel has one luminance");
}

}  // namespace

int main() {
  a_plane_is_reproduced();
  borders();
  return check::status();
}
