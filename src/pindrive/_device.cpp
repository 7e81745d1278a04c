// Page and hand: arrays in and out of include/pindrive/device. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "_scan.hpp"
#include "arrays.hpp"
#include "interrupt.hpp"
#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/printed_lines.hpp"
#include "pindrive/device/raster.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
namespace device = pindrive::device;
using nb::literals::operator""_a;
using pindrive_python::path_of;
using pindrive_python::PathNumbers;
using pindrive_python::raster_of;
using pindrive_python::RasterNumbers;
using pindrive_python::Table;

namespace {

/// Both coordinates of a function of time.
template <class Function>
nb::tuple coordinates(const Column& times, Function&& f) {
  std::vector<double> x(times.size()), y(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const device::Place found = f(times.data()[i]);
    x[i] = found.x;
    y[i] = found.y;
  }
  return nb::make_tuple(to_array(std::move(x)), to_array(std::move(y)));
}

/// Begins, ends, and whether it is whole, of the lines along the way of one pin.
nb::tuple table_of(const std::vector<device::PrintedLine>& lines) {
  const auto column = [&](auto&& f) { return [&, f](std::size_t i) { return f(lines[i]); }; };
  return nb::make_tuple(
      mapped<double>(lines.size(), column([](const device::PrintedLine& l) { return l.begin; })),
      mapped<double>(lines.size(), column([](const device::PrintedLine& l) { return l.end; })),
      mapped<std::uint8_t>(lines.size(),
                           column([](const device::PrintedLine& l) { return l.whole; })));
}

nb::tuple printed_lines(const RasterNumbers& raster, const PathNumbers& path, double axis,
                        double threshold, const Table& spots, std::size_t most) {
  auto [found, count] = interruptible([&](auto go_on) {
    const device::PageAlongPath page(raster_of(raster), path_of(path), device::Axis(axis),
                                     threshold);
    std::vector<std::vector<device::PrintedLine>> lines;
    std::size_t edges = 0;
    for (std::size_t i = 0; i < spots.shape(0) && edges < most && go_on(); ++i)
      lines.push_back(page.lines({spots(i, 0), spots(i, 1)}, most - edges, edges));
    return std::pair{std::move(lines), edges};
  });
  nb::list tables;
  for (const auto& lines : found) tables.append(table_of(lines));
  return nb::make_tuple(tables, count);
}

}  // namespace

void bind_device(nb::module_& m) {
  m.def(
      "direction",
      [](double angle) {
        const device::Vector found = device::Axis(angle).direction();
        return std::pair(found.x, found.y);
      },
      "angle"_a, "Unit vector at an angle, rad.");
  m.def(
      "luminance",
      [](const RasterNumbers& raster, const Column& x, const Column& y) {
        const device::Raster page = raster_of(raster);
        return mapped<double>(x.size(),
                              [&](std::size_t i) { return page.at({x.data()[i], y.data()[i]}); });
      },
      "raster"_a, "x"_a, "y"_a);
  m.def(
      "on_page",
      [](const RasterNumbers& raster, const Column& x, const Column& y) {
        const device::Raster page = raster_of(raster);
        return mapped<std::uint8_t>(
            x.size(), [&](std::size_t i) { return page.contains({x.data()[i], y.data()[i]}); });
      },
      "raster"_a, "x"_a, "y"_a);
  m.def(
      "hand_position",
      [](const PathNumbers& path, const Column& times) {
        const device::HandPath hand = path_of(path);
        return coordinates(times, [&](double t) { return hand.position(t); });
      },
      "path"_a, "times"_a);
  m.def(
      "hand_velocity",
      [](const PathNumbers& path, const Column& times) {
        const device::HandPath hand = path_of(path);
        return coordinates(times, [&](double t) { return hand.velocity(t); });
      },
      "path"_a, "times"_a);
  m.def(
      "way",
      [](const PathNumbers& path, const Column& times) {
        const device::Way way(path_of(path));
        return mapped<double>(times.size(), [&](std::size_t i) { return way(times.data()[i]); });
      },
      "path"_a, "times"_a, "Length of the way of the hand until each time.");
  m.def(
      "turnings",
      [](const PathNumbers& path, double axis) {
        return to_array(device::turnings(path_of(path), device::Axis(axis)));
      },
      "path"_a, "axis"_a);
  m.def("printed_lines", &printed_lines, "raster"_a, "path"_a, "axis"_a, "threshold"_a, "spots"_a,
        "most"_a,
        "Begins, ends and wholeness of the lines along the way of each spot, and the number of "
        "edges; incomplete at `most` edges.");
  m.def(
      "plate_velocity",
      [](const PathNumbers& path, double axis) {
        const device::PlateVelocity found(path_of(path), device::Axis(axis));
        const auto component = [](const device::PlateVelocity::Component& of) {
          nb::list pieces;
          for (const pd::InputPiece<double>& piece : of.pieces)
            pieces.append(nb::make_tuple(piece.begin, nb::cast(piece.polynomial), nb::list()));
          return nb::make_tuple(to_array(std::vector<double>(of.rows)), pieces);
        };
        return nb::make_tuple(to_array(std::vector<double>(found.times())),
                              component(found.along_axis()), component(found.across_axis()),
                              found.oblique());
      },
      "path"_a, "axis"_a,
      "Times since the begin; velocity along and across the axis, at these times and as pieces "
      "where the path has bends; whether across it moves.");
}
