// Pieces of the flux of a coil against its differential equation, and pieces of the pull against the flux.
#include "pindrive/device/electromagnet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

device::MagnetParameters<double> parameters(double saturation = 0.8) {
  device::MagnetParameters<double> given{2.0, 0.05, saturation, 1e-3, 3e-3};
  given.winding_resistance = 10;
  given.outer_resistance = 20;
  given.power = 1;
  given.thermal_resistance = 100;
  return given;
}

/// Flux linkage and warming by small steps of Heun's method, the gap closed.
struct Integrated {
  double flux, warming;
};
Integrated integrated(const device::MagnetParameters<double>& given, double flux, double warming,
                      bool on, double level, double lasts) {
  constexpr int steps = 200000;
  const auto slopes = [&](Integrated now) {
    const double r = given.heat_capacity > 0 ? 1 + 3.93e-3 * now.warming : 1;
    const double whole = given.winding_resistance + given.outer_resistance;
    const double rate = on ? (level - r * now.flux) / given.rise_constant
                           : -now.flux * (r * given.winding_resistance + given.outer_resistance) /
                                 whole / given.fall_constant;
    if (given.heat_capacity == 0) return Integrated{rate, 0};
    const double heat = given.power * r * now.flux * now.flux;
    return Integrated{rate, (heat - now.warming / given.thermal_resistance) / given.heat_capacity};
  };
  const double h = lasts / steps;
  Integrated now{flux, warming};
  for (int i = 0; i < steps; ++i) {
    const Integrated one = slopes(now);
    const Integrated two = slopes({now.flux + h * one.flux, now.warming + h * one.warming});
    now.flux += 0.5 * h * (one.flux + two.flux);
    now.warming += 0.5 * h * (one.warming + two.warming);
  }
  return now;
}

void pieces() {
  const device::Electromagnet<double> magnet(parameters());
  for (const bool on : {true, false})
    for (const double start : {0.0, 0.3, 1.0})
      for (const double level : {1.0, 0.4}) {
        const auto piece = magnet.piece(0, start, 0, on, level);
        const double found = piece.flux_after(2e-3);
        const double exact = integrated(parameters(), start, 0, on, level, 2e-3).flux;
        expect(std::abs(found - exact) < 1e-9, "the flux is that of its equation");
      }
  expect(magnet.piece(0, 0, 0, true, 1).flux_after(1) == 1, "the full flux is reached exactly");
  expect(magnet.pull(1) == 2 && magnet.pull(0.8) == 2 && magnet.pull(0) == 0.05,
         "the pull saturates, and a residual pull stays");
  expect(std::abs(magnet.pull(0.4) - (0.05 + 1.95 / 4)) < 1e-15, "it grows with the square");
}

void temperature() {
  device::MagnetParameters<double> given = parameters(1);
  given.heat_capacity = 0.02;
  const device::Electromagnet<double> magnet(given);
  // Piece by piece, as long as each lasts.
  double flux = 1, warming = 0, time = 0;
  int count = 0;
  while (time < 0.5) {
    const auto piece = magnet.piece(time, flux, warming, true, 1);
    const double lasts = std::min(magnet.heating_after(piece), 0.5 - time);
    flux = piece.flux_after(lasts);
    warming = magnet.warming_after(piece, lasts);
    time += lasts;
    ++count;
  }
  const Integrated exact = integrated(given, 1, 0, true, 1, 0.5);
  expect(count > 50 && exact.warming > 15, "it warms by many kelvin");
  expect(std::abs(flux / exact.flux - 1) < 3e-4, "the flux follows the warming resistance");
  expect(std::abs(warming / exact.warming - 1) < 1e-4, "so does the temperature");
  expect(magnet.heating_after(magnet.piece(0, 1, 20, false, 1)) == infinity,
         "a coil that is off is one piece");
  given.heat_capacity = 0;
  const device::Electromagnet<double> cold(given);
  expect(cold.warming_after(cold.piece(0, 1, 0, true, 1), 1) == 0, "without a capacity it is cold");
}

void gap() {
  device::MagnetParameters<double> given = parameters();
  given.closing_flux = 0.3;
  given.open_inductance = 0.5;
  const device::Electromagnet<double> magnet(given);
  const auto open = magnet.piece(0, 0, 0, true, 1);
  expect(open.inductance == 0.5 && open.target == 0.5 && open.constant == 0.5e-3,
         "an open gap halves inductance, flux and time constant");
  const double closes = magnet.closing_after(open);
  expect(std::abs(open.flux_after(closes) - 0.3) < 1e-15, "it closes at its flux");
  const auto closed = magnet.piece(closes, 0.3, 0, true, 1);
  expect(closed.inductance == 1 && magnet.closing_after(closed) == infinity, "and stays closed");
  const auto falling = magnet.piece(0, 0.3, 0, false, 1);
  expect(falling.inductance == 0.5, "a falling flux at that of the closing has the gap open");
}

void pulls() {
  double worst = 0;
  int saturating = 0;
  for (const double saturation : {1.0, 0.8, 0.3})
    for (const double target : {1.0, 0.6, 0.3, 0.25})
      for (const double start : {0.0, 0.3, 0.5, 0.8, 1.0})
        for (const bool on : {true, false}) {
          const device::Electromagnet<double> magnet(parameters(saturation));
          const auto piece = magnet.piece(0.1, start, 0, on, target);
          const double edge = magnet.saturating_after(piece);
          saturating += edge < infinity;
          for (int k = 0; k <= 400; ++k) {
            const double t = k * 5e-5;
            const auto pull = magnet.pull_piece(piece, t > edge);
            worst = std::max(worst,
                             std::abs(magnet.pull(piece.flux_after(t)) - pull.at(piece.begin + t)));
          }
        }
  expect(worst < 1e-13, "a constant and two exponentials are the pull of the flux");
  expect(saturating > 20, "before and after the iron saturates");
  const device::Electromagnet<double> magnet(parameters());
  const auto full = magnet.pull_piece(magnet.piece(0, 1, 0, true, 1), false);
  expect(full.constant == 2 && full.once == 0 && full.twice == 0, "a saturated pull is constant");
}

}  // namespace

int main() {
  pieces();
  temperature();
  gap();
  pulls();
  return check::status();
}
