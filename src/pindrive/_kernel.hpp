// The kernel compiled for packs of several widths, of which the machine decides.
#pragma once

#include <array>
#include <cstddef>

#include "pindrive/kernel/kernel_block.hpp"

namespace pindrive_extension {

/// Bounds of a number: lowest and highest allowed value, and an additional value or NaN.
using Interval = std::array<double, 3>;
/// Bounds of the inputs of a block, of the damping ratio, and of the phase over the duration.
using Bounds = std::array<Interval, pindrive::detail::KernelBlock::inputs + 2>;

/// Extremes of some numbers; NaN if a number is NaN, or without numbers.
struct Extremes {
  double least, largest;
};

/// Functions that are compiled for one width.
struct KernelFunctions {
  int width;
  void (*follow)(pindrive::detail::KernelBlock& block, int count, pindrive::detail::Asked asked);
  /// Writes 0, or the number (1 and more) of the first bound that a release of the block breaks:
  /// bounds of its inputs, a static friction below the kinetic one (counted as its own bound),
  /// bounds of derived values. Returns true if all are 0. `of_inputs`: extremes of each input of
  /// the block.
  bool (*judge)(const pindrive::detail::KernelBlock& block, int count, const Extremes* of_inputs,
                const Bounds& bounds, signed char* broken);
  Extremes (*extremes)(const double* values, std::size_t count);
  /// `which` of the elementary functions, in the order of their header, at arguments a (and b).
  void (*elementary)(int which, const double* a, const double* b, double* found, std::size_t count);
};

/// The widths that this processor runs, smallest first; one more entry of width 0 ends them.
const KernelFunctions* kernels();
/// The functions for a width; for 0, the widest. None if this processor does not run it.
const KernelFunctions* kernel_of(int width);

}  // namespace pindrive_extension
