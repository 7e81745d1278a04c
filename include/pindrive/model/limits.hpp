/// Limits and tolerances that are not physics, each with its reason.
#pragma once

#include <limits>

namespace pindrive {

namespace detail {

/// Relative error of a sum: a force, a rate or a time is the sum of some eight terms, each rounded
/// by half an epsilon.
template <class T>
inline constexpr T rounding = 4 * std::numeric_limits<T>::epsilon();

/// Relative time of the first stick of skin that has no first mode as its load grows from zero:
/// some time resolutions, for each period in which the load grows by a half.
template <class T>
inline constexpr T first_grip = 64 * rounding<T>;

/// Events at one instant after which a motion is terminated. Physics has two or three (a contact
/// slips, a second one follows, a breakpoint is passed); more would never end.
inline constexpr int standstill_limit = 100;

/// Distance within which two states are equal, as a fraction of the natural scales of the motion:
/// well above the rounding of the events of one period.
inline constexpr double return_tolerance = 1e-12;

/// Distance below which a return is compared with the next return, as a fraction of the natural
/// scales.
inline constexpr double near_return = 1e-3;

/// Bound of the distance between a geometrically approached cycle and the simulated period that
/// represents the cycle, and largest difference between begin and end of that period, as fractions
/// of the natural scales.
inline constexpr double approach_tolerance = 1e-9, approach_step = 1e-10;

/// Difference between a motion and its periodic continuation from its steady begin on, as a
/// fraction of the amplitude; larger than `approach_tolerance`, so that the simulated period itself
/// is steady.
inline constexpr double repeat_tolerance = 1e-8;

/// Events in a window whose duration is compared, and windows after which a motion that neither
/// returns, nor grows, nor decays is irregular: 15 360 events, some ten milliseconds. Many numbers
/// of events per period divide the window, so that the windows of a decaying motion are alike.
inline constexpr int irregular_window = 240, irregular_windows = 64;

/// Speed below which a pin is at rest, as a fraction of |x| ω0: below the remaining digits of the
/// position in a decay (MODEL, section 10).
inline constexpr double rest_tolerance = 3e-11;

/// Error of the band of the settling time, as a fraction of the largest position: a sum of some
/// dozens of roundings; and the remaining motion of a pin at rest by the rest criterion,
/// `rest_tolerance` times the ratio of its fastest and slowest rates.
template <class T>
inline constexpr T band_error = 16 * rounding<T>;
inline constexpr double band_error_at_rest = 64 * rest_tolerance;

/// Angle (rad) before the end of a segment within which a position belongs to the end: the velocity
/// at an event is set exactly, and its closed form reaches zero slightly earlier or later.
inline constexpr double at_end = 1e-6;

}  // namespace detail

/// Events after which a motion is terminated: friction and damping are too weak to end the motion,
/// and its segments would fill the memory.
inline constexpr long long event_limit = 1'000'000;

}  // namespace pindrive
