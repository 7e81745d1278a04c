/// The event loop: mode → closed form → earliest event → next mode. No step, no tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "flow.hpp"
#include "friction.hpp"
#include "model.hpp"
#include "recurrence.hpp"
#include "roots.hpp"

namespace second_opinion {

/// Follows one pin from its release and hands each segment to the sink, in order of time; a sink may
/// return false to stop.
template <class T, class Surface = Contact<T>, class Input = Profile<T>>
class Simulation {
 public:
  Simulation(const Drive<T, Surface>& drive, const Inputs<T, Input>& inputs)
      : drive_(drive),
        inputs_(inputs),
        friction_(drive),
        plain_(drive.mass, drive.damping, drive.stiffness),
        half_period_(plain_.zeros(T(0), T(1)).first),
        half_turn_(plain_.oscillates() ? plain_.half_turn() : Transition<T>{}),
        x_(inputs.displacement),
        v_(inputs.velocity) {
    look_ahead();
    using std::isnan;
    const bool given = !isnan(inputs.skin_stretch);
    if (given) skin_ = drive.finger.stiffness * inputs.skin_stretch;
    mode_ = friction_.starting(now_, x_, v_, skin_, given);
  }

  template <class Sink>
  Outcome<T> run(Sink&& sink) {
    int standing = 0;
    for (long long events = 0; events < event_limit; ++events) {
      const Segment<T> segment = next();
      outcome_.until = segment.end;
      if (!goes_on(sink, segment)) {
        outcome_.status = Status::stopped;
        return outcome_;
      }
      if (finished_ || outcome_.cycles()) return outcome_;
      standing = segment.end > segment.begin ? 0 : standing + 1;
      if (standing > standstill_limit) {
        outcome_.status = Status::standstill;
        return outcome_;
      }
    }
    outcome_.status = Status::too_many_events;
    return outcome_;
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();
  static constexpr T rounding = 4 * std::numeric_limits<T>::epsilon();

  /// Why a mode ends: a sliding velocity comes to zero, or to the lower or upper end of a region
  /// of a friction curve; a contact cannot hold any longer; or an input has its next row. And a
  /// mode that grows is written anew from its state before its rounding has grown.
  enum class Cause : signed char { nothing, arrives, slower, faster, gives_way, input, grown };

  struct Exit {
    T tau{never};
    Cause cause{Cause::nothing};
    bool plate{false}, finger{false};
    int side{0};            ///< of the force that the contact cannot hold
    bool half_turn{false};  ///< the pin has swung from one zero of its velocity to the next
  };

  // ---- one mode ----------------------------------------------------------------------------------

  Segment<T> next() {
    const Equation<T> equation = friction_.equation(mode_, now_, x_, skin_);
    follows_ = !mode_.stuck() && follows(equation);
    Segment<T> segment;
    segment.begin = time_;
    segment.end = never;
    segment.mode = mode_;
    if (mode_.stuck())
      segment.flow = Flow<T>::stuck(x_, friction_.level(mode_, now_));
    else
      segment.flow = free_flow(equation);
    segment.plate_velocity = now_.plate_velocity;
    segment.plate_force = friction_.plate_force(mode_, now_, equation, segment.flow);
    segment.finger_force = friction_.finger_force(mode_, equation, segment.flow, skin_);

    Exit exit = comes_to_rest(segment) ? rest(segment.flow) : first_exit(segment);
    // What happens at the row of an input to rounding is judged with what the row brings.
    if (row_ < never && exit.tau < never && row_ - (time_ + exit.tau) <= rounding * row_)
      exit = {row_ - time_, Cause::input, false, false, 0};
    finished_ = !(time_ + exit.tau < inputs_.duration);
    if (!finished_) {
      leave(segment, exit);
      return segment;
    }
    if (exit.tau == never) outcome_.end = ending(segment.flow);
    if (outcome_.end == End::moving && inputs_.duration < never) {
      segment.end = inputs_.duration;
      segment.moved = segment.flow.after(segment.end - segment.begin);
    }
    return segment;
  }

  Flow<T> free_flow(const Equation<T>& equation) const {
    const Oscillator<T> oscillator =
        friction_.constant(mode_)
            ? plain_
            : Oscillator<T>(drive_.mass, equation.damping, equation.stiffness);
    const T drift = equation.pull.rate / equation.stiffness;
    using std::abs;
    // A pin without speed on which forces act that cancel to rounding is at rest.
    if (v_ == 0 && equation.pull.rate == 0 && abs(equation.pull.value) <= equation.blur(v_))
      return Flow<T>::free(oscillator, x_, v_, T(0), T(0), T(0));
    if (!follows_) {
      const T acceleration = (equation.pull.value - equation.damping * v_) / drive_.mass;
      const T y = (equation.damping * drift - equation.pull.value) / equation.stiffness;
      return Flow<T>::free(oscillator, x_, v_, acceleration, y, drift);
    }
    const T y = -(drive_.mass * followed() + equation.damping * (v_ - drift)) / equation.stiffness;
    return Flow<T>::free(oscillator, x_, v_, followed(), y, drift);
  }

  /// Whether the pin sets out along with a level: it breaks loose tangentially, or came to the border
  /// of a region with no more than rounding against it.
  bool follows(const Equation<T>& equation) const {
    using std::abs;
    if (Surface::plain || tangential_ || !bordering_) return tangential_;
    const T against = equation.pull.value - equation.damping * v_ - drive_.mass * followed();
    return abs(against) <= equation.blur(v_);
  }
  /// The acceleration of that level.
  T followed() const {
    return tangential_ ? tangent_ : changed_plate_ ? now_.plate_velocity.rate : T(0);
  }

  // ---- how it ends -------------------------------------------------------------------------------

  Exit first_exit(const Segment<T>& segment) const {
    const Flow<T>& flow = segment.flow;
    const Mode mode = segment.mode;
    Exit first, border;
    if (row_ < never) first = {row_ - time_, Cause::input, false, false, 0};
    if (!friction_.constant(mode) && flow.velocity.oscillates() &&
        flow.oscillator.serves_for() < first.tau)
      first = {flow.oscillator.serves_for(), Cause::grown, false, false, 0};

    // Two surfaces that keep different speeds are never reached together: no guard need be followed
    // beyond what is known to end the mode, and of two that the pin outruns on one side the farther
    // one hides behind the nearer.
    const bool apart =
        friction_.constant(mode) && now_.plate_velocity.rate == 0 && now_.plate_velocity.value != 0;
    const auto consider = [&](const Path<T>& guard, auto&& goes, Exit exit) {
      if (guard.start > 0 && guard.constant()) return;
      // At its zero already, a guard leaves it to the side where it goes.
      const bool at_once = !(guard.start > 0) && goes(guard) < 0;
      exit.tau =
          at_once ? T(0) : first_root(flow.oscillator, guard, 1, apart ? first.tau : row_ - time_);
      if ((exit.cause == Cause::slower || exit.cause == Cause::faster) && exit.tau < border.tau)
        border = exit;
      if (exit.cause == Cause::gives_way && turns_back(flow, guard, exit)) return;
      if (exit.tau == never || exit.tau > first.tau) return;
      if (exit.tau == first.tau && exit.cause == first.cause) {
        first.plate = first.plate || exit.plate;
        first.finger = first.finger || exit.finger;
      } else if (exit.tau < first.tau || first.cause == Cause::input ||
                 first.cause == Cause::grown) {
        first = exit;
      }
    };
    const auto sliding = [&](const Surface& contact, Slide slide, int index, Line<T> surface,
                             bool hidden, bool just_changed, Exit exit) {
      if (!slides(slide)) return;
      const Path<T> level = surface;
      Path<T> above = along(slide, T(1)) * (flow.velocity + T(-1) * level);
      const Region<T> region = contact.region(index);
      const T speed = above.start;
      above.start -= region.from;
      // A pin that goes along with the border of a region may be sent back, but not twice.
      const bool away = just_changed && (!follows_ || tangential_ || bounced_);
      const auto goes = [&](const Path<T>& guard) {
        return away ? 1 : side_after_zero(flow.oscillator, guard);
      };
      exit.cause = index == 0 ? Cause::arrives : Cause::slower;
      // A pin that stays at its level has arrived there.
      const auto arrives = [&](const Path<T>& guard) {
        const int side = goes(guard);
        return index == 0 && side == 0 ? -1 : side;
      };
      if (!hidden) consider(above, arrives, exit);
      if (!(region.to < never)) return;
      Path<T> below = T(-1) * above;
      below.start = region.to - speed;
      exit.cause = Cause::faster;
      consider(below, goes, exit);
    };
    const auto holding = [&](const Path<T>& force, Line<T> limit, Exit exit) {
      exit.cause = Cause::gives_way;
      for (const int side : {1, -1}) {
        exit.side = side;
        const Path<T> most = limit, left = most + T(-side) * force;
        // A gripping skin stretches as the pin moves, whose start is exact.
        const auto goes = [&](const Path<T>& guard) {
          return !mode.stuck() ? -side * side_after_start(flow.oscillator, flow.velocity)
                 : held_again_ ? 1
                               : side_after_zero(flow.oscillator, guard);
        };
        consider(left, goes, exit);
      }
    };

    const Exit plate{never, Cause::nothing, true, false, 0};
    const Exit finger{never, Cause::nothing, false, true, 0};
    const T nearer =
        apart && mode.plate == mode.finger ? sign(mode.plate) * segment.plate_velocity.value : T(0);
    sliding(drive_.finger, mode.finger, mode.finger_region, {}, nearer > 0, changed_finger_,
            finger);
    sliding(drive_.plate, mode.plate, mode.plate_region, segment.plate_velocity, nearer < 0,
            changed_plate_, plate);
    if (!Surface::plain && mode.finger == Slide::gripping)
      holding(T(-1) * segment.finger_force, {drive_.finger.static_limit, T(0)}, finger);
    if (mode.stuck())
      holding(mode.plate == Slide::stuck ? segment.plate_force : segment.finger_force,
              friction_.capacity(mode, now_),
              {never, Cause::nothing, mode.plate == Slide::stuck, mode.finger == Slide::stuck, 0});
    // A force that comes to its limit as another contact comes to a row of its curve is judged with
    // what the row brings.
    if (first.cause == Cause::gives_way && border.tau - first.tau <= rounding * (time_ + first.tau))
      return border;
    return first;
  }

  /// Gripping skin whose vibration reaches its limit by no more than rounding turns back there and,
  /// with nothing that drives it, never goes beyond.
  static bool turns_back(const Flow<T>& flow, const Path<T>& guard, const Exit& exit) {
    using std::abs;
    const Oscillator<T>& oscillator = flow.oscillator;
    const bool vibrates = flow.position.oscillates() && guard.straight() &&
                          oscillator.oscillates() && !(oscillator.alpha() > 0);
    if (!vibrates || exit.tau == T(0) || exit.tau == never) return false;
    const T v = flow.velocity.at(oscillator, exit.tau);
    const T acceleration = flow.acceleration().at(oscillator, exit.tau);
    const T swing = oscillator.omega() * flow.amplitude();
    return exit.side * acceleration < 0 && exit.side * v * abs(v) <= rounding * swing * swing;
  }

  /// Whether a pin that slides under constant friction comes to rest on the finger before anything
  /// else can end the mode. Its velocity oscillates about zero: once it falls, it falls to there.
  bool comes_to_rest(const Segment<T>& segment) const {
    const Mode mode = segment.mode;
    const Path<T>& velocity = segment.flow.velocity;
    const Oscillator<T>& oscillator = segment.flow.oscillator;
    if (!slides(mode.finger) || !friction_.constant(mode) || velocity.centre() != 0 ||
        row_ < never || !oscillator.oscillates())
      return false;
    const int side = sign(mode.finger);
    const T speed = side * velocity.value, rising = side * velocity.slope;
    if (!(speed > 0) && !(speed == 0 && rising > 0)) return false;
    if (!slides(mode.plate)) return true;
    const T plate = side * segment.plate_velocity.value;
    if (mode.plate == mode.finger) return plate < 0;
    if (!(speed <= plate)) return false;
    if (!(rising > 0)) return true;
    const T sine = velocity.slope - oscillator.alpha() * velocity.value;
    const T cosine = oscillator.omega() * velocity.value, reach = oscillator.omega() * plate;
    return speed < plate && sine * sine + cosine * cosine < reach * reach;
  }

  /// When it does.
  Exit rest(const Flow<T>& flow) const {
    const Path<T>& velocity = flow.velocity;
    const T tau = velocity.value == 0 ? half_period_
                                      : flow.oscillator.zeros(velocity.value, velocity.slope).first;
    if (tau == never) return {};
    if (velocity.value == 0) return {tau, Cause::arrives, false, true, 0, true};
    return {Rooted<T>::at(flow.oscillator, velocity, tau), Cause::arrives, false, true};
  }

  static int side_after_zero(const Oscillator<T>& oscillator, Path<T> guard) {
    guard.start = T(0);
    return side_after_start(oscillator, guard);
  }

  // ---- what follows ------------------------------------------------------------------------------

  /// Ends a segment and brings the state, set exactly at the event, to the next mode.
  void leave(Segment<T>& segment, const Exit& exit) {
    const Mode before = mode_;
    const Transition<T> moved = exit.half_turn ? half_turn_ : segment.flow.after(exit.tau);
    segment.moved = moved;
    x_ = segment.flow.position.at(moved, exit.tau);
    v_ = segment.flow.velocity.at(moved, exit.tau);
    if (!Surface::plain && before.finger == Slide::gripping)
      skin_ = -segment.finger_force.at(moved, exit.tau);
    segment.end = time_ = exit.cause == Cause::input ? row_ : time_ + exit.tau;
    advance(exit);
    if (before.stuck()) v_ = friction_.level(before, now_).value;
    // Where no force jumps, a pin at the same instant still leaves as the event before let it go.
    const bool skin_follows = !Surface::plain && exit.cause == Cause::gives_way && exit.finger &&
                              before.finger == Slide::gripping &&
                              drive_.finger.kinetic == drive_.finger.static_limit;
    const bool border =
        !Surface::plain && (exit.cause == Cause::slower || exit.cause == Cause::faster);
    const bool at_once = exit.tau == 0 && (border || skin_follows);
    tangential_ = tangential_ && at_once;
    const bool same_instant = !(segment.end > segment.begin);
    bounced_ = border && bordering_ && same_instant;
    bordering_ = border;
    held_again_ = same_instant && exit.cause == Cause::arrives &&
                  ((exit.plate && let_go_.plate) || (exit.finger && let_go_.finger));
    let_go_ = {};
    changed_plate_ = exit.plate || (changed_plate_ && at_once);
    changed_finger_ = exit.finger || (changed_finger_ && at_once);

    switch (exit.cause) {
      case Cause::arrives:
        arrive(exit);
        break;
      case Cause::slower:
      case Cause::faster:
        change_region(exit);
        break;
      case Cause::gives_way:
        give_way(segment, exit);
        break;
      case Cause::input:
      case Cause::nothing:
        meet_input();
        break;
      case Cause::grown:
        break;
    }
    segment.event = {change(before.plate, mode_.plate), change(before.finger, mode_.finger)};
  }

  void advance(const Exit& exit) {
    if (exit.cause == Cause::input) {
      look_ahead();
    } else {
      now_.plate_velocity.value = now_.plate_velocity.at(exit.tau);
      now_.load.value = now_.load.at(exit.tau);
    }
  }

  void look_ahead() {
    now_ = {inputs_.mouse_velocity.from(time_), inputs_.plate_load.from(time_)};
    row_ = std::min(inputs_.mouse_velocity.next_row(time_), inputs_.plate_load.next_row(time_));
  }

  void arrive(const Exit& exit) {
    const bool held = mode_.stuck();
    if (held) now_.plate_velocity.value = T(0);  // one level carries the pin to the other
    v_ = exit.plate ? now_.plate_velocity.value : T(0);
    if (exit.finger && !drive_.finger.rigid()) grip();
    const bool finger = exit.finger && drive_.finger.rigid();
    if (!exit.plate && !finger) return;
    const Mode stuck{exit.plate ? Slide::stuck : mode_.plate, finger ? Slide::stuck : mode_.finger,
                     mode_.plate_region, mode_.finger_region};
    const bool parting = stuck.both_stuck() && now_.plate_velocity.rate != 0;
    const int side = sign(exit.plate ? mode_.plate : mode_.finger);
    mode_ = parting || held ? friction_.holding(stuck, mode_, now_, x_, skin_)
                            : friction_.arriving(stuck, side, now_, x_, skin_);
    if (held) changed_plate_ = changed_finger_ = true;
  }

  /// Skin that slid grips again, with the stretch that carries its kinetic friction. It never
  /// blocks the pin.
  void grip() {
    skin_ = sign(mode_.finger) * drive_.finger.kinetic;
    mode_.finger = Slide::gripping;
  }

  void change_region(const Exit& exit) {
    const int step = exit.cause == Cause::faster ? 1 : -1;
    const auto border = [&](const Surface& contact, Slide slide, int& index) {
      const Region<T> region = contact.region(index);
      index += step;
      return sign(slide) * (step > 0 ? region.to : region.from);
    };
    T v = v_;
    if (exit.plate)
      v = now_.plate_velocity.value + border(drive_.plate, mode_.plate, mode_.plate_region);
    if (exit.finger) v = border(drive_.finger, mode_.finger, mode_.finger_region);
    if (exit.tau > 0) v_ = v;  // else it is at another level too, whose number it keeps
    if (exit.plate && step > 0) note_recurrence(false);
  }

  void give_way(const Segment<T>& segment, const Exit& exit) {
    if (mode_.finger == Slide::gripping && exit.finger) {
      mode_.finger = static_cast<Slide>(exit.side);
      mode_.finger_region = drive_.finger.region_of(exit.side * v_);
      if (!mode_.stuck()) return;
      // The skin's force drops to its kinetic friction: the plate may not hold what is left.
      mode_ = friction_.holding(mode_, mode_, now_, x_, skin_);
      changed_plate_ = !mode_.stuck();
      return;
    }
    const auto even = [](bool taken, const Surface& contact) {
      return !taken || contact.kinetic == contact.static_limit;
    };
    let_go_ = {exit.plate, exit.finger};
    tangential_ = even(exit.plate, drive_.plate) && even(exit.finger, drive_.finger);
    tangent_ = friction_.level(mode_, now_).rate;
    mode_ = friction_.released(mode_, -exit.side);
    if (!exit.plate) return;
    hold_begin_ = segment.begin;
    note_recurrence(true);
  }

  /// A row of an input: what holds the pin may be asked for more, or the surfaces part.
  void meet_input() {
    const Mode before = mode_;
    if (slides(mode_.finger) && v_ == 0 && !drive_.finger.rigid()) grip();
    if (!before.stuck()) return;
    Mode stuck = mode_;
    if (slides(stuck.plate) && v_ == now_.plate_velocity.value) stuck.plate = Slide::stuck;
    if (slides(stuck.finger) && v_ == 0) stuck.finger = Slide::stuck;
    mode_ = friction_.holding(stuck, mode_, now_, x_, skin_);
    changed_plate_ = before.plate == Slide::stuck && mode_.plate != Slide::stuck;
    changed_finger_ = before.finger == Slide::stuck && mode_.finger != Slide::stuck;
  }

  // ---- how the motion ends -----------------------------------------------------------------------

  /// How a mode without an exit ends.
  End ending(const Flow<T>& flow) {
    if (!flow.position.oscillates())
      return flow.velocity.start == 0 && flow.velocity.straight() ? End::resting : End::moving;
    const T alpha = flow.oscillator.alpha();
    if (alpha < 0) return End::decaying;
    if (alpha > 0) return End::moving;
    outcome_.steady_since = time_;
    outcome_.period = flow.oscillator.period();
    return tangential_ ? End::grazing : End::free;
  }

  /// A state that comes back closes a cycle: looked for at releases from the plate and where the pin
  /// slides faster than a row of the plate's curve.
  void note_recurrence(bool release) {
    if (row_ < never) return;
    const Visit<T> now{time_, x_, v_, skin_, hold_begin_, mode_, release};
    const Visit<T>* before = recurrence_.earlier(drive_, now);
    if (!before) return;
    outcome_.end = release || before->released ? End::stick_slip : End::limit_cycle;
    outcome_.period = time_ - before->time;
    outcome_.cycle_begin = outcome_.steady_since = before->time;
    // The cycle began where the first carried phase joined the one that it repeats.
    if (release && mode_.finger != Slide::gripping)
      outcome_.steady_since = std::max(before->hold_begin, before->time - (time_ - hold_begin_));
  }

  const Drive<T, Surface>& drive_;
  const Inputs<T, Input>& inputs_;
  Friction<T, Surface> friction_;
  Oscillator<T> plain_;      ///< of a pin on which no contact acts but with a constant force,
  T half_period_;            ///< from one zero of its velocity to the next,
  Transition<T> half_turn_;  ///< and how it has moved on there

  T time_{0}, x_, v_;
  T skin_{0};  ///< force in a gripping skin, N
  Mode mode_{};
  Instant<T> now_{};
  T row_{never};  ///< time of the next row of an input, s

  bool changed_plate_{false},
      changed_finger_{false};  ///< by the last event: a zero there is no root
  bool bordering_{false},
      bounced_{false};  ///< came to the border of a region; from another, at once
  struct {
    bool plate{false}, finger{false};
  } let_go_;                ///< at the last event …
  bool held_again_{false};  ///< … and it holds again at once: it was rounding that let go
  bool follows_{false};     ///< it sets out along with a level
  bool tangential_{false};  ///< the pin breaks loose with no relative acceleration, …
  T tangent_{0};            ///< … at this acceleration

  Recurrence<T> recurrence_;
  T hold_begin_{0};
  bool finished_{false};
  Outcome<T> outcome_{};
};

}  // namespace second_opinion
