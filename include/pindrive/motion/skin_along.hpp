/// Stretch and slider of a compliant finger along a trajectory.
#pragma once

#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// True if the skin has a damper that is part of the finger force, and a slider of its own.
template <class T>
bool has_damped_skin(const Drive<T>& drive, const Segment<T>& segment) {
  return drive.finger.damped() && segment.mode.finger != ContactState::absent;
}

/// Rate at which the skin stretches, m/s.
template <class T, class Trajectory>
auto stretch_rate_along(const Drive<T>& drive, const Segment<T>& segment, const Trajectory& along) {
  if (!has_damped_skin(drive, segment))
    return -1 / drive.finger.stiffness * along.derivative(along.finger_force());
  const auto slides = T(is_slip(segment.mode.finger) ? -1 : 0) * along.slider_velocity();
  return along.velocity() + slides;
}

/// Force on the pin by the stretch of the skin, without its damper, N.
template <class T, class Trajectory>
auto stretch_force_along(const Drive<T>& drive, const Segment<T>& segment,
                         const Trajectory& along) {
  auto force = T(1) * along.finger_force();
  if (has_damped_skin(drive, segment))
    force = force + drive.finger.damping * stretch_rate_along(drive, segment, along);
  return force;
}

/// Sliding velocity of the pin on a compliant finger, m/s: slower than the pin by the stretch rate.
template <class T, class Trajectory>
auto sliding_along(const Drive<T>& drive, const Segment<T>& segment, const Trajectory& along) {
  if (!has_damped_skin(drive, segment))
    return along.velocity() + 1 / drive.finger.stiffness * along.derivative(along.finger_force());
  return T(is_slip(segment.mode.finger) ? 1 : 0) * along.slider_velocity();
}

}  // namespace pindrive::detail
