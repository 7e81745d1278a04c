/// Trajectory of a segment: quantities as functions of the time τ since its begin, in closed form, under
/// functions or by series, behind one interface.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "pindrive/flow/roots.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/motion/quadrature.hpp"
#include "pindrive/series/driven_motion.hpp"
#include "pindrive/series/series_mode.hpp"

namespace pindrive {

/// Quantity of a motion.
enum class Quantity : signed char { position, velocity, acceleration };

namespace detail {

/// Quantity along a segment, by its name.
template <class Trajectory>
std::decay_t<decltype(std::declval<Trajectory>().position())> quantity_of(const Trajectory& t,
                                                                          Quantity quantity) {
  if (quantity == Quantity::position) return t.position();
  return quantity == Quantity::velocity ? t.velocity() : t.acceleration();
}

/// Trajectory in closed form. Refers to the segment.
template <class T>
class ClosedForm {
 public:
  explicit ClosedForm(const Segment<T>& segment) : segment_(segment) {}

  const Path<T>& position() const { return segment_.flow.position; }
  const Path<T>& velocity() const { return segment_.flow.velocity; }
  Path<T> acceleration() const { return segment_.flow.acceleration(); }
  const Path<T>& plate_force() const { return segment_.plate_force; }
  const Path<T>& finger_force() const { return segment_.finger_force; }
  /// Of a segment without a length, or of a pin at rest.
  Path<T> slider_velocity() const { return {segment_.slider_velocity, T(0), T(0)}; }
  Path<T> input(const Curve<T>& curve) const { return curve.line(); }
  Path<T> above(Path<T> path, T level) const {
    path.start -= level;
    return path;
  }
  Path<T> above(Path<T> path, const Line<T>& line) const {
    path.drift -= line.rate;
    return above(path, line.value);
  }

  const Oscillator<T>& oscillator() const { return segment_.flow.oscillator; }
  T start(const Path<T>& path) const { return path.start; }
  T at(const Path<T>& path, T tau) const { return path.at(segment_.after(tau)); }
  /// An instant at which several quantities are evaluated.
  using Moment = Propagator<T>;
  Moment moment(T tau) const {
    return waves() && tau > 0 ? oscillator().after(tau) : Moment::still(tau);
  }
  T at(const Path<T>& path, const Moment& now) const { return path.at(now); }
  /// True if any quantity oscillates.
  bool waves() const {
    return position().oscillates() || velocity().oscillates() || plate_force().oscillates() ||
           finger_force().oscillates();
  }
  T change(const Path<T>& path, T tau) const { return path.change(segment_.after(tau)); }
  Path<T> derivative(const Path<T>& path) const { return path.derivative(oscillator()); }
  bool constant(const Path<T>& path) const { return path.constant(); }
  /// Bound of the terms of a path until τ.
  T terms(const Path<T>& path, T tau) const {
    return abs(path.start) + abs(path.value) + abs(path.drift) * tau;
  }
  /// Square of a rate that bounds all rates of the oscillation, 1/s².
  T hurry_squared() const { return oscillator().hurry_squared(); }

  int side_after_start(const Path<T>& path) const {
    return detail::side_after_start(oscillator(), path);
  }
  /// Calls visit(τ) at each sign change in (0, horizon], until visit returns false.
  template <class Visitor>
  void each_root(const Path<T>& path, int side, T horizon, Visitor&& visit) const {
    detail::each_root(oscillator(), path, side, horizon, visit);
  }
  T product_integral(const Path<T>& p, const Path<T>& q, T from, T to) const {
    return detail::product_integral(oscillator(), p, q, from, to);
  }

 private:
  const Segment<T>& segment_;
};

/// State with which a segment under functions begins, from its initial values.
template <class T>
SeriesState<T> start_of(const Drive<T>& drive, const Segment<T>& segment,
                        const SeriesMode<T>& mode) {
  const Path<T>& v = segment.flow.velocity;
  const T skin = mode.has_slider_state()
                     ? segment.slider_velocity
                     : -segment.finger_force.start - drive.finger.damping * v.start;
  return {segment.flow.position.start, v.start, skin, v.drift};
}

/// Trajectory of a segment under functions: the quantities of a `SeriesStep` or of a `DrivenMotion`.
template <class T, class Motion>
class MotionTrajectory {
 public:
  using Path = typename Motion::Path;

  const Path& position() const { return motion_.position; }
  const Path& velocity() const { return motion_.velocity; }
  Path acceleration() const { return motion_.velocity.derivative(); }
  const Path& plate_force() const { return plate_force_; }
  const Path& finger_force() const { return finger_force_; }
  /// Velocity of a slider that has one of its own, m/s.
  const Path& slider_velocity() const { return motion_.skin; }
  /// Sliding speed on the plate, with its transverse part, m/s.
  const Path& sliding_speed() const { return motion_.speed; }
  Path input(const Curve<T>& curve) const { return motion_.input(curve); }
  Path above(const Path& path, T level) const { return above(path, Line<T>{level, T(0)}); }
  Path above(Path path, const Line<T>& line) const {
    return path += Line<T>{-line.value, -line.rate};
  }

  T start(const Path& path) const { return path.start(); }
  T at(const Path& path, T tau) const { return path.at(tau); }
  struct Moment {
    T tau;
  };
  Moment moment(T tau) const { return {tau}; }
  T at(const Path& path, const Moment& now) const { return path.at(now.tau); }
  Path derivative(const Path& path) const { return path.derivative(); }
  bool constant(const Path& path) const { return path.constant(); }

 protected:
  MotionTrajectory(const Drive<T>& drive, const Mode& mode, const Motion& motion)
      : motion_(motion), plate_force_(motion.plate_force), finger_force_(motion.input({})) {
    const bool held = !held_by_stop(drive, mode), on_plate = mode.plate == ContactState::stick;
    if (on_plate && held) plate_force_ = motion_.stick_force;
    if (mode.finger == ContactState::elastic_stick)
      finger_force_ = T(-1) * motion_.skin + (-drive.finger.damping) * motion_.velocity;
    else if (mode.finger == ContactState::stick && held && !on_plate)
      finger_force_ = motion_.stick_force;
  }

  Motion motion_;
  Path plate_force_, finger_force_;
};

/// Trajectory of a segment that is one step of a series.
template <class T>
class BySeries : public MotionTrajectory<T, SeriesStep<T>> {
 public:
  /// Expands the series anew from the begin of the segment; only the initial state is stored.
  BySeries(const Drive<T>& drive, const Segment<T>& segment, const InputCurves<T>& lines)
      : BySeries(drive, segment, lines, expand(drive, segment, lines)) {}
  /// The step by which the segment was simulated.
  BySeries(const Drive<T>& drive, const Segment<T>& segment, const InputCurves<T>& lines,
           const SeriesStep<T>& step)
      : MotionTrajectory<T, SeriesStep<T>>(drive, segment.mode, step) {
    if (is_slip(segment.mode.finger))
      this->finger_force_ = of_finger(drive, segment.mode, lines.finger_load);
  }

  /// Calls visit(begin, length, expand) with each part of the segment until `to` in which quantities are
  /// polynomials, as which expand(quantity) returns them, until visit returns false: one part.
  template <class Visitor>
  void each_part(T to, Visitor&& visit) const {
    visit(T(0), plain(to), [](const Polynomial<T>& p) { return p; });
  }
  T largest_size(const Polynomial<T>& p) const { return detail::largest_size(p); }
  T change(Polynomial<T> p, T tau) const {
    p.c[0] = T(0);
    return p.at(tau);
  }
  T terms(const Polynomial<T>& p, T) const { return p.size(); }
  T hurry_squared() const { return T(1) / (motion_.span() * motion_.span()); }

  int side_after_start(const Polynomial<T>& p) const {
    for (const T c : p.c)
      if (c != 0) return c > 0 ? 1 : -1;
    return 0;
  }
  template <class Visitor>
  void each_root(const Polynomial<T>& p, int side, T horizon, Visitor&& visit) const {
    sign_changes(p, side, [&](T tau) { return tau <= horizon && visit(tau); });
  }
  T product_integral(const Polynomial<T>& p, const Polynomial<T>& q, T from, T to) const {
    return gauss<T>([&](T tau) { return p.at(tau) * q.at(tau); }, from, to);
  }

 private:
  using MotionTrajectory<T, SeriesStep<T>>::motion_;

  static SeriesStep<T> expand(const Drive<T>& drive, const Segment<T>& segment,
                              const InputCurves<T>& lines) {
    const SeriesMode<T> mode(drive, segment.mode, lines);
    const SeriesState<T> start = start_of(drive, segment, mode);
    const T span = segment.end - segment.begin;
    const SeriesEquation<T> e = mode.equation();
    if (segment.eliminated == EliminatedPart::of_slider)
      if (const auto slow = slow_slider(e, start, span, true)) return *slow;
    if (segment.eliminated == EliminatedPart::of_inertia)
      if (const auto slow = overdamped(e, start, span, true)) return *slow;
    if (segment.eliminated == EliminatedPart::of_friction)
      for (const bool within_step : {true, false})
        if (const auto slow = creep(e, start, span, within_step)) return *slow;
    if (!e.held && e.side == 0 && follows_plate(e, start)) return carried_by_plate(e, start, span);
    return SeriesFlow<T>(e, start, span, true);
  }
  /// Friction of a rigid finger, or of slipping skin.
  Polynomial<T> of_finger(const Drive<T>& drive, const Mode& mode, const Curve<T>& given) const {
    const Branch<T> branch = drive.finger.branch(mode.finger_branch);
    const bool has_slider_state = SeriesMode<T>(drive, mode, {}).has_slider_state();
    const Polynomial<T> load = this->input(given);
    Polynomial<T> at_load_1 = branch.slope * (has_slider_state ? motion_.skin : motion_.velocity);
    at_load_1.c[0] += along(mode.finger, branch.intercept());
    if (!branch.linear()) at_load_1 += along(mode.finger, T(1)) * motion_.falling_at_finger;
    return T(-1) * load * at_load_1;
  }
};

/// Trajectory of a segment in closed form under functions.
template <class T>
class ByTerms : public MotionTrajectory<T, DrivenMotion<T>> {
 public:
  /// Computes the closed form anew; only the initial state is stored.
  ByTerms(const Drive<T>& drive, const Segment<T>& segment, const InputCurves<T>& lines)
      : ByTerms(drive, segment, lines, SeriesMode<T>(drive, segment.mode, lines)) {}

  template <class Visitor>
  void each_part(T to, Visitor&& visit) const {
    const auto reach = [&](Real<T> tau) {
      return std::min(this->motion_.reach(tau), this->finger_force_.from(tau).reach());
    };
    each_step(T(0), to, reach, [&](T from, T end) {
      const Real<T> length = plain(end - from);
      return goes_on(visit, from, length,
                     [&](const TermSum<T>& sum) { return sum.from(from).expanded(length); });
    });
  }
  T largest_size(const TermSum<T>& sum) const { return sum.size(lasts_); }
  T change(const TermSum<T>& sum, T tau) const { return sum.at(tau) - sum.at(T(0)); }
  T terms(const TermSum<T>& sum, T tau) const { return sum.size(tau); }
  T hurry_squared() const { return this->motion_.position.hurry_squared(); }

  /// Sign of the first Taylor coefficient that is not zero; a value within rounding is zero.
  int side_after_start(const TermSum<T>& sum) const {
    const Polynomial<T> p = sum.expanded(std::min(sum.reach(), plain(lasts_)));
    const T error = rounding<T> * sum.size(T(0));
    for (const T& c : p.c)
      if (abs(c) > (&c == p.c.data() ? error : T(0))) return c > 0 ? 1 : -1;
    return 0;
  }
  template <class Visitor>
  void each_root(const TermSum<T>& sum, int side, T horizon, Visitor&& visit) const {
    sign_changes(sum, side, T(0), horizon, horizon, visit);
  }
  T product_integral(const TermSum<T>& p, const TermSum<T>& q, T from, T to) const {
    T sum{0};
    const auto reach = [&](Real<T> tau) {
      return std::min(p.from(tau).reach(), q.from(tau).reach());
    };
    each_step(from, to, reach, [&](T low, T high) {
      sum += gauss<T>([&](T tau) { return p.at(tau) * q.at(tau); }, low, high);
      return true;
    });
    return sum;
  }

 private:
  ByTerms(const Drive<T>& drive, const Segment<T>& segment, const InputCurves<T>& lines,
          const SeriesMode<T>& mode)
      : MotionTrajectory<T, DrivenMotion<T>>(
            drive, segment.mode, DrivenMotion<T>(mode.equation(), start_of(drive, segment, mode))),
        lasts_(segment.end - segment.begin) {
    if (!is_slip(segment.mode.finger)) return;
    const Branch<T> branch = drive.finger.branch(segment.mode.finger_branch);
    this->finger_force_
        .add(-pindrive::along(segment.mode.finger, branch.intercept()), lines.finger_load)
        .add(-branch.slope * lines.finger_load.value, this->motion_.velocity);
  }

  T lasts_;
};

}  // namespace detail

}  // namespace pindrive
