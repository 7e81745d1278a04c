/// Samples of a steady motion and of its last period: a check of period and begin without the code
/// that found them (recurrence.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "pindrive/motion/motion.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Compares x(t), from the end of the segments backwards, with the last period continued into the
/// past.
template <class T>
class PeriodSamples {
 public:
  /// The motion outlives the samples.
  explicit PeriodSamples(Motion<T>&& motion) = delete;
  explicit PeriodSamples(const Motion<T>& motion, GoOn go_on = {})
      : motion_(motion), go_on_(go_on), period_(motion.outcome().period), step_(period_ / samples) {
    const Segment<T>& last = *std::prev(motion.end());
    until_ = motion.outcome().cycles() ? last.end : last.begin + period_;
    for (int i = 0; i < samples; ++i) last_[static_cast<std::size_t>(i)] = position(time(i));
    const auto [low, high] = std::minmax_element(last_.begin(), last_.end());
    amplitude_ = (*high - *low) / 2;
    rounding_ = difference_error<T> * std::max(-*low, *high);
  }

  /// Largest difference from a time on, as a part of the amplitude.
  T difference_since(T since) const {
    T largest{0};
    for (long long i = samples; time(i) >= since && time(i) >= 0 && go_on_(); ++i)
      largest = std::max(largest, difference(i));
    return largest;
  }
  /// Earliest time from which no sample differs by more than a part of the amplitude, s; a sample is looked at
  /// `step` apart.
  T begin(T part) const {
    long long i = samples;
    while (time(i) > 0 && !(difference(i) > part) && go_on_()) ++i;
    return time(i) > 0 ? time(i - 1) : T(0);
  }
  T step() const { return step_; }

 private:
  static constexpr int samples = 64;  ///< in a period

  T time(long long i) const { return until_ - static_cast<T>(i + 1) * step_; }
  T difference(long long i) const {
    const T apart = abs(position(time(i)) - last_[static_cast<std::size_t>(i % samples)]);
    return std::max(apart - rounding_, T(0)) / amplitude_;
  }
  T position(T time) const {
    const auto place = motion_.locate(time, Side::right);
    return motion_.value(*place.segment, place.tau, Quantity::position);
  }

  const Motion<T>& motion_;
  GoOn go_on_;
  T period_, step_, until_{0}, amplitude_{0}, rounding_{0};
  std::array<T, samples> last_{};  ///< positions of the last period, backwards
};

}  // namespace pindrive::detail
