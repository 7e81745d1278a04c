// Page, hand and evaluation of a scan: arrays in and out of include/pindrive/device. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bytes.hpp"
#include "interrupt.hpp"
#include "owned_motion.hpp"
#include "pindrive/device/closest_approach.hpp"
#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/pin_evaluation.hpp"
#include "pindrive/device/printed_lines.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/device/scan.hpp"

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

// ---- scan ----------------------------------------------------------------------------------------

/// Kinetic and static friction, stiffness, and the rows (speed, force) of the curve.
using ContactNumbers = std::tuple<double, double, double, pd::Rows>;
/// Mass, stiffness, damping; plate, finger; travel, stiffness and damping of the end stops.
using DriveNumbers = std::tuple<double, double, double, ContactNumbers, ContactNumbers,
                                std::tuple<double, double, double>>;
/// Numbers of an electromagnet in the order of MagnetParameters; rows (time, level) of its voltage.
using MagnetNumbers = std::pair<std::vector<double>, pd::Rows>;
/// Sample rate, latency, threshold, hysteresis.
using ControlNumbers = std::tuple<double, double, double, double>;
/// Since, flux, pull, warming, level, commanded; on, command.
using CoilNumbers = std::tuple<double, double, double, double, double, double, bool, bool>;
/// Position, velocity, stretch; coil; decision, pending switchings; numbers of the motion, none of a release.
using StateNumbers =
    std::tuple<double, double, double, CoilNumbers, bool, std::vector<double>, std::vector<double>>;

/// Numbers of a state, in the order of its bytes.
struct ToNumbers {
  std::vector<double> list;

  template <class N>
  void item(const N& number) {
    list.push_back(static_cast<double>(number));
  }
};
struct FromNumbers {
  const std::vector<double>& list;
  std::size_t next{0};

  template <class N>
  void item(N& number) {
    number = static_cast<N>(list.at(next++));
  }
};

std::vector<double> numbers_of(pd::StepperState<double> state) {
  ToNumbers numbers;
  pindrive_c::exchange(numbers, state);
  return std::move(numbers.list);
}
std::optional<pd::StepperState<double>> motion_of(const std::vector<double>& given) {
  if (given.empty()) return {};
  pd::StepperState<double> state{};
  FromNumbers numbers{given};
  pindrive_c::exchange(numbers, state);
  return state;
}

device::Electromagnet magnet_of(const MagnetNumbers& given) {
  const std::vector<double>& n = given.first;
  std::vector<device::VoltageStep> steps;
  for (const auto& [time, level] : given.second) steps.push_back({time, level});
  return device::Electromagnet(
      {n.at(0), n.at(1), n.at(2), n.at(3), n.at(4), n.at(5), n.at(6), n.at(7), n.at(8), n.at(9),
       n.at(10), n.at(11), n.at(12), n.at(13), n.at(14)},
      std::move(steps));
}

device::CoilState coil_of(const CoilNumbers& given) {
  const auto& [since, flux, pull, warming, level, commanded, on, command] = given;
  return {since, flux, pull, warming, level, commanded, on, command};
}
CoilNumbers numbers_of(const device::CoilState& s) {
  return {s.since, s.flux, s.pull, s.warming, s.level, s.commanded, s.on, s.command};
}

template <class Function>
auto column_of(const std::vector<device::FluxPiece>& pieces, Function&& f) {
  return mapped<double>(pieces.size(), [&](std::size_t i) { return f(pieces[i]); });
}

/// Columns of the pieces of a coil, rows of its pull and its state at the end.
nb::tuple table_of(const device::CoilCourse& course) {
  using Piece = device::FluxPiece;
  const auto column = [&](auto&& f) { return column_of(course.pieces, f); };
  nb::dict pieces;
  pieces["begins"] = column([](const Piece& p) { return p.begin; });
  pieces["starts"] = column([](const Piece& p) { return p.start; });
  pieces["on"] = mapped<std::uint8_t>(course.pieces.size(),
                                      [&](std::size_t i) { return course.pieces[i].on; });
  pieces["levels"] = column([](const Piece& p) { return p.level; });
  pieces["targets"] = column([](const Piece& p) { return p.target; });
  pieces["constants"] = column([](const Piece& p) { return p.constant; });
  pieces["inductances"] = column([](const Piece& p) { return p.inductance; });
  pieces["warmings"] = column([](const Piece& p) { return p.warming; });
  pieces["resistances"] = column([](const Piece& p) { return p.resistance; });
  return nb::make_tuple(pieces, to_array(std::vector<double>(course.times)),
                        to_array(std::vector<double>(course.pulls)), numbers_of(course.end));
}

nb::tuple coil_course(const MagnetNumbers& magnet, const CoilNumbers& from,
                      const Column& switchings, double begin, double end, std::size_t most) {
  device::CoilCourse course;
  course.follow(magnet_of(magnet), coil_of(from), switchings.data(), switchings.size(), begin, end,
                most);
  return table_of(course);
}

/// Scan with all that it refers to.
class Scan {
 public:
  Scan(const DriveNumbers& drive, double normal_force, const MagnetNumbers& magnet,
       const ControlNumbers& control, double axis, RasterNumbers raster, PathNumbers path,
       const Table& spots, const pd::Rows& touch, const std::vector<StateNumbers>& states)
      : raster_(std::move(raster)),
        path_(std::move(path)),
        plate_(contact(std::get<3>(drive)), contact(std::get<3>(drive))),
        finger_(contact(std::get<4>(drive)), contact(std::get<4>(drive))),
        touch_(touch, touch),
        device_{drive_of(drive),        normal_force,       magnet_of(magnet),
                controller_of(control), device::Axis(axis), spots_of(spots)},
        velocity_(path_of(path_), device_.axis),
        inputs_{device_,   raster_of(raster_), path_of(path_),
                velocity_, touch_.profile(),   path_of(path_).begin()} {
    for (const auto& [position, velocity, stretch, coil, decision, pending, motion] : states)
      states_.push_back(
          {position, velocity, stretch, coil_of(coil), decision, pending, motion_of(motion)});
    runs_.resize(states_.size());
    motions_.resize(states_.size());
  }
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  std::size_t size() const { return runs_.size(); }

  /// Samples the page and switches the coils; returns the numbers of switchings and of input rows until
  /// one of them exceeds its limit, and the number of pins so far.
  nb::tuple energise(std::size_t most_switchings, std::size_t most_rows) {
    std::size_t switchings = 0, rows = 0, pins = 0;
    interruptible([&](auto go_on) {
      while (pins < size() && switchings <= most_switchings && rows <= most_rows &&
             go_on(1U << 12)) {
        device::PinRun& run = runs_[pins];
        run.energise(inputs_, pins, states_[pins], std::max(most_switchings, most_rows));
        switchings += run.coil.pieces.size() - 1;
        rows += run.loads.size() + inputs_.path.count + touch_rows();
        ++pins;
      }
      return 0;
    });
    return nb::make_tuple(switchings, rows, pins);
  }

  /// Simulates the pins with several threads, until they have more than the largest number of segments;
  /// returns the numbers of segments and of pins.
  /// The caller's thread is the first one; it alone checks for an interrupt and reports the progress.
  nb::tuple simulate(std::size_t threads, std::size_t most_segments, const nb::object& progress) {
    std::atomic<std::size_t> next{0}, done{0}, segments{0};
    std::atomic<bool> stopped{false};
    std::size_t reported = 0;
    Interrupt interrupt;
    const auto work = [&](auto go_on, auto report) {
      for (std::size_t i = next++; i < size() && !stopped; i = next++) {
        simulate_pin(i, go_on);
        segments += motions_[i]->segments().size();
        ++done;
        if (segments > most_segments) stopped = true;
        if (!stopped) report();
      }
    };
    const auto report = [&] {
      if (progress.is_none() || interrupt.found() || stopped) return;
      const nb::gil_scoped_acquire locked;
      for (std::size_t now = done; reported < now;) progress(++reported, size());
    };
    {
      const nb::gil_scoped_release unlocked;
      std::vector<std::future<void>> others;
      try {
        while (others.size() + 1 < std::min(threads, size()))
          others.push_back(std::async(std::launch::async, [&] {
            work([&] { return !stopped.load(std::memory_order_relaxed); }, [] {});
          }));
        work([&] { return interrupt.go_on() && !stopped; }, report);
        if (interrupt.found()) stopped = true;
        for (auto& other : others)
          while (other.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
            if (!interrupt.look()) stopped = true;
            report();
          }
        report();
      } catch (...) {
        stopped = true;
        throw;
      }
    }
    if (interrupt.found()) throw nb::python_error();
    return nb::make_tuple(segments.load(), done.load());
  }

  const pd::StoredMotion<double>& motion(std::size_t pin) const { return *motions_.at(pin); }
  const device::PinRun& run(std::size_t pin) const { return runs_.at(pin); }
  const device::ScanInputs& inputs() const { return inputs_; }

 private:
  static pd::ContactNumbers contact(const ContactNumbers& given) {
    const auto& [kinetic, fixed, stiffness, curve] = given;
    return {kinetic, fixed, stiffness, curve};
  }
  pd::Drive<double> drive_of(const DriveNumbers& given) const {
    const auto& [travel, stiffness, damping] = std::get<5>(given);
    return {std::get<0>(given), std::get<1>(given), std::get<2>(given),
            plate_.contact,     finger_.contact,    {travel, stiffness, damping}};
  }
  static device::Controller controller_of(const ControlNumbers& given) {
    const auto& [rate, latency, threshold, hysteresis] = given;
    return {rate, latency, threshold, hysteresis};
  }
  static std::vector<device::Place> spots_of(const Table& spots) {
    std::vector<device::Place> found;
    for (std::size_t i = 0; i < spots.shape(0); ++i) found.push_back({spots(i, 0), spots(i, 1)});
    return found;
  }
  std::size_t touch_rows() const { return std::max<std::size_t>(touch_.first.size(), 1); }

  template <class GoOn>
  void simulate_pin(std::size_t i, GoOn&& go_on) {
    device::PinRun& run = runs_[i];
    run.simulate(inputs_, states_[i], go_on);
    motions_[i] = std::make_unique<pd::StoredMotion<double>>(
        device_.drive, run.inputs(inputs_, states_[i]), std::move(run.segments), run.outcome);
  }

  RasterNumbers raster_;
  PathNumbers path_;
  pd::OwnedContact<double> plate_, finger_;
  pd::OwnedRows<double> touch_;
  device::Device device_;
  device::PlateVelocity velocity_;
  device::ScanInputs inputs_;
  std::vector<device::PinState> states_;
  std::vector<device::PinRun> runs_;
  std::vector<std::unique_ptr<pd::StoredMotion<double>>> motions_;
};

/// Smallest difference of the positions of each pair of motions, by their indices, and its time.
nb::tuple closest_approaches(const std::vector<const pd::StoredMotion<double>*>& motions,
                             const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                             double duration) {
  auto both = interruptible([&](auto go_on) {
    std::vector<device::BoundedPieces> pieces;
    for (const auto* const motion : motions)
      if (go_on(1U << 10)) pieces.emplace_back(motion->view(), duration);
    std::pair<std::vector<double>, std::vector<double>> found;
    for (const auto& [behind, ahead] : pairs) {
      if (!go_on(1U << 12)) break;
      const device::Approach closest =
          device::ClosestApproach(pieces.at(behind), pieces.at(ahead), duration).found();
      found.first.push_back(closest.difference);
      found.second.push_back(closest.time);
    }
    return found;
  });
  return nb::make_tuple(to_array(std::move(both.first)), to_array(std::move(both.second)));
}

// ---- evaluation ----------------------------------------------------------------------------------

using Lines =
    std::tuple<Column, Column, nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig>>;

std::vector<device::PrintedLine> lines_of(const Lines& given) {
  const auto& [begins, ends, whole] = given;
  std::vector<device::PrintedLine> found;
  for (std::size_t i = 0; i < begins.size(); ++i)
    found.push_back({begins.data()[i], ends.data()[i], whole.data()[i] != 0});
  return found;
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

nb::dict evaluate(const Scan& scan,
                  const std::tuple<double, double, double, double, double>& criteria,
                  const std::vector<Lines>& printed) {
  return dictionary(interruptible([&](auto go_on) {
    const device::ScanInputs& inputs = scan.inputs();
    const device::Device& device = inputs.device;
    const device::Way way(inputs.path);
    const std::vector<double> turnings = device::turnings(inputs.path, device.axis);
    const auto [felt, direction, sure, speed, false_line] = criteria;
    const device::ScanSetting setting{inputs.path,
                                      device.axis,
                                      &way,
                                      &turnings,
                                      device.controller.latency,
                                      device.load(device.magnet.given().residual),
                                      {felt, direction, sure, speed, false_line}};
    Found found;
    for (std::size_t i = 0; i < scan.size() && go_on(1U << 12); ++i) {
      const pd::Motion<double> motion = scan.motion(i).view();
      const device::ScannedPin pin{static_cast<int>(i), device.spots[i], &motion,
                                   scan.run(i).energised(inputs), lines_of(printed.at(i))};
      const device::PinEvaluation evaluation(setting, pin);
      evaluation.add_lines(found.lines);
      evaluation.add_false_lines(found.false_lines);
      std::vector<double> dips;
      for (const auto& pull : evaluation.pulls()) dips.push_back(pull.dip);
      found.dips.push_back(std::move(dips));
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
  m.def(
      "plate_velocity",
      [](const PathNumbers& path, double axis) {
        const device::PlateVelocity found(path_of(path), device::Axis(axis));
        return nb::make_tuple(to_array(std::vector<double>(found.times)),
                              to_array(std::vector<double>(found.along)),
                              to_array(std::vector<double>(found.across)), found.oblique());
      },
      "path"_a, "axis"_a,
      "Times since the begin; velocity along and across the axis; whether across it moves.");
  m.def("closest_approaches", &closest_approaches, "motions"_a, "pairs"_a, "duration"_a,
        "Smallest x(behind) - x(ahead) of each pair of motions, m, and its time, s.");
  m.def("coil_course", &coil_course, "magnet"_a, "state"_a, "switchings"_a, "begin"_a, "end"_a,
        "most"_a,
        "Pieces of a coil under commands, rows of its pull (times, N), and its state at the end.");
  nb::class_<Scan>(m, "Scan", "Pins under a hand that moves over a page.")
      .def(nb::init<const DriveNumbers&, double, const MagnetNumbers&, const ControlNumbers&,
                    double, RasterNumbers, PathNumbers, const Table&, const pd::Rows&,
                    const std::vector<StateNumbers>&>(),
           "drive"_a, "normal_force"_a, "magnet"_a, "control"_a, "axis"_a, "raster"_a, "path"_a,
           "spots"_a, "touch"_a, "states"_a)
      .def("energise", &Scan::energise, "most_switchings"_a, "most_rows"_a)
      .def("simulate", &Scan::simulate, "threads"_a, "most_segments"_a, "progress"_a.none())
      .def("motion", &Scan::motion, "pin"_a, nb::rv_policy::reference_internal)
      .def(
          "switchings",
          [](const Scan& scan, std::size_t pin) {
            return to_array(std::vector<double>(scan.run(pin).switchings));
          },
          "pin"_a)
      .def(
          "coil", [](const Scan& scan, std::size_t pin) { return table_of(scan.run(pin).coil); },
          "pin"_a)
      .def(
          "load",
          [](const Scan& scan, std::size_t pin) {
            const device::PinRun& run = scan.run(pin);
            return nb::make_tuple(to_array(std::vector<double>(run.load_times)),
                                  to_array(std::vector<double>(run.loads)));
          },
          "pin"_a)
      .def(
          "control",
          [](const Scan& scan, std::size_t pin) {
            const device::PinRun& run = scan.run(pin);
            return nb::make_tuple(run.commanded, run.decision, run.pending);
          },
          "pin"_a, "Whether it was commanded on at first; the last decision; pending switchings.")
      .def(
          "end", [](const Scan& scan, std::size_t pin) { return numbers_of(scan.run(pin).ended); },
          "pin"_a, "State of the pin at the end: time, twice, and its error; x, v, skin force; ...")
      .def("evaluate", &evaluate, "criteria"_a, "lines"_a);
}
