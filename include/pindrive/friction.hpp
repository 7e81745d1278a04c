/// The law of friction at an instant: what each contact may do next and the force that it carries
/// (docs/theory.md, section 4).
#pragma once

#include <array>
#include <cmath>

#include "pindrive/limits.hpp"
#include "pindrive/model.hpp"

namespace pindrive::detail {

/// Which end of its range a contact is at exactly: of the branch of its friction curve or, an elastic
/// stick at its stick limit, the upper one.
enum class Bound : signed char { none, lower, upper };

/// What the last event reached exactly: a bound by a sliding speed, its limit by a stick force.
struct Reached {
  Bound plate{Bound::none}, finger{Bound::none};
  int limit{0};  ///< the side of that force
};

/// The pin at an instant.
template <class T>
struct State {
  T x, v;         ///< m, m/s
  T skin{0};      ///< force in an elastic stick, N
  T x_size{0};    ///< the largest that the position is a sum of, m
  T roundoff{0};  ///< forces that differ by less are one, N
};

/// Whether a guard at its zero dips below it by no more than its roundoff.
template <class T>
bool touches(T rate, T curvature, T roundoff) {
  return rate < 0 && rate * rate <= 2 * curvature * roundoff;
}

/// A contact at an instant: its surface and its load from here on, what it may do next and, of that,
/// what it does.
template <class T, class Surface>
struct Touch {
  struct Option {
    ContactState state{ContactState::absent};
    Bound at{Bound::none};
    int branch{0};
  };

  const Surface contact;
  Line<T> surface, load;
  ContactState before{};
  std::array<Option, 3> options{};
  int count{0}, chosen{0};

  const Option& does() const { return options[chosen]; }
  bool may_stick() const { return options[0].state == ContactState::stick; }
  bool sliding() const { return slips(does().state); }
  bool stuck() const { return does().state == ContactState::stick; }
  bool elastic() const { return !Surface::plain && does().state == ContactState::elastic_stick; }
  Branch<T> branch() const { return contact.branch(does().branch); }
  /// Whether nothing but its relative acceleration tells where it goes.
  bool rests(T v) const { return does().at != Bound::none && (!elastic() || v == 0); }

  /// Sets out what it may do, the preferred first: to stick, else to go on as it does. `reached` is
  /// the end of its branch that its speed has just reached; another speed that is not inside its
  /// branch is at the end of it.
  void ask(ContactState state, int branch, Bound reached, const State<T>& s) {
    before = state;
    count = 1;
    chosen = 0;
    const T u = s.v - surface.value;
    const auto across = static_cast<ContactState>(state == ContactState::slip_forward ? -1 : 1);
    if (slips(state)) {
      const Branch<T> range = contact.branch(branch);
      const T speed = along(state, u);
      const Bound at = reached != Bound::none ? reached
                       : speed >= range.to    ? Bound::upper
                       : speed > range.from   ? Bound::none
                                              : Bound::lower;
      options[0] = {state, at, branch};
      if (at == Bound::none) return;
      if (at == Bound::upper || branch > 0) {
        options[1] = at == Bound::upper ? Option{state, Bound::lower, branch + 1}
                                        : Option{state, Bound::upper, branch - 1};
        count = 2;
        return;
      }
      // Skin grips with the force that it has.
      state = contact.rigid() ? ContactState::stick : ContactState::elastic_stick;
    }
    options[0] = {state, Bound::none, 0};
    if (state == ContactState::stick) {
      options[1] = {across, Bound::lower, 0};
      options[2] = {opposite(across), Bound::lower, 0};
      count = 3;
    } else if (!Surface::plain && state == ContactState::elastic_stick) {
      const int side = s.skin > 0 ? 1 : -1;
      if (side * s.skin < contact.static_limit || side * u < 0) return;
      options[0].at = Bound::upper;
      options[1] = {static_cast<ContactState>(side), u == 0 ? Bound::lower : Bound::none, 0};
      count = 2;
    }
  }

  /// Kinetic friction at its sliding speed. Where that is at the end of a branch it is one number,
  /// whichever branch follows.
  T kinetic(T v) const {
    if (contact.branches == 0) return contact.kinetic;
    if (does().at == Bound::none) return branch().at(along(does().state, v - surface.value));
    return contact.branch(does().branch + (does().at == Bound::upper ? 1 : 0)).force;
  }
  /// Its force on the pin, unless it sticks, N, …
  T force(const State<T>& s) const {
    if (elastic()) return -s.skin;
    return sliding() ? -along(does().state, kinetic(s.v)) * load.value : T(0);
  }
  /// … and how fast it changes on a pin of this acceleration, …
  T force_rate(T v, T acceleration) const {
    if (elastic()) return -contact.stiffness * v;
    if (!sliding()) return T(0);
    const T slope = branch().slope;
    if (slope == 0) return -along(does().state, branch().force) * load.rate;
    const T by_speed = -slope * load.value * (acceleration - surface.rate);
    return load.rate == 0 ? by_speed : by_speed - along(does().state, kinetic(v)) * load.rate;
  }
  /// … and how fast that changes on one whose acceleration is constant.
  T force_bend(T acceleration) const {
    if (!sliding() || load.rate == 0) return T(0);
    return -2 * branch().slope * load.rate * (acceleration - surface.rate);
  }
  /// How large the terms of that rate are: its slope is known to rounding only.
  T force_rate_size(T rate, T acceleration) const {
    using std::abs;
    if (!sliding() || branch().slope == 0) return abs(rate);
    const T unsure = branch().rounding * load.value * abs(acceleration - surface.rate);
    return abs(rate) + unsure / rounding<T>;
  }
  /// How large the terms are that it brings into a sum of forces, N.
  T size(T v) const {
    using std::abs;
    if (contact.branches == 0 || !sliding()) return contact.static_limit * load.value;
    const T rounded = abs(branch().slope) * (abs(v) + abs(surface.value));
    return (contact.static_limit + abs(kinetic(v)) + rounded) * load.value;
  }

  /// R = −s (F + c (s u − from)) λ with u = x' − surface: without c x', N, and c.
  Line<T> constant_force(T& drag) const {
    const Branch<T> range = branch();
    const T force = -along(does().state, range.force - range.slope * range.from);
    drag = T(0);
    if (range.slope == 0) return {force * load.value, force * load.rate};
    drag = range.slope * load.value;
    return {force * load.value + drag * surface.value, force * load.rate + drag * surface.rate};
  }
  /// Adds its force to m x'' + c x' + κ (x − x₀) = pull, and what is rounding of c to `known`.
  void add_to(T& damping, T& known, T& stiffness, Line<T>& pull, const State<T>& s) const {
    if (elastic()) {
      stiffness += contact.stiffness;
      pull.value -= s.skin;
    } else if (sliding()) {
      T drag;
      const Line<T> force = constant_force(drag);
      pull = {pull.value + force.value, pull.rate + force.rate};
      damping += drag;
      known += branch().rounding * load.value;
    }
  }
  /// Its force along a flow, unless it sticks, N.
  Path<T> force_along(const Flow<T>& flow, const State<T>& s) const {
    if (elastic()) {
      Path<T> force = -contact.stiffness * flow.position;
      force.start = -s.skin;
      return force;
    }
    if (!sliding()) return {};
    T drag;
    const Path<T> force = constant_force(drag);
    return drag != 0 ? force + (-drag) * flow.velocity : force;
  }

  /// Whether the force that it carried until now goes on without a jump, after a stick force has
  /// come to its limit on the given side.
  bool continues(int limit) const {
    if (before == does().state) return true;
    if (contact.kinetic != contact.static_limit) return false;
    return before == ContactState::stick ? sign(does().state) == -limit
                                         : before == ContactState::elastic_stick;
  }

  /// Whether what is at an end of its range goes, or stays, inside, by the first derivative of its
  /// relative velocity that is not zero. Without any it stays; but it would not slip.
  bool goes_inside(const State<T>& s, T first, T second = T(0), T third = T(0)) const {
    if (does().at == Bound::none) return true;
    const T decides = first != 0 ? first : second != 0 ? second : third;
    if (!elastic()) {
      const T inwards = along(does().state, does().at == Bound::lower ? decides : -decides);
      return inwards > 0 || (inwards == 0 && (does().at == Bound::upper || does().branch > 0));
    }
    const T inside = s.skin > 0 ? T(-1) : T(1);
    if (s.v == 0) return inside * decides >= 0;
    return inside * s.v > 0 || touches(contact.stiffness * inside * s.v,
                                       contact.stiffness * inside * decides, s.roundoff);
  }
};

}  // namespace pindrive::detail
