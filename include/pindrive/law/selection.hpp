/// The selection of the mode that follows an event, from the state there (docs/theory.md, section 4).
#pragma once

#include <cmath>

#include "pindrive/law/friction.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/law/oblique.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/law/stops.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// The pin and its contacts at an instant, and the mode in which they go on from there.
template <class T>
class Selection {
 protected:
  using Side = Touch<T>;

  Selection(const Drive<T>& drive, T time, T x, T v)
      : drive_(drive),
        time_(time),
        state_{x, v, T(0), T(0), T(0)},
        plate_(drive.plate),
        finger_(drive.finger),
        stop_(drive.stops) {
    using std::abs;
    state_.x_size = abs(x);
  }

  /// Selects the mode that follows: of the candidates, the first that is consistent, which is to say
  /// that each guard that is zero has a first derivative that is not zero and is positive. Preferred
  /// is what sticks; of two contacts that cannot both, the one that held until now, or the plate.
  /// False if none is.
  bool select() {
    using std::abs;
    plate_.ask(state_);
    finger_.ask(state_);
    inertia_ = drive_.mass * plate_.surface.rate;
    pull_ = drive_.stiffness * state_.x + drive_.damping * state_.v;
    T size = drive_.stiffness * state_.x_size + drive_.damping * abs(state_.v);
    inertia_ += force_.value;
    size += abs(force_.rate) * time_;  // known to the rounding of the time
    stop_.ask(state_);
    size += stop_.size(state_);
    state_.roundoff =
        rounding<T> * (size + 2 * abs(inertia_) + plate_.size(state_.v) + finger_.size(state_.v));
    const T pull = pull_;
    for (const bool stick : {true, false})
      for (int option = 0; option < stop_.count(); ++option) {
        stop_.take(option);
        pull_ = pull - stop_.force(state_);
        if (stop_.holds() ? stick && stays_at_stop() : stick ? sticks() : slips()) return true;
      }
    return false;
  }

  /// The mode that was selected.
  Mode mode() const {
    return {plate_.does.state, finger_.does.state, plate_.does.branch, finger_.does.branch,
            stop_.does};
  }

  bool held() const { return pindrive::held(drive_, mode()); }

  /// Whether a stick force that has come to its limit stays exactly there: no force jumps.
  bool continues() const {
    return limit_ != 0 && plate_.continues(limit_) && finger_.continues(limit_) && !stop_.jumped();
  }

  /// Whether the push of a stop is exactly zero: it came to that, and no force jumps. What is at rest at a rigid
  /// one carries nothing.
  bool no_push() const {
    if (!stop_.no_push() || !stop_.rigid()) return stop_.no_push();
    const auto alike = [&](const Side& side) {
      const bool rested = side.before == ContactState::stick || side.before == ContactState::absent;
      return side.continues(0) || (rested && side.force(state_) == 0);
    };
    return alike(plate_) && alike(finger_);
  }

  const Drive<T>& drive_;
  T time_;  ///< now, s
  State<T> state_;
  Side plate_, finger_;   ///< in the mode that was selected, …
  EndStops<T> stop_;      ///< … and the end stops
  int limit_{0};          ///< the side of a stick force that has just come to its limit
  Line<T> force_{};       ///< from outside, N
  T inertia_{}, pull_{};  ///< m v_p' and what acts from outside; k x + b v less a stop's force, N

  T acceleration_{};  ///< of a pin that slips; tangential: that of a surface …
  bool tangential_{false};
  Path<T> stick_force_{};  ///< … or what carries it
  Guards<T> guards_;       ///< the mode's

 private:
  /// Of spring and damper, with a stop that pushes.
  T stiffness() const { return drive_.stiffness + stop_.stiffness(); }
  T damping() const { return drive_.damping + stop_.damping(); }

  /// Whether the finger is asked before the plate.
  bool finger_first() const {
    return finger_.before == ContactState::stick && plate_.before != ContactState::stick;
  }
  /// Whether a contact sticks …
  bool sticks() {
    const bool finger = finger_first();
    Side &first = finger ? finger_ : plate_, &second = finger ? plate_ : finger_;
    if (first.may_stick() && sticks(first, second, 0)) return true;
    return second.may_stick() && sticks(second, first, first.may_stick() ? 1 : 0);
  }
  /// … or the pin sets out with none that does.
  bool slips() {
    const bool finger = finger_first();
    Side &first = finger ? finger_ : plate_, &second = finger ? plate_ : finger_;
    for (Side* side : {&first, &second}) {
      Side& other = side == &first ? second : first;
      if (!side->may_stick()) continue;
      if (!other.may_stick()) other.does = other.option(0);
      side->breaks_under(stick_force(*side, other.may_stick() ? T(0) : other.force(state_)));
    }
    for (const bool kept : {false, true})
      for (int k = first.may_stick() ? 1 : 0; k < first.count; ++k)
        for (int l = second.may_stick() ? 1 : 0; l < second.count; ++l) {
          first.does = first.option(k);
          second.does = second.option(l);
          if ((keeps(first, second) || keeps(second, first)) == kept && sets_out()) return true;
        }
    return false;
  }
  /// Whether what stuck could carry the pin beside a slip of the other: it slips only where nothing else goes.
  bool keeps(const Side& side, const Side& other) const {
    using std::abs;
    if (side.before != ContactState::stick || !side.may_stick() || other.may_stick()) return false;
    const T force = stick_force(side, other.force(state_));
    return limit_ == 0 && side.stick_limit() - abs(force) > state_.roundoff;
  }

  /// Whether a rigid stop keeps the pin where it is. What its contacts do then follows from that it is at rest;
  /// a rigid finger does nothing.
  bool stays_at_stop() {
    using std::abs;
    tangential_ = false;
    acceleration_ = T(0);
    const T end = side(stop_.does);
    const auto goes = [&](Side& side, T apart) {
      for (int k = 0; k < side.count; ++k) {
        side.does = side.option(k);
        if (side.stuck() ? apart == 0 : side.goes_inside(state_, apart)) return true;
      }
      return false;
    };
    if (!goes(plate_, -plate_.surface.rate) || !goes(finger_, T(0))) return false;
    const T force = inertia_ - pull_ + plate_.force(state_) + finger_.force(state_);
    const auto rate = plate_.force_rate(T(0), T(0)), skin = finger_.force_rate(T(0), T(0));
    const Path<T> push{end * force, T(0), T(0), end * (force_.rate + rate.value + skin.value),
                       end * (rate.bend + skin.bend)};
    return stop_.holds_under(push, abs(force_.rate) + rate.size + skin.size, no_push(),
                             state_.roundoff, guards_);
  }

  /// Whether a contact sticks while the other one does one of its options.
  bool sticks(Side& on, Side& other, int option) {
    on.does = on.option(0);
    for (; option < other.count; ++option) {
      other.does = other.option(option);
      if (holds(on, other)) return true;
    }
    return false;
  }

  /// The force that would keep the pin on a contact's surface, beside what the other does, N, …
  T stick_force(const Side& on, T of_other) const {
    return pull_ - (inertia_ - drive_.mass * on.surface.rate) - of_other;
  }
  /// … and how it changes; `size` is that of the terms of its slope.
  Path<T> stick_force_from(T force, const Side& on, const Side& other, T& size) const {
    using std::abs;
    const T a = on.surface.rate, spring = stiffness() * state_.v, damper = damping() * a;
    const auto rate = other.force_rate(state_.v, a);
    size = abs(spring) + abs(damper) + rate.size;
    T drift = spring + damper - rate.value;
    drift -= force_.rate;
    size += abs(force_.rate);
    return {force, T(0), T(0), drift, stiffness() * a - rate.bend};
  }

  /// Whether a contact, and the other where it sticks too, keeps the pin on its surface.
  bool holds(const Side& on, const Side& other) {
    using std::abs;
    const T apart = on.surface.rate - other.surface.rate;
    if (other.stuck() ? apart != 0 : !other.goes_inside(state_, apart)) return false;
    if (!stop_.allows(state_.v, on.surface.rate, {})) return false;
    const T of_on = on.contact.static_limit;
    const T of_other = other.stuck() ? other.contact.static_limit : T(0);
    const Line<T> most{of_on * on.load.value + of_other * other.load.value,
                       of_on * on.load.rate + of_other * other.load.rate};
    const T force = stick_force(on, other.force(state_));
    const int at_limit = continues() ? limit_ : 0;
    if (most.value - abs(force) < -state_.roundoff && (force < 0 ? -1 : 1) != at_limit)
      return false;
    T size;
    stick_force_ = stick_force_from(force, on, other, size);
    guards_.clear();
    for (const int side : {1, -1}) {
      Path<T> left = Path<T>(most) + T(-side) * stick_force_;
      if (!(left.start > state_.roundoff) || side == at_limit) {
        left.start = T(0);
        if (abs(left.drift) <= rounding<T> * (size + abs(most.rate)) ||
            touches(left.drift, left.curvature, state_.roundoff))
          left.drift = T(0);
        if ((left.drift != 0 ? left.drift : left.curvature) < 0) return false;
      }
      guards_.add_force(left, plate_.stuck(), side);
    }
    return true;
  }

  /// Whether the pin can set out with no contact that sticks. A relative acceleration that is zero is
  /// exactly zero: it sets out along with that surface.
  bool sets_out() {
    using std::abs;
    tangential_ = false;
    guards_.clear();
    const T finger = finger_.force(state_);
    // Beside a plate that begins to slide across all forces may balance but for rounding.
    const bool across =
        plate_.oblique() && plate_.across.value == 0 && state_.v == plate_.surface.value;
    const T parting =
        across ? set_out_across(drive_.mass, plate_, inertia_ - pull_ + finger) : T(0);
    const T plate = plate_.force(state_);
    acceleration_ =
        across ? plate_.surface.rate + parting : (inertia_ - pull_ + plate + finger) / drive_.mass;
    const auto parts = [&](const Side& side, T own, T of_other) {  // times the mass
      if (!side.rests(state_.v)) return acceleration_;
      const T force = across ? drive_.mass * (acceleration_ - side.surface.rate)
                             : own - stick_force(side, of_other);
      const bool releases = side.before == ContactState::stick && continues();
      const T known = across ? T(0) : state_.roundoff + plate_.unsure(state_.v);
      const bool none = abs(force) <= known;
      if (!tangential_ && (none || releases || turns_at_once(side, force))) {
        tangential_ = true;
        acceleration_ = side.surface.rate;
      }
      return force;
    };
    const T at_plate = parts(plate_, plate, finger), at_finger = parts(finger_, finger, plate);
    if (stop_.ask_further() && !leaves_stop()) return false;
    const auto leaves = [&](const Side& side, const Side& other, T force) {
      if (side.oblique()) {
        const Line<T> jerk = this->jerk();
        return side.goes_inside(state_, acceleration_ - side.surface.rate, jerk.value, jerk.rate);
      }
      if (!tangential_) return side.goes_inside(state_, force);
      const T apart = acceleration_ - side.surface.rate;
      if (drive_.mass * abs(apart) > state_.roundoff || !side.rests(state_.v))
        return side.goes_inside(state_, apart);
      T size;
      const Path<T> needed = stick_force_from(T(0), side, other, size);
      const T own = side.force_rate(state_.v, acceleration_).value, jerk = own - needed.drift;
      const bool none = abs(jerk) <= rounding<T> * (size + abs(own));
      return side.goes_inside(state_, T(0), none ? T(0) : jerk, -needed.curvature);
    };
    return leaves(plate_, finger_, at_plate) && leaves(finger_, plate_, at_finger);
  }

  /// Whether the force that takes a sliding speed off a breakpoint turns within the rounding of the time.
  bool turns_at_once(const Side& side, T force) const {
    using std::abs;
    if (side.may_stick() || side.lags() || !side.sliding()) return false;
    const T rate = force_rate().value;
    return force * rate < 0 && 2 * abs(force) <= rounding<T> * time_ * abs(rate);
  }

  /// Whether a pin that sets out goes on as the stops do.
  bool leaves_stop() {
    using std::abs;
    const bool none =
        drive_.mass * abs(acceleration_) <= state_.roundoff || (stop_.rigid() && no_push());
    if (!tangential_ && stop_.at_edge() && none) {
      tangential_ = true;
      acceleration_ = T(0);
    }
    return stop_.allows(state_.v, acceleration_, jerk());
  }

  /// The jerk of a pin that sets out, none to rounding, and how fast it changes.
  Line<T> jerk() const {
    using std::abs;
    const auto [rate, size, bend] = force_rate();
    return {abs(rate) <= rounding<T> * size ? T(0) : rate / drive_.mass, bend / drive_.mass};
  }
  /// How the force on a pin that sets out changes: mass times its jerk.
  typename Side::Rate force_rate() const {
    using std::abs;
    const auto plate = plate_.force_rate(state_.v, acceleration_);
    const auto finger = finger_.force_rate(state_.v, acceleration_);
    const T spring = stiffness() * state_.v, damper = damping() * acceleration_;
    return {force_.rate + plate.value + finger.value - spring - damper,
            abs(force_.rate) + plate.size + finger.size + abs(spring) + abs(damper),
            plate.bend + finger.bend - stiffness() * acceleration_};
  }
};

}  // namespace pindrive::detail
