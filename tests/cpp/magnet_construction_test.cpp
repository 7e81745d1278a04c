// Electromagnet by the keys of a device file: a coil by hand, times of a pull, derivatives beside differences.
#include "pindrive/device/magnet_construction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "check.hpp"
#include "pindrive/numbers/dual.hpp"

namespace device = pindrive::device;
using check::expect;
using Dual = pindrive::Dual<double>;

namespace {

bool close(double one, double other) { return std::abs(one / other - 1) < 1e-12; }

void a_coil() {
  const device::CoilConstruction<double> coil{250, 3e-6, 5e-5, 1e-4, 8.5e-3, 1, 2, 1.6};
  const double pi = 3.141592653589793, mu = 1.25663706127e-6;
  const double resistance = 250 * 8.5e-3 / (58e6 * pi / 4 * 1e-8), current = 1 / resistance;
  const double field = mu * 250 * current / 1e-4;
  expect(close(coil.resistance(), resistance), "resistance of the copper");
  expect(close(coil.inductance(), mu * 62500 * 3e-6 / 1e-4), "inductance of two gaps in series");
  expect(close(coil.field(), field) && coil.saturation() == 1, "field in the gap");
  expect(close(coil.pull(), field * field * 3e-6 / mu), "pull of two poles");
  device::CoilConstruction<double> weak = coil;
  weak.saturation_field = 0.25 * field;
  expect(close(weak.saturation(), 0.25) && close(weak.pull(), coil.pull() / 16), "saturation");
}

void times_of_a_pull() {
  for (const double sigma : {1.0, 0.6}) {
    const device::Electromagnet<double> magnet(
        {1, 0.1, sigma, device::rise_constant(0.003, sigma), device::fall_constant(0.005, sigma)});
    const double rises = magnet.piece(0, 0, 0, true, 1).flux_after(0.003);
    const double falls = magnet.piece(0, 1, 0, false, 1).flux_after(0.005);
    expect(close(magnet.pull(rises), 0.1 + 0.9 * 0.9), "90 % after the rise time");
    expect(close(magnet.pull(falls), 0.1 + 0.1 * 0.9), "10 % after the fall time");
    const double edge = device::closing_flux(magnet.given(), 0.3);
    expect(close(magnet.pull(edge), 0.3), "the gap closes where the pull is its force");
  }
}

using Keys = std::map<std::string, double>;

/// Electromagnet whose keys have values value(key, given).
template <class Value>
auto magnet_of(const Keys& keys, Value&& value) {
  using T = decltype(value(std::string(), 0.0));
  return device::magnet_by_keys([&](const char* key) -> T {
    const auto found = keys.find(key);
    return found == keys.end() ? T(std::numeric_limits<double>::quiet_NaN())
                               : value(found->first, found->second);
  });
}
auto plain_magnet(const Keys& keys) {
  return magnet_of(keys, [](const std::string&, double value) { return value; });
}

Keys by_times() {
  return {{"magnet.hold_force", 1.2}, {"magnet.rise_time", 0.003}, {"magnet.fall_time", 0.005},
          {"magnet.saturation", 0.6}, {"magnet.residual", 0.02},   {"magnet.pwm_frequency", 437},
          {"magnet.pwm_duty", 0.8}};
}

Keys by_construction() {
  return {{"magnet.turns", 300},
          {"magnet.pole_area", 6e-6},
          {"magnet.gap", 6e-5},
          {"magnet.wire_diameter", 1e-4},
          {"magnet.turn_length", 0.016},
          {"magnet.supply_voltage", 3},
          {"magnet.lift", 4e-5},
          {"magnet.release_resistance", 2},
          {"magnet.residual", 0.02},
          {"magnet.saturation_field", 0.5},
          {"magnet.heat_capacity", 0.5},
          {"magnet.closing_force", 0.2},
          {"magnet.thermal_resistance", 40}};
}

void by_keys() {
  const auto timed = plain_magnet(by_times());
  expect(timed.hold_force == 1.2 && timed.saturation == 0.6 && timed.residual == 0.02, "pulls");
  expect(close(timed.rise_constant, device::rise_constant(0.003, 0.6)), "rise constant");
  expect(timed.pulse_frequency == 437 && timed.pulse_duty == 0.8, "pulses");
  expect(timed.closing_flux == 0 && timed.heat_capacity == 0, "no lift, no temperature");
  const auto made = plain_magnet(by_construction());
  const device::CoilConstruction<double> coil{300, 6e-6, 6e-5, 1e-4, 0.016, 3, 2, 0.5};
  expect(made.hold_force == coil.pull() && made.saturation == coil.saturation(), "pull of a coil");
  expect(made.saturation < 1, "it saturates");
  expect(close(made.rise_constant, coil.inductance() / coil.resistance()), "L/R while it is on");
  expect(close(made.fall_constant, coil.inductance() / (coil.resistance() + 2)), "and off");
  expect(made.winding_resistance == coil.resistance() && made.outer_resistance == 2, "resistances");
  expect(close(made.power, 9 / coil.resistance()), "power");
  expect(made.thermal_resistance == 40 && made.heat_capacity == 0.5, "temperature");
  expect(close(made.open_inductance, 0.6), "inductance with the open gap");
  expect(close(device::Electromagnet<double>(made).pull(made.closing_flux), 0.2),
         "the gap closes where the pull is its force");
  expect(made.pulse_frequency == 0 && made.pulse_duty == 1, "no pulses");
}

template <class T>
auto numbers_of(const device::MagnetParameters<T>& m) {
  return std::array<T, 14>{m.hold_force,      m.residual,           m.saturation,
                           m.rise_constant,   m.fall_constant,      m.closing_flux,
                           m.open_inductance, m.pulse_frequency,    m.pulse_duty,
                           m.power,           m.winding_resistance, m.outer_resistance,
                           m.heat_capacity,   m.thermal_resistance};
}

void derivatives() {
  for (const Keys& keys : {by_times(), by_construction()})
    for (const auto& [name, size] : keys) {
      const auto exact = numbers_of(magnet_of(keys, [&of = name](const std::string& key, double v) {
        return Dual(v, key == of ? v : 0);
      }));
      const auto moved = [&, &of = name](double step) {
        return numbers_of(magnet_of(keys, [&](const std::string& key, double v) {
          return key == of ? v * (1 + step) : v;
        }));
      };
      const double h = 1e-6;
      const auto more = moved(h), less = moved(-h);
      double moves = 0, worst = 0;
      for (std::size_t i = 0; i < exact.size(); ++i) {
        const double slope = (more[i] - less[i]) / (2 * h);
        moves = std::max(moves, std::abs(exact[i].slope));
        worst = std::max(worst, std::abs(exact[i].slope - slope) / std::abs(exact[i].value));
      }
      expect(moves > 0 && worst < 1e-8, "derivatives are those of differences");
    }
}

}  // namespace

int main() {
  a_coil();
  times_of_a_pull();
  by_keys();
  derivatives();
  return check::status();
}
