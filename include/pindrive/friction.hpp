/// Which mode follows: stick, slip or cross, at one contact or at two that share a level.
#pragma once

#include <cmath>

#include "pindrive/model.hpp"

namespace pindrive {

/// Set-valued Coulomb friction of a pin x between the plate (surface velocity v_p) and the
/// finger (surface velocity 0), as MODEL.md §2–§4 states it.
template <class T>
class Friction {
 public:
  Friction(const Drive<T>& drive, T mouse_velocity)
      : drive_(drive), plate_velocity_(mouse_velocity) {}

  T plate_velocity() const { return plate_velocity_; }

  /// Friction force on the pin from the contacts that slide, N.
  T sliding_force(Mode mode) const {
    return -(sign(mode.plate) * drive_.plate.kinetic + sign(mode.finger) * drive_.finger.kinetic);
  }

  /// The velocity of the surface that a stuck pin moves with, m/s.
  T level(Mode stuck) const { return stuck.plate == Slide::stuck ? plate_velocity_ : T(0); }

  /// The force that the stuck contacts must carry to hold the pin at x, N.
  T needed(Mode stuck, T x) const {
    return drive_.stiffness * x + drive_.damping * level(stuck) - sliding_force(stuck);
  }

  /// The largest force that the stuck contacts can carry together, N.
  T capacity(Mode stuck) const {
    return (stuck.plate == Slide::stuck ? drive_.plate.static_limit : T(0)) +
           (stuck.finger == Slide::stuck ? drive_.finger.static_limit : T(0));
  }

  /// Where a stuck pin needs exactly this force, m.
  T position_needing(Mode stuck, T force) const {
    return (force - drive_.damping * level(stuck) + sliding_force(stuck)) / drive_.stiffness;
  }

  /// Mode of a pin that starts at x, v.
  Mode starting(T x, T v) const {
    const Mode mode{slide(drive_.plate, v - plate_velocity_), slide(drive_.finger, v)};
    if (!mode.stuck()) return mode;
    const T force = needed(mode, x);
    const T limit = capacity(mode);
    return force > limit ? released(mode, -1) : force < -limit ? released(mode, 1) : mode;
  }

  /// Mode of a pin that, sliding, has brought the contacts of `arrived` to their level at x.
  /// It came with a force that pushed it there, so it sticks or crosses; it cannot turn back.
  Mode arriving(Mode sliding, Event arrived, T x) const {
    Mode stuck = sliding;
    if (arrived.plate) stuck.plate = Slide::stuck;
    if (arrived.finger) stuck.finger = Slide::stuck;
    const int side = sign(arrived.plate ? sliding.plate : sliding.finger);
    return side * needed(stuck, x) > capacity(stuck) ? released(stuck, -side) : stuck;
  }

  /// The mode in which the stuck contacts slide to the given side.
  static Mode released(Mode stuck, int side) {
    const auto slide = static_cast<Slide>(side);
    return {stuck.plate == Slide::stuck ? slide : stuck.plate,
            stuck.finger == Slide::stuck ? slide : stuck.finger};
  }

  struct Forces {
    T plate, finger;
  };
  /// Friction force of each contact on the pin at x, N; two stuck contacts share what is needed in
  /// proportion to their static friction.
  Forces forces(Mode mode, T x) const {
    Forces forces{-sign(mode.plate) * drive_.plate.kinetic,
                  -sign(mode.finger) * drive_.finger.kinetic};
    if (!mode.stuck()) return forces;
    const T load = needed(mode, x) / capacity(mode);
    if (mode.plate == Slide::stuck) forces.plate = load * drive_.plate.static_limit;
    if (mode.finger == Slide::stuck) forces.finger = load * drive_.finger.static_limit;
    return forces;
  }

 private:
  static Slide slide(const Contact<T>& contact, T u) {
    if (!contact.present()) return Slide::absent;
    return u > 0 ? Slide::forward : u < 0 ? Slide::backward : Slide::stuck;
  }

  Drive<T> drive_;
  T plate_velocity_;
};

}  // namespace pindrive
