// Evaluation of scans and the largest hand speeds: arrays in and out of include/pindrive/device. No logic lives
// here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "_scan.hpp"
#include "arrays.hpp"
#include "interrupt.hpp"
#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/printed_lines.hpp"
#include "pindrive/device/scan_evaluation.hpp"
#include "pindrive/device/speed_limit.hpp"
#include "pindrive/device/two_lines.hpp"
#include "pindrive/engine.hpp"

namespace nb = nanobind;
namespace device = pindrive::device;
using nb::literals::operator""_a;
using pindrive_python::OwnedDevice;
using pindrive_python::Scan;

namespace {

/// Criteria of a felt line, in the order of `device::Criteria`.
using CriteriaNumbers = std::tuple<double, double, double, double, double, double>;

device::Criteria criteria_of(const CriteriaNumbers& given) {
  const auto [felt, direction, sure, speed, false_line, distinct] = given;
  return {felt, direction, sure, speed, false_line, distinct};
}

// ---- evaluation ----------------------------------------------------------------------------------

/// Evaluation, the number of edges of printed lines, and the number of pins; incomplete with more than
/// `most` edges.
nb::tuple evaluate(const Scan& scan, const CriteriaNumbers& criteria, std::size_t most) {
  device::Evaluation found;
  const auto [edges, pins] = interruptible([&](auto go_on) {
    const device::ScanInputs& inputs = scan.inputs();
    const device::Device& device = inputs.device;
    const device::PageAlongPath page(inputs.raster, inputs.path, device.axis,
                                     device.controller.threshold);
    const device::ScanEvaluation evaluation(inputs, criteria_of(criteria));
    std::size_t count = 0, pin = 0;
    for (; pin < scan.size() && count < most && go_on(); ++pin) {
      auto printed = page.lines(device.spots[pin], most - count, count);
      if (count >= most) continue;
      evaluation.add(pin, scan.run(pin), scan.motion(pin).view(), std::move(printed), found);
    }
    return std::pair{count, pin};
  });
  return nb::make_tuple(std::move(found), edges, pins);
}

/// Numbers of all lines and false lines by name.
nb::dict columns(const device::Evaluation& found) {
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
  const auto edge = [&](const char* const(&names)[5], const char* cue,
                        device::EvaluatedEdge Line::* end) {
    line(names[0], [end](const Line& l) { return (l.*end).time; });
    line(names[1], [end](const Line& l) { return (l.*end).spot.x; });
    line(names[2], [end](const Line& l) { return (l.*end).spot.y; });
    line(names[3], [end](const Line& l) { return (l.*end).command; });
    line(names[4], [end](const Line& l) { return (l.*end).response; });
    code(cue, [end](const Line& l) { return (l.*end).cue; });
  };
  edge({"begin_time", "begin_x", "begin_y", "begin_command", "begin_response"}, "cue_on",
       &Line::begin);
  edge({"end_time", "end_x", "end_y", "end_command", "end_response"}, "cue_off", &Line::end);
  std::size_t number = 0;
  for (const char* const name : device::line_number_names) {
    const auto which = static_cast<device::LineNumber>(number++);
    line(name, [which](const Line& l) { return device::Evaluation::number(l, which); });
  }
  line("height", [](const Line& l) { return l.height; });
  line("returned", [](const Line& l) { return l.returned; });
  line("release", [](const Line& l) { return l.release; });
  line("settled", [](const Line& l) { return l.settled; });
  const auto& false_lines = found.false_lines;
  const auto false_line = [&](const char* name, auto&& f) {
    table[name] =
        mapped<double>(false_lines.size(), [&](std::size_t i) { return f(false_lines[i]); });
  };
  using device::FalseLine;
  table["false_line_pin"] =
      mapped<std::int64_t>(false_lines.size(), [&](std::size_t i) { return false_lines[i].pin; });
  false_line("false_line_time", [](const FalseLine& l) { return l.time; });
  false_line("false_line_x", [](const FalseLine& l) { return l.spot.x; });
  false_line("false_line_y", [](const FalseLine& l) { return l.spot.y; });
  false_line("false_line_stroke", [](const FalseLine& l) { return l.height; });
  return table;
}

nb::dict counts(const device::Evaluation& evaluation) {
  const device::LineCounts found = evaluation.counts();
  nb::dict table;
  table["crossed"] = found.crossed;
  table["shown"] = found.shown;
  table["unseen"] = found.unseen;
  table["merged"] = found.merged;
  table["faint"] = found.faint;
  table["false"] = found.false_lines;
  table["unsettled"] = found.unsettled;
  table["direction"] = found.direction;
  table["sure"] = found.sure;
  return table;
}

nb::dict spreads(const device::Evaluation& evaluation) {
  nb::dict table;
  std::size_t number = 0;
  for (const char* const name : device::line_number_names) {
    const device::Spread found = evaluation.spread(static_cast<device::LineNumber>(number++));
    table[name] = nb::make_tuple(found.least, found.median, found.largest);
  }
  return table;
}

// ---- largest hand speed --------------------------------------------------------------------------

/// Speed, return, motion of the skin, and true for two lines shown; code of its status.
using TrialNumbers = std::tuple<double, double, double, bool, int>;
using Bands = std::vector<std::pair<double, double>>;

TrialNumbers numbers_of(const device::LineTrial& trial) {
  return {trial.speed, trial.back, trial.skin, trial.shown, static_cast<int>(trial.status)};
}

TrialNumbers two_lines(const OwnedDevice& device, double pitch, double width,
                       const CriteriaNumbers& criteria, double speed) {
  return numbers_of(interruptible([&](auto go_on) {
    return device::TwoLines(device.view(), pitch, width, criteria_of(criteria)).at(speed, go_on);
  }));
}

Bands bands_of(const std::vector<device::SpeedBand>& found) {
  Bands bands;
  for (const auto& [slowest, fastest] : found) bands.emplace_back(slowest, fastest);
  return bands;
}

/// Bands of distinct and of settled lines, the trial beyond the first, and the code of the status.
std::tuple<Bands, Bands, std::optional<TrialNumbers>, int> speed_limit(
    const OwnedDevice& device, double pitch, double width, const CriteriaNumbers& criteria,
    std::pair<double, double> tried, const nb::object& progress) {
  const device::Criteria limits = criteria_of(criteria);
  const device::SpeedLimit found = interruptible([&](auto go_on) {
    const device::TwoLines lines(device.view(), pitch, width, limits);
    device::SpeedLimitSearch search(lines, limits.direction, {{tried.first, tried.second}});
    return search.found(go_on, [&](int trials) {
      if (progress.is_none() || !go_on()) return;  // an error that is pending allows no call
      const nb::gil_scoped_acquire locked;
      progress(trials);
    });
  });
  std::optional<TrialNumbers> beyond;
  if (found.beyond) beyond = numbers_of(*found.beyond);
  return {bands_of(found.distinct), bands_of(found.settled), beyond,
          static_cast<int>(found.status)};
}

}  // namespace

void bind_evaluation(nb::module_& m) {
  nb::class_<device::Evaluation>(m, "Evaluation", "Lines and false lines under the pins of a scan.")
      .def("columns", &columns)
      .def("counts", &counts)
      .def("spreads", &spreads, "Least, median and largest of each number of the lines shown.");
  m.def("evaluate", &evaluate, "scan"_a, "criteria"_a, "most"_a);
  m.attr("tried_speeds") = device::SpeedSearch{}.count;
  m.attr("speed_precision") = device::SpeedSearch{}.precision;
  m.def("two_lines", &two_lines, "device"_a, "pitch"_a, "width"_a, "criteria"_a, "speed"_a);
  m.def("speed_limit", &speed_limit, "device"_a, "pitch"_a, "width"_a, "criteria"_a, "tried"_a,
        "progress"_a.none());
}
