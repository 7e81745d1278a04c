/// State of a stepper at a time.
#pragma once

#include <limits>

#include "pindrive/law/contact_mode.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive {

/// Complete state of a stepper: one constructed from this state gives identical bits.
template <class T>
struct StepperState {
  T now;                                    ///< s
  T since;                                  ///< time of the last event, s
  T since_error;                            ///< rounding error of that time, s
  detail::State<T> pin;                     ///< pin at that time
  detail::ContactMode<T> plate, finger;     ///< modes of the contacts before
  detail::ActiveGuard at_plate, at_finger;  ///< active guards of the contacts
  int limit;                                ///< side of a stick force at its limit
  StopState stop;                           ///< state of the end stops before
  bool stop_released, stop_met;  ///< the stop force reached zero; the pin reached the stop
  bool struck;                   ///< the pin struck a rigid stop
  Mode before;                   ///< mode before
  Line<T> plate_velocity;        ///< plate velocity from that time on
  /// Inputs as set.
  Held<T> mouse_velocity{}, plate_load{}, across_velocity{}, force{}, finger_load{};
  /// Time at which the inputs are set next at the latest, s.
  T horizon{std::numeric_limits<T>::infinity()};
  Event event{};               ///< transitions of contacts and stops now
  OwnedPiece<T> load_piece{};  ///< plate load, if it is no line

  /// The same state on a clock that begins at a time, s.
  StepperState on_clock_from(const T& begin) const {
    StepperState found = *this;
    found.now -= begin;
    found.since -= begin;
    found.horizon -= begin;
    for (Held<T>* input : {&found.mouse_velocity, &found.plate_load, &found.across_velocity,
                           &found.force, &found.finger_load}) {
      input->since -= begin;
      input->ends -= begin;
    }
    found.load_piece.piece.begin -= begin;
    return found;
  }
};

}  // namespace pindrive
