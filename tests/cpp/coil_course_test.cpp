// Course of a coil under switchings: its pieces are those of a coil that is stepped, wherever it is cut.
#include "pindrive/device/coil_course.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

constexpr std::size_t unlimited = 1U << 20;

double pull(const device::CoilCourse& course, double t) {
  const auto later = [](double time, const device::PullPiece& piece) { return time < piece.begin; };
  const auto after = std::upper_bound(course.pulls.begin(), course.pulls.end(), t, later);
  return (after == course.pulls.begin() ? *after : *(after - 1)).at(t);
}

device::MagnetParameters parameters() {
  device::MagnetParameters given{2.0, 0.05, 1.0, 1e-3, 3e-3};
  given.pulse_frequency = 400;
  given.pulse_duty = 0.6;
  return given;
}

void equal_to_steps() {
  const device::Electromagnet magnet(parameters());
  const double switchings[]{0.0031, 0.0094, 0.02, 0.0333};
  device::CoilCourse course;
  course.follow(magnet, {0, 0}, switchings, 4, 0, 0.05, unlimited);
  device::Coil coil(magnet, 0);
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
  const device::Electromagnet magnet(parameters());
  const double switchings[]{0.0031, 0.0094, 0.02, 0.0333};
  device::CoilCourse whole, first, second;
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
  const device::Electromagnet magnet(parameters());
  const double switchings[]{0, 1.0 / 400};
  device::CoilCourse course;
  course.follow(magnet, {0, 0}, switchings, 2, 0, 0.01, unlimited);
  expect(course.pieces.size() == 2 && course.pieces[1].begin == 0.6 / 400,
         "a command to switch off comes before the pulse that begins then");
}

void limits() {
  const device::Electromagnet magnet(parameters());
  const double on = 0;
  device::CoilCourse course;
  course.follow(magnet, {0, 0}, &on, 1, 0, 1e6, 1000);
  expect(course.pieces.size() > 1000 && course.pieces.size() < 1100,
         "it ends just above its limit");
  course.follow(magnet, {0, 0}, nullptr, 0, 0, 1, unlimited);
  expect(course.idle() && course.pulls.front().at(0.5) == 0.05, "without a command it is idle");
  device::CoilState running{-1, 1};
  running.on = true;
  course.follow(magnet, running, nullptr, 0, 0, 0.01, unlimited);
  expect(!course.pieces.back().on && course.pieces.back().begin == 0,
         "a coil that is on without a command is switched off at the begin");
  device::CoilState late{5, 0};
  course.follow(magnet, late, &on, 1, 0, 0.01, unlimited);
  expect(course.pieces.front().begin == 0 && course.pieces.front().on, "a change of another clock");
}

}  // namespace

int main() {
  equal_to_steps();
  cuts();
  a_command_at_the_begin_of_a_pulse();
  limits();
  return check::status();
}
