// A pin followed in steps of any length is the pin that one simulation follows: the same modes, events and
// quantities, also from a state that was kept, through changes of the inputs, and in derivatives.
#include "pindrive/events/stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <type_traits>
#include <vector>

#include "cases.hpp"
#include "check.hpp"
#include "driven_case.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

using namespace driven;
using Dual = pd::Dual<double>;

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
               {c.times.data(), c.loads.data(), c.times.size()},
               std::numeric_limits<double>::quiet_NaN(),
               {c.times.data(), c.forces.data(), c.times.size()},
               {c.times.data(), c.across.data(), c.times.size()},
               {c.times.data(), c.touches.data(), c.times.size()}},
        outcome(pd::simulate(c.drive, inputs, [&](const auto& s) { segments.push_back(s); })) {}
  pd::Motion<double> view(const Case& c) const {
    return {c.drive, inputs, segments.data(), segments.size(), outcome};
  }
};

struct Values {
  double x, v, plate, finger, stop;
};
Values values_in(const pd::Drive<double>& drive, const pd::Segment<double>& segment,
                 const pd::InputCurves<double>& lines, double tau) {
  return pd::visit_trajectory(drive, segment, lines, [&](const auto& t) {
    const auto friction = pd::friction_along(t, drive, segment, [&] { return lines; }, tau);
    return Values{t.at(t.position(), tau), t.at(t.velocity(), tau), friction.plate, friction.finger,
                  pd::stop_force_along(t, drive, segment, lines.force, tau)};
  });
}
Values values_of(const pd::Stepper<double>& stepper) {
  return values_in(stepper.drive(), stepper.segment(), stepper.lines(), stepper.tau());
}

pd::Inputs<double> start_of(const Case& c) {
  const auto lines = c.from(0);
  return {{0, lines.plate_velocity.line()},
          c.displacement,
          c.velocities[0],
          infinity,
          {0, lines.plate_load.line()},
          std::numeric_limits<double>::quiet_NaN(),
          {0, lines.force.line()},
          {0, lines.across_velocity.line()},
          {0, lines.finger_load.line()}};
}

struct Worst {
  double position{0}, velocity{0}, force{0};
  int given_up{0}, oblique{0}, at_stop{0}, modes{0}, checked{0}, restored{0}, differing{0};
};

/// Random steps against one run; now and then from a state that was kept, after going astray.
void compare(const Case& c, Random& random, Worst& worst) {
  const Whole whole(c);
  worst.given_up += whole.outcome.status != pd::Status::ok;
  if (whole.outcome.status != pd::Status::ok) return;
  const auto motion = whole.view(c);
  const double pushed = 0.1 * bool(c.forces[0]) / c.drive.stiffness;
  const double size =
      std::abs(c.displacement) + 0.3 * std::sqrt(c.drive.mass / c.drive.stiffness) + pushed;
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
        stepper->set({{0.2, 1}, {0, 0}, {0.1, -3}, {0.5, 2}});
        stepper->step(stepper->now() + 0.01);
        auto again = std::make_unique<pd::Stepper<double>>(c.drive, kept);
        stepper.swap(again);
        ++worst.restored;
        const Values back = values_of(*stepper);
        if (back.x != at.x || back.v != at.v || back.plate != at.plate ||
            back.finger != at.finger || back.stop != at.stop)
          ++worst.differing;
      }
      const auto [segment, tau] = motion.locate(stepper->now(), pd::Side::left);
      const Values found = values_of(*stepper);
      const Values expected = values_in(
          c.drive, *segment, pd::InputCurves<double>::of(c.drive, whole.inputs, *segment), tau);
      worst.position = std::max(worst.position, std::abs(found.x - expected.x) / size);
      ++worst.checked;
      worst.at_stop += segment->mode.stop != pd::StopState::apart;
      worst.oblique += segment->mode.plate == pd::ContactState::slip_oblique;
      const bool inside = tau > 1e-9 && segment->end - segment->begin - tau > 1e-9;
      if (inside || !c.drive.stops.present() || !c.drive.stops.rigid())  // it jumps as it strikes
        worst.velocity = std::max(worst.velocity, std::abs(found.v - expected.v) / speed);
      if (inside)
        worst.force = std::max({worst.force, std::abs(found.plate - expected.plate),
                                std::abs(found.finger - expected.finger),
                                std::abs(found.stop - expected.stop)});
      if (inside && (stepper->mode().plate != segment->mode.plate ||
                     stepper->mode().finger != segment->mode.finger ||
                     stepper->mode().stop != segment->mode.stop))
        ++worst.modes;
    }
    if (row < c.times.size()) stepper->set(c.from(end));
  }
}

void the_same_as_in_one_run() {
  Random random(16);
  Worst worst, across;
  Worst stopped;  // against stops a thousand times as stiff as the spring, rounding grows
  for (int i = 0; i < cases(2000); ++i) {
    const Case c(random);
    const bool oblique = c.across != std::vector<double>(c.across.size(), 0.0);
    const bool damped = c.drive.finger.damped();  // its force rounds as the velocity
    compare(c, random, oblique || damped ? across : c.drive.stops.present() ? stopped : worst);
  }
  expect(stopped.position < 1e-12 && stopped.velocity < 1e-11 && stopped.force < 1e-12,
         "nor where it is stopped");
  expect(stopped.at_stop > stopped.checked / 100 && stopped.modes == 0 && stopped.differing == 0,
         "in any mode of the stops, and from each state that is kept");
  std::printf("stopped: position %.1e, velocity %.1e, force %.1e\n", stopped.position,
              stopped.velocity, stopped.force);
  std::printf("%d times, %d of them oblique, %d from a kept state; %d given up\n", worst.checked,
              worst.oblique, worst.restored, worst.given_up);
  std::printf("position %.1e, velocity %.1e, force %.1e\n", worst.position, worst.velocity,
              worst.force);
  // The rest criterion is applied where a step of a series ends, which rows of inputs cut elsewhere.
  std::printf("across: position %.1e, velocity %.1e, force %.1e\n", across.position,
              across.velocity, across.force);
  expect(across.position < 3e-11 && across.velocity < 3e-11 && across.force < 1e-10,
         "across the axis and on damped skin to the rest criterion");
  expect(worst.position < 2e-14 && worst.velocity < 2e-14 && worst.force < 2e-14,
         "steps leave no trace in the motion");
  expect(across.oblique > 0 && worst.given_up + across.given_up < cases(2000) / 100,
         "of all kinds");
  expect(worst.modes == 0 && across.modes == 0, "nor in what the contacts do");
  expect(worst.differing == 0 && across.differing == 0, "a kept state gives the same bits");
}

/// Segments of a pin whose inputs are set row by row, each until the next; steps in between if `cut`.
std::vector<pd::Segment<double>> segments_of(const Case& c, bool cut) {
  std::vector<pd::Segment<double>> found;
  const auto sink = [&](const pd::Segment<double>& segment, const auto&) {
    found.push_back(segment);
  };
  pd::Stepper<double> stepper(c.drive, start_of(c));
  for (std::size_t row = 0; row < c.times.size(); ++row) {
    const bool last = row + 1 == c.times.size();
    const double end = last ? c.duration : c.times[row + 1];
    stepper.set(c.from(c.times[row]), last ? infinity : end, sink);
    if (cut)
      for (double part : {0.3, 0.31, 0.9})
        stepper.step(c.times[row] + part * (end - c.times[row]), false, {}, sink);
    stepper.step(end, false, {}, sink);
  }
  found.push_back(stepper.segment_until_now());
  return found;
}

void segments_between_rows() {
  Random random(17);
  int differing = 0, cut_differing = 0, count = 0;
  // Steps of a series may end elsewhere.
  const auto with_events = [](std::vector<pd::Segment<double>> segments) {
    segments.erase(std::remove_if(segments.begin(), segments.end(),
                                  [](const auto& segment) { return !segment.event.any(); }),
                   segments.end());
    return segments;
  };
  for (int i = 0; i < cases(500); ++i) {
    const Case c(random);
    const Whole whole(c);
    if (whole.outcome.status != pd::Status::ok) continue;
    const auto found = segments_of(c, false), again = segments_of(c, true);
    const auto alike = [](const pd::Segment<double>& one, const pd::Segment<double>& other) {
      return std::abs(one.end - other.end) < 1e-10 && pd::same_mode(one.mode, other.mode) &&
             one.event.plate == other.event.plate && one.event.finger == other.event.finger &&
             one.event.stop == other.event.stop;
    };
    const auto equal = [](const pd::Segment<double>& one, const pd::Segment<double>& other) {
      return one.begin == other.begin && one.end == other.end &&
             one.flow.position.start == other.flow.position.start &&
             one.moved.gain == other.moved.gain;
    };
    const auto events = with_events(found), expected = with_events(whole.segments);
    count += static_cast<int>(events.size());
    differing += !std::equal(events.begin(), events.end(), expected.begin(), expected.end(), alike);
    cut_differing += !std::equal(found.begin(), found.end(), again.begin(), again.end(), equal);
  }
  std::printf("%d events between rows, of %d motions other than in one run\n", count, differing);
  expect(differing == 0, "events between rows are those of one run");
  expect(cut_differing == 0, "to the bit wherever steps end");
}

/// A released pin that comes to rest on the finger.
const pd::Drive<double> drive{0.010, 100, 0.40, {0.020, 0.020}, {0.005, 0.005}};
const pd::Inputs<double> release{{0, {0.10, 0}}, 1.5e-3, 0.10, infinity, {0, {1, 0}}};

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
  stepper.set({{0.10, 0}});
  expect(stepper.tau() > 0, "an input that is set as it is changes nothing");
  stepper.set({{0.10 * (1 + 3e-16), 0}});
  expect(stepper.tau() > 0, "nor one that differs by rounding");
}

/// Inputs that are set once more in one instant: the segments tell all transitions, one after the other.
void set_twice() {
  pd::Stepper<double> stepper(drive, release);
  expect(stepper.step(1), "a pin at rest on the finger");
  std::vector<pd::Segment<double>> segments;
  const auto keep = [&](const auto& segment, const auto&) {
    segments.push_back(segment);
    return true;
  };
  pd::InputCurves<double> lines = stepper.inputs();
  lines.force = {1, 0};
  stepper.set(lines, infinity, keep);
  expect(segments.size() == 1 && segments[0].event.finger == pd::Transition::slip, "is pushed");
  lines.force = {0, 0};
  stepper.set(lines, infinity, keep);
  expect(stepper.mode().finger == pd::ContactState::stick, "... and is not, in the same instant");
  expect(segments.size() == 2 && segments[1].event.finger == pd::Transition::stick,
         "the second change has its event");
  expect(segments[1].begin == 1 && segments[1].end == 1, "... at the end of a segment of no time");
  stepper.set(lines, 2.0, keep);
  expect(segments.size() == 2, "a change without a transition has none");
}

/// Events at rigid and elastic stops in steps; a jerk of the housing, which throws the pin from one rigid stop.
void at_the_stops() {
  for (const double stiffness : {infinity, 2000.0}) {
    pd::Drive<double> stopped = drive;
    stopped.stops = {1.6e-3, stiffness, stiffness < infinity ? 0.5 : 0};
    std::vector<pd::Event> expected, found;
    pd::simulate(stopped, pd::Inputs<double>{0.10, 1.5e-3, 0.10}, [&](const auto& segment) {
      const pd::Event& e = segment.event;
      if (pd::stops(e.finger) || e.finger == pd::Transition::slip || e.stop != pd::Transition::none)
        expected.push_back(e);
    });
    pd::Stepper<double> stepper(stopped, release);
    while (stepper.next() < infinity && stepper.step(1, true)) found.push_back(stepper.event());
    const bool same =
        std::equal(expected.begin(), expected.end(), found.begin(), found.end(),
                   [](const auto& a, const auto& b) {
                     return a.plate == b.plate && a.finger == b.finger && a.stop == b.stop;
                   });
    expect(same && !found.empty() && pd::stops(found[0].stop), "it strikes as in one run");
  }
  pd::Drive<double> stopped = drive;
  stopped.stops.travel = 1.5e-3;
  const pd::Inputs<double> held{{0, {0.10, 0}}, 1.5e-3, 0, infinity, {0, {1, 0}}, NAN,
                                {0, {0.3, 0}}};
  for (const double jump : {0.05, -0.05}) {
    pd::Stepper<double> stepper(stopped, held);
    stepper.step(0.01);
    expect(stepper.mode().stop == pd::StopState::upper, "a force keeps it at a stop");
    auto inputs = stepper.inputs();
    inputs.plate_velocity.value += jump;
    stepper.set(inputs);
    const Values now = values_of(stepper);
    if (jump > 0)
      expect(now.v == 0 && stepper.event().stop == pd::Transition::stick, "it strikes again");
    else
      expect(now.v == jump && stepper.event().stop == pd::Transition::slip, "it is thrown off");
    pd::Stepper<double> kept(stopped, stepper.state());
    expect(kept.event().stop == stepper.event().stop && values_of(kept).v == now.v &&
               kept.next() == stepper.next(),
           "which a kept state says too");
  }
}

/// An input that jumps is one that gets there ever faster.
void a_jump() {
  const double before = 0.004, after = 0.011;
  const pd::InputCurves<double> lines[]{
      {{-0.05, 0}},                    // the mouse velocity
      {{0.10, 0}, {1, 0}, {0.03, 0}},  // the velocity across, on a plate that did not slide across
      {{0.10, 0}, {3, 0}, {}, {0.020, 0}}};  // the load and the force
  for (const auto& target : lines) {
    pd::Stepper<double> stepper(drive, release);
    stepper.step(before);
    const auto start = stepper.inputs();
    stepper.set(target);
    stepper.step(after);
    const double x = values_of(stepper).x;
    double last = infinity;
    for (const double ramp : {1e-5, 1e-7, 1e-9}) {
      const auto towards = [&](const pd::Curve<double>& from, const pd::Curve<double>& to) {
        return pd::Line<double>{from.value, (to.value - from.value) / ramp};
      };
      pd::Stepper<double> ramped(drive, release);
      ramped.step(before);
      ramped.set({towards(start.plate_velocity, target.plate_velocity),
                  towards(start.plate_load, target.plate_load),
                  towards(start.across_velocity, target.across_velocity),
                  towards(start.force, target.force)});
      ramped.step(before + ramp);
      ramped.set(target);
      ramped.step(after);
      const double apart = std::abs(values_of(ramped).x - x);
      expect(apart < 0.05 * last && apart < 3 * ramp, "a jump is the limit of a ramp");
      last = apart;
    }
  }
}

/// The plate of a pin that is carried slides across from a jump on: the pin does not stick until it stops.
void across_and_back() {
  const pd::Drive<double> light{0.010, 100, 0.40, {0.5, 0.5}, {0.005, 0.005}};
  pd::Stepper<double> stepper(light, release);
  stepper.step(0.002);
  expect(stepper.mode().plate == pd::ContactState::stick, "the plate carries the pin");
  stepper.set({{0.10, 0}, {1, 0}, {0.05, 0}});
  expect(stepper.mode().plate == pd::ContactState::slip_oblique &&
             stepper.event().plate == pd::Transition::slip,
         "it slips at once where the plate jumps across");
  stepper.step(0.004);
  stepper.set({{0.10, 0}, {1, 0}, {0.05, -0.05 / 0.003}});
  stepper.step(0.007);
  stepper.set({{0.10, 0}, {1, 0}, {0, 0}});  // its line is at zero to rounding
  expect(stepper.inputs().across_velocity.value == 0 &&
             stepper.mode().plate == pd::ContactState::slip_backward,
         "what is set is exact: it slips along the axis alone");
  stepper.step(0.008, true);
  expect(stepper.event().plate == pd::Transition::stick, "and sticks");
}

/// Along a direction of the drive, of the release and of inputs that are set on the way.
void derivatives() {
  const auto position = [&](const auto& p) {
    using T = std::decay_t<decltype(p[0])>;
    const pd::Drive<T> with{p[0], T(100), T(0.40), {T(0.020), T(0.020)}, {T(0.005), T(0.005)}};
    const pd::Inputs<T> start{T(0.10), p[1], T(0.10)};
    pd::Stepper<T> stepper(with, start);
    stepper.step(T(0.004));
    stepper.set({{p[2], p[3]}, {T(1), T(0)}, {p[4], T(0)}, {p[5], p[6]}});
    stepper.step(T(0.03));
    return pd::visit_trajectory(
        stepper.drive(), stepper.segment(), stepper.lines(),
        [&](const auto& along) { return along.at(along.position(), stepper.tau()); });
  };
  constexpr int count = 7;
  const double at[count]{0.010, 1.5e-3, 0.10, -1.0, 0.05, 0.010, 0.3}, step = 1e-5;
  const double along[count]{1e-3, 2e-4, 0.02, 0.5, 0.02, 5e-3, 0.2};
  for (int only = 0; only < count; ++only) {
    std::array<Dual, count> exact;
    for (int i = 0; i < count; ++i) exact[i] = Dual(at[i], i == only ? along[i] : 0);
    const auto apart = [&](double h) {
      std::array<double, count> moved;
      for (int i = 0; i < count; ++i) moved[i] = at[i] + (i == only ? h * along[i] : 0);
      return position(moved);
    };
    const double difference = (apart(step) - apart(-step)) / (2 * step);
    expect(std::abs(position(exact).slope - difference) < 1e-6 * std::abs(difference),
           "an exact derivative is that of neighbours");
  }
}

/// Random functions of time for all inputs, some in two pieces; the rest continues as the first row.
struct Functions {
  std::vector<pd::InputTerm<double>> terms;
  std::vector<pd::InputPiece<double>> velocity, load, force, across, touch;

  explicit Functions(const Case& c, Random& random) {
    terms.reserve(8);
    const double rate = std::sqrt(c.drive.stiffness / c.drive.mass);
    const auto term = [&](double cosine, double sine, double decay, double frequency) {
      terms.push_back({cosine, sine, decay * rate, frequency * rate});
      return &terms.back();
    };
    const double end = c.times.back(), v = c.velocities[0], speed = 30 * (c.velocities[1] - v) / 16;
    const double fast = between(random, 0.3, 3);
    if (one_of(random, 2))
      velocity = {{0, {v}, term(0, c.velocities[1], 0, fast), 1}};
    else
      velocity = {{0, {v, 0, speed / pow(end, 2), -2 * speed / pow(end, 3), speed / pow(end, 4)}},
                  {end, {v}}};
    if (one_of(random, 2)) load = {{0.01, {1}, term(1.5, 0, between(random, 0.5, 5), 0), 1}};
    if (one_of(random, 2)) force = {{0, {0.02, 0.1}, term(0.05, 0.02, 0.3, fast / 2), 1}};
    if (one_of(random, 4)) across = {{0, {0.1}, term(0, 0.05, 0, 0.7), 1}};
    if (one_of(random, 2) && c.drive.finger.rigid())
      touch = {{0, {1}, term(0.4, 0.4, 0, 2 * fast), 1}};
  }
  static double pow(double x, int n) { return std::pow(x, n); }
  pd::Inputs<double> release(const Case& c) const {
    const auto input = [](const std::vector<pd::InputPiece<double>>& pieces, double constant) {
      return pieces.empty() ? pd::Profile<double>(pd::Held<double>(constant))
                            : pd::Profile<double>(pieces.data(), pieces.size());
    };
    return {input(velocity, c.velocities[0]),
            c.displacement,
            c.velocities[0],
            c.duration,
            input(load, c.loads[0]),
            std::numeric_limits<double>::quiet_NaN(),
            input(force, c.forces[0]),
            input(across, c.across[0]),
            input(touch, c.touches[0])};
  }
};

/// Inputs that are functions, followed in random steps, beside one run; also from states that are kept.
void functions_of_time() {
  Random random(18);
  double position = 0, velocity = 0;
  int differing = 0, modes = 0, count = 0, given_up = 0;
  for (int i = 0; i < cases(1000); ++i) {
    const Case c(random);
    const Functions functions(c, random);
    const pd::Inputs<double> inputs = functions.release(c);
    std::vector<pd::Segment<double>> segments;
    const auto outcome =
        pd::simulate(c.drive, inputs, [&](const auto& s) { segments.push_back(s); });
    given_up += outcome.status != pd::Status::ok;
    if (outcome.status != pd::Status::ok) continue;
    const pd::Motion<double> motion(c.drive, inputs, segments.data(), segments.size(), outcome);
    const double size =
        std::abs(c.displacement) + 0.3 * std::sqrt(c.drive.mass / c.drive.stiffness);
    const double speed = size * std::sqrt(c.drive.stiffness / c.drive.mass);
    auto stepper = std::make_unique<pd::Stepper<double>>(c.drive, inputs);
    while (stepper->now() < c.duration) {
      stepper->step(std::min(c.duration, stepper->now() + between(random, 0, 0.02)),
                    one_of(random, 2));
      if (one_of(random, 5)) {
        const Values at = values_of(*stepper);
        stepper = std::make_unique<pd::Stepper<double>>(c.drive, stepper->state(), inputs);
        const Values back = values_of(*stepper);
        differing += back.x != at.x || back.v != at.v || back.plate != at.plate;
      }
      const auto [segment, tau] = motion.locate(stepper->now(), pd::Side::left);
      const Values found = values_of(*stepper);
      const Values expected =
          values_in(c.drive, *segment, pd::InputCurves<double>::of(c.drive, inputs, *segment), tau);
      position = std::max(position, std::abs(found.x - expected.x) / size);
      const bool inside = tau > 1e-9 && segment->end - segment->begin - tau > 1e-9;
      if (inside) {
        velocity = std::max(velocity, std::abs(found.v - expected.v) / speed);
        modes += !pd::same_mode(stepper->mode(), segment->mode);
      }
      ++count;
    }
  }
  std::printf("functions: %d times, %d given up, position %.1e, velocity %.1e, %d modes\n", count,
              given_up, position, velocity, modes);
  expect(position < 1e-11 && velocity < 1e-10 && modes == 0 && given_up == 0,
         "under functions of time, steps leave no trace");
  expect(differing == 0, "a kept state goes on under functions with the same bits");
}

/// As event_times_do_not_drift in simulation_test.cpp, by steps, from states that are kept on the way.
void event_times_do_not_drift() {
  const pd::Drive<double> undamped{0.01, 100, 0, {}, {1e-9, 1e-9}};
  const auto begin = std::make_unique<pd::Stepper<double>>(
      undamped, pd::Inputs<double>{pd::Held<double>(0.1), 1.5e-3, 0.1});
  const long double omega = sqrtl(100.0L / undamped.mass), pi = 3.14159265358979323846264L;
  const long double first =
      atan2l(0.1L, omega * (undamped.finger.kinetic / 100.0L + 1.5e-3)) / omega;
  double worst = 0;
  auto state = begin->state();
  for (int kept = 0; kept < 10; ++kept) {
    pd::Stepper<double> stepper(undamped, state);
    for (int i = 0; i < 1000; ++i) {
      const long double exact = first + (1000 * kept + i) * pi / omega;
      stepper.step(1e3, true);
      const auto apart = static_cast<double>(std::abs(stepper.now() - exact));
      worst = std::max(worst, apart / (std::nextafter(stepper.now(), 1e9) - stepper.now()));
    }
    state = stepper.state();
  }
  std::printf("# times within %.2f ulp after 10 000 reversals\n", worst);
  expect(worst <= 4, "10 000 reversals later an event is within 4 ulp");
}

}  // namespace

int main() {
  event_times_do_not_drift();
  the_same_as_in_one_run();
  segments_between_rows();
  events();
  set_twice();
  at_the_stops();
  a_jump();
  across_and_back();
  derivatives();
  functions_of_time();
  return check::status();
}
