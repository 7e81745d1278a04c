/// Quantities of a pin at an instant from its state, its inputs and its mode, by the equation of
/// motion without its solution; with dual numbers, their derivatives.
#pragma once

#include <cmath>

#include "pindrive/law/oblique.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/series/series_mode.hpp"

namespace pindrive {

/// Pin at an instant of a mode. `state` provides position and velocity and, for a compliant finger,
/// the state of the mode: the tension of sticking skin or the slider velocity.
template <class T>
class Instant {
 public:
  Instant(const Drive<T>& drive, const Mode& mode, const InputCurves<T>& inputs,
          const detail::State<T>& state) {
    const detail::SeriesMode<T> series(drive, mode, inputs);
    const detail::SeriesEquation<T> e = series.equation();
    const bool has_slider_state = series.has_slider_state(), at_stop = held_by_stop(drive, mode);
    position_ = at_stop ? stop_sign(mode.stop) * drive.stops.travel : drive.stops.within(state.x);
    const Line<T> surface = at_stop ? Line<T>{} : e.surface.line();
    velocity_ = e.held ? surface.value : state.v;
    const T by_stretch = state.skin - drive.finger.damping * state.v;
    const T skin = e.skin_pull.value * (has_slider_state ? state.slider_velocity : by_stretch);
    T pull = e.force.value - e.damping * velocity_ - e.stiffness * position_ - skin;
    if (e.finger_falling.present())
      pull -= e.finger_side * e.finger_load.value * e.finger_falling.at(e.finger_side * velocity_);
    const T plate = is_slip(mode.plate) ? plate_slip(e, pull) : T(0);
    acceleration_ = e.held ? surface.rate : (pull + plate) / e.mass;
    const T carried = e.mass * acceleration_ - pull - plate;  // force of the holding contact
    const bool plate_holds = mode.plate == ContactState::stick && !at_stop;
    const bool finger_holds = mode.finger == ContactState::stick && !at_stop;
    friction_.plate = plate_holds ? carried : plate;
    if (finger_holds && !plate_holds) friction_.finger = carried;
    if (finger_holds && plate_holds) {  // shared as in friction_along()
      const T at_plate = drive.plate.static_limit * inputs.plate_load.value;
      const T at_finger = drive.finger.static_limit * inputs.finger_load.value;
      const T part = at_plate > 0 ? at_plate / (at_plate + at_finger) : T(0);
      friction_ = {part * carried, (1 - part) * carried};
    }
    if (mode.finger == ContactState::elastic_stick) {
      friction_.finger = -state.skin;
      stretch_rate_ = velocity_;
    } else if (is_slip(mode.finger)) {
      const Branch<T> branch = drive.finger.branch(mode.finger_branch);
      const T speed = has_slider_state ? state.slider_velocity : velocity_;
      const T at_load_1 = along(mode.finger, branch.intercept()) + branch.slope * speed;
      friction_.finger = -at_load_1 * inputs.finger_load.value;
      if (!branch.linear())
        friction_.finger -= along(mode.finger, branch.falling.at(along(mode.finger, speed))) *
                            inputs.finger_load.value;
      if (has_slider_state)
        stretch_rate_ = velocity_ - state.slider_velocity;
      else
        stretch_rate_ = at_load_1 * inputs.finger_load.rate / drive.finger.stiffness;
    }
    const T damper =
        mode.finger != ContactState::absent ? drive.finger.damping * stretch_rate_ : T(0);
    stretch_ = -(friction_.finger + damper) / drive.finger.stiffness;
    // Balance of all forces on the pin.
    housing_force_ = friction_.plate + inputs.force.value +
                     drive.mass * (inputs.plate_velocity.rate - acceleration_);
  }

  T position() const { return position_; }          ///< m
  T velocity() const { return velocity_; }          ///< m/s
  T acceleration() const { return acceleration_; }  ///< m/s²
  const Friction<T>& friction() const { return friction_; }
  T stretch() const { return stretch_; }              ///< skin stretch, m; 0 without skin
  T stretch_rate() const { return stretch_rate_; }    ///< m/s
  T housing_force() const { return housing_force_; }  ///< force on housing and finger, N

 private:
  /// Friction of the slipping plate beside a force `pull`. A pin with the velocity of the plate
  /// starts to slide as the plate begins to slide across.
  T plate_slip(const detail::SeriesEquation<T>& e, T pull) const {
    using detail::hypot;
    const T u = velocity_ - e.plate_velocity.value, w = e.across.value;
    T along = T(e.side), force = e.plate_force;
    if (e.plate_falling.present())
      force += e.plate_falling.at(e.side != 0 ? T(e.side) * u : hypot(u, w));
    if (e.side == 0 && u == 0 && w == 0) {
      const T rest = pull - e.mass * e.plate_velocity.rate;
      along = e.held
                  ? detail::ObliqueSlip<T>(T(0), e.surface.rate - e.plate_velocity.rate,
                                           e.plate_velocity, e.across)
                        .along()
                  : detail::departure_of(e.mass, e.load.value * force, e.across.rate, rest).along;
    } else if (e.side == 0) {
      along = u / hypot(u, w);
    }
    return -e.load.value * (force * along + e.plate_slope * u);
  }

  T position_{}, velocity_{}, acceleration_{}, stretch_{0}, stretch_rate_{0}, housing_force_{0};
  Friction<T> friction_{T(0), T(0)};
};

/// State of a pin whose velocity changes to v (m/s), and the load of its finger to that of the inputs, by
/// derivatives alone: the stretch of damped skin stays.
template <class T, class Plain>
detail::State<T> changed(const Drive<T>& drive, const Mode& mode, const InputCurves<T>& inputs,
                         const T& v, const detail::State<Plain>& pin) {
  const Contact<T>& finger = drive.finger;
  detail::State<T> state{pin.x, v, pin.skin, 0, 0, pin.slider_velocity};
  if (!finger.damped() || held_by_stop(drive, mode)) return state;
  state.skin += finger.damping * (v - pin.v);
  if (!is_slip(mode.finger)) return state;
  const Branch<T> branch = finger.branch(mode.finger_branch);
  const T load = inputs.finger_load.value;
  const T slider = (state.skin - along(mode.finger, branch.intercept()) * load) /
                   (branch.slope * load + finger.damping);
  state.slider_velocity = slider + (pin.slider_velocity - plain(slider));
  return state;
}

/// State at the begin of the first mode after a release at x, v with a skin stretch; NaN: stretch
/// of sliding skin or, at rest, zero. `pin` is the state in plain numbers: a rigid stop may have
/// taken the velocity.
template <class T, class Plain>
detail::State<T> released(const Drive<T>& drive, const Mode& mode, const InputCurves<T>& inputs,
                          T x, T v, T stretch, const detail::State<Plain>& pin) {
  using std::abs;
  using std::isnan;
  detail::State<T> state{x, v};
  if (plain(v) != pin.v) state = {pin.x < 0 ? -drive.stops.travel : drive.stops.travel, T(0)};
  const Contact<T>& finger = drive.finger;
  if (finger.rigid()) return state;
  const T load = inputs.finger_load.value, speed = abs(state.v);
  if (!isnan(stretch))
    state.skin = finger.stiffness * stretch;
  else if (speed != 0)
    state.skin = (state.v < 0 ? -load : load) * finger.branch(finger.branch_of(speed)).at(speed);
  state.skin += finger.damping * state.v;
  if (!detail::SeriesMode<T>(drive, mode, inputs).has_slider_state()) return state;
  const int slid = finger.branch_of(speed);
  const Branch<T> branch = finger.branch(mode.finger_branch);
  // On a falling curve a slider jumps to another speed with equal friction.
  const T asked = abs(state.skin) - branch.force * load - finger.damping * branch.from;
  const T faster = asked / (branch.slope * load + finger.damping);
  state.slider_velocity = slid == mode.finger_branch && isnan(stretch)
                              ? state.v
                              : along(mode.finger, branch.from + faster);
  return state;
}

}  // namespace pindrive
