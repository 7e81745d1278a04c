/// Whether contacts that slip from rest had to: what they would have had to carry to stick.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/model.hpp"

namespace pindrive {

/// The instant at which a segment begins: the pin, the friction on it and the inputs, and which
/// rigid contacts it is at rest against, to rounding.
template <class T>
struct Beginning {
  T x, v, plate_force, finger_force;
  Line<T> plate_velocity;
  T plate_load, finger_load, force;
  bool rests_on_plate, rests_on_finger;
  bool plate_began, finger_began;  ///< to do what they do
};

/// What contacts that slip from rest could have carried beyond what they would have had to, N; 0 where
/// they could not stick. Where the law allows several modes none is preferred: a contact that slips
/// while the other sticks is not asked.
template <class T>
T spare_stick_limit(const Drive<T>& drive, const Mode& mode, const Beginning<T>& now) {
  using std::abs;
  const bool plate = now.rests_on_plate && slips(mode.plate);
  const bool finger = now.rests_on_finger && slips(mode.finger);
  if (mode.stuck() || !(plate || finger)) return T(0);
  const T at_plate = drive.plate.static_limit * now.plate_load;
  const T at_finger = drive.finger.static_limit * now.finger_load;
  const T pull = drive.damping * now.v + drive.stiffness * now.x - now.force;
  const T inertia = drive.mass * now.plate_velocity.rate;
  if (plate && finger && inertia == 0) return std::max(at_plate + at_finger - abs(pull), T(0));
  // Each alone. Where both part, the one that does not stick slips the way in which they part.
  const int side = inertia > 0 ? 1 : -1;
  const T of_finger =
      plate && finger ? -side * drive.finger.kinetic * now.finger_load : now.finger_force;
  const T of_plate =
      plate && finger ? side * drive.plate.kinetic * now.plate_load : now.plate_force;
  T spare{0};
  if (plate && now.plate_began) spare = at_plate - abs(pull - of_finger);
  if (finger && now.finger_began)
    spare = std::max(spare, at_finger - abs(pull - inertia - of_plate));
  return std::max(spare, T(0));
}

}  // namespace pindrive
