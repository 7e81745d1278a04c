/// What the event loop needs of a segment whose mode has no closed form: a step of its series.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/friction.hpp"
#include "pindrive/limits.hpp"
#include "pindrive/model.hpp"
#include "pindrive/series_mode.hpp"

namespace pindrive::detail {

/// The step of a series that the present segment is; none where its mode has a closed form.
template <class T>
class SeriesSegment {
 public:
  bool used() const { return used_; }

  /// Begins a segment of a mode (that, its begin and its plate velocity are set) if it has no closed form;
  /// whether it has none. Its flow says where it begins. `at_limit` is the side on which a stick force is at
  /// its limit, `span` the time until the next row, s.
  template <class Side>
  bool begin(Segment<T>& segment, const Drive<T>& drive, const Side& plate, const Side& finger,
             const State<T>& state, T acceleration, int at_limit, T span) {
    const SeriesMode<T> mode(drive, segment.mode, {plate.surface, plate.load});
    used_ = !mode.has_closed_form();
    if (!used_) return false;
    step_ = SeriesFlow<T>(mode.equation(), {state.x, state.v, state.skin, acceleration}, span);
    guards_ = mode.guards(step_, {plate.does.at, finger.does.at, at_limit});
    const T stick = step_.stick_force.c[0];
    const T of_plate = plate.stuck() ? stick : plate.force(state);
    const T of_finger = !finger.stuck() ? finger.force(state) : plate.stuck() ? T(0) : stick;
    segment.flow = {{}, {state.x, T(0), T(0)}, {step_.velocity.c[0], T(0), T(0)}};
    segment.plate_force = {of_plate, T(0), T(0)};
    segment.finger_force = {of_finger, T(0), T(0)};
    return true;
  }

  /// The time to the earliest event, the end of the step or the row; what happens at the row to the rounding
  /// of a time happens there.
  T earliest(T since, T row) const {
    const auto* guard = guards_.earliest();
    const T first = guard != nullptr ? guard->zero : T(step_.span());
    return row - first <= rounding<T> * (since + row) ? row : first;
  }

  /// Brings the state on by τ.
  void move(State<T>& state, bool elastic, T tau) const {
    using std::abs;
    const SeriesState<T> now = step_.at(tau);
    state.x = now.x;
    state.v = now.v;
    state.x_size = std::max(state.x_size, abs(state.x));
    if (elastic) state.skin = now.skin;
  }

  template <class Visitor>
  void each_guard(Visitor&& visit) const {
    for (const auto& guard : guards_) visit(guard);
  }

 private:
  bool used_{false};
  SeriesStep<T> step_;
  typename SeriesMode<T>::Guards guards_;
};

/// Contacts without friction curves have closed forms only.
struct NoSeries {};

}  // namespace pindrive::detail
