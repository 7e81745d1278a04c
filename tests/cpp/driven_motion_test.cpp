// The closed form of a mode under functions: its equation, its Taylor polynomials, where it is refused, and a
// motion beside that under the same functions in many pieces, between which there is no room for it.
#include "pindrive/series/driven_motion.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "check.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"

namespace pd = pindrive;
using check::expect;
using pd::detail::DrivenMotion;

namespace {

using Equation = pd::detail::SeriesEquation<double>;
using State = pd::detail::SeriesState<double>;

/// Inputs of an equation: a load that decays and swings, a hand and a force of one frequency.
struct Given {
  std::array<pd::InputTerm<double>, 2> fall{{{0.3, 0.1, 50, 300}, {0.2, 0, 20, 0}}};
  std::array<pd::InputTerm<double>, 1> swing{{{0.01, 0.02, 0, 200}}};
  pd::InputPiece<double> load{0, {1, 0.3, 0.2}, fall.data(), 2};
  pd::InputPiece<double> push{0, {0.001, 0.1, -2, 3, 4, 5}, swing.data(), 1};

  Equation equation(double damping, bool held) const {
    Equation e{0.01, damping, 100.0};
    e.load = {load, 0.01};
    e.plate_force = 0.2;
    e.side = -1;
    e.pushes = {push, 0.02};
    e.plate_velocity = {push, 0.0};
    e.force.value = e.pushes.value + e.mass * e.plate_velocity.rate;
    e.skin_stiffness = 30;
    e.skin_factor.value = e.skin_pull.value = 1;
    e.held = held;
    if (held) e.surface = e.plate_velocity;
    return e;
  }
};

/// Largest residual of the equation of motion and of the law of the skin, and largest error of the steps.
double worst_of(const Equation& e, const DrivenMotion<double>& motion, const State& start) {
  double worst = 0;
  const auto acceleration = motion.velocity.derivative();
  for (const double t : {0.0, 0.001, 0.01, 0.1}) {
    const double x = motion.position.at(t), v = motion.velocity.at(t), y = motion.skin.at(t);
    const double given = e.pushes.at(t) + e.mass * e.plate_velocity.rate_at(t) +
                         e.plate_force * e.load.at(t) + motion.stick_force.at(t);
    const double left = e.mass * acceleration.at(t) + e.damping * v + e.stiffness * x + y;
    worst = std::max({worst, std::abs(left - given),
                      std::abs(y - start.skin - e.skin_stiffness * (x - start.x))});
    const double h = motion.reach(t);
    const auto step = motion.step(t, h);
    worst = std::max({worst, std::abs(step.position.at(0.7 * h) - motion.position.at(t + 0.7 * h)),
                      std::abs(step.velocity.at(h) - motion.velocity.at(t + h))});
  }
  return worst;
}

void equation() {
  const Given given;
  const State start{1e-3, 0.05, 0.02};
  for (const double damping : {0.0, 0.3, 5.0})  // undamped, below and above critical damping
    for (const bool held : {false, true}) {
      const Equation e = given.equation(damping, held);
      const DrivenMotion<double> motion(e, start);
      const double v = held ? e.surface.value : start.v;
      expect(std::abs(motion.position.at(0) - start.x) < 1e-18 &&
                 std::abs(motion.velocity.at(0) - v) < 1e-16 &&
                 std::abs(motion.skin.at(0) - start.skin) < 1e-17,
             "a driven motion begins with its state");
      expect(worst_of(e, motion, start) < 2e-15, "... and obeys its equation");
    }
}

void refused() {
  const double k = 100, m = 0.01, omega = std::sqrt(k / m);
  for (const double detuned : {0.0, 1e-9, 1e-3, 0.5}) {
    const std::array<pd::InputTerm<double>, 1> swing{{{0.01, 0, 0, omega * (1 + detuned)}}};
    const pd::InputPiece<double> push{0, {}, swing.data(), 1};
    Equation e{m, 0, k};
    e.pushes = {push, 0.0};
    e.force.value = e.pushes.value;
    const DrivenMotion<double> motion(e, {1e-4, 0});
    expect(motion.is_accurate(1e-4, 0.01) == (detuned == 0.5), "resonance is left to the series");
  }
}

/// Release under a stroke of the hand and a pull that dies away; in parts of a duration, s.
struct Release {
  explicit Release(double part) {
    for (double t = 0; t < 0.5; t += part) {
      terms.push_back({0.8 * std::exp(-200 * t), 0, 200, 0});
      begins.push_back(t);
    }
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double t = begins[i];
      loads.push_back({t, {0.2}, &terms[i], 1});
      hands.push_back({t, {0.03 + 0.4 * t - 0.9 * t * t, 0.4 - 1.8 * t, -0.9}, nullptr, 0});
    }
    drive.plate.static_limit = 0.3;
    drive.plate.kinetic = 0.25;
    inputs.mouse_velocity = {hands.data(), hands.size()};
    inputs.plate_load = {loads.data(), loads.size()};
    inputs.duration = 0.5;
    outcome =
        pd::simulate(drive, inputs, [&](const auto& segment) { segments.push_back(segment); });
  }
  Release(const Release&) = delete;
  pd::Motion<double> motion() const {
    return {drive, inputs, segments.data(), segments.size(), outcome};
  }
  double at(double t, pd::Quantity quantity) const {
    const auto place = motion().locate(t, pd::Side::right);
    return motion().value(*place.segment, place.tau, quantity);
  }

  std::vector<pd::InputTerm<double>> terms;
  std::vector<double> begins;
  std::vector<pd::InputPiece<double>> loads, hands;
  pd::Drive<double> drive{0.001, 250, 0.5, {}, {}};
  pd::Inputs<double> inputs{pd::Profile<double>(0.0), 2e-3, 0.0};
  std::vector<pd::Segment<double>> segments;
  pd::Outcome<double> outcome;
};

void motion() {
  const Release whole(1), parts(4e-3);
  double apart = 0;
  for (double t = 0; t < 0.5; t += 1e-3) {
    apart = std::max(
        {apart,
         std::abs(whole.at(t, pd::Quantity::position) - parts.at(t, pd::Quantity::position)) / 2e-3,
         std::abs(whole.at(t, pd::Quantity::velocity) - parts.at(t, pd::Quantity::velocity))});
  }
  std::printf("%zu segments and %zu, %.2g apart\n", whole.segments.size(), parts.segments.size(),
              apart);
  expect(apart < 1e-13, "a driven motion is that in many pieces");
  expect(whole.segments.size() < 12 && parts.segments.size() > 100, "... in few segments");
  const auto certificate = pd::Certifier<double>(whole.motion(), 0.5).certify();
  expect(certificate.worst() < 1e-13, "... and keeps the laws");
}

/// A pin that only decays is at rest, to rounding, after the time constants of its slowest part.
void decays() {
  pd::detail::SeriesEquation<double> e;
  e.mass = 1;
  e.damping = 5;
  e.stiffness = 4;  // rates of 1 and 4 per second
  const pd::detail::SeriesState<double> start{1e-3, 0, 0, 0, 0};
  const pd::detail::DrivenMotion<double> motion(e, start);
  const double end = motion.decay_time();
  expect(end > 30 && end < 40, "a decay takes some 36 time constants to its rounding");
  expect(std::abs(motion.velocity.at(end)) < 1e-17, "... after which the velocity is rounding");
  expect(std::isinf(pd::detail::DrivenMotion<double>(e, {}).decay_time()),
         "a pin at rest has nothing that decays");
  e.damping = 0;
  expect(std::isinf(pd::detail::DrivenMotion<double>(e, start).decay_time()),
         "an oscillation lasts");
}

}  // namespace

int main() {
  equation();
  refused();
  decays();
  motion();
  return check::status();
}
