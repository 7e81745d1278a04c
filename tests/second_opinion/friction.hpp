/// Which mode follows: stick, slip or cross, at one contact or at two that share a level; and the
/// forces of a mode.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "model.hpp"

namespace second_opinion {

/// The inputs from an instant on: the plate's velocity and the factor on its friction.
template <class T>
struct Instant {
  Line<T> plate_velocity, load;
};

/// m x'' + c x' + κ (x − x₀) = pull: what acts on a pin that sets out from x₀.
template <class T>
struct Equation {
  T damping, stiffness;
  Line<T> pull;
  T size;      ///< of all that the pull is the sum of, N
  T rounding;  ///< how well the damping is known, N s/m

  /// What the pull and the damping at a velocity leave, less than this, is rounding, N.
  T blur(T velocity) const {
    using std::abs;
    return 4 * std::numeric_limits<T>::epsilon() * (size + abs(damping * velocity));
  }
};

/// Set-valued friction of a pin between the plate (surface velocity v_p) and the finger (surface
/// velocity 0), as docs/theory.md, 1 and 4, states it. A force in the skin counts like its stretch.
template <class T, class Surface = Contact<T>>
class Friction {
 public:
  explicit Friction(const Drive<T, Surface>& drive) : drive_(drive) {}

  /// The motion of a pin at x whose sliding and gripping contacts act on it.
  Equation<T> equation(const Mode& mode, const Instant<T>& now, T x, T skin_force) const {
    using std::abs;
    const T inertia = drive_.mass * now.plate_velocity.rate, spring = drive_.stiffness * x;
    Equation<T> sum{drive_.damping,
                    drive_.stiffness,
                    {inertia - spring, T(0)},
                    abs(inertia) + abs(spring),
                    2 * std::numeric_limits<T>::epsilon() * drive_.damping};
    add_sliding(sum, drive_.plate, mode.plate, mode.plate_region, now.plate_velocity, now.load);
    if (!Surface::plain && mode.finger == Slide::gripping) {
      sum.stiffness += drive_.finger.stiffness;
      sum.pull.value -= skin_force;
      sum.size += abs(skin_force);
    } else {
      add_sliding(sum, drive_.finger, mode.finger, mode.finger_region, {}, {T(1), T(0)});
    }
    // A damper that falling friction cancels to rounding neither damps nor drives.
    if (abs(sum.damping) <= sum.rounding) sum.damping -= plain(sum.damping);
    return sum;
  }

  /// Whether no contact gives way or changes its force with the pin's speed: it neither damps nor
  /// stiffens.
  bool constant(const Mode& mode) const {
    return Surface::plain || (mode.finger != Slide::gripping && drive_.plate.regions == 0 &&
                              drive_.finger.regions == 0);
  }

  /// The velocity of the surface that a stuck pin moves with, m/s.
  Line<T> level(const Mode& stuck, const Instant<T>& now) const {
    return stuck.plate == Slide::stuck ? now.plate_velocity : Line<T>{};
  }

  /// The largest force that the stuck contacts can carry together, N.
  Line<T> capacity(const Mode& stuck, const Instant<T>& now) const {
    Line<T> sum{};
    if (stuck.plate == Slide::stuck)
      sum = {drive_.plate.static_limit * now.load.value, drive_.plate.static_limit * now.load.rate};
    if (stuck.finger == Slide::stuck) sum.value += drive_.finger.static_limit;
    return sum;
  }

  /// The force that the stuck contacts must carry along a flow, N.
  Path<T> needed(const Equation<T>& equation, const Flow<T>& flow) const {
    Path<T> moved = flow.position;
    moved.start = T(0);
    const Path<T> pull = equation.pull;
    return drive_.mass * flow.acceleration() + equation.damping * flow.velocity +
           equation.stiffness * moved + T(-1) * pull;
  }
  /// The same at the start of a mode, with the velocity and acceleration of a level, N.
  T needed(const Equation<T>& equation, Line<T> level) const {
    return drive_.mass * level.rate + equation.damping * level.value - equation.pull.value;
  }

  /// Friction of the plate on the pin along the flow of a mode, N; of two stuck contacts the sum.
  Path<T> plate_force(const Mode& mode, const Instant<T>& now, const Equation<T>& equation,
                      const Flow<T>& flow) const {
    if (mode.plate == Slide::stuck) return needed(equation, flow);
    return sliding_force(drive_.plate, mode.plate, mode.plate_region, flow.velocity,
                         now.plate_velocity, now.load);
  }
  /// Friction of the finger, N, beside it.
  Path<T> finger_force(const Mode& mode, const Equation<T>& equation, const Flow<T>& flow,
                       T skin_force) const {
    if (mode.finger == Slide::stuck && mode.plate != Slide::stuck) return needed(equation, flow);
    if (Surface::plain || mode.finger != Slide::gripping)
      return sliding_force(drive_.finger, mode.finger, mode.finger_region, flow.velocity, {},
                           {T(1), T(0)});
    Path<T> force = -drive_.finger.stiffness * flow.position;
    force.start = -skin_force;
    return force;
  }

  /// Mode of a pin that starts at x, v, with or without a stretched skin.
  Mode starting(const Instant<T>& now, T x, T v, T skin_force, bool grips) const {
    Mode mode{touch(drive_.plate, v - now.plate_velocity.value), touch(drive_.finger, v)};
    if (drive_.finger.present() && !drive_.finger.rigid() && (grips || v == 0))
      mode.finger = Slide::gripping;
    sort_regions(mode, v, now);
    return mode.stuck() ? holding(mode, mode, now, x, skin_force) : mode;
  }

  /// Mode of a pin that, sliding, has brought one rigid contact to its level at x. It came with a
  /// force that pushed it there, so it sticks or crosses; it cannot turn back. What is as large as
  /// the capacity to rounding holds: the mode that holds asks where it goes from there.
  Mode arriving(const Mode& stuck, int side, const Instant<T>& now, T x, T skin_force) const {
    return overload(stuck, now, x, skin_force) == side ? released(stuck, -side) : stuck;
  }

  /// Mode of a pin at rest against the surface of every contact marked stuck, of which those of
  /// `before` held it until now: it stays where it can, or goes where the force takes it.
  Mode holding(const Mode& stuck, const Mode& before, const Instant<T>& now, T x,
               T skin_force) const {
    const T w = now.plate_velocity.rate;
    if (!stuck.both_stuck() || w == 0) {
      const int side = overload(stuck, now, x, skin_force);
      return side == 0 ? stuck : released(stuck, -side);
    }
    // The surfaces part: with the plate, with the finger, or with neither.
    const int parting = w > 0 ? 1 : -1;
    Mode with_plate = stuck, with_finger = stuck;
    with_plate.finger = static_cast<Slide>(parting);
    with_finger.plate = static_cast<Slide>(-parting);
    const bool plate_first = before.plate == Slide::stuck || before.finger != Slide::stuck;
    for (const Mode& mode :
         {plate_first ? with_plate : with_finger, plate_first ? with_finger : with_plate})
      if (overload(mode, now, x, skin_force) == 0) return mode;
    // Neither holds: the pin is thrown ahead of both or behind both, or slides between them.
    const auto acceleration = [&](const Mode& mode) {
      return -needed(equation(mode, now, x, skin_force), Line<T>{}) / drive_.mass;
    };
    const Mode ahead = released(stuck, 1), behind = released(stuck, -1);
    if (acceleration(ahead) > std::max(w, T(0))) return ahead;
    if (acceleration(behind) < std::min(w, T(0))) return behind;
    with_plate.plate = static_cast<Slide>(-parting);
    return with_plate;
  }

  /// The mode in which the stuck contacts slide to the given side. What slides already stays in its
  /// region.
  Mode released(Mode stuck, int side) const {
    const auto slide = static_cast<Slide>(side);
    if (stuck.plate == Slide::stuck) {
      stuck.plate = slide;
      stuck.plate_region = 0;
    }
    if (stuck.finger == Slide::stuck) {
      stuck.finger = slide;
      stuck.finger_region = 0;
    }
    return stuck;
  }

  /// Puts each sliding contact in the region of its curve that its speed lies in.
  void sort_regions(Mode& mode, T v, const Instant<T>& now) const {
    mode.plate_region =
        slides(mode.plate)
            ? drive_.plate.region_of(sign(mode.plate) * (v - now.plate_velocity.value))
            : 0;
    mode.finger_region = slides(mode.finger) ? drive_.finger.region_of(sign(mode.finger) * v) : 0;
  }

 private:
  /// The sign of the force that the stuck contacts cannot carry; 0 if they can.
  int overload(const Mode& stuck, const Instant<T>& now, T x, T skin_force) const {
    using std::abs;
    const Equation<T> sum = equation(stuck, now, x, skin_force);
    const Line<T> held = level(stuck, now);
    const T force = needed(sum, held), inertia = drive_.mass * held.rate;
    const T blur = sum.blur(held.value) + 4 * std::numeric_limits<T>::epsilon() * abs(inertia);
    return abs(force) <= capacity(stuck, now).value + blur ? 0 : force > 0 ? 1 : -1;
  }

  static Slide touch(const Surface& contact, T u) {
    if (!contact.present()) return Slide::absent;
    return u > 0 ? Slide::forward : u < 0 ? Slide::backward : Slide::stuck;
  }

  /// R = −s (F + c (s u − from)) λ with u = x' − surface, brought to the other side where it acts
  /// on x'. A slope and a changing load do not come together.
  static void add_sliding(Equation<T>& sum, const Surface& contact, Slide slide, int index,
                          Line<T> surface, Line<T> load) {
    if (!slides(slide)) return;
    const Region<T> region = contact.region(index);
    const T force = along(slide, region.force - region.slope * region.from);
    using std::abs;
    sum.size += abs(force * load.value);
    sum.pull.value -= force * load.value;
    sum.pull.rate -= force * load.rate;
    if (region.slope == 0) return;
    const T drag = region.slope * load.value;
    sum.damping += drag;
    sum.rounding += region.rounding * load.value;
    sum.size += abs(drag * surface.value);
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

}  // namespace second_opinion
