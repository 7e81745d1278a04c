// The kernel compiled for packs of several widths, of which the machine decides.
#pragma once

#include <cstddef>

#include "pindrive/kernel_block.hpp"

namespace pindrive_extension {

/// What is compiled for one width.
struct KernelFunctions {
  int width;
  void (*follow)(pindrive::detail::KernelBlock& block, int count, pindrive::detail::Asked asked);
  /// `which` of the elementary functions, in the order of their header, at arguments a (and b).
  void (*elementary)(int which, const double* a, const double* b, double* found, std::size_t count);
};

/// The widths that this processor runs, smallest first; one more entry of width 0 ends them.
const KernelFunctions* kernels();
/// The functions for a width; for 0, the widest. None if this processor does not run it.
const KernelFunctions* kernel_of(int width);

}  // namespace pindrive_extension
