/// Inputs of a system from a time on.
#pragma once

#include <vector>

#include "pindrive/bodies/system.hpp"

namespace pindrive::detail {

/// Curves of all inputs at a time, in the order of the parts of the system.
template <class T>
struct InputsAt {
  std::vector<Curve<T>> force, length, load, surface, reference;

  void read(const bodies::System<T>& system, const T& time) {
    const auto fill = [&](std::vector<Curve<T>>& curves, const auto& parts, auto input) {
      curves.resize(parts.size());
      for (std::size_t i = 0; i < parts.size(); ++i) curves[i] = (parts[i].*input).from(time);
    };
    fill(force, system.bodies, &bodies::Body<T>::force);
    fill(length, system.links, &bodies::Link<T>::length);
    fill(load, system.contacts, &bodies::Contact<T>::load);
    fill(surface, system.contacts, &bodies::Contact<T>::velocity);
    fill(reference, system.feedbacks, &bodies::Feedback<T>::reference);
  }
  template <class Look>
  void each(Look&& look) const {
    for (const auto* curves : {&force, &length, &load, &surface, &reference})
      for (const Curve<T>& curve : *curves) look(curve);
  }
};

}  // namespace pindrive::detail
