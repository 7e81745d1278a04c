/// A contact at an instant: what it does, on which surface and under which load.
#pragma once

#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// What a contact may do.
template <class T>
struct TouchOption {
  ContactState state{ContactState::absent};
  Bound at{Bound::none};
  int branch{0};
  T sense{0};  ///< in which it slips: 1, −1 or 0
};

/// The rate of a force, how large the terms of that rate are, as its slope is known to rounding only, and how
/// fast the rate changes while the acceleration is constant.
template <class T>
struct ForceRate {
  T value{0}, size{0}, bend{0};
};

/// A contact at an instant: its surface and its load from here on, and what it does.
template <class T>
struct TouchState {
  explicit TouchState(const Contact<T>& given) : contact(given) {}

  Contact<T> contact;
  Line<T> surface{}, load{T(1), T(0)}, across{};
  TouchOption<T> does{};
  ContactState before{};       ///< what it did until the last event, …
  Bound reached{Bound::none};  ///< … and the end of its branch that its speed came to there
  int count{0};                ///< of its options
  T friction{0};   ///< how large its friction is at its sliding speed under a load of 1, N
  T direction{0};  ///< of an oblique slip, along the axis: u/√(u² + w²)

  static TouchOption<T> slip(T sense, Bound at, int branch = 0) {
    return {sense > 0 ? ContactState::slip_forward : ContactState::slip_backward, at, branch,
            sense};
  }
  bool sliding() const { return slips(does.state); }
  bool elastic() const { return does.state == ContactState::elastic_stick; }
  Branch<T> branch() const { return contact.branch(does.branch); }
  T stick_limit() const { return contact.static_limit * load.value; }  ///< N

 protected:
  ContactState goes_on_{
      ContactState::absent};  ///< what it does unless it comes to an end of its range,
  T sense_{0};                ///< in which direction it slips then,
  int branch_{0};             ///< on which branch,
  Bound at_{Bound::none};     ///< and the end of its range that it is at now
  ContactState rest_{ContactState::absent};  ///< how it can stick, or absent
  Bound parts_{Bound::none};                 ///< where it is on its branch if it slips from there
};

}  // namespace pindrive::detail
