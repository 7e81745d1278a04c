/// Checks a finished motion against the laws it must obey, without using the solver: no mode is
/// chosen here and no event looked for; the motion is evaluated and held against docs/theory.md, 1 and 4.
///
/// Each segment is walked once. At Gauss nodes the laws are held against the state, and sums over
/// the nodes give the integrals; between the nodes a bound proves that no guard dips unseen.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "pindrive/breakaway.hpp"
#include "pindrive/motion.hpp"
#include "pindrive/named_number.hpp"
#include "pindrive/positivity.hpp"
#include "pindrive/quadrature.hpp"

namespace pindrive {

/// The worst violation of each law, as a part of the largest force, velocity, displacement or
/// energy in the motion.
template <class T>
struct Certificate {
  T motion_law{0};  ///< m x'' + b x' + k x = R_plate + R_finger + m v_p'
  T kinematics{
      0};  ///< x' and x'' are the derivatives of x; an elastic stick stretches with the pin
  T friction_law{0};  ///< a sliding contact carries its kinetic friction
  T force_bound{0};   ///< a stuck contact carries no more than its static friction
  T sliding_sign{0};  ///< friction opposes the sliding; no guard came to zero unseen
  T sticking{0};      ///< a stuck contact does not slide
  T continuity{0};    ///< x and x' do not jump, nor the skin but where it breaks away
  T transitions{0};   ///< a contact slips from rest only where it cannot stick
  T energy{0};        ///< what goes in, is stored and is dissipated adds up
  T dissipation{0};   ///< friction and damper take energy, never give

  T worst() const {
    return std::max({motion_law, kinematics, friction_law, force_bound, sliding_sign, sticking,
                     continuity, transitions, energy, dissipation});
  }
};

/// Its laws, by their names in the table of quantities, after "certificate.".
template <class T>
inline constexpr NamedNumber<T, Certificate<T>> certificate_numbers[] = {
    {"motion_law", [](const Certificate<T>& c) { return c.motion_law; }},
    {"kinematics", [](const Certificate<T>& c) { return c.kinematics; }},
    {"friction_law", [](const Certificate<T>& c) { return c.friction_law; }},
    {"force_bound", [](const Certificate<T>& c) { return c.force_bound; }},
    {"sliding_sign", [](const Certificate<T>& c) { return c.sliding_sign; }},
    {"sticking", [](const Certificate<T>& c) { return c.sticking; }},
    {"continuity", [](const Certificate<T>& c) { return c.continuity; }},
    {"transitions", [](const Certificate<T>& c) { return c.transitions; }},
    {"energy", [](const Certificate<T>& c) { return c.energy; }},
    {"dissipation", [](const Certificate<T>& c) { return c.dissipation; }},
};

template <class T, class GoOn = Unattended>
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
        const auto stage = stage_of(segment, along);
        breaks_away(stage);
        return walk(stage);
      });
      if (segment.end > duration_) break;
      const Segment<T>* next = motion_.after(segment);
      if (next == nullptr) break;
      if (next == &segment + 1) worst(result_.continuity, segment.end - next->begin, segment.end);
      junction(segment, last, start_of(*next));
    }
    const T energy = std::max({stored_, input_, dissipated_});
    worst(result_.energy, unaccounted_, energy);
    // Forces are known to their rounding, and so is what they do on the way.
    const T time = std::min(duration_, motion_.outcome().until);
    const T known = detail::rounding<T> * force_scale_ * v_scale_ * time;
    worst(result_.dissipation, std::max(gained_ - known, T(0)), energy);
    return result_;
  }

 private:
  /// How deep, as a part of the largest, a guard may dip between two nodes unseen; and how many
  /// panels are walked at each end of a segment before what lies between is leapt over.
  static constexpr T unseen = T(1e-10);
  static constexpr int walked = 2048;

  /// A guard, and the law that it breaks where it is negative.
  template <class Guard>
  struct Watch {
    Guard guard;
    T Certificate<T>::* law;
    T scale;
    T known{0};  ///< how well, by the rounding of the time
  };
  static PositivityBound<T> guard_of(const ClosedForm<T>& along, const Path<T>& path) {
    return {along.oscillator(), path};
  }
  static Polynomial<T> guard_of(const BySeries<T>&, const Polynomial<T>& path) { return path; }

  /// A segment with the inputs as they were given, and its guards.
  template <class Trajectory>
  struct Stage {
    using Quantity = std::decay_t<decltype(std::declval<Trajectory>().position())>;
    using Guard = decltype(guard_of(std::declval<Trajectory>(), std::declval<Quantity>()));

    const Segment<T>& segment;
    const Trajectory& along;
    Line<T> plate_velocity, load, finger_load, force, across;
    T span;
    Quantity x_rate, acceleration, finger_rate;
    std::array<Watch<Guard>, 6> watches;
    int count{0};
    T slider_unsure{0};  ///< m/s
  };

  /// The motion at an instant.
  struct Numbers {
    T tau, x, v, a, plate_force, finger_force, finger_rate;
  };
  template <class Trajectory>
  struct State : Numbers {
    typename Trajectory::Moment moment;
  };

  Numbers start_of(const Segment<T>& segment) const {
    return motion_.along(segment, [&](const auto& along) -> Numbers {
      return state(stage_of(segment, along), T(0));
    });
  }

  template <class Trajectory>
  Stage<Trajectory> stage_of(const Segment<T>& segment, const Trajectory& along) const {
    Stage<Trajectory> stage{
        segment,
        along,
        motion_.inputs().mouse_velocity.from(segment.begin),
        motion_.inputs().plate_load.from(segment.begin),
        motion_.inputs().finger_load.from(segment.begin),
        motion_.inputs().force.from(segment.begin),
        motion_.inputs().across_velocity.from(segment.begin),
        std::min(segment.end, std::max(duration_, segment.begin)) - segment.begin,
        along.derivative(along.position()),
        along.acceleration(),
        along.derivative(along.finger_force()),
        {}};
    const Mode mode = segment.mode;
    const Line<T> at_plate{drive_.plate.static_limit * stage.load.value,
                           drive_.plate.static_limit * stage.load.rate};
    const Line<T> at_finger{drive_.finger.static_limit * stage.finger_load.value,
                            drive_.finger.static_limit * stage.finger_load.rate};
    const auto watch = [&](const auto& path, T Certificate<T>::* law, T scale) {
      stage.watches[stage.count++] = {guard_of(along, path), law, scale, T(0)};
    };
    const auto slipping = [&](const Contact<T>& contact, ContactState does, int index,
                              const auto& sliding) {
      if (!slips(does)) return;
      const Branch<T> branch =
          contact.branch(std::clamp(index, 0, std::max(contact.branches - 1, 0)));
      const auto speed = T(sign(does)) * sliding;
      watch(along.above(speed, branch.from), &Certificate<T>::sliding_sign, v_scale_);
      if (branch.to < never)
        watch(along.above(T(-1) * speed, -branch.to), &Certificate<T>::sliding_sign, v_scale_);
    };
    const auto sticking = [&](const auto& force, const Line<T>& most) {
      const auto limit = along.line(most);
      watch(limit + force, &Certificate<T>::force_bound, force_scale_);
      watch(limit + T(-1) * force, &Certificate<T>::force_bound, force_scale_);
    };
    if (mode.plate != ContactState::slip_oblique) {
      slipping(drive_.plate, mode.plate, mode.plate_branch,
               along.velocity() + T(-1) * along.line(stage.plate_velocity));
    } else if constexpr (std::is_same_v<Trajectory, BySeries<T>>) {
      const Branch<T> branch = drive_.plate.branch(mode.plate_branch);
      const auto& speed = along.sliding_speed();
      if (branch.from > 0)
        watch(along.above(speed, branch.from), &Certificate<T>::sliding_sign, v_scale_);
      if (branch.to < never)
        watch(along.above(T(-1) * speed, -branch.to), &Certificate<T>::sliding_sign, v_scale_);
    }
    // A slider is slower than the pin by what its skin stretches.
    if (soft()) {
      const int others = stage.count;
      slipping(drive_.finger, mode.finger, mode.finger_branch,
               along.velocity() + 1 / drive_.finger.stiffness * stage.finger_rate);
      stage.slider_unsure = slider_unsure(stage);
      for (int i = others; i < stage.count; ++i) stage.watches[i].known = stage.slider_unsure;
    } else {
      slipping(drive_.finger, mode.finger, mode.finger_branch, along.velocity());
    }
    stops_at(stage, watch);
    if (held_by_stop(drive_, mode)) return stage;
    if (mode.both_stuck()) {
      sticking(along.plate_force(),
               {at_plate.value + at_finger.value, at_plate.rate + at_finger.rate});
    } else {
      if (mode.plate == ContactState::stick) sticking(along.plate_force(), at_plate);
      if (mode.finger == ContactState::stick || mode.finger == ContactState::elastic_stick)
        sticking(along.finger_force(), at_finger);
    }
    return stage;
  }

  template <class Trajectory>
  State<Trajectory> state(const Stage<Trajectory>& stage, T tau) const {
    const Trajectory& along = stage.along;
    const auto now = along.moment(tau);
    return {{tau, along.at(along.position(), now), along.at(along.velocity(), now),
             along.at(stage.acceleration, now), along.at(along.plate_force(), now),
             along.at(along.finger_force(), now), along.at(stage.finger_rate, now)},
            now};
  }

  /// What the end stops keep positive: the way to them or, of an elastic one, its depth or its push.
  template <class Trajectory, class Watch>
  void stops_at(const Stage<Trajectory>& stage, Watch&& watch) const {
    const Stops<T>& stops = drive_.stops;
    if (!stops.present()) return;
    const Trajectory& along = stage.along;
    const StopState does = stage.segment.mode.stop;
    const auto beyond = [&](int end, int sense) {
      watch(along.above(T(sense * end) * along.position(), sense * stops.travel),
            &Certificate<T>::sliding_sign, x_scale_);
    };
    if (does == StopState::apart || stops.rigid()) {
      beyond(1, -1);
      beyond(-1, -1);
      return;
    }
    const int end = side(does), sense = touches(does) ? 1 : -1;
    beyond(end, 1);
    auto damping = T(sense * end) * stops.damping * along.velocity();
    damping = T(sense * end) * stops.stiffness * along.position() + damping;
    watch(along.above(damping, sense * stops.stiffness * stops.travel),
          &Certificate<T>::force_bound, stop_scale_);
  }
  /// The force of an elastic stop on the pin, or of a rigid one that keeps it in equilibrium, N.
  template <class Stage>
  T stop_force(const Stage& stage, const Numbers& s) const {
    if (!touches(stage.segment.mode.stop)) return T(0);
    const Stops<T>& stops = drive_.stops;
    if (!stops.rigid())
      return stops.stiffness * (side(stage.segment.mode.stop) * stops.travel - s.x) -
             stops.damping * s.v;
    return drive_.stiffness * s.x - drive_.mass * stage.plate_velocity.rate - s.plate_force -
           s.finger_force - stage.force.at(s.tau);
  }

  /// Kinetic friction at a sliding speed, from the rows of the contact's curve.
  static T kinetic(const Contact<T>& contact, T speed) {
    T force = contact.kinetic;
    for (int i = 0; i < contact.branches; ++i)
      if (speed >= contact.curve[i].from)
        force = contact.curve[i].force + contact.curve[i].slope * (speed - contact.curve[i].from);
    return force;
  }

  /// How far a force and a sliding velocity are from the law of a plate that slides across too, N: by the
  /// force at that velocity or, where that turns steeply, by how far the velocity is from those with the
  /// direction of the force, as a part of the largest.
  T oblique_error(T u, T across, T force, T load) const {
    using detail::hypot;
    using std::abs;
    using std::sqrt;
    const T speed = hypot(u, across), strength = load * kinetic(drive_.plate, speed);
    if (!(strength > 0)) return force;
    const T part = -force / strength, along = std::clamp(part, T(-1), T(1));
    const T beside = abs(u * sqrt((1 - along) * (1 + along)) - abs(across) * along);
    const T too_large = strength * abs(part - along);
    // Without a scale nothing moves, and nothing pulls.
    const T by_velocity = (v_scale_ > 0 ? beside / v_scale_ * force_scale_ : beside) + too_large;
    return speed > 0 ? std::min(by_velocity, abs(force + strength * u / speed)) : by_velocity;
  }

  /// What the forces are unsure by, N: that of skin on a slider changes within the rounding of the time, as its
  /// load does, …
  template <class Stage>
  T unsure(const Stage& stage, const Numbers& s) const {
    const T of_skin = slips(stage.segment.mode.finger)
                          ? skin_unsure(stage.finger_load, stage.segment.begin + s.tau, s)
                          : T(0);
    return of_skin + turns_by(stage, s);
  }
  T skin_unsure(const Line<T>& load, T time, const Numbers& s) const {
    using std::abs;
    return soft() && load.rate != 0 ? detail::rounding<T> * time * abs(s.finger_rate) : T(0);
  }
  /// … and that of a plate that slides across too turns with the velocity, which is known to its rounding and
  /// to that of the time.
  template <class Stage>
  T turns_by(const Stage& stage, const Numbers& s) const {
    using detail::hypot;
    using std::abs;
    if (stage.segment.mode.plate != ContactState::slip_oblique) return T(0);
    const T u = s.v - stage.plate_velocity.at(s.tau), w = stage.across.at(s.tau);
    const T speed = hypot(u, w), time = stage.segment.begin + s.tau;
    const T load = std::max(stage.load.at(s.tau), T(0));  // less by rounding where it ends
    const T strength = load * kinetic(drive_.plate, speed);
    const T moves = v_scale_ + time * (abs(s.a) + abs(stage.plate_velocity.rate));
    if (!(speed > 0)) return T(0);
    const T turns = w / speed;
    return 4 * detail::rounding<T> * moves * strength * turns * turns / speed;
  }

  /// What the speed of a slider under a load that changes is unsure by, m/s: by the rounding of the time, in which it
  /// changes, and by that of the force, of whose change it is known.
  template <class Trajectory>
  T slider_unsure(const Stage<Trajectory>& stage) const {
    using std::abs;
    if (stage.finger_load.rate == 0) return T(0);
    const Trajectory& along = stage.along;
    const auto bend = along.derivative(stage.finger_rate);
    T most{0};
    for (const T tau : {T(0), stage.span}) {
      const auto now = along.moment(tau);
      const T faster =
          along.at(stage.acceleration, now) + along.at(bend, now) / drive_.finger.stiffness;
      most = std::max(most, abs(faster));
    }
    most *= detail::rounding<T> * (stage.segment.begin + stage.span);
    const T carries = abs(along.at(along.finger_force(), along.moment(T(0))));
    return most + detail::rounding<T> * carries / (drive_.finger.stiffness * stage.span);
  }

  bool soft() const { return drive_.finger.present() && !drive_.finger.rigid(); }

  T energy(const Numbers& s) const {
    const T skin = soft() ? s.finger_force * s.finger_force / (2 * drive_.finger.stiffness) : T(0);
    return drive_.mass * s.v * s.v / 2 + drive_.stiffness * s.x * s.x / 2 + skin +
           motion_.stop_energy(s.x);
  }

  /// Keeps the larger of what was found and |error|; infinity for what is not a number.
  static void raise(T& most, T error) {
    using std::abs;
    const T size = abs(error);
    if (!(size <= most)) most = size < never ? size : never;
  }
  static void worst(T& residual, T error, T scale) {
    raise(residual, scale > 0 ? error / scale : error);
  }

  /// The largest displacement, velocity and force: where segments begin and end, and within, where
  /// no wave is that begins and ends at nothing.
  void scales(const Segment<T>& segment) {
    using std::abs;
    using std::sqrt;
    const T omega0 = sqrt(drive_.stiffness / drive_.mass);
    motion_.along(segment, [&](const auto& along) {
      const auto stage = stage_of(segment, along);
      for (const T part : {T(0), T(0.382), T(1)}) {
        const T tau = part * stage.span;
        const Numbers s = state(stage, tau);
        x_scale_ = std::max(
            {x_scale_, abs(s.x), abs(s.v) / omega0, abs(stage.plate_velocity.at(tau)) / omega0});
        force_scale_ =
            std::max({force_scale_, abs(drive_.mass * s.a), abs(drive_.damping * s.v),
                      abs(s.plate_force), abs(s.finger_force), abs(stage.force.at(tau))});
        if (drive_.stops.present() && !drive_.stops.rigid())
          stop_scale_ = std::max(
              {stop_scale_, drive_.stops.stiffness * abs(s.x), drive_.stops.damping * abs(s.v)});
      }
    });
    v_scale_ = x_scale_ * omega0;
    force_scale_ = std::max(force_scale_, drive_.stiffness * x_scale_);
    stop_scale_ = std::max(stop_scale_, force_scale_);
  }

  // ---- along a segment ---------------------------------------------------------------------------

  /// The largest error of each law in a segment, in its own unit.
  struct Errors {
    T law{0}, velocity{0}, friction{0}, sticking{0};
  };

  /// Powers, and the sums of them and of v and a over a panel.
  struct Sums {
    T v{0}, a{0}, input{0}, damper{0}, plate{0}, finger{0}, stop{0};
  };

  /// Holds the laws all along a segment; its last state.
  Numbers walk(const Stage<ClosedForm<T>>& stage) {
    const Oscillator<T>& oscillator = stage.segment.flow.oscillator;
    const T alpha = oscillator.alpha(), fastest = oscillator.fastest_rate();
    const T quick = exact_over / fastest;
    const bool waves = stage.along.waves();
    Errors errors;
    auto from = state(stage, T(0));
    laws(stage, from, errors);
    T low{0};
    for (int panels = 0; low < stage.span && go_on_(); ++panels) {
      const bool grows = !oscillator.oscillates() || -alpha * low > 40;
      const T length = !waves ? stage.span : grows ? std::max(quick, low / 2) : quick;
      const bool leaps = panels == walked && stage.span - low > (walked + 1) * length;
      T high = leaps ? stage.span - walked * length : std::min(low + length, stage.span);
      if (!(high > low)) high = stage.span;  // so late that a panel is lost in rounding
      const auto to = state(stage, high);
      if (leaps)
        leap(stage, from, to);
      else
        panel(stage, from, to, !waves || (high - low) * fastest < T(1.2), errors);
      from = to;
      low = high;
    }
    judge(stage, errors, fastest);
    return from;
  }

  /// The same for a step of a series, of which all is smooth.
  Numbers walk(const Stage<BySeries<T>>& stage) {
    Errors errors;
    const auto from = state(stage, T(0)), to = state(stage, stage.span);
    const T known = std::max(unsure(stage, from), unsure(stage, to));
    for (int i = 0; i < stage.count; ++i) {
      const auto& [guard, law, scale, slid] = stage.watches[i];
      const T least =
          lowest(guard, unseen * scale) + (law == &Certificate<T>::force_bound ? known : slid);
      if (!(least >= 0)) worst(result_.*law, least, scale);
    }
    laws(stage, from, errors);
    Sums sums;
    gauss_nodes(gauss16, T(0), stage.span, [&](T tau, T weight) {
      const auto now = state(stage, tau);
      laws(stage, now, errors);
      gather(stage, now, weight, sums);
    });
    laws(stage, to, errors);
    balance(stage, from, to, sums);
    judge(stage, errors, 1 / stage.span);
    return to;
  }

  template <class Stage>
  void judge(const Stage& stage, const Errors& errors, T fastest) {
    worst(result_.motion_law, errors.law, stop_scale_);
    // An error in the rate of the position counts by how far it moves the pin in a mode.
    const T moves = x_scale_ * std::max(fastest, 1 / stage.span);
    worst(result_.kinematics, errors.velocity, std::max(v_scale_, moves));
    worst(result_.friction_law, errors.friction, force_scale_);
    worst(result_.sticking, errors.sticking, v_scale_);
  }

  using Closed = Stage<ClosedForm<T>>;
  using ClosedState = State<ClosedForm<T>>;

  void panel(const Closed& stage, const ClosedState& from, const ClosedState& to, bool brief,
             Errors& errors) {
    const Oscillator<T>& oscillator = stage.segment.flow.oscillator;
    std::array<typename PositivityBound<T>::Flatness, 6> flatness;
    for (int i = 0; i < stage.count; ++i)
      flatness[i] =
          stage.watches[i].guard.flatness(oscillator, from.moment, from.tau, to.tau - from.tau);
    ClosedState before = from;
    const auto follow = [&](const ClosedState& now) {
      for (int i = 0; i < stage.count; ++i) {
        const auto& [guard, law, scale, slid] = stage.watches[i];
        const T lowest = guard.lowest(oscillator, guard.at(before.moment), guard.at(now.moment),
                                      flatness[i], unseen * scale);
        if (!(lowest >= 0)) worst(result_.*law, lowest, scale);
      }
      laws(stage, now, errors);
      before = now;
    };
    Sums sums;
    const auto visit = [&](T tau, T weight) {
      const auto now = state(stage, tau);
      follow(now);
      gather(stage, now, weight, sums);
    };
    if (brief)
      gauss_nodes(gauss8, from.tau, to.tau, visit);
    else
      gauss_nodes(gauss16, from.tau, to.tau, visit);
    follow(to);
    balance(stage, from, to, sums);
  }

  /// Changes against the sums of their rates.
  template <class Stage>
  void balance(const Stage& stage, const Numbers& from, const Numbers& to, const Sums& sums) {
    worst(result_.kinematics, to.x - from.x - sums.v, x_scale_);
    worst(result_.kinematics, to.v - from.v - sums.a, v_scale_);
    if (stage.segment.mode.finger == ContactState::elastic_stick)
      worst(result_.kinematics,
            (to.finger_force - from.finger_force) / drive_.finger.stiffness + sums.v, x_scale_);
    account(energy(from), energy(to), sums);
  }

  /// The same over the middle of a very long oscillation, in closed form and without guards.
  void leap(const Closed& stage, const ClosedState& from, const ClosedState& to) {
    const Segment<T>& segment = stage.segment;
    const Path<T>&v = segment.flow.velocity, plate = segment.plate_force;
    const Path<T> v_plate = stage.plate_velocity;
    const auto over = [&](const Path<T>& p, const Path<T>& q) {
      return product_integral(segment.flow.oscillator, p, q, from.tau, to.tau);
    };
    Line<T> push = stage.force;
    push.value += drive_.mass * stage.plate_velocity.rate;
    const Path<T> inertia = push;
    Sums sums;
    sums.input = over(plate, v_plate) + over(inertia, v);
    sums.damper = drive_.damping * over(v, v);
    sums.plate = -over(plate, v + T(-1) * v_plate);
    if (touches(segment.mode.stop)) sums.stop = drive_.stops.damping * over(v, v);
    if (segment.mode.finger != ContactState::elastic_stick)
      sums.finger = -over(segment.finger_force, v);
    account(energy(from), energy(to), sums);
  }

  template <class Trajectory>
  void laws(const Stage<Trajectory>& stage, const State<Trajectory>& s, Errors& errors) {
    using std::abs;
    const Trajectory& along = stage.along;
    const Mode mode = stage.segment.mode;
    raise(errors.velocity, along.at(stage.x_rate, s.moment) - s.v);
    if (mode.finger == ContactState::elastic_stick)
      raise(errors.velocity, along.at(stage.finger_rate, s.moment) / drive_.finger.stiffness + s.v);
    const T missed = drive_.mass * (s.a - stage.plate_velocity.rate) + drive_.damping * s.v +
                     drive_.stiffness * s.x - s.plate_force - s.finger_force -
                     stage.force.at(s.tau) - stop_force(stage, s);
    raise(errors.law, std::max(abs(missed) - unsure(stage, s), T(0)));
    if (held_by_stop(drive_, mode)) {
      const int end = side(mode.stop);
      raise(errors.sticking, s.v);
      worst(result_.sticking, end * s.x - drive_.stops.travel, x_scale_);
      const T pull = end * stop_force(stage, s) - unsure(stage, s);
      worst(result_.force_bound, std::max(pull, T(0)), force_scale_);
    }
    const auto contact = [&](const Contact<T>& law, ContactState does, T u, T force, T load,
                             T unsure) {
      if (does == ContactState::slip_oblique)
        raise(errors.friction, oblique_error(u, stage.across.at(s.tau), force, load));
      else if (slips(does))
        raise(errors.friction,
              std::max(abs(force + sign(does) * load * kinetic(law, abs(u))) - unsure, T(0)));
      else if (does == ContactState::stick)
        raise(errors.sticking, u);
    };
    contact(drive_.plate, mode.plate, s.v - stage.plate_velocity.at(s.tau), s.plate_force,
            stage.load.at(s.tau), T(0));
    const T pressed = stage.finger_load.at(s.tau);
    const T slope =
        drive_.finger.branches > 0
            ? abs(drive_.finger
                      .branch(std::clamp(mode.finger_branch, 0, drive_.finger.branches - 1))
                      .slope)
            : T(0);
    contact(drive_.finger, mode.finger, on_finger(stage, s), s.finger_force, pressed,
            pressed * slope * stage.slider_unsure);
  }

  /// The sliding velocity on the finger.
  template <class Trajectory>
  T on_finger(const Stage<Trajectory>& stage, const State<Trajectory>& s) const {
    if (!soft()) return s.v;
    return s.v + stage.along.at(stage.finger_rate, s.moment) / drive_.finger.stiffness;
  }

  template <class Trajectory>
  void gather(const Stage<Trajectory>& stage, const State<Trajectory>& s, T weight, Sums& sums) {
    // A whole wave may begin and end at nothing, and be summed from what is stored on the way.
    stored_ = std::max(stored_, energy(s));
    const T v_plate = stage.plate_velocity.at(s.tau);
    const T push = drive_.mass * stage.plate_velocity.rate + stage.force.at(s.tau);
    sums.v += weight * s.v;
    sums.a += weight * s.a;
    sums.input += weight * (s.plate_force * v_plate + push * s.v);
    sums.damper += weight * drive_.damping * s.v * s.v;
    sums.plate -= weight * s.plate_force * (s.v - v_plate);
    const StopState stop = stage.segment.mode.stop;
    if (stop != StopState::apart && !drive_.stops.rigid())
      sums.stop +=
          weight * s.v *
          (touches(stop) ? drive_.stops.damping * s.v
                         : drive_.stops.stiffness * (side(stop) * drive_.stops.travel - s.x));
    if (stage.segment.mode.finger != ContactState::elastic_stick)
      sums.finger -= weight * s.finger_force * on_finger(stage, s);
  }

  void account(T before, T after, const Sums& sums) {
    using std::abs;
    const T loss = sums.damper + sums.plate + sums.finger + sums.stop;
    balance_ += after - before - sums.input + loss;
    raise(unaccounted_, balance_);
    stored_ = std::max({stored_, before, after});
    input_ += abs(sums.input);
    dissipated_ += abs(loss);
    for (const T part : {sums.damper, sums.plate, sums.finger, sums.stop})
      raise(gained_, std::min(part, T(0)));
  }

  // ---- from segment to segment -------------------------------------------------------------------

  void junction(const Segment<T>& before, const Numbers& left, const Numbers& right) {
    using std::abs;
    const Event event = before.event;
    worst(result_.continuity, left.x - right.x, x_scale_);
    if (stops(event.stop) && drive_.stops.rigid()) {  // it takes the velocity, which was towards it
      worst(result_.continuity, right.v, v_scale_);
      worst(result_.sliding_sign, std::min(left.v * (left.x < 0 ? -1 : 1), T(0)), v_scale_);
      worst(result_.continuity, abs(left.x) - drive_.stops.travel, x_scale_);
    } else {
      // The time at which it is, and so how long the pin is accelerated, is known to its rounding.
      const T known = detail::rounding<T> * before.end * std::max(abs(left.a), abs(right.a));
      worst(result_.continuity, std::max(abs(left.v - right.v) - known, T(0)), v_scale_);
    }
    if (!soft()) return;
    const T asked = abs(left.finger_force), drop = asked - abs(right.finger_force);
    if (event.finger != Transition::slip) {
      const T known =
          skin_unsure(motion_.inputs().finger_load.from(before.begin), before.end, left);
      const T jump = abs(left.finger_force - right.finger_force);
      worst(result_.continuity, std::max(jump - known, T(0)), force_scale_);
      return;
    }
    const T load = motion_.inputs().finger_load.from(before.end).value;
    const bool gripped = before.mode.finger == ContactState::elastic_stick;
    if (gripped)
      worst(result_.transitions, std::max(drive_.finger.static_limit * load - asked, T(0)),
            force_scale_);
    const bool lifts = !(load > 0) || lifts_off(before.mode, left.v, before.end);
    const T most = !lifts ? load * most_from(gripped ? 0 : before.mode.finger_branch + 1) : T(0);
    const T unmet = std::max(most - asked, T(0));
    worst(result_.continuity, drop > 0 ? std::min(drop, unmet) : drop, force_scale_);
    raise(gained_, std::min(energy(left) - energy(right), T(0)));
  }

  /// Whether a load that falls to zero is so near to that that the times in which skin follows it are within
  /// the rounding of the time: those of its slider or of the rounds in which it grips and slips.
  bool lifts_off(const Mode& mode, T v, T time) const {
    using std::abs;
    const Contact<T>& finger = drive_.finger;
    const Line<T> load = motion_.inputs().finger_load.from(time);
    if (!(load.rate < 0)) return false;
    const T slope = slips(mode.finger) ? finger.branch(mode.finger_branch).slope : T(0);
    const T limit = finger.static_limit;
    const T follows = slope > 0 ? 1 / slope : limit > 0 ? abs(v) / limit : T(0);
    const T known = 65 * detail::rounding<T> * time;
    return load.value <= known * (finger.stiffness * follows - load.rate);
  }

  /// The largest friction of the finger from a branch of its curve on, under a load of 1: skin becomes
  /// shorter at once only where no speed carries what it asks.
  T most_from(int index) const {
    const Contact<T>& finger = drive_.finger;
    if (finger.branches == 0) return finger.kinetic;
    T most{0};
    for (int i = index; i < finger.branches; ++i) most = std::max(most, finger.curve[i].force);
    return finger.curve[finger.branches - 1].slope > 0 ? never : most;
  }

  /// How far within its limit the force is of what sticks, N; 0 where nothing does.
  template <class Stage>
  T within_limit(const Stage& stage, const Numbers& s) const {
    using std::abs;
    const Mode mode = stage.segment.mode;
    T most{0}, force{0};
    if (mode.plate == ContactState::stick) {
      most += drive_.plate.static_limit * stage.load.value;
      force += s.plate_force;
    }
    if (mode.finger == ContactState::stick) {
      most += drive_.finger.static_limit * stage.finger_load.value;
      force += s.finger_force;
    }
    return most - abs(force);
  }

  /// A contact begins to slip from rest only where it cannot stick. Segments in which nothing has time
  /// to change are one instant with the next, but for what sticks within its limit however briefly.
  template <class Stage>
  void breaks_away(const Stage& stage) {
    using std::abs;
    const Segment<T>& segment = stage.segment;
    if (!brief_) instant_ = segment.begin;
    Numbers s = state(stage, T(0));
    // A plate's direction may turn in no more time than that.
    const bool oblique = segment.mode.plate == ContactState::slip_oblique;
    const auto turned = [&] {
      return abs(state(stage, stage.span).plate_force - s.plate_force) > T(1e-10) * force_scale_;
    };
    brief_ = segment.end - segment.begin <= T(1e-11) * x_scale_ / v_scale_ &&
             !(within_limit(stage, s) > 8 * detail::rounding<T> * force_scale_) &&
             !(oblique && turned());
    const auto began = [&](ContactState does, ContactState& was, T& since) {
      const bool slides_on = was == ContactState::slip_oblique && slips(does);
      if (does != was && !slides_on) since = segment.begin;
      was = does;
      return since >= instant_;
    };
    const bool plate = began(segment.mode.plate, plate_, plate_since_);
    const bool finger = began(segment.mode.finger, finger_, finger_since_);
    if (brief_ || held_by_stop(drive_, segment.mode)) return;
    const T still = T(1e-12) * v_scale_;
    // Where both sliding velocities are zero, a plate's direction is that in which the pin sets out, or stays.
    const T drags = stage.plate_velocity.rate, turns = detail::hypot(drags, stage.across.rate);
    if (oblique && turns > 0 && abs(s.v - stage.plate_velocity.value) <= still &&
        abs(stage.across.value) <= still)
      s.plate_force = stage.load.value * kinetic(drive_.plate, T(0)) * drags / turns;
    // A rigid stop keeps the pin from going with the plate.
    const int end = s.x < 0 ? -1 : 1;
    const bool at_stop = drive_.stops.rigid() && end * s.x >= drive_.stops.travel;
    const bool on_plate = abs(s.v - stage.plate_velocity.value) <= still && !oblique &&
                          !(at_stop && end * stage.plate_velocity.rate > 0);
    const bool on_finger = abs(s.v) <= still && drive_.finger.rigid();
    if (!(plate && on_plate) && !(finger && on_finger)) return;
    const T push = stage.force.value + stop_force(stage, s);
    const auto spare_of = [&](bool rests_on_plate, bool rests_on_finger) {
      const Beginning<T> now{s.x,
                             s.v,
                             s.plate_force,
                             s.finger_force,
                             stage.plate_velocity,
                             stage.load.value,
                             stage.finger_load.value,
                             push,
                             rests_on_plate,
                             rests_on_finger,
                             plate,
                             finger};
      return spare_stick_limit(drive_, segment.mode, now) - unsure(stage, s);
    };
    // What slid before and slides on is at rest or not where its speed is rounding.
    T spare = spare_of(on_plate, on_finger);
    if (on_plate && !plate) spare = std::min(spare, spare_of(false, on_finger));
    if (on_finger && !finger) spare = std::min(spare, spare_of(on_plate, false));
    worst(result_.transitions, std::max(spare, T(0)), force_scale_);
  }

  static constexpr T never = std::numeric_limits<T>::infinity();

  Motion<T> motion_;
  Drive<T> drive_;
  T duration_;
  GoOn go_on_;
  T x_scale_{0}, v_scale_{0}, force_scale_{0};
  T stop_scale_{0};  ///< of forces where elastic stops are, which may be stiffer by far
  T balance_{0}, unaccounted_{0}, gained_{0};  ///< J: of the ledger so far, at its worst …
  T stored_{0}, input_{0}, dissipated_{0};     ///< … and what it is measured against
  ContactState plate_{ContactState::absent}, finger_{ContactState::absent};  ///< what they do, …
  T plate_since_{0}, finger_since_{0};                                       ///< … since when
  T instant_{0};  ///< when the instant began that ends where the segment begins
  bool brief_{false};
  Certificate<T> result_{};
};

}  // namespace pindrive
