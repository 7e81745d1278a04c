/// Progress of a standard release from one round of the kernel to the next.
#pragma once

#include "pindrive/kernel/kernel_numbers.hpp"
#include "pindrive/kernel/kernel_settling.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// State of a release at the start of a round, mirrored so that the plate moves forward.
template <class V>
struct Standing {
  V position, velocity, time;  ///< m, m/s, s
  V time_error;                ///< rounding error of the time, s
  V released;                  ///< 1 after stick on the plate, else 0

  explicit Standing(const ForwardRelease<V>& r)
      : position(r.start), velocity(r.start_velocity), time(0.0), time_error(0.0), released(0.0) {}
  template <class F>
  void columns(const F& f) {
    f(position), f(velocity), f(time), f(time_error), f(released);
  }
  static constexpr int column_count = 5;
};

/// Complete progress at the start of a round. `Measured`: with its numbers.
template <class V, bool Measured>
struct Progress {
  Standing<V> standing;
  explicit Progress(const ForwardRelease<V>& r) : standing(r) {}
  template <class F>
  void columns(const F& f) {
    standing.columns(f);
  }
  static constexpr int column_count = Standing<V>::column_count;
};
template <class V>
struct Progress<V, true> {
  Standing<V> standing;
  TransientNumbers<V> numbers;
  KernelSettling<V> settling;
  explicit Progress(const ForwardRelease<V>& r) : standing(r), numbers(r) {}
  template <class F>
  void columns(const F& f) {
    standing.columns(f);
    numbers.columns(f);
    settling.columns(f);
  }
  static constexpr int column_count = Standing<V>::column_count +
                                      TransientNumbers<V>::column_count +
                                      KernelSettling<V>::column_count;
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
