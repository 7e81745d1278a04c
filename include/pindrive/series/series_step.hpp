/// Step of a series: polynomials of all quantities, and their truncation errors.
#pragma once

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/series/series_equation.hpp"
#include "pindrive/series/series_inputs.hpp"

namespace pindrive::detail {

/// Step of a mode without a closed form, over the time for which its series holds to rounding.
template <class T>
class SeriesStep {
 public:
  using Real = detail::Real<T>;
  using Path = Polynomial<T>;

  Polynomial<T> position, velocity, skin;
  Polynomial<T> plate_force;        ///< R, N
  Polynomial<T> stick_force;        ///< stick force of the surface that holds the pin, N; else 0
  Polynomial<T> speed;              ///< sliding speed on the plate: s u or √(u² + w²), m/s
  Polynomial<T> falling_at_finger;  ///< falling part of friction at a load factor of 1, N; >= 0
  /// Truncation errors: bounds of the errors of position, velocity, skin state and sliding speed
  /// over the step.
  Real x_bound{0}, v_bound{0}, skin_bound{0}, speed_bound{0};
  EliminatedPart eliminated{EliminatedPart::none};  ///< eliminated fast transient

  Real span() const { return velocity.span; }
  /// True in creep on an oblique plate.
  bool creeps() const { return eliminated == EliminatedPart::of_friction; }
  SeriesState<T> at(T tau) const { return {position.at(tau), velocity.at(tau), skin.at(tau)}; }
  Polynomial<T> input(const Curve<T>& curve) const { return polynomial_of(curve, span()); }
};

}  // namespace pindrive::detail
