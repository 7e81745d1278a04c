// Numbers of steady and irregular motions beside closed forms and samples.
#include "pindrive/motion/steady_numbers.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "check.hpp"
#include "pindrive/events/recurrence.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/steady_since.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

namespace {

struct Simulated {
  pd::Drive<double> drive;
  pd::Inputs<double> inputs;
  std::vector<pd::Segment<double>> segments;
  pd::Outcome<double> outcome;

  Simulated(const pd::Drive<double>& given, const pd::Inputs<double>& release)
      : drive(given),
        inputs(release),
        outcome(pd::simulate(drive, inputs, [&](const auto& s) { segments.push_back(s); })) {}
  pd::Motion<double> motion() const {
    return {drive, inputs, segments.data(), segments.size(), outcome};
  }
};

/// Without friction at the finger the pin oscillates about F/k, grazing the plate's velocity.
void grazing() {
  const Simulated drive({0.01, 100, 0, {0.02, 0.02}, {}}, {0.05, 1.5e-3, 0.05});
  const auto found = pd::steady_numbers(drive.motion());
  expect(near(found.centre / 2e-4, 1, 1e-12) && near(found.amplitude / 5e-4, 1, 1e-12) &&
             near(found.peak_velocity / 0.05, 1, 1e-12) && found.rounds == 1,
         "grazing: centre F/k, amplitude v/omega0, peak velocity v");
}

/// Stick-slip of a mass on a belt with static above kinetic friction.
void stick_slip() {
  const Simulated drive({1, 100, 0, {1, 2}, {}}, {0.1, 0, 0.1});
  const auto motion = drive.motion();
  const auto found = pd::steady_numbers(motion);
  // The slip is an arc about F/k through (S/k, v) of radius A, and the stick goes back at v.
  const double omega = 10, half = 0.01, radius = std::hypot(half, 0.1 / omega);
  const double slip = (2 * std::acos(-1.0) - 2 * std::atan2(0.1 / omega, half)) / omega;
  expect(drive.outcome.end == pd::End::stick_slip && near(found.amplitude / radius, 1, 1e-12) &&
             near(found.centre / 0.01, 1, 1e-12) &&
             near(found.peak_velocity / (radius * omega), 1, 1e-12) &&
             near(found.period / (slip + 2 * half / 0.1), 1, 1e-12) && found.rounds == 1 &&
             found.least_amplitude == found.amplitude,
         "stick-slip: an arc and a line");
  expect(near(pd::steady_since(motion), motion.begin()->begin, 1e-12),
         "it is steady from its first stick on");
}

/// Skin that loses its stretch at each slip, on falling friction: the pin never repeats.
void irregular() {
  constexpr double rigid = std::numeric_limits<double>::infinity();
  const double fast[]{0, 0.05}, slow[]{0, 0.02}, forces[]{0.02, 0.01};
  std::vector<pd::Branch<double>> on_plate(3), on_finger(3);
  const int plate_branches = pd::branches_of(fast, forces, 2, on_plate.data());
  const int finger_branches = pd::branches_of(slow, forces, 2, on_finger.data());
  const Simulated drive({0.5,
                         50,
                         0.01,
                         {0.02, 0.02, rigid, on_plate.data(), plate_branches},
                         {0.02, 0.05, 100, on_finger.data(), finger_branches}},
                        {0.01, 5e-4, 0});
  const auto motion = drive.motion();
  const auto found = pd::steady_numbers(motion);
  expect(drive.outcome.end == pd::End::irregular &&
             drive.segments.size() <
                 std::size_t{3} * pd::detail::irregular_window * pd::detail::irregular_windows,
         "a chaotic motion is irregular after a stated number of events");
  expect(motion.known_until() == drive.outcome.until, "it is known until there");
  std::printf("# end %d, %zu segments, %g to %g m, period %g, %g rounds\n",
              static_cast<int>(drive.outcome.end), drive.segments.size(), found.least_amplitude,
              found.amplitude, found.period, found.rounds);
  double low = 1, high = -1, fastest = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double t =
        drive.outcome.cycle_begin + i / 2e5 * (drive.outcome.until - drive.outcome.cycle_begin);
    const auto at = motion.locate(t, pd::Side::right);
    const double x = motion.value(*at.segment, at.tau, pd::Quantity::position);
    low = std::min(low, x), high = std::max(high, x);
    fastest =
        std::max(fastest, std::abs(motion.value(*at.segment, at.tau, pd::Quantity::velocity)));
  }
  const double period = 2 * std::acos(-1.0) * std::sqrt(0.5 / 150);
  const double swept = (high - low) / (2 * found.amplitude), ran = fastest / found.peak_velocity;
  std::printf("# samples reach %.4f of the range, %.4f of the peak velocity\n", swept, ran);
  // Samples miss the very extremes, and nothing lies beyond these.
  expect(swept > 0.98 && swept <= 1 + 1e-12 && ran > 0.98 && ran <= 1 + 1e-12 &&
             found.least_amplitude > 0 && found.least_amplitude < found.amplitude &&
             found.period > 0.9 * period && found.period < 2 * period && std::isnan(found.rounds) &&
             std::isnan(pd::steady_since(motion)),
         "its amplitude, peak velocity and mean period are those of samples");
}

}  // namespace

int main() {
  grazing();
  stick_slip();
  irregular();
  return check::status();
}
