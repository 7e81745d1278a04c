// A pin followed in steps of any length is the pin that one simulation follows: the same modes, events and
// quantities, also from a state that was kept, through changes of the inputs, and in derivatives.
#include "pindrive/stepper.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "cases.hpp"
#include "check.hpp"
#include "pindrive/dual.hpp"
#include "pindrive/simulate.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

using Random = std::mt19937_64;
using Dual = pd::Dual<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
bool one_of(Random& random, int count) { return random() % static_cast<unsigned>(count) == 0; }

struct Case {
  std::vector<pd::Branch<double>> curve{5};
  pd::Drive<double> drive{};
  std::vector<double> times{0}, velocities, loads;
  double displacement, duration;

  explicit Case(Random& random) {
    drive.mass = between(random, 2e-3, 2e-2);
    drive.stiffness = between(random, 20, 400);
    drive.damping = one_of(random, 4) ? 0 : between(random, 0, 1);
    const double plate = between(random, 1e-3, 0.1), finger = between(random, 1e-3, 0.05);
    drive.plate = {plate, plate * (one_of(random, 2) ? 1 : between(random, 1, 2))};
    drive.finger = {finger, finger * (one_of(random, 2) ? 1 : between(random, 1, 2))};
    if (one_of(random, 3)) {
      const double speeds[]{0, 0.05, 0.3}, forces[]{plate, plate * between(random, 0.5, 1), plate};
      drive.plate.branches = pd::branches_of(speeds, forces, 3, curve.data());
      drive.plate.curve = curve.data();
    }
    if (one_of(random, 3)) drive.finger.stiffness = drive.stiffness * between(random, 1, 50);
    for (int i = 0; i < 4; ++i) times.push_back(times.back() + between(random, 0.005, 0.08));
    for (std::size_t i = 0; i < times.size(); ++i) {
      velocities.push_back(i > 1 && one_of(random, 3) ? velocities.back()
                                                      : between(random, -0.3, 0.3));
      loads.push_back(one_of(random, 2) ? 1 : between(random, 0, 2));
    }
    displacement = between(random, -3e-3, 3e-3);
    duration = times.back() + 0.1;
  }
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  pd::Line<double> line(const std::vector<double>& values, double t) const {
    return pd::Profile<double>(times.data(), values.data(), times.size()).from(t);
  }
};

/// A motion in one run.
struct Whole {
  pd::Inputs<double> inputs;
  std::vector<pd::Segment<double>> segments;
  pd::Outcome<double> outcome;

  explicit Whole(const Case& c)
      : inputs{{c.times.data(), c.velocities.data(), c.times.size()},
               c.displacement,
               c.velocities[0],
               c.duration,
               {c.times.data(), c.loads.data(), c.times.size()}},
        outcome(pd::simulate(c.drive, inputs, [&](const auto& s) { segments.push_back(s); })) {}
  pd::Motion<double> view(const Case& c) const {
    return {c.drive, inputs, segments.data(), segments.size(), outcome};
  }
};

struct Values {
  double x, v, plate, finger;
};
Values values_in(const pd::Drive<double>& drive, const pd::Segment<double>& segment,
                 const pd::InputLines<double>& lines, double tau) {
  return pd::visit_trajectory(drive, segment, lines, [&](const auto& t) {
    const auto given = [&] { return lines; };
    const auto friction = pd::friction_along(t, drive, segment, given, tau);
    return Values{t.at(t.position(), tau), t.at(t.velocity(), tau), friction.plate,
                  friction.finger};
  });
}
Values values_of(const pd::Stepper<double>& stepper) {
  return values_in(stepper.drive(), stepper.segment(), stepper.lines(), stepper.tau());
}

pd::Inputs<double, pd::Held<double>> start_of(const Case& c) {
  return {{0, c.line(c.velocities, 0)},
          c.displacement,
          c.velocities[0],
          infinity,
          {0, c.line(c.loads, 0)}};
}

struct Worst {
  double position{0}, velocity{0}, force{0};
  int modes{0}, checked{0}, restored{0}, differing{0};
};

/// Random steps against one run; now and then from a state that was kept, after going astray.
void compare(const Case& c, Random& random, Worst& worst) {
  const Whole whole(c);
  if (whole.outcome.status != pd::Status::ok) return;
  const auto motion = whole.view(c);
  const double size = std::abs(c.displacement) + 0.3 * std::sqrt(c.drive.mass / c.drive.stiffness);
  const double speed = size * std::sqrt(c.drive.stiffness / c.drive.mass);
  auto stepper = std::make_unique<pd::Stepper<double>>(c.drive, start_of(c));
  for (std::size_t row = 1; row <= c.times.size(); ++row) {
    const double end = row < c.times.size() ? c.times[row] : c.duration;
    while (stepper->now() < end) {
      const double t = std::min(end, stepper->now() + between(random, 0, 0.02));
      stepper->step(t, one_of(random, 2));
      if (one_of(random, 5)) {
        const auto kept = stepper->state();
        const Values at = values_of(*stepper);
        stepper->set({0.2, 1}, {0, 0});
        stepper->step(stepper->now() + 0.01);
        auto again = std::make_unique<pd::Stepper<double>>(c.drive, kept);
        stepper.swap(again);
        ++worst.restored;
        const Values back = values_of(*stepper);
        if (back.x != at.x || back.v != at.v || back.plate != at.plate || back.finger != at.finger)
          ++worst.differing;
      }
      const auto [segment, tau] = motion.locate(stepper->now(), pd::Side::left);
      const Values found = values_of(*stepper);
      const Values expected =
          values_in(c.drive, *segment, pd::InputLines<double>::of(whole.inputs, *segment), tau);
      worst.position = std::max(worst.position, std::abs(found.x - expected.x) / size);
      worst.velocity = std::max(worst.velocity, std::abs(found.v - expected.v) / speed);
      ++worst.checked;
      const bool inside = tau > 1e-9 && segment->end - segment->begin - tau > 1e-9;
      if (inside)
        worst.force = std::max({worst.force, std::abs(found.plate - expected.plate),
                                std::abs(found.finger - expected.finger)});
      if (inside && (stepper->mode().plate != segment->mode.plate ||
                     stepper->mode().finger != segment->mode.finger))
        ++worst.modes;
    }
    if (row < c.times.size()) stepper->set(c.line(c.velocities, end), c.line(c.loads, end));
  }
}

void the_same_as_in_one_run() {
  Random random(16);
  Worst worst;
  for (int i = 0; i < cases(2000); ++i) compare(Case(random), random, worst);
  std::printf("%d times, %d from a kept state: position %.1e, velocity %.1e, force %.1e\n",
              worst.checked, worst.restored, worst.position, worst.velocity, worst.force);
  expect(worst.position < 1e-12 && worst.velocity < 1e-12 && worst.force < 1e-12,
         "steps leave no trace in the motion");
  expect(worst.modes == 0, "nor in what the contacts do");
  expect(worst.differing == 0, "a kept state gives the same bits");
}

/// A released pin that comes to rest on the finger.
const pd::Drive<double> drive{0.010, 100, 0.40, {0.020, 0.020}, {0.005, 0.005}};
const pd::Inputs<double, pd::Held<double>> release{
    {0, {0.10, 0}}, 1.5e-3, 0.10, infinity, {0, {1, 0}}};

void events() {
  std::vector<double> expected, found;
  const pd::Inputs<double> inputs{0.10, 1.5e-3, 0.10};
  pd::simulate(drive, inputs, [&](const auto& segment) {
    if (segment.end < infinity) expected.push_back(segment.end);
  });
  pd::Stepper<double> stepper(drive, release);
  while (stepper.next() < infinity) {
    const double next = stepper.next();
    expect(stepper.step(1, true) && stepper.now() == next, "it stops at the next event");
    expect(stepper.event().finger != pd::Transition::none, "... and says which");
    found.push_back(stepper.now());
  }
  expect(found == expected, "those of one run, to the bit");
  expect(stepper.step(1, true) && stepper.now() == 1 && stepper.tau() > 0, "then it goes on");
  expect(stepper.mode().finger == pd::ContactState::stick, "at rest");
  stepper.set({0.10, 0}, {1, 0});
  expect(stepper.tau() > 0, "an input that is set as it is changes nothing");
  stepper.set({0.10 * (1 + 3e-16), 0}, {1, 0});
  expect(stepper.tau() > 0, "nor one that differs by rounding");
}

/// A mouse velocity that jumps is one that gets there ever faster.
void a_jump() {
  const double before = 0.004, after = 0.011;
  pd::Stepper<double> stepper(drive, release);
  stepper.step(before);
  stepper.set({-0.05, 0}, {1, 0});
  stepper.step(after);
  const double x = values_of(stepper).x;
  double last = infinity;
  for (const double ramp : {1e-5, 1e-7, 1e-9}) {
    pd::Stepper<double> ramped(drive, release);
    ramped.step(before);
    ramped.set({0.10, -0.15 / ramp}, {1, 0});
    ramped.step(before + ramp);
    ramped.set({-0.05, 0}, {1, 0});
    ramped.step(after);
    const double apart = std::abs(values_of(ramped).x - x);
    expect(apart < 0.05 * last && apart < 3 * ramp, "a jump is the limit of a ramp");
    last = apart;
  }
}

/// Along a direction of the drive, of the release and of inputs that are set on the way.
void derivatives() {
  const auto position = [&](auto mass, auto displacement, auto velocity, auto rate) {
    using T = decltype(mass);
    const pd::Drive<T> with{mass, T(100), T(0.40), {T(0.020), T(0.020)}, {T(0.005), T(0.005)}};
    pd::Stepper<T> stepper(
        with, {{T(0), {T(0.10), T(0)}}, displacement, T(0.10), T(infinity), {T(0), {T(1), T(0)}}});
    stepper.step(T(0.004));
    stepper.set({velocity, rate}, {T(1), T(0)});
    stepper.step(T(0.03));
    const T tau = stepper.tau();
    return stepper.segment().flow.position.at(stepper.segment().after(tau), tau);
  };
  const double at[]{0.010, 1.5e-3, 0.10, -1.0}, along[]{1e-3, 2e-4, 0.02, 0.5}, step = 1e-5;
  const auto moved = [&](int i, double h) { return at[i] + h * along[i]; };
  for (int only = 0; only < 4; ++only) {
    const auto slope = [&](int i) { return i == only ? along[i] : 0; };
    const auto shifted = [&](int i, double h) { return i == only ? moved(i, h) : at[i]; };
    const Dual exact = position(Dual(at[0], slope(0)), Dual(at[1], slope(1)), Dual(at[2], slope(2)),
                                Dual(at[3], slope(3)));
    const auto apart = [&](double h) {
      return position(shifted(0, h), shifted(1, h), shifted(2, h), shifted(3, h));
    };
    const double difference = (apart(step) - apart(-step)) / (2 * step);
    expect(std::abs(exact.slope - difference) < 1e-6 * std::abs(difference),
           "an exact derivative is that of neighbours");
  }
}

}  // namespace

int main() {
  the_same_as_in_one_run();
  events();
  a_jump();
  derivatives();
  return check::status();
}
