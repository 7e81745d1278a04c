/// Checks a finished motion against the laws it must obey, without using the solver: no mode is
/// chosen here and no event looked for; the motion is evaluated and held against MODEL.md §2–§4.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/energy.hpp"
#include "pindrive/motion.hpp"
#include "pindrive/quadrature.hpp"

namespace pindrive {

/// The worst violation of each law, as a part of the largest force, velocity, displacement or
/// energy in the motion.
template <class T>
struct Certificate {
  T motion_law{0};    ///< m x'' + b x' + k x = R_plate + R_finger + m v_p'
  T kinematics{0};    ///< x' and x'' are the derivatives of x; gripping skin stretches with the pin
  T friction_law{0};  ///< a sliding contact carries its kinetic friction
  T force_bound{0};   ///< a stuck contact carries no more than its static friction
  T sliding_sign{0};  ///< friction opposes the sliding; no level was passed unseen
  T sticking{0};      ///< a stuck contact does not slide
  T continuity{0};    ///< x and x' do not jump, nor the skin but where its grip breaks
  T transitions{0};   ///< a contact breaks loose or crosses only where it cannot hold
  T energy{0};        ///< the ledger adds up
  T dissipation{0};   ///< friction and damper take energy, never give

  T worst() const {
    return std::max({motion_law, kinematics, friction_law, force_bound, sliding_sign, sticking,
                     continuity, transitions, energy, dissipation});
  }
};

template <class T>
class Certifier {
 public:
  Certifier(const Motion<T>& motion, T duration)
      : motion_(motion), drive_(motion.drive()), duration_(duration) {}

  Certificate<T> certify() {
    for (const Segment<T>& segment : motion_) scales(segment);
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > duration_) break;
      if (segment.end > segment.begin) laws(segment);
      derivatives(segment);
      if (&segment + 1 != motion_.end()) junction(segment, *(&segment + 1));
    }
    const Ledger<T> ledger = energy_ledger(motion_, duration_);
    const T energy = ledger.scale();
    worst(result_.energy, ledger.residual(), energy);
    for (const T part :
         {ledger.damper_dissipated, ledger.plate_dissipated, ledger.finger_dissipated})
      worst(result_.dissipation, std::min(part, T(0)), energy);
    return result_;
  }

 private:
  /// The motion at an instant, and the inputs as they were given.
  struct State {
    T x, v, a, plate_force, finger_force;
    Line<T> plate_velocity;
    T load;
  };
  State state(const Segment<T>& segment, T tau) const {
    const Transition<T> moved = segment.flow.oscillator.after(tau);
    const Line<T> v_plate = motion_.inputs().mouse_velocity.from(segment.begin);
    const auto friction = motion_.friction(segment, tau);
    return {segment.flow.position.at(moved, tau),
            segment.flow.velocity.at(moved, tau),
            segment.flow.acceleration.at(moved, tau),
            friction.plate,
            friction.finger,
            {v_plate.at(tau), v_plate.rate},
            motion_.inputs().plate_load.from(segment.begin).at(tau)};
  }

  /// Kinetic friction at a sliding speed, from the rows of the contact's curve.
  static T kinetic(const Contact<T>& contact, T speed) {
    T force = contact.kinetic;
    for (int i = 0; i < contact.regions; ++i)
      if (speed >= contact.curve[i].from)
        force = contact.curve[i].force + contact.curve[i].slope * (speed - contact.curve[i].from);
    return force;
  }

  T length(const Segment<T>& segment) const {
    return std::min(segment.end, std::max(duration_, segment.begin)) - segment.begin;
  }

  /// Calls visit(τ) at both ends, some times in each half-wave, and closely after the start.
  template <class Visitor>
  void samples(const Segment<T>& segment, Visitor&& visit) const {
    const T span = length(segment);
    const T waves =
        segment.flow.oscillator.oscillates() ? segment.flow.oscillator.omega() * span : T(0);
    const int count = 24 + static_cast<int>(std::min(waves * 3, T(168)));
    for (int i = 0; i <= count; ++i) visit(i == count ? span : span * (T(i) / count));
    T tau = span / count;
    for (int i = 0; i < 6; ++i) visit(tau /= 8);
  }

  static void worst(T& residual, T error, T scale) {
    using std::abs;
    if (!(error == 0)) residual = std::max(residual, scale > 0 ? abs(error) / scale : abs(error));
    if (!std::isfinite(error)) residual = std::numeric_limits<T>::infinity();
  }

  void scales(const Segment<T>& segment) {
    using std::abs;
    using std::sqrt;
    samples(segment, [&](T tau) {
      const State s = state(segment, tau);
      x_scale_ = std::max(x_scale_, abs(s.x));
      v_scale_ = std::max({v_scale_, abs(s.v), abs(s.plate_velocity.value)});
      force_scale_ =
          std::max({force_scale_, abs(drive_.mass * s.a), abs(drive_.damping * s.v),
                    abs(drive_.stiffness * s.x), abs(s.plate_force), abs(s.finger_force)});
    });
    const T omega0 = sqrt(drive_.stiffness / drive_.mass);
    x_scale_ = std::max(x_scale_, v_scale_ / omega0);
    v_scale_ = std::max(v_scale_, x_scale_ * omega0);
  }

  void laws(const Segment<T>& segment) {
    using std::abs;
    const auto contact = [&](const Contact<T>& law, Slide slide, T u, T force, T load) {
      const int side = sign(slide);
      if (slides(slide)) {
        worst(result_.sliding_sign, std::min(side * u, T(0)), v_scale_);
        worst(result_.friction_law, force + side * load * kinetic(law, abs(u)), force_scale_);
      } else if (slide != Slide::absent) {
        worst(result_.force_bound, std::max(abs(force) - law.static_limit * load, T(0)),
              force_scale_);
        if (slide == Slide::stuck) worst(result_.sticking, u, v_scale_);
      }
    };
    samples(segment, [&](T tau) {
      const State s = state(segment, tau);
      worst(result_.motion_law,
            drive_.mass * (s.a - s.plate_velocity.rate) + drive_.damping * s.v +
                drive_.stiffness * s.x - s.plate_force - s.finger_force,
            force_scale_);
      contact(drive_.plate, segment.mode.plate, s.v - s.plate_velocity.value, s.plate_force,
              s.load);
      contact(drive_.finger, segment.mode.finger, s.v, s.finger_force, T(1));
    });
  }

  /// x and v against the integrals of v and a, panel by panel; gripping skin against x.
  void derivatives(const Segment<T>& segment) {
    using std::sqrt;
    const T span = length(segment);
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    const T fastest = sqrt(oscillator.omega0_squared()) + std::abs(oscillator.alpha());
    T low{0};
    for (int panel = 0; panel < 4 && low < span; ++panel) {
      const T high = std::min(low + 1 / fastest, span);
      const State from = state(segment, low), to = state(segment, high);
      const T dx = gauss<T>([&](T tau) { return state(segment, tau).v; }, low, high);
      const T dv = gauss<T>([&](T tau) { return state(segment, tau).a; }, low, high);
      worst(result_.kinematics, to.x - from.x - dx, x_scale_);
      worst(result_.kinematics, to.v - from.v - dv, v_scale_);
      if (segment.mode.finger == Slide::gripping)
        worst(result_.kinematics,
              (to.finger_force - from.finger_force) / drive_.finger.stiffness + dx, x_scale_);
      low = panel < 2 ? high : high + span / 3;
    }
  }

  void junction(const Segment<T>& before, const Segment<T>& after) {
    if (before.end > duration_) return;
    const State left = state(before, before.end - before.begin), right = state(after, T(0));
    worst(result_.continuity, left.x - right.x, x_scale_);
    worst(result_.continuity, left.v - right.v, v_scale_);
    worst(result_.continuity, before.end - after.begin, before.end);
    const Event event = before.event;
    const bool soft = drive_.finger.present() && !drive_.finger.rigid();
    const bool skin_slips = soft && event.finger == Kind::slip;
    if (soft && !skin_slips)
      worst(result_.continuity, left.finger_force - right.finger_force, force_scale_);
    if (skin_slips)
      worst(result_.transitions, drive_.finger.static_limit - std::abs(left.finger_force),
            force_scale_);
    const auto let_go = [](Kind kind) { return kind == Kind::slip || kind == Kind::cross; };
    cannot_hold(let_go(event.plate), let_go(event.finger) && !soft, right, after.mode);
  }

  /// What contacts that let go would have had to carry to stay, against what they could.
  void cannot_hold(bool plate, bool finger, const State& now, Mode after) {
    if (!plate && !finger) return;
    using std::abs;
    const T still = T(1e-12) * v_scale_;
    const bool meets_both =
        abs(now.v) <= still && abs(now.plate_velocity.value) <= still && drive_.finger.rigid();
    if (meets_both && now.plate_velocity.rate != 0) return;  // the surfaces part
    const T follows = plate ? now.plate_velocity.rate : T(0);
    T others{0}, limit{0};
    if (plate)
      limit += drive_.plate.static_limit * now.load;
    else if (after.plate != Slide::absent)
      others += now.plate_force;
    if (finger)
      limit += drive_.finger.static_limit;
    else if (after.finger != Slide::absent)
      others += now.finger_force;
    const T held = drive_.mass * (follows - now.plate_velocity.rate) + drive_.damping * now.v +
                   drive_.stiffness * now.x - others;
    worst(result_.transitions, std::max(limit - abs(held), T(0)), force_scale_);
  }

  Motion<T> motion_;
  Drive<T> drive_;
  T duration_;
  T x_scale_{0}, v_scale_{0}, force_scale_{0};
  Certificate<T> result_{};
};

}  // namespace pindrive
