// An instant of a motion, at the release and on the way, has the values and derivatives of the event loop on
// dual numbers.
#include "pindrive/motion/instant.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "cases.hpp"
#include "check.hpp"
#include "driven_case.hpp"
#include "pindrive/events/stepper.hpp"
#include "pindrive/motion/skin_along.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

using namespace driven;
using Dual = pd::Dual<double>;

/// Requested values of an instant, in the order of an Instant's functions, but for the skin of a rigid finger.
std::array<Dual, 7> numbers_of(const pd::Instant<Dual>& now, bool rigid) {
  return {now.position(),
          now.velocity(),
          now.acceleration(),
          now.friction().plate,
          now.friction().finger,
          rigid ? Dual(0) : now.stretch(),
          rigid ? Dual(0) : now.stretch_rate()};
}
std::array<Dual, 7> numbers_of(const pd::Stepper<Dual>& stepper) {
  const auto& given = stepper.drive();
  const auto& segment = stepper.segment();
  const auto lines = stepper.lines();
  const Dual tau = stepper.tau();
  return pd::visit_trajectory(given, segment, lines, [&](const auto& t) -> std::array<Dual, 7> {
    const auto friction = pd::friction_along(t, given, segment, [&] { return lines; }, tau);
    const bool rigid = given.finger.rigid();
    const Dual skin = rigid ? Dual(1) : given.finger.stiffness;
    return {given.stops.within(t.at(t.position(), tau)),
            t.at(t.velocity(), tau),
            t.at(t.acceleration(), tau),
            friction.plate,
            friction.finger,
            rigid ? Dual(0) : -t.at(pd::detail::stretch_force_along(given, segment, t), tau) / skin,
            rigid ? Dual(0) : t.at(pd::detail::stretch_rate_along(given, segment, t), tau)};
  });
}

struct Instants {
  double worst{0}, damped{0};
  int held{0}, by_both{0}, at_stop{0}, oblique{0}, departure_acceleration{0}, lagging{0}, slow{0};

  void compare(const pd::Instant<Dual>& now, const pd::Stepper<Dual>& known) {
    if (known.segment().eliminated !=
        pd::EliminatedPart::
            none) {  // its derivatives are those of the motion without its fast part
      ++slow;
      return;
    }
    const bool rigid = known.drive().finger.rigid();
    const auto one = numbers_of(now, rigid), other = numbers_of(known);
    const pd::Mode mode = known.mode();
    const auto lines = known.lines();
    const bool across = pd::is_slip(mode.plate) && lines.oblique();
    held += mode.stuck();
    by_both += mode.both_stuck();
    at_stop += pd::in_contact(mode.stop);
    oblique += across;
    departure_acceleration +=
        across && lines.across_velocity.value == 0 && one[1] == lines.plate_velocity.value;
    lagging += pd::detail::SeriesMode<Dual>(known.drive(), mode, lines).has_slider_state();
    for (std::size_t i = 0; i < one.size(); ++i) {
      const double value = std::abs(one[i].value - other[i].value);
      const double slope = std::abs(one[i].slope - other[i].slope);
      double& most = known.drive().finger.damped() ? damped : worst;
      most = std::max({most, value / (1 + std::abs(other[i].value)),
                       slope / (1 + std::abs(other[i].slope) + std::abs(other[2].slope))});
    }
  }
};

constexpr double curve_speeds[]{0, 0.05, 0.3};

/// A drive of dual numbers, which changes along random slopes, or does not change.
struct Changing {
  std::vector<pd::Branch<Dual>> plate_curve, finger_curve;
  pd::Drive<Dual> drive;

  Changing(const pd::Drive<double>& at, Random* random) {
    const auto number = [&](double value) {
      const bool fixed = !random || !(value < infinity) || value == 0;
      return Dual(value, fixed ? 0 : between(*random, -1, 1) * value);
    };
    const auto contact = [&](const pd::Contact<double>& of, std::vector<pd::Branch<Dual>>& curve) {
      pd::Contact<Dual> made{number(of.kinetic), number(of.static_limit), number(of.stiffness)};
      made.damping = number(of.damping);
      if (of.branches == 0) return made;
      Dual speeds[3], forces[3];
      for (int i = 0; i < 3; ++i) {
        speeds[i] = curve_speeds[i];
        forces[i] = number(of.branch(of.branch_of(curve_speeds[i])).at(curve_speeds[i]));
      }
      curve.resize(5);
      made.branches = pd::branches_of(speeds, forces, 3, curve.data());
      made.curve = curve.data();
      made.kinetic = forces[0];
      return made;
    };
    drive = {number(at.mass), number(at.stiffness), number(at.damping),
             contact(at.plate, plate_curve), contact(at.finger, finger_curve)};
    drive.stops = {at.stops.travel, number(at.stops.stiffness), number(at.stops.damping)};
  }
  Changing(const Changing&) = delete;
  Changing& operator=(const Changing&) = delete;
};

/// Inputs whose values and rates change along random slopes; none of the finger's load where that may not.
pd::InputCurves<Dual> changing(const pd::InputCurves<double>& inputs, bool touch, Random& random) {
  const auto line = [&](const pd::Curve<double>& l, bool changes = true) {
    const double value = changes ? between(random, -1, 1) : 0;
    return pd::Line<Dual>{{l.value, value}, {l.rate, changes ? between(random, -1, 1) : 0}};
  };
  return {line(inputs.plate_velocity), line(inputs.plate_load), line(inputs.across_velocity),
          line(inputs.force), line(inputs.finger_load, touch)};
}
template <class T>
pd::Inputs<T> started(const pd::InputCurves<T>& l, T x, T v) {
  const auto held = [](const pd::Curve<T>& input) { return pd::Held<T>(T(0), input.line()); };
  return {held(l.plate_velocity),
          x,
          v,
          T(infinity),
          held(l.plate_load),
          std::numeric_limits<T>::quiet_NaN(),
          held(l.force),
          held(l.across_velocity),
          held(l.finger_load)};
}

/// At the release and on the way an instant has the derivatives of the event loop on dual numbers.
void at_an_instant() {
  Random random(29);
  Instants instants;
  for (int i = 0; i < cases(2000); ++i) {
    Case c(random);
    std::vector<pd::Branch<double>> curve(5);
    pd::Contact<double>& finger = c.drive.finger;
    if (one_of(random, 3)) {
      const double f = finger.static_limit = finger.kinetic;
      const double rows[]{f, f * between(random, 0.5, 1.5), f * between(random, 1, 2)};
      finger.branches = pd::branches_of(curve_speeds, rows, 3, curve.data());
      finger.curve = curve.data();
    }
    pd::InputCurves<double> inputs = c.from(0);
    const bool touch = finger.rigid() && finger.branches == 0;
    if (!touch) inputs.finger_load = {1, 0};
    if (one_of(random, 8)) inputs.across_velocity.value = 0;
    if (one_of(random, 8)) inputs.plate_velocity = {0, 0};
    const double plate = inputs.plate_velocity.value,
                 nan = std::numeric_limits<double>::quiet_NaN();
    const double v = one_of(random, 2) ? plate : between(random, -0.3, 0.3);
    if (plate == 0 && v == 0) c.displacement *= 0.01;
    pd::Stepper<double> stepper(c.drive, started(inputs, c.displacement, v));
    if (stepper.status() != pd::Status::ok) continue;

    const Changing moving(c.drive, &random), still(c.drive, nullptr);
    pd::InputCurves<Dual> first = changing(inputs, touch, random);
    if (plate == 0) first.plate_velocity.value = 0;  // else it is no rest to the finger
    const Dual x(c.displacement, between(random, -1e-3, 1e-3));
    const Dual u = v == plate ? first.plate_velocity.value : Dual(v, between(random, -1, 1));
    const pd::Stepper<Dual> begun(moving.drive, started(first, x, u));
    instants.compare(
        {moving.drive, begun.mode(), first,
         pd::released(moving.drive, begun.mode(), first, x, u, Dual(nan), stepper.pin())},
        begun);

    const auto fixed = [](const pd::Curve<double>& l) { return pd::Line<Dual>{l.value, l.rate}; };
    pd::Stepper<Dual> later(still.drive,
                            started<Dual>({fixed(inputs.plate_velocity), fixed(inputs.plate_load),
                                           fixed(inputs.across_velocity), fixed(inputs.force),
                                           fixed(inputs.finger_load)},
                                          c.displacement, v));
    const double time = between(random, 0, 0.1);
    if (!stepper.step(time) || !later.step(time)) continue;
    const pd::InputCurves<double> now = stepper.lines().from(stepper.tau());
    const pd::InputCurves<Dual> next = changing(now, touch, random);
    later.set(next);
    // Where a stop takes over from a contact the event loop goes on in another mode; and it has no derivative
    // along a load of 0.
    const pd::Mode one = stepper.mode(), other = later.mode();
    const bool same = one.plate == other.plate && one.finger == other.finger &&
                      one.plate_branch == other.plate_branch &&
                      one.finger_branch == other.finger_branch && one.stop == other.stop;
    if (!same || now.plate_load.value == 0) continue;
    const pd::detail::State<double> pin = stepper.pin();
    const Dual moves(pin.v, next.plate_velocity.value.slope);
    instants.compare({still.drive, one, next, pd::changed(still.drive, one, next, moves, pin)},
                     later);
  }
  std::printf(
      "# instants within %.1e: %d held, %d by both, %d at a stop, %d across, %d of them from the "
      "plate's velocity, %d with a slider that lags; %d without their fast part left out\n",
      instants.worst, instants.held, instants.by_both, instants.at_stop, instants.oblique,
      instants.departure_acceleration, instants.lagging, instants.slow);
  expect(instants.worst < 1e-12, "an instant has the derivatives of the event loop");
  expect(instants.damped < 1e-11, "... to the rounding of the damper on damped skin");
  expect(std::min({instants.held, instants.by_both, instants.at_stop, instants.oblique,
                   instants.departure_acceleration, instants.lagging}) > cases(20),
         "in every kind of mode");
}

}  // namespace

int main() {
  at_an_instant();
  return check::status();
}
