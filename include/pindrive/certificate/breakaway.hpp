/// Check of contacts that start to slip from rest: margin of the stick force that they would have
/// had.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/certificate/evaluated_segment.hpp"
#include "pindrive/certificate/tolerances.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive::detail {

/// Instant at the begin of a segment: pin, friction, inputs, and the rigid contacts with zero
/// relative velocity within rounding.
template <class T>
struct Beginning {
  T x, v, plate_force, finger_force;
  Curve<T> plate_velocity;
  T plate_load, finger_load, force;
  bool rests_on_plate, rests_on_finger;
  bool plate_began, finger_began;  ///< the contact changed its state at this instant
};

/// Margin to the stick limit of contacts that slip from rest, N; 0 if they could not stick. Where
/// the law allows several modes none is preferred: a contact that slips beside a sticking contact
/// is not checked.
template <class T>
T spare_stick_limit(const Drive<T>& drive, const Mode& mode, const Beginning<T>& now) {
  const bool plate = now.rests_on_plate && is_slip(mode.plate);
  const bool finger = now.rests_on_finger && is_slip(mode.finger);
  if (mode.stuck() || !(plate || finger)) return T(0);
  const T at_plate = drive.plate.static_limit * now.plate_load;
  const T at_finger = drive.finger.static_limit * now.finger_load;
  const T pull = drive.damping * now.v + drive.stiffness * now.x - now.force;
  const T inertia = drive.mass * now.plate_velocity.rate;
  const T second = now.plate_velocity.second();
  const T parts =
      inertia != 0  ? inertia
      : second != 0 ? second
                    : third_or_later(now.plate_velocity.template coefficients<beginning_orders>());
  if (plate && finger && parts == 0) return std::max(at_plate + at_finger - abs(pull), T(0));
  // Each contact alone. If the surfaces part, the slipping contact slips in the direction of parting.
  const int side = parts > 0 ? 1 : -1;
  const T of_finger =
      plate && finger ? -side * drive.finger.kinetic * now.finger_load : now.finger_force;
  const T of_plate =
      plate && finger ? side * drive.plate.kinetic * now.plate_load : now.plate_force;
  T spare{0};
  // A plate that moves out does not take along a pin at a rigid stop.
  const bool blocked = drive.stops.present() && drive.stops.rigid() &&
                       abs(now.x) >= drive.stops.travel && now.x * parts > 0;
  if (plate && now.plate_began && !blocked) spare = at_plate - abs(pull - of_finger);
  if (finger && now.finger_began)
    spare = std::max(spare, at_finger - abs(pull - inertia - of_plate));
  return std::max(spare, T(0));
}

/// Checks the segments of a motion in order. Segments of zero length count as one instant with the
/// next segment, except for sticking within the limit.
template <class T>
class Breakaways {
 public:
  /// Margin to the stick limit of contacts that slip from rest at the begin of a segment, N.
  template <class Trajectory>
  T spare(const EvaluatedSegment<T, Trajectory>& segment) {
    const Mode& mode = segment.mode();
    const T begin = segment.segment.begin;
    if (!brief_) instant_ = begin;
    PinState<T> s = segment.at(T(0));
    s.v = segment.segment.flow.velocity.start;  // exact, while a sum of terms is rounded
    brief_ = is_brief(segment, s);
    const bool plate = began(plate_, mode.plate, begin);
    const bool finger = began(finger_, mode.finger, begin);
    if (brief_ || held_by_stop(segment.drive, mode)) return T(0);
    return spare_at(segment, s, plate, finger);
  }

 private:
  /// State of a contact, and the time since.
  struct Doing {
    ContactState state{ContactState::absent};
    T since{0};
  };

  /// True if a contact changed its state at this instant.
  bool began(Doing& doing, ContactState does, T time) const {
    const bool slides_on = doing.state == ContactState::slip_oblique && is_slip(does);
    if (does != doing.state && !slides_on) doing.since = time;
    doing.state = does;
    return doing.since >= instant_;
  }

  template <class Trajectory>
  static bool is_brief(const EvaluatedSegment<T, Trajectory>& segment, const PinState<T>& s) {
    return !(segment.segment.end > segment.segment.begin) &&
           !(within_limit(segment, s) > tolerance::difference<T> * segment.scales.force);
  }

  /// Margin of the stick force to its limit, N; 0 without stick.
  template <class Trajectory>
  static T within_limit(const EvaluatedSegment<T, Trajectory>& segment, const PinState<T>& s) {
    const Mode& mode = segment.mode();
    T most{0}, force{0};
    if (mode.plate == ContactState::stick) {
      most += segment.drive.plate.static_limit * segment.load.value;
      force += s.plate_force;
    }
    if (mode.finger == ContactState::stick) {
      most += segment.drive.finger.static_limit * segment.finger_load.value;
      force += s.finger_force;
    }
    return most - abs(force);
  }

  /// Margin at a state of the pin, where plate or finger has just changed its state.
  template <class Trajectory>
  static T spare_at(const EvaluatedSegment<T, Trajectory>& segment, PinState<T> s, bool plate,
                    bool finger) {
    const Drive<T>& drive = segment.drive;
    const Curve<T>& plate_velocity = segment.plate_velocity;
    // A given velocity is exact: next to that of the plate, the pin slides.
    const T still = segment.segment.begin > 0 ? T(tolerance::still) * segment.scales.v : T(0);
    const bool with_plate = abs(s.v - plate_velocity.value) <= still;
    // With both sliding velocities zero, the direction of the plate's friction is that in which the plate begins to
    // slide; within the resolution of time it is unknown.
    const Curve<T>& across = segment.across;
    if (segment.oblique() && with_plate) {
      const T slow = tolerance::transverse<T> * segment.segment.begin *
                     (abs(across.rate) + abs(plate_velocity.rate));
      if (across.value == 0)
        s.plate_force = -segment.load.value * kinetic_friction(drive.plate, T(0)) *
                        ObliqueSlip<T>(T(0), -plate_velocity.rate, plate_velocity, across).along();
      else if (abs(across.value) + abs(s.v - plate_velocity.value) <= slow)
        return T(0);
    }
    // A rigid stop keeps the pin from going with the plate.
    const int end = s.x < 0 ? -1 : 1;
    const bool at_stop = drive.stops.rigid() && end * s.x >= drive.stops.travel;
    const bool on_plate =
        with_plate && !segment.oblique() && !(at_stop && end * plate_velocity.rate > 0);
    const bool on_finger = abs(s.v) <= still && drive.finger.rigid();
    if (!(plate && on_plate) && !(finger && on_finger)) return T(0);
    const T push = segment.force.value + segment.stop_force(s), unsure = segment.unsure(s);
    const auto spare_of = [&](bool rests_on_plate, bool rests_on_finger) {
      return spare_stick_limit(drive, segment.mode(),
                               Beginning<T>{s.x, s.v, s.plate_force, s.finger_force, plate_velocity,
                                            segment.load.value, segment.finger_load.value, push,
                                            rests_on_plate, rests_on_finger, plate, finger}) -
             unsure;
    };
    // A contact that slides before and after may be at rest or not if its speed is rounding.
    T spare = spare_of(on_plate, on_finger);
    if (on_plate && !plate) spare = std::min(spare, spare_of(false, on_finger));
    if (on_finger && !finger) spare = std::min(spare, spare_of(on_plate, false));
    return std::max(spare, T(0));
  }

  Doing plate_{}, finger_{};
  T instant_{0};  ///< begin of the instant that ends at the begin of the segment
  bool brief_{false};
};

}  // namespace pindrive::detail
