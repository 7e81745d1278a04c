// Table of the inputs and its wording for the Python extension. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <limits>
#include <string>
#include <tuple>

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

}  // namespace

void bind_inputs(nb::module_& m) {
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
}
