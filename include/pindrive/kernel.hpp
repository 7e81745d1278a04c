/// Many plain releases at once: rigid Coulomb contacts at both surfaces, a mouse of constant velocity,
/// less than critical damping. The same text follows one drive, a pack of drives, or is a GPU thread.
///
/// Between two events the pin turns about a fixed centre: c_A, c_B or c_C = (∓F_p ∓ F_f)/k, while it is
/// faster than the plate, between plate and finger, or moves backward. From one rest to the next it
/// takes half a turn, which costs one multiplication: x − c becomes −q (x − c). Where a half turn comes
/// up to the plate's velocity, the pin passes the plate or is carried by it.
///
/// A release is given up, and left to the general core, where it is not plain, where rounding could
/// decide what comes next, and where it repeats a cycle of carrying and sliding for ever.
#pragma once

#include "pindrive/plain_release.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// Two numbers that differ by less than this part of what they are computed from may be equal: a
/// thousand times what rounding adds up to over the turns that are followed.
inline constexpr double near_tie = 1e-12;
/// How close to the plate's velocity, as a part of it, an extremum of the velocity may come: closer,
/// and the time of the event hangs on less than half of the digits.
inline constexpr double near_grazing = 1e-9;
/// 1 − ζ² from which on the sine and cosine of a half turn keep their digits.
inline constexpr double least_oscillation = 0.02;
/// Half turns that are followed; each costs a few operations, of a whole pack if one drive needs it.
inline constexpr int most_half_turns = 4096;

/// Follows plain releases. `Meets`: those that meet the plate's velocity again, too; else they are put
/// off. `Measured`: takes the numbers on the way.
template <class V, bool Meets, bool Measured>
class Kernel {
 public:
  using Mask = MaskOf<V>;

  explicit Kernel(const PlainRelease<V>& r)
      : mirror_(with_sign(V(1.0), r.mouse_velocity)),
        stiffness_(r.stiffness),
        fp_(r.plate_kinetic),
        sp_(r.plate_static),
        ff_(r.finger_kinetic),
        sf_(r.finger_static),
        vp_(absolute(r.mouse_velocity)),
        until_(r.duration),
        band_(r.settling_band),
        x_(r.displacement * mirror_),
        v_(r.velocity * mirror_),
        start_(x_) {
    const V zero(0.0);
    drag_ = r.damping * vp_;
    per_mass_ = V(1.0) / r.mass;
    flexibility_ = V(1.0) / stiffness_;
    omega0_squared_ = stiffness_ * per_mass_;
    per_omega0_squared_ = r.mass * flexibility_;
    omega0_ = root(omega0_squared_);
    alpha_ = V(-0.5) * r.damping * per_mass_;
    const V squared = (omega0_ + alpha_) * (omega0_ - alpha_);
    omega_ = root(larger(squared, zero));
    per_omega_ = V(1.0) / omega_;
    rho_ = V(0.0) - alpha_ * per_omega_;
    half_ = V(0x1.921fb54442d18p+1) * per_omega_;
    shrink_ = exponential_in_range(alpha_ * half_);
    const V angle = angle_of(omega_, V(0.0) - alpha_);
    to_extreme_ = angle * per_omega_;
    extreme_ = omega0_ * exponential_in_range(alpha_ * to_extreme_);
    between_ = (fp_ - ff_) * flexibility_;
    outside_ = (fp_ + ff_) * flexibility_;
    const V reach = absolute(x_) + (absolute(v_) + vp_) * per_omega_;
    size_ = stiffness_ * reach + fp_ + sp_ + ff_ + sf_ + drag_ + r.damping * absolute(v_);
    given_up_ = !((r.finger_stiffness == V(__builtin_inf())) & (zero < vp_) & (zero < sp_) &
                  (zero < sf_) & (V(least_oscillation) * omega0_squared_ < squared));
  }

  LastState<V> run() {
    start();
    for (;;) {
      if constexpr (Meets) {
        if (any(rising_)) meet_plate();
        if (any(above_)) outrun_plate();
      }
      if (any(carried_)) carry();
      if (any(falling_)) come_to_rest();
      if (any(still_)) decay();
      if (!any(rising_ | above_ | carried_ | falling_)) break;
    }
    finish();
    return {x_ * mirror_, v_ * mirror_, select(resting_, t_, V(none)), given_up_, put_off_};
  }

  /// The same where it is known where it comes to rest. Else the slides that may be the one in which it
  /// settles are remembered, and `full` says that there were too many.
  LastState<V> run(const V& rest) {
    rest_ = rest * mirror_;
    knows_rest_ = true;
    return run();
  }
  bool full() const { return full_; }

  /// What `run` took on the way; the settling time only if it is asked for.
  PlainNumbers<V> numbers(bool with_settling_time) const {
    static_assert(Measured, "numbers are taken on the way");
    using Name = PlainNumber;
    const V zero(0.0), period = V(0x1.921fb54442d18p+2) / omega0_;
    PlainNumbers<V> n;
    n.of[Name::peak_displacement] = peak_ * mirror_;
    n.of[Name::peak_time] = peak_time_;
    n.of[Name::trough_displacement] = trough_ * mirror_;
    n.of[Name::trough_time] = trough_time_;
    n.of[Name::swing] = (peak_ - trough_) * outward_;
    const Mask returned = zero < return_speed_;
    n.of[Name::return_velocity] =
        select(returned, V(0.0) - outward_ * return_speed_ * mirror_, V(none));
    n.of[Name::return_velocity_time] = select(returned, return_time_, V(none));
    n.of[Name::first_reversal_time] = first_reversal_;
    const V duration = select(until_ < V(__builtin_inf()), until_, larger(V(1.25) * t_, period));
    const V left = select(resting_, duration - t_, zero), held = absolute(fp_ - stiffness_ * x_);
    const V plate_slid = plate_slid_ + vp_ * left;
    n.of[Name::plate_reversals] = plate_reversals_;
    n.of[Name::plate_time_stuck] = plate_stuck_;
    n.of[Name::plate_distance_slid] = plate_slid;
    n.of[Name::plate_dissipated] = fp_ * plate_slid;
    n.of[Name::plate_peak_force] = select(slid_ | resting_, larger(plate_peak_, fp_), plate_peak_);
    n.of[Name::finger_reversals] = finger_reversals_;
    n.of[Name::finger_time_stuck] = left;
    n.of[Name::finger_distance_slid] = finger_slid_;
    n.of[Name::finger_dissipated] = ff_ * finger_slid_;
    const V sliding = select(slid_, larger(finger_peak_, ff_), finger_peak_);
    n.of[Name::finger_peak_force] = select(resting_, larger(sliding, held), sliding);
    n.of[Name::duration] = duration;
    n.of[Name::events] = events_;
    n.of[Name::settling_time] = V(none);
    n.unsure = Mask(false);
    if (with_settling_time) settle(n.of[Name::settling_time], n.unsure);
    return n;
  }

 private:
  static constexpr double none = __builtin_nan("");

  // ---- the start -------------------------------------------------------------------------------

  void start() {
    const V zero(0.0);
    const Mask plain = !given_up_;
    const V carrying = stiffness_ * x_ + drag_ + ff_;  // force on the plate if it carries the pin
    const Mask at_plate = plain & (v_ == vp_), at_finger = plain & (v_ == zero);
    const Mask faster = plain & (vp_ < v_), backward = plain & (v_ < zero);
    const Mask between = plain & (zero < v_) & (v_ < vp_);
    if constexpr (Measured) set_out(at_finger);
    // A velocity next to that of a surface is at neither side of it for certain.
    const V reach = absolute(v_) + vp_;
    give_up((faster | between) & !(V(near_grazing) * reach < absolute(v_ - vp_)));
    give_up((backward | between) & !(V(near_grazing) * reach < absolute(v_)));
    give_up(at_plate & tie(absolute(carrying), sp_));

    still_ = at_finger;
    carried_ = at_plate & (absolute(carrying) <= sp_) & !given_up_;
    above_ = ((at_plate & (carrying < V(0.0) - sp_)) | faster) & !given_up_;
    falling_ = ((at_plate & (sp_ < carrying)) | between | backward) & !given_up_;
    centre_ = select(above_, V(0.0) - outside_, select(backward, outside_, between_));
    acceleration_ = select(at_plate, (select(above_, V(0.0) - fp_, fp_) - carrying) * per_mass_,
                           V(2.0) * alpha_ * v_ - omega0_squared_ * (x_ - centre_));
    // Between the surfaces it may come up to the plate first.
    const Mask speeding = between & falling_ & (zero < acceleration_);
    if (any(speeding)) {
      const Extreme most = extreme_velocity(V(1.0));
      give_up(speeding & grazes(most.velocity));
      rising_ = speeding & (vp_ < most.velocity) & !given_up_;
      rise_ = most;
      falling_ = falling_ & !rising_ & !given_up_;
    }
    if constexpr (!Meets) {
      put_off_ = rising_ | above_;
      rising_ = above_ = Mask(false);
    }
  }

  // ---- from event to event -----------------------------------------------------------------------

  /// Sliding forward, it comes up to the plate.
  void meet_plate() {
    const Mask now = rising_;
    const Extreme most = rise_;
    const V angle = most.angle - angle_from_turn(vp_ / most.velocity, V(0.0) - rho_);
    const Mask on = now & !too_late(now, angle * per_omega_);
    if constexpr (Measured) {
      remember_before_turn(on);
      consider(on, t_, v_);
    }
    slide_to(on, after(angle).position, angle * per_omega_);
    if constexpr (Measured) consider(on, t_, vp_);
    const V carrying = stiffness_ * x_ + drag_ + ff_;
    give_up(on & tie(V(0.0) - carrying, sp_));
    reach_plate(on);
    const Mask held = V(0.0) - carrying <= sp_;
    carried_ = carried_ | (on & held & !given_up_);
    const Mask passes = on & !held & !given_up_;
    above_ = above_ | passes;
    centre_ = select(passes, V(0.0) - outside_, centre_);
    acceleration_ = select(passes, (V(0.0) - fp_ - carrying) * per_mass_, acceleration_);
    rising_ = Mask(false);
  }

  /// Faster than the plate, it comes back to its velocity.
  void outrun_plate() {
    const Mask now = above_;
    const Extreme most = extreme_velocity(V(1.0));
    const V angle = most.angle + angle_from_turn(vp_ / most.velocity, rho_);
    const Mask on = now & !too_late(now, angle * per_omega_);
    if constexpr (Measured) {
      remember_before_turn(on);
      consider(on, t_, v_);
      consider(on & (V(0.0) < acceleration_), t_ + most.angle * per_omega_, most.velocity);
    }
    slide_to(on, after(angle).position, angle * per_omega_);
    const V carrying = stiffness_ * x_ + drag_ + ff_;
    give_up(on & tie(carrying, sp_));
    reach_plate(on);
    const Mask held = carrying <= sp_;
    carried_ = carried_ | (on & held & !given_up_);
    falls(on & !held & !given_up_, (fp_ - carrying) * per_mass_);
    above_ = Mask(false);
  }

  /// The plate carries it until the force is at its limit.
  void carry() {
    const Mask now = carried_;
    const V release = (sp_ - drag_ - ff_) * flexibility_;
    const V time = (release - x_) / vp_;
    const Mask stays = too_late(now, time);
    carried_late_ = carried_late_ | stays;
    const Mask on = now & !stays;
    if constexpr (Measured) {
      remember(on, t_, V(0.0), V(0.0));
      carries(on, release, time);
      plate_peak_ = select(on, larger(plate_peak_, sp_), plate_peak_);
      events_ = events_ + select(on, V(1.0), V(0.0));
    }
    // Let go again, it repeats what followed the first time.
    give_up(on & released_);
    released_ = released_ | on;
    x_ = select(on, release, x_);
    t_ = select(on, t_ + time, t_);
    falls(on & !given_up_, (fp_ - sp_) * per_mass_);
    carried_ = Mask(false);
  }

  /// Sliding slower than the plate or backward, its velocity comes to zero.
  void come_to_rest() {
    const Mask now = falling_;
    const Turn turn = next_turn();
    const V time = turn.angle * per_omega_;
    const Mask on = now & !too_late(now, time);
    if constexpr (Measured) {
      remember(on, t_ + time, turn.distance, V(-1.0));
      if (any(on & (turns_ == V(1.0)))) watch(on, time);
    }
    slide_to(on, centre_ + turn.distance, time);
    stop(on);
    still_ = still_ | on;
    falling_ = Mask(false);
  }

  /// From rest to rest, each half turn shorter than the one before by the same linear law, until it
  /// stays, the time is over, or it comes up to the plate.
  void decay() {
    const V zero(0.0), one(1.0), infinite(__builtin_inf());
    // Distances from where the plate's friction and the spring cancel.
    const V middle = fp_ * flexibility_, stick = sf_ * flexibility_;
    const V friction = ff_ * flexibility_, loss = friction * (one + shrink_);
    const V from = x_ - middle, first = absolute(from), second = shrink_ * first - loss;
    const Mask forward = from < zero;
    Mask moves = still_ & (stick < first);

    // Of all half turns forward the first one is the fastest: where it does not meet the plate, none does.
    const V ahead = select(forward, first, second), fastest = extreme_ * (ahead - friction);
    const Mask comes = moves & (stick < ahead);
    give_up(comes & grazes(fastest));
    const Mask meets = comes & (vp_ < fastest);
    V allowed = infinite;
    if constexpr (Meets) {
      allowed = select(meets, select(forward, zero, one), infinite);
    } else {
      put_off_ = put_off_ | (meets & !given_up_);
      still_ = still_ & !meets;
      moves = moves & !meets;
    }

    const V per_half = omega_ * V(0x1.45f306dc9c883p-2);
    const V room = (until_ - t_) * per_half, last = smaller(allowed, room) - one;
    V w = first, before = first, n = zero, sum = zero;
    Mask goes = moves & !given_up_ & (zero <= last);
    for (int count = 0; any(goes); ++count) {
      if (count == most_half_turns) {
        give_up(goes);
        break;
      }
      if constexpr (Measured) sum = select(goes, sum + w, sum);
      before = select(goes, w, before);
      w = select(goes, shrink_ * w - loss, w);
      n = select(goes, n + one, n);
      goes = goes & (stick < w) & (n <= last);
    }
    const V slack = V(near_tie) * size_ * flexibility_;
    give_up(still_ & !((slack < absolute(w - stick)) & (slack < absolute(before - stick))));
    const Mask left = still_ & (stick < w), late = left & (n < allowed);
    const V so_far = t_ * per_half, next = n + one;
    give_up(still_ & (zero < n) & !(V(near_tie) * (so_far + n) < absolute(room - n)));
    give_up(late & !(V(near_tie) * (so_far + next) < absolute(room - next)));

    const Mask on = still_ & !given_up_;
    const V time = n * half_, side = with_sign(one, from);
    const V position = select(zero < n, middle + side * one_or_minus_one(n) * w, x_);
    const Mask rests = on & !left;
    if constexpr (Measured) {
      const Mask some = on & (zero < n), fresh = turns_ == zero;
      const V third = shrink_ * second - loss;
      peak_ = select(some & fresh, middle - side * second, peak_);
      peak_time_ = select(some & fresh, t_ + half_, peak_time_);
      const Mask back = on & ((fresh & (one < n)) | ((turns_ == one) & (zero < n)));
      const V begin = t_ + select(fresh, half_, zero);
      const V speed = extreme_ * (select(fresh, second, first) - friction);
      const V trough = middle + side * select(fresh, third, zero - second);
      consider_way_back(back, begin + to_extreme_,
                        with_sign(speed, select(fresh, from, zero - from)));
      trough_ = select(back, trough, trough_);
      trough_time_ = select(back, begin + half_, trough_time_);
      const V so_many = select(on, n, zero);
      events_ = events_ + so_many;
      finger_reversals_ = finger_reversals_ + so_many;
      turns_ = turns_ + so_many;
      slid_ = slid_ | some;
      finger_slid_ = finger_slid_ + select(some, (sum - first) + (sum + w), zero);
      plate_slid_ = plate_slid_ + select(some, vp_ * time - (position - x_), zero);
      if constexpr (Meets) remember(some & left, t_, x_ - outside_, one, outside_);
      last_from_ = select(rests, from, last_from_);
      last_begin_ = select(rests, t_, last_begin_);
      last_turns_ = select(rests, n, last_turns_);
      last_w_ = select(rests, w, last_w_);
    }
    x_ = select(on, position, x_);
    t_ = select(on, t_ + time, t_);
    resting_ = resting_ | rests;
    late_ = late_ | (on & late);
    const Mask goes_on = on & left;
    v_ = select(goes_on, zero, v_);  // which may have been −0
    centre_ = select(goes_on, select(x_ < middle, between_, outside_), centre_);
    acceleration_ = select(goes_on, V(0.0) - omega0_squared_ * (x_ - centre_), acceleration_);
    if constexpr (Meets) {
      const Mask rises = on & left & !late;
      rising_ = rising_ | rises;
      rise_.angle = select(rises, to_extreme_ * omega_, rise_.angle);
      rise_.velocity = select(rises, fastest, rise_.velocity);
    }
    still_ = Mask(false);
  }

  /// Where it is at the end of the duration.
  void finish() {
    const Mask slides = late_ & !carried_late_;
    V left = until_ - t_;
    if (any(slides)) {
      const V time = select(slides, left, V(0.0));
      const State end = after(omega_ * time);
      if constexpr (Measured) {
        if (any(slides & (turns_ == V(1.0)))) {
          watch(slides, time);
          consider(slides, until_, end.velocity);
        }
      }
      slide_to(slides, end.position, time);
      v_ = select(slides, end.velocity, v_);
    }
    const V carried_to = x_ + vp_ * left;
    if constexpr (Measured) {
      carries(carried_late_, carried_to, left);
    }
    x_ = select(carried_late_, carried_to, x_);
    v_ = select(carried_late_, vp_, v_);
    if constexpr (Measured) {
      const V carrying = absolute(stiffness_ * x_ + drag_ + ff_);
      plate_peak_ = select(carried_late_, larger(plate_peak_, carrying), plate_peak_);
    }
  }

  // ---- steps that they share -----------------------------------------------------------------------

  void give_up(const Mask& which) { given_up_ = given_up_ | which; }
  /// Whether rounding could decide which of two forces is larger.
  Mask tie(const V& one, const V& other) const {
    return !(V(near_tie) * size_ < absolute(one - other));
  }
  Mask grazes(const V& fastest) const { return !(V(near_grazing) * vp_ < absolute(fastest - vp_)); }
  /// Which of those that are followed do not come to their event before the end of the duration.
  Mask too_late(const Mask& which, const V& time) {
    const V event = t_ + time;
    give_up(which & !(V(near_tie) * event < absolute(until_ - event)));
    const Mask late = which & (until_ < event);
    late_ = late_ | late;
    return late | (which & given_up_);
  }

  /// 1 of an even whole number below 2^52, −1 of an odd one.
  static V one_or_minus_one(const V& n) {
    const BitsOf<V> low = bits(n + V(0x1p52));
    return from_bits<V>((low << 63) | bits(V(1.0)));
  }

  struct State {
    V position, velocity;
  };
  /// So far on its turn about the centre.
  State after(const V& angle) const {
    const Circular<V> turned = sine_and_cosine_in_turn(angle);
    const V decay = exponential_in_range(V(0.0) - rho_ * angle), y = x_ - centre_;
    const V gain = decay * turned.sine * per_omega_;
    const V stay = decay * turned.cosine - alpha_ * gain;
    return {centre_ + (y * stay + v_ * gain),
            v_ * (stay + V(2.0) * alpha_ * gain) - omega0_squared_ * y * gain};
  }

  struct Extreme {
    V angle, velocity;
  };
  /// Where its velocity is largest in the direction of a side: the nearest such angle, < 0 if it is past.
  Extreme extreme_velocity(const V& side) const {
    const V cosine = side * omega_ * acceleration_;
    const V sine = side * (alpha_ * acceleration_ - omega0_squared_ * v_);
    const V angle = angle_of(cosine, V(0.0) - sine);
    const V speed = root(cosine * cosine + sine * sine) * per_omega0_squared_;
    return {angle, side * speed * exponential_in_range(V(0.0) - rho_ * angle)};
  }

  struct Turn {
    V angle, distance;  ///< from the centre
  };
  /// Where its velocity would come to zero if no contact changed its force before.
  Turn next_turn() const {
    const V side = with_sign(V(1.0), v_);
    const V sine = acceleration_ - alpha_ * v_, cosine = omega_ * v_;
    const V angle = angle_of(absolute(cosine), V(0.0) - side * sine);
    const V distance = root(cosine * cosine + sine * sine) * per_omega0_squared_;
    return {angle, side * distance * exponential_in_range(V(0.0) - rho_ * angle)};
  }

  /// Down from the plate's velocity.
  void falls(const Mask& which, const V& acceleration) {
    falling_ = falling_ | which;
    centre_ = select(which, between_, centre_);
    acceleration_ = select(which, acceleration, acceleration_);
    v_ = select(which, vp_, v_);
  }
  void slide_to(const Mask& which, const V& position, const V& time) {
    if constexpr (Measured) {
      const V zero(0.0), distance = position - x_;
      finger_slid_ = finger_slid_ + select(which, absolute(distance), zero);
      plate_slid_ = plate_slid_ + select(which, absolute(distance - vp_ * time), zero);
      slid_ = slid_ | which;
    }
    x_ = select(which, position, x_);
    t_ = select(which, t_ + time, t_);
  }
  /// At the finger's velocity.
  void stop(const Mask& which) {
    v_ = select(which, V(0.0), v_);
    if constexpr (!Measured) return;
    const V one = select(which, V(1.0), V(0.0));
    events_ = events_ + one;
    finger_reversals_ = finger_reversals_ + one;
    const Mask peak = which & (turns_ == V(0.0)), trough = which & (turns_ == V(1.0));
    peak_ = select(peak, x_, peak_);
    peak_time_ = select(peak, t_, peak_time_);
    trough_ = select(trough, x_, trough_);
    trough_time_ = select(trough, t_, trough_time_);
    turns_ = turns_ + one;
  }
  /// At the plate's velocity.
  void reach_plate(const Mask& which) {
    v_ = select(which, vp_, v_);
    if constexpr (!Measured) return;
    const V one = select(which, V(1.0), V(0.0));
    events_ = events_ + one;
    first_reversal_ = select(which & (plate_reversals_ == V(0.0)), t_, first_reversal_);
    plate_reversals_ = plate_reversals_ + one;
  }

  // ---- the numbers taken on the way ----------------------------------------------------------------

  /// Which way is out, and whether the pin sets out that way: else its start is the peak.
  void set_out(const Mask& at_finger) {
    const V zero(0.0);
    const V first = select(x_ == zero, select(v_ == zero, V(1.0), v_), x_);
    outward_ = with_sign(V(1.0), first);
    const V net = fp_ - stiffness_ * x_;
    const V heading = select(at_finger, select(absolute(net) <= sf_, zero, net), v_);
    const Mask inward = !(zero < heading * outward_);
    turns_ = select(inward, V(1.0), zero);
    peak_ = select(inward, x_, V(none));
    peak_time_ = select(inward, zero, V(none));
  }
  /// A velocity, which counts on the way back from the peak.
  void consider(const Mask& which, const V& time, const V& velocity) {
    consider_way_back(which & (turns_ == V(1.0)), time, velocity);
  }
  void consider_way_back(const Mask& which, const V& time, const V& velocity) {
    const V speed = V(0.0) - outward_ * velocity;
    const Mask better = which & (return_speed_ < speed);
    return_speed_ = select(better, speed, return_speed_);
    return_time_ = select(better, time, return_time_);
  }
  /// The velocities of a slide that lasts for a time from now on: where it starts, and its extreme.
  void watch(const Mask& which, const V& time) {
    consider(which, t_, v_);
    const V heading = select(v_ == V(0.0), acceleration_, v_), side = with_sign(V(1.0), heading);
    const Extreme most = extreme_velocity(side);
    const V when = most.angle * per_omega_;
    consider(which & (V(0.0) < when) & (when < time), t_ + when, most.velocity);
  }
  /// What is carried to a position in a time.
  void carries(const Mask& which, const V& position, const V& time) {
    const V zero(0.0);
    consider(which, t_, vp_);
    plate_stuck_ = plate_stuck_ + select(which, time, zero);
    finger_slid_ = finger_slid_ + select(which, position - x_, zero);
    finger_peak_ = select(which, larger(finger_peak_, ff_), finger_peak_);
    const V carrying = absolute(stiffness_ * x_ + drag_ + ff_);
    plate_peak_ = select(which, larger(plate_peak_, carrying), plate_peak_);
  }
  // ---- the settling time ---------------------------------------------------------------------------

  /// A slide whose turning point is at its start (side 1) or at, or beyond, its end (−1), or a stretch
  /// that the plate carries it (0).
  struct Slide {
    V start, time, distance, centre,
        side;  ///< time of the turning point, or of the start; from centre
  };
  void remember(const Mask& which, const V& time, const V& distance, const V& side,
                const V& centre) {
    const Slide slide{select(which, x_, V(none)), time, distance, centre, side};
    if (knows_rest_)
      weigh(slide, rest_, entry_);
    else if (slides_ < most_slides)
      slide_[slides_++] = slide;
    else
      full_ = true;
  }
  void remember(const Mask& which, const V& time, const V& distance, const V& side) {
    remember(which, time, distance, side, centre_);
  }
  /// The same of one that ends before the turn.
  void remember_before_turn(const Mask& which) {
    const Turn turn = next_turn();
    remember(which, t_ + turn.angle * per_omega_, turn.distance, V(-1.0));
  }

  /// The last slide that begins outside the band.
  struct Entry {
    Slide slide;
    Mask found, unsure;
  };
  /// Whether an end so far off is on the edge of the band; at the start it is as far off as the width
  /// says, however little rounding leaves of it.
  Mask on_edge(const V& off, const V& width, const Mask& at_start) const {
    const V slack = V(near_tie) * size_ * flexibility_;
    return !(slack < absolute(off - width)) & !(at_start & (slack < off));
  }
  V width(const V& rest) const { return band_ * absolute(start_ - rest); }
  /// Takes a slide that follows those before.
  void weigh(const Slide& slide, const V& rest, Entry& entry) const {
    const V off = absolute(slide.start - rest), width = this->width(rest);
    const Mask here = slide.start == slide.start, away = here & (width < off);
    entry.unsure = (entry.unsure & !away) | (here & on_edge(off, width, slide.start == start_));
    entry.found = entry.found | away;
    entry.slide.start = select(away, slide.start, entry.slide.start);
    entry.slide.time = select(away, slide.time, entry.slide.time);
    entry.slide.distance = select(away, slide.distance, entry.slide.distance);
    entry.slide.centre = select(away, slide.centre, entry.slide.centre);
    entry.slide.side = select(away, slide.side, entry.slide.side);
  }

  /// When it comes within the band to stay there.
  void settle(V& settled, Mask& unsure) const {
    const V zero(0.0), one(1.0), rest = x_, width = this->width(rest);
    Entry entry = entry_;
    for (int i = 0; i < slides_; ++i) weigh(slide_[i], rest, entry);
    const Slide& slide = entry.slide;
    const V target = rest + with_sign(width, slide.start - rest);
    V time = slide.time, side = slide.side;
    V part = (target - slide.centre) / select(slide.distance == zero, one, slide.distance);
    // The half turns of the last decay: what is an even number before the end is on its side.
    const V friction = ff_ * flexibility_, loss = friction * (one + shrink_);
    V w = absolute(last_from_), end = last_w_ * one_or_minus_one(last_turns_), n = zero;
    V from = zero, far = w, near = end;
    Mask found(false);
    unsure = entry.unsure;
    for (Mask more = resting_ & (zero < last_turns_); any(more); more = more & (n < last_turns_)) {
      const V off = w - end;
      const Mask away = more & (width < off);
      unsure = (unsure & !away) | (more & on_edge(off, width, n + last_begin_ == zero));
      found = found | away;
      from = select(away, n, from);
      far = select(away, w, far);
      near = select(away, end, near);
      w = shrink_ * w - loss;
      end = zero - end;
      n = n + one;
    }
    time = select(found, last_begin_ + from * half_, time);
    part = select(found, (near + (width - friction)) / select(found, far - friction, one), part);
    side = select(found, one, side);
    const Mask enters = resting_ & (found | entry.found), turned = enters & !(side == zero);
    const V angle = angle_from_turn(select(turned, part, one), side * rho_);
    settled = select(resting_, zero, V(none));
    settled = select(turned, time + side * angle * per_omega_, settled);
    settled = select(enters & !turned, time + (target - slide.start) / vp_, settled);
    unsure = unsure & resting_;
  }

  // ---- what is known of a drive --------------------------------------------------------------------

  V mirror_;  ///< ±1: the plate moves forward
  V per_mass_, stiffness_, flexibility_, fp_, sp_, ff_, sf_, vp_, until_, band_, drag_;
  V omega0_squared_, per_omega0_squared_, omega0_, alpha_, omega_, per_omega_, rho_;
  V half_, shrink_;         ///< time of a half turn, and by what it shrinks
  V to_extreme_, extreme_;  ///< time from rest to the largest velocity, and that of 1 m, 1/s
  V between_, outside_;     ///< centres c_B and c_C = −c_A, m
  V size_;                  ///< of the forces, N

  // ---- where it is ---------------------------------------------------------------------------------

  V x_, v_, start_, t_{0.0}, centre_{0.0}, acceleration_{0.0};
  Mask still_{false}, rising_{false}, above_{false}, carried_{false}, falling_{false};
  Mask resting_{false}, late_{false}, carried_late_{false}, released_{false};
  Mask given_up_{false}, put_off_{false};

  Extreme rise_{V(1.0), V(1.0)};  ///< of a velocity that comes up to the plate's

  V outward_{1.0}, turns_{0.0};
  V peak_{none}, peak_time_{none}, trough_{none}, trough_time_{none};
  V return_speed_{0.0}, return_time_{none}, first_reversal_{none};
  V plate_reversals_{0.0}, plate_stuck_{0.0}, plate_slid_{0.0}, plate_peak_{0.0};
  V finger_reversals_{0.0}, finger_slid_{0.0}, finger_peak_{0.0}, events_{0.0};
  Mask slid_{false};

  V rest_{none};
  bool knows_rest_{false}, full_{false};
  Entry entry_{{V(none), V(0.0), V(1.0), V(0.0), V(0.0)}, Mask(false), Mask(false)};
  static constexpr int most_slides =
      Meets ? 16 : 2;  ///< one that meets no plate is carried, then slides
  Slide slide_[most_slides];
  int slides_{0};
  V last_from_{0.0}, last_begin_{0.0}, last_turns_{0.0}, last_w_{0.0};  ///< of the last decay
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
