/// Runs a drive and judges its motion by the laws alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "case.hpp"
#include "pindrive/certify.hpp"
#include "pindrive/energy.hpp"
#include "pindrive/simulate.hpp"

namespace fuzz {

namespace pd = pindrive;

inline constexpr double largest_residual = 1e-9;

/// The rows of a curve as branches, as the core makes them.
inline std::vector<pd::Branch<double>> branches(const Rows& rows) {
  std::vector<pd::Branch<double>> all(rows.at.size() + 1);
  const int count = static_cast<int>(rows.at.size());
  all.resize(pd::branches_of(rows.at.data(), rows.value.data(), count, all.data()));
  return all;
}

struct Verdict {
  pd::Certificate<double> certificate;
  pd::Status status{};
  std::size_t segments{};
  std::size_t instants{};  ///< segments of zero length

  bool good() const { return status == pd::Status::ok && certificate.worst() <= largest_residual; }
};

/// A drive and its inputs as the core takes them: they point into the case, which outlives them.
struct Given {
  explicit Given(const Case& c)
      : plate(branches(c.curve[0])),
        finger(branches(c.curve[1])),
        drive{
            c.mass,
            c.stiffness,
            c.damping,
            {c.curve[0].value[0], c.limit[0], never, plate.data(), static_cast<int>(plate.size())},
            {c.curve[1].value[0], c.limit[1], c.skin, finger.data(),
             static_cast<int>(finger.size())}},
        inputs{profile(c.mouse_velocity),
               c.displacement,
               c.velocity,
               c.duration,
               profile(c.plate_load),
               std::numeric_limits<double>::quiet_NaN(),
               profile(c.force),
               profile(c.across),
               profile(c.finger_load)} {}
  Given(const Given&) = delete;
  Given& operator=(const Given&) = delete;

  static pd::Profile<double> profile(const Rows& rows) {
    return rows.at.size() == 1
               ? pd::Profile<double>(rows.value[0])
               : pd::Profile<double>(rows.at.data(), rows.value.data(), rows.at.size());
  }

  std::vector<pd::Branch<double>> plate, finger;
  pd::Drive<double> drive;
  pd::Inputs<double> inputs;
};

/// What is said of a run before it is judged.
inline Verdict seen(const pd::Outcome<double>& outcome,
                    const std::vector<pd::Segment<double>>& segments) {
  const auto instants = std::count_if(segments.begin(), segments.end(),
                                      [](const auto& s) { return !(s.end > s.begin); });
  return {{}, outcome.status, segments.size(), static_cast<std::size_t>(instants)};
}

inline pd::Outcome<double> run(const Given& given, std::vector<pd::Segment<double>>& segments) {
  segments.clear();
  return pd::simulate(given.drive, given.inputs,
                      [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
}

inline Verdict simulated(const Case& c, std::vector<pd::Segment<double>>& segments) {
  const Given given(c);
  return seen(run(given, segments), segments);
}

/// With its numbers: the ledger of energies is measured too, with every integral and extremum.
inline Verdict judge(const Case& c, bool measured, std::vector<pd::Segment<double>>& segments) {
  const Given given(c);
  const auto outcome = run(given, segments);
  const pd::Motion<double> motion(given.drive, given.inputs, segments.data(), segments.size(),
                                  outcome);
  Verdict verdict = seen(outcome, segments);
  if (outcome.status != pd::Status::ok) return verdict;
  pd::Certificate<double>& certificate = verdict.certificate;
  certificate = pd::Certifier<double>(motion, c.duration).certify();
  if (!measured) return verdict;
  const auto ledger = pd::energy_ledger(motion, c.duration);
  const double rest = std::abs(ledger.residual());
  if (!(rest <= certificate.energy * ledger.scale()))
    certificate.energy = rest < never ? rest / ledger.scale() : never;
  return verdict;
}

inline void print(const char* name, const Verdict& verdict) {
  const auto& r = verdict.certificate;
  std::printf(
      "%s: status %d, %zu segments; law %.1e kinematics %.1e friction %.1e bound %.1e "
      "sign %.1e sticking %.1e continuity %.1e transitions %.1e energy %.1e dissipation %.1e\n",
      name, static_cast<int>(verdict.status), verdict.segments, r.motion_law, r.kinematics,
      r.friction_law, r.force_bound, r.sliding_sign, r.sticking, r.continuity, r.transitions,
      r.energy, r.dissipation);
}

}  // namespace fuzz
