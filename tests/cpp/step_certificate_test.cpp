// Certificate of a motion of bodies: it accepts those of random systems, and refuses those of another system.
#include "pindrive/bodies/step_certificate.hpp"

#include <cmath>
#include <cstdio>
#include <deque>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "cases.hpp"
#include "check.hpp"

namespace pd = pindrive;
namespace bodies = pd::bodies;
using check::expect;

namespace {

constexpr double duration = 0.1;

/// One to six bodies with links, contacts and stops between them, under constant inputs, rows and sinusoids.
class RandomSystem {
 public:
  bodies::System<double> system;
  bodies::State<double> state;

  explicit RandomSystem(unsigned seed) : random_(seed) {
    const int bodies_count = 1 + below(6);
    for (int i = 0; i < bodies_count; ++i) {
      system.bodies.push_back({near(0.01)});
      if (below(3) == 0) system.bodies[i].force = input(near(0.05), false);
      state.position.push_back(sign() * near(1e-3));
      state.velocity.push_back(below(2) ? 0 : sign() * near(0.05));
    }
    for (int i = below(bodies_count + 1); i > 0; --i) {
      bodies::Link<double> link{0, 0, near(150), below(2) ? near(0.2) : 0};
      join(link);
      if (link.other == bodies::ground && below(3) == 0) link.length = input(near(1e-3), false);
      system.links.push_back(link);
    }
    for (int i = 1 + below(2 * bodies_count); i > 0; --i) {
      bodies::Contact<double> contact{0, 0, near(0.02)};
      join(contact);
      contact.static_limit = contact.kinetic * (below(2) ? 1 : 1.5);
      if (below(2)) contact.stiffness = near(400);
      if (!contact.rigid() && below(2)) contact.damping = near(0.3);
      if (below(3) == 0) contact.load = input(1, true);
      if (contact.other == bodies::ground && below(2)) contact.velocity = input(near(0.05), false);
      system.contacts.push_back(contact);
      state.stretch.push_back(0);
    }
    for (int i = below(2) * (1 + below(3)); i > 0; --i) {
      bodies::Stop<double> stop{};
      join(stop);
      stop.side = below(2) ? 1 : -1;
      const double other = stop.other == bodies::ground ? 0 : state.position[stop.other];
      stop.position = state.position[stop.one] - other + stop.side * near(3e-4);
      if (below(3) == 0) stop.stiffness = near(2e4);
      if (!stop.rigid() && below(2)) stop.damping = near(1);
      if (stop.rigid() && below(2)) stop.restitution = below(2) ? 0.5 : 0.8;
      system.stops.push_back(stop);
    }
    for (int i = below(2) * (1 + below(2)); i > 0; --i) {
      bodies::Feedback<double> feedback{};
      join(feedback);
      feedback.measured = below(bodies_count);
      feedback.proportional = sign() * near(20);
      feedback.derivative = near(0.1);
      if (below(2)) feedback.integral = near(100);
      if (below(2)) feedback.reference = input(near(1e-3), false);
      if (below(2)) feedback.period = near(0.01);
      if (!feedback.sampled() && feedback.reference.next_breakpoint(0) < duration)
        feedback.derivative = 0;
      system.feedbacks.push_back(feedback);
    }
    for (std::size_t j = 1; j < system.contacts.size(); ++j) {
      bodies::Contact<double>& contact = system.contacts[j];
      if (below(4) != 0 || system.contacts[0].pressed_by >= 0) continue;
      if (contact.rigid() || contact.damping > 0) {
        contact.pressed_by = 0;
        contact.share = near(0.5);
        for (std::size_t s = 0; s < system.stops.size(); ++s)
          if (!system.stops[s].rigid())
            contact.pressed_by = static_cast<int>(system.contacts.size() + s);
      }
    }
  }
  RandomSystem(const RandomSystem&) = delete;
  RandomSystem& operator=(const RandomSystem&) = delete;

 private:
  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  double sign() { return below(2) ? 1 : -1; }
  double near(double value) {
    return value * std::exp(std::uniform_real_distribution<double>(-1.5, 1.5)(random_));
  }
  template <class Joint>
  void join(Joint& joint) {
    const int count = static_cast<int>(system.bodies.size());
    joint.one = below(count);
    joint.other = below(count + 1) - 1;
    if (joint.other == joint.one) joint.other = bodies::ground;
  }
  pd::Profile<double> input(double size, bool positive) {
    const double way = positive ? 1 : sign();
    const int kind = below(4);
    if (kind < 2) return pd::Profile<double>(way * size);
    if (kind == 2) {
      const double first = near(0.02);
      rows_.push_back({0, first, first + near(0.02)});
      const double* times = rows_.back().data();
      rows_.push_back({way * size, (positive ? 1 : -way) * near(size), below(2) ? size : 0});
      return {times, rows_.back().data(), 3};
    }
    terms_.push_back({0, way * size / 2, 0, 2 * M_PI * near(20)});
    pd::InputPiece<double> piece;
    piece.polynomial[0] = way * size;
    piece.terms = &terms_.back();
    piece.count = 1;
    pieces_.push_back(piece);
    return {&pieces_.back(), 1};
  }

  std::mt19937_64 random_;
  std::deque<std::vector<double>> rows_;
  std::deque<pd::InputTerm<double>> terms_;
  std::deque<pd::InputPiece<double>> pieces_;
};

void random_systems() {
  const int count = cases(400);
  double worst = 0;
  int unfinished = 0;
  long steps = 0;
  // Last: an impact close to the middle of a step, and forces at their limits to rounding.
  std::vector<int> seeds(static_cast<std::size_t>(count));
  std::iota(seeds.begin(), seeds.end(), 0);
  seeds.insert(seeds.end(), {11842, 34591, 86651, 88741});
  for (const int seed : seeds) {
    const RandomSystem given(static_cast<unsigned>(seed));
    bodies::Following<double> following(given.system, given.state);
    bodies::StepCertificate<double> certificate(given.system);
    const auto add = [&](const bodies::Step<double>& step) { certificate.add(step); };
    following.advance(duration, add);
    if (following.status() != pd::Status::ok) {
      std::printf("# system %d ends at %g s\n", seed, following.state().time);
      ++unfinished;
      continue;
    }
    worst = std::max(worst, certificate.violations().worst());
    steps += certificate.steps();
  }
  std::printf("# %d systems, %ld steps: laws and energy within %.1e\n", count, steps, worst);
  expect(worst < 1e-9, "random systems keep their laws");
  expect(50 * unfinished <= count, "and few of them find no mode");
}

/// Largest violation of a motion by the laws of a system that differs in one thing.
double violation(const std::function<void(bodies::System<double>&)>& change) {
  bodies::System<double> system;
  system.bodies = {{0.01}, {0.02}};
  system.links = {{0, 1, 150, 0.2}};
  system.contacts = {{0, bodies::ground, 0.02, 0.03}, {1, bodies::ground, 0.01, 0.01, 400, 0.3}};
  system.contacts[0].velocity = 0.05;
  system.contacts[1].pressed_by = 2;
  system.contacts[1].share = 2;
  system.stops = {{1, bodies::ground, 1e-3, 1, 1000}};
  system.feedbacks = {{1, 0, 1, 0, 20, 0.1, 300, 1e-3}, {0, bodies::ground, 1}};
  system.feedbacks[1].proportional = 10;
  system.feedbacks[1].integral = 100;
  system.feedbacks[1].period = 0.01;
  bodies::System<double> other = system;
  change(other);
  bodies::Following<double> following(system, {0, {0, 2e-3}, {0.05, 0}, {0, 0}});
  bodies::StepCertificate<double> certificate(other);
  const auto add = [&](const bodies::Step<double>& step) { certificate.add(step); };
  following.advance(duration, add);
  return certificate.violations().worst();
}

void wrong_motions() {
  using System = bodies::System<double>;
  expect(violation([](System&) {}) < 1e-12, "the motion of a system is its own");
  const std::vector<std::function<void(System&)>> changes{
      [](System& s) { s.bodies[0].mass *= 1.0001; },
      [](System& s) { s.bodies[1].force = 1e-5; },
      [](System& s) { s.links[0].stiffness *= 1.0001; },
      [](System& s) { s.links[0].damping *= 1.001; },
      [](System& s) { s.links[0].length = 1e-6; },
      [](System& s) { s.contacts[0].kinetic *= 1.0001; },
      [](System& s) { s.contacts[0].static_limit = 0.019; },
      [](System& s) { s.contacts[0].velocity = 0.0501; },
      [](System& s) { s.contacts[1].load = 1.0001; },
      [](System& s) { s.contacts[1].stiffness *= 1.0001; },
      [](System& s) { s.contacts[1].damping *= 1.001; },
      [](System& s) { s.contacts[1].share *= 1.001; },
      [](System& s) { s.feedbacks[0].proportional *= 1.0001; },
      [](System& s) { s.feedbacks[0].derivative *= 1.001; },
      [](System& s) { s.feedbacks[0].integral *= 1.001; },
      [](System& s) { s.feedbacks[0].reference = 1.001e-3; },
      [](System& s) { s.feedbacks[1].integral *= 1.01; },
      [](System& s) { s.feedbacks[1].period = 0.02; }};
  for (const auto& change : changes) expect(violation(change) > 1e-6, "and that of no other");
}

}  // namespace

int main() {
  random_systems();
  wrong_motions();
  return check::status();
}
