/// Growth or decay of a motion that neither ends nor returns within a reasonable number of periods.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/events/irregularity.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/functions.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Compares the range of the position from block to block of a motion (docs/theory.md, section 14).
///
/// The range of a motion that grows or decays changes in one direction. The ratio of successive changes tells how many
/// periods remain: an approach is geometric, growth at resonance is linear. A motion that would take more than
/// `approach_limit` periods ends as growing or approaching.
template <class T>
class Trend {
 public:
  /// Includes a segment and the state at its end.
  void add(const Segment<T>& ended, const State<T>& state) { block_.add(ended, state.x, state.v); }

  /// Counts an event at a time, with the state after. At the end of a block, sets or resets the ending.
  void visit(T time, const State<T>& state, Outcome<T>& outcome) {
    ++events_;
    count_period(state);
    if (++in_block_ < trend_block) return;
    const Real length = plain(block_.length()), change = length - length_;
    ratio_ = change / change_;
    const bool clear = std::abs(change) > 64 * rounding<Real> * length;
    in_row_ = !clear ? 0 : ratio_ > 0 ? in_row_ + 1 : 1;
    change_ = change;
    length_ = length;
    widest_ = std::max(widest_, length);
    period_ = (time - begin_) / trend_block * T(in_period_);
    begin_ = time;
    in_block_ = 0;
    speed_ = plain(block_.speed());
    block_ = {};
    if (outcome.end == End::growing || outcome.end == End::approaching) outcome.end = End::moving;
    if (in_row_ >= trend_blocks &&
        periods(events_ + trend_block * remaining_blocks()) > approach_limit)
      conclude(outcome);
  }

  /// Ends a motion that has taken too long. False if the motion neither grows nor decays.
  bool conclude(Outcome<T>& outcome) const {
    if (in_row_ < trend_blocks) return false;
    const bool limited = ratio_ < 1 - alike;
    const Real factor = limited ? ratio_ : length_ / (length_ - change_);
    outcome.end = change_ > 0 && !limited ? End::growing : End::approaching;
    outcome.growth = exp(log(factor) * in_period_ / trend_block);
    outcome.period = period_;
    return true;
  }
  /// True if the motion has taken too many periods: `period_limit` if its end cannot be predicted.
  bool is_too_long() const {
    const bool predictable = in_row_ >= trend_blocks && (change_ < 0 || ratio_ < 1 - alike);
    return periods(events_) > (predictable ? approach_limit : period_limit);
  }

 private:
  using Real = detail::Real<T>;

  /// Ratio of successive changes beside which growth is linear.
  static constexpr Real alike{0.01};
  /// Difference of two states that are one period apart, over the range and the speed.
  static constexpr Real near_state{0.01};

  Real periods(Real events) const { return events / in_period_; }
  /// Counts the events of a period, from the first event of a block until its state nearly returns.
  void count_period(const State<T>& state) {
    const Real x = plain(state.x), v = plain(state.v);
    if (in_block_ == 0) {
      first_x_ = x;
      first_v_ = v;
      counted_ = !(speed_ > 0);
    } else if (!counted_ && std::abs(x - first_x_) <= near_state * length_ &&
               std::abs(v - first_v_) <= near_state * speed_) {
      in_period_ = in_block_;
      counted_ = true;
    }
  }
  /// Blocks until the motion ends, as its range changes now; infinite for linear growth, zero if unknown.
  Real remaining_blocks() const {
    // A decay whose changes hardly shrink comes to zero.
    if (change_ < 0 && -change_ * ratio_ > 2 * (1 - ratio_) * length_) return length_ / -change_;
    if (std::abs(ratio_ - 1) <= alike && change_ > 0) return std::numeric_limits<Real>::infinity();
    if (ratio_ >= 1) return Real(0);
    return log(approach_step * widest_ / std::abs(change_)) / log(ratio_);
  }

  Extent<T> block_;
  int in_block_{0};
  Real events_{0}, in_period_{1};  ///< events so far, and in a period
  bool counted_{false};            ///< the events of a period are counted in this block
  Real first_x_{0}, first_v_{0};   ///< state after the first event of the block, m, m/s
  Real speed_{0};                  ///< largest speed in the block before, m/s
  int in_row_{0};                  ///< successive changes of the range in one direction
  Real length_{0}, change_{0}, ratio_{0}, widest_{0};
  T begin_{0}, period_{0};  ///< begin of the block, time of a period, s
};

}  // namespace pindrive::detail
