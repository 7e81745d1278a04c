/// What a compliant contact has beside a rigid one: skin that stretches, and the slider at its end
/// (docs/theory.md, section 11).
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/law/slider.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/law/touch_state.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// The part of `Touch` that knows its slider.
template <class T>
class SlidingSkin : public TouchState<T> {
 public:
  using Base = TouchState<T>;
  using Base::Base, Base::contact, Base::surface, Base::load, Base::does, Base::before, Base::count;
  using Base::friction, Base::slip, Base::sliding, Base::elastic, Base::branch, Base::stick_limit;

  /// Whether the velocity of its slider is a state of its own, beside that of the pin.
  bool lags() const { return contact.may_lag() && sliding() && branch().slope != 0; }
  /// The speed of its slider, which lags; along its slip.
  T slide() const { return landed() ? T(landing_.speed) : slid_; }
  /// By how much the pin is faster than that, beside what the skin stretches as its load grows; none to rounding
  /// is none.
  T gap(T v) const {
    using std::abs;
    if (meets_ && slide() == slid_) return T(0);
    const T gap = does.sense * v - stretching(carried()) - slide();
    return abs(gap) < rounding<T> * abs(v) ? T(0) : gap;
  }
  /// The rate at which the stretch of a friction follows the load, m/s.
  T stretching(T of) const {
    return load.rate == 0 || contact.rigid() ? T(0) : load.rate * of / contact.stiffness;
  }
  /// The velocity of a pin at which what a contact does at an end of its range stays there, m/s.
  T level() const {
    if (contact.rigid()) return surface.value;
    return elastic() ? -sense_ * stretching(contact.static_limit)
                     : does.sense * stretching(branch().force);
  }
  /// By how much the pin is faster than that, m/s; none to rounding is none.
  T off_level(T v) const {
    using std::abs;
    const T off = v - level();
    return abs(off) < rounding<T> * abs(v) ? T(0) : off;
  }
  /// Whether its skin has become shorter at once.
  bool drops() const { return landed() && landing_.drops; }

  /// What it stretches its skin with as it slips under a load, N.
  T skin_force(const State<T>& s, T loaded) const {
    const Branch<T> range = branch();
    const T sense = does.sense;
    return sense * range.at(lags() ? sense * s.slide : range.from) * loaded;
  }
  /// Whether it moves by much in the rounding of a time, as a slider does that gets ever faster while its load
  /// falls: it then goes on by the time that is kept.
  bool rounds_time() const { return lags() && load.rate != 0; }
  /// Goes on with its force where its load is known to the rounding of the time only: it was `loaded`.
  void keeps_force(State<T>& s, T loaded) const {
    if (!lags() || loaded == load.value || !(load.value > 0)) return;
    const Branch<T> range = branch();
    s.slide +=
        does.sense * range.at(does.sense * s.slide) * (loaded / load.value - 1) / range.slope;
  }
  /// Brings the state to where the mode that was selected begins.
  void land(State<T>& s) const {
    if (does.state == ContactState::absent) s.skin = T(0);
    if (drops()) s.skin = grip(s);
    if (lags()) s.slide = does.sense * slide();
  }

 protected:
  /// Its friction under a load of 1 in what it does, N.
  T carried() const { return landed() ? T(landing_.friction) : friction; }
  /// The force that stretches its skin where it does not slip, N.
  T grip(const State<T>& s) const {
    return drops() ? (s.skin < 0 ? T(-1) : T(1)) * carried() * load.value : s.skin;
  }
  /// The rate of its force where its slider lags: the skin stretches by what the pin is faster.
  ForceRate<T> slip_rate(T v, T acceleration) const {
    using std::abs;
    const T stiffness = contact.stiffness, sense = does.sense;
    const T slope = branch().slope;
    const T faster = load.value == 0
                         ? sense * stiffness * acceleration / (stiffness + 2 * slope * load.rate)
                         : stiffness * gap(v) / (slope * load.value);
    return {-stiffness * (v - sense * slide()), stiffness * (abs(v) + slide()),
            -stiffness * (acceleration - sense * faster)};
  }
  /// What its slope multiplies, at most.
  T fastest(T v) const {
    using std::abs;
    return lags() ? branch().from + slid_ : abs(v) + abs(surface.value);
  }

  bool breaks() const { return compliant() && breaks_; }
  /// Whether it has neither force nor static friction, so that it may slip either way.
  bool either_way() const { return compliant() && either_way_; }
  /// Of what has come to the begin of a branch at the speed of the pin, the last: that it turns back.
  bool turns_back(int index) const { return compliant() && meets_other_ && index == count - 1; }
  TouchOption<T> after_landing(T sense, int index = 0) const {
    if (lifted()) return {};
    const Landing<T>& there = turns_back(index) ? other_ : landing_;
    if (!there.grips) return slip(there.turns ? -sense : sense, there.at, there.branch);
    if (!either_way_) return {ContactState::elastic_stick, Bound::none, 0, T(0)};
    const int way = breaks_ ? index : index - 1;
    if (way == 0) return {ContactState::elastic_stick, Bound::upper, 0, T(0)};
    return slip(way == 1 ? sense : -sense, Bound::lower);
  }

  /// The slider of a pin that slips at the start; where its curve falls it is no faster than it can be.
  void begin_slider(State<T>& s, T speed) {
    const Branch<T> range = branch();
    const T asked = range.at(speed);
    slid_ = speed;
    s.skin = does.sense * asked * load.value;
    if (range.slope < 0) {
      landing_ = slider(does.sense, does.sense * speed).slower(does.branch, asked);
      slid_ = landing_.speed;
      does = after_landing(does.sense);
      does.at = Bound::none;
    }
    s.slide = does.sense * slid_;
  }

  /// Finds out what it may do.
  [[gnu::noinline]] void ask_slider(const State<T>& s, T u) {
    Bound& at = at_;
    breaks_ = either_way_ = meets_ = meets_other_ = false;
    if (!contact.present()) return;
    if (load.value == 0 && !takes_load(s, u)) return;
    meets_ = sliding() && !lags();
    if (sliding() && load.value != 0) {
      const Branch<T> range = branch();
      const auto goes = slider(sense_, u);
      const T speed = lags() ? sense_ * s.slide : goes.pin(range.force);
      if (meets_ && at != Bound::none &&
          off(speed - (at == Bound::upper ? range.to : range.from), u))
        at = Bound::none;  // its load has changed its rate
      const Bound came_to = at;
      if (at == Bound::none && speed >= range.to) at = Bound::upper;
      if (at == Bound::none && !(speed > range.from)) at = Bound::lower;
      // A pin whose velocity has jumped takes along a slider that does not lag.
      const T jumps = at == Bound::upper ? speed - range.to : range.from - speed;
      breaks_ = meets_ && came_to == Bound::none && at != Bound::none &&
                jumps > 2 * rounding<T> * (range.from + (speed < 0 ? -speed : speed));
      meets_ = meets_ && !breaks_;
      slid_ = at == Bound::none ? speed : at == Bound::upper ? range.to : range.from;
      friction = range.at(lags() ? slid_ : range.from);
      const T pulls = sense_ * s.skin, most = friction * load.value;
      if (std::abs(plain(pulls - most)) > 64 * rounding<T> * plain(pulls + most) + s.roundoff) {
        breaks_ = true;  // its load has jumped
        meets_ = false;
        landing_ = pulls > most ? goes.faster(branch_, pulls / load.value)
                                : goes.slower(branch_ + 1, pulls / load.value);
        comes_to_rest(goes, sense_, u);
        return;
      }
      if (at == Bound::none) return;
      if (at == Bound::upper || branch_ > 0) {
        const int beyond = branch_ + (at == Bound::upper ? 1 : 0);
        const T asked = friction = contact.branch(beyond).force;
        landing_ = at == Bound::upper ? goes.faster(beyond, asked) : goes.slower(beyond, asked);
        count = breaks_ ? 1 : 2;
        comes_to_rest(goes, sense_, u);
        if (at == Bound::upper || !landing_.grips || asked < contact.static_limit) return;
      }
    }
    friction = contact.branch(0).force;
    count = 1;
    breaks_ = false;
    at = Bound::none;
    rest_ = ContactState::elastic_stick;  // with the force that it has
    const T most = stick_limit(), grows = stretching(contact.static_limit);
    const bool empty = !(most > 0) && s.skin == 0;
    either_way_ = empty && !(grows > 0);
    sense_ = (empty ? u > 0 : s.skin > 0) ? T(-1) : T(1);  // of the force
    const T pulls = -sense_ * s.skin;
    const bool exceeds = pulls > most + rounding<T> * most + s.roundoff;
    if (!exceeds && (pulls < most || sense_ * u > -grows)) return;
    at = Bound::upper;
    breaks_ = exceeds;
    const auto goes = slider(-sense_, u);
    landing_ = goes.faster(0, breaks_ ? pulls / load.value : contact.static_limit);
    if (landing_.drops && landing_.at == Bound::lower && load.rate < 0)  // nor does it slip on
      landing_ = goes.gripping(landing_);
    count = breaks_ ? 1 : either_way_ && u == 0 ? 3 : 2;
    comes_to_rest(goes, -sense_, u);
  }
  /// What follows where it has landed: without static friction what grips slips on with the pin, or the way that
  /// a pin at rest sets out, and where it meets the speed of the pin at the begin of a branch, only the pin's
  /// acceleration tells which way it goes.
  void comes_to_rest(const Slider<T>& goes, T sense, T u) {
    if (landing_.grips && contact.static_limit == 0) {
      either_way_ = u == 0;
      if (either_way_) {
        count += 2;
        return;
      }
      landing_ = slider(-sense, u).faster(0, T(0));
      landing_.drops = landing_.turns = true;
    }
    if (landing_.at != Bound::lower || landing_.turns) return;
    const bool meets = goes.misses(landing_.speed, landing_.friction) == 0;
    if (!breaks_ && !(meets && landing_.branch > 0)) return;
    other_ = goes.slower(landing_.branch, landing_.friction);
    meets_other_ = breaks_ || landing_.drops || !other_.grips;
    if (meets_other_) ++count;
  }

 public:
  /// Where no mode of its skin lasts next to a load of zero, it has none while that is nearer than the rounds
  /// of grip and slip need that are known by their times. When the load is to be asked again, s.
  [[gnu::noinline]] T keeps_off_zero(State<T>& s, T time, T row) {
    if (load.rate == 0 || contact.rigid() || !contact.present()) return row;
    const T u = s.v < 0 ? -s.v : s.v, known = first_grip<T> * row;
    if (load.value == 0 && load.rate > 0) {
      const T most = stretching(contact.static_limit);
      if (!contact.may_lag() || u == 0 || u < most) return row;
      const Landing<T> there = slider(T(1), u).from_zero();
      if (!there.grips && there.at != Bound::lower) return row;
      const T round = stretching(carries_at_most(2 * u));  // for each second that it waits
      load.rate = T(0);
      return std::min(row, time + u / round * known);
    }
    if (load.rate > 0) return row;
    const T ends = load.at(row - time);
    const T follows = lags()                     ? 1 / branch().slope
                      : contact.static_limit > 0 ? u / contact.static_limit
                                                 : T(0);
    if (ends > rounding<T> * load.value + known * -load.rate ||
        load.value > known * (contact.stiffness * follows - load.rate))
      return row;
    load = {T(0), T(0)};
    return row;
  }

 protected:
  using Base::at_, Base::branch_, Base::rest_, Base::sense_;

 private:
  bool compliant() const { return !contact.rigid(); }
  bool lifted() const { return load.value == 0 && !(load.rate > 0); }
  Slider<T> slider(T sense, T u) const {
    return {contact, sense * u, contact.rigid() ? T(0) : load.rate / contact.stiffness};
  }
  /// The friction under a load of 1 that a slider may carry which gets faster from rest, until it runs away or has
  /// come to a speed, N.
  T carries_at_most(T speed) const {
    T most = contact.static_limit;
    for (int j = 0; j < contact.branches; ++j) {
      const Branch<T> range = contact.branch(j);
      if (range.slope < 0 || !(range.from < speed)) break;
      most = std::max(most, range.at(std::min(speed, range.to)));
    }
    return most;
  }
  bool off(T distance, T u) const {
    using std::abs;
    const T size = abs(u) + abs(stretching(contact.branch(branch_).force));
    return abs(distance) > 64 * rounding<T> * size;
  }

  /// What it does where its load is zero: it lifts, slides on as the load grows, or grips. Whether it is at the
  /// limit of that grip.
  bool takes_load(const State<T>& s, T u) {
    landing_ = {};
    breaks_ = true;
    at_ = Bound::none;
    if (!lifted()) {
      sense_ = u < 0 ? T(-1) : T(1);
      landing_ = slider(sense_, u).from_zero();
      breaks_ = !landing_.grips || s.skin != 0 || slider(sense_, u).pin(contact.static_limit) != 0;
    }
    landing_.drops = s.skin != 0;
    if (landing_.at == Bound::lower || (landing_.grips && u == 0))
      comes_to_rest(slider(sense_, u), sense_, u);
    return !breaks_;
  }

  /// Whether what it does is where its slider has come to at once.
  bool landed() const {
    if (!compliant()) return false;
    const bool rests = rest_ == ContactState::elastic_stick;
    const bool elsewhere = rests ? sliding() : elastic() || does.branch != branch_;
    return breaks_ || does.at != at_ || elsewhere;
  }

  T slid_{0};                               ///< the speed of the slider until now, …
  Landing<T> landing_{};                    ///< … where it comes to, …
  Landing<T> other_{};                      ///< … or, from there, …
  bool either_way_{false}, breaks_{false};  ///< … whether it could not but go there, …
  bool meets_other_{false};                 ///< … where it may do both, …
  bool meets_{false};                       ///< … and whether it had the speed of the pin
};

}  // namespace pindrive::detail
