// Motion of several bodies: a single pin as `simulate` has it, cases with a formula, and what no choice of names changes.
#include "pindrive/bodies/follow.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "cases.hpp"
#include "check.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"

namespace pd = pindrive;
namespace bodies = pd::bodies;
using check::expect;

namespace {

using Random = std::mt19937_64;
using Following = bodies::Following<double>;

/// A pin under a plate whose velocity changes, as a drive and as a system.
struct Pin {
  std::array<double, 2> times{}, velocities{};
  std::array<pd::InputPiece<double>, 2> inertia{};
  pd::Drive<double> drive{};
  double displacement, velocity;
  bodies::System<double> system;

  Pin(Random& random, bool round) {
    const auto near = [&](double value) {
      const double x = value * std::exp(std::uniform_real_distribution<double>(-1, 1)(random));
      const double digit = std::pow(10, std::floor(std::log10(x)));
      return round ? std::round(x / digit) * digit : x;
    };
    const auto one_of = [&](int count) { return random() % static_cast<unsigned>(count) == 0; };
    drive = {near(0.005), near(150), one_of(4) ? 0 : near(0.2), {}, {}};
    drive.plate.kinetic = near(0.02);
    drive.plate.static_limit = drive.plate.kinetic * (one_of(2) ? 1 : 1.5);
    drive.finger.kinetic = near(0.02);
    drive.finger.static_limit = drive.finger.kinetic * (one_of(2) ? 1 : 1.5);
    const bool skin = !one_of(3), damped = one_of(2);
    if (skin) drive.finger.stiffness = near(400);
    if (skin && damped) drive.finger.damping = near(0.3);
    displacement = near(1.5e-3) * (one_of(2) ? 1 : -1);
    times = {0, near(0.01)};
    velocities = {near(0.06), near(0.06) * (one_of(3) ? -1 : 1)};
    velocity = skin ? 0 : velocities[0];
    inertia[0].polynomial[0] = drive.mass * (velocities[1] - velocities[0]) / times[1];
    inertia[1].begin = times[1];
    system.bodies.push_back({drive.mass, {inertia.data(), 2}});
    system.links.push_back({0, bodies::ground, drive.stiffness, drive.damping});
    for (const pd::Contact<double>* given : {&drive.plate, &drive.finger}) {
      bodies::Contact<double> made{0, bodies::ground, given->kinetic, given->static_limit};
      made.stiffness = given->stiffness;
      made.damping = given->damping;
      system.contacts.push_back(made);
    }
    system.contacts[0].velocity = plate();
  }
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;

  pd::Profile<double> plate() const { return {times.data(), velocities.data(), 2}; }
};

constexpr double duration = 0.05;

/// Position of a pin at the end, by `simulate`.
double by_simulate(const Pin& pin) {
  pd::Inputs<double> inputs{pin.plate(), pin.displacement, pin.velocity, duration};
  if (!pin.drive.finger.rigid()) inputs.skin_stretch = 0;
  std::vector<pd::Segment<double>> segments;
  const auto outcome =
      pd::simulate(pin.drive, inputs, [&](const auto& segment) { segments.push_back(segment); });
  const pd::Motion<double> motion(pin.drive, inputs, segments.data(), segments.size(), outcome);
  const auto [segment, tau] = motion.locate(duration, pd::Side::left);
  return motion.value(*segment, tau, pd::Quantity::position);
}

void single_pins() {
  for (const bool round : {false, true}) {
    Random random(round ? 8 : 7);
    double worst = 0;
    int apart = 0, refused = 0;
    const int count = cases(5000);
    for (int i = 0; i < count; ++i) {
      const Pin pin(random, round);
      Following following(pin.system, {0, {pin.displacement}, {pin.velocity}, {0, 0}});
      following.advance(duration);
      refused += following.status() != pd::Status::ok;
      const double error =
          std::abs(following.state().position[0] - by_simulate(pin)) / std::abs(pin.displacement);
      apart += !(error < 1e-12);
      worst = std::max(worst, error < 1e-12 ? error : 0);
    }
    std::printf("# %d single pins: within %.1e of the displacement, %d others\n", count, worst,
                apart);
    expect(refused == 0, "each has a consistent mode at each event");
    expect(1000 * apart <= count, "a single pin moves as `simulate` has it");
  }
}

void a_block_on_a_board() {
  // The block slides on a board that is free to move until both have one velocity.
  bodies::System<double> system;
  system.bodies = {{0.2}, {0.6}};
  system.contacts = {{0, 1, 0.3, 0.4}};
  Following following(system, {0, {0, 0}, {1, 0}, {0}});
  following.advance(1);
  const double together = 1 / (0.3 / 0.2 + 0.3 / 0.6);
  expect(
      following.changes().size() == 1 && std::abs(following.changes()[0].time - together) < 1e-15,
      "it sticks when friction has made the velocities equal");
  expect(std::abs(following.state().velocity[0] - 0.25) < 1e-15 &&
             following.state().velocity[0] == following.state().velocity[1],
         "and both keep the momentum");
}

void a_pin_that_the_finger_holds() {
  // The plate passes through the velocity of the pin: it could take the pin along, had the finger not held it before.
  const double times[] = {0, 0.05}, velocities[] = {0.07, -0.09};
  bodies::System<double> system;
  system.bodies = {{0.004, -0.06}};
  system.contacts = {{0, bodies::ground, 0.011, 0.0164}, {0, bodies::ground, 0.05, 0.0756}};
  system.contacts[0].velocity = {times, velocities, 2};
  Following following(system, {0, {0}, {0}, {0, 0}});
  following.advance(0.05);
  const auto& changes = following.changes();
  expect(changes.size() == 1 && changes[0].contact == 0 &&
             std::abs(changes[0].time - 0.05 * 0.07 / 0.16) < 1e-15 &&
             changes[0].after == bodies::Slip::forward,
         "a contact that sticks holds on before one that meets");
}

void pins_that_share_a_hand() {
  Random random(3);
  double momentum = 0, renamed = 0;
  int refused = 0;
  for (int i = 0; i < cases(500); ++i) {
    const auto draw = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    bodies::System<double> system, turned;
    system.bodies = {{0.5}};
    bodies::State<double> state{0, {0}, {draw(0.02, 0.1)}, {}}, other;
    for (int pin = 1; pin <= 3; ++pin) {
      system.bodies.push_back({draw(5e-4, 2e-3)});
      system.links.push_back({pin, 0, draw(100, 400), draw(0, 0.5)});
      bodies::Contact<double> contact{pin, 0, draw(0.01, 0.05), 0};
      contact.static_limit = contact.kinetic * 1.5;
      if (pin != 2) contact.stiffness = draw(200, 600);
      if (pin == 3) contact.damping = 0.3;
      system.contacts.push_back(contact);
      state.position.push_back(draw(-1e-3, 1e-3));
      state.velocity.push_back(state.velocity[0]);
      state.stretch.push_back(0);
    }
    const auto place = [](int body) { return body == bodies::ground ? body : 3 - body; };
    other = state;
    turned = system;
    for (int body = 0; body < 4; ++body) {
      turned.bodies[place(body)] = system.bodies[body];
      other.position[place(body)] = state.position[body];
      other.velocity[place(body)] = state.velocity[body];
    }
    for (auto& link : turned.links) link.one = place(link.one), link.other = place(link.other);
    for (auto& contact : turned.contacts)
      contact.one = place(contact.one), contact.other = place(contact.other);
    const auto sum = [&](const bodies::State<double>& of) {
      double found = 0;
      for (int body = 0; body < 4; ++body) found += system.bodies[body].mass * of.velocity[body];
      return found;
    };
    Following one(system, state), two(turned, other);
    one.advance(0.1);
    two.advance(0.1);
    refused += one.status() != pd::Status::ok || two.status() != pd::Status::ok;
    momentum = std::max(momentum, std::abs(sum(one.state()) / sum(state) - 1));
    for (int body = 0; body < 4; ++body)
      renamed = std::max(renamed,
                         std::abs(one.state().position[body] - two.state().position[place(body)]));
  }
  std::printf("# momentum within %.1e, positions by other names within %.1e m\n", momentum,
              renamed);
  expect(refused == 0, "a hand and three pins find a mode at each event");
  expect(momentum < 1e-13, "keep their momentum");
  expect(renamed < 1e-14, "and move alike by any names");
}

}  // namespace

int main() {
  single_pins();
  a_block_on_a_board();
  a_pin_that_the_finger_holds();
  pins_that_share_a_hand();
  return check::status();
}
