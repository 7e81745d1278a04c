// Course of a coil under switchings: its pieces are those of a coil that is stepped, wherever it is cut.
#include "pindrive/device/coil_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "pindrive/numbers/dual.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

constexpr std::size_t unlimited = 1U << 20;

template <class T>
T pull(const device::CoilCourse<T>& course, T t) {
  const auto later = [](T time, const device::PullPiece<T>& piece) { return time < piece.begin; };
  const auto after = std::upper_bound(course.pulls.begin(), course.pulls.end(), t, later);
  return (after == course.pulls.begin() ? *after : *(after - 1)).at(t);
}

device::MagnetParameters<double> parameters() {
  device::MagnetParameters<double> given{2.0, 0.05, 1.0, 1e-3, 3e-3};
  given.pulse_frequency = 400;
  given.pulse_duty = 0.6;
  return given;
}

void equal_to_steps() {
  const device::Electromagnet<double> magnet(parameters());
  const double switchings[]{0.0031, 0.0094, 0.02, 0.0333};
  device::CoilCourse<double> course;
  course.follow(magnet, {0, 0}, switchings, 4, 0, 0.05, unlimited);
  device::Coil<double> coil(magnet, 0);
  double worst = 0;
  std::size_t next = 0;
  for (int i = 1; i < 1000; ++i) {
    const double time = i * 5e-5;
    while (next < 4 && switchings[next] <= time) {
      coil.pass(std::nextafter(switchings[next], 0.0));
      coil.command(!coil.state().command, switchings[next++]);
    }
    coil.pass(time);
    worst = std::max(worst, std::abs(coil.pull(time) - pull(course, time)));
  }
  expect(worst < 1e-13, "the pieces are those of a coil that is stepped");
  const auto earlier = [](const auto& one, const auto& other) { return one.begin < other.begin; };
  expect(std::is_sorted(course.pulls.begin(), course.pulls.end(), earlier), "and in order");
  expect(course.end.since == coil.state().since && course.end.flux == coil.state().flux,
         "and so is the state at the end");
  expect(!course.idle(), "a coil that was on is not idle");
}

void cuts() {
  const device::Electromagnet<double> magnet(parameters());
  const double switchings[]{0.0031, 0.0094, 0.02, 0.0333};
  device::CoilCourse<double> whole, first, second;
  whole.follow(magnet, {0, 0}, switchings, 4, 0, 0.05, unlimited);
  int differing = 0;
  for (int i = 1; i < 50; ++i) {
    const double cut = i * 1.001e-3;
    const auto before =
        static_cast<std::size_t>(std::lower_bound(switchings, switchings + 4, cut) - switchings);
    first.follow(magnet, {0, 0}, switchings, before, 0, cut, unlimited);
    second.follow(magnet, first.end, switchings + before, 4 - before, cut, 0.05, unlimited);
    for (int k = 0; k < 200; ++k) {
      const double t = cut + (0.05 - cut) * k / 200;
      differing += std::abs(pull(whole, t) - pull(second, t)) > 1e-15;
    }
  }
  expect(differing == 0, "a course that is cut keeps its pull");
}

void a_command_at_the_begin_of_a_pulse() {
  const device::Electromagnet<double> magnet(parameters());
  const double switchings[]{0, 1.0 / 400};
  device::CoilCourse<double> course;
  course.follow(magnet, {0, 0}, switchings, 2, 0, 0.01, unlimited);
  expect(course.pieces.size() == 2 && course.pieces[1].begin == 0.6 / 400,
         "a command to switch off comes before the pulse that begins then");
}

void limits() {
  const device::Electromagnet<double> magnet(parameters());
  const double on = 0;
  device::CoilCourse<double> course;
  course.follow(magnet, {0, 0}, &on, 1, 0, 1e6, 1000);
  expect(course.pieces.size() > 1000 && course.pieces.size() < 1100,
         "it ends just above its limit");
  course.follow(magnet, {0, 0}, nullptr, 0, 0, 1, unlimited);
  expect(course.idle() && course.pulls.front().at(0.5) == 0.05, "without a command it is idle");
  device::CoilState<double> running{-1, 1};
  running.on = true;
  course.follow(magnet, running, nullptr, 0, 0, 0.01, unlimited);
  expect(!course.pieces.back().on && course.pieces.back().begin == 0,
         "a coil that is on without a command is switched off at the begin");
  device::CoilState<double> late{5, 0};
  course.follow(magnet, late, &on, 1, 0, 0.01, unlimited);
  expect(course.pieces.front().begin == 0 && course.pieces.front().on, "a change of another clock");
}

/// The numbers of a magnet, in order.
template <class T>
std::array<T, 14> numbers_of(const device::MagnetParameters<T>& magnet) {
  const auto& [hold_force, residual, saturation, rise, fall, flux, inductance, frequency, duty,
               winding, outer, power, cooling, capacity] = magnet;
  return {hold_force, residual, saturation, rise,  fall,  flux,    inductance,
          frequency,  duty,     winding,    outer, power, cooling, capacity};
}
template <class T>
device::MagnetParameters<T> magnet_of(const std::array<T, 14>& n) {
  return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10], n[11], n[12], n[13]};
}

/// Derivatives by each parameter and by a delay of all switchings, beside differences: with pulses, with a gap that
/// closes, and with a coil that heats.
void derivatives() {
  using Dual = pindrive::Dual<double>;
  device::MagnetParameters<double> pulsed = parameters(), closing{2.0, 0.05, 0.7, 1e-3, 3e-3},
                                   hot = closing;
  closing.closing_flux = 0.4;
  closing.open_inductance = 0.5;
  hot.winding_resistance = 5;
  hot.outer_resistance = 10;
  hot.power = 2;
  hot.thermal_resistance = 40;
  hot.heat_capacity = 0.5;
  const double switchings[]{0.0031, 0.0094, 0.0203, 0.0333};
  double worst = 0, most = 0;
  for (const auto& magnet : {pulsed, closing, hot}) {
    const auto given = numbers_of(magnet);
    const std::size_t count = given.size();
    const auto course_of = [&](auto along, double step) {
      using T = decltype(along(0));
      std::array<T, 14> moved;
      for (std::size_t i = 0; i < count; ++i) moved[i] = given[i] + step * along(i);
      std::vector<T> times;
      for (const double t : switchings) times.push_back(t + step * along(count));
      device::CoilCourse<T> course;
      course.follow(device::Electromagnet<T>(magnet_of(moved)), {}, times.data(), times.size(),
                    T(0), T(0.05), unlimited);
      return course;
    };
    for (std::size_t of = 0; of <= count; ++of) {
      const double size = of == count ? 1e-3 : given[of];
      if (size == 0) continue;
      const auto along = [&](std::size_t i) { return i == of ? size : 0.0; };
      const auto exact = course_of([&](std::size_t i) { return Dual(0, along(i)); }, 1);
      const double h = 1e-6;
      const auto more = course_of(along, h), less = course_of(along, -h);
      for (int i = 1; i < 500; ++i) {
        const double t = i * 1e-4 + 3.7e-6;
        const double slope = pull(exact, Dual(t)).slope;
        worst = std::max(worst, std::abs(slope - (pull(more, t) - pull(less, t)) / (2 * h)));
        most = std::max(most, std::abs(slope));
      }
    }
  }
  expect(most > 1 && worst < 1e-6 * most, "derivatives are those of differences");
}

}  // namespace

int main() {
  equal_to_steps();
  cuts();
  a_command_at_the_begin_of_a_pulse();
  limits();
  derivatives();
  return check::status();
}
