/// Pin, contacts and end stops at an instant.
#pragma once

#include <cmath>

#include "pindrive/law/contact_point.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/law/stops.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Pin at an instant, with its contacts, its end stops and the force on it.
template <class T>
struct Pin {
  Pin(const Drive<T>& of, T begin, T x, T v)
      : drive(of),
        time(begin),
        state{x, v, T(0), T(0), T(0)},
        plate(of.plate),
        finger(of.finger),
        stop(of.stops) {
    state.position_scale = abs(x);
  }

  const Drive<T>& drive;
  T time;  ///< s
  State<T> state;
  ContactPoint<T> plate, finger;
  EndStops<T> stop;
  Curve<T> force{};         ///< external force, N
  int stick_limit_side{0};  ///< side of a stick force that has just reached its limit, else 0
  T neglected_force{0};     ///< force that the rest criterion has just neglected, N

  /// Selected mode.
  Mode mode() const {
    return {plate.mode.state, finger.mode.state, plate.mode.branch, finger.mode.branch, stop.state};
  }

  bool held() const { return pindrive::held(drive, mode()); }
  /// Error of the sum of all forces, N.
  T force_error() const { return state.force_error + neglected_force; }

  /// True if a stick force at its limit stays there exactly, because no force jumps.
  bool stays_at_limit() const {
    return stick_limit_side != 0 && plate.is_continuous(stick_limit_side) &&
           finger.is_continuous(stick_limit_side) && !stop.force_jumped();
  }

  /// True if the push of a stop is exactly zero: it has reached zero and no force jumps. A pin at
  /// rest at a rigid stop is not pushed.
  bool no_push() const {
    if (!stop.no_push() || !stop.rigid()) return stop.no_push();
    const auto alike = [&](const ContactPoint<T>& side) {
      const bool rested = side.before == ContactState::stick || side.before == ContactState::absent;
      return side.is_continuous(0) || (rested && abs(side.force(state)) <= state.force_error);
    };
    return alike(plate) && alike(finger);
  }
};

}  // namespace pindrive::detail
