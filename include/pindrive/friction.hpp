/// The law of friction at an instant: what each contact may do next and the force that it carries
/// (docs/theory.md, section 4).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "pindrive/limits.hpp"
#include "pindrive/model.hpp"
#include "pindrive/series_oblique.hpp"

namespace pindrive::detail {

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
    T sense{0};  ///< in which it slips: 1, −1 or 0
  };

  explicit Touch(const Surface& given) : contact(given) {}

  const Surface contact;
  Line<T> surface{}, load{T(1), T(0)}, across{};
  Option does{};
  ContactState before{};       ///< what it did until the last event, …
  Bound reached{Bound::none};  ///< … and the end of its branch that its speed came to there
  std::array<Option, 3> options{};
  int count{0};
  T friction{0};   ///< how large its friction is at its sliding speed under a load of 1, N
  T direction{0};  ///< of an oblique slip, along the axis: u/√(u² + w²)

  static Option slip(T sense, Bound at, int branch = 0) {
    return {sense > 0 ? ContactState::slip_forward : ContactState::slip_backward, at, branch,
            sense};
  }
  bool may_stick() const { return options[0].state == ContactState::stick; }
  bool sliding() const { return slips(does.state); }
  bool stuck() const { return does.state == ContactState::stick; }
  bool elastic() const { return !Surface::plain && does.state == ContactState::elastic_stick; }
  bool oblique() const { return !Surface::plain && does.state == ContactState::slip_oblique; }
  Branch<T> branch() const { return contact.branch(does.branch); }
  /// Whether nothing but its relative acceleration tells where it goes.
  bool rests(T v) const { return does.at != Bound::none && (!elastic() || v == 0) && !oblique(); }

  /// What it does at the start: it slips unless its surface has the velocity of the pin.
  void begin(T v, bool stretched) {
    const T u = v - surface.value, size = u < 0 ? -u : u;
    if (!contact.present()) return;
    const bool elastic = !contact.rigid() && (stretched || v == 0);
    does.state = elastic ? ContactState::elastic_stick : ContactState::stick;
    if (!elastic && u != 0) does = slip(u / size, Bound::none, contact.branch_of(size));
  }

  /// Sets out what it may do, the preferred first: to stick, else to go on as it does. A speed that has
  /// reached no bound and is not inside its branch is at the end of it.
  void ask(const State<T>& s) {
    before = does.state;
    count = 1;
    const T u = s.v - surface.value;
    if constexpr (!Surface::plain)
      if (asks_across(*this, u)) return;
    if (sliding()) {
      const Branch<T> range = branch();
      const T speed = does.sense * u;
      does.at = reached != Bound::none ? reached
                : speed >= range.to    ? Bound::upper
                : speed > range.from   ? Bound::none
                                       : Bound::lower;
      reached = Bound::none;
      options[0] = does;
      if (does.at == Bound::none) {
        friction = range.at(speed);
        return;
      }
      if (does.at == Bound::upper || does.branch > 0) {
        const bool faster = does.at == Bound::upper;
        options[1] = {before, faster ? Bound::lower : Bound::upper, does.branch + (faster ? 1 : -1),
                      does.sense};
        count = 2;
        // At a breakpoint it is one number, whichever branch follows.
        friction = contact.branch(std::max(does.branch, options[1].branch)).force;
        return;
      }
    }
    friction = contact.branch(0).force;
    // A compliant contact sticks with the force that it has.
    if (sliding()) does.state = contact.rigid() ? ContactState::stick : ContactState::elastic_stick;
    const T across = does.sense > 0 ? T(-1) : T(1);
    does = options[0] = {does.state, Bound::none, 0, T(0)};
    if (does.state == ContactState::stick) {
      options[1] = slip(across, Bound::lower);
      options[2] = slip(-across, Bound::lower);
      count = 3;
    } else if (elastic()) {
      const T side = s.skin > 0 ? T(1) : T(-1);
      if (side * s.skin < contact.static_limit || side * u < 0) return;
      does.at = options[0].at = Bound::upper;
      options[1] = slip(side, u == 0 ? Bound::lower : Bound::none);
      count = 2;
    }
  }

  /// Its force on the pin, unless it sticks, N, …
  T force(const State<T>& s) const {
    return elastic() ? -s.skin : -(oblique() ? direction : does.sense) * friction * load.value;
  }
  /// … and how fast it changes on a pin of this acceleration, …
  T force_rate(T v, T acceleration) const {
    if (elastic()) return -contact.stiffness * v;
    if (!sliding()) return T(0);
    if (oblique()) return slides(v, acceleration).force_rate(branch(), load);
    const T slope = branch().slope;
    if (slope == 0) return -does.sense * branch().force * load.rate;
    const T by_speed = -slope * load.value * (acceleration - surface.rate);
    return load.rate == 0 ? by_speed : by_speed - does.sense * friction * load.rate;
  }
  /// … and how fast that changes while the acceleration is constant.
  T force_bend(T v, T acceleration) const {
    if (oblique()) return slides(v, acceleration).force_bend(branch(), load);
    if (Surface::plain || !sliding() || load.rate == 0) return T(0);
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
    return (contact.static_limit + rounded) * load.value + friction * load.value;
  }

  /// Its force in its mode, unless it sticks: where it slips, −s (F + c (s u − from)) λ, u = x' − surface.
  Force<T> law(const State<T>& s) const {
    if (elastic()) return {{-s.skin, T(0)}, T(0), contact.stiffness, T(0)};
    if (!sliding()) return {};
    const Branch<T> range = branch();
    const T force = -does.sense * (range.force - range.slope * range.from);
    const T drag = range.slope * load.value;
    return {{force * load.value + drag * surface.value, force * load.rate + drag * surface.rate},
            drag,
            T(0),
            range.rounding * load.value};
  }

  /// Whether its force goes on without a jump after a stick force has come to its limit on a side.
  bool continues(int limit) const {
    if (before == does.state) return true;
    if (contact.kinetic != contact.static_limit) return false;
    return before == ContactState::stick ? does.sense == -limit
                                         : before == ContactState::elastic_stick;
  }

  /// Whether what is at an end of its range goes, or stays, inside, by the first derivative of its
  /// relative velocity that is not zero. Without any it stays; but it would not slip.
  bool goes_inside(const State<T>& s, T first, T second = T(0), T third = T(0)) const {
    if (does.at == Bound::none) return true;
    if (oblique()) {
      const T faster = slides(s.v, surface.rate + first).closing();
      return (does.at == Bound::lower ? faster : -faster) >= 0;
    }
    const T decides = first != 0 ? first : second != 0 ? second : third;
    if (!elastic()) {
      const T inwards = does.sense * (does.at == Bound::lower ? decides : -decides);
      return inwards > 0 || (inwards == 0 && (does.at == Bound::upper || does.branch > 0));
    }
    const T inside = s.skin > 0 ? T(-1) : T(1);
    if (s.v == 0) return inside * decides >= 0;
    return inside * s.v > 0 || touches(contact.stiffness * inside * s.v,
                                       contact.stiffness * inside * decides, s.roundoff);
  }

  ObliqueSlip<T> slides(T v, T acceleration) const {
    return {{v - surface.value, acceleration - surface.rate}, across};
  }
};

}  // namespace pindrive::detail
