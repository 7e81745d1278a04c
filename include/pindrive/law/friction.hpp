/// The law of friction at an instant: what each contact may do next and the force that it carries
/// (docs/theory.md, section 4).
#pragma once

#include <cmath>

#include "pindrive/law/oblique.hpp"
#include "pindrive/law/skin.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// A contact at an instant: its surface and its load from here on, what it may do next and, of that,
/// what it does.
template <class T>
struct Touch : SlidingSkin<T> {
  using Base = SlidingSkin<T>;
  using Option = TouchOption<T>;
  using Base::Base, Base::contact, Base::surface, Base::load, Base::across, Base::does;
  using Base::before, Base::reached, Base::count, Base::friction, Base::direction;
  using Base::lags, Base::gap, Base::drops;
  using Base::slip, Base::sliding, Base::elastic, Base::branch, Base::stick_limit;

  bool may_stick() const { return rest_ == ContactState::stick; }
  /// Of what stuck under a force, the likelier slip is asked first: it matters where the law allows both.
  void breaks_under(T force) {
    if (sense_ == 0) sense_ = force < 0 ? T(-1) : T(1);
  }
  bool stuck() const { return does.state == ContactState::stick; }
  bool oblique() const { return does.state == ContactState::slip_oblique; }
  /// Whether nothing but its relative acceleration tells where it goes.
  bool rests(T v) const {
    if (does.at == Bound::none || oblique()) return false;
    return elastic() ? this->off_level(v) == 0 : !lags() || gap(v) == 0;
  }
  /// What it does at the start: it slips unless its surface has the velocity of the pin.
  void begin(State<T>& s, bool stretched) {
    const T u = s.v - surface.value, size = u < 0 ? -u : u;
    if (!contact.present() || (!contact.rigid() && load.value == 0)) return;
    const bool skin = !contact.rigid() && (stretched || s.v == 0);
    does.state = skin ? ContactState::elastic_stick : ContactState::stick;
    if (skin || u == 0) return;
    does = slip(u / size, Bound::none, contact.branch_of(size));
    if (lags())
      this->begin_slider(s, size);
    else if (!contact.rigid())
      s.skin = this->skin_force(s, load.value);
  }

  /// Without a load for ever it is absent.
  void take_off(const Profile<T>& given) {
    if (!given.constant() || given.first() != 0) return;
    contact = {};
    does = {};
  }

  /// Finds out what it may do. A speed that has reached no bound and is not inside its branch is at the end
  /// of it.
  void ask(const State<T>& s) {
    before = does.state;
    count = 1;
    at_ = reached;
    reached = Bound::none;
    rest_ = ContactState::absent;
    const T u = s.v - surface.value;
    const bool across_too = asks_across(*this, u, at_);
    goes_on_ = does.state;
    sense_ = does.sense;
    branch_ = does.branch;
    if (across_too) return;
    if (!contact.rigid()) return this->ask_slider(s, u);
    if (sliding()) {
      const Branch<T> range = branch();
      const T speed = sense_ * u;
      if (at_ == Bound::none && speed >= range.to) at_ = Bound::upper;
      if (at_ == Bound::none && !(speed > range.from)) at_ = Bound::lower;
      friction = range.at(speed);
      if (at_ == Bound::none) return;
      if (at_ == Bound::upper || branch_ > 0) {
        // At a breakpoint it is one number, whichever branch follows.
        friction = contact.branch(at_ == Bound::upper ? branch_ + 1 : branch_).force;
        count = 2;
        return;
      }
    }
    friction = contact.branch(0).force;
    if (before == ContactState::absent) return;
    at_ = Bound::none;
    parts_ = Bound::lower;
    rest_ = ContactState::stick;
    count = 3;
  }

  /// What it may do, the preferred first: to stick, else to go on as it does.
  Option option(int index) const {
    if (this->breaks() || this->turns_back(index))
      return this->after_landing(rest_ == ContactState::absent ? sense_ : -sense_, index);
    if (rest_ == ContactState::absent) {
      if (index == 0) return {goes_on_, at_, branch_, sense_};
      if (!contact.rigid()) return this->after_landing(sense_, index);
      const bool faster = at_ == Bound::upper;
      return {goes_on_, faster ? Bound::lower : Bound::upper, branch_ + (faster ? 1 : -1), sense_};
    }
    if (index == 0) return {rest_, at_, 0, T(0)};
    const bool backward = (index == 1) == (sense_ > 0);
    const T sense = backward ? T(-1) : T(1);
    return contact.rigid() ? slip(sense, parts_) : this->after_landing(sense);
  }

  /// Its force on the pin, unless it sticks, N, …
  T force(const State<T>& s) const {
    if (elastic()) return -this->grip(s);
    return -(oblique() ? direction : does.sense) * this->carried() * load.value;
  }
  /// … how fast it changes on a pin of this acceleration, how large the terms of that rate are, as its slope
  /// is known to rounding only, and how fast the rate changes while the acceleration is constant.
  using Rate = ForceRate<T>;
  Rate force_rate(T v, T acceleration) const {
    using std::abs;
    const T stretching = contact.stiffness * v;
    if (elastic()) return {-stretching, abs(stretching), -contact.stiffness * acceleration};
    if (!sliding()) return {};
    if (lags()) return this->slip_rate(v, acceleration);
    const Branch<T> range = branch();
    const T faster = acceleration - surface.rate;
    T rate{}, bend{};
    if (oblique()) {
      const ObliqueSlip<T> speed = slides(v, acceleration);
      rate = speed.force_rate(range, load);
      bend = speed.force_bend(range, load);
    } else {
      rate = -range.slope * load.value * faster - does.sense * this->carried() * load.rate;
      bend = -2 * range.slope * load.rate * faster;
    }
    const T unsure = range.rounding * load.value * abs(faster);
    return {rate, abs(rate) + unsure / rounding<T>, bend};
  }
  /// What the rounding of this velocity of the pin makes of its force, N: much where it hardly slides across.
  T unsure(T v) const {
    using std::abs;
    if (!oblique() || v == 0) return T(0);
    return rounding<T> * abs(v * slides(v, surface.rate).steepness(branch(), load));
  }
  /// How large the terms are that it brings into a sum of forces, N.
  T size(T v) const {
    using std::abs;
    if (contact.branches == 0 || !sliding()) return stick_limit();
    const T rounded = abs(branch().slope) * this->fastest(v);
    return (contact.static_limit + rounded) * load.value + friction * load.value;
  }

  /// Its force in its mode, unless it sticks: where it slips, −s (F + c (s u − from)) λ, u = x' − surface; where it
  /// slips across too, that of its present sliding velocity.
  Force<T> law(const State<T>& s) const {
    if (elastic()) return {{-s.skin, T(0)}, T(0), contact.stiffness, T(0)};
    if (oblique()) {
      const T axial = -direction * this->carried();
      return {{axial * load.value, axial * load.rate}};
    }
    if (!sliding()) return {};
    const Branch<T> range = branch();
    const T force = -does.sense * range.force;
    Force<T> law{{force * load.value, force * load.rate}};
    if (vanishes(range.slope)) return law;
    const T from = does.sense * range.from;
    law.drag = range.slope * load.value;
    law.constant.value += law.drag * (from + surface.value);
    law.constant.rate += range.slope * load.rate * from + law.drag * surface.rate;
    if (range.slope != 0) law.rounding = range.rounding * load.value;
    return law;
  }

  /// Whether its force goes on without a jump after a stick force has come to its limit on a side.
  bool continues(int limit) const {
    if (drops() || before == does.state) return !drops();
    if (contact.kinetic != contact.static_limit && load.value != 0) return false;
    return before == ContactState::stick ? does.sense == -limit
                                         : before == ContactState::elastic_stick;
  }

  /// Whether what is at an end of its range goes, or stays, inside, by the first derivative of its
  /// relative velocity that is not zero. Without any it stays; but it would not slip.
  bool goes_inside(const State<T>& s, T first, T second = T(0), T third = T(0)) const {
    if (does.at == Bound::none) return true;
    if (oblique()) {
      const ObliqueSlip<T> speed = slides(s.v, surface.rate + first);
      const T closing = speed.closing(), known = speed.rounding_of(surface.value);
      const T parting = speed.parting(second);
      const bool turns = closing == 0 || touches(closing, parting, known);
      T faster = closing;
      if (turns) faster = parting != 0 ? parting : speed.u.value * third;
      if (faster == 0) faster = second * second;  // it begins to turn
      return (does.at == Bound::lower ? faster : -faster) >= 0;
    }
    const T decides = first != 0 ? first : second != 0 ? second : third;
    if (!elastic()) {
      const T faster = lags() ? gap(s.v) : T(0);
      const T inwards = faster != 0 ? (does.at == Bound::lower ? faster : -faster)
                                    : does.sense * (does.at == Bound::lower ? decides : -decides);
      return inwards > 0 || (inwards == 0 && (does.at == Bound::upper || does.branch > 0));
    }
    if (this->either_way()) return s.v == 0 && decides == 0;
    const T stretches = contact.stiffness * sense_, faster = this->off_level(s.v);
    if (faster == 0) return sense_ * decides >= 0;
    return sense_ * faster > 0 || touches(stretches * faster, stretches * decides, s.roundoff);
  }

  ObliqueSlip<T> slides(T v, T acceleration) const {
    return {{v - surface.value, acceleration - surface.rate}, across};
  }

 private:
  using Base::goes_on_, Base::sense_, Base::branch_, Base::at_, Base::rest_, Base::parts_;
};

}  // namespace pindrive::detail
