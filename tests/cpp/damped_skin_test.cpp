// Skin with a damper beside its spring: when its slider grips and slips, and how fast it begins.
#include "pindrive/law/damped_skin.hpp"

#include <cmath>
#include <limits>

#include "check.hpp"
#include "pindrive/law/contact_point.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;
using pd::detail::ActiveGuard;

namespace {

using ContactMode = pd::detail::ContactMode<double>;
using ContactPoint = pd::detail::ContactPoint<double>;
using State = pd::detail::State<double>;

constexpr double never = std::numeric_limits<double>::infinity();
/// 0.2 N in slip, 0.3 N at rest, 1000 N/m and 5 N s/m.
const pd::Contact<double> skin{0.2, 0.3, 1000, {}, {}, 5};
/// Falls by 100 N s/m from 0.3 N at rest to 0.2 N at 1 mm/s: faster than 5 N s/m make up for.
const pd::Branch<double> falling[] = {{0, 1e-3, 0.3, -100, 0}, {1e-3, never, 0.2, 0, 0}};
const pd::Contact<double> unstable{0.3, 0.3, 1000, falling, 2, 5};
/// Falls by 2 N s/m, which 5 N s/m make up for.
const pd::Branch<double> gentle[] = {{0, 0.02, 0.3, -2, 0}, {0.02, never, 0.26, 0, 0}};
const pd::Contact<double> stable{0.3, 0.3, 1000, gentle, 2, 5};

State at(double v, double tension) { return {1e-3, v, tension, 1e-3, 1e-16}; }

ContactPoint sticking(const pd::Contact<double>& contact) {
  ContactPoint point(contact);
  point.load = {1, 0};
  point.mode = {ContactState::elastic_stick, ActiveGuard::none, 0, 0};
  return point;
}
ContactPoint slipping(const pd::Contact<double>& contact, int branch = 0) {
  ContactPoint point(contact);
  point.load = {1, 0};
  point.mode = ContactMode::slip(1, ActiveGuard::none, branch);
  return point;
}

void grips() {
  ContactPoint point = sticking(skin);
  point.enumerate_candidates(at(0.1, -0.25));
  expect(
      point.candidates.size() == 1 && point.candidates[0].mode.state == ContactState::elastic_stick,
      "within its limit skin grips");
  expect(near(point.force(at(0.1, -0.25)), 0.25, 1e-15), "with all of its force");
  const auto law = point.force_law(at(0.1, -0.25));
  expect(law.drag == 5 && law.stiffness == 1000 && near(law.constant.value, 0.75, 1e-15),
         "... of which the damper's follows the velocity of the pin");
}

void begins_with_a_speed() {
  ContactPoint point = sticking(skin);
  point.enumerate_candidates(at(0.1, 0.3));
  expect(point.candidates.size() == 2, "at its limit it may stick or slip");
  point.choose(1);
  State state = at(0.1, 0.3);
  point.apply_jump(state);
  expect(near(state.slider_velocity, (0.3 - 0.2) / 5, 1e-15),
         "below static friction its slider begins with (S - F)/b");
  expect(near(point.force(state), -0.2, 1e-15), "and the pin feels kinetic friction");
  point.choose(0);
  expect(!point.is_admissible(state, 0), "a pin that moves on does not let it stick");
  expect(point.is_admissible(at(-0.1, 0.3), 0), "one that returns does");
}

void follows_a_jump() {
  State state = at(0, 0.2);
  state.slider_velocity = 0.04;
  ContactPoint point = slipping(skin);
  point.enumerate_candidates(state);
  expect(
      point.candidates.size() == 1 && point.candidates[0].mode.state == ContactState::elastic_stick,
      "a pin that a stop takes to rest lets its skin stick");
  state = at(0.1, 0.7);
  state.slider_velocity = 0.04;
  point = slipping(skin);
  point.enumerate_candidates(state);
  point.choose(0);
  point.apply_jump(state);
  expect(near(state.slider_velocity, 0.1, 1e-15), "one that jumps on takes the slider along");
}

void falls_with_speed() {
  State state = at(0.1, 0.3);
  ContactPoint point = sticking(unstable);
  point.enumerate_candidates(state);
  point.choose(1);
  point.apply_jump(state);
  expect(point.mode.branch == 1 && near(state.slider_velocity, (0.3 - 0.2) / 5, 1e-15),
         "friction that falls faster than the damper rises is passed in a jump");
  state = at(0.1, 0.3);
  point = sticking(stable);
  point.enumerate_candidates(state);
  point.choose(1);
  point.apply_jump(state);
  expect(point.mode.branch == 0 && state.slider_velocity == 0,
         "friction that falls more slowly is followed from rest");
  state = at(0.001, 0.2 + 5e-3);
  state.slider_velocity = 1e-3;
  point = slipping(unstable, 1);
  point.reached_guard = ActiveGuard::lower;
  point.enumerate_candidates(state);
  expect(
      point.candidates.size() == 2 && point.candidates[1].mode.state == ContactState::elastic_stick,
      "a slider that gets too slow for its branch sticks");
}

}  // namespace

int main() {
  grips();
  begins_with_a_speed();
  follows_a_jump();
  falls_with_speed();
  return check::status();
}
