/// The law of friction at an instant: what each contact may do next and the force that it carries,
/// and the selection of the mode that follows (docs/theory.md, section 4).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/limits.hpp"
#include "pindrive/model.hpp"

namespace pindrive {

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

/// m x'' + c x' + κ (x − x₀) = pull: what acts on a pin that sets out from x₀.
template <class T>
struct Equation {
  T damping, stiffness;
  Line<T> pull;
};

/// Whether a guard at its zero dips below it by no more than its roundoff.
template <class T>
bool touches(T rate, T curvature, T roundoff) {
  return rate < 0 && rate * rate <= 2 * curvature * roundoff;
}

/// A contact at an instant: its surface and its load from here on, what it did until now, what it may
/// do next and, of that, what it does. A force in the skin counts like its stretch.
template <class T, class Surface>
struct Touch {
  struct Option {
    Slide slide{Slide::absent};
    Bound at{Bound::none};
    int region{0};
  };

  const Surface& contact;
  Line<T> surface, load;
  Slide before{};
  Option does{};
  std::array<Option, 3> options{};
  int count{0};

  bool slips() const { return slides(does.slide); }
  bool stuck() const { return does.slide == Slide::stuck; }
  bool grips() const { return !Surface::plain && does.slide == Slide::gripping; }
  /// Whether nothing but its relative acceleration tells where it goes.
  bool rests(T v) const { return does.at != Bound::none && (!grips() || v == 0); }

  /// Sets out what it may do, the preferred first: to stick, else to go on as it does. `reached` is
  /// the end of its branch that its speed has just reached; another speed that is not inside its
  /// branch is at the end of it.
  void ask(Slide slide, int region, Bound reached, const State<T>& s) {
    before = slide;
    const T u = s.v - surface.value;
    const Slide ahead = slide == Slide::forward ? Slide::backward : Slide::forward;  // it crosses
    if (slides(slide)) {
      const Region<T> range = contact.region(region);
      const T speed = along(slide, u);
      const Bound at = reached != Bound::none ? reached
                       : speed >= range.to    ? Bound::upper
                       : speed > range.from   ? Bound::none
                                              : Bound::lower;
      const int step = at == Bound::upper ? 1 : at == Bound::lower ? -1 : 0;
      if (step >= 0 || region > 0) {
        const Bound other = at == Bound::upper ? Bound::lower : Bound::upper;
        options = {Option{slide, at, region}, {slide, other, region + step}};
        count = step == 0 ? 1 : 2;
        return;
      }
      slide = contact.rigid() ? Slide::stuck : Slide::gripping;  // with the force that it has
    }
    count = 1;
    options[0] = {slide, Bound::none, 0};
    if (slide == Slide::stuck) {
      options[1] = {ahead, Bound::lower, 0};
      options[2] = {opposite(ahead), Bound::lower, 0};
      count = 3;
    } else if (!Surface::plain && slide == Slide::gripping) {
      const int side = s.skin > 0 ? 1 : -1;
      if (side * s.skin < contact.static_limit || side * u < 0) return;
      options[0].at = Bound::upper;
      options[1] = {static_cast<Slide>(side), u == 0 ? Bound::lower : Bound::none, 0};
      count = 2;
    }
  }

  /// Kinetic friction at its sliding speed. Where that is at the end of a branch it is one number,
  /// whichever branch follows.
  T kinetic(T v) const {
    if (does.at == Bound::none)
      return contact.region(does.region).at(along(does.slide, v - surface.value));
    return contact.region(does.region + (does.at == Bound::upper ? 1 : 0)).force;
  }
  /// Its force on the pin, unless it sticks, N, …
  T force(const State<T>& s) const {
    if (grips()) return -s.skin;
    return slips() ? -along(does.slide, kinetic(s.v)) * load.value : T(0);
  }
  /// … and how fast it changes on a pin of this acceleration. A slope and a changing load do not come
  /// together.
  T force_rate(T v, T acceleration) const {
    if (grips()) return -contact.stiffness * v;
    if (!slips()) return T(0);
    const Region<T> region = contact.region(does.region);
    return region.slope != 0 ? -region.slope * load.value * (acceleration - surface.rate)
                             : -along(does.slide, region.force) * load.rate;
  }
  /// How large the terms are that it brings into a sum of forces, N.
  T size(T v) const {
    using std::abs;
    if (does.slide == Slide::absent) return T(0);
    T sum = contact.static_limit;
    if (slips() && contact.regions > 0)
      sum +=
          abs(kinetic(v)) + abs(contact.region(does.region).slope) * (abs(v) + abs(surface.value));
    return sum * load.value;
  }

  /// R = −s (F + c (s u − from)) λ with u = x' − surface, brought to the other side where it acts
  /// on x'.
  void add_to(Equation<T>& sum, const State<T>& s) const {
    if (grips()) {
      sum.stiffness += contact.stiffness;
      sum.pull.value -= s.skin;
    }
    if (!slips()) return;
    const Region<T> region = contact.region(does.region);
    const T force = along(does.slide, region.force - region.slope * region.from);
    sum.pull.value -= force * load.value;
    sum.pull.rate -= force * load.rate;
    if (region.slope == 0) return;
    const T drag = region.slope * load.value;
    sum.damping += drag;
    sum.pull.value += drag * surface.value;
    sum.pull.rate += drag * surface.rate;
  }
  /// Its force along a flow, unless it sticks, N.
  Path<T> force_along(const Flow<T>& flow, const State<T>& s) const {
    if (grips()) {
      Path<T> force = -contact.stiffness * flow.position;
      force.start = -s.skin;
      return force;
    }
    if (!slips()) return {};
    const Region<T> region = contact.region(does.region);
    const T constant = -along(does.slide, region.force - region.slope * region.from);
    const Path<T> force = Line<T>{constant * load.value, constant * load.rate};
    if (region.slope == 0) return force;
    const T drag = region.slope * load.value;
    return force + Line<T>{drag * surface.value, drag * surface.rate} + (-drag) * flow.velocity;
  }

  /// Whether the force that it carried until now goes on without a jump, after a stick force has
  /// come to its limit on the given side.
  bool continues(int limit) const {
    if (before == does.slide) return true;
    if (contact.kinetic != contact.static_limit) return false;
    return before == Slide::stuck ? sign(does.slide) == -limit : before == Slide::gripping;
  }

  /// Whether what is at an end of its range goes, or stays, inside, by the first derivative of its
  /// relative velocity that is not zero. Without any it stays; but it would not slip.
  bool goes_inside(const State<T>& s, T first, T second = T(0), T third = T(0)) const {
    if (does.at == Bound::none) return true;
    const T decides = first != 0 ? first : second != 0 ? second : third;
    if (!grips()) {
      const int inside = does.at == Bound::lower ? sign(does.slide) : -sign(does.slide);
      return inside * decides > 0 || (decides == 0 && (does.at == Bound::upper || does.region > 0));
    }
    const int inside = s.skin > 0 ? -1 : 1;
    if (s.v == 0) return inside * decides >= 0;
    return inside * s.v > 0 || touches(contact.stiffness * inside * s.v,
                                       contact.stiffness * inside * decides, s.roundoff);
  }
};

}  // namespace pindrive
