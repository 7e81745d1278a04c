/// The friction of a plate that also slides across, along the axis, at an instant: how it changes from there,
/// and how a pin sets out from the plate and comes to rest on it.
#pragma once

#include <cmath>
#include <limits>

#include "pindrive/flow/flow.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive {

/// Whether a plate of this load, which moves like this across the axis, slides across too and carries something.
template <class T>
bool carries_across(const Line<T>& load, const Line<T>& across) {
  return (across.value != 0 || across.rate != 0) && (load.value != 0 || load.rate != 0);
}

/// The relative acceleration p with which a pin of mass m sets out from a plate that begins to slide across
/// with the acceleration w': m p + λF p/√(p² + w'²) = what else pulls, N. It grows with the pull: one root.
template <class T>
T setting_out(T mass, T friction, T across_rate, T pull) {
  using std::abs;
  using std::sqrt;
  const T w = abs(across_rate);
  // In t = p/w', from above in size: there the left side bends away from its tangent.
  T t = pull / (mass * w);
  bool converged = false;  // the derivative of a dual number does so one round later
  for (int tries = 0; tries < 200; ++tries) {
    const T root = sqrt(1 + t * t);
    const T missed = mass * w * t + friction * t / root - pull;
    const T move = -missed / (mass * w + friction / (root * root * root));
    const T next = t + move;
    // What falls beyond zero has overshot.
    const T kept = next * t < 0 ? t / 64 : next;
    const bool done = converged;
    converged = abs(kept - t) <= 2 * std::numeric_limits<detail::Real<T>>::epsilon() * abs(t);
    t = kept;
    if (done) break;
  }
  return t * w;
}

namespace detail {

/// The sliding velocity along the axis and across, both lines from here on. With the branch F + S ρ,
/// ρ = √(u² + w²), the force is −λ (F d + S u), d = u/ρ; u' w − u w' does not change.
template <class T>
struct ObliqueSlip {
  Line<T> u, w;  ///< m/s

  /// ρ ρ': positive where the plate slides ever faster, …
  T closing() const { return u.value * u.rate + w.value * w.rate; }
  /// … and its rate, where that is zero to rounding, of a pin whose acceleration changes at this rate.
  T parting(T jerk) const { return u.rate * u.rate + w.rate * w.rate + u.value * jerk; }
  /// What ρ²/2 is known to beside a surface of this velocity.
  T rounding_of(T surface) const {
    using std::abs;
    return rounding<T> * speed() * (speed() + abs(surface));
  }
  /// How steeply the force falls with the velocity along the axis, N s/m.
  T steepness(const Branch<T>& branch, const Line<T>& load) const {
    const T r = speed(), across = r > 0 ? w.value / r : T(0);
    return load.value * ((r > 0 ? at_rest(branch) * across * across / r : T(0)) + branch.slope);
  }
  T force_rate(const Branch<T>& branch, const Line<T>& load) const {
    const T strength = at_rest(branch);
    return -load.rate * (strength * along() + branch.slope * u.value) -
           load.value * (strength * turning() + branch.slope * u.rate);
  }
  T force_bend(const Branch<T>& branch, const Line<T>& load) const {
    const T strength = at_rest(branch);
    return -2 * load.rate * (strength * turning() + branch.slope * u.rate) -
           load.value * strength * turning_rate();
  }

 private:
  static T at_rest(const Branch<T>& branch) { return branch.force - branch.slope * branch.from; }
  T speed() const {
    using detail::hypot;
    return hypot(u.value, w.value);
  }
  T along() const {
    using detail::hypot;
    return speed() > 0 ? u.value / speed() : u.rate / hypot(u.rate, w.rate);
  }
  T turn() const { return u.rate * w.value - u.value * w.rate; }
  /// d' and d''; none while it sets out from no speed.
  T turning() const {
    const T r = speed();
    return r > 0 ? turn() * w.value / (r * r * r) : T(0);
  }
  T turning_rate() const {
    const T r = speed();
    return r > 0 ? turn() * (w.rate - 3 * w.value * closing() / (r * r)) / (r * r * r) : T(0);
  }
};

/// Whether a contact of relative velocity u slides across too and carries anything from here on; then it slips on
/// the branch of its speed, and `at` is the end of that which it is at, the one it has just come to or none. Where
/// it no longer does, it slips along the axis, or is asked whether it sticks.
template <class Side, class T>
bool asks_across(Side& side, T u, Bound& at) {
  using detail::hypot;
  const auto& contact = side.contact;
  if (!carries_across(side.load, side.across)) {
    if (!side.oblique()) return false;
    at = Bound::none;  // that of another speed
    side.does = {ContactState::stick, Bound::none, 0, T(0)};
    if (u != 0)
      side.does = Side::slip(u < 0 ? T(-1) : T(1), Bound::none, contact.branch_of(u < 0 ? -u : u));
    return false;
  }
  if (!contact.present()) return false;
  const T speed = hypot(u, side.across.value);
  if (!side.oblique()) {
    at = Bound::none;
    side.does = {ContactState::slip_oblique, Bound::none, contact.branch_of(speed), T(0)};
  }
  const Branch<T> range = side.branch();
  if (at == Bound::none && speed >= range.to) at = Bound::upper;
  if (at == Bound::none && !(speed > range.from || side.does.branch == 0)) at = Bound::lower;
  side.friction = range.at(speed);
  const T rate = side.surface.rate;
  side.direction = speed > 0 ? u / speed : -rate / hypot(rate, side.across.rate);
  if (at == Bound::none) return true;
  side.count = 2;
  side.friction =
      contact.branch(at == Bound::upper ? side.does.branch + 1 : side.does.branch).force;
  return true;
}

/// The relative acceleration with which a pin leaves a plate that begins to slide across, while all else pulls
/// it, N; the plate's direction follows.
template <class T, class Side>
T set_out_across(T mass, Side& plate, T pull) {
  using detail::hypot;
  const T rest = pull - mass * plate.surface.rate;
  const T p = setting_out(mass, plate.load.value * plate.friction, plate.across.rate, rest);
  plate.direction = p / hypot(p, plate.across.rate);
  return p;
}

/// Where a plate stops to slide across, a pin that has come to its velocity has it exactly: to what it was
/// across there, to the rounding of the velocity, or to what friction does in the rounding of the time.
template <class T, class Side>
void land_along_axis(State<T>& state, Side& plate, bool on_finger, T across, T mass, T time) {
  using std::abs;
  if (!plate.oblique() || plate.across.value != 0) return;
  const T changes = plate.load.value * plate.friction / mass + abs(plate.surface.rate);
  const T crept = abs(across) + rounding<T> * (abs(state.v) + abs(plate.surface.value)) +
                  4 * rounding<T> * time * changes;
  if (abs(state.v - plate.surface.value) > crept) return;
  if (on_finger)
    plate.surface.value = state.v;
  else
    state.v = plate.surface.value;
}

}  // namespace detail

}  // namespace pindrive
