/// Oblique slip: axial friction of a plate that also slides in the transverse direction.
#pragma once

#include <cmath>

#include "pindrive/flow/flow.hpp"
#include "pindrive/law/contact_mode.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/input_curves.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Relative acceleration p with which a pin of mass m leaves a plate that begins to slide across
/// with acceleration w'.
///
/// Solves m p + λF p/√(p² + w'²) = pull (N); the left side is monotone, so the root is unique.
template <class T>
T departure_acceleration(T mass, T friction, T across_rate, T pull) {
  const T w = abs(across_rate);
  // Newton in t = p/w', from larger |t|, where the left side is convex.
  T t = pull / (mass * w);
  bool converged = false;  // a dual derivative converges one iteration later
  for (int tries = 0; tries < 200; ++tries) {
    const T root = sqrt(1 + t * t);
    const T missed = mass * w * t + friction * t / root - pull;
    const T move = -missed / (mass * w + friction / (root * root * root));
    const T next = t + move;
    // A change of sign is an overshoot.
    const T kept = next * t < 0 ? t / 64 : next;
    const bool done = converged;
    converged = abs(kept - t) <= root_error<Real<T>> * abs(t);
    t = kept;
    if (done) break;
  }
  return t * w;
}

/// Axial and transverse sliding velocity u and w, linear from this instant on. A branch is linear;
/// its curvature (N s²/m²) counts where a second derivative is asked for.
///
/// On the branch F + S ρ with ρ = √(u² + w²) the axial force is −λ (F d + S u) with d = u/ρ, and u'
/// w − u w' is constant.
template <class T>
struct ObliqueSlip {
  Line<T> u, w;  ///< m/s

  /// Derivative of ρ²/2, m²/s³; positive if the sliding speed grows.
  T closing() const { return u.value * u.rate + w.value * w.rate; }
  /// Second derivative of ρ²/2 with the second derivatives of u and w, where the first derivative
  /// is zero within its error.
  T parting(T jerk, T across) const {
    return u.rate * u.rate + w.rate * w.rate + u.value * jerk + w.value * across;
  }
  /// Error of the derivative of ρ²/2, for a surface with this velocity.
  T rounding_of(T surface) const { return rounding<T> * speed() * (speed() + abs(surface)); }
  /// Decrease of the force with the axial velocity, N s/m.
  T steepness(const Branch<T>& branch, const Curve<T>& load) const {
    const T r = speed(), across = r > 0 ? w.value / r : T(0);
    return load.value * ((r > 0 ? branch.intercept() * across * across / r : T(0)) + branch.slope);
  }
  T force_rate(const Branch<T>& branch, const Curve<T>& load) const {
    const T strength = branch.intercept();
    return -load.rate * (strength * along() + branch.slope * u.value) -
           load.value * (strength * turning() + branch.slope * u.rate);
  }
  T force_second_rate(const Branch<T>& branch, T curvature, const Curve<T>& load) const {
    const T strength = branch.intercept();
    const T bend = curvature == 0 ? T(0) : curvature * faster() * faster() * along() * load.value;
    return -2 * load.rate * (strength * turning() + branch.slope * u.rate) -
           load.value * strength * turning_rate() - bend;
  }

 private:
  T speed() const { return hypot(u.value, w.value); }
  /// Rate of the sliding speed ρ.
  T faster() const { return speed() > 0 ? closing() / speed() : hypot(u.rate, w.rate); }
  T along() const { return speed() > 0 ? u.value / speed() : u.rate / hypot(u.rate, w.rate); }
  T turn() const { return u.rate * w.value - u.value * w.rate; }
  /// First derivative of d; zero at zero speed.
  T turning() const {
    const T r = speed();
    return r > 0 ? turn() * w.value / (r * r * r) : T(0);
  }
  T turning_rate() const {
    const T r = speed();
    return r > 0 ? turn() * (w.rate - 3 * w.value * closing() / (r * r)) / (r * r * r) : T(0);
  }
};

/// Enumerates the candidates of an oblique slip. Returns false if the plate does not slide across;
/// the contact then slips along the axis or may stick.
///
/// `guard` is the active guard: the end of the branch that the sliding speed has just reached, or
/// none.
template <class Point, class T>
bool enumerate_oblique_candidates(Point& side, T u, ActiveGuard& guard) {
  const auto& contact = side.contact;
  if (!slides_obliquely(side.load, side.across)) {
    if (!side.oblique()) return false;
    guard = ActiveGuard::none;  // the old guard belongs to another speed
    side.mode = {ContactState::stick, ActiveGuard::none, 0, T(0)};
    if (u != 0)
      side.mode = ContactMode<T>::slip(u < 0 ? T(-1) : T(1), ActiveGuard::none,
                                       contact.branch_of(u < 0 ? -u : u));
    return false;
  }
  if (!contact.present()) return false;
  const T speed = hypot(u, side.across.value);
  if (!side.oblique()) {
    guard = ActiveGuard::none;
    side.mode = {ContactState::slip_oblique, ActiveGuard::none, contact.branch_of(speed), T(0)};
  }
  const Branch<T> range = side.branch();
  if (guard == ActiveGuard::none && speed >= range.to) guard = ActiveGuard::upper;
  if (guard == ActiveGuard::none && !(speed > range.from || side.mode.branch == 0))
    guard = ActiveGuard::lower;
  side.start.friction = range.at(speed);
  const T rate = side.surface.rate;
  side.direction = speed > 0 ? u / speed : -rate / hypot(rate, side.across.rate);
  side.add_branches(guard);
  return true;
}

/// Relative acceleration with which a pin leaves a plate that begins to slide across; sets the
/// sliding direction. `pull` is the sum of all further forces, N.
template <class T, class Point>
T oblique_departure(T mass, Point& plate, T pull) {
  const T rest = pull - mass * plate.surface.rate;
  const T p = departure_acceleration(mass, plate.load.value * plate.start.friction,
                                     plate.across.rate, rest);
  plate.direction = p / hypot(p, plate.across.rate);
  return p;
}

/// Ends an oblique slip at zero transverse velocity: a pin that has the velocity of the plate
/// within the errors of both gets it exactly.
template <class T, class Point>
void end_oblique_slip(State<T>& state, Point& plate, bool on_finger, T across, T mass, T time) {
  if (!plate.oblique() || plate.across.value != 0) return;
  const T changes = plate.load.value * plate.start.friction / mass + abs(plate.surface.rate);
  const T crept = abs(across) + rounding<T> * (abs(state.v) + abs(plate.surface.value)) +
                  difference_error<T> * time * changes;
  if (abs(state.v - plate.surface.value) > crept) return;
  if (on_finger)
    plate.surface.value = state.v;
  else
    state.v = plate.surface.value;
}

}  // namespace pindrive::detail
