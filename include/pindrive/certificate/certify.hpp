/// Certifier: checks a finished motion against the laws of motion, without the solver. No mode is
/// selected and no event located; the motion is evaluated and compared with docs/theory.md,
/// sections 1 and 4.
///
/// Each segment is traversed once. At Gauss nodes the laws are compared with the state, and sums
/// over the nodes give the integrals; between the nodes a bound proves that no guard becomes
/// negative unnoticed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "pindrive/certificate/breakaway.hpp"
#include "pindrive/certificate/certificate.hpp"
#include "pindrive/certificate/evaluated_segment.hpp"
#include "pindrive/certificate/segment_guards.hpp"
#include "pindrive/certificate/tolerances.hpp"
#include "pindrive/flow/positivity.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/period_samples.hpp"
#include "pindrive/motion/quadrature.hpp"
#include "pindrive/motion/skin_along.hpp"
#include "pindrive/motion/steady_since.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

template <class T>
class Certifier {
 public:
  Certifier(const Motion<T>& motion, T duration, GoOn go_on = {})
      : motion_(motion), drive_(motion.drive()), duration_(duration), go_on_(go_on) {}

  Certificate<T> certify() {
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > duration_ || !go_on_()) break;
      scales(segment);
    }
    for (const Segment<T>& segment : motion_) {
      if (segment.begin > duration_ || !go_on_()) break;
      const Numbers last = motion_.along(segment, [&](const auto& along) -> Numbers {
        const auto evaluated = evaluate(segment, along);
        // Within the resolution of time nothing moves, and forces may turn.
        if (evaluated.span <= detail::tolerance::sum<T> * segment.begin) return evaluated.at(T(0));
        worst(result_.transitions, breakaways_.spare(evaluated), scales_.force);
        return walk(evaluated);
      });
      if (segment.end > duration_) break;
      const Segment<T>* next = motion_.after(segment);
      if (next == nullptr) break;
      const bool in_order = next == &segment + 1;
      if (in_order) worst(result_.continuity, segment.end - next->begin, segment.end);
      junction(segment, last, start_of(*next), in_order ? next->begin : segment.end);
    }
    const T energy = std::max({stored_, input_, dissipated_});
    worst(result_.energy, unaccounted_, energy);
    // Forces are known to their rounding, and so is what they do on the way.
    const T time = std::min(duration_, motion_.outcome().until);
    const T error = detail::tolerance::sum<T> * scales_.force * scales_.v * time;
    worst(result_.dissipation, std::max(gained_ - error, T(0)), energy);
    repetition();
    return result_;
  }

 private:
  /// Compares the samples of a steady motion with its period and its begin.
  void repetition() {
    using std::abs;
    if (!motion_.outcome().steady()) return;
    const T since = steady_since(motion_, go_on_);
    if (!(since <= duration_)) return;
    const detail::PeriodSamples<T> samples(motion_, go_on_);
    const T tolerance = T(detail::repeat_tolerance);
    // The begin is found from four instants between two events: between those the difference may be larger.
    update_max(result_.period, std::max(samples.difference_since(since) - 2 * tolerance, T(0)));
    const Outcome<T>& outcome = motion_.outcome();
    if (!outcome.cycles()) return;  // a mode of its own begins where its mode does
    // Continuity from the last segment to the begin of the cycle closes a round: it lasts one period.
    const T round = std::prev(motion_.end())->end - outcome.cycle_begin;
    const T error = detail::tolerance::sum<T> * outcome.until;
    update_max(result_.period,
               std::max(abs(round - outcome.period) - error, T(0)) / outcome.period);
    const T begin = std::max(samples.begin(tolerance), detail::last_breakpoint(motion_.inputs()));
    update_max(result_.steady_since, std::max((since - begin) / outcome.period - T(1), T(0)));
  }

  template <class Trajectory>
  using Evaluated = detail::EvaluatedSegment<T, Trajectory>;
  template <class Trajectory>
  using Guards = detail::SegmentGuards<T, Trajectory>;
  using Closed = Evaluated<detail::ClosedForm<T>>;
  using ClosedState = typename Closed::State;
  using Numbers = detail::PinState<T>;

  template <class Trajectory>
  Evaluated<Trajectory> evaluate(const Segment<T>& segment, const Trajectory& along) const {
    return {drive_, scales_, motion_.inputs(), duration_, segment, along};
  }
  Numbers start_of(const Segment<T>& segment) const {
    return motion_.along(
        segment, [&](const auto& along) -> Numbers { return evaluate(segment, along).at(T(0)); });
  }

  T energy(const Numbers& s) const {
    const T skin = drive_.finger.compliant()
                       ? s.stretch_force * s.stretch_force / (2 * drive_.finger.stiffness)
                       : T(0);
    return drive_.mass * s.v * s.v / 2 + drive_.stiffness * s.x * s.x / 2 + skin +
           motion_.stop_energy(s.x);
  }

  /// Updates a maximum by |error|; infinity for NaN.
  static void update_max(T& most, T error) {
    using std::abs;
    const T size = abs(error);
    if (!(size <= most)) most = size < never ? size : never;
  }
  static void worst(T& residual, T error, T scale) {
    update_max(residual, scale > 0 ? error / scale : error);
  }

  /// Updates the largest displacement, velocity and force: at the ends of segments, and within
  /// where needed.
  void scales(const Segment<T>& segment) {
    using std::abs;
    using std::sqrt;
    const T omega0 = sqrt(drive_.stiffness / drive_.mass);
    motion_.along(segment, [&](const auto& along) {
      const auto evaluated = evaluate(segment, along);
      for (const T part : {T(0), T(0.382), T(1)}) {
        const T tau = part * evaluated.span;
        const Numbers s = evaluated.at(tau);
        scales_.x = std::max({scales_.x, abs(s.x), abs(s.v) / omega0,
                              abs(evaluated.plate_velocity.at(tau)) / omega0});
        scales_.across = std::max(scales_.across, abs(evaluated.across.at(tau)));
        scales_.force =
            std::max({scales_.force, abs(drive_.mass * s.a), abs(drive_.damping * s.v),
                      abs(s.plate_force), abs(s.finger_force), abs(evaluated.force.at(tau))});
        // With its transverse part, of which the axial part has the rounding.
        if (evaluated.oblique())
          scales_.force = std::max(scales_.force, evaluated.load.at(tau) * drive_.plate.kinetic);
        if (drive_.stops.present() && !drive_.stops.rigid())
          scales_.stop = std::max(
              {scales_.stop, drive_.stops.stiffness * abs(s.x), drive_.stops.damping * abs(s.v)});
      }
    });
    scales_.v = scales_.x * omega0;
    scales_.force = std::max(scales_.force, drive_.stiffness * scales_.x);
    scales_.stop = std::max(scales_.stop, scales_.force);
  }

  // ---- along a segment ---------------------------------------------------------------------------

  /// Largest error of each law in a segment, in its own unit.
  struct Errors {
    T law{0}, velocity{0}, friction{0}, sticking{0};
  };

  /// Powers; sums of the powers and of v and a over a panel.
  struct Sums {
    T v{0}, a{0}, input{0}, damper{0}, plate{0}, finger{0}, stop{0}, stretching{0}, skin{0};
  };

  /// Compares the laws along a segment; returns its last state.
  Numbers walk(const Closed& evaluated) {
    const Oscillator<T>& oscillator = evaluated.segment.flow.oscillator;
    const T alpha = oscillator.alpha(), fastest = oscillator.fastest_rate();
    const T quick = detail::exact_over / fastest;
    const bool waves = evaluated.along.waves();
    const Guards<detail::ClosedForm<T>> guards(evaluated);
    Errors errors;
    auto from = evaluated.at(T(0));
    laws(evaluated, from, errors);
    T low{0};
    for (int panels = 0; low < evaluated.span && go_on_(); ++panels) {
      const bool grows = !oscillator.oscillates() || -alpha * low > 40;
      const T length = !waves ? evaluated.span : grows ? std::max(quick, low / 2) : quick;
      const bool leaps = panels == detail::tolerance::walked_panels &&
                         evaluated.span - low > (detail::tolerance::walked_panels + 1) * length;
      T high = leaps ? evaluated.span - detail::tolerance::walked_panels * length
                     : std::min(low + length, evaluated.span);
      if (!(high > low)) high = evaluated.span;  // so late that a panel is lost in rounding
      const auto to = evaluated.at(high);
      if (leaps)
        leap(evaluated, from, to);
      else
        panel(evaluated, guards, from, to, !waves || (high - low) * fastest < T(1.2), errors);
      from = to;
      low = high;
    }
    judge(evaluated, errors, fastest);
    return from;
  }

  /// Compares the laws along the parts of a segment in which all quantities are polynomials.
  template <class Trajectory>
  Numbers walk(const Evaluated<Trajectory>& evaluated) {
    Errors errors;
    const Guards<Trajectory> guards(evaluated);
    auto from = evaluated.at(T(0));
    T shortest = evaluated.span;
    laws(evaluated, from, errors);
    evaluated.along.each_part(evaluated.span, [&](T low, auto length, const auto& expanded) {
      const auto to = evaluated.at(low + length);
      const T error = std::max(evaluated.unsure(from), evaluated.unsure(to));
      for (const auto& [guard, law, scale, slid] : guards) {
        const T least = lowest(expanded(guard), T(detail::tolerance::unseen_violation) * scale) +
                        (law == &Certificate<T>::force_bound ? error : slid);
        if (!(least >= 0)) worst(result_.*law, least, scale);
      }
      Sums sums;
      detail::gauss_nodes(detail::gauss16, low, T(low + length), [&](T tau, T weight) {
        const auto now = evaluated.at(tau);
        laws(evaluated, now, errors);
        gather(evaluated, now, weight, sums);
      });
      laws(evaluated, to, errors);
      balance(evaluated, from, to, sums);
      shortest = std::min(shortest, T(length));
      from = to;
      return go_on_();
    });
    judge(evaluated, errors, 1 / shortest);
    return from;
  }

  template <class Trajectory>
  void judge(const Evaluated<Trajectory>& evaluated, const Errors& errors, T fastest) {
    worst(result_.motion_law, errors.law, scales_.stop);
    // An error in the rate of the position counts by how far it moves the pin in a mode.
    const T moves = scales_.x * std::max(fastest, 1 / evaluated.span);
    worst(result_.kinematics, errors.velocity, std::max(scales_.v, moves));
    worst(result_.friction_law, errors.friction, scales_.force);
    worst(result_.sticking, errors.sticking, scales_.v);
  }

  void panel(const Closed& evaluated, const Guards<detail::ClosedForm<T>>& guards,
             const ClosedState& from, const ClosedState& to, bool brief, Errors& errors) {
    const Oscillator<T>& oscillator = evaluated.segment.flow.oscillator;
    std::array<typename detail::PositivityBound<T>::Flatness,
               Guards<detail::ClosedForm<T>>::capacity>
        flatness;
    for (int i = 0; i < guards.size(); ++i)
      flatness[i] = guards[i].guard.flatness(oscillator, from.moment, from.tau, to.tau - from.tau);
    ClosedState before = from;
    const auto follow = [&](const ClosedState& now) {
      for (int i = 0; i < guards.size(); ++i) {
        const auto& [guard, law, scale, slid] = guards[i];
        const T lowest = guard.lowest(oscillator, guard.at(before.moment), guard.at(now.moment),
                                      flatness[i], T(detail::tolerance::unseen_violation) * scale);
        if (!(lowest >= 0)) worst(result_.*law, lowest, scale);
      }
      laws(evaluated, now, errors);
      before = now;
    };
    Sums sums;
    const auto visit = [&](T tau, T weight) {
      const auto now = evaluated.at(tau);
      follow(now);
      gather(evaluated, now, weight, sums);
    };
    if (brief)
      detail::gauss_nodes(detail::gauss8, from.tau, to.tau, visit);
    else
      detail::gauss_nodes(detail::gauss16, from.tau, to.tau, visit);
    follow(to);
    balance(evaluated, from, to, sums);
  }

  /// Compares changes with the sums of their rates.
  template <class Trajectory>
  void balance(const Evaluated<Trajectory>& evaluated, const Numbers& from, const Numbers& to,
               const Sums& sums) {
    worst(result_.kinematics, to.x - from.x - sums.v, scales_.x);
    worst(result_.kinematics, to.v - from.v - sums.a, scales_.v);
    if (stretches(evaluated))
      worst(result_.kinematics,
            (to.stretch_force - from.stretch_force) / drive_.finger.stiffness + sums.stretching,
            scales_.x);
    account(energy(from), energy(to), sums);
  }

  /// Compares changes over the middle of a very long oscillation, in closed form and without
  /// guards.
  void leap(const Closed& evaluated, const ClosedState& from, const ClosedState& to) {
    const Segment<T>& segment = evaluated.segment;
    const Path<T>&v = segment.flow.velocity, plate = segment.plate_force;
    const Path<T> v_plate = evaluated.plate_velocity.line();
    const auto over = [&](const Path<T>& p, const Path<T>& q) {
      return detail::product_integral(segment.flow.oscillator, p, q, from.tau, to.tau);
    };
    Line<T> push = evaluated.force.line();
    push.value += drive_.mass * evaluated.plate_velocity.rate;
    const Path<T> inertia = push;
    Sums sums;
    sums.input = over(plate, v_plate) + over(inertia, v);
    sums.damper = drive_.damping * over(v, v);
    sums.plate = -over(plate, v + T(-1) * v_plate);
    if (in_contact(segment.mode.stop)) sums.stop = drive_.stops.damping * over(v, v);
    if (segment.mode.finger != ContactState::elastic_stick)
      sums.finger = -over(segment.finger_force, v);
    else
      sums.skin = drive_.finger.damping * over(v, v);
    account(energy(from), energy(to), sums);
  }

  template <class Trajectory>
  void laws(const Evaluated<Trajectory>& evaluated, const typename Evaluated<Trajectory>::State& s,
            Errors& errors) {
    using std::abs;
    const Trajectory& along = evaluated.along;
    const Mode mode = evaluated.segment.mode;
    update_max(errors.velocity, along.at(evaluated.x_rate, s.moment) - s.v);
    if (stretches(evaluated))
      update_max(errors.velocity, along.at(along.derivative(evaluated.stretch_force), s.moment) /
                                          drive_.finger.stiffness +
                                      stretch_rate(evaluated, s));
    const T missed = drive_.mass * (s.a - evaluated.plate_velocity.rate_at(s.tau)) +
                     drive_.damping * s.v + drive_.stiffness * s.x - s.plate_force -
                     s.finger_force - evaluated.force.at(s.tau) - evaluated.stop_force(s);
    update_max(errors.law, std::max(abs(missed) - evaluated.unsure(s), T(0)));
    if (held_by_stop(drive_, mode)) {
      const int end = stop_sign(mode.stop);
      update_max(errors.sticking, s.v);
      worst(result_.sticking, end * s.x - drive_.stops.travel, scales_.x);
      const T pull = end * evaluated.stop_force(s) - evaluated.unsure(s);
      worst(result_.force_bound, std::max(pull, T(0)), scales_.force);
    }
    const auto contact = [&](const Contact<T>& law, ContactState does, T u, T force, T load,
                             T unsure) {
      if (is_slip(does))
        update_max(errors.friction,
                   std::max(abs(force + sign(does) * load * detail::kinetic_friction(law, abs(u))) -
                                unsure,
                            T(0)));
      else if (does == ContactState::stick)
        update_max(errors.sticking, u);
      else if (does == ContactState::absent && law.present())
        update_max(errors.friction,
                   std::max(load * detail::kinetic_friction(law, abs(u)) - unsure, T(0)));
    };
    if (evaluated.oblique())
      update_max(errors.friction, evaluated.oblique_error(s));
    else
      contact(drive_.plate, mode.plate, s.v - evaluated.plate_velocity.at(s.tau), s.plate_force,
              evaluated.load.at(s.tau), T(0));
    const T pressed = evaluated.finger_load.at(s.tau);
    T u = evaluated.on_finger(s), slope{0};
    if (drive_.finger.branches > 0) {
      const int last = drive_.finger.branches - 1;
      const auto branch = drive_.finger.branch(std::clamp(mode.finger_branch, 0, last));
      slope = abs(branch.slope);
      // A speed is beyond the end of its branch by its error, and the next branch may be steep.
      const T within = std::clamp(abs(u), branch.from, branch.to);
      if (abs(within - abs(u)) <= evaluated.slider_unsure) u = u < 0 ? -within : within;
    }
    contact(drive_.finger, mode.finger, u, s.finger_force, pressed,
            mode.finger == ContactState::absent ? evaluated.lifted_unsure()
                                                : pressed * slope * evaluated.slider_unsure);
  }

  template <class Trajectory>
  void gather(const Evaluated<Trajectory>& evaluated,
              const typename Evaluated<Trajectory>::State& s, T weight, Sums& sums) {
    // Energy may be zero at both ends of a period; the scale follows from the energy stored in between.
    stored_ = std::max(stored_, energy(s));
    const T v_plate = evaluated.plate_velocity.at(s.tau);
    const T push =
        drive_.mass * evaluated.plate_velocity.rate_at(s.tau) + evaluated.force.at(s.tau);
    sums.v += weight * s.v;
    sums.a += weight * s.a;
    sums.input += weight * (s.plate_force * v_plate + push * s.v);
    sums.damper += weight * drive_.damping * s.v * s.v;
    sums.plate -= weight * s.plate_force * (s.v - v_plate);
    const StopState stop = evaluated.segment.mode.stop;
    if (stop != StopState::apart && !drive_.stops.rigid())
      sums.stop += weight * s.v *
                   (in_contact(stop)
                        ? drive_.stops.damping * s.v
                        : drive_.stops.stiffness * (stop_sign(stop) * drive_.stops.travel - s.x));
    if (evaluated.segment.mode.finger != ContactState::elastic_stick)
      sums.finger -= weight * s.finger_force * evaluated.on_finger(s);
    if (!stretches(evaluated)) return;
    const T rate = stretch_rate(evaluated, s);
    sums.stretching += weight * rate;
    sums.skin += weight * drive_.finger.damping * rate * rate;
  }

  void account(T before, T after, const Sums& sums) {
    using std::abs;
    const T loss = sums.damper + sums.plate + sums.finger + sums.stop + sums.skin;
    balance_ += after - before - sums.input + loss;
    update_max(unaccounted_, balance_);
    stored_ = std::max({stored_, before, after});
    input_ += abs(sums.input);
    dissipated_ += abs(loss);
    for (const T part : {sums.damper, sums.plate, sums.finger, sums.stop})
      update_max(gained_, std::min(part, T(0)));
  }

  // ---- from segment to segment -------------------------------------------------------------------

  void junction(const Segment<T>& before, const Numbers& left, const Numbers& right, T time) {
    using std::abs;
    const Event event = before.event;
    worst(result_.continuity, left.x - right.x, scales_.x);
    if (stops(event.stop) && drive_.stops.rigid()) {  // the stop takes the velocity towards it
      worst(result_.continuity, right.v, scales_.v);
      worst(result_.sliding_sign, std::min(left.v * (left.x < 0 ? -1 : 1), T(0)), scales_.v);
      worst(result_.continuity, abs(left.x) - drive_.stops.travel, scales_.x);
    } else {
      // The time at which it is, and so how long the pin is accelerated, is known to its rounding.
      // A pin that creeps follows the transverse velocity, until that is within `tolerance::transverse` of zero.
      const T drifts =
          before.mode.plate == ContactState::slip_oblique
              ? abs(motion_.inputs().across_velocity.from(before.begin).rate_at(left.tau))
              : T(0);
      const T error =
          before.end * (detail::tolerance::sum<T> * std::max(abs(left.a), abs(right.a)) +
                        detail::tolerance::transverse<T> * drifts);
      worst(result_.continuity, std::max(abs(left.v - right.v) - error, T(0)), scales_.v);
    }
    if (!drive_.finger.compliant()) return;
    if (drive_.finger.damped()) return damped_junction(before, left, right, time);
    const T asked = abs(left.finger_force), drop = asked - abs(right.finger_force);
    if (event.finger != Transition::slip) {
      const T error = detail::skin_unsure(drive_, before.end, left);
      const T jump = abs(left.finger_force - right.finger_force);
      worst(result_.continuity, std::max(jump - error, T(0)), scales_.force);
      return;
    }
    const T load = motion_.inputs().finger_load.from(time).value;
    const bool gripped = before.mode.finger == ContactState::elastic_stick;
    if (gripped)
      worst(result_.transitions, std::max(drive_.finger.static_limit * load - asked, T(0)),
            scales_.force);
    const bool lifts = !(load > 0) || lifts_off(before.mode, left.v, time);
    const T most = !lifts ? load * most_from(gripped ? 0 : before.mode.finger_branch + 1) : T(0);
    const T unmet = std::max(most - asked, T(0));
    worst(result_.continuity, drop > 0 ? std::min(drop, unmet) : drop, scales_.force);
    update_max(gained_, std::min(energy(left) - energy(right), T(0)));
  }

  /// True if the stretch of the skin follows from the motion: it sticks, or it has a damper.
  template <class Trajectory>
  bool stretches(const Evaluated<Trajectory>& evaluated) const {
    return evaluated.segment.mode.finger == ContactState::elastic_stick ||
           detail::has_damped_skin(drive_, evaluated.segment);
  }
  template <class Trajectory>
  T stretch_rate(const Evaluated<Trajectory>& evaluated,
                 const typename Evaluated<Trajectory>::State& s) const {
    return evaluated.segment.mode.finger == ContactState::elastic_stick
               ? s.v
               : -s.stretch_force_rate / drive_.finger.stiffness;
  }

  /// Junction of skin with damping: its stretch does not jump, and it slips at its limit.
  void damped_junction(const Segment<T>& before, const Numbers& left, const Numbers& right,
                       T time) {
    const T error = detail::skin_unsure(drive_, before.end, left);
    const T jump = std::abs(left.stretch_force - right.stretch_force);
    worst(result_.continuity, std::max(jump - error, T(0)), scales_.force);
    if (before.event.finger != Transition::slip) return;
    const T asked = std::abs(left.finger_force - drive_.finger.damping * (right.v - left.v));
    const T most = drive_.finger.static_limit * motion_.inputs().finger_load.from(time).value;
    worst(result_.transitions, std::max(most - asked, T(0)), scales_.force);
  }

  /// True if a load that falls to zero is so close to zero that the time constants of the skin are
  /// within the time resolution: of its slider or of its alternations of stick and slip.
  bool lifts_off(const Mode& mode, T v, T time) const {
    using std::abs;
    const Contact<T>& finger = drive_.finger;
    const Curve<T> load = motion_.inputs().finger_load.from(time);
    if (!(load.rate < 0)) return false;
    const T slope = is_slip(mode.finger) ? finger.branch(mode.finger_branch).slope : T(0);
    const T limit = finger.static_limit;
    const T follows = slope > 0 ? 1 / slope : limit > 0 ? abs(v) / limit : T(0);
    const T error = time * detail::tolerance::unloaded_time<T>;
    return load.value <= error * (finger.stiffness * follows - load.rate);
  }

  /// Largest friction of the finger from a branch of its curve on, for a load factor of 1, N: skin
  /// shortens at once only where no speed has the required friction.
  T most_from(int index) const {
    const Contact<T>& finger = drive_.finger;
    if (finger.branches == 0) return finger.kinetic;
    T most{0};
    for (int i = index; i < finger.branches; ++i) most = std::max(most, finger.curve[i].force);
    return finger.curve[finger.branches - 1].slope > 0 ? never : most;
  }

  static constexpr T never = std::numeric_limits<T>::infinity();

  Motion<T> motion_;
  Drive<T> drive_;
  T duration_;
  GoOn go_on_;
  detail::Scales<T> scales_{};
  T balance_{0}, unaccounted_{0},
      gained_{0};  ///< energy balance so far, its largest error and gain, J
  T stored_{0}, input_{0},
      dissipated_{0};  ///< scales of the balance: stored, input and dissipated energy, J
  detail::Breakaways<T> breakaways_{};
  Certificate<T> result_{};
};

/// Returns the certificate of a motion over [0, duration], s.
template <class T>
Certificate<T> certify(const Motion<T>& motion, T duration, GoOn go_on = {}) {
  return Certifier<T>(motion, duration, go_on).certify();
}

}  // namespace pindrive
