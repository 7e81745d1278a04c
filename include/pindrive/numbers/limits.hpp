/// Limits and tolerances that are not physics, each with its reason and a test that fails without it:
/// a test of tests/cpp, `fuzz` with 100 000 drives, or `fuzz --replay` of tests/hard.
#pragma once

#include <limits>

namespace pindrive {

namespace detail {

/// Relative error of a sum: a force, a rate or a time is the sum of some eight terms, each rounded
/// by half an epsilon. Without it: limits_test fails.
template <class T>
inline constexpr T rounding = 4 * std::numeric_limits<T>::epsilon();

/// Relative error of a root, at which Newton's iteration ends. Without it: fuzz --replay fails.
template <class T>
inline constexpr T root_error = 2 * std::numeric_limits<T>::epsilon();
/// Relative change of an iteration at its fixed point: its last digit. Without it: slow_slider_test
/// fails.
template <class T>
inline constexpr T last_digit = std::numeric_limits<T>::epsilon();

/// Relative last step of Newton's iteration from which on it converges quadratically.
inline constexpr double near_root = 1e-5;

/// Relative error of the difference of two computed values: of two positions, of two friction
/// forces of one sliding speed, of two velocities that reach zero together. Without it: fuzz
/// --replay fails.
template <class T>
inline constexpr T difference_error = 4 * rounding<T>;

/// Relative transverse velocity below which an oblique plate moves along the axis: closer to zero
/// the steps of a pin that comes to rest on the plate become short. Without it: fuzz --replay
/// fails.
template <class T>
inline constexpr T least_across = 64 * rounding<T>;

/// Relative time before a breakpoint at which an oblique plate comes to rest, within which an event
/// belongs to the breakpoint: the sliding direction under a held pin is undetermined there. Without
/// it: fuzz --replay fails.
template <class T>
inline constexpr T before_rest = 128 * rounding<T>;

/// Relative time of the first stick of skin that has no first mode as its load grows from zero:
/// some time resolutions, for each period in which the load grows by a half. Without it: fuzz
/// --replay fails.
template <class T>
inline constexpr T first_grip = 64 * rounding<T>;

/// Events at one instant after which a motion is terminated. Physics has two or three (a contact
/// slips, a second one follows, a breakpoint is passed); more would never end. Without it:
/// limits_test fails.
inline constexpr int standstill_limit = 100;

/// Index of the first event whose state is kept for comparison: most motions come to rest after few.
/// Without it: recurrence_test fails.
inline constexpr long long first_kept_event = 3;
/// Events after which the recent kept state is renewed, so that a short period is found soon.
/// Without it: recurrence_test fails.
inline constexpr long long short_memory = 32;

/// Distance within which two states are equal, as a fraction of the natural scales of the motion:
/// well above the rounding of the events of one period. Without it: recurrence_test fails.
inline constexpr double return_tolerance = 1e-12;

/// Distance below which a return is compared with the next return, as a fraction of the natural
/// scales. Without it: recurrence_test fails.
inline constexpr double near_return = 1e-3;

/// Bound of the distance between a geometrically approached cycle and the simulated period that
/// represents the cycle, and largest difference between begin and end of that period, as fractions
/// of the natural scales. Without it: recurrence_test fails.
inline constexpr double approach_tolerance = 1e-9, approach_step = 1e-10;

/// Difference between a motion and its periodic continuation from its steady begin on, as a
/// fraction of the amplitude; larger than `approach_tolerance`, so that the simulated period itself
/// is steady. Without it: steady_since_test fails.
inline constexpr double repeat_tolerance = 1e-8;

/// Events in a window whose duration is compared, and windows after which a motion that neither
/// returns, nor grows, nor decays is irregular: 15 360 events, some ten milliseconds. Many numbers
/// of events per period divide the window, so that the windows of a decaying motion are alike.
/// Without it: irregularity_test fails.
inline constexpr int irregular_window = 240, irregular_windows = 64;
/// Periods of the inputs in a window: with the pauses between windows, 5700 periods in all. Without it:
/// irregularity_test fails.
inline constexpr int irregular_periods = 60;

/// Events in a block whose range is compared with that of the block before, blocks after which a change in one
/// direction is a trend, and periods after which a motion by series without an ending is terminated: a second or two,
/// or some seconds while the motion approaches a limit that it would reach in that time. Without it: trend_test fails.
inline constexpr int trend_block = 640, trend_blocks = 7;
inline constexpr double period_limit = 50'000, approach_limit = 200'000;

/// Speed below which a pin is at rest, as a fraction of |x| ω0: below the remaining digits of the
/// position in a decay (MODEL, section 10). Without it: endings fails.
inline constexpr double rest_tolerance = 3e-11;

/// Error of the band of the settling time, as a fraction of the largest position: a sum of some
/// dozens of roundings; and the remaining motion of a pin at rest by the rest criterion,
/// `rest_tolerance` times the ratio of its fastest and slowest rates. Without it: settling_test
/// fails.
template <class T>
inline constexpr T band_error = 16 * rounding<T>;
inline constexpr double band_error_at_rest = 64 * rest_tolerance;

/// Angle (rad) before the end of a segment within which a position belongs to the end: the velocity
/// at an event is set exactly, and its closed form reaches zero slightly earlier or later. Without
/// it: crossings_test fails.
inline constexpr double at_end = 1e-6;

/// Relative time before the end of a segment within which a turning point belongs to the next
/// segment. Without it: transient_test fails.
inline constexpr double turning_at_end = 1e-9;

// ---- series ------------------------------------------------------------------------------------

/// Relative truncation error of a step of a series, and of the terms that are removed from it:
/// together less than one rounding. Without it: fuzz --replay fails.
template <class T>
inline constexpr T truncation_error = std::numeric_limits<T>::epsilon() / 4;
template <class T>
inline constexpr T removed_terms = std::numeric_limits<T>::epsilon() / 8;
/// Relative truncation error of an accepted step, beside the coefficients of the step; and of the
/// motion in which friction or a slider is eliminated, whose equations are solved by iteration.
/// Without the first fuzz --replay fails; without the second it does not end.
template <class T>
inline constexpr T step_error = 2 * std::numeric_limits<T>::epsilon();
template <class T>
inline constexpr T eliminated_error = 2 * rounding<T>;
/// Error of a sliding direction, rad, above which a step of an oblique slip is rejected; and relative
/// velocity beside creep above which the pin does not creep. Without it: fuzz fails.
template <class T>
inline constexpr T direction_error = 16 * rounding<T>;
/// Largest error of the creep velocity close to the friction limit, as a fraction of the pin
/// velocity. Without it: fuzz fails.
template <class T>
inline constexpr T creep_error = 1024 * rounding<T>;
/// Time, in units of √(m/k), for which the plate takes along a pin at its friction limit where a stroke begins: the
/// motion has no power series there. Without it: fuzz --family strokes fails.
inline constexpr double carried_time = 1e-10;
/// Largest angle by which friction turns while the plate takes a pin along, rad. Without it: fuzz --replay fails.
inline constexpr double turned_by_carrying = 0.01;
/// Longest step of a series in units of its fastest time constant, even at rest: rounding of the
/// start then remains rounding. Without it: series_test fails.
inline constexpr double longest_step = 8;
/// Longest step in units of the fastest time constant of the inputs: terms beyond order 24 are then
/// below 2e-17 of theirs.
inline constexpr double longest_input = 2;
/// Time constants after which a term of an input is over: rounding of its amplitude remains, and
/// decides where nothing else moves a plate. Without it: fuzz --replay fails.
inline constexpr double term_duration = 34.7;
/// Size of the parts of a motion in closed form under functions over that of the motion, and its shortest duration
/// in steps of a series. Beyond, or below, the motion is expanded in series. Without it: driven_motion_test fails.
inline constexpr double most_cancelled = 32;
inline constexpr double shortest_driven = 2;
/// Factor between tried and used step of a series; the powers of the step must be finite. Without
/// it: fuzz fails.
inline constexpr double farthest_step = 1024;
/// Reductions of a step before its truncation error is accepted as it is. Without it: series_test
/// fails.
inline constexpr int most_reductions = 200;
/// Factor by which a step of slow motion is shortened until its iteration converges. Without it:
/// slow_slider_test fails.
inline constexpr double step_reduction = 0.75;
/// Taylor steps that a step of creep replaces at least where it is tried: each of its 7 to 15 iterations costs as much
/// as one. Saves a sixth of the time under a free hand, and changes no result.
inline constexpr double creep_steps = 8;
/// Iterations and reductions of a step of slow motion before the Taylor series of the whole motion
/// is used instead. Without it: creep_test, slow_slider_test fails.
inline constexpr int slow_iterations = 24, slow_reductions = 40;
/// Largest ratio t = (x' − v_p)/w of creep: closer to the friction limit the boundary layer is
/// never thin. Saves 6 % of the time under oblique hands, and changes no result.
inline constexpr double steepest_creep = 1e4;

// ---- stepper -----------------------------------------------------------------------------------

/// Periods, in units of 1/ω0, after which a stepper selects its mode again under inputs that
/// change: a double still resolves the time of an event. Without it: stepper_test fails.
inline constexpr double longest_segment = 1e6;

// ---- kernel ------------------------------------------------------------------------------------

/// Relative difference below which the kernel leaves a decision to the general core: a thousand
/// times the accumulated rounding of the evaluated half periods. Without it: plain_release_test
/// fails.
inline constexpr double near_tie = 1e-12;
/// Smallest distance of an extremum of the velocity from the plate velocity, relative to the latter:
/// closer, the time of the event has less than half of the digits. Without it: kernel_test fails.
inline constexpr double near_grazing = 1e-9;
/// Smallest 1 − ζ² in the kernel: closer to critical damping the sine of a half period loses digits.
/// Without it: kernel_test fails.
inline constexpr double least_discriminant = 0.02;
/// Relative change of an angle after which the kernel's iteration of order 4 ends: its next change
/// is below the rounding. Without it: oscillation_test fails.
inline constexpr double last_change = 1e-4;
/// Half periods evaluated by the kernel; each costs a few operations, of a whole pack if one drive
/// needs it. Without it: kernel_test fails.
inline constexpr int most_half_turns = 4096;
/// Rounds evaluated by the kernel before a release is left to the general core. Without it:
/// kernel_test fails.
inline constexpr int most_rounds = 1 << 18;

}  // namespace detail

/// Events after which a motion is terminated: friction and damping are too weak to end the motion,
/// and its segments would fill the memory. Without it: limits_test fails.
inline constexpr long long event_limit = 1'000'000;

}  // namespace pindrive
