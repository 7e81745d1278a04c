// The kernel compiled for packs of several widths, of which the machine decides.
#pragma once

#include <array>
#include <cstddef>

#include "pindrive/kernel/kernel_block.hpp"

namespace pindrive_extension {

/// Of a number: the least and the largest that are allowed, and one beside them or NaN.
using Interval = std::array<double, 3>;
/// Of the inputs of a block, then of the damping ratio and of the phase over the duration.
using Bounds = std::array<Interval, pindrive::detail::KernelBlock::inputs + 2>;

/// Of some numbers; NaN if one is NaN, or there is none.
struct Extremes {
  double least, largest;
};

/// What is compiled for one width.
struct KernelFunctions {
  int width;
  void (*follow)(pindrive::detail::KernelBlock& block, int count, pindrive::detail::Asked asked);
  /// 0, or 1 and more for the first bound that a release of the block breaks: those of its inputs, a
  /// static friction below the kinetic one (as if it broke its own), those of what they make together.
  /// Whether all are 0. `of_inputs`: the extremes of each input of the block.
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
