// Endings: modes that last for ever, states that close a cycle, and the time from which a motion repeats.
#include "pindrive/events/recurrence.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using pd::ContactState;
using pd::End;

namespace {

using Flow = pd::Flow<double>;

pd::Outcome<double> ending(const Flow& flow, ContactState plate = ContactState::slip_backward,
                           double plate_velocity = 0.1) {
  pd::Segment<double> last{};
  last.begin = 2;
  last.mode = {plate, ContactState::absent};
  last.flow = flow;
  last.plate_velocity = {plate_velocity, 0};
  pd::Outcome<double> outcome;
  pd::detail::end_with(last, outcome);
  return outcome;
}

void endings() {
  const pd::Oscillator<double> damped(0.01, 0.2, 100), undamped(0.01, 0, 100);
  expect(ending(Flow::stuck(1e-3, {})).end == End::resting, "at rest on the finger it rests");
  expect(ending(Flow::stuck(1e-3, {0.1, 0})).end == End::drifting, "with the plate it drifts");
  expect(ending(Flow::stuck(1e-3, {0.1, 1})).end == End::moving,
         "a plate that accelerates leaves it no ending");
  expect(ending(Flow::free(damped, 1e-3, 0.0, -1.0, 1e-4, 0.0)).end == End::decaying,
         "a damped vibration decays");
  expect(ending(Flow::free(damped, 1e-3, 0.0, -1.0, 1e-4, 0.02)).end == End::drifting,
         "... about a line it drifts");
  const auto free = ending(Flow::free(undamped, 1e-3, 0.0, -1.0, 1e-4, 0.0));
  expect(free.end == End::free && check::near(free.period, 0.0628318530717958648, 1e-14),
         "one without damping is free");
  expect(ending(Flow::free(undamped, 1e-3, 0.1, 0.0, 0.0, 0.0)).end == End::grazing,
         "... or grazes the velocity of the plate that it left along with it");
}

/// Releases from the plate every 0.5 s, at x = 1 + offset·q^n mm; from a round on at 1 mm.
int rounds_until_cycle(double offset, double q, int steady_from = 3000) {
  const pd::Drive<double> drive{0.01, 100, 0, {0.1, 0.2}, {}};
  pd::detail::CycleDetector<double> cycles(drive);
  pd::Outcome<double> outcome;
  for (int i = 0; i < 3000; ++i, offset *= q) {
    if (i == steady_from) offset = 0;
    pd::Segment<double> carried{};
    carried.begin = 0.5 * i;
    carried.end = 0.5 * i + 0.2;
    carried.flow.position.value = 1e-3, carried.flow.velocity.value = 0.1;  // it moves
    carried.mode = {ContactState::stick, ContactState::absent};
    const pd::Mode after{ContactState::slip_backward, ContactState::absent};
    cycles.visit(carried, after, carried.end, 0, {1e-3 * (1 + offset), 0.1, 0, 1e-3, 0}, outcome);
    if (!outcome.cycles()) continue;
    expect(check::near(outcome.period, 0.5 * std::round(outcome.period / 0.5), 1e-12),
           "the period of a cycle is a whole number of rounds");
    return i;
  }
  return -1;
}

void cycles() {
  expect(rounds_until_cycle(0, 1) == 4, "a return to the first kept state closes a cycle");
  expect(rounds_until_cycle(4e-13, -1) == 4 && rounds_until_cycle(6e-13, -1) == 5,
         "states closer than the return tolerance are one");
  expect(rounds_until_cycle(1e-2, 0.5) == 27,
         "a cycle is closed when the next return is within 1e-10");
  expect(rounds_until_cycle(1e-2, 0.95) == 316, "... and all further returns are within 1e-9");
  expect(rounds_until_cycle(1e-9, 1.5) == -1, "states that part close none");
  const int found = rounds_until_cycle(1e-2, -1.001, 1500);
  expect(found > 1500 && found <= 1500 + 33, "a short period that begins late is found soon");
}

}  // namespace

int main() {
  endings();
  cycles();
  return check::status();
}
