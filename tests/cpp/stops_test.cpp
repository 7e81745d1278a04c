// The end stops: what they may do next, their force, and how a pin meets and leaves them.
#include "pindrive/law/stops.hpp"

#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::StopState;

namespace {

using State = pd::detail::State<double>;
using Stops = pd::detail::EndStops<double>;

State at(double x, double v) {
  State s{x, v};
  s.position_scale = 1e-3;
  return s;
}

}  // namespace

int main() {
  Stops rigid(pd::Stops<double>{1e-3});
  State s = at(-1e-3, -0.2);
  rigid.initialize(s);
  expect(s.v == 0, "a rigid stop takes the velocity of a pin released towards it");
  rigid.enumerate_candidates(s);
  expect(rigid.count() == 2 && rigid.at_edge(), "there it holds the pin or lets it go");
  rigid.choose(0);
  expect(rigid.is_holding() && rigid.state == StopState::lower && rigid.force(s) == 0,
         "it holds it");
  rigid.choose(1);
  expect(rigid.is_consistent(0, 1, {}) && !rigid.is_consistent(0, -1, {}) &&
             rigid.is_consistent(0, 0, {1, -1}) && rigid.is_consistent(0, 0, {0, 1}) &&
             !rigid.is_consistent(0, 0, {0, -1}),
         "it lets go what moves inwards, by the first derivative that is not zero");

  Stops elastic(pd::Stops<double>{1e-3, 1e4, 2});
  s = at(1.1e-3, -0.1);
  elastic.initialize(s);
  expect(elastic.state == StopState::upper && near(elastic.force(s), -0.8, 1e-12),
         "an elastic one pushes by its depth and its damping");
  s = at(1.1e-3, -0.6);
  Stops slow(pd::Stops<double>{1e-3, 1e4, 2});
  slow.initialize(s);
  expect(slow.state == StopState::beyond_upper && slow.force(s) == 0, "it never pulls");
  elastic.released = true;
  s = at(1.1e-3, -0.5);
  elastic.enumerate_candidates(s);
  elastic.choose(1);
  expect(elastic.state == StopState::beyond_upper && elastic.is_consistent(-0.5, -1, {}) &&
             !elastic.is_consistent(-0.5, 3000, {}),
         "a push that has come to zero ends unless the pin is slowed down enough");
  State met = at(-1.0000001e-3, -0.1);
  Stops below(pd::Stops<double>{1e-3, 1e4, 2});
  expect(!below.snap(met) && met.x == -1e-3, "a pin that has come to its end is exactly there");
  below.enumerate_candidates(met);
  below.choose(0);
  expect(below.is_pushing() && below.force_jumped(), "and meets a force at once, by the damping");

  using pd::detail::change;
  expect(change(StopState::apart, StopState::upper, false) == pd::Transition::stick &&
             change(StopState::apart, StopState::apart, true) == pd::Transition::cross &&
             change(StopState::lower, StopState::beyond_lower, false) == pd::Transition::slip,
         "what happens to a stop");

  // A free pin strikes a rigid one, and swings from there for ever.
  const pd::Drive<double> drive{0.01, 100, 0, {}, {}, {1e-3}};
  std::vector<pd::Segment<double>> segments;
  const auto outcome = pd::simulate(drive, pd::Inputs<double>{0.0, 0, 0.3},
                                    [&](const auto& segment) { segments.push_back(segment); });
  expect(outcome.end == pd::End::moving || segments.size() > 1, "it strikes");
  expect(segments[0].event.stop == pd::Transition::cross &&
             segments[1].flow.position.start == 1e-3 && segments[1].flow.velocity.start == 0,
         "it is at the stop exactly, without velocity");
  return check::status();
}
