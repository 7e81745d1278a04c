/// Certificate of a motion: largest violation of each law.
#pragma once

#include <algorithm>

#include "pindrive/numbers/named_number.hpp"

namespace pindrive {

/// Largest violation of each law, as a fraction of the largest force, velocity, displacement or
/// energy in the motion.
template <class T>
struct Certificate {
  T motion_law{0};  ///< m x'' + b x' + k x = R_plate + R_finger + m v_p'
  /// x' and x'' are the derivatives of x; an elastic stick stretches with the pin
  T kinematics{0};
  T friction_law{0};  ///< a sliding contact carries its kinetic friction
  T force_bound{0};   ///< a stuck contact carries no more than its static friction
  T sliding_sign{0};  ///< friction opposes the sliding; no guard came to zero unseen
  T sticking{0};      ///< a stuck contact does not slide
  T continuity{0};    ///< x and x' do not jump, nor the skin but where it breaks away
  T transitions{0};   ///< a contact slips from rest only where it cannot stick
  T energy{0};        ///< input, stored and dissipated energy balance
  T dissipation{0};   ///< friction and damper take energy, never give
  T period{0};        ///< a steady motion repeats: difference of x beyond 2 `repeat_tolerance`
  T steady_since{0};  ///< the steady motion does not begin earlier: delay in periods, beyond one

  T worst() const {
    return std::max({motion_law, kinematics, friction_law, force_bound, sliding_sign, sticking,
                     continuity, transitions, energy, dissipation, period, steady_since});
  }
};

/// Laws by their names in the table of quantities, after "certificate.".
template <class T>
inline constexpr NamedNumber<T, Certificate<T>> certificate_numbers[] = {
    {"motion_law", [](const Certificate<T>& c) { return c.motion_law; }},
    {"kinematics", [](const Certificate<T>& c) { return c.kinematics; }},
    {"friction_law", [](const Certificate<T>& c) { return c.friction_law; }},
    {"force_bound", [](const Certificate<T>& c) { return c.force_bound; }},
    {"sliding_sign", [](const Certificate<T>& c) { return c.sliding_sign; }},
    {"sticking", [](const Certificate<T>& c) { return c.sticking; }},
    {"continuity", [](const Certificate<T>& c) { return c.continuity; }},
    {"transitions", [](const Certificate<T>& c) { return c.transitions; }},
    {"energy", [](const Certificate<T>& c) { return c.energy; }},
    {"dissipation", [](const Certificate<T>& c) { return c.dissipation; }},
    {"period", [](const Certificate<T>& c) { return c.period; }},
    {"steady_since", [](const Certificate<T>& c) { return c.steady_since; }},
};

}  // namespace pindrive
