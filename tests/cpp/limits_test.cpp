// The limits that are not physics: each is where its reason puts it, and those that end a motion do.
#include "pindrive/numbers/limits.hpp"

#include <cmath>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;

int main() {
  namespace limits = pd::detail;
  expect(limits::rounding<double> >= 8 * 0.5 * std::numeric_limits<double>::epsilon(),
         "eight terms are rounded by half an epsilon each");
  expect(limits::return_tolerance >= 20 * limits::rounding<double> / 2 &&
             limits::return_tolerance < limits::approach_tolerance &&
             limits::approach_tolerance < limits::repeat_tolerance,
         "a cycle is closed more closely than it has to repeat, and less than rounding allows");
  const double left = std::exp(-limits::term_duration) / limits::rounding<double>;
  expect(0.9 < left && left < 1,
         "a term of an input lasts until rounding of its amplitude remains");
  expect(limits::standstill_limit > 3, "physics has up to three events at an instant");

  // Without damping and with next to no friction it would swing more than 10^7 times.
  const pd::Drive<double> drive{0.010, 100.0, 0, {}, {1e-9, 1e-9}};
  const pd::Inputs<double> inputs{0.0, 0.1, 0.0};
  long long events = 0;
  const auto outcome = pd::simulate(drive, inputs, [&](const auto&) { ++events; });
  expect(outcome.status == pd::Status::too_many_events && events == 1000000,
         "a motion with too many events is given up, with a status of its own");
  return check::status();
}
