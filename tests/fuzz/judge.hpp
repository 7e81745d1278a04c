/// Runs a drive and judges its motion by the laws alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <vector>

#include "given.hpp"
#include "laws.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/motion/energy.hpp"

namespace fuzz {

struct Verdict {
  pd::Certificate<double> certificate;
  double mirror{}, cut{};  ///< residuals of the laws between two motions (laws.hpp)
  pd::Status status{};
  std::size_t segments{};
  std::size_t instants{};  ///< segments of zero length
  std::size_t
      changes{};  ///< events at which a contact does something else or passes a point of its curve

  /// True if the motion itself has more events than the limit, and not its computation: it is judged until
  /// there.
  bool beyond_limit() const {
    return status == pd::Status::too_many_events && instants == 0 && 16 * changes > segments;
  }
  bool good() const {
    return (status == pd::Status::ok || beyond_limit()) &&
           certificate.worst() <= largest_residual && mirror == 0 && cut <= largest_residual;
  }
};

/// Verdict of a run before its motion is checked.
inline Verdict seen(const pd::Outcome<double>& outcome,
                    const std::vector<pd::Segment<double>>& segments) {
  const auto count = [&](auto&& is) {
    return static_cast<std::size_t>(std::count_if(segments.begin(), segments.end(), is));
  };
  const auto instants = count([](const auto& s) { return !(s.end > s.begin); });
  const auto* const last = segments.data() + segments.size() - 1;
  const auto changes = count([&](const auto& s) {
    return s.event.any() || (&s != last && !pd::same_mode(s.mode, (&s)[1].mode));
  });
  return {{}, 0, 0, outcome.status, segments.size(), instants, changes};
}

inline Verdict simulated(const Case& c, std::vector<pd::Segment<double>>& segments) {
  const Given given(c);
  return seen(run(given, segments), segments);
}

/// Thoroughly: the ledger of energies is measured too, with every integral and extremum, and the motion is
/// compared with its mirror image and with a motion that is cut in two.
inline Verdict judge(const Case& c, bool thoroughly, std::vector<pd::Segment<double>>& segments) {
  const Given given(c);
  const auto outcome = run(given, segments);
  const pd::Motion<double> motion(given.drive, given.inputs, segments.data(), segments.size(),
                                  outcome);
  Verdict verdict = seen(outcome, segments);
  if (outcome.status != pd::Status::ok && !verdict.beyond_limit()) return verdict;
  pd::Certificate<double>& certificate = verdict.certificate;
  certificate = pd::Certifier<double>(motion, std::min(c.duration, outcome.until)).certify();
  if (!thoroughly || verdict.beyond_limit()) return verdict;
  const auto ledger = pd::energy_ledger(motion, c.duration);
  // A cycle that is approached repeats with a step from its end to its begin (`approach_step`).
  const double repeats =
      outcome.cycles() ? std::max(1.0, (c.duration - outcome.until) / outcome.period) : 1;
  double rest = std::abs(ledger.residual()) / repeats;
  if (rest >
      largest_residual * ledger.scale()) {  // but for the rounding of what a position is a sum of
    const double sum = terms(motion, c.duration)[0];
    rest =
        std::max(rest - 4 * std::numeric_limits<double>::epsilon() * c.stiffness * sum * sum, 0.0);
  }
  if (!(rest <= certificate.energy * ledger.scale()))
    certificate.energy = rest < never ? rest / ledger.scale() : never;
  verdict.mirror = mirror_residual(motion, c);
  verdict.cut = cut_residual(motion, c);
  return verdict;
}

inline void print(const char* name, const Verdict& verdict) {
  const auto& r = verdict.certificate;
  std::printf(
      "%s: status %d, %zu segments; law %.1e kinematics %.1e friction %.1e bound %.1e "
      "sign %.1e sticking %.1e continuity %.1e transitions %.1e energy %.1e dissipation %.1e "
      "period %.1e steady since %.1e mirror %.1e cut %.1e\n",
      name, static_cast<int>(verdict.status), verdict.segments, r.motion_law, r.kinematics,
      r.friction_law, r.force_bound, r.sliding_sign, r.sticking, r.continuity, r.transitions,
      r.energy, r.dissipation, r.period, r.steady_since, verdict.mirror, verdict.cut);
}

}  // namespace fuzz
