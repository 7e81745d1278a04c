/// Inputs from an instant to the next breakpoint.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

namespace detail {

/// True if a plate slides in the transverse direction and has a load, from this instant on.
template <class T>
bool slides_obliquely(const Curve<T>& load, const Curve<T>& across) {
  return !across.is_zero() && !load.is_zero();
}

}  // namespace detail

/// Inputs from an instant on, until the next breakpoint.
template <class T>
struct InputCurves {
  Curve<T> plate_velocity;           ///< v_p, m/s
  Curve<T> plate_load{T(1), T(0)};   ///< >= 0
  Curve<T> across_velocity{};        ///< w, m/s
  Curve<T> force{};                  ///< external force, N
  Curve<T> finger_load{T(1), T(0)};  ///< >= 0

  bool oblique() const { return detail::slides_obliquely(plate_load, across_velocity); }
  InputCurves from(T tau) const {
    return {plate_velocity.from(tau), plate_load.from(tau), across_velocity.from(tau),
            force.from(tau), finger_load.from(tau)};
  }
  /// Inputs of a segment; the plate velocity is exactly that of the pin where known.
  static InputCurves of(const Drive<T>& drive, const Inputs<T>& inputs, const Segment<T>& segment) {
    return {segment.plate_velocity, inputs.plate_load.from(segment.begin),
            across_from(inputs, segment.begin, segment.plate_velocity, held(drive, segment.mode)),
            inputs.force.from(segment.begin), inputs.finger_load.from(segment.begin)};
  }
  /// Returns the transverse velocity from a time on.
  ///
  /// A transverse velocity that is smaller than the rounding of both components is set to zero: close to zero the steps
  /// of a pin that comes to rest on the plate become short. If both components of a held pin's plate reach zero at the
  /// next breakpoint, the value follows from the time until then, which is more accurate.
  static Curve<T> across_from(const Inputs<T>& inputs, T time, const Curve<T>& along, bool held) {
    using std::abs;
    Curve<T> line = inputs.across_velocity.from(time);
    const T rest = std::min(inputs.across_velocity.next_breakpoint(time),
                            inputs.mouse_velocity.next_breakpoint(time)) -
                   time;
    const T changes = time * (abs(line.rate) + abs(along.rate));
    // rounding: tests/hard/plate-rest-in-both-directions-with-reversing-axis.txt
    if (held && along.rate != 0 && along.straight() && line.straight() &&
        abs(line.at(rest)) + abs(along.at(rest)) <= detail::difference_error<T> * changes)
      return {-line.rate * rest, line.rate};
    // rounding: two functions, or a function and a line, may reach zero at the same time. Setting one of them to zero
    // before would turn the sliding direction (tests/hard/oblique-plate-stops-as-a-function-turns.txt).
    const T there = abs(along.value * line.rate - along.rate * line.value);
    const int lines = int(line.straight()) + int(along.straight());
    const bool together =
        lines < (held ? 2 : 1) && there <= detail::least_across<T> * changes * abs(line.rate);
    const T beside = together ? T(0) : changes;
    if (abs(line.value) <= detail::least_across<T> * (beside + abs(along.value))) line.value = T(0);
    if (line.straight()) return line;
    // rounding: tests/hard/oblique-plate-touches-rest-at-two-frequencies.txt, and fuzz 1
    if (touches_zero(line, time)) line.value = line.rate = T(0);
    if (along.value == 0 && passes_zero(along, line, time)) line.value = T(0);
    return line;
  }
  /// rounding: makes exact that a plate turns back, or comes to rest, on a path. Both its velocities are zero within
  /// rounding, of which no direction follows (tests/hard/oblique-plate-turns-back-in-a-stroke.txt).
  static void stop_at_rest(Curve<T>& along, const Curve<T>& across, T time) {
    if (across.straight()) return;
    if (passes_zero(along, across, time)) along.value = T(0);
    if (touches_zero(along, time) && touches_zero(across, time)) along.value = along.rate = T(0);
  }

 private:
  /// Time of which an input has the rounding, s: sinusoids have that of their phase.
  [[gnu::noinline]] static T resolved(const Curve<T>& input, T time) {
    const auto fastest = T(input.fastest());
    return fastest > 0 ? time + 1 / fastest : time;
  }
  /// True if both velocities are zero within the resolution of time
  /// (rounding: tests/hard/oblique-plate-passes-zero-within-time-resolution.txt).
  static bool passes_zero(const Curve<T>& along, const Curve<T>& across, T time) {
    using std::abs;
    return abs(along.value) + abs(across.value) <=
           detail::difference_error<T> * (abs(along.rate) + abs(across.rate)) *
               std::max(resolved(along, time), resolved(across, time));
  }
  static bool touches_zero(const Curve<T>& input, T time) {
    using std::abs;
    if (input.straight()) return input.is_zero();
    const T error = input.rounding(), turns = detail::least_across<T> * time * abs(input.second());
    return abs(input.value) <= error && abs(input.rate) <= error * input.fastest() + turns;
  }
};

}  // namespace pindrive
