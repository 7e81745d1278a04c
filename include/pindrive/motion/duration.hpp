/// Duration over which the numbers of a motion are measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/motion/transient.hpp"

namespace pindrive {

/// Requested duration or, without one, long enough to see the ending: a decay to a thousandth and
/// settled within the band or the default band, or a few periods of a steady motion.
template <class T>
T duration_of(const Motion<T>& motion, T band, GoOn go_on = {}) {
  using std::isfinite;
  using std::sqrt;
  if (isfinite(motion.inputs().duration)) return motion.inputs().duration;
  constexpr T never = std::numeric_limits<T>::infinity();
  const Outcome<T>& outcome = motion.outcome();
  const T period = T(6.283185307179586) / sqrt(motion.drive().stiffness / motion.drive().mass);
  const T last_begin = std::prev(motion.end())->begin;
  switch (outcome.end) {
    case End::resting:
      return std::max(last_begin * T(1.25), period);
    case End::decaying:
    case End::drifting: {
      const Measurement<T> measured(motion, never, go_on);
      const T settled = measured.settling_time(std::min(band, T(settling_band)));
      const T decayed = measured.decayed() + period;  // infinite where there is nothing to decay
      if (!(decayed < never)) return last_begin + period;
      return settled * T(1.25) > decayed ? settled * T(1.25) : decayed;
    }
    case End::free:
    case End::grazing:
      return last_begin + 3 * outcome.period;
    case End::stick_slip:
    case End::limit_cycle:
    case End::driven:
      return outcome.until + 3 * outcome.period;
    case End::irregular:
    case End::growing:
    case End::approaching:
    case End::moving:
      break;
  }
  return outcome.until;
}

}  // namespace pindrive
