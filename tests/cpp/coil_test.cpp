// Coil under commands: pulses, voltage steps, the gap, the order of changes, and states that are kept.
#include "pindrive/device/coil.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

device::MagnetParameters<double> parameters() { return {2.0, 0.05, 1.0, 1e-3, 3e-3}; }

/// Changes of the voltage until a time: when, and whether the coil is on then.
struct Change {
  double time;
  bool on;
  double level;
};
std::vector<Change> changes(device::Coil<double> coil, double until) {
  std::vector<Change> found;
  while (coil.next() <= until) {
    const device::CoilState<double> before = coil.state();
    coil.pass(coil.next());
    const device::CoilState<double>& now = coil.state();
    if (now.on != before.on || now.level != before.level)
      found.push_back({now.since, now.on, now.level});
  }
  return found;
}

void a_continuous_voltage() {
  const device::Electromagnet<double> magnet(parameters());
  device::Coil<double> coil(magnet, 0);
  expect(coil.pull(1) == 0.05 && std::isinf(coil.next()), "off, it pulls by the residual pull");
  coil.command(true, 0.01);
  expect(coil.state().on && coil.state().since == 0.01, "a command switches it on");
  coil.command(true, 0.011);
  expect(coil.state().since == 0.01, "a command in force changes nothing");
  coil.pass(0.012);
  expect(std::abs(coil.flux(0.012) - (1 - std::exp(-2.0))) < 1e-15, "the flux rises");
  expect(std::abs(coil.pull(0.012) - magnet.pull(coil.flux(0.012))) < 1e-15,
         "and so does the pull");
  const double before = coil.pull(0.012);
  coil.command(false, 0.012);
  expect(std::abs(coil.pull(0.012) - before) < 1e-15, "the pull has no step");
  coil.pass(0.02);
  expect(coil.pull(0.02) < 0.3 * before, "and falls");
}

void pulses() {
  device::MagnetParameters<double> given = parameters();
  given.pulse_frequency = 400;
  given.pulse_duty = 0.6;
  const device::Electromagnet<double> magnet(given);
  device::Coil<double> coil(magnet, 0);
  coil.command(true, 0.001);  // in the first pulse, which ends at 1.5 ms
  expect(coil.state().on, "a command within a pulse switches on at once");
  const auto found = changes(coil, 0.00551);
  expect(found.size() == 4 && found[0].time == 0.6 / 400 && !found[0].on, "the pulse ends");
  expect(found[1].time == 1.0 / 400 && found[1].on && found[3].time == 2.0 / 400, "the next begin");
  device::Coil<double> between(magnet, 0);
  between.command(true, 0.002);
  expect(!between.state().on && between.state().command, "a command between pulses waits");
  expect(changes(between, 0.0026).front().time == 1.0 / 400, "for the next one");
  // Whatever the rounding of a multiple of the period, it is the begin of its pulse.
  given.pulse_frequency = 1 / 0.0003;
  const device::Electromagnet<double> odd(given);
  int wrong = 0;
  for (int k = 1; k < 2000; ++k) {
    device::Coil<double> at_begin(odd, 0);
    at_begin.command(true, k / given.pulse_frequency);
    wrong += !at_begin.state().on;
    const auto ends = changes(at_begin, (k + 0.7) / given.pulse_frequency);
    const bool one = ends.size() == 1;
    wrong += !one || ends[0].time != (k + 0.6) / given.pulse_frequency;
  }
  expect(wrong == 0, "a command at the begin of a pulse lasts as long as the pulse");
}

void voltage_steps() {
  const device::Electromagnet<double> magnet(parameters(), {{0, 1}, {0.004, 0.5}, {0.01, 0.25}});
  device::Coil<double> coil(magnet, 0);
  coil.command(true, 0.001);
  const auto found = changes(coil, 1);
  expect(found.size() == 2 && found[0].time == 0.005 && found[0].level == 0.5, "the second step");
  expect(found[1].time == 0.011 && found[1].level == 0.25, "and the third, since the command");
}

void the_gap() {
  device::MagnetParameters<double> given = parameters();
  given.closing_flux = 0.3;
  given.open_inductance = 0.5;
  const device::Electromagnet<double> magnet(given);
  device::Coil<double> coil(magnet, 0);
  coil.command(true, 0);
  const double closes = 0.5e-3 * std::log(0.5 / 0.2);
  coil.pass(closes * (1 + 1e-12));
  expect(std::abs(coil.state().since - closes) < 1e-15 && coil.state().flux == 0.3,
         "it closes at its flux, to the bit");
  expect(coil.piece().inductance == 1, "and is closed from then on");
  expect(std::abs(coil.current(coil.state().since) - 0.3) < 1e-15,
         "where the current has fallen to the flux");
}

void saturation() {
  device::MagnetParameters<double> given = parameters();
  given.saturation = 0.6;
  const device::Electromagnet<double> magnet(given);
  device::Coil<double> coil(magnet, 0);
  coil.command(true, 0);
  const double saturates = 1e-3 * std::log(1 / 0.4);
  expect(std::abs(coil.next() - saturates) < 1e-18,
         "a piece of the pull ends as the iron saturates");
  coil.pass(saturates * (1 + 1e-12));
  expect(coil.pull_piece().constant == 2 && coil.pull(0.01) == 2 && std::isinf(coil.next()),
         "from then on the pull is constant");
  expect(coil.state().since == 0, "though the flux goes on");
  coil.command(false, 0.02);
  coil.pass(0.02);
  expect(coil.pull(0.02) == 2, "switched off it remains saturated for a while");
  expect(std::abs(coil.next() - 0.02 - 3e-3 * std::log(coil.flux(0.02) / 0.6)) < 1e-17,
         "until its flux falls to that");
  const double time = coil.next();
  coil.pass(time);
  expect(std::abs(coil.pull(time) - 2) < 1e-15 && coil.pull(time + 1e-3) < 1.5, "and falls then");
}

void states() {
  device::MagnetParameters<double> given = parameters();
  given.pulse_frequency = 300;
  given.pulse_duty = 0.7;
  given.closing_flux = 0.3;
  given.open_inductance = 0.5;
  given.power = 1;
  given.winding_resistance = 10;
  given.thermal_resistance = 100;
  given.heat_capacity = 1e-3;
  const device::Electromagnet<double> magnet(given);
  device::Coil<double> whole(magnet, 0);
  whole.command(true, 0.0007);
  int differing = 0;
  for (int i = 1; i < 400; ++i) {
    const double time = 0.0007 + i * 1.37e-4;
    whole.pass(time);
    device::Coil<double> again(magnet, whole.state());
    again.pass(time);
    const double later = time + 3.1e-4;
    device::Coil<double> ahead = whole;
    ahead.pass(later);
    again.pass(later);
    differing += ahead.pull(later) != again.pull(later) || ahead.flux(later) != again.flux(later) ||
                 ahead.warming(later) != again.warming(later) || ahead.next() != again.next();
  }
  expect(differing == 0, "a coil in a kept state continues with the same bits");
}

}  // namespace

int main() {
  a_continuous_voltage();
  pulses();
  voltage_steps();
  the_gap();
  saturation();
  states();
  return check::status();
}
