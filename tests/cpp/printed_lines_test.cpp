// Lines along the way of a pin: edges where the luminance passes the threshold, grazed edges, whole lines.
#include "pindrive/device/printed_lines.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

/// Hand at 0.1 m/s from x = 0 to 20 mm or, if it turns, to 18 mm and back.
struct Hand {
  std::vector<double> times{0, 0.2}, vx{0.1, 0.1}, vy{0, 0}, x{0, 0.02}, y{5e-5, 5e-5};

  explicit Hand(bool turns) {
    if (!turns) return;
    times = {0, 0.18, 0.19, 0.37};
    vx = {0.1, 0.1, -0.1, -0.1};
    vy.assign(4, 0);
    x = {0, 0.018, 0.018, 0};
    y.assign(4, 5e-5);
  }
  device::HandPath path() const {
    return {times.data(), vx.data(), vy.data(), x.data(), y.data(), times.size()};
  }
};

/// Paper of 200 pixels of 0.1 mm, dark in some.
std::vector<double> paper(const std::vector<std::pair<int, int>>& lines) {
  std::vector<double> row(200, 1.0);
  for (const auto& [first, last] : lines)
    for (int i = first; i < last; ++i) row[i] = 0;
  return row;
}

std::vector<device::PrintedLine> lines_of(const std::vector<double>& row, const Hand& hand,
                                          double spot = 0, std::size_t most = 1000) {
  const device::Raster raster{row.data(), 1, 200, 1e-4, {0, 0}};
  const device::PageAlongPath page(raster, hand.path(), device::Axis(0), 0.5);
  std::size_t count = 0;
  return page.lines({spot, 0}, most, count);
}

void edges() {
  const auto found = lines_of(paper({{50, 70}, {100, 101}}), Hand(false));
  expect(found.size() == 2, "two lines");
  expect(std::abs(found[0].begin - 0.05) < 1e-15 && std::abs(found[0].end - 0.07) < 1e-15,
         "half way between a light and a dark pixel");
  expect(found[0].whole && found[1].whole, "both whole");
  const auto ahead = lines_of(paper({{50, 70}}), Hand(false), 0.001);
  expect(std::abs(ahead[0].begin - 0.04) < 1e-15, "a spot ahead is there before");
}

void begin_end_and_turns() {
  const auto cut = lines_of(paper({{0, 10}, {190, 200}}), Hand(false));
  expect(cut.size() == 2 && !cut[0].whole && !cut[1].whole, "begin and end of the path cut lines");
  expect(cut[0].begin == 0 && cut[1].end == 0.2, "which begin and end there");
  const auto turned = lines_of(paper({{100, 120}, {175, 195}}), Hand(true));
  expect(turned.size() == 3 && turned[0].whole && !turned[1].whole && turned[2].whole,
         "a line on which the hand turns is not whole");
}

void grazed_edges() {
  std::vector<double> row = paper({{50, 70}, {71, 90}});
  row[70] = 0.6;  // a gap of a third of a pixel
  expect(lines_of(row, Hand(false)).size() == 1, "a grazed gap joins two lines");
  row = paper({});
  row[100] = 0.49;
  expect(lines_of(row, Hand(false)).empty(), "a grazed line is none");
}

void too_many() {
  const std::vector<double> row = paper({{20, 30}, {50, 60}, {80, 90}});
  const device::Raster raster{row.data(), 1, 200, 1e-4, {0, 0}};
  const Hand hand(false);
  const device::PageAlongPath page(raster, hand.path(), device::Axis(0), 0.5);
  std::size_t count = 0;
  page.lines({0, 0}, 3, count);
  expect(count >= 3 && count < 6, "the search ends at the largest number of edges");
}

}  // namespace

int main() {
  edges();
  begin_end_and_turns();
  grazed_edges();
  too_many();
  return check::status();
}
