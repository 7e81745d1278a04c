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

/// How closely a state returns in a cycle, as a part of its size: a hundred roundings, which is what
/// the events of one round leave; and by how much more for each round before, since without damping the
/// rounding of the rounds adds up.
inline constexpr double return_tolerance = 1e-14, return_tolerance_per_round = 1e-15;

/// So much of a radian before the end of a segment, what is there to rounding is at the end: the velocity
/// at an event is set exactly, and its closed form comes to zero a little sooner or later.
inline constexpr double at_end = 1e-6;

}  // namespace detail

/// Events after which a motion is given up: friction and damping are too weak to end it, and its
/// segments would fill the memory.
inline constexpr long long event_limit = 1'000'000;

}  // namespace pindrive
