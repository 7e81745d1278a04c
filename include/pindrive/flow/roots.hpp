/// Roots of a damped sinusoid plus a line, all, in order and with certainty, by isolation.
///
/// A guard  G(τ) = oscillation + constant + D τ  is monotone between the zeros of G', G' is
/// monotone between the zeros of G'', and the zeros of G'' are known in closed form. So each root
/// lies alone in a bracket with different signs at its ends; no root can be stepped over.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pindrive/flow/bracket.hpp"
#include "pindrive/flow/flow.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Sign changes of a path in (0, horizon], one by one; infinity after the last. Degree 1: an
/// oscillation with a constant; 2: with a line too (a finite horizon, unless overdamped).
///
/// `side` is the sign of the path just after τ = 0, given by the mode: a path that starts at zero,
/// or tangentially, leaves zero to this side, and its start is no root. Rounded numbers that
/// contradict the side are corrected.
template <class T, int Degree>
class Roots {
 public:
  Roots(const Oscillator<T>& oscillator, const Path<T>& path, int side, T horizon)
      : oscillator_(oscillator),
        path_(exact_at_start(oscillator, path, side)),
        side_(side),
        horizon_(horizon),
        extrema_(oscillator, path_.derivative(oscillator), side_of_slope(), horizon),
        approaching_(side_of_slope() != side),
        exhausted_(shrinks() && path_.start == 0 && slope() == 0) {}

  T next() {
    while (!exhausted_ && left_ < horizon_) {
      if (!(left_ < extremum_)) extremum_ = extrema_.next();
      const T right = end_of_bracket();
      if (!(left_ < right)) break;
      const T low = left_;
      const bool turned = right == extremum_;
      left_ = right;
      if (recedes()) {
        approaching_ = turned;
        continue;
      }
      const T value = path_.at(oscillator_, right);
      if (!isfinite(value)) break;  // grown beyond all numbers on its side
      if (side_ * value < 0) {
        // From its start to an extremum it is near a parabola with its vertex there.
        const T guess =
            turned && low == 0 ? right * (1 - sqrt(value / (value - path_.start))) : low;
        const T root = root_between(oscillator_, path_, low, right, side_, guess);
        side_ = -side_;
        approaching_ = turned;
        return root;
      }
      if (!turned) continue;
      // A decaying oscillation that turned back before zero never comes as far again; a growing
      // one comes farther by one factor each time.
      exhausted_ = shrinks();
      if constexpr (Degree == 1)
        if (oscillator_.alpha() > 0) left_ = skip_short_swings(value);
      approaching_ = !approaching_;
    }
    return never;
  }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  bool shrinks() const { return Degree == 1 && oscillator_.alpha() <= 0; }

  /// True if the path moves away from zero until its next extremum, whose time is a closed form.
  bool recedes() const { return Degree == 1 && !approaching_; }

  T slope() const { return path_.slope + path_.drift; }

  int side_of_slope() const {
    if (slope() != 0) return slope() > 0 ? 1 : -1;
    if (path_.start == 0) return side_;
    return oscillator_.bend(path_.value, path_.slope) > 0 ? 1 : -1;
  }

  /// True if a path that decays to its centre, or its line, ends on the other side.
  bool ends_beyond() const {
    if (oscillator_.alpha() > 0) return false;
    return side_ * (Degree == 1 ? path_.centre() : path_.drift) < 0;
  }

  /// Last extremum of a growing oscillation that turns back before zero.
  T skip_short_swings(T value) {
    const T growth = 2 * oscillator_.alpha() * extrema_.spacing();  // in a period
    const T short_of = abs(path_.centre() / (value - path_.centre()));
    if (!(short_of > 1) || !(growth > 0)) return left_;
    const T periods = floor(log(short_of) / growth) - 1;
    if (periods < 1) return left_;
    extremum_ = extrema_.skip(2 * periods);
    return std::min(extremum_, horizon_);
  }

  /// End of the monotone bracket: next extremum, horizon or, without either, a time that decides
  /// whether the path reaches zero. A growing path is evaluated in strides that do not overflow.
  T end_of_bracket() {
    const T right = std::min(extremum_, horizon_);
    if (recedes()) return right < never ? right : left_;
    const T rate = oscillator_.slowest_rate();
    if (rate > 0) return right < never || approaching_ ? std::min(right, left_ + 16 / rate) : left_;
    if (right < never) return right;
    if (!ends_beyond()) return left_;
    T step = -1 / rate;
    while (side_ * path_.at(oscillator_, left_ + step) > 0) step *= 2;
    return left_ + step;
  }

  Oscillator<T> oscillator_;
  Path<T> path_;
  int side_;
  T horizon_;
  Roots<T, Degree - 1> extrema_;
  T left_{0}, extremum_{0};
  bool approaching_;
  bool exhausted_;
};

/// Degree 0, a pure oscillation: zeros in closed form.
template <class T>
class Roots<T, 0> {
 public:
  Roots(const Oscillator<T>& oscillator, const Path<T>& path, int side, T horizon)
      : zeros_(oscillator.zeros(side * path.start > 0 ? path.start : T(0), path.slope)),
        horizon_(std::min(horizon, oscillator.lasts_for())) {}

  T next() {
    const T zero = zeros_.at(count_);
    count_ += 1;
    return zero <= horizon_ ? zero : std::numeric_limits<T>::infinity();
  }
  /// Skips an even number of zeros after the last zero returned.
  T skip(T zeros) {
    count_ += zeros - 1;
    return next();
  }
  T spacing() const { return zeros_.spacing; }

 private:
  Zeros<T> zeros_;
  T horizon_;
  T count_{0};
};

/// Time during which an oscillation cannot bring a path, whose line is on its side, to zero. A
/// growing oscillation gets half of the distance, the line the second half.
template <class T>
T out_of_reach(const Oscillator<T>& oscillator, const Path<T>& path, int side) {
  constexpr T never = std::numeric_limits<T>::infinity();
  const T alpha = oscillator.alpha();
  const T reach = hypot(path.value, (path.slope - alpha * path.value) / oscillator.omega());
  const T distance = side * path.centre() - reach, approach = -side * path.drift;
  if (!(distance > 0)) return T(0);
  if (!(alpha > 0)) return approach > 0 ? distance / approach : never;
  const T grown = log1p(distance / (2 * reach)) / alpha;
  return approach > 0 ? std::min(grown, distance / (2 * approach)) : grown;
}

/// True if a decaying oscillation about a constant on its side is too small to reach zero.
template <class T>
bool too_small(const Oscillator<T>& oscillator, const Path<T>& path, int side) {
  const T sine = path.slope - oscillator.alpha() * path.value;
  const T cosine = oscillator.omega() * path.value;
  const T distance = oscillator.omega() * path.centre();
  return side * distance > 0 && sine * sine + cosine * cosine < distance * distance;
}

/// Calls visit(τ) at each sign change of a path in (0, horizon], until visit returns false.
template <class T, class Visitor>
void each_root(const Oscillator<T>& oscillator, const Path<T>& path, int side, T horizon,
               Visitor&& visit) {
  const auto all = [&](auto roots) {
    for (;;) {
      const T root = roots.next();
      if (!(root < std::numeric_limits<T>::infinity())) return;
      if (!visit(Rooted<T>::at(oscillator, path, root))) return;
    }
  };
  if (!path.oscillates()) {
    const T root = parabola_root(path, side);
    if (!(root <= horizon) || !visit(root) || path.curvature == 0) return;
    const T other = -2 * path.drift / path.curvature - root;
    if (other > root && other <= horizon) visit(other);
  } else if (path.drift != 0) {
    all(Roots<T, 2>(oscillator, path, side, horizon));
  } else if (path.centre() != 0) {
    all(Roots<T, 1>(oscillator, path, side, horizon));
  } else {
    all(Roots<T, 0>(oscillator, path, side, horizon));
  }
}

/// Earliest τ in (0, horizon] at which the path leaves its side, else infinity.
template <class T>
T first_root(const Oscillator<T>& oscillator, const Path<T>& path, int side, T horizon) {
  constexpr T never = std::numeric_limits<T>::infinity();
  const auto earliest = [&](const Path<T>& from_here, T until) {
    T first = never;
    each_root(oscillator, from_here, side, until, [&](T root) {
      first = root;
      return false;
    });
    return first;
  };
  if (!oscillator.oscillates() || !path.oscillates()) return earliest(path, horizon);
  if (path.drift == 0) {
    const bool never_reaches = oscillator.alpha() <= 0 && too_small(oscillator, path, side);
    return never_reaches ? never : earliest(path, horizon);
  }
  // While the line is out of the oscillation's reach, nothing need be looked at; else a few periods
  // are, before the reach is measured again.
  Path<T> rest = path;
  T passed{0};
  for (;;) {
    // Not all of it, so that the path stays clearly on its side.
    const T idle = out_of_reach(oscillator, rest, side) * T(0.99);
    if (!(idle < horizon - passed)) return never;
    T leap = idle;
    if (!(idle * oscillator.omega() > 8)) {
      leap = std::min(horizon - passed, 64 / oscillator.omega());
      const T first = earliest(rest, leap);
      if (first < never) return passed + first;
      if (!(passed + leap < horizon)) return never;
    }
    rest = rest.from(oscillator, leap);
    passed += leap;
  }
}

/// Sign of a path just after τ = 0, of its first derivative that is not zero; 0 if the path stays zero.
template <class T>
int side_after_start(const Oscillator<T>& oscillator, const Path<T>& path) {
  const auto sign = [](T value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
  if (path.start != 0) return sign(path.start);
  if (path.slope + path.drift != 0) return sign(path.slope + path.drift);
  const T bend = oscillator.bend(path.value, path.slope) + path.curvature;
  if (bend != 0) return sign(bend);
  return sign(oscillator.bend(path.slope, -path.curvature));
}

}  // namespace pindrive::detail
