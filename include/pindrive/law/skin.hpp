/// Skin and slider of a compliant contact (docs/theory.md, section 4).
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/law/contact_mode.hpp"
#include "pindrive/law/slider.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Slider of a contact, for a relative pin velocity u (m/s) and a direction of slip.
template <class T, class Point>
Slider<T> slider_of(const Point& point, T slip_sign, T u) {
  const auto& contact = point.contact;
  return {contact, slip_sign * u, contact.rigid() ? T(0) : point.load.rate / contact.stiffness};
}

/// Mode after a slider jump.
template <class T>
ContactMode<T> mode_after(const SliderJump<T>& jump, T slip_sign) {
  if (jump.sticks) return {ContactState::elastic_stick, ActiveGuard::none, 0, T(0)};
  return ContactMode<T>::slip(jump.reverses ? -slip_sign : slip_sign, jump.guard, jump.branch);
}

/// Sets the slider of a pin that slips at the release. On a falling branch the slider starts at the
/// largest stable speed.
template <class T, class Point>
void initialize_slider(Point& point, State<T>& s, T speed) {
  auto& mode = point.mode;
  const Branch<T> range = point.branch();
  const T friction = range.at(speed);
  point.start.slider_speed = speed;
  s.skin = mode.slip_sign * friction * point.load.value;
  if (range.slope < 0) {
    const auto jump =
        slider_of(point, mode.slip_sign, mode.slip_sign * speed).next_slower(mode.branch, friction);
    point.start.slider_speed = jump.speed;
    mode = mode_after(jump, mode.slip_sign);
    mode.guard = ActiveGuard::none;
  }
  s.slider_velocity = mode.slip_sign * point.start.slider_speed;
}

/// Keeps the skin tension where the load is known only to the time resolution; `loaded` is the load
/// factor before.
template <class T, class Point>
void keep_force(const Point& point, State<T>& s, T loaded) {
  const T now = point.load.value;
  if (!point.has_slider_state()) return;
  if (!point.contact.damped() && (loaded == now || !(now > 0))) return;
  const Branch<T> range = point.branch();
  const T friction = point.mode.slip_sign * range.at(point.mode.slip_sign * s.slider_velocity);
  s.slider_velocity += point.slider_change(friction * (loaded - now));
}

/// Enumeration of the candidate modes of a compliant contact at an instant, for a relative pin
/// velocity u (m/s).
template <class T, class Point>
class SliderCandidates {
 public:
  SliderCandidates(Point& point, const State<T>& s, T u, ActiveGuard guard)
      : point_(point),
        contact_(point.contact),
        s_(s),
        u_(u),
        present_(point.mode),
        start_{point.start.friction, point.start.slider_speed, false, false} {
    present_.guard = guard;
  }

  [[gnu::noinline]] void enumerate() {
    add_all();
    point_.start = start_;
  }

 private:
  void add_all() {
    point_.slips_either_way = false;
    if (!contact_.present()) return add_present();
    if (point_.load.value == 0 && !may_grip()) return;
    start_.keeps_speed = point_.sliding() && !point_.has_slider_state();
    if (point_.sliding() && point_.load.value != 0 && slips_on()) return;
    stick_or_slip();
  }

  void add_present() { point_.candidates.add(present_, start_); }

  /// Adds a mode after a jump. A jump that ends where the slider is changes nothing.
  void add(const ContactMode<T>& mode, const SliderJump<T>& jump) {
    const bool stays = !must_jump_ && is_slip(present_.state) && is_slip(mode.state) &&
                       mode.branch == present_.branch && mode.guard == present_.guard;
    const bool keeps_speed = start_.keeps_speed && jump.speed == start_.slider_speed;
    point_.candidates.add(
        mode,
        stays ? start_ : ModeStart<T>{jump.friction, jump.speed, keeps_speed, jump.shortens_skin});
  }

  /// Adds the candidates after a jump, for a direction of slip.
  ///
  /// Without static friction, a sticking skin slips with the pin or, under a pin at rest, to either
  /// side. If the jump ends at the begin of a branch with the speed of the pin, the acceleration of
  /// the pin decides.
  void add_jump(SliderJump<T> jump, const Slider<T>& slider, T slip_sign, bool both_ways = false) {
    if (jump.sticks && contact_.static_limit == 0) {
      if (u_ == 0) {
        point_.slips_either_way = true;
        add({ContactState::elastic_stick, ActiveGuard::upper, 0, T(0)}, jump);
        for (const T sign : {slip_sign, -slip_sign})
          add(ContactMode<T>::slip(sign, ActiveGuard::lower), jump);
        return;
      }
      jump = slider_of(point_, -slip_sign, u_).next_faster(0, T(0));
      jump.shortens_skin = jump.reverses = true;
    }
    add(mode_after(jump, slip_sign), jump);
    if (both_ways) add(mode_after(jump, -slip_sign), jump);
    if (jump.guard != ActiveGuard::lower || jump.reverses) return;
    const bool meets = slider.excess(jump.speed, jump.friction) == 0;
    if (!must_jump_ && !(meets && jump.branch > 0)) return;
    const SliderJump<T> back = slider.next_slower(jump.branch, jump.friction);
    if (must_jump_ || jump.shortens_skin || !back.sticks) add(mode_after(back, slip_sign), jump);
  }

  /// Adds the candidates at a load of zero: loss of contact, or slip under the growing load.
  /// Returns true if the contact is at its stick limit instead.
  bool may_grip() {
    must_jump_ = true;
    SliderJump<T> jump{};
    if (!(point_.load.rate > 0)) {
      jump.shortens_skin = s_.skin != 0;
      add({}, jump);
      return false;
    }
    const T slip_sign = point_.slip_sign = u_ < 0 ? T(-1) : T(1);
    const auto slider = slider_of(point_, slip_sign, u_);
    jump = slider.at_first_load();
    must_jump_ =
        !jump.sticks || s_.skin != 0 || slider.stationary_speed(contact_.static_limit) != 0;
    jump.shortens_skin = s_.skin != 0;
    if (must_jump_ && jump.sticks && u_ != 0)
      add(mode_after(jump, slip_sign), jump);
    else if (must_jump_)
      add_jump(jump, slider, slip_sign);
    return !must_jump_;
  }

  /// Adds the candidates of a contact that slips under a load. Returns false if it may stick.
  bool slips_on() {
    ActiveGuard& guard = present_.guard;
    const T slip_sign = present_.slip_sign;
    const Branch<T> range = point_.branch();
    const auto slider = slider_of(point_, slip_sign, u_);
    const bool own_speed = point_.has_slider_state();
    const T speed =
        own_speed ? slip_sign * s_.slider_velocity : slider.stationary_speed(range.force);
    if (!own_speed && guard != ActiveGuard::none &&
        is_nonzero(speed - (guard == ActiveGuard::upper ? range.to : range.from)))
      guard = ActiveGuard::none;  // the rate of the load has changed
    const ActiveGuard reached = guard;
    if (guard == ActiveGuard::none && speed >= range.to) guard = ActiveGuard::upper;
    if (guard == ActiveGuard::none && !(speed > range.from)) guard = ActiveGuard::lower;
    // A slider without its own velocity follows a jump of the pin velocity.
    const T beyond_end = guard == ActiveGuard::upper ? speed - range.to : range.from - speed;
    must_jump_ =
        !own_speed && reached == ActiveGuard::none && guard != ActiveGuard::none && beyond_end > 0;
    start_.keeps_speed = !own_speed && !must_jump_;
    start_.slider_speed = guard == ActiveGuard::none    ? speed
                          : guard == ActiveGuard::upper ? range.to
                                                        : range.from;
    start_.friction = range.at(own_speed ? start_.slider_speed : range.from);
    const T tension = slip_sign * s_.skin, most = start_.friction * point_.load.value;
    const int branch = present_.branch;
    if (std::abs(plain(tension - most)) > s_.force_error) {
      must_jump_ = true;  // the load has jumped
      start_.keeps_speed = false;
      const T friction = tension / point_.load.value;
      add_jump(tension > most ? slider.next_faster(branch, friction)
                              : slider.next_slower(branch + 1, friction),
               slider, slip_sign);
      return true;
    }
    if (guard == ActiveGuard::none) {
      add_present();
      return true;
    }
    const bool upper = guard == ActiveGuard::upper;
    if (!upper && branch == 0) return false;
    const int beyond = branch + (upper ? 1 : 0);
    const T friction = start_.friction = contact_.branch(beyond).force;
    const auto jump =
        upper ? slider.next_faster(beyond, friction) : slider.next_slower(beyond, friction);
    const bool sticks = jump.sticks && (contact_.static_limit != 0 || u_ == 0);
    if (!upper && sticks && !(friction < contact_.static_limit)) return false;
    if (!must_jump_) add_present();
    add_jump(jump, slider, slip_sign);
    return true;
  }

  /// Adds the candidates of skin that sticks with its present tension or begins to slip.
  void stick_or_slip() {
    start_.friction = contact_.branch(0).force;
    must_jump_ = false;
    present_ = {ContactState::elastic_stick, ActiveGuard::none, 0, T(0)};
    const T most = point_.stick_limit(), stretch_rate = point_.stretch_rate(contact_.static_limit);
    const bool empty = !(most > 0) && s_.skin == 0;
    point_.slips_either_way = empty && !(stretch_rate > 0);
    point_.slip_sign = (empty ? u_ > 0 : s_.skin > 0) ? T(-1) : T(1);  // sign of the force
    const T slip_sign = -point_.slip_sign, tension = slip_sign * s_.skin;
    const bool exceeds = tension > most + s_.force_error;
    if (!exceeds && (tension < most || point_.slip_sign * u_ > -stretch_rate)) return add_present();
    present_.guard = ActiveGuard::upper;
    must_jump_ = exceeds;
    const auto slider = slider_of(point_, slip_sign, u_);
    SliderJump<T> jump =
        slider.next_faster(0, must_jump_ ? tension / point_.load.value : contact_.static_limit);
    if (jump.shortens_skin && jump.guard == ActiveGuard::lower && point_.load.rate < 0)
      jump = slider.sticking(jump);  // slip cannot continue either
    if (!must_jump_) add_present();
    add_jump(jump, slider, slip_sign, !must_jump_ && point_.slips_either_way && u_ == 0);
  }

  bool is_nonzero(T distance) const {
    const T size = abs(u_) + abs(point_.stretch_rate(contact_.branch(present_.branch).force));
    // rounding: tests/hard/slider-at-end-of-plateau-as-the-load-rate-changes.txt
    return abs(distance) > difference_error<T> * size;
  }

  Point& point_;
  const Contact<T>& contact_;
  const State<T>& s_;
  T u_;
  ContactMode<T> present_;  ///< mode that continues
  ModeStart<T> start_;      ///< its friction and slider
  bool must_jump_{false};   ///< the present mode cannot continue
};

/// Largest friction (N at load factor 1) of a slider that accelerates from rest to a speed, before
/// it jumps.
template <class T>
T largest_friction(const Contact<T>& contact, T speed) {
  T most = contact.static_limit;
  for (int j = 0; j < contact.branches; ++j) {
    const Branch<T> range = contact.branch(j);
    if (range.slope < 0 || !(range.from < speed)) break;
    most = std::max(most, range.at(std::min(speed, range.to)));
  }
  return most;
}

/// Removes the load while it is too close to zero for a lasting mode: alternations of stick and slip
/// would be shorter than the time resolution.
///
/// Returns the time at which the load is to be evaluated again, s.
template <class T, class Point>
[[gnu::noinline]] T defer_first_grip(Point& point, T v, T time, T breakpoint) {
  const Contact<T>& contact = point.contact;
  Curve<T>& load = point.load;
  if (load.rate == 0 || contact.rigid() || contact.damped() || !contact.present())
    return breakpoint;
  const T u = v < 0 ? -v : v, delay = first_grip<T> * breakpoint;
  if (load.value == 0 && load.rate > 0) {
    const T most = point.stretch_rate(contact.static_limit);
    if (!contact.may_lag() || u == 0 || u < most) return breakpoint;
    const SliderJump<T> there = slider_of(point, T(1), u).at_first_load();
    if (!there.sticks && there.guard != ActiveGuard::lower) return breakpoint;
    const T round = point.stretch_rate(largest_friction(contact, 2 * u));  // per second of delay
    load.rate = T(0);
    return std::min(breakpoint, time + u / round * delay);
  }
  if (load.rate > 0) return breakpoint;
  // rounding: tests/hard/slider-under-load-just-above-zero.txt
  const T ends = load.at(breakpoint - time);
  const T follows = point.has_slider_state()   ? 1 / point.branch().slope
                    : contact.static_limit > 0 ? u / contact.static_limit
                                               : T(0);
  if (ends > delay * -load.rate || load.value > delay * (contact.stiffness * follows - load.rate))
    return breakpoint;
  load = {T(0), T(0)};
  return breakpoint;
}

}  // namespace pindrive::detail
