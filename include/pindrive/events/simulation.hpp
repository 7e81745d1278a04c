/// The event loop: mode → closed form or series → earliest event → next mode. No step, no tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/events/recurrence.hpp"
#include "pindrive/events/series_segment.hpp"
#include "pindrive/flow/flow.hpp"
#include "pindrive/law/friction.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/law/oblique.hpp"
#include "pindrive/law/selection.hpp"
#include "pindrive/model/limits.hpp"
#include "pindrive/model/model.hpp"

#ifdef __OPTIMIZE_SIZE__
#define PINDRIVE_FLAT
#else
#define PINDRIVE_FLAT [[gnu::flatten]]
#endif

namespace pindrive {
template <class T>
class Stepper;
}

namespace pindrive::detail {

/// Follows one pin from its release and hands each segment to the sink, in order of time; a sink may
/// return false to stop.
template <class T>
class Simulation : private Selection<T> {
 public:
  Simulation(const Drive<T>& drive, const Inputs<T>& inputs) : Simulation(drive, inputs, T(0)) {
    plate_.take_off(inputs.plate_load);
    finger_.take_off(inputs.finger_load);
    select();
  }

  template <class Sink>
  Outcome<T> run(Sink&& sink) {
    int standing = 0;
    Segment<T> segment;
    for (long long events = 1;; ++events) {
      begin(segment);
      const T event = earliest(segment.flow), turn = turning_point();
      const T tau = std::min(event, turn);
      const bool finished = !(time_after(tau) < inputs_.duration);
      if (!finished) {
        jump(segment, tau);
        if (turn < event) state_.v = T(0);
        select();
        const Mode after = mode();
        segment.event = {change(segment.mode.plate, after.plate),
                         change(segment.mode.finger, after.finger)};
        segment.event.stop = change(segment.mode.stop, after.stop, struck_);
        if (finger_.drops()) segment.event.finger = Transition::slip;
        const bool changes = segment.event.any() || !same_mode(segment.mode, after);
        if (!(row_ < never) && (changes || turn < event))
          cycles_.visit(segment, after, time_, time_error_, state_, outcome_);
      } else if (tau == never) {
        end_with(segment, outcome_);
      }
      if (finished && !outcome_.known() && inputs_.duration < never) {
        segment.end = inputs_.duration;
        segment.moved = segment.flow.after(segment.end - segment.begin);
      }
      outcome_.until = segment.end;
      standing = segment.end > segment.begin ? 0 : standing + 1;
      if (!goes_on(sink, segment))
        outcome_.status = Status::stopped;
      else if (finished || outcome_.cycles() ||
               (outcome_.end == End::irregular && !(inputs_.duration < never)))
        return outcome_;
      else if (events == event_limit)
        outcome_.status = Status::too_many_events;
      else if (standing > standstill_limit)
        outcome_.status = Status::standstill;
      if (outcome_.status != Status::ok) return outcome_;
    }
  }

 private:
  friend class pindrive::Stepper<T>;
  static constexpr T never = std::numeric_limits<T>::infinity();
  using Selected = Selection<T>;
  using Selected::drive_, Selected::state_, Selected::plate_, Selected::finger_, Selected::limit_;
  using Selected::held, Selected::no_push, Selected::time_, Selected::force_, Selected::inertia_,
      Selected::acceleration_, Selected::tangential_;
  using Selected::stop_, Selected::stick_force_, Selected::guards_, Selected::mode,
      Selected::continues;
  using typename Selected::Side;

  /// A release at a time, of which the first mode is still to be selected.
  Simulation(const Drive<T>& drive, const Inputs<T>& inputs, T begin)
      : Selected(drive, begin, inputs.displacement, inputs.velocity),
        inputs_(inputs),
        plain_(drive.mass, drive.damping, drive.stiffness),
        half_period_(plain_.zeros(T(0), T(1)).first),
        half_turn_(plain_.oscillates() ? plain_.half_turn() : Propagator<T>{}) {
    using std::isnan;
    look_ahead();
    const bool given = !isnan(inputs.skin_stretch);
    if (given) state_.skin = drive.finger.stiffness * inputs.skin_stretch;
    stop_.begin(state_);
    plate_.begin(state_, false);
    finger_.begin(state_, given);
  }

  /// Flat, as calls would cost a plain release a tenth of its time; but not where size was asked for.
  PINDRIVE_FLAT void select() {
    row_ = finger_.keeps_off_zero(state_, time_, row_);
    if (!Selected::select()) outcome_.status = Status::inconsistent;
    finger_.land(state_);
  }

  /// The segment of the mode that was selected, and its guards.
  void begin(Segment<T>& segment) {
    if (plate_.oblique())
      plate_.across = InputLines<T>::across_from(inputs_, time_, plate_.surface, held());
    const Force<T> plate = plate_.law(state_), finger = finger_.law(state_);
    segment.begin = time_;
    segment.end = never;
    segment.mode = mode();
    segment.event = {};
    segment.moved = {};
    segment.plate_velocity = plate_.surface;
    segment.without = FastPart::none;
    series_.reset();
    if (!SeriesMode<T>::closed_form(
            drive_, segment.mode,
            {plate_.surface, plate_.load, plate_.across, force_, finger_.load})) {
      if (in_equilibrium()) return stay(segment, plate, finger);
      series_.begin(segment, guards_, drive_, plate_, finger_, force_, state_, acceleration_,
                    continues() ? limit_ : 0, no_push(),
                    std::min(until_row(), inputs_.duration - time_));
      return;
    }
    segment.flow = flow(plate, finger);
    segment.plate_force = plate.along(segment.flow);
    segment.finger_force = finger.along(segment.flow);
    if (plate_.stuck() && !stop_.holds())
      segment.plate_force = stick_force_;
    else if (finger_.stuck() && !stop_.holds())
      segment.finger_force = stick_force_;
    guards_.add(finger_, segment, false);
    guards_.add(plate_, segment, true);
    if (!stop_.holds()) stop_.add_guards(guards_, state_, segment.flow);
  }

  /// Speed below which a pin is at rest, m/s. The place of rest may be 0: the scale is the largest term of x.
  T rest_speed() const {
    using std::sqrt;
    return T(rest_tolerance) * state_.x_size * sqrt(drive_.stiffness / drive_.mass);
  }
  /// True if a pin that no contact holds is at rest by the rest criterion (MODEL, section 10), for ever: under
  /// constant inputs forces balance and the speed has decayed.
  bool in_equilibrium() const {
    using std::abs;
    const State<T>& s = state_;
    if (row_ < never || held() || plate_.surface.rate != 0 || plate_.across.rate != 0) return false;
    if (force_.rate != 0 || plate_.load.rate != 0 || finger_.load.rate != 0 || finger_.lags())
      return false;
    return abs(s.v) <= rest_speed() &&
           drive_.mass * abs(acceleration_) <= T(rest_tolerance) * drive_.stiffness * s.x_size;
  }
  /// The segment of a pin in equilibrium.
  void stay(Segment<T>& segment, const Force<T>& plate, const Force<T>& finger) {
    guards_.clear();
    state_.v = T(0);
    segment.without = FastPart::motion;
    segment.flow = Flow<T>::stuck(state_.x, Line<T>{});
    segment.plate_force = plate.along(segment.flow);
    segment.finger_force = finger.along(segment.flow);
  }

  Flow<T> flow(const Force<T>& plate, const Force<T>& finger) const {
    using std::abs;
    const State<T>& s = state_;
    if (stop_.holds()) return Flow<T>::stuck(s.x, Line<T>{});
    if (plate_.stuck() || finger_.stuck())
      return Flow<T>::stuck(s.x, plate_.stuck() ? plate_.surface : Line<T>{});
    T damping = drive_.damping + plate.drag + finger.drag;
    T stiffness = drive_.stiffness + plate.stiffness + finger.stiffness;
    T pull = inertia_ - drive_.stiffness * s.x + plate.constant.value + finger.constant.value;
    T rate = plate.constant.rate + finger.constant.rate;
    rate += force_.rate;
    damping += stop_.damping();
    stiffness += stop_.stiffness();
    pull += stop_.spring_force(s);
    Oscillator<T> oscillator = plain_;
    if (!linear()) {
      // A damper that falling friction cancels to rounding neither damps nor drives.
      const T known =
          2 * std::numeric_limits<T>::epsilon() * drive_.damping + plate.rounding + finger.rounding;
      if (abs(damping) <= known) damping -= plain(damping);
      oscillator = Oscillator<T>(drive_.mass, damping, stiffness);
    }
    // A pin without speed on which forces act that cancel, to rounding or to the rest criterion, is at rest.
    const T balanced = std::max(s.roundoff, T(rest_tolerance) * drive_.stiffness * abs(s.x));
    if (abs(pull) <= balanced && s.v == 0 && rate == 0)
      return Flow<T>::free(oscillator, s.x, s.v, T(0), T(0), T(0));
    const T drift = rate / stiffness;
    const T from_rest = tangential_ ? drive_.mass * acceleration_ + damping * (s.v - drift)
                                    : pull - damping * drift;
    return Flow<T>::free(oscillator, s.x, s.v, acceleration_, -from_rest / stiffness, drift);
  }

  bool linear() const {  // no contact damps or stiffens
    return !finger_.elastic() && !stop_.pushes() && drive_.plate.branches == 0 &&
           drive_.finger.branches == 0;
  }

  /// The time to the next turning point of a pin over a plate that slides across, under constant inputs: it may
  /// oscillate for ever without an event, and a cycle is closed there. Infinite elsewhere.
  T turning_point() const {
    return series_.used() && plate_.oblique() && !held() && !(row_ < never)
               ? series_.turning_point()
               : never;
  }
  /// Time after τ, s: the rounding of earlier sums is taken into account.
  T time_after(T tau) const { return time_ + (tau + time_error_); }
  /// The time to the next row of an input, s.
  T until_row() const { return row_ - time_ - time_error_; }

  /// The time to the earliest event. What happens at the row of an input to rounding happens there.
  T earliest(const Flow<T>& flow) {
    const T row = until_row();
    if (series_.used()) return series_.earliest(time_, row);
    const T serves = flow.oscillator.serves_for();
    const T limit = serves < row && flow.velocity.oscillates() ? serves : row;
    const T end = guards_.first_event(flow.oscillator, time_, limit, limit == row, state_.roundoff);
    return row < never && row - end <= rounding<T> * (time_ + row) ? row : end;
  }

  /// Ends a segment and brings the state to the event: what has come to zero is exactly there.
  void jump(Segment<T>& segment, T tau) {
    using std::abs;
    const T coincident = tau + rounding<T> * (time_ + tau);
    const bool row = tau == until_row();
    const T end = row ? row_ : time_after(tau);
    time_error_ = row ? T(0) : tau + time_error_ - (end - time_);
    const T lasts = finger_.rounds_time() && end > time_ ? end - time_ : tau;
    series_.move(state_, drive_, finger_, lasts);
    if (!series_.used()) {
      const bool turns = tau == half_period_ && segment.flow.velocity.value == 0 && linear();
      segment.moved = turns ? half_turn_ : segment.flow.after(tau);
      state_.move(segment, finger_.elastic());
    }
    segment.end = time_ = end;
    const T across = plate_.across.at(tau), level = finger_.sliding() ? finger_.level() : T(0);
    const T loaded = load_before(finger_.load.at(lasts), finger_.load.rate);
    limit_ = 0;
    struck_ = false;
    if (row) come_to_rest();
    bool on_plate = plate_.stuck(), on_finger = finger_.stuck() || stop_.holds(), known = on_finger;
    T rest{0};  // velocity of what is on the finger, or at an end of a branch there, if known
    for (const Guard<T>& guard : guards_) {
      if (!(guard.zero <= coincident) || meets_stop(guard, row)) continue;
      Side& side = guard.plate ? plate_ : finger_;
      if (guard.bound != Bound::none) {
        side.reached = guard.bound;
        if (side.oblique()) continue;
        const T speed = guard.bound == Bound::lower ? side.branch().from : side.branch().to;
        if (side.lags()) {
          state_.slide = side.does.sense * speed;
          continue;
        }
        state_.v = (guard.plate ? side.surface.value : level) + side.does.sense * speed;
        if (guard.bound == Bound::lower && side.does.branch == 0)
          (guard.plate ? on_plate : on_finger) = true;
        known = known || !guard.plate;
        if (!guard.plate) rest = state_.v;
      } else if (side.elastic()) {
        state_.skin = guard.side * drive_.finger.static_limit * loaded;
      } else if (!row) {
        limit_ = guard.side;
      }
    }
    if (on_plate && known) plate_.surface.value = rest;
    if (on_finger || on_plate) state_.v = on_finger ? rest : plate_.surface.value;
    if (finger_.sliding() && !drive_.finger.rigid())
      state_.skin = finger_.skin_force(state_, loaded);
    land_along_axis(state_, plate_, on_finger, across, drive_.mass, time_);
    if (stop_.settles(state_) || struck_) begin_at_stop();
  }

  /// Applies the rest criterion (MODEL, section 10) where an input changes: a pin that slides so slowly on a
  /// rigid surface at rest is at rest, and its friction may hold it.
  void come_to_rest() {
    using std::abs;
    if (state_.v == 0 || !(abs(state_.v) <= rest_speed())) return;
    for (Side* side : {&plate_, &finger_}) {
      if (!side->sliding() || side->oblique() || !side->contact.rigid()) continue;
      if (side->surface.value != 0 || side->surface.rate != 0) continue;
      state_.v = T(0);
      side->reached = Bound::lower;
    }
  }

  /// Whether a guard was one of the stops, which is then exactly where it has come to.
  bool meets_stop(const Guard<T>& guard, bool row) {
    if (guard.bound == Bound::push) stop_.released = !row || !stop_.holds();
    if (guard.bound != Bound::edge) return guard.bound == Bound::push;
    if (stop_.meet(state_, guard.side)) struck_ = true;
    return true;
  }
  /// The contacts of a pin that has struck a rigid stop.
  void begin_at_stop() {
    struck_ = true;
    state_.v = T(0);
    for (Side* side : {&plate_, &finger_}) {
      side->reached = Bound::none;
      if (side->lags()) continue;
      side->does = {};
      side->begin(state_, side == &finger_);
    }
    limit_ = 0;
  }

  /// Takes the inputs from here on; the finger's load until now, where it was this by its rate, to the rounding
  /// of the time: it jumps, perhaps from zero, or it is the same.
  T load_before(T value, T rate) {
    using std::abs;
    if (inputs_.constant())
      plate_.surface = inputs_.mouse_velocity.from(time_);
    else
      look_ahead();
    const T now = finger_.load.value, known = rounding<T> * (abs(value) + 2 * abs(rate) * time_);
    if (abs(value - now) > known + rounding<T> * abs(now)) return abs(value) > known ? value : T(0);
    if (!series_.follows()) finger_.keeps_force(state_, value);
    return now;
  }
  /// Takes the inputs from here on, from their rows: carried on from event to event they would gather rounding.
  /// Rows that differ by the rounding of a time are one: the last of them.
  void look_ahead() {
    for (;; time_ = row_) {
      plate_.surface = inputs_.mouse_velocity.from(time_);
      plate_.load = inputs_.plate_load.from(time_);
      finger_.load = inputs_.finger_load.from(time_);
      force_ = inputs_.force.from(time_);
      plate_.across = InputLines<T>::across_from(inputs_, time_, plate_.surface, held());
      row_ = inputs_.next_row(time_);
      if (row_ - time_ > rounding<T> * time_) return;
    }
  }

  const Inputs<T>& inputs_;
  Oscillator<T> plain_;      ///< of a pin on which no contact acts but with a constant force,
  T half_period_;            ///< from one zero of its velocity to the next,
  Propagator<T> half_turn_;  ///< and how it has moved on there

  T time_error_{0};     ///< what the rounding of time_ leaves out of it (Kahan 1965), s
  T row_{never};        ///< time of the next row of an input, s
  bool struck_{false};  ///< a rigid stop, just now
  SeriesSegment<T> series_;

  CycleDetector<T> cycles_{drive_};
  Outcome<T> outcome_{};
};

}  // namespace pindrive::detail

#undef PINDRIVE_FLAT
