/// Segment evaluated from its trajectory and the given inputs: state of the pin, forces not given
/// by the friction law, and their errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "pindrive/certificate/tolerances.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/skin_along.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive::detail {

/// Largest displacement, velocity and force of a motion. Elastic stops, which may be much stiffer,
/// have a force scale of their own.
template <class T>
struct Scales {
  T x{0}, v{0}, across{0}, force{0}, stop{0};
};

/// State of the pin, τ after the begin of its segment.
template <class T>
struct PinState {
  T tau, x, v, a, plate_force, finger_force;
  T stretch_force, stretch_force_rate;  ///< finger force by the stretch of the skin, N, and N/s
};

/// Kinetic friction for a load factor of 1 at a sliding speed, from the points of the friction
/// curve, N.
template <class T>
T kinetic_friction(const Contact<T>& contact, T speed) {
  T force = contact.kinetic;
  for (int i = 0; i < contact.branches; ++i)
    if (speed >= contact.curve[i].from) force = contact.curve[i].at(speed);
  return force;
}

/// Error of the skin tension, N: its change within the time resolution.
template <class T>
T skin_unsure(const Drive<T>& drive, T time, const PinState<T>& s) {
  return drive.finger.rigid() ? T(0) : tolerance::sum<T> * time * abs(s.stretch_force_rate);
}

template <class T, class Trajectory>
class EvaluatedSegment {
 public:
  using Quantity = std::decay_t<decltype(std::declval<Trajectory>().position())>;
  struct State : PinState<T> {
    typename Trajectory::Moment moment;
  };

  const Drive<T>& drive;
  const Scales<T>& scales;
  const Segment<T>& segment;
  const Trajectory& along;
  const Curve<T> plate_velocity, load, finger_load, force, across;
  const T span;  ///< time to the end of the segment or of the evaluated range, s
  const Quantity x_rate, acceleration, stretch_force, stretch_force_rate;

  EvaluatedSegment(const Drive<T>& of, const Scales<T>& largest, const Inputs<T>& inputs,
                   T duration, const Segment<T>& part, const Trajectory& trajectory)
      : drive(of),
        scales(largest),
        segment(part),
        along(trajectory),
        plate_velocity(inputs.mouse_velocity.from(part.begin)),
        load(inputs.plate_load.from(part.begin)),
        finger_load(inputs.finger_load.from(part.begin)),
        force(inputs.force.from(part.begin)),
        across(
            InputCurves<T>::across_from(inputs, part.begin, plate_velocity, held(of, part.mode))),
        span(std::min(part.end, std::max(duration, part.begin)) - part.begin),
        x_rate(along.derivative(along.position())),
        acceleration(along.acceleration()),
        stretch_force(stretch_force_along(of, part, along)),
        stretch_force_rate(has_damped_skin(of, part)
                               ? -of.finger.stiffness * stretch_rate_along(of, part, along)
                               : along.derivative(along.finger_force())) {}

  const Mode& mode() const { return segment.mode; }
  bool oblique() const { return mode().plate == ContactState::slip_oblique; }

  State at(T tau) const {
    const auto now = along.moment(tau);
    return {{tau, along.at(along.position(), now), along.at(along.velocity(), now),
             along.at(acceleration, now), along.at(along.plate_force(), now),
             along.at(along.finger_force(), now), along.at(stretch_force, now),
             along.at(stretch_force_rate, now)},
            now};
  }

  /// Force of an elastic stop on the pin, or of a rigid stop that keeps the pin in equilibrium, N.
  T stop_force(const PinState<T>& s) const {
    if (!in_contact(mode().stop)) return T(0);
    const Stops<T>& stops = drive.stops;
    if (!stops.rigid())
      return stops.stiffness * (stop_sign(mode().stop) * stops.travel - s.x) - stops.damping * s.v;
    return drive.stiffness * s.x - drive.mass * plate_velocity.rate_at(s.tau) - s.plate_force -
           s.finger_force - force.at(s.tau);
  }

  /// Sliding velocity on the finger, m/s.
  T on_finger(const State& s) const {
    if (!drive.finger.compliant()) return s.v;
    return s.v + s.stretch_force_rate / drive.finger.stiffness;
  }

  /// Distance of a force and a sliding velocity from the law of oblique slip, N: by the force at
  /// the given velocity or, where the force turns steeply, by the distance of the velocity from the
  /// direction of the force, scaled to the largest velocity.
  T oblique_error(const PinState<T>& s) const {
    const T u = s.v - plate_velocity.at(s.tau), w = across.at(s.tau), speed = hypot(u, w);
    const T strength = load.at(s.tau) * kinetic_friction(drive.plate, speed);
    if (!(strength > 0)) return s.plate_force;
    const T part = -s.plate_force / strength, axial = std::clamp(part, T(-1), T(1));
    const T beside = abs(u * sqrt((1 - axial) * (1 + axial)) - abs(w) * axial);
    const T too_large = strength * abs(part - axial);
    // Without a scale nothing moves, and nothing pulls.
    const T largest = std::max(scales.v, scales.across);
    const T by_velocity = (largest > 0 ? beside / largest * scales.force : beside) + too_large;
    return speed > 0 ? std::min(by_velocity, abs(s.plate_force + strength * u / speed))
                     : by_velocity;
  }

  /// Error of the forces, N.
  T unsure(const PinState<T>& s) const {
    const T time = segment.begin + s.tau;
    const bool changes = is_slip(mode().finger) && finger_load.rate != 0;
    const T of_skin = changes ? skin_unsure(drive, time, s) : T(0);
    return of_skin + turning_unsure(s, time);
  }
  /// Largest skin tension near a load of zero, where the skin is not simulated: its momentum is
  /// within the time resolution, N.
  T lifted_unsure() const {
    if (!drive.finger.compliant() || finger_load.rate == 0 || !(span > 0)) return T(0);
    return tolerance::unloaded_stretch<T> * scales.force * (segment.begin + span) / span;
  }
  /// Error of the slider speed, m/s: from the time resolution and from the error of the force.
  const T slider_unsure = unsure_slider();
  /// Error of the velocity of the pin from the time resolution, m/s.
  T velocity_unsure() const {
    if (!(span < std::numeric_limits<T>::infinity())) return T(0);
    const T begins = abs(along.at(acceleration, along.moment(T(0)))),
            ends = abs(along.at(acceleration, along.moment(span)));
    return tolerance::sum<T> * (segment.begin + span) * std::max(begins, ends);
  }

 private:
  /// Part of the error from oblique slip: the force turns with the velocity, which has the error of
  /// its rounding and of the time.
  T turning_unsure(const PinState<T>& s, T time) const {
    if (!oblique()) return T(0);
    const T u = s.v - plate_velocity.at(s.tau), w = across.at(s.tau);
    const T speed = hypot(u, w);
    const T pressed = std::max(load.at(s.tau), T(0));  // less by rounding where it ends
    const T strength = pressed * kinetic_friction(drive.plate, speed);
    const T moves = scales.v + time * (abs(s.a) + abs(plate_velocity.rate_at(s.tau)));
    if (!(speed > 0)) return T(0);
    const T drifts = scales.across + time * abs(across.rate_at(s.tau));
    const T turn = (moves * abs(w) + drifts * abs(u)) / speed;  // change of direction, times speed
    return tolerance::difference<T> * strength * abs(w) / speed * turn / speed;
  }

  T unsure_slider() const {
    if (!drive.finger.compliant() || !is_slip(mode().finger)) return T(0);
    const auto bend = along.derivative(stretch_force_rate);
    T most{0}, terms{0};  // rounding of the rate, and of the force, whose parts may cancel
    for (const T tau : {T(0), span}) {
      const auto now = along.moment(tau);
      const T faster = along.at(acceleration, now) + along.at(bend, now) / drive.finger.stiffness;
      most = std::max(most, abs(faster));
      terms = std::max(terms, abs(along.at(along.finger_force(), now)) +
                                  2 * finger_load.at(tau) * finger_at_rest());
    }
    const T rate = span > 0 ? terms / (drive.finger.stiffness * span) : T(0);
    return tolerance::sum<T> * (most * (segment.begin + span) + rate);
  }
  /// Friction of the finger branch extrapolated to zero speed, N.
  T finger_at_rest() const {
    if (!is_slip(mode().finger)) return T(0);
    const int last = std::max(drive.finger.branches - 1, 0);
    const Branch<T> branch = drive.finger.branch(std::clamp(mode().finger_branch, 0, last));
    return abs(branch.intercept());
  }
};

}  // namespace pindrive::detail
