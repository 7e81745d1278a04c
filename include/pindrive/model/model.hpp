/// What goes into the core and what comes out of it. SI units throughout.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "pindrive/flow/flow.hpp"
#include "pindrive/model/limits.hpp"

namespace pindrive {

/// Default band of the settling time, as a part of |x(0) − x_end|.
inline constexpr double settling_band = 0.05;

/// Kinetic friction in one range of sliding speed: force + slope·(|u| − from) for from <= |u| < to.
template <class T>
struct Branch {
  T from, to;  ///< m/s
  T force;     ///< at `from`, N
  T slope;     ///< N s/m; negative where friction falls with speed
  T rounding;  ///< how well the slope is known from rounded rows, N s/m

  T at(T speed) const { return force + slope * (speed - from); }
};

/// The branches between the rows (speed, force) of a friction curve, at most count + 1; none for the
/// one row of Coulomb friction. Rows on one line, to rounding, make one branch, and a slope that is
/// rounding is none. The last slope goes on; where it falls, until the force is zero: friction never pushes.
template <class T>
int branches_of(const T* speeds, const T* forces, int count, Branch<T>* branches) {
  using std::abs;
  if (count < 2) return 0;
  constexpr T never = std::numeric_limits<T>::infinity();
  constexpr T unit = 2 * std::numeric_limits<T>::epsilon();
  int made = 0;
  for (int i = 0; i + 1 < count; ++i) {
    const T width = speeds[i + 1] - speeds[i];
    T slope = (forces[i + 1] - forces[i]) / width;
    const T rounding =
        unit * (forces[i] + forces[i + 1] + abs(slope) * (speeds[i] + speeds[i + 1])) / width;
    if (abs(slope) <= unit * (forces[i] + forces[i + 1]) / width) slope -= plain(slope);
    const bool bends =
        made == 0 || abs(slope - branches[made - 1].slope) > rounding + branches[made - 1].rounding;
    if (bends) branches[made++] = {speeds[i], never, forces[i], slope, rounding};
    branches[made - 1].to = speeds[i + 1];
  }
  const T force = forces[count - 1];
  Branch<T>& last = branches[made - 1];
  if (last.slope < 0) {
    if (force > 0) last.to -= force / last.slope;
    branches[made] = {last.to, never, T(0), T(0), T(0)};
    return made + 1;
  }
  last.to = never;
  return made;
}

/// Dry friction at one surface. Without friction the contact is absent.
template <class T>
struct Contact {
  T kinetic{0};       ///< friction force when it starts to slide, N; >= 0
  T static_limit{0};  ///< largest friction force while it sticks, N; >= kinetic
  T stiffness{std::numeric_limits<T>::infinity()};  ///< tangential, N/m; > 0, infinite if rigid

  /// Kinetic friction over sliding speed; none: `kinetic` at every speed (Coulomb).
  const Branch<T>* curve{nullptr};
  int branches{0};

  bool rigid() const { return !(stiffness < std::numeric_limits<T>::infinity()); }
  /// Whether skin stretches between it and the pin.
  bool compliant() const { return present() && !rigid(); }
  /// Whether the slider may lag behind the pin: that of skin on a friction curve.
  bool may_lag() const { return branches > 0 && !rigid(); }
  Branch<T> branch(int index) const {
    if (branches == 0) return {T(0), std::numeric_limits<T>::infinity(), kinetic, T(0), T(0)};
    return curve[index];
  }
  int branch_of(T speed) const {
    int index = 0;
    while (index + 1 < branches && speed >= curve[index].to) ++index;
    return index;
  }
  /// Kinetic friction at a sliding speed, N.
  T friction_at(T speed) const { return branch(branch_of(speed)).at(speed); }
  bool present() const {
    return static_limit > 0 || branches > 1 || (branches == 1 && curve[0].slope > 0);
  }
};

/// End stops of the pin's travel, which push it and never pull: rigid and plastic, or elastic.
template <class T>
struct Stops {
  T travel{std::numeric_limits<T>::infinity()};     ///< to either side, m; > 0, infinite without
  T stiffness{std::numeric_limits<T>::infinity()};  ///< N/m; > 0, infinite if rigid
  T damping{0};                                     ///< of elastic ones, N s/m; >= 0

  bool present() const { return travel < std::numeric_limits<T>::infinity(); }
  bool rigid() const { return !(stiffness < std::numeric_limits<T>::infinity()); }
  /// A position without what its closed form goes beyond a rigid stop by rounding, as the pin strikes that, m.
  T within(T x) const { return !rigid() ? x : x < -travel ? -travel : travel < x ? travel : x; }
};

template <class T>
struct Drive {
  T mass;                    ///< of the moving body: in a device electromagnet and pin, kg; > 0
  T stiffness;               ///< spring, N/m; > 0
  T damping;                 ///< damper, N s/m; >= 0
  Contact<T> plate, finger;  ///< the plate is rigid
  Stops<T> stops{};
};

/// An input that goes on at its rate from the time at which it was set; at no rate it is a constant.
template <class T>
struct Held {
  T since{0};                                  ///< s
  Line<T> line{};                              ///< from then on
  T ends{std::numeric_limits<T>::infinity()};  ///< when it has come to zero and stays there, s

  Held() = default;
  constexpr Held(T constant) noexcept : line{constant, T(0)} {}  // NOLINT: a number is an input
  Held(T begin, const Line<T>& from_there) noexcept : since(begin), line(from_there) {}

  Line<T> from(T t) const {
    if (t >= ends) return {};
    return {line.at(t - since), line.rate};
  }
  T next_row(T t) const { return t < ends ? ends : std::numeric_limits<T>::infinity(); }
};

/// An input over time: held, or linear between its rows and constant outside. It owns nothing.
template <class T>
class Profile {
 public:
  constexpr Profile(T constant) noexcept : held_(constant) {}  // NOLINT: a number is a profile
  constexpr Profile(const Held<T>& line) noexcept
      : held_(line), constant_(false) {}  // NOLINT: so is it
  Profile(T since, const Line<T>& from_there) noexcept : Profile(Held<T>(since, from_there)) {}
  /// count >= 1 rows, times strictly increasing.
  Profile(const T* times, const T* values, std::size_t count)
      : held_(values[0]), constant_(false), times_(times), values_(values), count_(count) {}

  /// Value and rate from time t on, until the next row.
  Line<T> from(T t) const {
    if (count_ == 0) return held_.from(t);
    const std::size_t i = rows_until(t);
    if (i == 0) return {first(), T(0)};
    if (i == count_) return {values_[count_ - 1], T(0)};
    const T rate = (values_[i] - values_[i - 1]) / (times_[i] - times_[i - 1]);
    const T after = t - times_[i - 1];  // what lies after a row by the rounding of a time is at it
    return {after > detail::rounding<T> * t ? values_[i - 1] + rate * after : values_[i - 1], rate};
  }
  /// The first row after time t; infinite when there is none.
  T next_row(T t) const {
    if (count_ == 0) return held_.next_row(t);
    const std::size_t i = rows_until(t);
    return i == count_ ? std::numeric_limits<T>::infinity() : times_[i];
  }
  bool constant() const { return constant_; }   ///< it is one number, and stays so
  T first() const { return held_.line.value; }  ///< its value until its first row

  /// Of an input without rows, to be set on the way: it is no constant any more.
  Held<T>& held() {
    constant_ = false;
    return held_;
  }
  const Held<T>& held() const { return held_; }

 private:
  std::size_t rows_until(T t) const {
    return static_cast<std::size_t>(std::upper_bound(times_, times_ + count_, t) - times_);
  }

  Held<T> held_;  ///< without rows; before the first, a constant
  bool constant_{true};
  const T* times_{nullptr};
  const T* values_{nullptr};
  std::size_t count_{0};
};

/// The release at t = 0 and what happens after it.
template <class T>
struct Inputs {
  Profile<T> mouse_velocity;  ///< v_p: the plate's velocity in the housing's frame, m/s
  T displacement;             ///< x(0), m
  T velocity;                 ///< x'(0), m/s
  T duration{std::numeric_limits<T>::infinity()};  ///< s; infinite: until the ending is known
  Profile<T> plate_load{T(1)};                     ///< factor on the plate's friction; >= 0
  /// Stretch of a compliant finger, m; NaN: as it slides or, at rest, none.
  T skin_stretch{std::numeric_limits<T>::quiet_NaN()};
  Profile<T> force{T(0)};            ///< on the pin from outside, N
  Profile<T> across_velocity{T(0)};  ///< of the plate across the axis of the pin, m/s; continuous
  Profile<T> finger_load{T(1)};      ///< factor on the finger's friction; >= 0

  /// The first row of any input after time t, s; infinite without one.
  T next_row(T t) const {
    return std::min({mouse_velocity.next_row(t), plate_load.next_row(t), finger_load.next_row(t),
                     force.next_row(t), across_velocity.next_row(t)});
  }
  bool constant() const {
    return mouse_velocity.constant() && plate_load.constant() && force.constant() &&
           across_velocity.constant() && finger_load.constant();
  }
};

/// What a contact does: it slips with one sign of its sliding velocity or the other, sticks, is
/// absent, or sticks elastically: skin that stretches with the pin. A plate that also slides across
/// slips, whatever the pin does.
enum class ContactState : signed char {
  slip_backward = -1,
  stick = 0,
  slip_forward = 1,
  absent = 2,
  elastic_stick = 3,
  slip_oblique = 4
};

inline bool slips(ContactState state) {
  return state == ContactState::slip_backward || state == ContactState::slip_forward ||
         state == ContactState::slip_oblique;
}
inline bool holds(ContactState state) {
  return state == ContactState::stick || state == ContactState::elastic_stick;
}
inline int sign(ContactState state) {
  return state == ContactState::slip_backward ? -1 : state == ContactState::slip_forward ? 1 : 0;
}
inline ContactState opposite(ContactState state) { return static_cast<ContactState>(-sign(state)); }
/// A value in the direction of slipping.
template <class T>
T along(ContactState state, T value) {
  return T(static_cast<int>(state)) * value;
}

/// What the end stops do: the upper or the lower one touches the pin, or it is beyond the end of its travel
/// and on its way back faster than an elastic one follows.
enum class StopState : signed char {
  beyond_lower = -2,
  lower = -1,
  apart = 0,
  upper = 1,
  beyond_upper = 2
};

inline bool touches(StopState state) {
  return state == StopState::lower || state == StopState::upper;
}
/// Of the stop, if any: 1, −1 or 0.
inline int side(StopState state) { return (state > StopState::apart) - (state < StopState::apart); }

struct Mode {
  ContactState plate, finger;
  int plate_branch{0}, finger_branch{0};  ///< of the friction curve, while sliding
  StopState stop{StopState::apart};

  bool stuck() const { return plate == ContactState::stick || finger == ContactState::stick; }
  bool both_stuck() const { return plate == finger && finger == ContactState::stick; }
};

inline bool same_mode(const Mode& one, const Mode& other) {
  return one.plate == other.plate && one.finger == other.finger &&
         one.plate_branch == other.plate_branch && one.finger_branch == other.finger_branch &&
         one.stop == other.stop;
}

/// What happens to a contact where a segment ends: it begins to hold, it breaks loose or lifts, or
/// sliding reverses. Nothing where only an input has its next row or a friction curve its breakpoint.
enum class Transition : signed char { none, stick, slip, cross };

struct Event {
  Transition plate{Transition::none}, finger{Transition::none};
  Transition stop{Transition::none};  ///< stick: it is met, cross: for an instant; slip: it is left

  bool any() const {
    return plate != Transition::none || finger != Transition::none || stop != Transition::none;
  }
};

/// Whether a rigid stop holds the pin.
template <class T>
bool held_by_stop(const Drive<T>& drive, const Mode& mode) {
  return touches(mode.stop) && drive.stops.rigid();
}
/// Whether what holds the pin gives its velocity.
template <class T>
bool held(const Drive<T>& drive, const Mode& mode) {
  return mode.stuck() || held_by_stop(drive, mode);
}

inline Transition change(ContactState before, ContactState after) {
  if (before == after) return Transition::none;
  if (holds(before) == holds(after))
    return sign(before) == -sign(after) ? Transition::cross : Transition::none;
  return holds(after) ? Transition::stick : Transition::slip;
}

/// Whether the sliding velocity came to zero.
inline bool stops(Transition transition) {
  return transition == Transition::stick || transition == Transition::cross;
}

/// The fast part that a series leaves out (creep.hpp, slow_slider.hpp).
/// `motion`: the whole motion of a pin that is in equilibrium by the rest criterion.
enum class FastPart : signed char { none, of_friction, of_slider, motion };

/// One mode from begin to end (infinite for one that lasts for ever), with its friction.
template <class T>
struct Segment {
  T begin, end;  ///< s
  Mode mode;
  Event event;  ///< at the end
  Flow<T> flow;
  Propagator<T> moved;                ///< of its oscillation, from begin to a finite end
  Line<T> plate_velocity;             ///< m/s
  Path<T> plate_force, finger_force;  ///< friction on the pin, N; while both are stuck the plate's
                                      ///< is what they carry together
  FastPart without{FastPart::none};   ///< which its series leaves out

  /// How its oscillation has moved on after τ.
  Propagator<T> after(T tau) const { return tau == end - begin ? moved : flow.after(tau); }
};

/// How a motion ends.
enum class End : signed char {
  moving,       ///< not known within the duration
  resting,      ///< at rest for ever
  decaying,     ///< free decay, no further event
  free,         ///< undamped oscillation, no further event
  grazing,      ///< the same, touching the plate's velocity once a period
  stick_slip,   ///< a cycle of carried and sliding phases, repeated
  limit_cycle,  ///< a cycle that is sustained by falling friction, without a carried phase
  irregular     ///< chaotic or quasi-periodic: no return within `irregular_windows` (limits.hpp)
};

enum class Status : signed char { ok, too_many_events, standstill, stopped, inconsistent };

template <class T>
struct Outcome {
  Status status{Status::ok};
  End end{End::moving};
  T period{std::numeric_limits<T>::quiet_NaN()};  ///< of a steady oscillation, s
  T until{0};  ///< end of the last segment, s; then a cycle begins again …
  T cycle_begin{
      0};  ///< … from here, s; of an irregular motion, begin of the stretch that is measured

  /// True if the state is known at all times, not only as far as it was simulated.
  bool known() const { return end != End::moving && end != End::irregular; }
  bool steady() const { return cycles() || end == End::free || end == End::grazing; }
  bool cycles() const { return end == End::stick_slip || end == End::limit_cycle; }
};

/// Asked all along a long computation whether to go on, which this one always does. Where another one
/// returns false, the computation ends early and what it returns means nothing.
struct Unattended {
  constexpr bool operator()() const { return true; }
};

/// Calls a function that may return false when it wants no more calls; whether to go on.
template <class Function, class... Arguments>
bool goes_on(Function& function, const Arguments&... arguments) {
  if constexpr (std::is_void_v<std::invoke_result_t<Function&, const Arguments&...>>) {
    function(arguments...);
    return true;
  } else {
    return function(arguments...);
  }
}

}  // namespace pindrive
