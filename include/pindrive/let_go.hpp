/// Whether contacts that let go had to: what they would have had to carry to stay.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/model.hpp"

namespace pindrive {

/// The instant after an event: the pin, the friction on it and the inputs.
template <class T>
struct Aftermath {
  T x, v, plate_force, finger_force;
  Line<T> plate_velocity;
  T load;
};

/// What contacts that let go, or crossed, could have carried beyond what they would have had to, N;
/// 0 where they could not hold.
template <class T>
T spare_capacity(const Drive<T>& drive, bool plate, bool finger, const Aftermath<T>& now) {
  using std::abs;
  const T w = now.plate_velocity.rate;
  T limit{0}, held = drive.damping * now.v + drive.stiffness * now.x;
  if (plate)
    limit += drive.plate.static_limit * now.load;
  else
    held -= drive.mass * w + now.plate_force;
  if (finger)
    limit += drive.finger.static_limit;
  else
    held -= now.finger_force;
  return std::max(limit - abs(held), T(0));
}

/// The same where both contacts have met a pin at rest and part: it goes with neither only if neither
/// could hold, and with one only if that was to be asked first (it held alone, or is the plate), or
/// the other could not.
template <class T>
T spare_capacity_parting(const Drive<T>& drive, Mode before, Mode after, const Aftermath<T>& now) {
  using std::abs;
  const bool plate_first = before.plate == Slide::stuck || before.finger != Slide::stuck;
  const bool neither = slides(after.plate) && slides(after.finger);
  const T inertia = drive.mass * now.plate_velocity.rate, spring = drive.stiffness * now.x;
  const int side = inertia > 0 ? 1 : -1;
  T spare{0};
  if (neither || (slides(after.plate) && plate_first))
    spare = drive.plate.static_limit * now.load - abs(spring + side * drive.finger.kinetic);
  if (neither || (slides(after.finger) && !plate_first))
    spare = std::max(spare, drive.finger.static_limit -
                                abs(spring - inertia - side * drive.plate.kinetic * now.load));
  return std::max(spare, T(0));
}

}  // namespace pindrive
