/// The core with the instances that the compiled engine holds.
///
/// A program that links the CMake target `pindrive::engine` declares these instances and links them;
/// without it, they are compiled where they are used. The files of `engine/` define them.
#pragma once

#include <cstddef>

#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/events/stepper.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/motion/crossings.hpp"
#include "pindrive/motion/duration.hpp"
#include "pindrive/motion/energy.hpp"
#include "pindrive/motion/sampling.hpp"
#include "pindrive/motion/steady_since.hpp"
#include "pindrive/motion/transient.hpp"
#include "pindrive/numbers/dual.hpp"

// Each list takes a number type, and `extern` to declare its instances or nothing to define them.
// NOLINTBEGIN(bugprone-macro-parentheses): a keyword has none

#define PINDRIVE_ENGINE_SIMULATION(T, declared)      \
  declared template struct InputPiece<T>;            \
  declared template class detail::TermSum<T>;        \
  declared template class detail::SeriesFlow<T>;     \
  declared template class detail::CreepFlow<T>;      \
  declared template class detail::OverdampedFlow<T>; \
  declared template class detail::SlowSliderFlow<T>; \
  declared template class detail::DrivenMotion<T>;   \
  declared template class detail::SeriesMode<T>;     \
  declared template class detail::SeriesSegment<T>;  \
  declared template class detail::BySeries<T>;       \
  declared template class detail::ByTerms<T>;        \
  declared template class detail::Selection<T>;      \
  declared template class detail::Evolution<T>;      \
  declared template class detail::CycleDetector<T>;  \
  declared template class Stepper<T>;                \
  declared template Outcome<T> simulate(const Drive<T>&, const Inputs<T>&, SegmentSink<T>);

#define PINDRIVE_ENGINE_MOTION(T, declared)                                         \
  declared template Transient<T> transient_of(const Motion<T>&, T, T, GoOn);        \
  declared template T duration_of(const Motion<T>&, T, GoOn);                       \
  declared template T steady_since(const Motion<T>&, GoOn);                         \
  declared template Ledger<T> energy_ledger(const Motion<T>&, T, GoOn);             \
  declared template T start_acceleration(const Motion<T>&, const Segment<T>&);      \
  declared template T sampled_in(const Motion<T>&, const Segment<T>&, T, Sampled);  \
  declared template T sampled_now(const Stepper<T>&, Sampled);                      \
  declared template void sample(const Motion<T>&, const double*, std::size_t, Side, \
                                const Sampled*, std::size_t, Callback<std::size_t, const T*>);

#define PINDRIVE_ENGINE_SEARCH(T, declared)                                                    \
  declared template T acceleration_bound(const Motion<T>&, const Segment<T>&);                 \
  declared template void crossings(const Motion<T>&, Quantity, T, T, Callback<T, int>, GoOn);  \
  declared template void extrema(const Motion<T>&, Quantity, T, Callback<T, T>, GoOn);         \
  declared template void events(const Motion<T>&, T, T, Callback<T, const Segment<T>&>, GoOn); \
  declared template Certificate<T> certify(const Motion<T>&, T, GoOn);

// NOLINTEND(bugprone-macro-parentheses)

#ifdef PINDRIVE_COMPILED
namespace pindrive {
PINDRIVE_ENGINE_SIMULATION(double, extern)
PINDRIVE_ENGINE_SIMULATION(Dual<double>, extern)
PINDRIVE_ENGINE_MOTION(double, extern)
PINDRIVE_ENGINE_MOTION(Dual<double>, extern)
PINDRIVE_ENGINE_SEARCH(double, extern)
}  // namespace pindrive
#endif
