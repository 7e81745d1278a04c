// Widths of the kernel that this processor runs.
#include "_kernel.hpp"

#if defined(_MSC_VER) && defined(_M_X64)
#include <immintrin.h>
#include <intrin.h>
#endif

namespace pindrive_extension {

extern const KernelFunctions kernel_2;
#ifdef PINDRIVE_X86
extern const KernelFunctions kernel_4, kernel_8;
#endif

namespace {

#ifdef PINDRIVE_X86
#ifdef _MSC_VER
/// True if the processor has a feature of leaf 7 and the system saves these registers.
bool has(int bit, unsigned long long registers) {
  int found[4];
  __cpuidex(found, 1, 0);
  if ((found[2] & (1 << 27)) == 0 || (_xgetbv(0) & registers) != registers) return false;
  __cpuidex(found, 7, 0);
  return (found[1] & (1 << bit)) != 0;
}
bool runs_4() { return has(5, 0x6); }
bool runs_8() { return has(16, 0xe6) && has(17, 0xe6) && has(31, 0xe6); }
#else
bool runs_4() { return __builtin_cpu_supports("avx2") != 0; }
bool runs_8() {
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0;
}
#endif
#endif

struct Known {
  KernelFunctions functions[4];
  Known() : functions{} {
    KernelFunctions* next = functions;
    *next++ = kernel_2;
#ifdef PINDRIVE_X86
    if (runs_4()) *next++ = kernel_4;
    if (runs_8()) *next++ = kernel_8;
#endif
  }
};

}  // namespace

const KernelFunctions* kernels() {
  static const Known known;
  return known.functions;
}

const KernelFunctions* kernel_of(int width) {
  const KernelFunctions* found = nullptr;
  for (const KernelFunctions* each = kernels(); each->width != 0; ++each)
    if (width == 0 || each->width == width) found = each;
  return found;
}

}  // namespace pindrive_extension
