/// The law of friction: what a contact may do next, the force it carries, how the pin sets out in a
/// mode and whether that mode lasts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/limits.hpp"
#include "pindrive/model.hpp"

namespace pindrive {

/// The pin and the inputs at an instant.
template <class T>
struct State {
  T x, v;
  T skin{0};                       ///< force in an elastic stick, N
  Line<T> plate_velocity, load{};  ///< of the inputs from here on
};

/// Which end of a branch of its friction curve a sliding speed is at.
enum class Bound : signed char { none, lower, upper };

/// What a contact may do next, and where it starts exactly: a sliding speed at an end of its branch,
/// an elastic stick at its stick limit (`upper`).
struct Option {
  Slide slide{Slide::absent};
  Bound at{Bound::none};
  int region{0};
};

struct Options {
  std::array<Option, 3> list;
  int count;
  const Option* begin() const { return list.data(); }
  const Option* end() const { return list.data() + count; }
};

/// A mode that may follow.
struct Candidate {
  Option plate, finger;
  Mode mode() const { return {plate.slide, finger.slide, plate.region, finger.region}; }
};

/// m x'' + c x' + κ (x − x₀) = pull: what acts on a pin that sets out from x₀.
template <class T>
struct Equation {
  T damping, stiffness;
  Line<T> pull;
};

/// How the pin sets out in a mode.
template <class T>
struct Start {
  T acceleration{0};        ///< m/s²
  bool tangential{false};   ///< it is that of a surface
  Path<T> stick_force{};    ///< what the stuck contacts carry together, N …
  std::array<Path<T>, 2> left{};  ///< … and could carry beyond it: forward, backward
};

/// Set-valued friction of a pin between the plate (surface velocity v_p) and the finger (surface
/// velocity 0), as MODEL.md §2–§4 states it. A force in the skin counts like its stretch.
template <class T, class Surface = Contact<T>>
class Friction {
 public:
  explicit Friction(const Drive<T, Surface>& drive) : drive_(drive) {}

  /// The motion of a pin on which the sliding and gripping contacts of a mode act.
  Equation<T> equation(const Mode& mode, const State<T>& s) const {
    Equation<T> sum{drive_.damping,
                    drive_.stiffness,
                    {drive_.mass * s.plate_velocity.rate - drive_.stiffness * s.x, T(0)}};
    add_sliding(sum, drive_.plate, mode.plate, mode.plate_region, s.plate_velocity, s.load);
    if (!Surface::plain && mode.finger == Slide::gripping) {
      sum.stiffness += drive_.finger.stiffness;
      sum.pull.value -= s.skin;
    } else {
      add_sliding(sum, drive_.finger, mode.finger, mode.finger_region, {}, {T(1), T(0)});
    }
    return sum;
  }

  /// Whether no contact gives way or changes its force with the pin's speed: it neither damps nor
  /// stiffens.
  bool constant(const Mode& mode) const {
    return Surface::plain || (mode.finger != Slide::gripping && drive_.plate.regions == 0 &&
                              drive_.finger.regions == 0);
  }

  /// The velocity of the surface that a stuck pin moves with, m/s.
  Line<T> level(const Mode& stuck, const State<T>& s) const {
    return stuck.plate == Slide::stuck ? s.plate_velocity : Line<T>{};
  }

  /// Friction of the plate on the pin along the flow of a mode, N; of two stuck contacts the sum.
  Path<T> plate_force(const Mode& mode, const State<T>& s, const Start<T>& start,
                      const Flow<T>& flow) const {
    if (mode.plate == Slide::stuck) return start.stick_force;
    return sliding_force(drive_.plate, mode.plate, mode.plate_region, flow.velocity,
                         s.plate_velocity, s.load);
  }
  /// Friction of the finger, N, beside it.
  Path<T> finger_force(const Mode& mode, const State<T>& s, const Start<T>& start,
                       const Flow<T>& flow) const {
    if (mode.finger == Slide::stuck && mode.plate != Slide::stuck) return start.stick_force;
    if (Surface::plain || mode.finger != Slide::gripping)
      return sliding_force(drive_.finger, mode.finger, mode.finger_region, flow.velocity, {},
                           {T(1), T(0)});
    Path<T> force = -drive_.finger.stiffness * flow.position;
    force.start = -s.skin;
    return force;
  }

 private:
  /// R = −s (F + c (s u − from)) λ with u = x' − surface, brought to the other side where it acts
  /// on x'.
  static void add_sliding(Equation<T>& sum, const Surface& contact, Slide slide, int index,
                          Line<T> surface, Line<T> load) {
    if (!slides(slide)) return;
    const Region<T> region = contact.region(index);
    const T force = along(slide, region.force - region.slope * region.from);
    sum.pull.value -= force * load.value;
    sum.pull.rate -= force * load.rate;
    if (region.slope == 0) return;
    const T drag = region.slope * load.value;
    sum.damping += drag;
    sum.pull.value += drag * surface.value;
    sum.pull.rate += drag * surface.rate;
  }

  static Path<T> sliding_force(const Surface& contact, Slide slide, int index,
                               const Path<T>& velocity, Line<T> surface, Line<T> load) {
    if (!slides(slide)) return {};
    const Region<T> region = contact.region(index);
    const T constant = -along(slide, region.force - region.slope * region.from);
    const Path<T> force = Line<T>{constant * load.value, constant * load.rate};
    if (region.slope == 0) return force;
    const T drag = region.slope * load.value;
    return force + Line<T>{drag * surface.value, drag * surface.rate} + (-drag) * velocity;
  }

  const Drive<T, Surface>& drive_;
};

/// What the last event reached exactly.
struct Reached {
  Bound plate{Bound::none}, finger{Bound::none};  ///< an end of a sliding contact's branch
  int limit{0};  ///< the side on which a stick force is at its limit
};

/// The choice of the mode that follows at an instant: of the candidates, the first that is
/// consistent. Every guard that is zero decides by its first derivative that is not.
template <class T, class Surface>
class Selection {
 public:
  /// `x_size` is the largest that the position is a sum of, m.
  Selection(const Drive<T, Surface>& drive, const State<T>& state, T x_size, const Mode& before,
            const Reached& reached)
      : drive_(drive),
        s_(state),
        limit_(reached.limit),
        plate_{drive.plate, before.plate, state.plate_velocity, state.load,
               options(drive.plate, before.plate, before.plate_region,
                       state.v - state.plate_velocity.value, reached.plate)},
        finger_{drive.finger, before.finger, {}, {T(1), T(0)},
                options(drive.finger, before.finger, before.finger_region, state.v,
                        reached.finger)},
        inertia_(drive.mass * state.plate_velocity.rate),
        pull_(drive.stiffness * state.x + drive.damping * state.v) {
    using std::abs;
    roundoff_ = rounding<T> * (drive.stiffness * x_size + abs(drive.damping * state.v) +
                               2 * abs(inertia_) + size(plate_) + size(finger_));
  }

  /// False if no candidate is consistent. Preferred is what sticks; of two contacts that cannot both,
  /// the one that held until now, or the plate. `start` says how the pin sets out.
  bool next(Candidate& chosen, Start<T>& start) {
    const bool finger_first = finger_.before == Slide::stuck && plate_.before != Slide::stuck;
    Side &first = finger_first ? finger_ : plate_, &second = finger_first ? plate_ : finger_;
    for (const bool stuck : {true, false})
      for (const Option& one : first.options)
        for (const Option& other : second.options) {
          if ((one.slide == Slide::stuck || other.slide == Slide::stuck) != stuck) continue;
          first.option = &one;
          second.option = &other;
          if (!consistent(start)) continue;
          chosen = {*plate_.option, *finger_.option};
          return true;
        }
    return false;
  }

 private:
  /// A contact, with what it did until now, and a candidate for what it does next.
  struct Side {
    const Surface& contact;
    Slide before;
    Line<T> surface, load;
    Options options;
    const Option* option{nullptr};

    bool stuck() const { return option->slide == Slide::stuck; }
    bool grips() const { return !Surface::plain && option->slide == Slide::gripping; }
    /// Whether the force that it carried until now goes on without a jump.
    bool even(int limit) const {
      const Slide after = option->slide;
      if (before == after) return true;
      if (contact.kinetic != contact.static_limit) return false;
      return before == Slide::stuck ? sign(after) == -limit : before == Slide::gripping;
    }
  };

  /// What a contact may do, the preferred first: to stick, else to go on as it does. `at` is the end
  /// of its branch that its speed has just reached; another speed that is not inside its branch is at
  /// the end of it.
  Options options(const Surface& contact, Slide slide, int region, T u, Bound at) const {
    if (slide == Slide::absent) return {{Option{slide}}, 1};
    const Slide ahead = slide == Slide::forward ? Slide::backward : Slide::forward;  // it crosses
    if (slides(slide)) {
      const Region<T> range = contact.region(region);
      const T speed = along(slide, u);
      if (at == Bound::none)
        at = speed >= range.to ? Bound::upper : speed > range.from ? Bound::none : Bound::lower;
      if (at == Bound::none) return {{Option{slide, at, region}}, 1};
      if (at == Bound::upper)
        return {{Option{slide, at, region}, {slide, Bound::lower, region + 1}}, 2};
      if (region > 0) return {{Option{slide, at, region}, {slide, Bound::upper, region - 1}}, 2};
      slide = contact.rigid() ? Slide::stuck : Slide::gripping;  // with the force that it has
    }
    if (!Surface::plain && slide == Slide::gripping) {
      const int side = s_.skin > 0 ? 1 : -1;
      if (side * s_.skin < contact.static_limit || side * u < 0) return {{Option{slide}}, 1};
      return {{Option{slide, Bound::upper},
               {static_cast<Slide>(side), u == 0 ? Bound::lower : Bound::none}},
              2};
    }
    return {{Option{Slide::stuck}, {ahead, Bound::lower}, {opposite(ahead), Bound::lower}}, 3};
  }

  /// How large the terms are that a contact brings into a sum of forces, N.
  T size(const Side& side) const {
    using std::abs;
    const Option& option = side.options.list[0];
    if (option.slide == Slide::absent) return T(0);
    T sum = side.contact.static_limit;
    if (slides(option.slide) && side.contact.regions > 0)
      sum += abs(sliding(side, option)) + abs(side.contact.region(option.region).slope) *
                                              (abs(s_.v) + abs(side.surface.value));
    return sum * side.load.value;
  }

  /// Friction at a sliding speed, or at the end of the branch where it is: there it is one number,
  /// whichever branch follows.
  T sliding(const Side& side, const Option& option) const {
    if (option.at == Bound::none)
      return side.contact.region(option.region).at(along(option.slide, s_.v - side.surface.value));
    return side.contact.region(option.region + (option.at == Bound::upper ? 1 : 0)).force;
  }

  /// The force of a contact that is not stuck, N, …
  T force(const Side& side) const {
    if (side.grips()) return -s_.skin;
    if (!slides(side.option->slide)) return T(0);
    return -along(side.option->slide, sliding(side, *side.option)) * side.load.value;
  }
  /// … and how fast it changes on a pin of this acceleration. A slope and a changing load do not
  /// come together.
  T force_rate(const Side& side, T acceleration) const {
    if (side.grips()) return -side.contact.stiffness * s_.v;
    if (!slides(side.option->slide)) return T(0);
    const Region<T> region = side.contact.region(side.option->region);
    if (region.slope != 0)
      return -region.slope * side.load.value * (acceleration - side.surface.rate);
    return -along(side.option->slide, region.force) * side.load.rate;
  }

  /// The force that would keep the pin on the surface of a contact, beside what the other does, N.
  T demand(const Side& on, T of_other) const {
    return pull_ - (inertia_ - drive_.mass * on.surface.rate) - of_other;
  }
  struct Rates {
    T rate, size, curvature;  ///< N/s, the same of the terms of the rate, N/s²
  };
  /// How it changes.
  Rates demand_rates(const Side& on, const Side& other) const {
    using std::abs;
    const T a = on.surface.rate, spring = drive_.stiffness * s_.v, damper = drive_.damping * a;
    const T rate = force_rate(other, a);
    const T stiffness = drive_.stiffness + (other.grips() ? other.contact.stiffness : T(0));
    return {spring + damper - rate, abs(spring) + abs(damper) + abs(rate), stiffness * a};
  }

  bool consistent(Start<T>& start) const {
    if (plate_.stuck()) return holds(plate_, finger_, start);
    if (finger_.stuck()) return holds(finger_, plate_, start);
    return sets_out(start);
  }

  /// The side on which a stick force stays exactly at its limit; 0 if forces jump.
  int limit() const {
    return limit_ != 0 && plate_.even(limit_) && finger_.even(limit_) ? limit_ : 0;
  }

  /// A contact, and the other where it sticks too, keeps the pin on its surface.
  bool holds(const Side& on, const Side& other, Start<T>& start) const {
    using std::abs;
    const T apart = on.surface.rate - other.surface.rate;
    if (other.stuck() ? apart != 0 : !goes_inside(other, apart, T(0), T(0))) return false;
    Line<T> most{on.contact.static_limit * on.load.value, on.contact.static_limit * on.load.rate};
    if (other.stuck()) {
      most.value += other.contact.static_limit * other.load.value;
      most.rate += other.contact.static_limit * other.load.rate;
    }
    const T force = demand(on, other.stuck() ? T(0) : this->force(other));
    const int at_limit = limit();
    if (most.value - abs(force) < -roundoff_ && (force < 0 ? -1 : 1) != at_limit) return false;
    const Rates rates = demand_rates(on, other);
    start.acceleration = on.surface.rate;
    start.tangential = false;
    start.stick_force = {force, T(0), T(0), rates.rate, rates.curvature};
    for (const int side : {1, -1}) {
      Path<T>& left = start.left[side > 0 ? 0 : 1];
      left = {most.value - side * force, T(0), T(0), most.rate - side * rates.rate,
              -side * rates.curvature};
      if (left.start > roundoff_ && side != at_limit) continue;
      left.start = T(0);
      if (abs(left.drift) <= rounding<T> * (rates.size + abs(most.rate)) ||
          touches(left.drift, left.curvature, roundoff_))
        left.drift = T(0);
      if ((left.drift != 0 ? left.drift : left.curvature) < 0) return false;
    }
    return true;
  }

  /// No contact sticks. A relative acceleration that is zero is exactly zero: the pin sets out along
  /// with the surface.
  bool sets_out(Start<T>& start) const {
    using std::abs;
    const T of_plate = force(plate_), of_finger = force(finger_);
    start.acceleration = (inertia_ - pull_ + of_plate + of_finger) / drive_.mass;
    start.tangential = false;
    T over_plate{0}, over_finger{0};  // relative accelerations, times the mass
    const auto meets = [&](const Side& side, T own, T other, T& over) {
      if (!level(side)) return;
      over = own - demand(side, other);
      if (start.tangential) return;
      start.tangential = abs(over) <= roundoff_ || (side.before == Slide::stuck && limit() != 0);
      if (start.tangential) start.acceleration = side.surface.rate;
    };
    meets(plate_, of_plate, of_finger, over_plate);
    meets(finger_, of_finger, of_plate, over_finger);
    return leaves(plate_, finger_, over_plate, start) && leaves(finger_, plate_, over_finger, start);
  }

  /// Whether nothing but accelerations tells where a contact goes.
  bool level(const Side& side) const {
    return side.option->at != Bound::none && (!side.grips() || s_.v == 0);
  }

  bool leaves(const Side& side, const Side& other, T over, const Start<T>& start) const {
    using std::abs;
    if (side.option->at == Bound::none) return true;
    if (!level(side)) return goes_inside(side, start.acceleration, T(0), T(0));
    if (!start.tangential) return goes_inside(side, over, T(0), T(0));
    const T apart = start.acceleration - side.surface.rate;
    if (apart != 0) return goes_inside(side, apart, T(0), T(0));
    const Rates rates = demand_rates(side, other);
    const T own = force_rate(side, start.acceleration), jerk = own - rates.rate;
    const bool none = abs(jerk) <= rounding<T> * (rates.size + abs(own));
    return goes_inside(side, T(0), none ? T(0) : jerk, -rates.curvature);
  }

  /// Whether what starts at an end of its range goes, or stays, inside, by the first derivative of
  /// its relative velocity that is not zero. Without any it stays; but it would not slide.
  bool goes_inside(const Side& side, T first, T second, T third) const {
    const Option& option = *side.option;
    if (option.at == Bound::none) return true;
    const T decides = first != 0 ? first : second != 0 ? second : third;
    if (!side.grips()) {
      const int inside = option.at == Bound::lower ? sign(option.slide) : -sign(option.slide);
      return inside * decides > 0 ||
             (decides == 0 && (option.at == Bound::upper || option.region > 0));
    }
    const int inside = s_.skin > 0 ? -1 : 1;
    const T stiffness = side.contact.stiffness;
    if (s_.v == 0) return inside * decides >= 0;
    return inside * s_.v > 0 || touches(stiffness * inside * s_.v, stiffness * inside * decides,
                                        rounding<T> * side.contact.static_limit);
  }

  /// Whether a guard at its zero dips below it by no more than its roundoff.
  static bool touches(T rate, T curvature, T bound) {
    return rate < 0 && rate * rate <= 2 * curvature * bound;
  }

  const Drive<T, Surface>& drive_;
  const State<T>& s_;
  int limit_;
  Side plate_, finger_;
  T inertia_, pull_;  ///< m v_p'; k x + b v, N
  T roundoff_;        ///< forces that differ by less are one, N
};

}  // namespace pindrive
