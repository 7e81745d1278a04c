// Table of the inputs and its wording for the Python extension. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "contradictions.hpp"
#include "pindrive/device/inputs.hpp"
#include "wording.hpp"

namespace nb = nanobind;
namespace device = pindrive::device;
using nb::literals::operator""_a;

namespace {

/// Lower and upper end, whether they are closed, and the value beside; NaN: none.
using BoundsNumbers = std::tuple<double, double, bool, bool, double>;

BoundsNumbers numbers_of(const device::Bounds& b) {
  return {b.lower, b.upper, b.lower_closed, b.upper_closed, b.also};
}

using GivenRows = std::vector<std::pair<double, double>>;
/// A value by its key: a number, rows, or None: not known.
using Given = std::pair<std::string, std::optional<std::variant<double, GivenRows>>>;
/// Key, part of the value, required and given in words, and the keys that it contradicts.
using ProblemWords =
    std::tuple<std::string, std::string, std::string, std::string, std::vector<std::string>>;

std::vector<ProblemWords> problems_of(const std::vector<Given>& given, bool whole) {
  static_assert(sizeof(GivenRows::value_type) == 2 * sizeof(double));
  std::vector<pindrive_given> values;
  for (const auto& [key, value] : given)
    if (!value)
      values.push_back({key.c_str(), nullptr, 0});
    else if (const auto* const number = std::get_if<double>(&*value))
      values.push_back({key.c_str(), number, 0});
    else if (const auto& rows = std::get<GivenRows>(*value); !rows.empty())
      values.push_back({key.c_str(), &rows.front().first, rows.size()});
  std::vector<ProblemWords> found;
  for (const pindrive_c::Problem& problem :
       pindrive_c::problems_of(values.data(), values.size(), whole)) {
    std::vector<std::string> with;
    for (const char* const key : problem.with)
      if (key) with.emplace_back(key);
    found.emplace_back(problem.key, problem.part.get(), problem.required.get(), problem.given.get(),
                       std::move(with));
  }
  return found;
}

}  // namespace

void bind_inputs(nb::module_& m) {
  nb::list laws;
  for (const char* const name : device::law_names) laws.append(nb::str(name));
  m.attr("friction_laws") = nb::tuple(laws);
  m.def(
      "input_quantities",
      [] {
        nb::list rows;
        for (const device::InputQuantity& row : device::input_quantities)
          rows.append(nb::make_tuple(nb::str(row.key), nb::str(row.unit), numbers_of(row.bounds),
                                     numbers_of(row.computable_bounds()), row.absent));
        return rows;
      },
      "Key, unit, bounds, computable bounds and value without the key, of each input.");
  m.def(
      "bounds_words",
      [](const BoundsNumbers& bounds, const std::string& unit) {
        const auto& [lower, upper, lower_closed, upper_closed, also] = bounds;
        pindrive_c::Text text;
        pindrive_c::add_bounds(text, {lower, upper, lower_closed, upper_closed, also},
                               unit.c_str());
        return std::string(text.get());
      },
      "bounds"_a, "unit"_a);
  m.def("value_problems", &problems_of, "given"_a, "whole"_a,
        "Problems of values by key, SI: bounds of each, and contradictions.");
}
