/// Detection of irregular motions: chaotic or quasi-periodic, without growth or decay.
#pragma once

#include <algorithm>
#include <limits>

#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Natural scales of a motion, measured along its events: range of the position and largest speed.
template <class T>
class Extent {
 public:
  /// Includes an event, between a segment and the state after the event.
  void add(const Segment<T>& ended, T x, T v) {
    lowest_ = std::min(lowest_, x);
    highest_ = std::max(highest_, x);
    // The pin may turn between events, but in a short segment far from its centre it does not get there.
    const Path<T>& velocity = ended.flow.velocity;
    const T lasts = ended.end - ended.begin;
    const T reach = lasts * (abs(velocity.value) + lasts * abs(velocity.slope));
    amplitude_ = std::max(amplitude_, std::min(abs(ended.flow.position.value), reach));
    speed_ = std::max({speed_, abs(v), abs(velocity.value)});
  }
  /// Includes a position.
  void add(T x) {
    lowest_ = std::min(lowest_, x);
    highest_ = std::max(highest_, x);
  }
  T length() const { return std::max(highest_ - lowest_, amplitude_); }  ///< m
  T speed() const { return speed_; }                                     ///< m/s

 private:
  T lowest_{std::numeric_limits<T>::infinity()}, highest_{-std::numeric_limits<T>::infinity()};
  T amplitude_{0}, speed_{0};
};

/// Detects that a motion without a period neither grows nor decays.
///
/// The durations of windows of equally many events increase or decrease without exception in a motion that
/// grows or decays, or the ranges of the position in blocks of windows do. A motion with many windows, of which
/// many turn from longer to shorter or back, and with a block that contradicts growth and decay, is irregular.
///
/// Under periodic inputs the events are the begins of periods, which last equally long. The sums of the positions
/// there are compared instead of durations.
template <class T>
class IrregularityDetector {
 public:
  /// Counts an event at a time, between a segment and the state after the event. Sets the ending in the
  /// outcome if the motion is irregular.
  void visit(const Segment<T>& ended, T time, const State<T>& state, Outcome<T>& outcome) {
    block_.add(ended, state.x, state.v);
    if (++in_window_ == irregular_window) end_window(time, time - window_begin_, outcome);
  }
  /// Counts the begin of a period of the inputs.
  void visit_period(T time, const State<T>& state, Outcome<T>& outcome) {
    block_.add(state.x);
    // Between windows that follow each other at once a response turns by the same angle, which may be none.
    const int pause = windows_ * 37 % irregular_periods;
    if (in_window_++ >= pause) sum_ += state.x;
    if (in_window_ == pause + irregular_periods) end_window(time, sum_, outcome);
  }

 private:
  static constexpr int windows_in_block = irregular_windows / 8;

  /// Compares the sum of the durations, or of the positions, in a window with that in the window before.
  void end_window(T time, T sum, Outcome<T>& outcome) {
    const T longer = sum - before_;
    if (abs(longer) > T(repeat_tolerance) * abs(sum)) {
      if (windows_ > 1 && (longer > 0) != grew_) ++turns_;
      grew_ = longer > 0;
    }
    before_ = sum;
    sum_ = T(0);
    window_begin_ = time;
    in_window_ = 0;
    if (++windows_ == irregular_windows / 2) half_time_ = time;
    if (windows_ % windows_in_block == 0) end_block();
    if (windows_ < irregular_windows) return;
    if (4 * turns_ >= irregular_windows && !grows_ && !decays_) {
      outcome.end = End::irregular;
      outcome.cycle_begin = half_time_;
    }
    windows_ = turns_ = 0;
    grows_ = decays_ = true;
  }
  /// Compares the ranges of the position in a block of windows and in the block before.
  void end_block() {
    const T length = block_.length();
    if (windows_ > windows_in_block) {
      grows_ = grows_ && length > length_;
      decays_ = decays_ && length < length_;
    }
    length_ = length;
    block_ = {};
  }

  int in_window_{0}, windows_{0};  ///< events in the window, windows so far
  int turns_{0};                   ///< changes between longer and shorter windows
  bool grew_{false};
  bool grows_{true}, decays_{true};  ///< in each block of windows
  Extent<T> block_;
  T length_{0};           ///< range in the block before, m
  T window_begin_{0};     ///< s
  T sum_{0}, before_{0};  ///< sum of positions in the window; sum compared in the window before
  T half_time_{0};        ///< time after half of the windows, s
};

}  // namespace pindrive::detail
