// When a motion has settled, against samples: at that time it comes into the band, and it never leaves it again.
#include "pindrive/motion/settling.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

const pd::Inputs<double> inputs{0.0, 1e-3, 0};

/// A pin that decays freely from 1 mm about 0, for a time or for ever.
struct Decay {
  Decay(double ratio, double duration) : drive{0.01, 100, 2 * ratio, {}, {}} {
    segment.end = duration;
    segment.mode = {pd::ContactState::absent, pd::ContactState::absent};
    segment.flow = pd::Flow<double>::free({drive.mass, drive.damping, drive.stiffness}, 1e-3, 0.0,
                                          -10.0, 1e-3, 0.0);
    outcome.end = pd::End::decaying;
    outcome.until = duration;
  }
  pd::Motion<double> motion() const { return {drive, inputs, &segment, 1, outcome}; }
  double x(double t) const { return segment.flow.position.at(segment.flow.oscillator, t); }

  pd::Drive<double> drive;
  pd::Segment<double> segment{};
  pd::Outcome<double> outcome;
};

/// A turning point beyond the band by less than the error of the band counts as within: by rounding, or by what
/// remains of a motion that ends by the rest criterion.
void turns_at_the_edge() {
  Decay decay(0.1, std::numeric_limits<double>::infinity());
  const pd::Flow<double>& flow = decay.segment.flow;
  const double turn = flow.oscillator.zeros(flow.position.slope, flow.velocity.slope).at(1);
  const double edge = std::abs(decay.x(turn)) / 1e-3;
  const auto settled = [&](double band, bool rests) {
    decay.segment.eliminated = rests ? pd::EliminatedPart::motion : pd::EliminatedPart::none;
    const pd::Motion<double> motion = decay.motion();
    return pd::detail::Settling<double>(motion, {}, 1.0).within(band);
  };
  expect(settled(edge * (1 - 1e-15), false) < turn, "a turn beyond the band by rounding is within");
  expect(settled(edge * (1 - 1e-13), false) > turn, "... and by more is not");
  expect(settled(edge * (1 - 1e-9), true) < turn, "a turn beyond by the rest criterion is within");
  expect(settled(edge * (1 - 1e-8), true) > turn, "... and by more is not");
}

/// A vibration about a ramp settles about the ramp as one about a position does.
void about_a_ramp() {
  const double never = std::numeric_limits<double>::infinity();
  for (const double ratio : {0.003, 0.1, 1.0, 3.0}) {
    const Decay decay(ratio, never);
    Decay drifting(ratio, never);
    drifting.outcome.end = pd::End::drifting;
    drifting.segment.flow.position.drift = drifting.segment.flow.velocity.start = 0.7;
    const pd::Motion<double> still = decay.motion(), ramp = drifting.motion();
    const double since = pd::detail::Settling<double>(still, {}, never).within(0.05);
    const double settled = pd::detail::Settling<double>(ramp, {0, 0.7}, never).within(0.05);
    expect(std::abs(settled / since - 1) < 1e-12, "a drift settles about its line");
  }
  Decay undamped(0.0, never);
  undamped.outcome.end = pd::End::drifting;
  const pd::Motion<double> motion = undamped.motion();
  expect(std::isnan(pd::detail::Settling<double>(motion, {}, never).within(0.05)),
         "an undamped vibration never settles");
}

}  // namespace

int main() {
  constexpr double never = std::numeric_limits<double>::infinity();
  bool enters = true, stays = true;
  for (const double ratio : {0.003, 0.1, 0.5, 1.0, 3.0})
    for (const double band : {0.3, 0.05, 0.002}) {
      const Decay decay(ratio, never);
      const pd::Motion<double> motion = decay.motion();
      const double since = pd::detail::Settling<double>(motion, {}, never).within(band);
      const double width = band * 1e-3;
      enters = enters && std::abs(std::abs(decay.x(since)) - width) < 1e-12 * 1e-3;
      for (int i = 1; i < 2000; ++i)
        stays = stays && std::abs(decay.x(since + i * 1e-3 / ratio * 0.3)) <= width;
    }
  expect(enters, "it comes into the band when it has settled");
  expect(stays, "... and stays there");

  turns_at_the_edge();
  about_a_ramp();
  const Decay decay(0.1, never);
  const pd::Motion<double> motion = decay.motion();
  expect(std::isnan(pd::detail::Settling<double>(motion, {}, 0.05).within(0.05)),
         "what settles after the duration has not settled");
  expect(pd::detail::Settling<double>(motion, {}, never).last_outside(2e-3) == 0,
         "what was never outside is settled from the start");
  Decay moving(0.1, 0.02);
  moving.outcome.end = pd::End::moving;
  const pd::Motion<double> cut = moving.motion();
  expect(std::isnan(pd::detail::Settling<double>(cut, {}, never).within(0.05)),
         "a motion whose ending is not known has no settling time");
  return check::status();
}
