// Coils, devices and scans: arrays in and out of include/pindrive/device. No logic lives here.
#include "_scan.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "interrupt.hpp"
#include "owned_motion.hpp"
#include "pindrive/device/closest_approach.hpp"
#include "pindrive/device/coil_course.hpp"
#include "pindrive/device/magnet_construction.hpp"
#include "pindrive/numbers/dual.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
namespace device = pindrive::device;
using nb::literals::operator""_a;
using namespace pindrive_python;

namespace {

using Dual = pd::Dual<double>;

template <class Function>
auto column_of(const std::vector<device::FluxPiece<double>>& pieces, Function&& f) {
  return mapped<double>(pieces.size(), [&](std::size_t i) { return f(pieces[i]); });
}

/// Begin, polynomial and terms of a piece for Python, each number through `number`.
template <class T, class Number>
nb::tuple piece_of(const pd::InputPiece<T>& piece, Number&& number) {
  nb::list terms;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const pd::InputTerm<T>& term = piece.terms[i];
    terms.append(nb::make_tuple(number(term.cosine), number(term.sine), number(term.decay),
                                number(term.frequency)));
  }
  return nb::make_tuple(number(piece.begin),
                        nb::make_tuple(number(piece.polynomial[0]), number(piece.polynomial[1])),
                        nb::tuple(terms));
}
nb::tuple piece_of(const pd::InputPiece<double>& piece) {
  return piece_of(piece, [](double value) { return value; });
}

/// Columns of the pieces of a coil, pieces of its pull and its state at the end.
nb::tuple table_of(const device::CoilCourse<double>& course) {
  using Piece = device::FluxPiece<double>;
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
  nb::list pulls;
  for (const device::PullPiece<double>& pull : course.pulls) {
    // The load on a plate with a normal force of 1 N is 1 more.
    pd::OwnedPiece<double> given = device::Pressing<double>{1.0}.load_under(pull, 0.0);
    given.piece.polynomial[0] = pull.constant;
    pulls.append(piece_of(given.piece));
  }
  return nb::make_tuple(pieces, pulls, numbers_of(course.end));
}

using Keys = std::map<std::string, double>;

/// Reads keys of a device file with a derivative of 1 for one key; NaN without a value.
auto reader_of(const Keys& values, const std::string& along) {
  return [&](const char* key) -> Dual {
    const auto found = values.find(key);
    if (found == values.end()) return {std::numeric_limits<double>::quiet_NaN(), 0};
    return {found->second, found->first == along ? 1.0 : 0.0};
  };
}

/// Derived numbers of a coil by the keys of a device file.
std::map<std::string, double> coil_numbers(const Keys& values) {
  const auto coil = device::construction_by_keys(reader_of(values, ""));
  return {{"resistance", coil.resistance().value},
          {"inductance", coil.inductance().value},
          {"current", coil.current().value},
          {"field", coil.field().value},
          {"saturation", coil.saturation().value},
          {"pull", coil.pull().value},
          {"power", coil.power().value}};
}

/// Numbers of an electromagnet by the keys of a device file, and the derivatives by one key.
nb::tuple magnet_numbers(const Keys& values, const std::string& along) {
  const device::MagnetParameters<Dual> m = device::magnet_by_keys(reader_of(values, along));
  std::vector<double> numbers, slopes;
  for (const Dual& number :
       {m.hold_force, m.residual, m.saturation, m.rise_constant, m.fall_constant, m.closing_flux,
        m.open_inductance, m.pulse_frequency, m.pulse_duty, m.winding_resistance,
        m.outer_resistance, m.power, m.thermal_resistance, m.heat_capacity}) {
    numbers.push_back(number.value);
    slopes.push_back(number.slope);
  }
  return nb::make_tuple(numbers, slopes);
}

nb::tuple coil_course(const MagnetNumbers& magnet, const CoilNumbers& from,
                      const Column& switchings, double begin, double end, std::size_t most) {
  device::CoilCourse<double> course;
  course.follow(magnet_of(magnet), coil_of(from), switchings.data(), switchings.size(), begin, end,
                most);
  return table_of(course);
}

/// Normal force of a plate and its part that is touch, each with its derivative.
using PressingNumbers = std::pair<std::pair<double, double>, std::pair<double, double>>;

/// Derivative of the pieces of a load along numbers of the magnet, of what presses and of a delay of all
/// switchings.
nb::list load_along(const MagnetNumbers& magnet, const MagnetNumbers& along,
                    const PressingNumbers& pressing, const pd::Rows& touch, const CoilNumbers& from,
                    const Column& switchings, double delay, double begin, double end) {
  const auto electromagnet = magnet_with<Dual>(
      magnet, along, [](double value, double slope) -> Dual { return {value, slope}; });
  const auto& [since, flux, warming, level, commanded, on, command] = from;
  std::vector<Dual> times;
  for (std::size_t i = 0; i < switchings.size(); ++i)
    times.emplace_back(switchings.data()[i], delay);
  device::CoilCourse<Dual> course;
  course.follow(electromagnet, {since, flux, warming, level, commanded, on, command}, times.data(),
                times.size(), begin, end, std::numeric_limits<std::size_t>::max());
  const auto& [normal_force, touch_part] = pressing;
  const device::Pressing<Dual> pressed{{normal_force.first, normal_force.second},
                                       {touch_part.first, touch_part.second}};
  const pd::OwnedInput<double> touched(pd::InputNumbers{touch}, pd::InputNumbers{touch});
  nb::list found;
  for (const pd::OwnedPiece<Dual>& load :
       device::loads_under(course.pulls, pressed, Dual(begin), touched.profile()))
    found.append(piece_of(load.piece, [](const Dual& of) { return of.slope; }));
  return found;
}

/// Smallest difference of the positions of each pair of motions, by their indices, and its time.
nb::tuple closest_approaches(const std::vector<const pd::StoredMotion<double>*>& motions,
                             const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                             double duration) {
  auto both = interruptible([&](auto go_on) {
    std::vector<device::BoundedPieces> pieces;
    for (const auto* const motion : motions)
      if (go_on()) pieces.emplace_back(motion->view(), duration);
    std::pair<std::vector<double>, std::vector<double>> found;
    for (const auto& [behind, ahead] : pairs) {
      if (!go_on()) break;
      const device::Approach closest =
          device::ClosestApproach(pieces.at(behind), pieces.at(ahead), duration).found();
      found.first.push_back(closest.difference);
      found.second.push_back(closest.time);
    }
    return found;
  });
  return nb::make_tuple(to_array(std::move(both.first)), to_array(std::move(both.second)));
}

}  // namespace

void bind_scan(nb::module_& m) {
  m.def("coil_numbers", &coil_numbers, "values"_a,
        "Derived numbers of a coil by the keys of a device file, SI.");
  m.def("magnet_numbers", &magnet_numbers, "values"_a, "along"_a,
        "Numbers of an electromagnet by the keys of a device file; their derivatives by one key.");
  m.def("coil_course", &coil_course, "magnet"_a, "state"_a, "switchings"_a, "begin"_a, "end"_a,
        "most"_a,
        "Pieces of a coil under commands, those of its pull (N), and its state at the end.");
  m.def("load_along", &load_along, "magnet"_a, "along"_a, "pressing"_a, "touch"_a, "state"_a,
        "switchings"_a, "delay"_a, "begin"_a, "end"_a,
        "Derivative of the pieces of the factor of the plate friction: begin, polynomial, terms.");
  m.def("closest_approaches", &closest_approaches, "motions"_a, "pairs"_a, "duration"_a,
        "Smallest x(behind) - x(ahead) of each pair of motions, m, and its time, s.");
  nb::class_<OwnedDevice>(m, "Device", "Device whose pins are alike.")
      .def(nb::init<const DriveNumbers&, std::pair<double, double>, const MagnetNumbers&,
                    const ControlNumbers&, double, const Table&>(),
           "drive"_a, "pressing"_a, "magnet"_a, "control"_a, "axis"_a, "spots"_a);
  nb::class_<Scan>(m, "Scan", "Pins under a hand that moves over a page.")
      .def(nb::init<const OwnedDevice&, RasterNumbers, PathNumbers, const pd::Rows&,
                    const std::vector<StateNumbers>&>(),
           "device"_a, "raster"_a, "path"_a, "touch"_a, "states"_a, nb::keep_alive<1, 2>())
      .def("energise", &Scan::energise, "most_switchings"_a, "most_rows"_a)
      .def("hand", &Scan::hand, "hand"_a,
           "Path that a hand takes with its pins: times, velocities along the axis, bends, "
           "ambiguous samples, status, "
           "steps, and deflections of the pins at the end.")
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
            nb::list pieces;
            for (const pd::InputPiece<double>& piece : scan.run(pin).loads)
              pieces.append(piece_of(piece));
            return pieces;
          },
          "pin"_a, "Pieces of the factor of the plate friction: begin, polynomial, terms.")
      .def(
          "energised",
          [](const Scan& scan) {
            return mapped<double>(scan.size(), [&](std::size_t pin) {
              double sum = 0;
              for (const auto& [begin, end] : scan.run(pin).energised(scan.inputs()))
                sum += end - begin;
              return sum;
            });
          },
          "Time for which the magnet of each pin is switched on, s.")
      .def(
          "control",
          [](const Scan& scan, std::size_t pin) {
            const device::PinRun& run = scan.run(pin);
            return nb::make_tuple(run.commanded, run.decision, run.pending);
          },
          "pin"_a, "Whether it was commanded on at first; the last decision; pending switchings.")
      .def(
          "end", [](const Scan& scan, std::size_t pin) { return numbers_of(scan.run(pin).ended); },
          "pin"_a,
          "State of the pin at the end: time, twice, and its error; x, v, skin force; ...");
}
