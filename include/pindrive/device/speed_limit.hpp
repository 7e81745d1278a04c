/// Largest hand speed at which two lines are distinct.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "pindrive/device/two_lines.hpp"

namespace pindrive::device {

/// Speeds from one to another, m/s.
struct SpeedBand {
  double slowest, fastest;
};

/// Search for the speeds at which two lines are distinct.
struct SpeedSearch {
  SpeedBand tried{0.005, 1};  ///< slowest and fastest hand
  int count{32};              ///< speeds in the geometric grid
  double precision{1e-3};     ///< relative precision of a border
};

/// Speeds at which two lines are distinct. An interval between two speeds of the grid may be missed.
struct SpeedLimit {
  std::vector<SpeedBand> distinct, settled;  ///< the slowest first
  std::optional<LineTrial> beyond;           ///< failure of a hand just faster than the first band
  Status status{Status::ok};                 ///< reason for an incomplete search
};

/// Trials of two lines at a grid of speeds, and bisection of the borders.
class SpeedLimitSearch {
 public:
  SpeedLimitSearch(const TwoLines& lines, double direction, const SpeedSearch& search)
      : lines_(lines), direction_(direction), search_(search) {}

  /// Searches; go_on() is called after each event, and report(trials) after each trial.
  SpeedLimit found(GoOn go_on, Callback<int> report) {
    SpeedLimit limit;
    const auto trial = [&](double speed) -> Record& {
      const auto at = std::lower_bound(records_.begin(), records_.end(), speed, is_slower);
      if (at != records_.end() && at->trial.speed == speed) return *at;
      Record record{lines_.at(speed, go_on), {}};
      if (record.trial.status != Status::ok) limit.status = record.trial.status;
      report(++done_);
      return *records_.insert(at, std::move(record));
    };
    const auto distinct = [&](double speed) { return trial(speed).trial.distinct(direction_); };
    const auto settled = [&](double speed) {
      if (!distinct(speed)) return false;
      Record& record = trial(speed);
      if (!record.settles) {
        const TwoLines::Settling alone = lines_.settling(record.trial, go_on);
        if (alone.status != Status::ok) limit.status = alone.status;
        record.settles = alone.in_time;
        report(++done_);
      }
      return *record.settles;
    };
    limit.distinct = bands(distinct, limit.status);
    limit.settled = bands(settled, limit.status);
    if (limit.distinct.empty()) return limit;
    const double fastest = limit.distinct[0].fastest;
    const auto faster = std::find_if(records_.begin(), records_.end(), [&](const Record& record) {
      return record.trial.speed > fastest;
    });
    if (faster != records_.end()) limit.beyond = faster->trial;
    return limit;
  }

 private:
  struct Record {
    LineTrial trial{};
    std::optional<bool> settles;
  };
  static bool is_slower(const Record& record, double speed) { return record.trial.speed < speed; }

  double speed_of_grid(int i) const {
    if (i == 0) return search_.tried.slowest;
    if (i == search_.count - 1) return search_.tried.fastest;
    const double ratio = detail::log(search_.tried.fastest / search_.tried.slowest);
    return search_.tried.slowest * detail::exp(ratio * i / (search_.count - 1));
  }

  /// Bands in which a property holds: from the grid, with borders by bisection.
  template <class Holds>
  std::vector<SpeedBand> bands(Holds&& holds, const Status& status) {
    std::vector<SpeedBand> found;
    double slow = speed_of_grid(0);
    bool before = holds(slow);
    if (before) found.push_back(search_.tried);
    for (int i = 1; i < search_.count && status == Status::ok; ++i) {
      const double fast = speed_of_grid(i);
      const bool after = holds(fast);
      if (after && !before) found.push_back({border(slow, fast, holds), search_.tried.fastest});
      if (before && !after) found.back().fastest = border(slow, fast, holds);
      slow = fast;
      before = after;
    }
    return found;
  }

  /// Speed at which a property begins or ceases to hold, on the side on which it holds.
  template <class Holds>
  double border(double slow, double fast, Holds&& holds) {
    const bool before = holds(slow);
    while (fast - slow > search_.precision * slow) {
      const double middle = slow + 0.5 * (fast - slow);
      (holds(middle) == before ? slow : fast) = middle;
    }
    return before ? slow : fast;
  }

  TwoLines lines_;
  double direction_;  ///< least motion of the skin, m
  SpeedSearch search_;
  std::vector<Record> records_;  ///< the slowest first
  int done_{0};
};

}  // namespace pindrive::device
