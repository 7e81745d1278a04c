/// The event loop: mode → closed form or series → earliest event → next mode. No step, no tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/events/recurrence.hpp"
#include "pindrive/events/series_segment.hpp"
#include "pindrive/flow/flow.hpp"
#include "pindrive/law/contact_point.hpp"
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

/// Simulation of one pin from its release. Each segment is passed to the sink, in order of time; a
/// sink may return false to stop.
template <class T>
class Simulation : private Selection<T> {
 public:
  Simulation(const Drive<T>& drive, const Inputs<T>& inputs) : Simulation(drive, inputs, T(0)) {
    plate_.remove_unloaded(inputs.plate_load);
    finger_.remove_unloaded(inputs.finger_load);
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
        if (finger_.start.shortens_skin) segment.event.finger = Transition::slip;
        const bool changes = segment.event.any() || !same_mode(segment.mode, after);
        if (!(breakpoint_ < never) && (changes || turn < event))
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
  using Selected::drive_, Selected::state_, Selected::plate_, Selected::finger_,
      Selected::stick_limit_side_;
  using Selected::held, Selected::no_push, Selected::time_, Selected::force_,
      Selected::applied_force_, Selected::acceleration_, Selected::tangential_;
  using Selected::stop_, Selected::stick_force_, Selected::guards_, Selected::mode,
      Selected::stays_at_limit;
  using typename Selected::ContactPoint;

  /// Release at a time, before the first mode is selected.
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
    stop_.initialize(state_);
    plate_.initialize(state_, false);
    finger_.initialize(state_, given);
  }

  /// Flattened: calls would add a tenth to the time of a standard release; not flattened where size
  /// is optimised.
  PINDRIVE_FLAT void select() {
    breakpoint_ = defer_first_grip(finger_, state_.v, time_, breakpoint_);
    if (!Selected::select()) outcome_.status = Status::inconsistent;
    finger_.apply_jump(state_);
  }

  /// Begins the segment of the selected mode, with its guards.
  void begin(Segment<T>& segment) {
    if (plate_.oblique())
      plate_.across = InputLines<T>::across_from(inputs_, time_, plate_.surface, held());
    const Force<T> plate = plate_.force_law(state_), finger = finger_.force_law(state_);
    segment.begin = time_;
    segment.end = never;
    segment.mode = mode();
    segment.event = {};
    segment.moved = {};
    segment.plate_velocity = plate_.surface;
    segment.eliminated = EliminatedPart::none;
    series_.reset();
    if (!SeriesMode<T>::closed_form(
            drive_, segment.mode,
            {plate_.surface, plate_.load, plate_.across, force_, finger_.load})) {
      if (in_equilibrium()) return stay(segment, plate, finger);
      series_.begin(segment, guards_, drive_, plate_, finger_, force_, state_, acceleration_,
                    stays_at_limit() ? stick_limit_side_ : 0, no_push(),
                    std::min(until_breakpoint(), inputs_.duration - time_));
      return;
    }
    segment.flow = flow(plate, finger);
    segment.plate_force = plate.along(segment.flow);
    segment.finger_force = finger.along(segment.flow);
    if (plate_.stuck() && !stop_.is_holding())
      segment.plate_force = stick_force_;
    else if (finger_.stuck() && !stop_.is_holding())
      segment.finger_force = stick_force_;
    guards_.add(finger_, segment, false);
    guards_.add(plate_, segment, true);
    if (!stop_.is_holding()) stop_.add_guards(guards_, state_, segment.flow);
  }

  /// Speed below which a pin is at rest, m/s. The scale is the largest term of x, as the position
  /// of rest may be 0.
  T rest_speed() const {
    using std::sqrt;
    return T(rest_tolerance) * state_.position_scale * sqrt(drive_.stiffness / drive_.mass);
  }
  /// True if a pin that no contact holds is at rest by the rest criterion (MODEL, section 10), for ever: under
  /// constant inputs forces balance and the speed has decayed.
  bool in_equilibrium() const {
    using std::abs;
    const State<T>& s = state_;
    if (breakpoint_ < never || held() || plate_.surface.rate != 0 || plate_.across.rate != 0)
      return false;
    if (force_.rate != 0 || plate_.load.rate != 0 || finger_.load.rate != 0 ||
        finger_.has_slider_state())
      return false;
    return abs(s.v) <= rest_speed() && drive_.mass * abs(acceleration_) <=
                                           T(rest_tolerance) * drive_.stiffness * s.position_scale;
  }
  /// Begins the segment of a pin in equilibrium.
  void stay(Segment<T>& segment, const Force<T>& plate, const Force<T>& finger) {
    guards_.clear();
    state_.v = T(0);
    segment.eliminated = EliminatedPart::motion;
    segment.flow = Flow<T>::stuck(state_.x, Line<T>{});
    segment.plate_force = plate.along(segment.flow);
    segment.finger_force = finger.along(segment.flow);
  }

  Flow<T> flow(const Force<T>& plate, const Force<T>& finger) const {
    using std::abs;
    const State<T>& s = state_;
    if (stop_.is_holding()) return Flow<T>::stuck(s.x, Line<T>{});
    if (plate_.stuck() || finger_.stuck())
      return Flow<T>::stuck(s.x, plate_.stuck() ? plate_.surface : Line<T>{});
    T damping = drive_.damping + plate.drag + finger.drag;
    T stiffness = drive_.stiffness + plate.stiffness + finger.stiffness;
    T pull = applied_force_ - drive_.stiffness * s.x + plate.constant.value + finger.constant.value;
    T rate = plate.constant.rate + finger.constant.rate;
    rate += force_.rate;
    damping += stop_.damping();
    stiffness += stop_.stiffness();
    pull += stop_.spring_force(s);
    Oscillator<T> oscillator = plain_;
    if (!linear()) {
      // Damping cancelled by falling friction within rounding is zero.
      const T known =
          2 * std::numeric_limits<T>::epsilon() * drive_.damping + plate.rounding + finger.rounding;
      if (abs(damping) <= known) damping -= plain(damping);
      oscillator = Oscillator<T>(drive_.mass, damping, stiffness);
    }
    // A pin with zero speed and balanced forces, within rounding or the rest criterion, is at rest.
    const T balanced = std::max(s.force_error, T(rest_tolerance) * drive_.stiffness * abs(s.x));
    if (abs(pull) <= balanced && s.v == 0 && rate == 0)
      return Flow<T>::free(oscillator, s.x, s.v, T(0), T(0), T(0));
    const T drift = rate / stiffness;
    const T from_rest = tangential_ ? drive_.mass * acceleration_ + damping * (s.v - drift)
                                    : pull - damping * drift;
    return Flow<T>::free(oscillator, s.x, s.v, acceleration_, -from_rest / stiffness, drift);
  }

  bool linear() const {  // no contact adds damping or stiffness
    return !finger_.elastic() && !stop_.is_pushing() && drive_.plate.branches == 0 &&
           drive_.finger.branches == 0;
  }

  /// Time to the next turning point of a pin over a plate that slides across, under constant
  /// inputs; infinite elsewhere. Such a pin may oscillate for ever without an event, and a cycle is
  /// closed at its turning points.
  T turning_point() const {
    return series_.used() && plate_.oblique() && !held() && !(breakpoint_ < never)
               ? series_.turning_point()
               : never;
  }
  /// Time after τ, s, with the rounding of earlier sums.
  T time_after(T tau) const { return time_ + (tau + time_error_); }
  /// Time to the next breakpoint of an input, s.
  T until_breakpoint() const { return breakpoint_ - time_ - time_error_; }

  /// Time to the earliest event. An event within the time resolution of a breakpoint happens at the
  /// breakpoint.
  T earliest(const Flow<T>& flow) {
    const T breakpoint = until_breakpoint();
    if (series_.used()) return series_.earliest(time_, breakpoint);
    const T serves = flow.oscillator.serves_for();
    const T limit = serves < breakpoint && flow.velocity.oscillates() ? serves : breakpoint;
    const T end =
        guards_.first_event(flow.oscillator, time_, limit, limit == breakpoint, state_.force_error);
    return breakpoint < never && breakpoint - end <= rounding<T> * (time_ + breakpoint) ? breakpoint
                                                                                        : end;
  }

  /// Ends a segment and advances the state to the event: each guard at its zero is exactly zero
  /// there.
  void jump(Segment<T>& segment, T tau) {
    using std::abs;
    const T coincident = tau + rounding<T> * (time_ + tau);
    const bool breakpoint = tau == until_breakpoint();
    const T end = breakpoint ? breakpoint_ : time_after(tau);
    time_error_ = breakpoint ? T(0) : tau + time_error_ - (end - time_);
    const T lasts = finger_.is_sensitive_to_time() && end > time_ ? end - time_ : tau;
    series_.move(state_, drive_, finger_, lasts);
    if (!series_.used()) {
      const bool turns = tau == half_period_ && segment.flow.velocity.value == 0 && linear();
      segment.moved = turns ? half_turn_ : segment.flow.after(tau);
      state_.move(segment, finger_.elastic());
    }
    segment.end = time_ = end;
    const T across = plate_.across.at(tau),
            stationary = finger_.sliding() ? finger_.stationary_velocity() : T(0);
    const T loaded = load_before(finger_.load.at(lasts), finger_.load.rate);
    stick_limit_side_ = 0;
    struck_ = false;
    if (breakpoint) come_to_rest();
    bool on_plate = plate_.stuck(), on_finger = finger_.stuck() || stop_.is_holding(),
         known = on_finger;
    T rest{0};  // velocity at the finger or at an end of its branch, if known
    for (const Guard<T>& guard : guards_) {
      if (!(guard.zero <= coincident) || apply_stop_guard(guard, breakpoint)) continue;
      ContactPoint& side = guard.plate ? plate_ : finger_;
      if (guard.bound != ActiveGuard::none) {
        side.reached_guard = guard.bound;
        if (side.oblique()) continue;
        const T speed = guard.bound == ActiveGuard::lower ? side.branch().from : side.branch().to;
        if (side.has_slider_state()) {
          state_.slider_velocity = side.mode.slip_sign * speed;
          continue;
        }
        state_.v = (guard.plate ? side.surface.value : stationary) + side.mode.slip_sign * speed;
        if (guard.bound == ActiveGuard::lower && side.mode.branch == 0)
          (guard.plate ? on_plate : on_finger) = true;
        known = known || !guard.plate;
        if (!guard.plate) rest = state_.v;
      } else if (side.elastic()) {
        state_.skin = guard.side * drive_.finger.static_limit * loaded;
      } else if (!breakpoint) {
        stick_limit_side_ = guard.side;
      }
    }
    if (on_plate && known) plate_.surface.value = rest;
    if (on_finger || on_plate) state_.v = on_finger ? rest : plate_.surface.value;
    if (finger_.sliding() && !drive_.finger.rigid())
      state_.skin = finger_.skin_force(state_, loaded);
    end_oblique_slip(state_, plate_, on_finger, across, drive_.mass, time_);
    if (stop_.snap(state_) || struck_) begin_at_stop();
  }

  /// Applies the rest criterion (MODEL, section 10) where an input changes: a pin that slides so slowly on a
  /// rigid surface at rest is at rest, and its friction may hold it.
  void come_to_rest() {
    using std::abs;
    if (state_.v == 0 || !(abs(state_.v) <= rest_speed())) return;
    for (ContactPoint* side : {&plate_, &finger_}) {
      if (!side->sliding() || side->oblique() || !side->contact.rigid()) continue;
      if (side->surface.value != 0 || side->surface.rate != 0) continue;
      state_.v = T(0);
      side->reached_guard = ActiveGuard::lower;
    }
  }

  /// True if a guard belongs to a stop; the stop is then exactly at the zero of the guard.
  bool apply_stop_guard(const Guard<T>& guard, bool breakpoint) {
    if (guard.bound == ActiveGuard::push) stop_.released = !breakpoint || !stop_.is_holding();
    if (guard.bound != ActiveGuard::edge) return guard.bound == ActiveGuard::push;
    if (stop_.reach_end(state_, guard.side)) struck_ = true;
    return true;
  }
  /// Sets the contacts of a pin that has struck a rigid stop.
  void begin_at_stop() {
    struck_ = true;
    state_.v = T(0);
    for (ContactPoint* side : {&plate_, &finger_}) {
      side->reached_guard = ActiveGuard::none;
      if (side->has_slider_state()) continue;
      side->mode = {};
      side->initialize(state_, side == &finger_);
    }
    stick_limit_side_ = 0;
  }

  /// Reads the inputs from here on. Returns the finger load until now, which continued to `value`
  /// at `rate`, if the load jumps; the present load if the difference is within the time
  /// resolution.
  T load_before(T value, T rate) {
    using std::abs;
    if (inputs_.constant())
      plate_.surface = inputs_.mouse_velocity.from(time_);
    else
      look_ahead();
    const T now = finger_.load.value, known = rounding<T> * (abs(value) + 2 * abs(rate) * time_);
    if (abs(value - now) > known + rounding<T> * abs(now)) return abs(value) > known ? value : T(0);
    if (!series_.has_eliminated_slider()) keep_force(finger_, state_, value);
    return now;
  }
  /// Reads the inputs from here on from their breakpoints: continued from event to event they would
  /// accumulate rounding. Breakpoints within the time resolution are one, the last of them.
  void look_ahead() {
    for (;; time_ = breakpoint_) {
      plate_.surface = inputs_.mouse_velocity.from(time_);
      plate_.load = inputs_.plate_load.from(time_);
      finger_.load = inputs_.finger_load.from(time_);
      force_ = inputs_.force.from(time_);
      plate_.across = InputLines<T>::across_from(inputs_, time_, plate_.surface, held());
      breakpoint_ = inputs_.next_breakpoint(time_);
      if (breakpoint_ - time_ > rounding<T> * time_) return;
    }
  }

  const Inputs<T>& inputs_;
  Oscillator<T> plain_;      ///< oscillator of a pin on which contacts exert constant forces only
  T half_period_;            ///< time between two zeros of its velocity, s
  Propagator<T> half_turn_;  ///< propagator over this time

  T time_error_{0};      ///< rounding error of time_ (Kahan 1965), s
  T breakpoint_{never};  ///< time of the next breakpoint of an input, s
  bool struck_{false};   ///< the pin has just struck a rigid stop
  SeriesSegment<T> series_;

  CycleDetector<T> cycles_{drive_};
  Outcome<T> outcome_{};
};

}  // namespace pindrive::detail

#undef PINDRIVE_FLAT
