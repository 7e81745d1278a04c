/// Friction law at an instant: candidate modes of a contact and its transmitted force
/// (docs/theory.md, section 11).
#pragma once

#include <cmath>

#include "pindrive/law/contact_mode.hpp"
#include "pindrive/law/damped_skin.hpp"
#include "pindrive/law/oblique.hpp"
#include "pindrive/law/skin.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/inlining.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// One contact at one instant: candidate modes and transmitted force.
///
/// `enumerate_candidates()` lists at most four candidates in order of preference; `mode` is the
/// candidate under test or, finally, the selected one. `surface` (velocity, m/s) and `load` (load
/// factor) are linear functions of the time since this instant.
template <class T>
struct ContactPoint {
  explicit ContactPoint(const Contact<T>& given) : contact(given) {}

  Contact<T> contact;
  Curve<T> surface{}, load{T(1), T(0)}, across{};
  ContactMode<T> mode{};
  ModeStart<T> start{};                          ///< friction and slider where the mode starts
  ContactState before{};                         ///< state before the last event
  ActiveGuard reached_guard{ActiveGuard::none};  ///< guard that became zero at the last event
  T direction{0};  ///< axial component of the sliding direction of an oblique slip: u/√(u² + w²)
  Candidates<T> candidates{};
  /// sign of the sliding velocity before, or of the force at which an elastic stick slips
  T slip_sign{0};
  bool slips_either_way{false};  ///< skin tension and static friction are both zero

  bool sliding() const { return is_slip(mode.state); }
  bool stuck() const { return mode.state == ContactState::stick; }
  bool elastic() const { return mode.state == ContactState::elastic_stick; }
  bool oblique() const { return mode.state == ContactState::slip_oblique; }
  PINDRIVE_INLINE Branch<T> branch() const { return contact.branch(mode.branch); }
  /// Friction near the sliding speed of a rigid contact, linear.
  PINDRIVE_INLINE Branch<T> linear_branch(T v) const {
    const Branch<T> range = branch();
    return range.linear() ? range : range.tangent(sliding_speed(v));
  }
  /// Curvature of friction over the sliding speed, N s²/m².
  T curvature(T v) const {
    const Branch<T> range = branch();
    return range.linear() ? T(0) : range.falling.curvature(sliding_speed(v));
  }
  T stick_limit() const { return contact.static_limit * load.value; }  ///< largest stick force, N
  /// True if the contact exerts no stick force until the next breakpoint.
  bool powerless() const { return contact.static_limit == 0 || load.is_zero(); }

  /// Sets the mode and its start to those of a candidate.
  void choose(int index) {
    mode = candidates[index].mode;
    start = candidates[index].start;
  }
  bool may_stick() const { return candidates[0].mode.state == ContactState::stick; }
  /// After stick, orders the slip candidates: slip opposite to the stick force (N) is tested first.
  /// The order matters only where both directions are consistent, which requires static > kinetic
  /// friction.
  void prefer_direction(T force) {
    if (slip_sign != 0) return;
    slip_sign = force < 0 ? T(-1) : T(1);
    if (slip_sign > 0) candidates.swap(1, 2);
  }

  /// True if the slider velocity is a state of its own, beside that of the pin.
  PINDRIVE_INLINE bool has_slider_state() const {
    return contact.may_lag() && sliding() && (contact.damped() || branch().slope != 0);
  }
  /// Pin speed minus slider speed and stretch rate, m/s; zero within its error.
  T relative_speed(T v) const {
    if (start.keeps_speed) return T(0);
    const T relative_speed = mode.slip_sign * v - stretch_rate(start.friction) - start.slider_speed;
    // rounding: tests/hard/skin-slip-at-pin-speed-within-rounding-at-plate-breakaway.txt
    return abs(relative_speed) < rounding<T> * abs(v) ? T(0) : relative_speed;
  }
  /// Velocities by which damping shifts a relative speed, from derivatives of the pin velocity, m/s.
  T by_damping(T acceleration) const {
    return contact.damped() ? contact.damping / contact.stiffness * acceleration : T(0);
  }
  /// Rate at which the skin stretches so that a friction (N at load factor 1) follows the load,
  /// m/s.
  T stretch_rate(T friction) const {
    return load.rate == 0 || contact.rigid() ? T(0) : load.rate * friction / contact.stiffness;
  }
  /// Pin velocity at which the contact stays at its active guard, m/s.
  T stationary_velocity() const {
    if (contact.rigid()) return surface.value;
    return elastic() ? -slip_sign * stretch_rate(contact.static_limit)
                     : mode.slip_sign * stretch_rate(branch().force);
  }
  /// Pin velocity minus the stationary velocity, m/s; zero within its error.
  T excess_velocity(T v) const {
    const T off = v - stationary_velocity();
    // rounding: tests/hard/skin-relaxation-at-rate-of-falling-limit-within-rounding.txt
    return abs(off) < rounding<T> * abs(v) ? T(0) : off;
  }
  /// Skin tension in slip for a load factor, N; of skin with damping, if the slider stuck.
  T skin_force(const State<T>& s, T loaded) const {
    const Branch<T> range = branch();
    const T friction =
        mode.slip_sign *
        range.at(has_slider_state() ? mode.slip_sign * s.slider_velocity : range.from) * loaded;
    return contact.damped() ? friction + contact.damping * s.slider_velocity : friction;
  }
  /// True if the slider moves noticeably within the time resolution, as under a falling load. Such
  /// a slider advances by the stored time.
  bool is_sensitive_to_time() const { return has_slider_state() && load.rate != 0; }
  /// Change of the velocity of a slider that goes with one of its tension (N), m/s.
  T slider_change(T tension) const {
    return tension / (branch().slope * load.value + contact.damping);
  }
  /// Moves the state to the start of the selected mode.
  void apply_jump(State<T>& s) const {
    if (mode.state == ContactState::absent) s.skin = T(0);
    if (start.shortens_skin) s.skin = skin_tension(s);
    if (has_slider_state()) s.slider_velocity = mode.slip_sign * start.slider_speed;
  }
  /// True if, at pin velocity v (m/s), the relative acceleration is the first quantity that
  /// determines on which side of the active guard the motion continues.
  bool is_decided_by_acceleration(T v) const {
    if (mode.guard == ActiveGuard::none || oblique() || contact.damped()) return false;
    return elastic() ? excess_velocity(v) == 0 : !has_slider_state() || relative_speed(v) == 0;
  }
  /// Sets the initial mode: stick if pin and surface have equal velocities, otherwise slip. A
  /// compliant contact starts in elastic stick if its stretch is given or the pin is at rest.
  void initialize(State<T>& s, bool stretched) {
    const T u = s.v - surface.value, size = u < 0 ? -u : u;
    if (!contact.present()) return;
    if (!contact.rigid() && !contact.damped() && load.value == 0) return;
    const bool skin = !contact.rigid() && (stretched || s.v == 0);
    mode.state = skin ? ContactState::elastic_stick : ContactState::stick;
    if (skin || u == 0) return;
    mode = ContactMode<T>::slip(u / size, ActiveGuard::none, contact.branch_of(size));
    if (contact.damped()) {
      s.slider_velocity = s.v;
      s.skin = skin_force(s, load.value);
    } else if (has_slider_state())
      initialize_slider(*this, s, size);
    else if (!contact.rigid())
      s.skin = skin_force(s, load.value);
  }

  /// Removes a contact whose load factor is zero at all times.
  void remove_unloaded(const Profile<T>& given) {
    if (!given.constant() || given.first() != 0) return;
    contact = {};
    mode = {};
  }

  /// Enumerates the candidate modes. Without an active guard, a sliding speed outside its branch of
  /// the friction curve is treated as being at the nearer end of that branch.
  void enumerate_candidates(const State<T>& s) {
    before = mode.state;
    ActiveGuard guard = reached_guard;
    reached_guard = ActiveGuard::none;
    candidates.clear();
    const T u = s.v - surface.value;
    const bool slides_across =
        (oblique() || !across.is_zero()) && enumerate_oblique_candidates(*this, u, guard);
    slip_sign = mode.slip_sign;
    if (slides_across) return;
    if (contact.damped()) return DampedSkinCandidates<T, ContactPoint>(*this, s, guard).enumerate();
    if (!contact.rigid()) return SliderCandidates<T, ContactPoint>(*this, s, u, guard).enumerate();
    if (sliding()) {
      const Branch<T> range = branch();
      const T speed = slip_sign * u;
      if (guard == ActiveGuard::none && speed >= range.to) guard = ActiveGuard::upper;
      if (guard == ActiveGuard::none && !(speed > range.from)) guard = ActiveGuard::lower;
      start.friction = range.at(speed);
      if (guard == ActiveGuard::none || guard == ActiveGuard::upper || mode.branch > 0)
        return add_branches(guard);
    }
    start.friction = contact.branch(0).force;
    if (before == ContactState::absent)
      return candidates.add({mode.state, guard, mode.branch, mode.slip_sign}, start);
    candidates.add({ContactState::stick, ActiveGuard::none, 0, T(0)}, start);
    const T first = slip_sign > 0 ? T(-1) : T(1);
    candidates.add(ContactMode<T>::slip(first, ActiveGuard::lower), start);
    candidates.add(ContactMode<T>::slip(-first, ActiveGuard::lower), start);
  }

  /// Adds the present mode and, at a breakpoint of the friction curve, the other branch. Both
  /// branches have equal friction there.
  void add_branches(ActiveGuard guard) {
    const bool faster = guard == ActiveGuard::upper;
    if (guard != ActiveGuard::none)
      start.friction = contact.branch(faster ? mode.branch + 1 : mode.branch).force;
    candidates.add({mode.state, guard, mode.branch, mode.slip_sign}, start);
    if (guard != ActiveGuard::none)
      candidates.add({mode.state, faster ? ActiveGuard::lower : ActiveGuard::upper,
                      mode.branch + (faster ? 1 : -1), mode.slip_sign},
                     start);
  }

  /// Force on the pin, N; not defined in stick.
  T force(const State<T>& s) const {
    if (elastic()) return -skin_tension(s);
    return -(oblique() ? direction : mode.slip_sign) * start.friction * load.value;
  }
  /// Derivatives of the force for a pin with constant acceleration (m/s²).
  ForceRate<T> force_rate(T v, T acceleration) const {
    const T stretching = contact.stiffness * v, damper = contact.damping * acceleration;
    if (elastic())
      return {-stretching - damper, abs(stretching) + abs(damper),
              -contact.stiffness * acceleration};
    if (!sliding()) return {};
    if (has_slider_state()) return slip_force_rate(v, acceleration);
    const Branch<T> range = linear_branch(v);
    const T relative = acceleration - surface.rate, bend = curvature(v);
    T rate{}, second{};
    if (oblique()) {
      const ObliqueSlip<T> speed = oblique_slip(v, acceleration);
      rate = speed.force_rate(range, load);
      second = speed.force_second_rate(range, bend, load);
    } else {
      rate = -range.slope * load.value * relative - mode.slip_sign * start.friction * load.rate;
      second = -2 * range.slope * load.rate * relative +
               range.slope * load.value * surface.second() -
               mode.slip_sign * start.friction * load.second();
      if (bend != 0) second -= mode.slip_sign * bend * load.value * relative * relative;
    }
    const T slope_error = range.rounding * load.value * abs(relative);
    return {rate, abs(rate) + slope_error / rounding<T>, second};
  }
  /// Derivative of the force along the axis by the velocity of the pin, N s/m; 0 for a slider with a velocity of its
  /// own.
  T force_by_speed(T v) const {
    if (elastic()) return -contact.damping;
    if (!sliding() || oblique() || has_slider_state()) return T(0);
    return -linear_branch(v).slope * load.value;
  }
  /// Error of the force from rounding of the pin velocity, N; large if the plate hardly slides
  /// across.
  T force_error(T v) const {
    if (!oblique() || v == 0) return T(0);
    // rounding: tests/hard/creep-across-curve-point-of-finger.txt
    return rounding<T> * abs(v * oblique_slip(v, surface.rate).steepness(linear_branch(v), load));
  }
  /// Magnitude of the terms that the contact adds to a sum of forces, N.
  T force_scale(T v) const {
    if (contact.branches == 0 || !sliding()) return stick_limit();
    const T rounded = abs(linear_branch(v).slope) * speed_scale(v);
    return (contact.static_limit + rounded) * load.value + start.friction * load.value;
  }

  /// Force of the mode as a linear law; not defined in stick.
  ///
  /// In slip: −s (F + c (s u − from)) λ with u = x' − surface. In oblique slip: the present value
  /// and rate.
  Force<T> force_law(const State<T>& s) const {
    if (elastic())
      return {{contact.damping * s.v - s.skin, T(0)}, contact.damping, contact.stiffness, T(0)};
    if (oblique()) {
      const T axial = -direction * start.friction;
      return {{axial * load.value, axial * load.rate}};
    }
    if (!sliding()) return {};
    const Branch<T> range = linear_branch(s.v);
    const T force = -mode.slip_sign * range.force;
    Force<T> law{{force * load.value, force * load.rate}};
    if (vanishes(range.slope)) return law;
    const T from = mode.slip_sign * range.from;
    law.drag = range.slope * load.value;
    law.constant.value += law.drag * (from + surface.value);
    law.constant.rate += range.slope * load.rate * from + law.drag * surface.rate;
    if (range.slope != 0) law.rounding = range.rounding * load.value;
    return law;
  }

  /// True if the force is continuous after a stick force has reached its limit on a side.
  bool is_continuous(int limit) const {
    if (start.shortens_skin || before == mode.state) return !start.shortens_skin;
    if (contact.kinetic != contact.static_limit && load.value != 0) return false;
    return before == ContactState::stick ? mode.slip_sign == -limit
                                         : before == ContactState::elastic_stick;
  }

  /// True if the motion continues on the admissible side of the active guard, by the first
  /// derivative of the relative velocity that is not zero. If all vanish, a stick is admissible and
  /// a slip is not.
  bool is_admissible(const State<T>& s, T first, T second = T(0), T third = T(0)) const {
    if (mode.guard == ActiveGuard::none) return true;
    if (oblique()) return is_admissible_obliquely(s, first, second, third);
    if (contact.damped()) return is_admissible_with_damping(s.v, first, second, third, T(0));
    const T decides = first != 0 ? first : second != 0 ? second : third;
    if (!elastic()) {
      const T faster = has_slider_state() ? relative_speed(s.v) : T(0);
      const T inwards =
          faster != 0 ? (mode.guard == ActiveGuard::lower ? faster : -faster)
                      : mode.slip_sign * (mode.guard == ActiveGuard::lower ? decides : -decides);
      return inwards > 0 || (inwards == 0 && (mode.guard == ActiveGuard::upper || mode.branch > 0));
    }
    if (slips_either_way) return s.v == 0 && decides == 0;
    const T stretches = contact.stiffness * slip_sign, faster = excess_velocity(s.v);
    if (faster == 0) return slip_sign * decides >= 0;
    return slip_sign * faster > 0 || grazes(stretches * faster, stretches * decides, s.force_error);
  }

  /// `is_admissible` of skin with damping: the sign of the first derivative of the slider velocity in slip, or of the
  /// tension in stick, that is not zero. `error` (m/s²) is that of the first derivative.
  bool is_admissible_with_damping(T v, T first, T second, T third, T error) const {
    if (mode.guard == ActiveGuard::none) return true;
    const T sign = elastic() ? -slip_sign : mode.slip_sign;
    const T friction = elastic() ? contact.static_limit : start.friction;
    const T moves = sign * v - (elastic() ? T(0) : start.slider_speed);
    const T damped = sign * by_damping(first), unloads = stretch_rate(friction);
    const T sum = moves + damped - unloads;
    const bool none = abs(sum) <= by_damping(error);
    const T later = sign * (first + by_damping(second));
    const T faster = !none ? sum : later != 0 ? later : sign * (second + by_damping(third));
    if (slips_either_way && elastic())
      return none ? later == 0 : sum < 0 && abs(v + by_damping(first)) < unloads;
    if (elastic()) return faster <= 0;
    return mode.guard == ActiveGuard::lower ? faster > 0 || (faster == 0 && mode.branch > 0)
                                            : faster <= 0;
  }

  ObliqueSlip<T> oblique_slip(T v, T acceleration) const {
    return {v - surface.value, acceleration - surface.rate, surface, across};
  }

 private:
  /// `is_admissible` of an oblique slip.
  [[gnu::noinline]] bool is_admissible_obliquely(const State<T>& s, T first, T second,
                                                 T third) const {
    const ObliqueSlip<T> speed = oblique_slip(s.v, surface.rate + first);
    const T closing = speed.closing(), error = speed.rounding_of(surface.value);
    const T parting = speed.parting(second, across.second());
    const bool turns =
        closing == 0 || grazes(closing, parting, error) || grazes(-closing, -parting, error);
    T faster = closing;
    if (turns) faster = parting != 0 ? parting : speed.velocity() * third;
    if (faster == 0) faster = second * second;  // the pin starts to turn
    return (mode.guard == ActiveGuard::lower ? faster : -faster) >= 0;
  }
  /// Sliding speed of a rigid contact, m/s.
  T sliding_speed(T v) const {
    const T u = v - surface.value;
    return oblique() ? hypot(u, across.value) : mode.slip_sign * u;
  }
  /// Skin tension in elastic stick, N.
  T skin_tension(const State<T>& s) const {
    return start.shortens_skin ? (s.skin < 0 ? T(-1) : T(1)) * start.friction * load.value : s.skin;
  }
  /// Derivatives of the force in slip with a slider velocity: the skin stretches at the relative
  /// speed.
  ForceRate<T> slip_force_rate(T v, T acceleration) const {
    const T stiffness = contact.stiffness, sign = mode.slip_sign;
    const T slope = branch().slope;
    if (contact.damped()) {
      const T faster = (stiffness * relative_speed(v) + sign * contact.damping * acceleration) /
                       (slope * load.value + contact.damping);
      const T by_load = sign * start.friction * load.rate, by_speed = slope * load.value * faster;
      return {-by_load - sign * by_speed, abs(by_load) + abs(by_speed),
              -sign * (start.friction * load.second() + 2 * slope * load.rate * faster)};
    }
    const T faster = load.value == 0
                         ? sign * stiffness * acceleration / (stiffness + 2 * slope * load.rate)
                         : stiffness * relative_speed(v) / (slope * load.value);
    return {-stiffness * (v - sign * start.slider_speed), stiffness * (abs(v) + start.slider_speed),
            -stiffness * (acceleration - sign * faster)};
  }
  /// Bound of the speed that the slope of the friction curve multiplies, m/s.
  T speed_scale(T v) const {
    return has_slider_state() ? branch().from + start.slider_speed : abs(v) + abs(surface.value);
  }
};

}  // namespace pindrive::detail
