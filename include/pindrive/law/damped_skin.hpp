/// Skin with damping: a Kelvin-Voigt element in series with a slider (docs/theory.md, section 4).
///
/// Skin and slider have no mass. With the stretch s, the tension P = K s + b x' that the skin would
/// have if the slider stuck is continuous wherever the velocity of the pin is. The slider moves with
/// a speed y > 0 for which λ F(y) + b y = |P|, and rests where |P| is within static friction.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/law/contact_mode.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Enumeration of the candidate modes of skin with damping at an instant.
template <class T, class Point>
class DampedSkinCandidates {
 public:
  DampedSkinCandidates(Point& point, const State<T>& s, ActiveGuard guard)
      : point_(point),
        contact_(point.contact),
        load_(point.load.value),
        tension_(s.skin),
        error_(s.force_error),
        present_(point.mode) {
    present_.guard = guard;
    speed_ = point.mode.slip_sign * s.slider_velocity;
  }

  [[gnu::noinline]] void enumerate() {
    point_.slips_either_way = false;
    if (!contact_.present())
      add(present_, T(0));
    else if (!point_.sliding() || !slips_on())
      stick_or_slip();
  }

 private:
  /// Slip at a speed on a branch of the friction curve; `none` if the slider does not slip.
  struct Slip {
    int branch;
    T speed;
    ActiveGuard guard{ActiveGuard::none};
    bool none{false};
  };

  /// Increase of the tension with the slider speed on a branch, N s/m; the slip is stable if it is
  /// positive.
  T rise(int branch) const { return contact_.branch(branch).slope * load_ + contact_.damping; }
  T tension_at_begin(int branch) const {
    const Branch<T> range = contact_.branch(branch);
    return range.force * load_ + contact_.damping * range.from;
  }
  T speed_on(int branch, T tension) const {
    return contact_.branch(branch).from + (tension - tension_at_begin(branch)) / rise(branch);
  }

  /// Least stable slip, from a branch upwards, under a tension in its direction.
  Slip faster(int from, T tension) const {
    for (int j = from;; ++j) {
      const T begins = tension_at_begin(j);
      if (!(rise(j) > 0)) continue;
      if (!(tension > begins + error_)) return {j, contact_.branch(j).from, ActiveGuard::lower};
      const T speed = speed_on(j, tension);
      if (j + 1 >= contact_.branches || speed < contact_.branch(j).to) return {j, speed};
    }
  }
  /// Fastest stable slip below a branch, under a tension in its direction.
  Slip slower(int below, T tension) const {
    for (int j = below - 1; j >= 0; --j) {
      const T begins = tension_at_begin(j), to = contact_.branch(j).to;
      if (!(rise(j) > 0 && tension > begins + error_)) continue;
      const T speed = speed_on(j, tension);
      if (speed < to) return {j, speed};
      return {j, to, ActiveGuard::upper};
    }
    return {0, T(0), ActiveGuard::none, true};
  }

  void add(const ContactMode<T>& mode, T speed) {
    const Branch<T> range = contact_.branch(mode.branch);
    point_.candidates.add(mode, {range.at(speed), speed, false, false});
  }
  void add_slip(const Slip& slip, T slip_sign) {
    add(ContactMode<T>::slip(slip_sign, slip.guard, slip.branch), slip.speed);
  }
  void add_stick(ActiveGuard guard) { add({ContactState::elastic_stick, guard, 0, T(0)}, T(0)); }
  /// Adds the slip after a jump of the speed, at the end of a branch also that beyond; without a stable slip, stick or
  /// slip in the other direction.
  void add_jump(const Slip& slip, T slip_sign) {
    if (slip.none) return stick_or_slip();
    add_slip(slip, slip_sign);
    if (slip.guard == ActiveGuard::upper)
      add_slip(faster(slip.branch + 1, slip_sign * tension_), slip_sign);
  }

  /// Adds the candidates of a slider that slips. Returns false if it may stick.
  bool slips_on() {
    ActiveGuard& guard = present_.guard;
    const T slip_sign = present_.slip_sign;
    const int branch = present_.branch;
    const Branch<T> range = contact_.branch(branch);
    if (guard == ActiveGuard::none && speed_ >= range.to) guard = ActiveGuard::upper;
    if (guard == ActiveGuard::none && !(speed_ > range.from)) guard = ActiveGuard::lower;
    const T speed = guard == ActiveGuard::none    ? speed_
                    : guard == ActiveGuard::upper ? range.to
                                                  : range.from;
    const T tension = slip_sign * tension_;
    const T most = range.at(speed) * load_ + contact_.damping * speed;
    const bool jumps = abs(tension - most) > error_;
    if (jumps || !(rise(branch) > 0)) {  // a load or the velocity of the pin has jumped
      // rounding: tests/hard/pin-held-at-a-stop-on-damped-skin.txt
      error_ += rounding<T> * most;
      const bool up = jumps && tension > most;
      return add_jump(up ? faster(branch, tension) : slower(branch + 1, tension), slip_sign), true;
    }
    if (guard == ActiveGuard::none) return add(present_, speed), true;
    const bool up = guard == ActiveGuard::upper;
    if (!up && branch == 0) return false;
    add(present_, speed);
    const int beyond = branch + (up ? 1 : -1);
    if (rise(beyond) > 0)
      add(ContactMode<T>::slip(slip_sign, up ? ActiveGuard::lower : ActiveGuard::upper, beyond),
          speed);
    else
      add_jump(up ? faster(beyond, tension) : slower(beyond, tension), slip_sign);
    return true;
  }

  /// Adds the candidates of a slider that sticks or begins to slip. With static friction above
  /// kinetic friction it begins with a speed.
  void stick_or_slip() {
    const T most = contact_.static_limit * load_, tension = abs(tension_);
    const bool exceeds = tension > most + error_;
    const T slip_sign = tension_ < 0 ? T(-1) : T(1);
    point_.slip_sign = -slip_sign;  // sign of the force
    point_.slips_either_way = most == 0 && tension_ == 0;
    if (!exceeds && tension < most) return add_stick(ActiveGuard::none);
    if (!exceeds) add_stick(ActiveGuard::upper);
    const Slip slip = faster(0, tension);
    add_slip(slip, slip_sign);
    if (point_.slips_either_way) add_slip(slip, -slip_sign);
  }

  Point& point_;
  const Contact<T>& contact_;
  const T load_, tension_;
  T error_;                 ///< of the tension, N
  T speed_;                 ///< in the direction of slip, m/s
  ContactMode<T> present_;  ///< mode that continues
};

}  // namespace pindrive::detail
