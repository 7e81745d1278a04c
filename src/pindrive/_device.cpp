// Page, hand and evaluation of a scan: arrays in and out of include/pindrive/device. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "interrupt.hpp"
#include "owned_motion.hpp"
#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/pin_evaluation.hpp"
#include "pindrive/device/printed_lines.hpp"
#include "pindrive/device/raster.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
namespace device = pindrive::device;
using nb::literals::operator""_a;

namespace {

using Table = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
/// Luminance (rows, columns); size of a pixel; left and top of the page.
using RasterNumbers = std::tuple<Table, double, double, double>;
/// Times, velocity (x, y), place (x, y), one row each.
using PathNumbers = std::tuple<Column, Column, Column, Column, Column>;

device::Raster raster_of(const RasterNumbers& given) {
  const auto& [luminance, pixel, left, top] = given;
  return {luminance.data(),
          static_cast<std::int64_t>(luminance.shape(0)),
          static_cast<std::int64_t>(luminance.shape(1)),
          pixel,
          {left, top}};
}
device::HandPath path_of(const PathNumbers& given) {
  const auto& [times, vx, vy, x, y] = given;
  return {times.data(), vx.data(), vy.data(), x.data(), y.data(), times.size()};
}

template <class N, class Function>
Array<N> mapped(std::size_t count, Function&& f) {
  std::vector<N> found(count);
  for (std::size_t i = 0; i < count; ++i) found[i] = static_cast<N>(f(i));
  return to_array(std::move(found));
}

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

// ---- printed lines -------------------------------------------------------------------------------

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
    for (std::size_t i = 0; i < spots.shape(0) && edges < most && go_on(1U << 12); ++i)
      lines.push_back(page.lines({spots(i, 0), spots(i, 1)}, most - edges, edges));
    return std::pair{std::move(lines), edges};
  });
  nb::list tables;
  for (const auto& lines : found) tables.append(table_of(lines));
  return nb::make_tuple(tables, count);
}

// ---- evaluation ----------------------------------------------------------------------------------

using Lines =
    std::tuple<Column, Column, nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig>>;
/// Number; offset of its spot; motion; times with the magnet on, (n, 2); printed lines.
using PinNumbers = std::tuple<int, double, double, const pd::OwnedMotion<double>*, Table, Lines>;

device::ScannedPin pin_of(const PinNumbers& given, const pd::Motion<double>& motion) {
  const auto& [number, x, y, owned, energised, lines] = given;
  device::ScannedPin pin{number, {x, y}, &motion, {}, {}};
  for (std::size_t i = 0; i < energised.shape(0); ++i)
    pin.energised.push_back({energised(i, 0), energised(i, 1)});
  const auto& [begins, ends, whole] = lines;
  for (std::size_t i = 0; i < begins.size(); ++i)
    pin.lines.push_back({begins.data()[i], ends.data()[i], whole.data()[i] != 0});
  return pin;
}

struct Found {
  std::vector<device::EvaluatedLine> lines;
  std::vector<device::FalseLine> false_lines;
  std::vector<std::vector<double>> dips;
};

nb::dict dictionary(Found&& found) {
  nb::dict table;
  const auto line = [&](const char* name, auto&& f) {
    table[name] =
        mapped<double>(found.lines.size(), [&](std::size_t i) { return f(found.lines[i]); });
  };
  const auto code = [&](const char* name, auto&& f) {
    table[name] =
        mapped<std::int64_t>(found.lines.size(), [&](std::size_t i) { return f(found.lines[i]); });
  };
  using Line = device::EvaluatedLine;
  code("pin", [](const Line& l) { return l.pin; });
  code("fate", [](const Line& l) { return l.outcome; });
  const auto edge = [&](const char* const(&names)[7], const char* cue,
                        device::EvaluatedEdge Line::* end) {
    line(names[0], [end](const Line& l) { return (l.*end).time; });
    line(names[1], [end](const Line& l) { return (l.*end).spot.x; });
    line(names[2], [end](const Line& l) { return (l.*end).spot.y; });
    line(names[3], [end](const Line& l) { return (l.*end).command; });
    line(names[4], [end](const Line& l) { return (l.*end).response; });
    line(names[5], [end](const Line& l) { return (l.*end).lag; });
    line(names[6], [end](const Line& l) { return (l.*end).skin; });
    code(cue, [end](const Line& l) { return (l.*end).cue; });
  };
  edge({"begin_time", "begin_x", "begin_y", "begin_command", "begin_response", "lag_on", "skin_on"},
       "cue_on", &Line::begin);
  edge({"end_time", "end_x", "end_y", "end_command", "end_response", "lag_off", "skin_off"},
       "cue_off", &Line::end);
  line("stroke", [](const Line& l) { return l.stroke; });
  line("height", [](const Line& l) { return l.height; });
  line("returned", [](const Line& l) { return l.returned; });
  line("release", [](const Line& l) { return l.release; });
  line("settled", [](const Line& l) { return l.settled; });
  line("smear", [](const Line& l) { return l.smear; });
  line("overshoot", [](const Line& l) { return l.overshoot; });
  line("contrast", [](const Line& l) { return l.contrast; });
  const auto& false_lines = found.false_lines;
  const auto false_line = [&](const char* name, auto&& f) {
    table[name] =
        mapped<double>(false_lines.size(), [&](std::size_t i) { return f(false_lines[i]); });
  };
  using FalseLine = device::FalseLine;
  table["false_line_pin"] =
      mapped<std::int64_t>(false_lines.size(), [&](std::size_t i) { return false_lines[i].pin; });
  false_line("false_line_time", [](const FalseLine& l) { return l.time; });
  false_line("false_line_x", [](const FalseLine& l) { return l.spot.x; });
  false_line("false_line_y", [](const FalseLine& l) { return l.spot.y; });
  false_line("false_line_stroke", [](const FalseLine& l) { return l.height; });
  nb::list dips;
  for (auto& each : found.dips) dips.append(to_array(std::move(each)));
  table["dips"] = dips;
  return table;
}

nb::dict evaluate(const PathNumbers& path, double axis, double latency, double residual_load,
                  const std::tuple<double, double, double, double, double>& criteria,
                  const std::vector<PinNumbers>& pins) {
  return dictionary(interruptible([&](auto go_on) {
    const device::HandPath hand = path_of(path);
    const device::Axis along(axis);
    const device::Way way(hand);
    const std::vector<double> turnings = device::turnings(hand, along);
    const auto [felt, direction, sure, speed, false_line] = criteria;
    const device::ScanSetting setting{hand,
                                      along,
                                      &way,
                                      &turnings,
                                      latency,
                                      residual_load,
                                      {felt, direction, sure, speed, false_line}};
    Found found;
    for (const PinNumbers& numbers : pins) {
      const pd::Motion<double> motion = std::get<3>(numbers)->view();
      const device::ScannedPin pin = pin_of(numbers, motion);
      const device::PinEvaluation evaluation(setting, pin);
      evaluation.add_lines(found.lines);
      evaluation.add_false_lines(found.false_lines);
      std::vector<double> dips;
      for (const auto& pull : evaluation.pulls()) dips.push_back(pull.dip);
      found.dips.push_back(std::move(dips));
      if (!go_on(1U << 12)) break;
    }
    return found;
  }));
}

}  // namespace

void bind_device(nb::module_& m) {
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
  m.def("evaluate", &evaluate, "path"_a, "axis"_a, "latency"_a, "residual_load"_a, "criteria"_a,
        "pins"_a);
}
