/// Friction law at an instant: candidate modes of a contact and its transmitted force
/// (docs/theory.md, section 4).
#pragma once

#include <cmath>

#include "pindrive/law/oblique.hpp"
#include "pindrive/law/skin.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// One contact at one instant: candidate modes and transmitted force.
///
/// `enumerate_options()` lists at most three candidates in order of preference, `option(i)` returns
/// candidate i, and `mode` is the candidate under test or, finally, the selected one. `surface`
/// (velocity, m/s) and `load` (load factor) are linear functions of the time since this instant.
template <class T>
struct ContactPoint : SlidingSkin<T> {
  using Base = SlidingSkin<T>;
  using Option = ContactMode<T>;
  using Base::Base, Base::contact, Base::surface, Base::load, Base::across, Base::mode;
  using Base::before, Base::reached_guard, Base::count, Base::friction, Base::direction;
  using Base::has_slider_state, Base::relative_speed, Base::shortens_skin;
  using Base::slip, Base::sliding, Base::elastic, Base::branch, Base::stick_limit;

  bool may_stick() const { return stick_state_ == ContactState::stick; }
  /// After stick, orders the slip candidates: slip opposite to the stick force (N) is tested first.
  /// The order matters only where both directions are consistent, which requires static > kinetic
  /// friction.
  void prefer_direction(T force) {
    if (slip_sign_ == 0) slip_sign_ = force < 0 ? T(-1) : T(1);
  }
  bool stuck() const { return mode.state == ContactState::stick; }
  bool oblique() const { return mode.state == ContactState::slip_oblique; }
  /// True if, at pin velocity v (m/s), the relative acceleration is the first quantity that
  /// determines on which side of the active guard the motion continues.
  bool is_decided_by_acceleration(T v) const {
    if (mode.guard == ActiveGuard::none || oblique()) return false;
    return elastic() ? this->excess_velocity(v) == 0
                     : !has_slider_state() || relative_speed(v) == 0;
  }
  /// Sets the initial mode: stick if pin and surface have equal velocities, otherwise slip. A
  /// compliant contact starts in elastic stick if its stretch is given or the pin is at rest.
  void initialize(State<T>& s, bool stretched) {
    const T u = s.v - surface.value, size = u < 0 ? -u : u;
    if (!contact.present() || (!contact.rigid() && load.value == 0)) return;
    const bool skin = !contact.rigid() && (stretched || s.v == 0);
    mode.state = skin ? ContactState::elastic_stick : ContactState::stick;
    if (skin || u == 0) return;
    mode = slip(u / size, ActiveGuard::none, contact.branch_of(size));
    if (has_slider_state())
      this->initialize_slider(s, size);
    else if (!contact.rigid())
      s.skin = this->skin_force(s, load.value);
  }

  /// Removes a contact whose load factor is zero at all times.
  void remove_unloaded(const Profile<T>& given) {
    if (!given.constant() || given.first() != 0) return;
    contact = {};
    mode = {};
  }

  /// Enumerates the candidate modes. Without an active guard, a sliding speed outside its branch of
  /// the friction curve is treated as being at the nearer end of that branch.
  void enumerate_options(const State<T>& s) {
    before = mode.state;
    count = 1;
    guard_ = reached_guard;
    reached_guard = ActiveGuard::none;
    stick_state_ = ContactState::absent;
    const T u = s.v - surface.value;
    const bool across_too = enumerate_oblique_options(*this, u, guard_);
    default_state_ = mode.state;
    slip_sign_ = mode.slip_sign;
    branch_ = mode.branch;
    if (across_too) return;
    if (!contact.rigid()) return this->enumerate_slider_options(s, u);
    if (sliding()) {
      const Branch<T> range = branch();
      const T speed = slip_sign_ * u;
      if (guard_ == ActiveGuard::none && speed >= range.to) guard_ = ActiveGuard::upper;
      if (guard_ == ActiveGuard::none && !(speed > range.from)) guard_ = ActiveGuard::lower;
      friction = range.at(speed);
      if (guard_ == ActiveGuard::none) return;
      if (guard_ == ActiveGuard::upper || branch_ > 0) {
        // Both branches have equal friction at a breakpoint.
        friction = contact.branch(guard_ == ActiveGuard::upper ? branch_ + 1 : branch_).force;
        count = 2;
        return;
      }
    }
    friction = contact.branch(0).force;
    if (before == ContactState::absent) return;
    guard_ = ActiveGuard::none;
    departure_guard_ = ActiveGuard::lower;
    stick_state_ = ContactState::stick;
    count = 3;
  }

  /// Candidate mode by its index: stick comes first, then the continuation of the present mode.
  Option option(int index) const {
    if (this->must_jump() || this->is_reversal(index))
      return this->after_jump(stick_state_ == ContactState::absent ? slip_sign_ : -slip_sign_,
                              index);
    if (stick_state_ == ContactState::absent) {
      if (index == 0) return {default_state_, guard_, branch_, slip_sign_};
      if (!contact.rigid()) return this->after_jump(slip_sign_, index);
      const bool faster = guard_ == ActiveGuard::upper;
      return {default_state_, faster ? ActiveGuard::lower : ActiveGuard::upper,
              branch_ + (faster ? 1 : -1), slip_sign_};
    }
    if (index == 0) return {stick_state_, guard_, 0, T(0)};
    const bool backward = (index == 1) == (slip_sign_ > 0);
    const T slip_sign = backward ? T(-1) : T(1);
    return contact.rigid() ? slip(slip_sign, departure_guard_) : this->after_jump(slip_sign);
  }

  /// Force on the pin, N; not defined in stick.
  T force(const State<T>& s) const {
    if (elastic()) return -this->skin_tension(s);
    return -(oblique() ? direction : mode.slip_sign) * this->mode_friction() * load.value;
  }
  /// Derivatives of the force for a pin with constant acceleration (m/s²).
  using Rate = ForceRate<T>;
  Rate force_rate(T v, T acceleration) const {
    using std::abs;
    const T stretching = contact.stiffness * v;
    if (elastic()) return {-stretching, abs(stretching), -contact.stiffness * acceleration};
    if (!sliding()) return {};
    if (has_slider_state()) return this->slip_force_rate(v, acceleration);
    const Branch<T> range = branch();
    const T faster = acceleration - surface.rate;
    T rate{}, bend{};
    if (oblique()) {
      const ObliqueSlip<T> speed = oblique_slip(v, acceleration);
      rate = speed.force_rate(range, load);
      bend = speed.force_bend(range, load);
    } else {
      rate =
          -range.slope * load.value * faster - mode.slip_sign * this->mode_friction() * load.rate;
      bend = -2 * range.slope * load.rate * faster;
    }
    const T unsure = range.rounding * load.value * abs(faster);
    return {rate, abs(rate) + unsure / rounding<T>, bend};
  }
  /// Error of the force from rounding of the pin velocity, N; large if the plate hardly slides
  /// across.
  T force_error(T v) const {
    using std::abs;
    if (!oblique() || v == 0) return T(0);
    return rounding<T> * abs(v * oblique_slip(v, surface.rate).steepness(branch(), load));
  }
  /// Magnitude of the terms that the contact adds to a sum of forces, N.
  T force_scale(T v) const {
    using std::abs;
    if (contact.branches == 0 || !sliding()) return stick_limit();
    const T rounded = abs(branch().slope) * this->speed_scale(v);
    return (contact.static_limit + rounded) * load.value + friction * load.value;
  }

  /// Force of the mode as a linear law; not defined in stick.
  ///
  /// In slip: −s (F + c (s u − from)) λ with u = x' − surface. In oblique slip: the present value
  /// and rate.
  Force<T> force_law(const State<T>& s) const {
    if (elastic()) return {{-s.skin, T(0)}, T(0), contact.stiffness, T(0)};
    if (oblique()) {
      const T axial = -direction * this->mode_friction();
      return {{axial * load.value, axial * load.rate}};
    }
    if (!sliding()) return {};
    const Branch<T> range = branch();
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
    if (shortens_skin() || before == mode.state) return !shortens_skin();
    if (contact.kinetic != contact.static_limit && load.value != 0) return false;
    return before == ContactState::stick ? mode.slip_sign == -limit
                                         : before == ContactState::elastic_stick;
  }

  /// True if the motion continues on the admissible side of the active guard, by the first
  /// derivative of the relative velocity that is not zero. If all vanish, a stick is admissible and
  /// a slip is not.
  bool is_admissible(const State<T>& s, T first, T second = T(0), T third = T(0)) const {
    if (mode.guard == ActiveGuard::none) return true;
    if (oblique()) {
      const ObliqueSlip<T> speed = oblique_slip(s.v, surface.rate + first);
      const T closing = speed.closing(), known = speed.rounding_of(surface.value);
      const T parting = speed.parting(second);
      const bool turns = closing == 0 || grazes(closing, parting, known);
      T faster = closing;
      if (turns) faster = parting != 0 ? parting : speed.u.value * third;
      if (faster == 0) faster = second * second;  // the pin starts to turn
      return (mode.guard == ActiveGuard::lower ? faster : -faster) >= 0;
    }
    const T decides = first != 0 ? first : second != 0 ? second : third;
    if (!elastic()) {
      const T faster = has_slider_state() ? relative_speed(s.v) : T(0);
      const T inwards =
          faster != 0 ? (mode.guard == ActiveGuard::lower ? faster : -faster)
                      : mode.slip_sign * (mode.guard == ActiveGuard::lower ? decides : -decides);
      return inwards > 0 || (inwards == 0 && (mode.guard == ActiveGuard::upper || mode.branch > 0));
    }
    if (this->slips_either_way()) return s.v == 0 && decides == 0;
    const T stretches = contact.stiffness * slip_sign_, faster = this->excess_velocity(s.v);
    if (faster == 0) return slip_sign_ * decides >= 0;
    return slip_sign_ * faster > 0 ||
           grazes(stretches * faster, stretches * decides, s.force_error);
  }

  ObliqueSlip<T> oblique_slip(T v, T acceleration) const {
    return {{v - surface.value, acceleration - surface.rate}, across};
  }

 private:
  using Base::default_state_, Base::slip_sign_, Base::branch_, Base::guard_, Base::stick_state_,
      Base::departure_guard_;
};

}  // namespace pindrive::detail
