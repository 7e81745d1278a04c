/// Input and output of the core: drive, release, inputs, modes, segments and outcome. SI units.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "pindrive/flow/flow.hpp"
#include "pindrive/model/input_function.hpp"
#include "pindrive/numbers/callback.hpp"
#include "pindrive/numbers/inlining.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

/// Default band of the settling time, as a fraction of |x(0) − x_end|.
inline constexpr double settling_band = 0.05;

/// Shape of friction that falls with the sliding speed: with s = |u|/velocity, e^(−s), e^(−s²) or
/// 1/(1 + s²).
enum class FallingShape : signed char { none, exponential, gaussian, rational };

/// Part of kinetic friction that falls from its excess at rest to zero (MODEL, section 11).
template <class T>
struct FallingFriction {
  FallingShape shape{FallingShape::none};
  T excess{0};    ///< at rest, N; >= 0
  T velocity{1};  ///< Stribeck velocity, m/s; > 0

  bool present() const { return shape != FallingShape::none; }
  T at(T speed) const { return present() ? excess * fraction(speed / velocity) : T(0); }
  /// First derivative by the speed, N s/m.
  T slope(T speed) const {
    const T s = speed / velocity, g = fraction(s);
    if (shape == FallingShape::exponential) return -excess * g / velocity;
    return -2 * s * g * (shape == FallingShape::gaussian ? T(1) : g) * excess / velocity;
  }
  /// Second derivative by the speed, N s²/m².
  T curvature(T speed) const {
    const T s = speed / velocity, g = fraction(s);
    const T bend = shape == FallingShape::exponential ? g
                   : shape == FallingShape::gaussian  ? (4 * s * s - 2) * g
                                                      : (8 * s * s * g - 2) * g * g;
    return bend * excess / (velocity * velocity);
  }

 private:
  T fraction(T s) const {
    using detail::exp;
    if (shape == FallingShape::exponential) return exp(-s);
    return shape == FallingShape::gaussian ? exp(-s * s) : 1 / (1 + s * s);
  }
};

/// Kinetic friction in one range of sliding speed: force + slope·(|u| − from) for from <= |u| < to. A
/// law with a part that falls has one branch, from zero speed on.
template <class T>
struct Branch {
  T from, to;  ///< m/s
  T force;     ///< at `from`, N
  T slope;     ///< N s/m; negative where friction falls with speed
  T rounding;  ///< error of the slope from rounded points, N s/m
  FallingFriction<T> falling{};

  bool linear() const { return !falling.present(); }
  T at(T speed) const {
    const T straight = force + slope * (speed - from);
    return linear() ? straight : straight - (falling.excess - falling.at(speed));
  }
  /// Linear part extrapolated to zero speed, N.
  T intercept() const {
    const T straight = force - slope * from;
    return linear() ? straight : straight - falling.excess;
  }
  /// Linear branch of the same friction and slope at a speed.
  Branch tangent(T speed) const {
    if (linear()) return *this;
    return {speed, to, at(speed), slope + falling.slope(speed), rounding};
  }
};

/// Computes the branches between the points (speed, force) of a friction curve, at most count + 1;
/// none for the single point of Coulomb friction.
///
/// Points on one line, within rounding, make one branch, and a slope within rounding of zero is
/// zero. The last slope continues; a falling one only until the force is zero, as friction never
/// pushes.
template <class T>
int branches_of(const T* speeds, const T* forces, int count, Branch<T>* branches) {
  using std::abs;
  if (count < 2) return 0;
  constexpr T never = std::numeric_limits<T>::infinity();
  constexpr T half = detail::rounding<T> / 2;  // a force is rounded once
  int made = 0;
  for (int i = 0; i + 1 < count; ++i) {
    const T width = speeds[i + 1] - speeds[i];
    T slope = (forces[i + 1] - forces[i]) / width;
    const T rounding =
        half * (forces[i] + forces[i + 1] + abs(slope) * (speeds[i] + speeds[i + 1])) / width;
    if (abs(slope) <= half * (forces[i] + forces[i + 1]) / width) slope -= plain(slope);
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

/// Adds a viscous part (N s/m) to the branches of a curve.
template <class T>
void add_viscous(Branch<T>* branches, int count, T viscous) {
  for (int i = 0; i < count; ++i) {
    branches[i].force += viscous * branches[i].from;
    branches[i].slope += viscous;
  }
}

/// Dry friction at one surface. A contact without friction is absent.
template <class T>
struct Contact {
  T kinetic{0};       ///< friction force at the smallest sliding speed, N; >= 0
  T static_limit{0};  ///< largest friction force in stick, N; >= kinetic
  T stiffness{std::numeric_limits<T>::infinity()};  ///< tangential, N/m; > 0, infinite if rigid

  /// Branches of kinetic friction over sliding speed; null: `kinetic` at every speed (Coulomb).
  const Branch<T>* curve{nullptr};
  int branches{0};
  T damping{0};  ///< of the skin, parallel to its stiffness, N s/m; >= 0

  /// True if friction is linear on each branch.
  bool linear() const { return branches == 0 || curve[0].linear(); }
  bool rigid() const { return !(stiffness < std::numeric_limits<T>::infinity()); }
  /// True if skin stretches between surface and pin.
  bool compliant() const { return present() && !rigid(); }
  /// True if skin stretches against a damper (a Kelvin-Voigt element).
  bool damped() const { return damping != 0 && !rigid(); }
  /// True if the slider may have a velocity of its own: skin with damping or a friction curve.
  bool may_lag() const { return (branches > 0 || damping != 0) && !rigid(); }
  PINDRIVE_INLINE Branch<T> branch(int index) const {
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

/// End stops of the travel, which push the pin and never pull it: rigid and plastic, or elastic.
template <class T>
struct Stops {
  T travel{std::numeric_limits<T>::infinity()};     ///< to either side, m; > 0, infinite without
  T stiffness{std::numeric_limits<T>::infinity()};  ///< N/m; > 0, infinite if rigid
  T damping{0};  ///< damping coefficient of elastic stops, N s/m; >= 0

  bool present() const { return travel < std::numeric_limits<T>::infinity(); }
  bool rigid() const { return !(stiffness < std::numeric_limits<T>::infinity()); }
  /// Position limited to the travel of a rigid stop: removes the rounding of a closed form at the
  /// impact, m.
  T within(T x) const { return !rigid() ? x : x < -travel ? -travel : travel < x ? travel : x; }
};

template <class T>
struct Drive {
  T mass;       ///< mass of the moving body (in a device: electromagnet and pin), kg; > 0
  T stiffness;  ///< spring, N/m; > 0
  T damping;    ///< damper, N s/m; >= 0
  Contact<T> plate, finger;  ///< the plate is rigid
  Stops<T> stops{};
};

/// Input that is linear from the time at which it was set, constant at zero rate, or a piece of a function.
template <class T>
struct Held {
  T since{0};      ///< s
  Line<T> line{};  ///< value and rate from `since` on
  T ends{std::numeric_limits<
      T>::infinity()};                  ///< time at which the input reaches zero and stays there, s
  const InputPiece<T>* piece{nullptr};  ///< in place of the line: begins at `since`

  Held() = default;
  constexpr Held(T constant) noexcept : line{constant, T(0)} {}  // NOLINT: a number is an input
  Held(T begin, const Line<T>& from_there) noexcept : since(begin), line(from_there) {}
  /// The piece must outlive the input.
  explicit Held(const InputPiece<T>& of) : since(of.begin), line{of.at(T(0)), T(0)}, piece(&of) {}

  Curve<T> from(T t) const {
    if (piece != nullptr) return Curve<T>::part(*piece, t - since, t >= decayed());
    if (t >= ends) return {};
    return {line.at(t - since), line.rate};
  }
  T next_breakpoint(T t) const {
    const T next = piece != nullptr ? decayed() : ends;
    return t < next ? next : std::numeric_limits<T>::infinity();
  }
  /// Time from which the terms of its piece have decayed, s.
  T decayed() const { return since + piece->decayed(); }
};

/// Line from a time on, s.
template <class T>
struct LineSince {
  T since{0};
  Line<T> line{};
};

/// Line >= 0 that is raised to a power; a chord close to zero.
///
/// The rate of a power has no bound where the line is zero. Below `least` of the usual load the power is its chord from
/// zero, which changes the impulse of the friction by less than 1e-11 of that at the usual load.
template <class T>
struct RaisedLine {
  static constexpr double least{1e-10};

  LineSince<T> of;
  T power;

  /// From a time on at which the value of the line is known.
  Curve<T> at(T t, const T& value) const {
    const T& rate = of.line.rate;
    const bool below = rate == 0 ? value < least : (t < passes_least()) == (rate > 0);
    if (!below) return Curve<T>(std::max(value, T(least)), rate).to_the(power);
    const T chord = Curve<T>(T(least), T(0)).to_the(power).value / least;
    return {chord * std::max(value, T(0)), chord * rate};
  }
  /// Time at which the chord begins or ends, s; infinite if never after t.
  T next_breakpoint(T t) const {
    constexpr T never = std::numeric_limits<T>::infinity();
    if (of.line.rate == 0) return never;
    const T time = passes_least();
    return t < time ? time : never;
  }

 private:
  T passes_least() const { return of.since + (least - of.line.value) / of.line.rate; }
};

/// Input over time: held, or linear between its breakpoints and constant outside, or a function of pieces; may be
/// raised to a power if it is not a function. Owns no memory.
template <class T>
class Profile {
 public:
  constexpr Profile(T constant) noexcept : held_(constant) {}  // NOLINT: a number is a profile
  constexpr Profile(const Held<T>& line) noexcept
      : held_(line), constant_(false) {}  // NOLINT: so is it
  Profile(T since, const Line<T>& from_there) noexcept : Profile(Held<T>(since, from_there)) {}
  /// Piecewise linear input with count >= 1 breakpoints, times strictly increasing.
  Profile(const T* times, const T* values, std::size_t count)
      : held_(values[0]), constant_(false), times_(times), values_(values), count_(count) {}

  /// Input of count >= 1 pieces, begins strictly increasing; before the first begin, its value there.
  Profile(const InputPiece<T>* pieces, std::size_t count)
      : held_(pieces[0].at(T(0))), constant_(false), pieces_(pieces), count_(count) {}

  /// Input from time t on, until the next breakpoint.
  PINDRIVE_INLINE Curve<T> from(T t) const { return raised() ? raised_from(t) : given_from(t); }
  /// The same before it is raised to a power.
  PINDRIVE_INLINE Curve<T> given_from(T t) const {
    if (count_ == 0) return held_.from(t);
    const std::size_t i = breakpoints_until(t);
    if (pieces_ != nullptr) return part_of_function(i, t);
    if (i == 0) return {held_.line.value, T(0)};
    if (i == count_) return {values_[count_ - 1], T(0)};
    const Line<T> line = between(i);
    // rounding: tests/hard/breakpoints-separated-by-rounding-with-skin-at-stick-limit.txt
    const T after = t - times_[i - 1];
    return {after > detail::rounding<T> * t ? line.at(after) : line.value, line.rate};
  }
  /// The line at time t of an input that is not a function, before it is raised to a power.
  [[gnu::noinline]] LineSince<T> given_line(T t) const {
    if (count_ == 0) return t < held_.ends ? LineSince<T>{held_.since, held_.line} : LineSince<T>{};
    const std::size_t i = breakpoints_until(t);
    if (i == 0) return {times_[0], {values_[0], T(0)}};
    return {times_[i - 1], i == count_ ? Line<T>{values_[i - 1], T(0)} : between(i)};
  }
  /// True if the line at a time is not that at an earlier one, beyond rounding.
  bool turns(T before, T t) const {
    using std::abs;
    const LineSince<T> was = given_line(before), is = given_line(t);
    const T value = was.line.at(is.since - was.since);
    return is.line.rate != was.line.rate || is.line.value != value;
  }
  /// First breakpoint after time t, s; infinite without one.
  T next_breakpoint(T t) const { return raised() ? next_of_raised(t) : next_given(t); }
  bool constant() const { return constant_; }  ///< the input is one number and remains so
  /// True if it is linear between breakpoints.
  bool straight() const { return pieces_ == nullptr && (constant_ || !raised()); }
  /// True if the input is made of rows or pieces, and so changes by itself.
  bool has_breakpoints() const { return count_ > 0; }
  /// Value before the first breakpoint.
  T first() const {
    return raised() ? RaisedLine<T>{{}, power_}.at(T(0), given_first()).value : given_first();
  }
  /// The same before it is raised to a power.
  T given_first() const { return held_.line.value; }

  /// The input raised to a power > 0, unless it is a function.
  Profile to_the(const T& power) const {
    Profile found = *this;
    if (pieces_ == nullptr) found.power_ = power;
    return found;
  }
  const T& power() const { return power_; }

  /// Line of an input without breakpoints, to be set during the simulation; the input is not
  /// constant any more.
  Held<T>& held() {
    constant_ = false;
    return held_;
  }
  const Held<T>& held() const { return held_; }

 private:
  bool raised() const {
    using detail::vanishes;
    return !vanishes(power_ - T(1));
  }
  [[gnu::noinline]] Curve<T> raised_from(T t) const {
    return RaisedLine<T>{given_line(t), power_}.at(t, given_from(t).value);
  }
  [[gnu::noinline]] T next_of_raised(T t) const {
    return std::min(next_given(t), RaisedLine<T>{given_line(t), power_}.next_breakpoint(t));
  }
  /// Line between two rows, from the row before the i-th on.
  Line<T> between(std::size_t i) const {
    return {values_[i - 1], (values_[i] - values_[i - 1]) / (times_[i] - times_[i - 1])};
  }
  /// First breakpoint of the input before it is raised.
  T next_given(T t) const {
    if (count_ == 0) return held_.next_breakpoint(t);
    const std::size_t i = breakpoints_until(t);
    constexpr T never = std::numeric_limits<T>::infinity();
    if (pieces_ == nullptr) return i == count_ ? never : times_[i];
    const T next = i == count_ ? never : pieces_[i].begin;
    if (i == 0) return next;
    const T decayed = pieces_[i - 1].begin + pieces_[i - 1].decayed();
    return t < decayed ? std::min(next, decayed) : next;
  }
  /// Function from time t on, after i of its begins.
  [[gnu::noinline]] Curve<T> part_of_function(std::size_t i, T t) const {
    if (i == 0) return {first(), T(0)};
    const InputPiece<T>& piece = pieces_[i - 1];
    return Curve<T>::part(piece, t - piece.begin, t >= piece.begin + piece.decayed());
  }
  std::size_t breakpoints_until(T t) const {
    if (pieces_ != nullptr) {
      const auto later = [](T time, const InputPiece<T>& piece) { return time < piece.begin; };
      return static_cast<std::size_t>(std::upper_bound(pieces_, pieces_ + count_, t, later) -
                                      pieces_);
    }
    return static_cast<std::size_t>(std::upper_bound(times_, times_ + count_, t) - times_);
  }

  Held<T> held_;  ///< line of an input without breakpoints; else the value before the first
  bool constant_{true};
  const T* times_{nullptr};
  const T* values_{nullptr};
  const InputPiece<T>* pieces_{nullptr};
  std::size_t count_{0};  ///< of breakpoints, or of pieces
  T power_{1};
};

/// Release at t = 0 and inputs from then on.
template <class T>
struct Inputs {
  Profile<T> mouse_velocity;  ///< v_p: velocity of the plate in the frame of the housing, m/s
  T displacement;             ///< x(0), m
  T velocity;                 ///< x'(0), m/s
  T duration{std::numeric_limits<T>::infinity()};  ///< s; infinite: until the ending is known
  Profile<T> plate_load{T(1)};                     ///< factor of the plate friction; >= 0
  /// Skin stretch of a compliant finger, m; NaN: that of the sliding skin or, at rest, zero.
  T skin_stretch{std::numeric_limits<T>::quiet_NaN()};
  Profile<T> force{T(0)};            ///< external force on the pin, N
  Profile<T> across_velocity{T(0)};  ///< transverse velocity of the plate, m/s; continuous
  Profile<T> finger_load{T(1)};      ///< factor of the finger friction; >= 0
  /// True if the force contains −m v_p', as for a spring that stands on the ground.
  bool on_ground{false};

  /// First breakpoint of any input after time t, s; infinite without one.
  T next_breakpoint(T t) const {
    return std::min({mouse_velocity.next_breakpoint(t), plate_load.next_breakpoint(t),
                     finger_load.next_breakpoint(t), force.next_breakpoint(t),
                     across_velocity.next_breakpoint(t)});
  }
  /// True if all inputs are linear between breakpoints.
  bool straight() const {
    return mouse_velocity.straight() && plate_load.straight() && force.straight() &&
           across_velocity.straight() && finger_load.straight();
  }
  bool constant() const {
    return mouse_velocity.constant() && plate_load.constant() && force.constant() &&
           across_velocity.constant() && finger_load.constant();
  }
};

/// State of a contact: slip forward or backward, stick, absent, elastic stick (skin that stretches
/// with the pin), or oblique slip (the plate also slides in the transverse direction, whatever the
/// pin does).
enum class ContactState : signed char {
  slip_backward = -1,
  stick = 0,
  slip_forward = 1,
  absent = 2,
  elastic_stick = 3,
  slip_oblique = 4
};

inline bool is_slip(ContactState state) {
  return state == ContactState::slip_backward || state == ContactState::slip_forward ||
         state == ContactState::slip_oblique;
}
inline bool is_stick(ContactState state) {
  return state == ContactState::stick || state == ContactState::elastic_stick;
}
inline int sign(ContactState state) {
  return state == ContactState::slip_backward ? -1 : state == ContactState::slip_forward ? 1 : 0;
}
inline ContactState opposite(ContactState state) { return static_cast<ContactState>(-sign(state)); }
/// Component of a value in the direction of slip.
template <class T>
T along(ContactState state, T value) {
  return T(static_cast<int>(state)) * value;
}

/// State of the end stops: the upper or lower stop touches the pin, or the pin is beyond the end of
/// the travel and returns faster than an elastic stop follows.
enum class StopState : signed char {
  beyond_lower = -2,
  lower = -1,
  apart = 0,
  upper = 1,
  beyond_upper = 2
};

inline bool in_contact(StopState state) {
  return state == StopState::lower || state == StopState::upper;
}
/// Sign of the stop: 1, −1, or 0 without one.
inline int stop_sign(StopState state) {
  return (state > StopState::apart) - (state < StopState::apart);
}

struct Mode {
  ContactState plate, finger;
  int plate_branch{0}, finger_branch{0};  ///< branches of the friction curves, in slip
  StopState stop{StopState::apart};

  bool stuck() const { return plate == ContactState::stick || finger == ContactState::stick; }
  bool both_stuck() const { return plate == finger && finger == ContactState::stick; }
};

inline bool same_mode(const Mode& one, const Mode& other) {
  return one.plate == other.plate && one.finger == other.finger &&
         one.plate_branch == other.plate_branch && one.finger_branch == other.finger_branch &&
         one.stop == other.stop;
}

/// Transition of a contact at the end of a segment: start of stick, start of slip or separation,
/// reversal of the sliding direction; none at a breakpoint of an input or of a friction curve.
enum class Transition : signed char { none, stick, slip, cross };

struct Event {
  Transition plate{Transition::none}, finger{Transition::none};
  /// stick: contact; cross: momentary contact; slip: separation
  Transition stop{Transition::none};

  bool any() const {
    return plate != Transition::none || finger != Transition::none || stop != Transition::none;
  }
};

/// True if a rigid stop holds the pin.
template <class T>
bool held_by_stop(const Drive<T>& drive, const Mode& mode) {
  return in_contact(mode.stop) && drive.stops.rigid();
}
/// True if the velocity of the pin is prescribed, by a sticking contact or a rigid stop.
template <class T>
bool held(const Drive<T>& drive, const Mode& mode) {
  return mode.stuck() || held_by_stop(drive, mode);
}

inline Transition change(ContactState before, ContactState after) {
  if (before == after) return Transition::none;
  if (is_stick(before) == is_stick(after))
    return sign(before) == -sign(after) ? Transition::cross : Transition::none;
  return is_stick(after) ? Transition::stick : Transition::slip;
}

/// True if the sliding velocity became zero.
inline bool stops(Transition transition) {
  return transition == Transition::stick || transition == Transition::cross;
}

/// Fast transient that a series omits (creep.hpp, slow_slider.hpp, overdamped.hpp). `motion`: the whole motion of a
/// pin in equilibrium by the rest criterion.
enum class EliminatedPart : signed char { none, of_friction, of_slider, of_inertia, motion };

/// One mode from begin to end (infinite if it never ends), with its friction.
template <class T>
struct Segment {
  T begin, end;  ///< s
  Mode mode;
  Event event;  ///< event at the end
  Flow<T> flow;
  Propagator<T> moved;      ///< propagator of the oscillator from begin to a finite end
  Curve<T> plate_velocity;  ///< m/s
  /// friction on the pin, N; if both contacts stick, the plate force is their sum
  Path<T> plate_force, finger_force;
  T slider_velocity{0};  ///< of a compliant finger that has one, at the begin, m/s
  EliminatedPart eliminated{EliminatedPart::none};  ///< fast transient that the series omits
  bool driven{false};  ///< in closed form under functions (series/driven_motion.hpp)

  /// Propagator of the oscillator after τ.
  Propagator<T> after(T tau) const { return tau == end - begin ? moved : flow.after(tau); }
};

/// Receives the segments of a motion in order of time; may return false to stop.
template <class T>
using SegmentSink = Callback<const Segment<T>&>;

/// Ending of a motion.
enum class End : signed char {
  moving,       ///< unknown within the duration
  resting,      ///< at rest for ever
  decaying,     ///< free decay, no further event
  free,         ///< undamped oscillation, no further event
  grazing,      ///< undamped oscillation that touches the velocity of the plate once a period
  stick_slip,   ///< periodic alternation of stick and slip
  limit_cycle,  ///< periodic motion sustained by falling friction, without stick
  driven,       ///< periodic response to periodic inputs
  irregular,    ///< chaotic or quasi-periodic: no return within `irregular_windows` (limits.hpp)
  drifting,  ///< approach to a line, or oscillation about it, under inputs that grow; no further event
  growing,     ///< the range grows from period to period, and no ending was found
  approaching  ///< the range tends to a limit, too slowly for the limit to be found
};

enum class Status : signed char {
  ok,
  too_many_events,
  standstill,
  stopped,
  inconsistent,
  too_many_periods
};

template <class T>
struct Outcome {
  Status status{Status::ok};
  End end{End::moving};
  /// Period of a steady, growing or approaching oscillation, s.
  T period{std::numeric_limits<T>::quiet_NaN()};
  /// Factor in a period of the range of a growing oscillation, of the distance from the limit of an approaching one.
  double growth{std::numeric_limits<double>::quiet_NaN()};
  T until{0};  ///< end of the last segment, s; a cycle repeats from here on
  /// begin of the repeated cycle, s; of an irregular motion, begin of the stretch that is measured
  T cycle_begin{0};

  /// True if the state is known at all times, not only as far as it was simulated.
  bool known() const { return end != End::moving && !unbounded(); }
  /// True if the motion has no known ending however long it is simulated.
  bool unbounded() const {
    return end == End::irregular || end == End::growing || end == End::approaching;
  }
  bool steady() const { return cycles() || end == End::free || end == End::grazing; }
  bool cycles() const {
    return end == End::stick_slip || end == End::limit_cycle || end == End::driven;
  }
};

}  // namespace pindrive
