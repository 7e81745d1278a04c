/// One motion, by a simulation that carries no more than its drive and its inputs need.
#pragma once

#include <cmath>

#include "pindrive/model.hpp"
#include "pindrive/simulation.hpp"

namespace pindrive {

/// Follows one pin and hands each segment to the sink, in order of time; a sink may return false to stop.
template <class T, class Sink>
Outcome<T> simulate(const Drive<T>& drive, const Inputs<T>& inputs, Sink&& sink) {
  const auto plain = [](const Contact<T>& contact) {
    return contact.branches == 0 && (contact.rigid() || !contact.present());
  };
  using std::isnan;
  if (!plain(drive.plate) || !plain(drive.finger) || !inputs.mouse_velocity.constant() ||
      !inputs.plate_load.constant() || !isnan(inputs.skin_stretch) || !inputs.force.constant() ||
      inputs.force.first() != 0 || !inputs.across_velocity.constant() ||
      inputs.across_velocity.first() != 0 || !inputs.finger_load.constant())
    return detail::Simulation<T>(drive, inputs).run(sink);
  // The usual case, with nothing in it of what it does not need.
  const auto coulomb = [](const Contact<T>& contact, T load) {
    return Coulomb<T>{contact.kinetic * load, contact.static_limit * load};
  };
  const auto constant = [](const Profile<T>& input) { return Constant<T>{input.first()}; };
  const Drive<T, Coulomb<T>> slim{drive.mass, drive.stiffness, drive.damping,
                                  coulomb(drive.plate, T(1)),
                                  coulomb(drive.finger, inputs.finger_load.first())};
  const Inputs<T, Constant<T>> steady{constant(inputs.mouse_velocity), inputs.displacement,
                                      inputs.velocity, inputs.duration,
                                      constant(inputs.plate_load)};
  detail::Simulation<T, Coulomb<T>, Constant<T>> simulation(slim, steady);
  return simulation.run(sink);  // NOLINT(clang-analyzer-core.StackAddressEscape): a value
}

}  // namespace pindrive
