// A contact as Python hands it over.
#pragma once

#include <tuple>
#include <utility>

#include "owned_motion.hpp"

/// Number of the law, friction at rest, Stribeck velocity, exponent, viscous part.
using LawNumbers = std::tuple<double, double, double, double, double>;
/// Kinetic and static friction, stiffness, the rows (speed, force) of the curve, the law, the damping, and the
/// exponent of the load.
using ContactNumbers =
    std::tuple<double, double, double, pindrive::Rows, LawNumbers, double, double>;

inline pindrive::ContactNumbers contact_of(ContactNumbers given) {
  auto& [kinetic, fixed, stiffness, curve, law, damping, load_exponent] = given;
  const auto& [number, breakaway, velocity, exponent, viscous] = law;
  return {kinetic,
          fixed,
          stiffness,
          std::move(curve),
          {number, breakaway, velocity, exponent, viscous},
          damping,
          load_exponent};
}
