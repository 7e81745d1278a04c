/// First time at which a function is no longer negative.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace pindrive::device {

/// Returns the number in (low, high] at which f ceases to be negative, for f negative at `low` and at least 0 at `high`;
/// `low` if f is not negative there.
///
/// If the sign changes more than once, any change may be found. The secant between both ends (Illinois method),
/// moved off the ends, narrows the bracket until its ends are neighbouring numbers; every third step halves it.
template <class Function>
double sign_change(Function&& f, double low, double high) {
  double below = f(low), above = f(high);
  if (!(below < 0)) return low;
  int moved_low = 0;  // times in a row
  for (int step = 0;; ++step) {
    const double half = low + 0.5 * (high - low);
    const bool neighbours = half <= low || high <= half;
    if (neighbours) return high;
    double middle = step % 3 == 2 ? half : low + (high - low) * (below / (below - above));
    const double ulp = 2 * std::numeric_limits<double>::epsilon() * std::abs(high);
    middle = std::max(middle, std::min(low + ulp, half));
    middle = std::min(middle, std::max(high - ulp, half));
    const bool inside = low < middle && middle < high;  // false for NaN
    if (!inside) middle = half;
    const double found = f(middle);
    if (found < 0) {
      low = middle;
      below = found;
      if (++moved_low > 1) above *= 0.5;
    } else {
      high = middle;
      above = found;
      moved_low = 0;
    }
  }
}

}  // namespace pindrive::device
