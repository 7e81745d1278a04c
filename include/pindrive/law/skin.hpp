/// Skin and slider of a compliant contact (docs/theory.md, section 11).
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/law/contact_point_state.hpp"
#include "pindrive/law/slider.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Compliant part of a contact: skin that stretches, with a massless slider at its end.
template <class T>
class SlidingSkin : public ContactPointState<T> {
 public:
  using Base = ContactPointState<T>;
  using Base::Base, Base::contact, Base::surface, Base::load, Base::mode, Base::before, Base::count;
  using Base::friction, Base::slip, Base::sliding, Base::elastic, Base::branch, Base::stick_limit;

  /// True if the slider velocity is a state of its own, beside that of the pin.
  bool has_slider_state() const { return contact.may_lag() && sliding() && branch().slope != 0; }
  /// Slider speed in the direction of slip, m/s.
  T slider_speed() const { return has_jumped() ? T(jump_.speed) : slider_speed_; }
  /// Pin speed minus slider speed and stretch rate, m/s; zero within its error.
  T relative_speed(T v) const {
    using std::abs;
    if (had_pin_speed_ && slider_speed() == slider_speed_) return T(0);
    const T relative_speed = mode.slip_sign * v - stretch_rate(mode_friction()) - slider_speed();
    return abs(relative_speed) < rounding<T> * abs(v) ? T(0) : relative_speed;
  }
  /// Rate at which the skin stretches so that a friction (N at load factor 1) follows the load,
  /// m/s.
  T stretch_rate(T of) const {
    return load.rate == 0 || contact.rigid() ? T(0) : load.rate * of / contact.stiffness;
  }
  /// Pin velocity at which the contact stays at its active guard, m/s.
  T stationary_velocity() const {
    if (contact.rigid()) return surface.value;
    return elastic() ? -slip_sign_ * stretch_rate(contact.static_limit)
                     : mode.slip_sign * stretch_rate(branch().force);
  }
  /// Pin velocity minus the stationary velocity, m/s; zero within its error.
  T excess_velocity(T v) const {
    using std::abs;
    const T off = v - stationary_velocity();
    return abs(off) < rounding<T> * abs(v) ? T(0) : off;
  }
  /// True if the skin shortens at once.
  bool shortens_skin() const { return has_jumped() && jump_.shortens_skin; }

  /// Skin tension in slip for a load factor, N.
  T skin_force(const State<T>& s, T loaded) const {
    const Branch<T> range = branch();
    const T slip_sign = mode.slip_sign;
    return slip_sign * range.at(has_slider_state() ? slip_sign * s.slider_velocity : range.from) *
           loaded;
  }
  /// True if the slider moves noticeably within the time resolution, as under a falling load. Such
  /// a slider advances by the stored time.
  bool is_sensitive_to_time() const { return has_slider_state() && load.rate != 0; }
  /// Keeps the force where the load is known only to the time resolution; `loaded` is the load
  /// factor before.
  void keep_force(State<T>& s, T loaded) const {
    if (!has_slider_state() || loaded == load.value || !(load.value > 0)) return;
    const Branch<T> range = branch();
    s.slider_velocity += mode.slip_sign * range.at(mode.slip_sign * s.slider_velocity) *
                         (loaded / load.value - 1) / range.slope;
  }
  /// Moves the state to the start of the selected mode.
  void apply_jump(State<T>& s) const {
    if (mode.state == ContactState::absent) s.skin = T(0);
    if (shortens_skin()) s.skin = skin_tension(s);
    if (has_slider_state()) s.slider_velocity = mode.slip_sign * slider_speed();
  }

 protected:
  /// Friction of the mode for a load factor of 1, N.
  T mode_friction() const { return has_jumped() ? T(jump_.friction) : friction; }
  /// Skin tension in elastic stick, N.
  T skin_tension(const State<T>& s) const {
    return shortens_skin() ? (s.skin < 0 ? T(-1) : T(1)) * mode_friction() * load.value : s.skin;
  }
  /// Derivatives of the force in slip with a slider velocity: the skin stretches at the relative
  /// speed.
  ForceRate<T> slip_force_rate(T v, T acceleration) const {
    using std::abs;
    const T stiffness = contact.stiffness, slip_sign = mode.slip_sign;
    const T slope = branch().slope;
    const T faster =
        load.value == 0 ? slip_sign * stiffness * acceleration / (stiffness + 2 * slope * load.rate)
                        : stiffness * relative_speed(v) / (slope * load.value);
    return {-stiffness * (v - slip_sign * slider_speed()), stiffness * (abs(v) + slider_speed()),
            -stiffness * (acceleration - slip_sign * faster)};
  }
  /// Bound of the speed that the slope of the friction curve multiplies, m/s.
  T speed_scale(T v) const {
    using std::abs;
    return has_slider_state() ? branch().from + slider_speed_ : abs(v) + abs(surface.value);
  }

  bool must_jump() const { return compliant() && must_jump_; }
  /// True if skin tension and static friction are both zero, so that either slip direction is a
  /// candidate.
  bool slips_either_way() const { return compliant() && slips_either_way_; }
  /// True if candidate `index` is the reversal at the begin of a branch; this candidate is the
  /// last.
  bool is_reversal(int index) const {
    return compliant() && has_alternative_ && index == count - 1;
  }
  ContactMode<T> after_jump(T slip_sign, int index = 0) const {
    if (is_unloaded()) return {};
    const SliderJump<T>& there = is_reversal(index) ? alternative_ : jump_;
    if (!there.sticks)
      return slip(there.reverses ? -slip_sign : slip_sign, there.guard, there.branch);
    if (!slips_either_way_) return {ContactState::elastic_stick, ActiveGuard::none, 0, T(0)};
    const int way = must_jump_ ? index : index - 1;
    if (way == 0) return {ContactState::elastic_stick, ActiveGuard::upper, 0, T(0)};
    return slip(way == 1 ? slip_sign : -slip_sign, ActiveGuard::lower);
  }

  /// Sets the slider of a pin that slips at the release. On a falling branch the slider starts at
  /// the largest stable speed.
  void initialize_slider(State<T>& s, T speed) {
    const Branch<T> range = branch();
    const T asked = range.at(speed);
    slider_speed_ = speed;
    s.skin = mode.slip_sign * asked * load.value;
    if (range.slope < 0) {
      jump_ = slider(mode.slip_sign, mode.slip_sign * speed).next_slower(mode.branch, asked);
      slider_speed_ = jump_.speed;
      mode = after_jump(mode.slip_sign);
      mode.guard = ActiveGuard::none;
    }
    s.slider_velocity = mode.slip_sign * slider_speed_;
  }

  /// Enumerates the candidate modes of a compliant contact.
  [[gnu::noinline]] void enumerate_slider_options(const State<T>& s, T u) {
    ActiveGuard& guard = guard_;
    must_jump_ = slips_either_way_ = had_pin_speed_ = has_alternative_ = false;
    if (!contact.present()) return;
    if (load.value == 0 && !begin_load(s, u)) return;
    had_pin_speed_ = sliding() && !has_slider_state();
    if (sliding() && load.value != 0) {
      const Branch<T> range = branch();
      const auto goes = slider(slip_sign_, u);
      const T speed =
          has_slider_state() ? slip_sign_ * s.slider_velocity : goes.stationary_speed(range.force);
      if (had_pin_speed_ && guard != ActiveGuard::none &&
          is_nonzero(speed - (guard == ActiveGuard::upper ? range.to : range.from), u))
        guard = ActiveGuard::none;  // the rate of the load has changed
      const ActiveGuard came_to = guard;
      if (guard == ActiveGuard::none && speed >= range.to) guard = ActiveGuard::upper;
      if (guard == ActiveGuard::none && !(speed > range.from)) guard = ActiveGuard::lower;
      // A slider without its own velocity follows a jump of the pin velocity.
      const T jumps = guard == ActiveGuard::upper ? speed - range.to : range.from - speed;
      must_jump_ = had_pin_speed_ && came_to == ActiveGuard::none && guard != ActiveGuard::none &&
                   jumps > 2 * rounding<T> * (range.from + (speed < 0 ? -speed : speed));
      had_pin_speed_ = had_pin_speed_ && !must_jump_;
      slider_speed_ = guard == ActiveGuard::none    ? speed
                      : guard == ActiveGuard::upper ? range.to
                                                    : range.from;
      friction = range.at(has_slider_state() ? slider_speed_ : range.from);
      const T pulls = slip_sign_ * s.skin, most = friction * load.value;
      if (std::abs(plain(pulls - most)) > jump_error<T> * plain(pulls + most) + s.force_error) {
        must_jump_ = true;  // the load has jumped
        had_pin_speed_ = false;
        jump_ = pulls > most ? goes.next_faster(branch_, pulls / load.value)
                             : goes.next_slower(branch_ + 1, pulls / load.value);
        resolve_rest(goes, slip_sign_, u);
        return;
      }
      if (guard == ActiveGuard::none) return;
      if (guard == ActiveGuard::upper || branch_ > 0) {
        const int beyond = branch_ + (guard == ActiveGuard::upper ? 1 : 0);
        const T asked = friction = contact.branch(beyond).force;
        jump_ = guard == ActiveGuard::upper ? goes.next_faster(beyond, asked)
                                            : goes.next_slower(beyond, asked);
        count = must_jump_ ? 1 : 2;
        resolve_rest(goes, slip_sign_, u);
        if (guard == ActiveGuard::upper || !jump_.sticks || asked < contact.static_limit) return;
      }
    }
    friction = contact.branch(0).force;
    count = 1;
    must_jump_ = false;
    guard = ActiveGuard::none;
    stick_state_ = ContactState::elastic_stick;  // with its present tension
    const T most = stick_limit(), grows = stretch_rate(contact.static_limit);
    const bool empty = !(most > 0) && s.skin == 0;
    slips_either_way_ = empty && !(grows > 0);
    slip_sign_ = (empty ? u > 0 : s.skin > 0) ? T(-1) : T(1);  // sign of the force
    const T pulls = -slip_sign_ * s.skin;
    const bool exceeds = pulls > most + rounding<T> * most + s.force_error;
    if (!exceeds && (pulls < most || slip_sign_ * u > -grows)) return;
    guard = ActiveGuard::upper;
    must_jump_ = exceeds;
    const auto goes = slider(-slip_sign_, u);
    jump_ = goes.next_faster(0, must_jump_ ? pulls / load.value : contact.static_limit);
    if (jump_.shortens_skin && jump_.guard == ActiveGuard::lower &&
        load.rate < 0)  // slip cannot continue either
      jump_ = goes.sticking(jump_);
    count = must_jump_ ? 1 : slips_either_way_ && u == 0 ? 3 : 2;
    resolve_rest(goes, -slip_sign_, u);
  }
  /// Completes the candidates after a slider jump.
  ///
  /// Without static friction a sticking skin slips with the pin or, under a pin at rest, to either
  /// side. If the jump ends at the begin of a branch with the speed of the pin, the acceleration of
  /// the pin decides.
  void resolve_rest(const Slider<T>& goes, T slip_sign, T u) {
    if (jump_.sticks && contact.static_limit == 0) {
      slips_either_way_ = u == 0;
      if (slips_either_way_) {
        count += 2;
        return;
      }
      jump_ = slider(-slip_sign, u).next_faster(0, T(0));
      jump_.shortens_skin = jump_.reverses = true;
    }
    if (jump_.guard != ActiveGuard::lower || jump_.reverses) return;
    const bool meets = goes.excess(jump_.speed, jump_.friction) == 0;
    if (!must_jump_ && !(meets && jump_.branch > 0)) return;
    alternative_ = goes.next_slower(jump_.branch, jump_.friction);
    has_alternative_ = must_jump_ || jump_.shortens_skin || !alternative_.sticks;
    if (has_alternative_) ++count;
  }

 public:
  /// Removes the load while it is too close to zero for a lasting mode: alternations of stick and
  /// slip would be shorter than the time resolution.
  ///
  /// Returns the time at which the load is to be evaluated again, s.
  [[gnu::noinline]] T defer_first_grip(State<T>& s, T time, T breakpoint) {
    if (load.rate == 0 || contact.rigid() || !contact.present()) return breakpoint;
    const T u = s.v < 0 ? -s.v : s.v, known = first_grip<T> * breakpoint;
    if (load.value == 0 && load.rate > 0) {
      const T most = stretch_rate(contact.static_limit);
      if (!contact.may_lag() || u == 0 || u < most) return breakpoint;
      const SliderJump<T> there = slider(T(1), u).at_first_load();
      if (!there.sticks && there.guard != ActiveGuard::lower) return breakpoint;
      const T round = stretch_rate(largest_friction(2 * u));  // per second of delay
      load.rate = T(0);
      return std::min(breakpoint, time + u / round * known);
    }
    if (load.rate > 0) return breakpoint;
    const T ends = load.at(breakpoint - time);
    const T follows = has_slider_state()         ? 1 / branch().slope
                      : contact.static_limit > 0 ? u / contact.static_limit
                                                 : T(0);
    if (ends > rounding<T> * load.value + known * -load.rate ||
        load.value > known * (contact.stiffness * follows - load.rate))
      return breakpoint;
    load = {T(0), T(0)};
    return breakpoint;
  }

 protected:
  using Base::guard_, Base::branch_, Base::stick_state_, Base::slip_sign_;

 private:
  bool compliant() const { return !contact.rigid(); }
  bool is_unloaded() const { return load.value == 0 && !(load.rate > 0); }
  Slider<T> slider(T slip_sign, T u) const {
    return {contact, slip_sign * u, contact.rigid() ? T(0) : load.rate / contact.stiffness};
  }
  /// Largest friction (N at load factor 1) of a slider that accelerates from rest to a speed,
  /// before it jumps.
  T largest_friction(T speed) const {
    T most = contact.static_limit;
    for (int j = 0; j < contact.branches; ++j) {
      const Branch<T> range = contact.branch(j);
      if (range.slope < 0 || !(range.from < speed)) break;
      most = std::max(most, range.at(std::min(speed, range.to)));
    }
    return most;
  }
  bool is_nonzero(T distance, T u) const {
    using std::abs;
    const T size = abs(u) + abs(stretch_rate(contact.branch(branch_).force));
    return abs(distance) > jump_error<T> * size;
  }

  /// Sets the jump at a load of zero: loss of contact, slip under the growing load, or stick.
  /// Returns true if the result is at its stick limit.
  bool begin_load(const State<T>& s, T u) {
    jump_ = {};
    must_jump_ = true;
    guard_ = ActiveGuard::none;
    if (!is_unloaded()) {
      slip_sign_ = u < 0 ? T(-1) : T(1);
      jump_ = slider(slip_sign_, u).at_first_load();
      must_jump_ = !jump_.sticks || s.skin != 0 ||
                   slider(slip_sign_, u).stationary_speed(contact.static_limit) != 0;
    }
    jump_.shortens_skin = s.skin != 0;
    if (jump_.guard == ActiveGuard::lower || (jump_.sticks && u == 0))
      resolve_rest(slider(slip_sign_, u), slip_sign_, u);
    return !must_jump_;
  }

  /// True if the mode is the end of a slider jump.
  bool has_jumped() const {
    if (!compliant()) return false;
    const bool rests = stick_state_ == ContactState::elastic_stick;
    const bool elsewhere = rests ? sliding() : elastic() || mode.branch != branch_;
    return must_jump_ || mode.guard != guard_ || elsewhere;
  }

  T slider_speed_{0};            ///< slider speed before a jump, m/s
  SliderJump<T> jump_{};         ///< end of the jump
  SliderJump<T> alternative_{};  ///< second candidate for the end of the jump
  /// either slip sign is a candidate; the jump is the only candidate
  bool slips_either_way_{false}, must_jump_{false};
  bool has_alternative_{false};  ///< the second candidate exists
  bool had_pin_speed_{false};    ///< the slider had the speed of the pin
};

}  // namespace pindrive::detail
