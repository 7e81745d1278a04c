/// Kernel for many standard releases at once: rigid Coulomb contacts at both surfaces, constant
/// mouse velocity, less than critical damping. One text serves a drive and a pack of drives.
///
/// Between two events the pin oscillates about a fixed centre: c_A, c_B or c_C = (∓F_p ∓ F_f)/k
/// while the pin is faster than the plate, between plate and finger, or moves backward. From one
/// turning point to the next takes half a period, which costs one multiplication: x − c becomes −q
/// (x − c). If the velocity reaches that of the plate within half a period, the pin overtakes the
/// plate or sticks to it.
///
/// A motion is divided into rounds. The first round begins at the release, each later one as the
/// velocity of the pin reaches that of the plate, or exceeds it from the start; a round ends at
/// permanent rest, or before the velocity of the plate is reached again. Releases that need another
/// round are gathered first, so that packs stay full.
///
/// A release is left to the general core if it is not standard, if rounding could decide the next
/// event, if a stick-slip cycle repeats for ever, and if it needs too many half periods or rounds.
#pragma once

#include "pindrive/kernel/kernel_progress.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// Round, from one progress to the next. `Later`: not the first round.
template <class V, bool Later, bool Measured>
class Round {
 public:
  using Mask = MaskOf<V>;

  /// Starts from the release, unless the progress is changed.
  explicit Round(const ForwardRelease<V>& release)
      : r_(release), w_(release.swing), progress_(release), given_up_(!release.plain) {}

  /// Advances to the first turning point, where the pin rests or turns.
  void to_first_rest() {
    x_ = progress_.standing.position;
    v_ = progress_.standing.velocity;
    t_ = progress_.standing.time;
    t_error_ = progress_.standing.time_error;
    start();
    if constexpr (Later) {
      if (any(rising_)) meet_plate();
      if (any(above_)) outrun_plate();
    }
    if (any(carried_)) carry();
    if (any(falling_)) come_to_rest();
  }
  /// Advances to the end of the round.
  void to_end() {
    if (any(still_)) decay();
    if (any(late_)) finish();
    progress_.standing.position = x_;
    progress_.standing.velocity = v_;
    progress_.standing.time = t_;
    progress_.standing.time_error = t_error_;
  }

  Progress<V, Measured>& progress() { return progress_; }
  Mask given_up() const { return given_up_; }
  /// Releases that need another round; all further releases have ended.
  Mask goes_on() const { return goes_on_ & !given_up_; }
  Mask resting() const { return resting_; }
  const LastTurns<V>& last_turns() const { return last_; }

 private:
  using Extreme = typename Oscillation<V>::Extreme;

  // ---- the start -------------------------------------------------------------------------------

  void start() {
    const V zero(0.0), vp = r_.vp;
    const Mask plain = !given_up_;
    const V carrying = r_.carrying(x_);
    const Mask at_plate = plain & (v_ == vp), at_finger = plain & (v_ == zero);
    give_up(at_plate & r_.tie(absolute(carrying), r_.sp));
    above_ = at_plate & (carrying < zero - r_.sp);
    falling_ = at_plate & (r_.sp < carrying);
    centre_ = select(above_, zero - r_.outside, r_.between);
    acceleration_ = (select(above_, zero - r_.fp, r_.fp) - carrying) * r_.per_mass;
    if (any(plain & !at_plate)) start_off_plate(plain, at_plate);
    above_ = above_ & !given_up_;
    falling_ = falling_ & !given_up_;
    if constexpr (Later) {
      // From rest: what was seen before it was put off.
      rising_ = rising_ | at_finger;
      rise_.angle = select(at_finger, w_.extreme_angle, rise_.angle);
      rise_.velocity = select(at_finger, w_.extreme * (centre_ - x_), rise_.velocity);
    } else {
      still_ = at_finger;
      carried_ = at_plate & (absolute(carrying) <= r_.sp) & !given_up_;
      goes_on_ = rising_ | above_;
    }
  }

  /// Starts releases whose velocity differs from that of the plate.
  void start_off_plate(const Mask& plain, const Mask& at_plate) {
    const V zero(0.0), vp = r_.vp;
    const Mask faster = plain & (vp < v_), backward = plain & (v_ < zero);
    const Mask between = plain & (zero < v_) & (v_ < vp);
    // A velocity next to that of a surface is at neither side of it for certain.
    const V reach = absolute(v_) + vp;
    give_up((faster | between) & !(V(near_grazing) * reach < absolute(v_ - vp)));
    give_up((backward | between) & !(V(near_grazing) * reach < absolute(v_)));
    above_ = above_ | faster;
    centre_ = select(above_, zero - r_.outside, select(backward, r_.outside, centre_));
    acceleration_ = select(at_plate, acceleration_,
                           V(2.0) * w_.alpha * v_ - w_.omega0_squared * (x_ - centre_));
    // Between the surfaces it may come up to the plate first.
    const Mask speeding = between & (zero < acceleration_) & !given_up_;
    if (any(speeding)) {
      rise_ = w_.extreme_velocity(v_, acceleration_, V(1.0));
      give_up(speeding & grazes(rise_.velocity));
      rising_ = speeding & (vp < rise_.velocity) & !given_up_;
    }
    falling_ = falling_ | ((between | backward) & !rising_);
  }

  // ---- from event to event -----------------------------------------------------------------------

  /// Advances a pin that slides forward to the plate velocity.
  void meet_plate() {
    const PastTurn<V> before = past_turn(r_.vp / rise_.velocity, V(0.0) - w_.rho);
    const V carrying = slide_to_plate(rising_, rise_, rise_.angle - before.angle,
                                      V(0.0) - w_.omega * rise_.velocity * before.slope);
    const Mask on = rising_ & !late_ & !given_up_;
    give_up(on & r_.tie(V(0.0) - carrying, r_.sp));
    const Mask held = V(0.0) - carrying <= r_.sp;
    carried_ = on & held & !given_up_;
    const Mask passes = on & !held & !given_up_;
    above_ = above_ | passes;
    centre_ = select(passes, V(0.0) - r_.outside, centre_);
    acceleration_ = select(passes, (V(0.0) - r_.fp - carrying) * r_.per_mass, acceleration_);
  }

  /// Advances a pin faster than the plate back to the plate velocity.
  void outrun_plate() {
    const Extreme most = w_.extreme_velocity(v_, acceleration_, V(1.0));
    const PastTurn<V> past = past_turn(r_.vp / most.velocity, w_.rho);
    if constexpr (Measured) {
      const Mask fastest = above_ & (V(0.0) < acceleration_);
      const V when = t_ + most.angle * w_.per_omega;
      progress_.numbers.consider(fastest & (when < r_.until), when, most.velocity);
    }
    const V carrying = slide_to_plate(above_, most, most.angle + past.angle,
                                      w_.omega * most.velocity * past.slope);
    const Mask on = above_ & !late_ & !given_up_;
    give_up(on & r_.tie(carrying, r_.sp));
    const Mask held = carrying <= r_.sp;
    carried_ = carried_ | (on & held & !given_up_);
    falls(on & !held & !given_up_, (r_.fp - carrying) * r_.per_mass);
  }

  /// Advances a pin stuck to the plate until its stick force reaches the limit.
  void carry() {
    const Mask now = carried_;
    const V to = (r_.sp - r_.drag - r_.ff) * r_.flexibility;
    const V time = (to - x_) / r_.vp;
    const Mask stays = too_late(now, time), on = now & !stays;
    carried_late_ = stays & !given_up_;
    if constexpr (Measured) {
      progress_.settling.remember(on, x_, t_, V(1.0), V(0.0), V(0.0));
      progress_.numbers.carries(on, x_, to, t_, time, r_);
      progress_.numbers.plate_peak =
          select(on, larger(progress_.numbers.plate_peak, r_.sp), progress_.numbers.plate_peak);
    }
    // Released again, it repeats what followed the first time.
    V& released = progress_.standing.released;
    give_up(on & (released == V(1.0)));
    released = select(on, V(1.0), released);
    x_ = select(on, to, x_);
    pass_time(on, time);
    falls(on & !given_up_, (r_.fp - r_.sp) * r_.per_mass);
  }

  /// Advances a pin slower than the plate, or moving backward, to zero velocity.
  void come_to_rest() {
    const auto turn = w_.next_turn(v_, acceleration_);
    const V time = turn.angle * w_.per_omega;
    const Mask on = falling_ & !too_late(falling_, time);
    if constexpr (Measured) {
      progress_.settling.remember(on, x_, t_ + time, turn.distance, centre_, V(-1.0));
      if (any(on & (progress_.numbers.turns == V(1.0)))) watch(on, time);
    }
    slide_to(on, centre_ + turn.distance, time);
    v_ = select(on, V(0.0), v_);
    if constexpr (Measured) progress_.numbers.turns_at(on, x_, t_);
    still_ = still_ | on;
  }

  /// Advances from turning point to turning point, each half period shorter by one linear law,
  /// until rest, the end of the duration, or the plate velocity.
  void decay() {
    const V zero(0.0), one(1.0), infinite(__builtin_inf());
    // Distances from where the plate's friction and the spring cancel.
    const V middle = r_.fp * r_.flexibility, stick = r_.sf * r_.flexibility;
    const V friction = r_.ff * r_.flexibility, loss = friction * (one + w_.shrink);
    const V from = x_ - middle, first = absolute(from), second = w_.shrink * first - loss;
    const Mask forward = from < zero, moves = still_ & (stick < first);

    // The first forward half turn is the fastest: if it does not meet the plate, none does.
    const V ahead = select(forward, first, second), fastest = w_.extreme * (ahead - friction);
    const Mask comes = moves & (stick < ahead);
    give_up(comes & grazes(fastest));
    const Mask meets = comes & (r_.vp < fastest);
    const V allowed = select(meets, select(forward, zero, one), infinite);

    const V per_half = w_.omega * V(0x1.45f306dc9c883p-2);
    const V room = (r_.until - t_) * per_half, last = smaller(allowed, room) - one;
    V w = first, before = first, n = zero, sum = zero;
    Mask turns = moves & !given_up_ & (zero <= last);
    for (int count = 0; any(turns); ++count) {
      if (count == most_half_turns) {
        give_up(turns);
        break;
      }
      if constexpr (Measured) sum = select(turns, sum + w, sum);
      before = select(turns, w, before);
      w = select(turns, w_.shrink * w - loss, w);
      n = select(turns, n + one, n);
      turns = turns & (stick < w) & (n <= last);
    }
    const V slack = r_.slack();
    give_up(still_ & !((slack < absolute(w - stick)) & (slack < absolute(before - stick))));
    const Mask left = still_ & (stick < w), late = left & (n < allowed);
    const V so_far = t_ * per_half, next = n + one;
    give_up(still_ & (zero < n) & !(V(near_tie) * (so_far + n) < absolute(room - n)));
    give_up(late & !(V(near_tie) * (so_far + next) < absolute(room - next)));

    const Mask on = still_ & !given_up_, some = on & (zero < n);
    const V time = n * w_.half, side = with_sign(one, from);
    const V position = select(zero < n, middle + side * one_or_minus_one(n) * w, x_);
    if constexpr (Measured) {
      TransientNumbers<V>& numbers = progress_.numbers;
      const Mask fresh = numbers.turns == zero;
      const V third = w_.shrink * second - loss;
      numbers.peak = select(some & fresh, middle - side * second, numbers.peak);
      numbers.peak_time = select(some & fresh, t_ + w_.half, numbers.peak_time);
      const Mask back = on & ((fresh & (one < n)) | ((numbers.turns == one) & (zero < n)));
      const V begin = t_ + select(fresh, w_.half, zero);
      const V speed = w_.extreme * (select(fresh, second, first) - friction);
      const V trough = middle + side * select(fresh, third, zero - second);
      numbers.consider_way_back(back, begin + w_.extreme_angle * w_.per_omega,
                                with_sign(speed, select(fresh, from, zero - from)));
      numbers.trough = select(back, trough, numbers.trough);
      numbers.trough_time = select(back, begin + w_.half, numbers.trough_time);
      numbers.turns = numbers.turns + select(on, n, zero);
      const V distance = (sum - first) + (sum + w);
      numbers.finger_slid = numbers.finger_slid + select(some, distance, zero);
      numbers.plate_slid = numbers.plate_slid + select(some, r_.vp * time - (position - x_), zero);
      numbers.plate_peak = select(some, larger(numbers.plate_peak, r_.fp), numbers.plate_peak);
      numbers.moved = select(some, one, numbers.moved);
      // A pin that moves on after one half turn came back from a turn outside.
      progress_.settling.remember(some & left, x_, t_, x_ - r_.outside, r_.outside, one);
      last_ = {from, t_, select(on & !left, n, zero), w};
    }
    x_ = select(on, position, x_);
    pass_time(on, time);
    resting_ = on & !left;
    const Mask moves_on = on & left;
    v_ = select(moves_on, zero, v_);  // removes −0
    centre_ = select(moves_on, select(x_ < middle, r_.between, r_.outside), centre_);
    acceleration_ = select(moves_on, zero - w_.omega0_squared * (x_ - centre_), acceleration_);
    late_ = late_ | (on & late);
    goes_on_ = goes_on_ | (moves_on & !late);
  }

  /// Sets the state at the end of the duration.
  void finish() {
    const Mask slides = late_ & !carried_late_;
    const V left = r_.until - t_;
    if (any(slides)) {
      const V time = select(slides, left, V(0.0));
      const auto end = w_.after(w_.omega * time, x_ - centre_, v_);
      if constexpr (Measured) {
        if (any(slides & (progress_.numbers.turns == V(1.0)))) {
          watch(slides, time);
          progress_.numbers.consider(slides, r_.until, end.velocity);
        }
      }
      slide_to(slides, centre_ + end.distance, time);
      v_ = select(slides, end.velocity, v_);
    }
    const V to = x_ + r_.vp * left;
    if constexpr (Measured) progress_.numbers.carries(carried_late_, x_, to, t_, left, r_);
    x_ = select(carried_late_, to, x_);
    v_ = select(carried_late_, r_.vp, v_);
  }

  // ---- steps that they share -----------------------------------------------------------------------

  void give_up(const Mask& which) { given_up_ = given_up_ | which; }
  Mask grazes(const V& fastest) const {
    return !(V(near_grazing) * r_.vp < absolute(fastest - r_.vp));
  }
  /// Mask of releases whose next event is after the end of the duration.
  Mask too_late(const Mask& which, const V& time) {
    const V event = t_ + time;
    give_up(which & !(V(near_tie) * event < absolute(r_.until - event)));
    const Mask late = which & (r_.until < event);
    late_ = late_ | late;
    return late | (which & given_up_);
  }

  /// Slides to the plate velocity over an angle, with an acceleration there; `most` is the extreme
  /// of the velocity in between. Returns the stick force of a pin that sticks to the plate.
  V slide_to_plate(const Mask& which, const Extreme& most, const V& angle, const V& acceleration) {
    const V time = angle * w_.per_omega;
    const Mask on = which & !too_late(which, time);
    if constexpr (Measured) {
      const V turn = t_ + (most.angle - w_.extreme_angle) * w_.per_omega;  // before it
      progress_.settling.remember(on, x_, turn, V(0.0) - most.velocity / w_.extreme, centre_,
                                  V(1.0));
      progress_.numbers.consider(on, t_, v_);
    }
    slide_to(on, centre_ + w_.distance_at(r_.vp, acceleration), time);
    v_ = select(on, r_.vp, v_);
    if constexpr (Measured) {
      progress_.numbers.consider(on, t_, r_.vp);
      progress_.numbers.reaches_plate(on & !given_up_, t_);
    }
    return r_.carrying(x_);
  }
  /// Slides with falling velocity from the plate velocity.
  void falls(const Mask& which, const V& acceleration) {
    falling_ = falling_ | which;
    centre_ = select(which, r_.between, centre_);
    acceleration_ = select(which, acceleration, acceleration_);
    v_ = select(which, r_.vp, v_);
  }
  void slide_to(const Mask& which, const V& position, const V& time) {
    if constexpr (Measured) progress_.numbers.slides(which, position - x_, time, r_);
    x_ = select(which, position, x_);
    pass_time(which, time);
  }
  /// Adds to the time with its rounding error (Kahan 1965).
  void pass_time(const Mask& which, const V& time) {
    const V passed = time + t_error_, sum = t_ + passed;
    t_error_ = select(which, passed - (sum - t_), t_error_);
    t_ = select(which, sum, t_);
  }
  /// Records the velocities of a slide of a given duration: start and extreme.
  void watch(const Mask& which, const V& time) {
    progress_.numbers.consider(which, t_, v_);
    const V heading = select(v_ == V(0.0), acceleration_, v_), side = with_sign(V(1.0), heading);
    const Extreme most = w_.extreme_velocity(v_, acceleration_, side);
    const V when = most.angle * w_.per_omega;
    progress_.numbers.consider(which & (V(0.0) < when) & (when < time), t_ + when, most.velocity);
  }

  const ForwardRelease<V>& r_;
  const Oscillation<V>& w_;
  Progress<V, Measured> progress_;

  V x_, v_, t_, t_error_, centre_{0.0}, acceleration_{0.0};
  Extreme rise_{V(1.0), V(1.0)};  ///< extreme of a velocity that reaches that of the plate
  Mask still_{false}, rising_{false}, above_{false}, carried_{false}, falling_{false};
  Mask resting_{false}, late_{false}, carried_late_{false}, goes_on_{false};
  Mask given_up_{false};
  LastTurns<V> last_;
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
