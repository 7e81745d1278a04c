/// Oblique slip: axial friction of a plate that also slides in the transverse direction.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pindrive/flow/flow.hpp"
#include "pindrive/law/contact_mode.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/input_curves.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Motion with which a pin leaves a plate that begins to slide across.
template <class T>
struct Departure {
  T acceleration;  ///< p, relative to the plate, m/s²
  T along;         ///< axial component of the sliding direction
};

/// Departure of a pin of mass m from a plate that begins to slide across with acceleration w'.
///
/// Solves m p + λF p/√(p² + w'²) = pull (N); the left side is monotone, so the root is unique. With w' = 0 friction
/// balances a pull up to λF: the pin then has the acceleration of the plate, and slides in the direction of the pull.
/// `error` is the error of the pull, N.
template <class T>
Departure<T> departure_of(T mass, T friction, T across_rate, T pull, T error = T(0)) {
  const T w = abs(across_rate);
  if (w == 0) {
    const T excess = abs(pull) - friction, side = pull < 0 ? T(-1) : T(1);
    if (excess <= error) return {T(0), excess < 0 ? pull / friction : friction > 0 ? side : T(0)};
    return {side * excess / mass, side};
  }
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
  return {t * w, t / sqrt(1 + t * t)};
}

/// Axial and transverse sliding velocity u and w by their Taylor coefficients at an instant, m/s, m/s², …
///
/// On the branch F + S ρ with ρ = √(u² + w²) the axial force is −λ (F d + S u) with d = u/ρ. Where both begin at
/// order k, d is that of u/τᵏ and w/τᵏ. A branch is linear; its curvature (N s²/m²) counts where a second derivative
/// is asked for.
template <class T>
class ObliqueSlip {
 public:
  using Coefficients = std::array<T, beginning_orders>;

  /// Pin of constant acceleration, with relative velocity and acceleration u and u', on a surface.
  ObliqueSlip(T velocity, T rate, const Curve<T>& surface, const Curve<T>& across)
      : u_(surface.template coefficients<beginning_orders>()),
        w_(across.template coefficients<beginning_orders>()) {
    for (T& each : u_) each = -each;
    u_[0] = velocity;
    u_[1] = rate;
    while (begins_ + 3 < beginning_orders && u_[begins_] == 0 && w_[begins_] == 0) ++begins_;
    size_ = hypot(u(0), w(0));
  }

  /// Derivative of ρ²/2, m²/s³; positive if the sliding speed grows.
  T closing() const { return u_[0] * u_[1] + w_[0] * w_[1]; }
  /// Second derivative of ρ²/2 with the second derivatives of u and w, where the first derivative
  /// is zero within its error.
  T parting(T jerk, T across) const {
    return u_[1] * u_[1] + w_[1] * w_[1] + u_[0] * jerk + w_[0] * across;
  }
  T velocity() const { return u_[0]; }  ///< u, m/s
  /// Error of the derivative of ρ²/2, for a surface with this velocity
  /// (rounding: tests/hard/transverse-speed-peaks-at-a-curve-breakpoint.txt).
  T rounding_of(T surface) const { return rounding<T> * speed() * (speed() + abs(surface)); }
  /// Decrease of the force with the axial velocity, N s/m.
  T steepness(const Branch<T>& branch, const Curve<T>& load) const {
    const T r = speed(), across = r > 0 ? w_[0] / r : T(0);
    return load.value * ((r > 0 ? branch.intercept() * across * across / r : T(0)) + branch.slope);
  }
  /// d: axial component of the sliding direction; 0 without any sliding.
  T along() const { return size_ > 0 ? u(0) / size_ : T(0); }
  T force_rate(const Branch<T>& branch, const Curve<T>& load) const {
    const T strength = branch.intercept();
    return -load.rate * (strength * along() + branch.slope * u_[0]) -
           load.value * (strength * turning() + branch.slope * u_[1]);
  }
  T force_second_rate(const Branch<T>& branch, T curvature, const Curve<T>& load) const {
    const T strength = branch.intercept();
    const T bend = curvature == 0 ? T(0) : curvature * faster() * faster() * along() * load.value;
    return -load.second() * (strength * along() + branch.slope * u_[0]) -
           2 * load.rate * (strength * turning() + branch.slope * u_[1]) -
           load.value * (strength * turning_rate() + 2 * branch.slope * u_[2]) - bend;
  }

 private:
  /// Coefficients of u/τᵏ and w/τᵏ.
  T u(std::size_t n) const { return u_[begins_ + n]; }
  T w(std::size_t n) const { return w_[begins_ + n]; }

  T speed() const { return hypot(u_[0], w_[0]); }
  /// Rate of the sliding speed ρ.
  T faster() const { return speed() > 0 ? closing() / speed() : hypot(u_[1], w_[1]); }
  T turn() const { return u(1) * w(0) - u(0) * w(1); }
  /// First derivative of d.
  T turning() const { return size_ > 0 ? turn() * w(0) / (size_ * size_ * size_) : T(0); }
  T turning_rate() const {
    if (!(size_ > 0)) return T(0);
    const T square = size_ * size_, closing = u(0) * u(1) + w(0) * w(1);
    const T turns = 2 * (u(2) * w(0) - u(0) * w(2));
    return (turns * w(0) + turn() * (w(1) - 3 * w(0) * closing / square)) / (square * size_);
  }

  Coefficients u_, w_;
  std::size_t begins_{0};  ///< k
  T size_;                 ///< of u/τᵏ and w/τᵏ at τ = 0
};

/// Enumerates the candidates of an oblique slip. Returns false if the plate does not slide across;
/// the contact then slips along the axis or may stick.
///
/// `guard` is the active guard: the end of the branch that the sliding speed has just reached, or
/// none.
template <class Point, class T>
[[gnu::noinline]] bool enumerate_oblique_candidates(Point& side, T u, ActiveGuard& guard) {
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
  side.direction = side.oblique_slip(u + side.surface.value, T(0)).along();
  side.add_branches(guard);
  return true;
}

/// Relative acceleration with which a pin leaves a plate that begins to slide across; sets the
/// sliding direction. `pull` is the sum of all further forces, N, and `error` its error.
template <class T, class Point>
T oblique_departure(T mass, Point& plate, T pull, T error = T(0)) {
  const T rest = pull - mass * plate.surface.rate;
  const Departure<T> found =
      departure_of(mass, plate.load.value * plate.start.friction, plate.across.rate, rest, error);
  plate.direction = found.along;
  return found.acceleration;
}

/// Ends an oblique slip at zero transverse velocity: a pin that has the velocity of the plate
/// within the errors of both gets it exactly.
template <class T, class Point>
void end_oblique_slip(State<T>& state, Point& plate, bool on_finger, T across, T mass, T time) {
  if (!plate.oblique() || plate.across.value != 0) return;
  const T changes = plate.load.value * plate.start.friction / mass + abs(plate.surface.rate);
  // rounding: tests/hard/oblique-plate-passes-zero-within-time-resolution.txt and oblique-plate-stops-with-a-slow-pin.txt
  const T crept = abs(across) + rounding<T> * (abs(state.v) + abs(plate.surface.value)) +
                  difference_error<T> * time * changes;
  if (abs(state.v - plate.surface.value) > crept) return;
  if (on_finger)
    plate.surface.value = state.v;
  else
    state.v = plate.surface.value;
}

}  // namespace pindrive::detail
