/// Every limit that is not physics, in one place, with its reason.
#pragma once

#include <limits>

namespace pindrive {

namespace detail {

/// Numbers that differ by this part of what they are sums of are one: a force, a rate or a time is
/// the sum of some eight terms, each rounded by half an epsilon.
template <class T>
inline constexpr T rounding = 4 * std::numeric_limits<T>::epsilon();

/// Skin that has no first mode as its load grows from zero grips first after this part of the time of the next
/// row, for each of the rounds that its load grows by a half in: some roundings of a time.
template <class T>
inline constexpr T first_grip = 64 * rounding<T>;

/// Events at one instant after which a motion is given up. Physics has two or three (a contact breaks
/// away, another follows, a breakpoint is passed); more would never end.
inline constexpr int standstill_limit = 100;

/// Distance within which a state is the same as one before, as a part of the natural scales of the motion: well
/// above the rounding of the events of one period.
inline constexpr double return_tolerance = 1e-12;

/// Distance below which returns are followed from one to the next, as a part of the natural scales.
inline constexpr double near_return = 1e-3;

/// Bound of the distance between a cycle that is approached geometrically and the simulated period that stands
/// for it, and largest difference between begin and end of that period, as parts of the natural scales.
inline constexpr double approach_tolerance = 1e-9, approach_step = 1e-10;

/// Difference between a motion and its periodic continuation from its steady begin on, as a part of the
/// amplitude. It is larger than `approach_tolerance`, so that the simulated period itself is steady.
inline constexpr double repeat_tolerance = 1e-8;

/// Events in a window whose duration is compared, and windows after which a motion that neither
/// returns, nor grows, nor decays is irregular: 15 360 events, some ten milliseconds. Many numbers of events in a
/// round divide the window, so that the windows of a motion that decays are alike.
inline constexpr int irregular_window = 240, irregular_windows = 64;

/// Speed below which a pin is at rest, as a part of |x| ω0: below what a decay leaves of the digits of the
/// position (MODEL, section 10).
inline constexpr double rest_tolerance = 3e-11;

/// Error of the band of the settling time, as a part of the largest position: that of a sum of some dozens of
/// roundings; and what a pin that rests by the rest criterion would still have moved, `rest_tolerance` times the
/// ratio of its fastest and slowest rates.
template <class T>
inline constexpr T band_error = 16 * rounding<T>;
inline constexpr double band_error_at_rest = 64 * rest_tolerance;

/// So much of a radian before the end of a segment, what is there to rounding is at the end: the velocity
/// at an event is set exactly, and its closed form comes to zero a little sooner or later.
inline constexpr double at_end = 1e-6;

}  // namespace detail

/// Events after which a motion is given up: friction and damping are too weak to end it, and its
/// segments would fill the memory.
inline constexpr long long event_limit = 1'000'000;

}  // namespace pindrive
