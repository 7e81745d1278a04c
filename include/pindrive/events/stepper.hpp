/// A pin followed from one time to the next, under inputs that are set on the way: for coupling it to other
/// simulators.
///
/// Nothing is integrated again at a step: a segment goes on from its event until the next one, or until an
/// input changes, and any time in it is evaluated from its beginning. So the steps leave no trace in the
/// results.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "pindrive/events/simulation.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive {

template <class T>
class Stepper {
  using Simulation = detail::Simulation<T>;
  using Option = typename detail::Touch<T>::Option;

 public:
  /// All that it goes on with: a stepper made of it gives the same bits.
  struct State {
    T now;                              ///< s
    T since;                            ///< time of the last event, s, …
    T since_error;                      ///< … what its rounding leaves out, s; there …
    detail::State<T> pin;               ///< … was the pin, …
    Option plate, finger;               ///< … this each contact had done, …
    detail::Bound at_plate, at_finger;  ///< … these bounds their speeds had come to, …
    int limit;                          ///< … this side a stick force, …
    StopState stop;                     ///< … this the end stops had done, …
    bool stop_released, stop_met;       ///< … their force had come to zero, the pin to them, …
    bool struck;                        ///< … it had struck a rigid one, …
    Mode before;                        ///< … the mode had been this, …
    Line<T> plate_velocity;             ///< … and from there on the plate moved like this
    /// The inputs as they were set.
    Held<T> mouse_velocity, plate_load, across_velocity, force, finger_load;
    Event event;  ///< what happened to the contacts and the stops now
  };

  /// A release at the time `begin`, s. The duration of its inputs does not matter: it has no end. The drive's
  /// friction curves stay where they are.
  Stepper(const Drive<T>& drive, const Inputs<T>& inputs, T begin = T(0))
      : drive_(drive),
        inputs_(without_end(inputs)),
        simulation_(drive_, inputs_, begin),
        now_(begin),
        before_(simulation_.mode()) {
    select();
  }
  Stepper(const Drive<T>& drive, const State& state)
      : drive_(drive),
        inputs_(without_end({state.mouse_velocity, state.pin.x, state.pin.v, never,
                             state.plate_load, std::numeric_limits<T>::quiet_NaN(), state.force,
                             state.across_velocity, state.finger_load})),
        simulation_(drive_, inputs_, state.since),
        now_(state.now) {
    restore(state);
    select();
    event_ = state.event;
  }
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  State state() const {
    State found = last_;
    found.now = now_;
    found.mouse_velocity = inputs_.mouse_velocity.held();
    found.plate_load = inputs_.plate_load.held();
    found.across_velocity = inputs_.across_velocity.held();
    found.force = inputs_.force.held();
    found.finger_load = inputs_.finger_load.held();
    found.event = event_;
    return found;
  }

  /// Advances to the time `until`, not before now, s; or, with `stop_at_event`, to the first event of a contact
  /// until then. `go_on` is called after each event. Returns false if the step was not completed: `status` is
  /// then not ok, or go_on() returned false, and now() is the time of the event reached; the next step continues
  /// from there.
  template <class GoOn = Unattended>
  bool step(T until, bool stop_at_event = false, GoOn go_on = {}) {
    int standing = 0;
    bool stopped = false;
    while (status() == Status::ok && !stopped && !(next() > until)) {
      const bool together = !(tau_ > 0);
      if (stop_at_event && !together && happens_after(now_)) break;
      before_ = segment_.mode;
      simulation_.jump(segment_, tau_);
      select();
      const Event event = event_now();
      if (!together || event.plate != Transition::none) event_.plate = event.plate;
      if (!together || event.finger != Transition::none) event_.finger = event.finger;
      if (!together || event.stop != Transition::none) event_.stop = event.stop;
      standing = together ? standing + 1 : 0;
      if (standing > detail::standstill_limit) standstill_ = true;
      stopped = !go_on();
    }
    if (status() != Status::ok) return false;
    const bool at_event = stopped || (stop_at_event && happens_after(now_));
    now_ = at_event ? T(plain(simulation_.time_)) : until;
    if (now_ > simulation_.time_) event_ = {};
    return !stopped;
  }

  /// Sets the inputs from now on, values and rates; a load that falls comes to zero at most. A mouse velocity
  /// that jumps moves the housing in no time: beside it the pin keeps its velocity, as no finite force could
  /// change that; so it does where the velocity across jumps. A value that differs from the input as it went
  /// on by rounding is the same.
  void set(const InputLines<T>& given) {
    Held<T>&velocity = inputs_.mouse_velocity.held(), &load = inputs_.plate_load.held();
    Held<T>&across = inputs_.across_velocity.held(), &force = inputs_.force.held();
    Held<T>& touch = inputs_.finger_load.held();
    const bool turns = differs(given.plate_velocity, velocity),
               loads = differs(given.plate_load, load);
    const bool drifts = differs(given.across_velocity, across),
               pushes = differs(given.force, force);
    const bool touches = differs(given.finger_load, touch);
    if (!turns && !loads && !drifts && !pushes && !touches) return;
    const T jump = change_to(given.plate_velocity.value, velocity);
    const bool across_jumps = plain(change_to(given.across_velocity.value, across)) != 0;
    if (turns) velocity = {now_, {velocity.from(now_).value, given.plate_velocity.rate}};
    if (loads) load = load_from(now_, given.plate_load.value, given.plate_load.rate);
    if (drifts) across = {now_, given.across_velocity};
    if (pushes) force = {now_, given.force};
    if (touches) touch = load_from(now_, given.finger_load.value, given.finger_load.rate);
    restart();
    if (!zero(jump)) {
      velocity.line.value = moved(velocity.line.value, jump, given.plate_velocity.value);
      shift(jump);
    }
    if (across_jumps) turn();
    select();
    event_ = event_now();
  }

  Status status() const { return standstill_ ? Status::standstill : simulation_.outcome_.status; }
  T now() const { return now_; }  ///< s
  /// The time until which no contact changes if the inputs go on as they do, s; infinite if none ever does.
  T next() const { return simulation_.time_after(tau_); }
  const Event& event() const { return event_; }  ///< what happens to the contacts now
  Mode mode() const { return segment_.mode; }    ///< of the contacts from now on
  const Drive<T>& drive() const { return drive_; }
  InputLines<T> inputs() const {
    return {inputs_.mouse_velocity.from(now_), inputs_.plate_load.from(now_),
            inputs_.across_velocity.from(now_), inputs_.force.from(now_),
            inputs_.finger_load.from(now_)};
  }

  /// The segment that goes on from now, how long it has lasted, and its inputs from its begin on.
  const Segment<T>& segment() const { return segment_; }
  T tau() const { return std::min(std::max(now_ - segment_.begin, T(0)), tau_); }
  /// The pin now; skin that slips is not looked at.
  detail::State<T> pin() const {
    detail::State<T> pin = simulation_.state_;
    if (!(tau() > 0)) return pin;
    simulation_.series_.move(pin, drive_, simulation_.finger_, tau());
    if (simulation_.series_.used()) return pin;
    Segment<T> along = segment_;
    along.moved = along.flow.after(tau());
    pin.move(along, simulation_.finger_.elastic());
    return pin;
  }
  InputLines<T> lines() const {
    return {segment_.plate_velocity, simulation_.plate_.load, simulation_.plate_.across,
            simulation_.force_, simulation_.finger_.load};
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  /// The load falls to zero at most: friction never pushes.
  static Held<T> load_from(T now, T value, T rate) {
    Held<T> load(now, {value, rate});
    if (rate < 0) load.ends = now - value / rate;
    return load;
  }
  static Inputs<T> without_end(Inputs<T> inputs) {
    inputs.duration = never;
    for (Held<T>* load : {&inputs.plate_load.held(), &inputs.finger_load.held()})
      if (!(load->ends < never)) *load = load_from(load->since, load->line.value, load->line.rate);
    return inputs;
  }
  /// Whether a number, and its derivative, is zero.
  static bool zero(const T& x) {
    if constexpr (std::is_floating_point_v<T>)
      return x == 0;
    else
      return x.value == 0 && x.slope == 0;
  }
  /// From what an input would be now to what is given; without what is rounding.
  T change_to(const T& given, const Held<T>& held) const {
    using std::abs;
    const Line<T> line = held.from(now_);
    const T change = given - line.value;
    const T size = abs(held.line.value) + abs(line.rate * (now_ - held.since)) + abs(given);
    return abs(change) <= detail::rounding<T> * size ? change - plain(change) : change;
  }
  bool differs(const Line<T>& given, const Held<T>& held) const {
    return !zero(change_to(given.value, held)) || !zero(given.rate - held.from(now_).rate);
  }
  static T moved(const T& from, const T& change, const T& given) {
    return plain(change) == 0 ? from + change : given;
  }
  bool happens_after(const T& time) const { return event_.any() && simulation_.time_ > time; }

  /// What happens where the segment that goes on begins.
  Event event_now() const {
    const Mode& after = segment_.mode;
    return {change(before_.plate, after.plate), change(before_.finger, after.finger),
            detail::change(before_.stop, after.stop, simulation_.struck_)};
  }

  void restore(const State& state) {
    simulation_.time_ = state.since;
    simulation_.time_error_ = state.since_error;
    simulation_.state_ = state.pin;
    simulation_.plate_.does = state.plate;
    simulation_.finger_.does = state.finger;
    simulation_.plate_.reached = state.at_plate;
    simulation_.finger_.reached = state.at_finger;
    simulation_.plate_.surface = state.plate_velocity;
    simulation_.limit_ = state.limit;
    simulation_.stop_.does = state.stop;
    simulation_.stop_.released = state.stop_released;
    simulation_.stop_.met = state.stop_met;
    simulation_.struck_ = state.struck;
    before_ = state.before;
    take_inputs(state.since);
  }
  /// Those but for the plate's velocity, which may be known to be exactly the pin's.
  void take_inputs(const T& time) {
    simulation_.plate_.load = inputs_.plate_load.from(time);
    simulation_.plate_.across =
        InputLines<T>::across_from(inputs_, time, simulation_.plate_.surface, simulation_.held());
    simulation_.force_ = inputs_.force.from(time);
    simulation_.finger_.load = inputs_.finger_load.from(time);
  }

  /// Brings the pin to now, where the inputs have a row: at an event that is now to rounding, to that.
  void restart() {
    using std::abs;
    if (abs(now_ - simulation_.time_) <= detail::rounding<T> * abs(now_)) {
      restore(last_);
      simulation_.time_ = now_;
      simulation_.time_error_ = T(0);
      simulation_.plate_.surface.rate = inputs_.mouse_velocity.held().line.rate;
      take_inputs(now_);
      simulation_.limit_ = 0;
      if (simulation_.stop_.rigid()) simulation_.stop_.released = false;  // its push may jump
    } else {
      simulation_.row_ = now_;
      before_ = segment_.mode;
      simulation_.jump(segment_, simulation_.until_row());
    }
  }

  /// The mouse velocity jumps: the pin keeps its velocity beside the housing, and so to the plate. Only a
  /// rigid stop takes it along.
  void shift(const T& jump) {
    using std::abs;
    auto &plate = simulation_.plate_, &finger = simulation_.finger_;
    plate.surface.value =
        moved(plate.surface.value, jump, inputs_.mouse_velocity.held().line.value);
    auto& stop = simulation_.stop_;
    T& v = simulation_.state_.v;
    if (plate.stuck() && !stop.holds())
      v = plate.surface.value;
    else if (!(finger.stuck() || stop.holds()) || plain(jump) != 0)
      v += jump;
    if (plain(jump) == 0) return;
    simulation_.struck_ = false;
    if (stop.begin(simulation_.state_)) return simulation_.begin_at_stop();
    finger.reached = detail::Bound::none;
    const T sense = finger.does.sense;
    if (finger.sliding() && finger.contact.may_lag()) return;
    if (finger.sliding() && sense * v > 0) {
      finger.does =
          Option{finger.does.state, detail::Bound::none, finger.contact.branch_of(abs(v)), sense};
    } else {
      finger.does = {};
      finger.begin(simulation_.state_, true);
    }
  }

  /// The velocity across jumps, and with it the speed at which the plate slides.
  void turn() {
    using detail::hypot;
    auto& plate = simulation_.plate_;
    plate.reached = detail::Bound::none;
    if (!plate.oblique()) return;
    const T u = simulation_.state_.v - plate.surface.value;
    plate.does.branch = plate.contact.branch_of(hypot(u, plate.across.value));
  }

  /// Begins the segment that follows.
  void select() {
    const auto &plate = simulation_.plate_, &finger = simulation_.finger_;
    last_ = {now_,
             simulation_.time_,
             simulation_.time_error_,
             simulation_.state_,
             plate.does,
             finger.does,
             plate.reached,
             finger.reached,
             simulation_.limit_,
             simulation_.stop_.does,
             simulation_.stop_.released,
             simulation_.stop_.met,
             simulation_.struck_,
             before_,
             plate.surface,
             {},
             {},
             {},
             {},
             {},
             {}};
    // A quantity that follows a line is looked at for a finite time.
    const bool steady = plate.surface.rate == 0 && plate.load.rate == 0 && finger.load.rate == 0 &&
                        simulation_.force_.rate == 0;
    simulation_.row_ = std::min({inputs_.plate_load.next_row(simulation_.time_),
                                 inputs_.finger_load.next_row(simulation_.time_),
                                 steady ? never : simulation_.time_ + far_});
    simulation_.select();
    simulation_.begin(segment_);
    tau_ = simulation_.earliest(segment_.flow);
    if (simulation_.series_.used()) segment_.end = simulation_.time_ + tau_;
  }

  static T far_for(const Drive<T>& drive) {
    using std::sqrt;
    return T(1e6) * sqrt(drive.mass / drive.stiffness);
  }

  Drive<T> drive_;
  T far_{far_for(drive_)};  ///< s
  Inputs<T> inputs_;
  Simulation simulation_;
  T now_;          ///< s
  Mode before_{};  ///< until the last event
  State last_;     ///< at the last event, before the mode was selected
  Segment<T> segment_;
  T tau_;  ///< its duration if the inputs go on, s
  Event event_{};
  bool standstill_{false};
};

}  // namespace pindrive
