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

#include "pindrive/motion.hpp"
#include "pindrive/simulation.hpp"

namespace pindrive {

/// An input that goes on at its rate from the time at which it was set.
template <class T>
struct Held {
  T since{0};                                  ///< s
  Line<T> line{};                              ///< from then on
  T ends{std::numeric_limits<T>::infinity()};  ///< when it has come to zero and stays there, s

  Held() = default;
  explicit Held(T constant) : line{constant, T(0)} {}
  Held(T from, const Line<T>& along, T until = std::numeric_limits<T>::infinity())
      : since(from), line(along), ends(until) {}

  Line<T> from(T t) const {
    if (t >= ends) return {};
    return {line.at(t - since), line.rate};
  }
  T next_row(T t) const { return t < ends ? ends : std::numeric_limits<T>::infinity(); }
  static constexpr bool constant() { return false; }
};

template <class T>
class Stepper {
  using Simulation = detail::Simulation<T, Contact<T>, Held<T>>;
  using Option = typename detail::Touch<T, Contact<T>>::Option;

 public:
  /// All that it goes on with: a stepper made of it gives the same bits.
  struct State {
    T now;                                ///< s
    T since;                              ///< time of the last event, s; there …
    detail::State<T> pin;                 ///< … was the pin, …
    Option plate, finger;                 ///< … this each contact had done, …
    detail::Bound at_plate, at_finger;    ///< … these bounds their speeds had come to, …
    int limit;                            ///< … this side a stick force, …
    Line<T> plate_velocity, plate_load;   ///< … and from there on the inputs went like this
    Held<T> mouse_velocity, load_factor;  ///< the inputs as they were set
    Event event;                          ///< what happened to the contacts now
  };

  /// A release at the time `begin`, s. The duration of its inputs does not matter: it has no end. The drive's
  /// friction curves stay where they are.
  Stepper(const Drive<T>& drive, const Inputs<T, Held<T>>& inputs, T begin = T(0))
      : drive_(drive),
        inputs_(without_end(inputs)),
        simulation_(drive_, inputs_, begin),
        now_(begin) {
    select();
  }
  Stepper(const Drive<T>& drive, const State& state)
      : drive_(drive),
        inputs_(without_end(
            {state.mouse_velocity, state.pin.x, state.pin.v, never, state.load_factor})),
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
    found.mouse_velocity = inputs_.mouse_velocity;
    found.load_factor = inputs_.plate_load;
    found.event = event_;
    return found;
  }

  /// Goes on to the time `until`, not before now, s; or, if asked to, to the first event of a contact until
  /// then. Whether it came there: `status` says otherwise why not.
  bool step(T until, bool stop_at_event = false) {
    int standing = 0;
    while (status() == Status::ok && !(next() > until)) {
      const bool together = !(tau_ > 0);
      if (stop_at_event && !together && happens_after(now_)) break;
      simulation_.jump(segment_, tau_);
      select();
      const Event event{change(simulation_.plate_.before, segment_.mode.plate),
                        change(simulation_.finger_.before, segment_.mode.finger)};
      if (!together || event.plate != Transition::none) event_.plate = event.plate;
      if (!together || event.finger != Transition::none) event_.finger = event.finger;
      standing = together ? standing + 1 : 0;
      if (standing > detail::standstill_limit) standstill_ = true;
    }
    if (status() != Status::ok) return false;
    now_ = stop_at_event && happens_after(now_) ? T(plain(simulation_.time_)) : until;
    if (now_ > simulation_.time_) event_ = {};
    return true;
  }

  /// Sets the inputs from now on, values and rates: mouse velocity (m/s, m/s²) and plate load (>= 0, 1/s). A
  /// mouse velocity that jumps moves the housing in no time: beside it the pin keeps its velocity, as no finite
  /// force could change that. A value that differs from the input as it went on by rounding is the same.
  void set(const Line<T>& mouse_velocity, const Line<T>& plate_load) {
    Held<T>&velocity = inputs_.mouse_velocity, &load = inputs_.plate_load;
    const T jump = change_to(mouse_velocity.value, velocity);
    const T of_load = change_to(plate_load.value, load);
    if (zero(jump) && zero(of_load) && zero(mouse_velocity.rate - velocity.from(now_).rate) &&
        zero(plate_load.rate - load.from(now_).rate))
      return;
    velocity = {now_, {velocity.from(now_).value, mouse_velocity.rate}};
    load =
        load_from(now_, moved(load.from(now_).value, of_load, plate_load.value), plate_load.rate);
    restart();
    const ContactState plate = simulation_.plate_.does.state;
    const ContactState finger = simulation_.finger_.does.state;
    if (!zero(jump)) {
      velocity.line.value = moved(velocity.line.value, jump, mouse_velocity.value);
      shift(jump);
    }
    select();
    event_ = {change(plate, segment_.mode.plate), change(finger, segment_.mode.finger)};
  }

  Status status() const { return standstill_ ? Status::standstill : simulation_.outcome_.status; }
  T now() const { return now_; }  ///< s
  /// The time until which no contact changes if the inputs go on as they do, s; infinite if none ever does.
  T next() const { return simulation_.time_ + tau_; }
  const Event& event() const { return event_; }  ///< what happens to the contacts now
  Mode mode() const { return segment_.mode; }    ///< of the contacts from now on
  const Drive<T>& drive() const { return drive_; }
  Line<T> mouse_velocity() const { return inputs_.mouse_velocity.from(now_); }
  Line<T> plate_load() const { return inputs_.plate_load.from(now_); }

  /// The segment that goes on from now, how long it has lasted, and its inputs from its begin on.
  const Segment<T>& segment() const { return segment_; }
  T tau() const { return std::min(std::max(now_ - segment_.begin, T(0)), tau_); }
  InputLines<T> lines() const {
    return {segment_.plate_velocity, simulation_.plate_.load, {}, simulation_.force_};
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  /// The load falls to zero at most: friction never pushes.
  static Held<T> load_from(T now, T value, T rate) {
    return {now, {value, rate}, rate < 0 ? now - value / rate : never};
  }
  static Inputs<T, Held<T>> without_end(Inputs<T, Held<T>> inputs) {
    inputs.duration = never;
    const Held<T>& load = inputs.plate_load;
    if (!(load.ends < never))
      inputs.plate_load = load_from(load.since, load.line.value, load.line.rate);
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
  static T moved(const T& from, const T& change, const T& given) {
    return plain(change) == 0 ? from + change : given;
  }
  bool happens_after(const T& time) const {
    const bool any = event_.plate != Transition::none || event_.finger != Transition::none;
    return any && simulation_.time_ > time;
  }

  void restore(const State& state) {
    simulation_.time_ = state.since;
    simulation_.state_ = state.pin;
    simulation_.plate_.does = state.plate;
    simulation_.finger_.does = state.finger;
    simulation_.plate_.reached = state.at_plate;
    simulation_.finger_.reached = state.at_finger;
    simulation_.plate_.surface = state.plate_velocity;
    simulation_.plate_.load = state.plate_load;
    simulation_.limit_ = state.limit;
  }

  /// Brings the pin to now, where the inputs have a row: at an event that is now to rounding, to that.
  void restart() {
    using std::abs;
    if (abs(now_ - simulation_.time_) <= detail::rounding<T> * abs(now_)) {
      restore(last_);
      simulation_.time_ = now_;
      simulation_.plate_.surface.rate = inputs_.mouse_velocity.line.rate;
      simulation_.plate_.load = inputs_.plate_load.from(now_);
      simulation_.limit_ = 0;
    } else {
      simulation_.row_ = now_;
      simulation_.jump(segment_, now_ - simulation_.time_);
    }
  }

  /// The mouse velocity jumps: the pin keeps its velocity beside the housing, and so to the plate.
  void shift(const T& jump) {
    using std::abs;
    auto &plate = simulation_.plate_, &finger = simulation_.finger_;
    plate.surface.value = moved(plate.surface.value, jump, inputs_.mouse_velocity.line.value);
    T& v = simulation_.state_.v;
    if (plate.stuck())
      v = plate.surface.value;
    else if (!finger.stuck() || plain(jump) != 0)
      v += jump;
    if (plain(jump) == 0) return;
    finger.reached = detail::Bound::none;
    const T sense = finger.does.sense;
    if (finger.sliding() && sense * v > 0) {
      finger.does =
          Option{finger.does.state, detail::Bound::none, finger.contact.branch_of(abs(v)), sense};
    } else {
      finger.does = {};
      finger.begin(v, true);
    }
  }

  /// Begins the segment that follows.
  void select() {
    const auto &plate = simulation_.plate_, &finger = simulation_.finger_;
    last_ = {now_,
             simulation_.time_,
             simulation_.state_,
             plate.does,
             finger.does,
             plate.reached,
             finger.reached,
             simulation_.limit_,
             plate.surface,
             plate.load,
             {},
             {},
             {}};
    // A quantity that follows a line is looked at for a finite time.
    const bool steady = plate.surface.rate == 0 && plate.load.rate == 0;
    simulation_.row_ = std::min(inputs_.plate_load.next_row(simulation_.time_),
                                steady ? never : simulation_.time_ + far_);
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
  Inputs<T, Held<T>> inputs_;
  Simulation simulation_;
  T now_;       ///< s
  State last_;  ///< at the last event, before the mode was selected
  Segment<T> segment_;
  T tau_;  ///< its duration if the inputs go on, s
  Event event_{};
  bool standstill_{false};
};

}  // namespace pindrive
