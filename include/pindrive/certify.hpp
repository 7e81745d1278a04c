/// Checks a finished motion against the laws it must obey, without using the solver: no mode is
/// chosen and no root is found here; the motion is evaluated and held against MODEL.md §2–§4.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/energy.hpp"
#include "pindrive/motion.hpp"

namespace pindrive {

/// The worst violation of each law, as a part of the largest force, velocity, displacement or
/// energy in the motion.
template <class T>
struct Certificate {
  T motion_law{0};    ///< m x'' + b x' + k x = R_plate + R_finger
  T kinematics{0};    ///< x' and x'' are the derivatives of x
  T force_bound{0};   ///< a stuck contact carries no more than its static friction
  T sliding_sign{0};  ///< friction opposes the sliding; no level was passed unseen
  T sticking{0};      ///< a stuck contact does not slide
  T continuity{0};    ///< x and x' do not jump
  T transitions{0};   ///< a contact breaks loose or crosses only where it cannot hold
  T energy{0};        ///< the ledger adds up
  T dissipation{0};   ///< friction and damper take energy, never give

  T worst() const {
    return std::max({motion_law, kinematics, force_bound, sliding_sign, sticking, continuity,
                     transitions, energy, dissipation});
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
      laws(segment);
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
  struct State {
    T x, v, a;
  };
  static State state(const Segment<T>& segment, T tau) {
    const Transition<T> moved = segment.flow.oscillator.after(tau);
    return {segment.flow.position.at(moved, tau), segment.flow.velocity.at(moved, tau),
            segment.flow.acceleration.at(moved, tau)};
  }

  T length(const Segment<T>& segment) const {
    return std::min(segment.end, std::max(duration_, segment.begin)) - segment.begin;
  }

  /// Calls visit(τ) densely enough to see every half-wave, and the start closely.
  template <class Visitor>
  void samples(const Segment<T>& segment, Visitor&& visit) const {
    const T span = length(segment);
    const int count = 192;
    for (int i = 0; i <= count; ++i) visit(i == count ? span : span * (T(i) / count));
    for (T tau = span / count; tau > span * T(1e-9); tau /= 8) visit(tau);
  }

  static void worst(T& residual, T error, T scale) {
    using std::abs;
    if (!(error == 0)) residual = std::max(residual, scale > 0 ? abs(error) / scale : abs(error));
    if (!std::isfinite(error)) residual = std::numeric_limits<T>::infinity();
  }

  void scales(const Segment<T>& segment) {
    using std::abs;
    samples(segment, [&](T tau) {
      const State s = state(segment, tau);
      x_scale_ = std::max(x_scale_, abs(s.x));
      v_scale_ = std::max({v_scale_, abs(s.v), abs(motion_.inputs().mouse_velocity)});
      force_scale_ = std::max({force_scale_, abs(drive_.mass * s.a), abs(drive_.damping * s.v),
                               abs(drive_.stiffness * s.x), drive_.plate.static_limit,
                               drive_.finger.static_limit});
    });
    x_scale_ = std::max(x_scale_, v_scale_ / std::sqrt(drive_.stiffness / drive_.mass));
    v_scale_ = std::max(v_scale_, x_scale_ * std::sqrt(drive_.stiffness / drive_.mass));
  }

  /// What the contacts must carry together, N.
  T friction_needed(const State& s) const {
    return drive_.mass * s.a + drive_.damping * s.v + drive_.stiffness * s.x;
  }

  void laws(const Segment<T>& segment) {
    using std::abs;
    const Mode mode = segment.mode;
    T sliding{0}, holding{0};
    const auto add = [&](Slide slide, const Contact<T>& contact) {
      if (slide == Slide::stuck) holding += contact.static_limit;
      if (slide == Slide::forward) sliding -= contact.kinetic;
      if (slide == Slide::backward) sliding += contact.kinetic;
    };
    add(mode.plate, drive_.plate);
    add(mode.finger, drive_.finger);

    const auto contact = [&](Slide slide, T u) {
      if (slide == Slide::stuck) worst(result_.sticking, u, v_scale_);
      if (slide == Slide::forward) worst(result_.sliding_sign, std::min(u, T(0)), v_scale_);
      if (slide == Slide::backward) worst(result_.sliding_sign, std::max(u, T(0)), v_scale_);
    };
    samples(segment, [&](T tau) {
      const State s = state(segment, tau);
      const T held = friction_needed(s) - sliding;
      if (mode.stuck())
        worst(result_.force_bound, std::max(abs(held) - holding, T(0)), force_scale_);
      else
        worst(result_.motion_law, held, force_scale_);
      contact(mode.plate, s.v - motion_.inputs().mouse_velocity);
      contact(mode.finger, s.v);
    });
  }

  /// x and v against the integrals of v and a, panel by panel.
  void derivatives(const Segment<T>& segment) {
    using std::sqrt;
    const T span = length(segment);
    const T fastest = sqrt(drive_.stiffness / drive_.mass) + drive_.damping / drive_.mass;
    T low{0};
    for (int panel = 0; panel < 48 && low < span; ++panel) {
      const T high = std::min(low + 1 / fastest, span);
      const State from = state(segment, low), to = state(segment, high);
      const T dx = gauss<T>([&](T tau) { return state(segment, tau).v; }, low, high);
      const T dv = gauss<T>([&](T tau) { return state(segment, tau).a; }, low, high);
      worst(result_.kinematics, to.x - from.x - dx, x_scale_);
      worst(result_.kinematics, to.v - from.v - dv, v_scale_);
      low = panel < 24 ? high : high + span / 24;
    }
  }

  void junction(const Segment<T>& before, const Segment<T>& after) {
    using std::abs;
    if (before.end > duration_) return;
    const State left = state(before, before.end - before.begin), right = state(after, T(0));
    worst(result_.continuity, left.x - right.x, x_scale_);
    worst(result_.continuity, left.v - right.v, v_scale_);
    worst(result_.continuity, before.end - after.begin, before.end);
    if (before.event.kind == Kind::stick) return;

    // Held at the level, a = 0: what the contacts of the event would have had to carry.
    const Event event = before.event;
    T others{0}, holding{0};
    const auto add = [&](bool of_event, Slide slide, const Contact<T>& contact) {
      if (of_event) holding += contact.static_limit;
      if (!of_event && slide == Slide::forward) others -= contact.kinetic;
      if (!of_event && slide == Slide::backward) others += contact.kinetic;
    };
    add(event.plate, after.mode.plate, drive_.plate);
    add(event.finger, after.mode.finger, drive_.finger);
    const T held = drive_.damping * right.v + drive_.stiffness * right.x - others;
    const T short_of =
        event.kind == Kind::cross ? std::max(holding - abs(held), T(0)) : holding - abs(held);
    worst(result_.transitions, short_of, force_scale_);
  }

  const Motion<T>& motion_;
  Drive<T> drive_;
  T duration_;
  T x_scale_{0}, v_scale_{0}, force_scale_{0};
  Certificate<T> result_{};
};

}  // namespace pindrive
