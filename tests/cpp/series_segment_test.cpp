// A segment that is a step of a series: a pin on a plate whose load grows while its friction changes with speed,
// beside the same equation integrated by Runge and Kutta's method in short steps.
#include "pindrive/events/series_segment.hpp"

#include <array>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;
using pd::detail::ActiveGuard;
using ContactPoint = pd::detail::ContactPoint<double>;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const pd::Branch<double> curve[] = {{0, 0.05, 0.03, -0.2, 0}, {0.05, inf, 0.02, 0.1, 0}};

/// A pin that slides at 0.08 m/s over a plate at rest whose load grows by half in 10 ms; it gets slower.
struct Slide {
  pd::Drive<double> drive{0.01, 100, 0.4, {0.03, 0.04}, {}};
  pd::detail::Guards<double> guards;
  pd::detail::SeriesSegment<double> series;
  pd::Segment<double> segment{};
  pd::detail::State<double> state{1e-4, 0.08};
  double acceleration{};

  explicit Slide(double span) {
    drive.plate.curve = curve;
    drive.plate.branches = 2;
    ContactPoint plate(drive.plate), finger(drive.finger);
    plate.load = {1, 50};
    plate.mode = pd::detail::ContactMode<double>::slip(1, ActiveGuard::none, 1);
    plate.start.friction = plate.branch().at(state.v);
    finger.mode = {};
    acceleration = rate({state.x, state.v}, 0)[1];
    segment.mode = {plate.mode.state, finger.mode.state, 1, 0};
    segment.begin = 2;
    series.begin(segment, guards, drive, plate, finger, {}, state, acceleration, 0, false, span);
    finger_ = finger;
  }
  void move(double tau) { series.move(state, drive, finger_, tau); }

  using Pin = std::array<double, 2>;
  Pin rate(const Pin& pin, double t) const {
    const double friction = (1 + 50 * t) * curve[1].at(pin[1]);
    return {pin[1], (-drive.damping * pin[1] - drive.stiffness * pin[0] - friction) / drive.mass};
  }
  Pin after(double tau) const {
    constexpr int steps = 2000;
    const double h = tau / steps;
    Pin pin{1e-4, 0.08};
    for (int i = 0; i < steps; ++i) {
      const auto along = [&](const Pin& k, double part) {
        return rate({pin[0] + part * h * k[0], pin[1] + part * h * k[1]}, (i + part) * h);
      };
      const Pin a = along({}, 0), b = along(a, 0.5), c = along(b, 0.5), d = along(c, 1);
      for (int n = 0; n < 2; ++n) pin[n] += h / 6 * (a[n] + 2 * b[n] + 2 * c[n] + d[n]);
    }
    return pin;
  }

 private:
  ContactPoint finger_{pd::Contact<double>{}};
};

void follows() {
  Slide slide(2e-3);
  expect(slide.series.used() && slide.segment.flow.position.start == 1e-4 &&
             slide.segment.flow.velocity.start == 0.08 &&
             slide.segment.flow.velocity.drift == slide.acceleration,
         "a segment says how it begins, with its acceleration");
  expect(
      near(slide.segment.plate_force.start, -0.023, 1e-15) && slide.segment.finger_force.start == 0,
      "... and the friction there");
  const auto expected = slide.after(1.5e-3);
  slide.move(1.5e-3);
  expect(near(slide.state.x / expected[0], 1, 1e-12) && near(slide.state.v / expected[1], 1, 1e-12),
         "it moves as its differential equation says");
  expect(slide.state.position_scale == slide.state.x, "... and the largest position is known");
}

void ends() {
  Slide slide(0.1);
  const double first = slide.series.earliest(2, 0.1);
  expect(slide.guards.end() - slide.guards.begin() == 1 &&
             slide.guards.begin()->bound == ActiveGuard::lower && slide.guards.begin()->plate &&
             slide.guards.begin()->zero == first,
         "what ends it is its speed, that comes to a breakpoint");
  expect(near(slide.after(first)[1], 0.05, 1e-12), "... at the time at which it does");
  const double soon = first * (1 + 1e-15);
  expect(slide.series.earliest(2, soon) == soon && slide.series.earliest(2, first / 2) == first / 2,
         "an event at a row to rounding happens at the row, as does what would come later");
  slide.series.reset();
  const auto before = slide.state;
  slide.move(1e-3);
  expect(!slide.series.used() && slide.state.x == before.x, "without a series nothing moves");
}

}  // namespace

int main() {
  follows();
  ends();
  return check::status();
}
