/// Hand that is given row by row, as it moves.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/scan_inputs.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::device {

/// Hand and touch, linear between the rows so far.
class LiveHand {
 public:
  struct Row {
    double time;         ///< s
    Vector velocity;     ///< m/s
    double finger_load;  ///< touch over the usual one
  };

  /// Hand that begins at a place.
  LiveHand(const Row& row, Place place, const Axis& axis) : begin_(row.time) {
    add(row, place, axis);
  }
  /// Hand of which the rows are known from one on; `begin` is the time of the first one of all, s.
  LiveHand(double begin, const std::vector<std::pair<Row, Place>>& rows, const Axis& axis)
      : begin_(begin) {
    for (const auto& [row, place] : rows) add(row, place, axis);
  }

  /// Goes on to a later row.
  void add(const Row& row, const Axis& axis) {
    const double lasts = row.time - times_.back();
    add(row,
        {x_.back() + 0.5 * (row.velocity.x + vx_.back()) * lasts,
         y_.back() + 0.5 * (row.velocity.y + vy_.back()) * lasts},
        axis);
  }
  /// Deletes the rows that are not needed from a time on, s.
  void forget(double before) {
    std::size_t past = 0;
    while (past + 2 < times_.size() && times_[past + 1] < before) ++past;
    if (2 * past < times_.size()) return;  // so each row is moved once on average
    plate_.forget(past);
    for (auto* column : {&times_, &vx_, &vy_, &x_, &y_, &loads_})
      column->erase(column->begin(), column->begin() + static_cast<std::ptrdiff_t>(past));
  }

  double begin() const { return begin_; }       ///< time of the first row of all, s
  double end() const { return times_.back(); }  ///< time of the last row, s
  std::size_t size() const { return times_.size(); }
  Row row(std::size_t i) const { return {times_[i], {vx_[i], vy_[i]}, loads_[i]}; }
  Place place(std::size_t i) const { return {x_[i], y_[i]}; }

  HandPath path() const {
    return {times_.data(), vx_.data(), vy_.data(), x_.data(), y_.data(), times_.size()};
  }
  const PlateVelocity& plate() const { return plate_; }
  /// Touch over the usual one, to the power of its friction.
  Profile<double> touch(double power) const { return plate_.profile(loads_).to_the(power); }

 private:
  void add(const Row& row, Place place, const Axis& axis) {
    times_.push_back(row.time);
    vx_.push_back(row.velocity.x);
    vy_.push_back(row.velocity.y);
    x_.push_back(place.x);
    y_.push_back(place.y);
    loads_.push_back(row.finger_load);
    plate_.add(row.time - begin_, row.velocity, axis);
  }

  double begin_;
  std::vector<double> times_, vx_, vy_, x_, y_, loads_;
  PlateVelocity plate_;
};

}  // namespace pindrive::device
