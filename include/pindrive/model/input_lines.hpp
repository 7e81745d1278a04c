/// Inputs as lines, from an instant to the next breakpoint.
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive {

namespace detail {

/// True if a plate slides in the transverse direction and has a load, from this instant on.
template <class T>
bool slides_obliquely(const Line<T>& load, const Line<T>& across) {
  return (across.value != 0 || across.rate != 0) && (load.value != 0 || load.rate != 0);
}

}  // namespace detail

/// Inputs from an instant on, until the next breakpoint.
template <class T>
struct InputLines {
  Line<T> plate_velocity;           ///< v_p, m/s
  Line<T> plate_load{T(1), T(0)};   ///< >= 0
  Line<T> across_velocity{};        ///< w, m/s
  Line<T> force{};                  ///< external force, N
  Line<T> finger_load{T(1), T(0)};  ///< >= 0

  bool oblique() const { return detail::slides_obliquely(plate_load, across_velocity); }
  InputLines from(T tau) const {
    const auto later = [&](const Line<T>& line) { return Line<T>{line.at(tau), line.rate}; };
    return {later(plate_velocity), later(plate_load), later(across_velocity), later(force),
            later(finger_load)};
  }
  /// Inputs of a segment; the plate velocity is exactly that of the pin where known.
  static InputLines of(const Drive<T>& drive, const Inputs<T>& inputs, const Segment<T>& segment) {
    return {segment.plate_velocity, inputs.plate_load.from(segment.begin),
            across_from(inputs, segment.begin, segment.plate_velocity, held(drive, segment.mode)),
            inputs.force.from(segment.begin), inputs.finger_load.from(segment.begin)};
  }
  /// Transverse velocity from a time on. A velocity within rounding of both velocities is zero:
  /// close to zero the steps of a pin that comes to rest on the plate become short. If both
  /// velocities reach zero at the next breakpoint under a held pin, the time until then gives the
  /// better value.
  static Line<T> across_from(const Inputs<T>& inputs, T time, const Line<T>& along, bool held) {
    using std::abs;
    Line<T> line = inputs.across_velocity.from(time);
    const T rest = std::min(inputs.across_velocity.next_breakpoint(time),
                            inputs.mouse_velocity.next_breakpoint(time)) -
                   time;
    const T changes = time * (abs(line.rate) + abs(along.rate));
    if (held && along.rate != 0 &&
        abs(line.at(rest)) + abs(along.at(rest)) <= detail::difference_error<T> * changes)
      return {-line.rate * rest, line.rate};
    if (abs(line.value) <= detail::least_across<T> * (changes + abs(along.value)))
      line.value = T(0);
    return line;
  }
};

}  // namespace pindrive
