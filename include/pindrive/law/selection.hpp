/// Selection of the mode that follows an event (docs/theory.md, section 4).
#pragma once

#include <cmath>

#include "pindrive/law/contact_point.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/law/oblique.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/law/stops.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Pin, contacts and stops at an instant, with the mode that follows.
template <class T>
class Selection {
 protected:
  using ContactPoint = detail::ContactPoint<T>;

  Selection(const Drive<T>& drive, T time, T x, T v)
      : drive_(drive),
        time_(time),
        state_{x, v, T(0), T(0), T(0)},
        plate_(drive.plate),
        finger_(drive.finger),
        stop_(drive.stops) {
    using std::abs;
    state_.position_scale = abs(x);
  }

  /// Selects the first candidate that is consistent: the first non-zero derivative of each guard
  /// that is zero is positive.
  ///
  /// Stick is preferred. If only one of two contacts can stick, the contact that stuck until now is
  /// preferred, then the plate. Returns false if no candidate is consistent.
  bool select() {
    using std::abs;
    plate_.enumerate_candidates(state_);
    finger_.enumerate_candidates(state_);
    applied_force_ = drive_.mass * plate_.surface.rate;
    restoring_force_ = drive_.stiffness * state_.x + drive_.damping * state_.v;
    T size = drive_.stiffness * state_.position_scale + drive_.damping * abs(state_.v);
    applied_force_ += force_.value;
    size += abs(force_.rate) * time_;  // error from the time resolution
    stop_.enumerate_candidates(state_);
    size += stop_.force_scale(state_);
    state_.force_error =
        rounding<T> * (size + 2 * abs(applied_force_) + plate_.force_scale(state_.v) +
                       finger_.force_scale(state_.v));
    const T pull = restoring_force_;
    for (const bool stick : {true, false})
      for (int option = 0; option < stop_.count(); ++option) {
        stop_.choose(option);
        restoring_force_ = pull - stop_.force(state_);
        if (stop_.is_holding() ? stick && try_stop() : stick ? try_any_stick() : try_any_slip())
          return true;
      }
    return false;
  }

  /// Selected mode.
  Mode mode() const {
    return {plate_.mode.state, finger_.mode.state, plate_.mode.branch, finger_.mode.branch,
            stop_.state};
  }

  bool held() const { return pindrive::held(drive_, mode()); }

  /// True if a stick force at its limit stays there exactly, because no force jumps.
  bool stays_at_limit() const {
    return stick_limit_side_ != 0 && plate_.is_continuous(stick_limit_side_) &&
           finger_.is_continuous(stick_limit_side_) && !stop_.force_jumped();
  }

  /// True if the push of a stop is exactly zero: it has reached zero and no force jumps. A pin at
  /// rest at a rigid stop is not pushed.
  bool no_push() const {
    if (!stop_.no_push() || !stop_.rigid()) return stop_.no_push();
    const auto alike = [&](const ContactPoint& side) {
      const bool rested = side.before == ContactState::stick || side.before == ContactState::absent;
      return side.is_continuous(0) || (rested && side.force(state_) == 0);
    };
    return alike(plate_) && alike(finger_);
  }

  const Drive<T>& drive_;
  T time_;  ///< time of the instant, s
  State<T> state_;
  ContactPoint plate_, finger_;  ///< contacts in the selected mode
  EndStops<T> stop_;             ///< end stops in the selected state
  int stick_limit_side_{0};      ///< side of a stick force that has just reached its limit, else 0
  Line<T> force_{};              ///< external force, N
  /// inertial and external force; force of spring and damper less that of a stop, N
  T applied_force_{}, restoring_force_{};

  T acceleration_{};  ///< acceleration in slip, m/s²
  bool tangential_{false};
  Path<T> stick_force_{};  ///< stick force, N
  Guards<T> guards_;       ///< guards of the mode

 private:
  /// Stiffness of spring and pushing stop, N/m.
  T stiffness() const { return drive_.stiffness + stop_.stiffness(); }
  T damping() const { return drive_.damping + stop_.damping(); }

  /// True if the finger is evaluated before the plate.
  bool finger_first() const {
    return finger_.before == ContactState::stick && plate_.before != ContactState::stick;
  }
  /// Selects a mode in which a contact sticks; false if none is consistent.
  bool try_any_stick() {
    const bool finger = finger_first();
    ContactPoint &first = finger ? finger_ : plate_, &second = finger ? plate_ : finger_;
    if (first.may_stick() && try_stick_beside(first, second, 0)) return true;
    return second.may_stick() && try_stick_beside(second, first, first.may_stick() ? 1 : 0);
  }
  /// Selects a mode in which no contact sticks; false if none is consistent.
  bool try_any_slip() {
    const bool finger = finger_first();
    ContactPoint &first = finger ? finger_ : plate_, &second = finger ? plate_ : finger_;
    for (ContactPoint* side : {&first, &second}) {
      ContactPoint& other = side == &first ? second : first;
      if (!side->may_stick()) continue;
      if (!other.may_stick()) other.choose(0);
      side->prefer_direction(stick_force(*side, other.may_stick() ? T(0) : other.force(state_)));
    }
    for (const bool kept : {false, true})
      for (int k = first.may_stick() ? 1 : 0; k < first.candidates.size(); ++k)
        for (int l = second.may_stick() ? 1 : 0; l < second.candidates.size(); ++l) {
          first.choose(k);
          second.choose(l);
          if ((could_stick(first, second) || could_stick(second, first)) == kept && try_slip())
            return true;
        }
    return false;
  }
  /// True if `side` was stuck and its static friction still suffices while `other` slips. `side` is
  /// released only if no other candidate is consistent.
  bool could_stick(const ContactPoint& side, const ContactPoint& other) const {
    using std::abs;
    if (side.before != ContactState::stick || !side.may_stick() || other.may_stick()) return false;
    const T force = stick_force(side, other.force(state_));
    return stick_limit_side_ == 0 && side.stick_limit() - abs(force) > state_.force_error;
  }

  /// Tests the mode in which a rigid stop holds the pin. The pin is at rest, which determines the
  /// modes of its contacts; a rigid finger transmits no force.
  bool try_stop() {
    using std::abs;
    tangential_ = false;
    acceleration_ = T(0);
    const T end = stop_sign(stop_.state);
    const auto goes = [&](ContactPoint& side, T apart) {
      for (int k = 0; k < side.candidates.size(); ++k) {
        side.choose(k);
        if (side.stuck() ? apart == 0 : side.is_admissible(state_, apart)) return true;
      }
      return false;
    };
    if (!goes(plate_, -plate_.surface.rate) || !goes(finger_, T(0))) return false;
    const T force =
        applied_force_ - restoring_force_ + plate_.force(state_) + finger_.force(state_);
    const auto rate = plate_.force_rate(T(0), T(0)), skin = finger_.force_rate(T(0), T(0));
    const Path<T> push{end * force, T(0), T(0), end * (force_.rate + rate.value + skin.value),
                       end * (rate.second + skin.second)};
    return stop_.try_hold(push, abs(force_.rate) + rate.scale + skin.scale, no_push(),
                          state_.force_error, guards_);
  }

  /// Tests stick of one contact beside each candidate of the second contact, from `option` on.
  bool try_stick_beside(ContactPoint& on, ContactPoint& other, int option) {
    on.choose(0);
    for (; option < other.candidates.size(); ++option) {
      other.choose(option);
      if (try_stick(on, other)) return true;
    }
    return false;
  }

  /// Force that keeps the pin on the surface of a contact, beside the force of the second contact,
  /// N.
  T stick_force(const ContactPoint& on, T of_other) const {
    return restoring_force_ - (applied_force_ - drive_.mass * on.surface.rate) - of_other;
  }
  /// Stick force as a function of time; `size` is the magnitude of the terms of its slope.
  Path<T> stick_force_from(T force, const ContactPoint& on, const ContactPoint& other,
                           T& size) const {
    using std::abs;
    const T a = on.surface.rate, spring = stiffness() * state_.v, damper = damping() * a;
    const auto rate = other.force_rate(state_.v, a);
    size = abs(spring) + abs(damper) + rate.scale;
    T drift = spring + damper - rate.value;
    drift -= force_.rate;
    size += abs(force_.rate);
    return {force, T(0), T(0), drift, stiffness() * a - rate.second};
  }

  /// Tests the mode in which a contact, and `other` if it sticks too, keeps the pin on its surface.
  bool try_stick(const ContactPoint& on, const ContactPoint& other) {
    using std::abs;
    const T apart = on.surface.rate - other.surface.rate;
    if (other.stuck() ? apart != 0 : !other.is_admissible(state_, apart)) return false;
    if (!stop_.is_consistent(state_.v, on.surface.rate, {})) return false;
    const T of_on = on.contact.static_limit;
    const T of_other = other.stuck() ? other.contact.static_limit : T(0);
    const Line<T> most{of_on * on.load.value + of_other * other.load.value,
                       of_on * on.load.rate + of_other * other.load.rate};
    const T force = stick_force(on, other.force(state_));
    const int at_limit = stays_at_limit() ? stick_limit_side_ : 0;
    if (most.value - abs(force) < -state_.force_error && (force < 0 ? -1 : 1) != at_limit)
      return false;
    T size;
    stick_force_ = stick_force_from(force, on, other, size);
    guards_.clear();
    for (const int side : {1, -1}) {
      Path<T> left = Path<T>(most) + T(-side) * stick_force_;
      if (!(left.start > state_.force_error) || side == at_limit) {
        left.start = T(0);
        if (abs(left.drift) <= rounding<T> * (size + abs(most.rate)) ||
            grazes(left.drift, left.curvature, state_.force_error))
          left.drift = T(0);
        if ((left.drift != 0 ? left.drift : left.curvature) < 0) return false;
      }
      guards_.add_force(left, plate_.stuck(), side);
    }
    return true;
  }

  /// Tests the mode in which no contact sticks. A relative acceleration that is zero within its
  /// error is exactly zero: the pin starts tangentially to that surface.
  bool try_slip() {
    using std::abs;
    tangential_ = false;
    guards_.clear();
    const T finger = finger_.force(state_);
    // On a plate that begins to slide across, all forces may balance within rounding.
    const bool across =
        plate_.oblique() && plate_.across.value == 0 && state_.v == plate_.surface.value;
    const T parting =
        across ? oblique_departure(drive_.mass, plate_, applied_force_ - restoring_force_ + finger)
               : T(0);
    const T plate = plate_.force(state_);
    acceleration_ = across ? plate_.surface.rate + parting
                           : (applied_force_ - restoring_force_ + plate + finger) / drive_.mass;
    const auto parts = [&](const ContactPoint& side, T own, T of_other) {  // times the mass
      if (!side.is_decided_by_acceleration(state_.v)) return acceleration_;
      const T force = across ? drive_.mass * (acceleration_ - side.surface.rate)
                             : own - stick_force(side, of_other);
      const bool releases = side.before == ContactState::stick && stays_at_limit();
      const T known = across ? T(0) : state_.force_error + plate_.force_error(state_.v);
      const bool none = abs(force) <= known;
      if (!tangential_ && (none || releases || turns_at_once(side, force))) {
        tangential_ = true;
        acceleration_ = side.surface.rate;
      }
      return force;
    };
    const T at_plate = parts(plate_, plate, finger), at_finger = parts(finger_, finger, plate);
    if (stop_.is_undecided() && !leaves_stop()) return false;
    const auto leaves = [&](const ContactPoint& side, const ContactPoint& other, T force) {
      if (side.oblique()) {
        const Line<T> jerk = this->jerk();
        return side.is_admissible(state_, acceleration_ - side.surface.rate, jerk.value, jerk.rate);
      }
      if (!tangential_) return side.is_admissible(state_, force);
      const T apart = acceleration_ - side.surface.rate;
      if (drive_.mass * abs(apart) > state_.force_error ||
          !side.is_decided_by_acceleration(state_.v))
        return side.is_admissible(state_, apart);
      T size;
      const Path<T> needed = stick_force_from(T(0), side, other, size);
      const T own = side.force_rate(state_.v, acceleration_).value, jerk = own - needed.drift;
      const bool none = abs(jerk) <= rounding<T> * (size + abs(own));
      return side.is_admissible(state_, T(0), none ? T(0) : jerk, -needed.curvature);
    };
    return leaves(plate_, finger_, at_plate) && leaves(finger_, plate_, at_finger);
  }

  /// True if the force that moves a sliding speed off a breakpoint changes its sign within the time
  /// resolution.
  bool turns_at_once(const ContactPoint& side, T force) const {
    using std::abs;
    if (side.may_stick() || side.has_slider_state() || !side.sliding()) return false;
    const T rate = force_rate().value;
    return force * rate < 0 && 2 * abs(force) <= rounding<T> * time_ * abs(rate);
  }

  /// True if a slipping pin is consistent with the state of the stops.
  bool leaves_stop() {
    using std::abs;
    const bool none =
        drive_.mass * abs(acceleration_) <= state_.force_error || (stop_.rigid() && no_push());
    if (!tangential_ && stop_.at_edge() && none) {
      tangential_ = true;
      acceleration_ = T(0);
    }
    return stop_.is_consistent(state_.v, acceleration_, jerk());
  }

  /// Jerk of a slipping pin, m/s³, zero within its error; and the derivative of the jerk.
  Line<T> jerk() const {
    using std::abs;
    const auto [rate, size, bend] = force_rate();
    return {abs(rate) <= rounding<T> * size ? T(0) : rate / drive_.mass, bend / drive_.mass};
  }
  /// Derivatives of the force on a slipping pin.
  ForceRate<T> force_rate() const {
    using std::abs;
    const auto plate = plate_.force_rate(state_.v, acceleration_);
    const auto finger = finger_.force_rate(state_.v, acceleration_);
    const T spring = stiffness() * state_.v, damper = damping() * acceleration_;
    return {force_.rate + plate.value + finger.value - spring - damper,
            abs(force_.rate) + plate.scale + finger.scale + abs(spring) + abs(damper),
            plate.second + finger.second - stiffness() * acceleration_};
  }
};

}  // namespace pindrive::detail
