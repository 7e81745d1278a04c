/// Quantities of a motion, or of a stepper, at given times.
#pragma once

#include <cstddef>
#include <limits>
#include <type_traits>

#include "pindrive/events/stepper.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/motion/skin_along.hpp"
#include "pindrive/numbers/callback.hpp"

namespace pindrive {

/// Quantity of a motion at a time.
enum class Sampled : signed char {
  position,      ///< m
  velocity,      ///< m/s
  acceleration,  ///< m/s²
  plate_force,   ///< friction of the plate on the pin, N
  finger_force,  ///< friction of the finger on the pin, N
  stretch,       ///< skin stretch of a compliant finger, m
  stretch_rate,  ///< m/s
  housing_force,  ///< force of the pin on the housing and the finger by spring, damper, skin and stops, N
  stop_force  ///< force of the end stops on the pin, N
};
inline constexpr std::size_t sampled_count = 9;

namespace detail {

/// Value of a quantity after τ along a trajectory of a segment; lines() returns the inputs from the begin
/// of the segment.
template <class Trajectory, class T, class Lines>
T sampled_along(const Trajectory& along, const Drive<T>& drive, const Segment<T>& segment,
                Lines&& lines, T tau, Sampled quantity) {
  const auto at = [&](const auto& path) { return along.at(path, tau); };
  switch (quantity) {
    case Sampled::position:
      return drive.stops.within(at(along.position()));
    case Sampled::velocity:
      return at(along.velocity());
    case Sampled::acceleration:
      return at(along.acceleration());
    case Sampled::plate_force:
      return friction_along(along, drive, segment, lines, tau).plate;
    case Sampled::finger_force:
      return friction_along(along, drive, segment, lines, tau).finger;
    case Sampled::stretch:
      return -at(detail::stretch_force_along(drive, segment, along)) / drive.finger.stiffness;
    case Sampled::stretch_rate:
      return at(detail::stretch_rate_along(drive, segment, along));
    case Sampled::housing_force:
      return drive.stiffness * drive.stops.within(at(along.position())) +
             drive.damping * at(along.velocity()) -
             friction_along(along, drive, segment, lines, tau).finger -
             stop_force_along(along, drive, segment, lines().force, tau);
    case Sampled::stop_force:
      return stop_force_along(along, drive, segment, lines().force, tau);
  }
  return std::numeric_limits<T>::quiet_NaN();
}

}  // namespace detail

/// Calls visit(i, values) with the values of `count` quantities at each of the times (s, in
/// [0, motion.known_until()]), until visit returns false. At an event, `side` selects the limit.
///
/// Times in a row that lie in one segment share its trajectory.
template <class T>
void sample(const Motion<T>& motion, const double* times, std::size_t time_count, Side side,
            const Sampled* quantities, std::size_t count,
            detail::Given<Callback<std::size_t, const T*>> visit) {
  T values[sampled_count];
  const auto place = [&](std::size_t i) { return motion.locate(T(times[i]), side); };
  for (std::size_t i = 0; i < time_count;) {
    auto here = place(i);
    const Segment<T>& segment = *here.segment;
    const bool more = motion.along(segment, [&](const auto& along) {
      const auto lines = [&] {
        return InputCurves<T>::of(motion.drive(), motion.inputs(), segment);
      };
      do {
        for (std::size_t k = 0; k < count; ++k)
          values[k] =
              detail::sampled_along(along, motion.drive(), segment, lines, here.tau, quantities[k]);
        if (!visit(i, values)) return false;
        if (++i < time_count) here = place(i);
      } while (i < time_count && here.segment == &segment);
      return true;
    });
    if (!more) return;
  }
}

/// Returns the value of a quantity after τ (s) in a segment.
template <class T>
T sampled_in(const Motion<T>& motion, const Segment<T>& segment, T tau, Sampled quantity) {
  return motion.along(segment, [&](const auto& along) {
    const auto lines = [&] { return InputCurves<T>::of(motion.drive(), motion.inputs(), segment); };
    return detail::sampled_along(along, motion.drive(), segment, lines, tau, quantity);
  });
}

/// Returns the acceleration at the begin of a segment, m/s².
template <class T>
T start_acceleration(const Motion<T>& motion, const Segment<T>& segment) {
  return motion.along(segment, [](const auto& along) { return along.start(along.acceleration()); });
}

/// Returns a bound of |acceleration| in a segment under functions or by series, m/s²; NaN for a segment in
/// closed form.
template <class T>
T acceleration_bound(const Motion<T>& motion, const Segment<T>& segment) {
  return motion.along(segment, [](const auto& along) -> T {
    if constexpr (std::is_same_v<std::decay_t<decltype(along)>, detail::ClosedForm<T>>)
      return std::numeric_limits<T>::quiet_NaN();
    else
      return along.largest_size(along.acceleration());
  });
}

/// Returns the present value of a quantity of a stepper.
template <class T>
T sampled_now(const Stepper<T>& stepper, Sampled quantity) {
  const InputCurves<T> now = stepper.lines();
  return visit_trajectory(stepper.drive(), stepper.segment(), now, stepper.series_step(),
                          [&](const auto& along) {
                            return detail::sampled_along(
                                along, stepper.drive(), stepper.segment(), [&] { return now; },
                                stepper.tau(), quantity);
                          });
}

}  // namespace pindrive
