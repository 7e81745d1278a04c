/// Mode of a drive for its series: modes without a closed form, their equation and their guards.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/law/contact_point.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/model/input_curves.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/inlining.hpp"
#include "pindrive/series/creep.hpp"
#include "pindrive/series/term_sum.hpp"

namespace pindrive::detail {

/// Mode of a drive between two events, while the inputs are linear. Under an oblique hand the plate
/// slips in every mode, whichever sign is given.
template <class T>
class SeriesMode {
 public:
  using Real = detail::Real<T>;

  SeriesMode(const Drive<T>& drive, const Mode& mode, const InputCurves<T>& inputs)
      : drive_(drive), mode_(mode), inputs_(inputs) {}

  /// True if flow.hpp has the closed form of a mode, so that no series is needed. Oblique slip has one only under a held
  /// pin and a plate of constant velocity, where friction is proportional to the load.
  PINDRIVE_INLINE static bool closed_form(const Drive<T>& drive, const Mode& mode,
                                          const InputCurves<T>& inputs) {
    const auto bilinear = [](ContactState state, const Contact<T>& contact, int branch,
                             const Curve<T>& load) {
      return is_slip(state) && !load.steady() && contact.branch(branch).slope != 0;
    };
    const auto curved = [](ContactState state, const Contact<T>& contact, const Curve<T>& load,
                           bool still) {
      return is_slip(state) && !contact.linear() && !(still && load.steady());
    };
    const bool functions = !inputs.plate_velocity.straight() || !inputs.force.straight() ||
                           (mode.plate != ContactState::absent && !inputs.plate_load.straight()) ||
                           (mode.finger != ContactState::absent && !inputs.finger_load.straight());
    if (functions) return false;
    const bool across = is_slip(mode.plate) && inputs.oblique();
    const bool still = held(drive, mode) && inputs.plate_velocity.steady();
    const bool steady = across && still && inputs.across_velocity.steady();
    if (curved(mode.plate, drive.plate, inputs.plate_load, across ? steady : still) ||
        curved(mode.finger, drive.finger, inputs.finger_load, still))
      return false;
    return (steady || (!across &&
                       !bilinear(mode.plate, drive.plate, mode.plate_branch, inputs.plate_load))) &&
           !bilinear(mode.finger, drive.finger, mode.finger_branch, inputs.finger_load) &&
           !has_slider_state(drive.finger, mode);
  }
  bool has_closed_form() const { return closed_form(drive_, mode_, inputs_); }

  /// True if the equation has constant coefficients, so that `DrivenMotion` is its solution.
  bool has_constant_coefficients() const {
    const auto constant = [](ContactState state, const Contact<T>& contact, int branch,
                             const Curve<T>& load) {
      if (!is_slip(state)) return true;
      return contact.linear() && (load.steady() || contact.branch(branch).slope == 0);
    };
    const bool follows = is_slip(mode_.finger) && !drive_.finger.rigid();
    const bool damped = follows && drive_.finger.damped();
    return mode_.plate != ContactState::slip_oblique && !inputs_.finger_load.raised &&
           constant(mode_.plate, drive_.plate, mode_.plate_branch, inputs_.plate_load) &&
           constant(mode_.finger, drive_.finger, mode_.finger_branch, inputs_.finger_load) &&
           (damped ? finger().slope == 0 : !has_slider_state()) &&
           !(follows && !damped && !inputs_.finger_load.straight()) &&
           !held_by_stop(drive_, mode_) && drive_.damping >= 0;
  }
  /// The mode with its inputs from τ on.
  SeriesMode from(T tau) const { return {drive_, mode_, inputs_.from(tau)}; }

  bool has_slider_state() const { return has_slider_state(drive_.finger, mode_); }

  /// Equation of the mode. The skin state is the tension by the stretch or, if the finger slips with damping or on
  /// a sloped branch, the slider velocity.
  SeriesEquation<T> equation() const {
    SeriesEquation<T> e{drive_.mass, drive_.damping, drive_.stiffness};
    e.force = inputs_.force.line();
    e.force.value += drive_.mass * inputs_.plate_velocity.rate;
    e.force.rate += drive_.mass * inputs_.plate_velocity.second();
    e.pushes = inputs_.force;
    e.plate_velocity = inputs_.plate_velocity;
    e.load = inputs_.plate_load;
    if (is_slip(mode_.plate)) {
      e.plate_force = plate().intercept();
      e.plate_slope = plate().slope;
      e.plate_falling = plate().falling;
    }
    e.side = sign(mode_.plate) < 0 ? -1 : 1;
    if (is_slip(mode_.plate) && inputs_.oblique()) {
      e.side = 0;
      e.across = inputs_.across_velocity;
    }
    if (is_slip(mode_.finger)) {
      const T friction = along(mode_.finger, finger().intercept());
      e.force.value -= friction * inputs_.finger_load.value;
      e.force.rate -= friction * inputs_.finger_load.rate;
      e.finger_force = friction;
    }
    const Curve<T>& load = inputs_.finger_load;
    if (mode_.finger != ContactState::absent) e.finger_load = load;  // also limits a stick force
    if (has_slider_state()) {
      e.skin_pull = {finger().slope * load.value, finger().slope * load.rate};
      e.skin_factor = {e.skin_pull.value + drive_.finger.damping, e.skin_pull.rate};
      e.skin_damping = drive_.finger.damping;
      e.skin_stiffness = e.skin_decay = drive_.finger.stiffness;
      e.skin_drift = along(mode_.finger, finger().intercept()) * load.rate;
    } else if (mode_.finger == ContactState::elastic_stick) {
      e.skin_factor.value = e.skin_pull.value = T(1);
      e.damping += drive_.finger.damping;
      e.skin_stiffness = drive_.finger.stiffness;
    } else if (is_slip(mode_.finger)) {
      e.damping += finger().slope * load.value;
      e.damping_rate = finger().slope * load.rate;
      e.finger_slope = finger().slope;
      e.finger_falling = finger().falling;
      e.finger_side = sign(mode_.finger);
    }
    e.held = held(drive_, mode_);
    if (in_contact(mode_.stop) && !drive_.stops.rigid()) {
      e.damping += drive_.stops.damping;
      e.stiffness += drive_.stops.stiffness;
      e.force.value += stop_sign(mode_.stop) * drive_.stops.stiffness * drive_.stops.travel;
    }
    if (mode_.plate == ContactState::stick) e.surface = inputs_.plate_velocity;
    return e;
  }

  /// Guards that are exactly zero at the begin: of the speeds, and the side of a stick force at its
  /// limit.
  struct Reached {
    ActiveGuard plate{ActiveGuard::none}, finger{ActiveGuard::none};
    int limit{0};
    bool push{false};  ///< the push of a stop

    bool any() const {
      return plate != ActiveGuard::none || finger != ActiveGuard::none || limit != 0 || push;
    }
  };

  /// Guards of the mode along a step or a driven motion.
  template <class Path>
  class StepGuards {
    using Guard = detail::Guard<T, Path>;

   public:
    const Guard* begin() const { return list_.data(); }
    const Guard* end() const { return list_.data() + count_; }
    /// Guard with the earliest zero; null without one.
    const Guard* earliest() const {
      const Guard* first = nullptr;
      for (const Guard& guard : *this)
        if (guard.zero < (first == nullptr ? never : first->zero)) first = &guard;
      return first;
    }
    /// Takes the guards of another list without their paths; a given guard is zero at 0.
    template <class Other>
    void assign(const StepGuards<Other>& others, const detail::Guard<T, Other>* zero) {
      count_ = 0;
      for (const detail::Guard<T, Other>& guard : others)
        list_[count_++] = {
            {}, guard.bound, guard.plate, guard.side, &guard == zero ? T(0) : never, guard.error};
    }

   private:
    friend class SeriesMode;
    void add(Polynomial<T> path, bool at_zero, ActiveGuard bound, bool plate, int side,
             Real error = 0) {
      if (at_zero) leave_zero(path.c);
      list_[count_++] = {path, bound, plate, side, zero_beyond(path, error), error};
    }
    void add(const TermSum<T>& path, bool, ActiveGuard bound, bool plate, int side,
             Real error = 0) {
      list_[count_++] = {path, bound, plate, side, never, error};
    }
    /// Makes exact the start that the selection of the mode implies: coefficients of the wrong sign
    /// are rounding, or the path turns back within the rounding of its start.
    template <class Coefficients>
    static void leave_zero(Coefficients& c) {
      const bool turns = c[1] < 0 && c[2] > -c[1];
      c[0] = turns ? c[1] * c[1] / (2 * c[2]) : T(0);  // twice the depth of the minimum
      for (int n = 1; n <= 3 && !turns && !(c[n] > 0); ++n) c[n] = T(0);
    }
    std::array<Guard, 8> list_;
    int count_{0};
  };
  /// Guards of the mode along a series step, with their zeros, or a motion in closed form; guards of a stick force
  /// come first.
  template <class Along>
  StepGuards<typename Along::Path> guards(const Along& along, const Reached& at = {}) const {
    using Path = typename Along::Path;
    StepGuards<Path> found;
    if (held_by_stop(drive_, mode_)) {
      const int end = stop_sign(mode_.stop);
      found.add(T(-end) * along.stick_force, at.push, ActiveGuard::push, false, end);
    } else if (mode_.stuck()) {
      Path most = along.input(Line<T>{T(0), T(0)});
      Real error{0};
      const auto add_limit = [&](const Contact<T>& contact, const Curve<T>& load) {
        most += contact.static_limit * along.input(load);
        error += plain(contact.static_limit) * given_rounding(load);
      };
      if (mode_.plate == ContactState::stick) add_limit(drive_.plate, inputs_.plate_load);
      if (mode_.finger == ContactState::stick) add_limit(drive_.finger, inputs_.finger_load);
      within(found, along.stick_force, most, at.limit, mode_.plate == ContactState::stick, error);
    }
    const Real followed = rounding_followed(along);
    if (is_slip(mode_.plate))
      between(found, along.speed, plate(), at.plate, true, inputs_.oblique(), followed);
    if (is_slip(mode_.finger)) {
      Path speed =
          pindrive::along(mode_.finger, T(1)) * (has_slider_state() ? along.skin : along.velocity);
      if (!has_slider_state() && !drive_.finger.rigid())
        speed += Line<T>{-follows(finger().force), T(0)};
      between(found, speed, finger(), at.finger, false, false, followed);
    }
    if (mode_.finger == ContactState::elastic_stick) {
      const int limit = at.finger == ActiveGuard::none ? 0 : begins_with(tension(along));
      within(found, tension(along), drive_.finger.static_limit * along.input(inputs_.finger_load),
             limit, false);
    }
    if (drive_.stops.present() && !held_by_stop(drive_, mode_)) stops(found, along, at);
    return found;
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  /// True if the slider of a compliant finger has a velocity of its own, in slip on a sloped
  /// branch.
  static bool has_slider_state(const Contact<T>& finger, const Mode& mode) {
    return finger.may_lag() && is_slip(mode.finger) &&
           (finger.damped() || finger.branch(mode.finger_branch).slope != 0);
  }
  Branch<T> plate() const { return drive_.plate.branch(mode_.plate_branch); }
  Branch<T> finger() const { return drive_.finger.branch(mode_.finger_branch); }
  /// Rate at which the skin stretches at a friction as the load changes, m/s.
  T follows(T friction) const {
    return inputs_.finger_load.rate * friction / drive_.finger.stiffness;
  }

  /// Tension of skin whose slider sticks, N.
  template <class Along>
  typename Along::Path tension(const Along& along) const {
    if (!drive_.finger.damped()) return along.skin;
    typename Along::Path found = along.skin;
    return found += drive_.finger.damping * along.velocity;
  }
  /// Sign of the first coefficient that is not zero.
  static int begins_with(const Polynomial<T>& series) {
    for (const T& c : series.c)
      if (c != 0) return c < 0 ? -1 : 1;
    return 1;
  }
  static int begins_with(const TermSum<T>& sum) { return sum.start() < 0 ? -1 : 1; }

  /// rounding: the error of a function; lines do not touch zero
  /// (tests/hard/creep-touches-rest-as-the-transverse-velocity-touches-zero.txt).
  static Real given_rounding(const Curve<T>& input) {
    return input.straight() ? Real(0) : input.rounding();
  }
  /// Rounding that a velocity has from that of the plate: of a pin that sticks, or creeps on an oblique plate.
  template <class Along>
  Real rounding_followed(const Along& along) const {
    const Curve<T>&plate = inputs_.plate_velocity, &across = inputs_.across_velocity;
    if (mode_.stuck()) return given_rounding(plate);
    if (!along.creeps() || across.value == 0) return Real(0);
    const Real ratio = abs(plain((along.velocity.start() - plate.value) / across.value));
    return given_rounding(plate) + ratio * given_rounding(across);
  }
  template <class Path>
  void between(StepGuards<Path>& found, const Path& speed, const Branch<T>& range, ActiveGuard at,
               bool is_plate, bool oblique, Real error) const {
    Path above = speed, below = T(-1) * speed;
    above += Line<T>{-range.from, T(0)};
    below += Line<T>{range.to, T(0)};
    if (!oblique || range.from > 0)  // otherwise the transverse velocity keeps the speed positive
      found.add(above, at == ActiveGuard::lower, ActiveGuard::lower, is_plate, 0, error);
    if (range.to < never)
      found.add(below, at == ActiveGuard::upper, ActiveGuard::upper, is_plate, 0, error);
  }
  template <class Along>
  void stops(StepGuards<typename Along::Path>& found, const Along& along, const Reached& at) const {
    using Path = typename Along::Path;
    const Stops<T>& stops = drive_.stops;
    const auto beyond = [&](int end, int sense) {
      Path path = T(sense * end) * along.position;
      path += Line<T>{-sense * stops.travel, T(0)};
      const bool exact = end * along.position.start() == stops.travel;
      found.add(path, exact, ActiveGuard::edge, false, end);
    };
    if (mode_.stop == StopState::apart) {
      beyond(1, -1);
      beyond(-1, -1);
      return;
    }
    const int end = stop_sign(mode_.stop), sense = in_contact(mode_.stop) ? 1 : -1;
    if (stops.damping == 0 || sense < 0) beyond(end, 1);
    if (stops.damping == 0) return;
    Path push = T(sense * end) * stops.stiffness * along.position;
    push += T(sense * end) * stops.damping * along.velocity;
    // A first value that is computed anew has less rounding than the sum of the paths.
    push.begin_at(sense * (stops.stiffness * (end * along.position.start() - stops.travel) +
                           stops.damping * end * along.velocity.start()));
    found.add(push, at.push, ActiveGuard::push, false, end);
  }
  template <class Path>
  void within(StepGuards<Path>& found, const Path& force, const Path& most, int at_limit,
              bool is_plate, Real error = 0) const {
    for (const int side : {1, -1}) {
      Path left = T(-side) * force;
      left += most;
      found.add(left, side == at_limit, ActiveGuard::none, is_plate, side, error);
    }
  }

  const Drive<T>& drive_;
  Mode mode_;
  InputCurves<T> inputs_;
};

}  // namespace pindrive::detail
