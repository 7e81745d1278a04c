// The numbers of a free decay, against its closed form: (13) to (19) of the paper, corrected.
#include "pindrive/motion/transient.hpp"

#include <vector>

#include "../fuzz/draw.hpp"
#include "../fuzz/judge.hpp"
#include "check.hpp"
#include "pindrive/motion/duration.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

int main() {
  constexpr double never = std::numeric_limits<double>::infinity();
  // Released in motion from 1 mm, about 0.
  const double v = 0.1;
  const pd::Drive<double> drive{0.01, 100, 0.4, {}, {}};
  const pd::Inputs<double> inputs{v, 1e-3, v};
  pd::Segment<double> segment{};
  segment.end = never;
  segment.mode = {pd::ContactState::absent, pd::ContactState::absent};
  const pd::Oscillator<double> o(drive.mass, drive.damping, drive.stiffness);
  segment.flow = pd::Flow<double>::free(o, 1e-3, v, (-0.4 * v - 100 * 1e-3) / 0.01, 1e-3, 0.0);
  pd::Outcome<double> outcome;
  outcome.end = pd::End::decaying;
  outcome.until = segment.end;
  const pd::Motion<double> motion(drive, inputs, &segment, 1, outcome);

  const auto t = pd::Measurement<double>(motion, never).transient(0.05);
  const double alpha = o.alpha(), omega = o.omega();
  const double peak = std::atan2(v * omega, 1e4 * 1e-3 - alpha * v) / omega;  // where x' is zero
  const auto x = [&](double tau) { return segment.flow.position.at(o, tau); };
  expect(near(t.peak_time, peak, 1e-13) && near(t.peak_displacement, x(peak), 1e-15),
         "the peak is where the velocity is first zero");
  expect(near(t.trough_time, peak + o.half_period(), 1e-13), "the trough half a period later");
  expect(near(1e3 * t.swing, 1e3 * x(peak) * (1 + std::exp(alpha * o.half_period())), 1e-12),
         "the swing is theirs");
  expect(t.return_velocity < 0 && t.return_velocity_time > t.peak_time &&
             t.return_velocity_time < t.trough_time &&
             std::abs(segment.flow.acceleration().at(o, t.return_velocity_time)) < 1e-10,
         "the return velocity is extreme between them");
  expect(t.end_position == 0 && t.rest_time == never && t.last_event_time == 0,
         "a decay ends at its centre, without rest and without events");
  expect(near(std::abs(x(t.settling_time)), 0.05e-3, 1e-15), "it settles where the band begins");
  expect(t.settling_time == pd::Measurement<double>(motion, never).settling_time(0.05),
         "... which can be asked for alone");
  expect(std::isnan(t.first_reversal_time) && std::isnan(t.steady.amplitude),
         "what does not happen is not a number");

  const double duration = pd::duration_of(motion, 0.05);
  expect(duration >= t.settling_time && std::abs(x(duration)) < 1e-3 * 1.5e-3,
         "without a duration it is followed until a thousandth is left");

  // A pin that turns where a segment ends turns once: peak and trough are two instants.
  std::vector<pd::Segment<double>> segments;
  bool apart = true;
  for (const int number : {336, 694, 1761, 2279, 2305}) {
    const fuzz::Case c = fuzz::Draw(1, number, fuzz::Family::aligned).next();
    const fuzz::Given given(c);
    const auto ended = fuzz::run(given, segments);
    const pd::Motion<double> drawn(given.drive, given.inputs, segments.data(), segments.size(),
                                   ended);
    const auto numbers = pd::Measurement<double>(drawn, c.duration).transient(0.02);
    apart = apart && numbers.peak_time != numbers.trough_time;
  }
  expect(apart, "the trough is not the peak of a pin that turns at an event");
  return check::status();
}
