/// Mode, surface and load of one contact at an instant.
#pragma once

#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Mode of one contact.
template <class T>
struct ContactMode {
  ContactState state{ContactState::absent};
  ActiveGuard guard{ActiveGuard::none};
  int branch{0};
  T slip_sign{0};  ///< sign of the sliding velocity: 1, −1 or 0
};

/// First and second derivative of a force, N/s and N/s², at constant acceleration.
///
/// `scale` is the magnitude of the terms of the first derivative, from which its error follows.
template <class T>
struct ForceRate {
  T value{0}, scale{0}, second{0};
};

/// Contact with its surface, its load factor and its mode.
template <class T>
struct ContactPointState {
  explicit ContactPointState(const Contact<T>& given) : contact(given) {}

  Contact<T> contact;
  Line<T> surface{}, load{T(1), T(0)}, across{};
  ContactMode<T> mode{};
  ContactState before{};                         ///< state before the last event
  ActiveGuard reached_guard{ActiveGuard::none};  ///< guard that became zero at the last event
  int count{0};                                  ///< number of candidate modes
  T friction{0};   ///< friction at the sliding speed for a load factor of 1, N
  T direction{0};  ///< axial component of the sliding direction of an oblique slip: u/√(u² + w²)

  static ContactMode<T> slip(T slip_sign, ActiveGuard guard, int branch = 0) {
    return {slip_sign > 0 ? ContactState::slip_forward : ContactState::slip_backward, guard, branch,
            slip_sign};
  }
  bool sliding() const { return is_slip(mode.state); }
  bool elastic() const { return mode.state == ContactState::elastic_stick; }
  Branch<T> branch() const { return contact.branch(mode.branch); }
  T stick_limit() const { return contact.static_limit * load.value; }  ///< largest stick force, N

 protected:
  ContactState default_state_{ContactState::absent};  ///< state if no guard is active
  T slip_sign_{0};                                    ///< its slip sign
  int branch_{0};                                     ///< its branch of the friction curve
  ActiveGuard guard_{ActiveGuard::none};              ///< guard that is zero now
  /// stick or elastic_stick if the contact may stick, else absent
  ContactState stick_state_{ContactState::absent};
  /// active guard of a slip that starts from stick
  ActiveGuard departure_guard_{ActiveGuard::none};
};

}  // namespace pindrive::detail
