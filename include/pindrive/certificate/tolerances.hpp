/// Tolerances of the certificate, apart from the limits of the solver.
#pragma once

#include <limits>

namespace pindrive::detail {

/// Tolerances of the certificate: own numbers, so that a limit of the solver that is too loose shows as a violation;
/// tolerances_test compares them.
struct tolerance {
  /// Relative error of a sum of some eight terms, and of a time.
  template <class T>
  static constexpr T sum = 4 * std::numeric_limits<T>::epsilon();
  /// Relative error of the difference of two computed values.
  template <class T>
  static constexpr T difference = 16 * std::numeric_limits<T>::epsilon();
  /// Relative transverse velocity below which an oblique plate may move along the axis.
  template <class T>
  static constexpr T transverse = 256 * std::numeric_limits<T>::epsilon();
  /// Relative time before a load ends, or after it begins, in which skin may have no mode.
  template <class T>
  static constexpr T unloaded_time = 260 * std::numeric_limits<T>::epsilon();
  /// Relative part of the force scale by which skin may stretch near a load of zero, where it is not simulated. Without
  /// it: fuzz fails.
  template <class T>
  static constexpr T unloaded_stretch = 1024 * std::numeric_limits<T>::epsilon();
  /// Relative velocity, as a fraction of the largest velocity, below which a pin is at rest on a surface. Without it: fuzz
  /// fails.
  static constexpr double still = 1e-12;
  /// Depth, as a fraction of the largest value, to which a guard may be negative between two nodes unnoticed. Saves a
  /// quarter of the time of a certificate; no violation is that small.
  static constexpr double unseen_violation = 1e-10;
  /// Panels at each end of a segment that are evaluated before its middle is skipped. Without it: fuzz --replay fails.
  static constexpr int walked_panels = 2048;
};

}  // namespace pindrive::detail
