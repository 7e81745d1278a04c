/// Closest approach of two pins: the smallest difference of their positions over time, with a bound.
///
/// Between the knots of both motions each position x is one closed form or one step of a series. In a
/// closed form the acceleration y obeys y'' = 2α y' − ω₀² y, so that |y| stays below √(y² + (y'/ω₀)²),
/// times e^(2ατ) where falling friction makes it grow; in a series, below its largest Bernstein
/// coefficient. With |y| of both together below A, a difference is nowhere in a time h more than A h²/8
/// below both its ends. An interval in which it may be smaller than the smallest difference so far is halved.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive::device {

/// Motion as pieces, each with a bound of its acceleration.
class BoundedPieces {
 public:
  BoundedPieces(const Motion<double>& motion, double duration) : motion_(motion) {
    motion.expanded(0.0, duration, [&](const Segment<double>& segment, double begin, double span) {
      if (begin > 0 && !(begin < duration)) return false;
      if (!(span > 0)) return true;
      const double bound = motion.along(segment, [&](const auto& along) {
        return largest_acceleration(along, std::min(span, duration - begin));
      });
      pieces_.push_back({begin, &segment, bound});
      return true;
    });
  }

  std::size_t count() const { return pieces_.size(); }
  double begin(std::size_t i) const { return pieces_[i].begin; }
  /// Bound of the acceleration in a piece, m/s².
  double bound(std::size_t i) const { return pieces_[i].bound; }

  /// Piece that contains a time.
  std::size_t place(double t) const {
    const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), t,
                                        [](double time, const Piece& p) { return time < p.begin; });
    return static_cast<std::size_t>(after - pieces_.begin()) - 1;
  }
  double position(std::size_t i, double t) const {
    const Piece& piece = pieces_[i];
    return motion_.value(*piece.segment, t - piece.begin, Quantity::position);
  }
  /// Positions at times in order; a trajectory is expanded once for the times in its piece.
  std::vector<double> positions(const std::vector<double>& times) const {
    std::vector<double> found;
    found.reserve(times.size());
    for (std::size_t i = 0; i < count(); ++i) {
      const Piece& piece = pieces_[i];
      const bool last = i + 1 == count();
      if (found.size() == times.size()) break;
      motion_.along(*piece.segment, [&](const auto& along) {
        while (found.size() < times.size() &&
               (last || times[found.size()] < pieces_[i + 1].begin)) {
          const double tau = times[found.size()] - piece.begin;
          found.push_back(motion_.value_of(along, tau, Quantity::position));
        }
      });
    }
    return found;
  }

 private:
  struct Piece {
    double begin;  ///< begin, in this round of a cycle, s
    const Segment<double>* segment;
    double bound;
  };

  template <class Trajectory>
  static double largest_acceleration(const Trajectory& along, double lasts) {
    if constexpr (!std::is_same_v<Trajectory, detail::ClosedForm<double>>) {
      return along.largest_size(along.acceleration());
    } else {
      const auto acceleration = along.acceleration();
      const double now = along.start(acceleration);
      const double jerk = along.start(along.derivative(acceleration));
      const Oscillator<double>& oscillator = along.oscillator();
      const double growth = detail::exp(std::max(2 * oscillator.alpha(), 0.0) * lasts);
      return detail::hypot(now, jerk / std::sqrt(oscillator.omega0_squared())) * growth;
    }
  }

  Motion<double> motion_;
  std::vector<Piece> pieces_;
};

/// Smallest position of one pin less that of another, and the earliest time at which it is found.
struct Approach {
  double difference;  ///< m
  double time;        ///< s
};

/// Search for the closest approach of two pins.
class ClosestApproach {
 public:
  /// No smaller difference is missed by more.
  static constexpr double close = 1e-12;

  ClosestApproach(const BoundedPieces& behind, const BoundedPieces& ahead, double duration)
      : behind_(behind), ahead_(ahead) {
    std::vector<double> knots;
    for (const BoundedPieces* const of : {&behind, &ahead})
      for (std::size_t i = 0; i < of->count(); ++i) knots.push_back(of->begin(i));
    knots.push_back(duration);
    std::sort(knots.begin(), knots.end());
    knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
    std::vector<double> apart = behind.positions(knots);
    const std::vector<double> other = ahead.positions(knots);
    for (std::size_t i = 0; i < knots.size(); ++i) {
      apart[i] -= other[i];
      visit(knots[i], apart[i]);
    }
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      i_ = behind.place(knots[i]);
      j_ = ahead.place(knots[i]);
      refine(knots[i], knots[i + 1], apart[i], apart[i + 1]);
    }
  }

  const Approach& found() const { return found_; }

 private:
  void visit(double time, double difference) {
    if (difference < found_.difference) found_ = {difference, time};
  }

  void refine(double low, double high, double first, double last) {
    const double lasts = high - low, bound = behind_.bound(i_) + ahead_.bound(j_);
    const double least = std::min(first, last) - 0.125 * bound * lasts * lasts;
    const double middle = low + 0.5 * lasts;
    const bool open = least < found_.difference - close && low < middle && middle < high;
    if (!open) return;
    const double value = behind_.position(i_, middle) - ahead_.position(j_, middle);
    visit(middle, value);
    refine(low, middle, first, value);
    refine(middle, high, value, last);
  }

  const BoundedPieces& behind_;
  const BoundedPieces& ahead_;
  std::size_t i_{0}, j_{0};  ///< pieces between the present knots
  Approach found_{std::numeric_limits<double>::infinity(), 0};
};

}  // namespace pindrive::device
