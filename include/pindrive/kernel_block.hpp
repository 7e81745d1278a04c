/// Blocks of plain releases, followed in packs: first those that never meet the plate again, then the
/// others, gathered, so that no pack works for one of them alone.
#pragma once

#include <cstddef>

#include "pindrive/kernel.hpp"

namespace pindrive::detail {

/// What is asked of the releases of a block. The settling time needs the resting place beforehand.
enum class Asked : signed char { state, numbers, settling };

/// Releases and what became of them, one in each slot; columns as in PlainRelease, and these.
struct KernelBlock {
  static constexpr int capacity = 256;
  /// From a column to the next: not a power of two, which would put all columns in the same few sets
  /// of the processor's cache.
  static constexpr int stride = capacity + 8;
  static constexpr int inputs = 14;
  /// Of the output: a PlainNumber, or of the state.
  enum State : signed char {
    rest_position = PlainNumber::count,
    final_position,
    final_velocity,
    rest_time,
    columns
  };

  double input[inputs][stride];
  double output[columns][stride];
  bool given_up[capacity];  ///< left to the general core
  bool unsure[capacity];    ///< the same of the settling time alone, where that is asked for
};

inline namespace PINDRIVE_TARGET {

/// What becomes of each release of a pack beside its numbers.
struct Flags {
  bool *given_up, *unsure, *put_off;
};

/// Follows the pack of releases that begins at `input`, each column `stride` after the one before. Its
/// answers go to `output` likewise.
template <class V, bool Meets>
void follow_pack(const double* input, double* output, std::ptrdiff_t stride, Asked asked,
                 const Flags& flags) {
  const auto in = [&](std::ptrdiff_t k) { return load<V>(input + k * stride); };
  const auto out = [&](std::ptrdiff_t k, const V& value) { store(value, output + k * stride); };
  const PlainRelease<V> release{in(0), in(1), in(2), in(3),  in(4),  in(5), in(6),
                                in(7), in(8), in(9), in(10), in(11), in(12)};
  LastState<V> last;
  MaskOf<V> unsure(false);
  if (asked == Asked::state) {
    last = Kernel<V, Meets, false>(release).run();
  } else {
    const bool settling = asked == Asked::settling;
    for (bool again = false;; again = true) {
      Kernel<V, Meets, true> kernel(release);
      last = again ? kernel.run(last.position) : kernel.run();
      if (settling && kernel.full()) continue;
      const PlainNumbers<V> numbers = kernel.numbers(settling);
      for (int k = 0; k < PlainNumber::count; ++k) out(k, numbers.of[k]);
      unsure = numbers.unsure;
      break;
    }
  }
  out(KernelBlock::rest_position, select(last.time == last.time, last.position, last.time));
  out(KernelBlock::final_position, last.position);
  out(KernelBlock::final_velocity, last.velocity);
  out(KernelBlock::rest_time, last.time);
  for (int i = 0; i < Traits<V>::width; ++i) {
    flags.given_up[i] = answer(last.given_up, i);
    flags.unsure[i] = answer(unsure, i);
    flags.put_off[i] = answer(last.put_off, i) && !flags.given_up[i];
  }
}

/// Follows the first `count` releases of a block.
template <class V>
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__SANITIZE_ADDRESS__)
// A pack that is handed over in memory costs more than what is done with it.
__attribute__((flatten))
#endif
void follow_block(KernelBlock& block, int count, Asked asked) {
  constexpr int width = Traits<V>::width;
  const auto repeat_last = [&](double (*columns)[KernelBlock::stride], int last, int until) {
    for (int k = 0; k < KernelBlock::inputs; ++k)
      for (int i = last + 1; i < until; ++i) columns[k][i] = columns[k][last];
  };
  const auto whole = [](int size) { return (size + width - 1) / width * width; };
  int later[KernelBlock::capacity], number = 0;
  bool put_off[width];
  repeat_last(block.input, count - 1, whole(count));
  for (int first = 0; first < count; first += width) {
    follow_pack<V, false>(&block.input[0][first], &block.output[0][first], KernelBlock::stride,
                          asked, {&block.given_up[first], &block.unsure[first], put_off});
    for (int i = 0; i < width && first + i < count; ++i)
      if (put_off[i]) later[number++] = first + i;
  }
  double input[KernelBlock::inputs][width], output[KernelBlock::columns][width];
  bool given_up[width], unsure[width];
  const int from = asked == Asked::state ? KernelBlock::rest_position : 0;
  for (int first = 0; first < number; first += width) {
    const int size = number - first < width ? number - first : width;
    for (int i = 0; i < width; ++i)
      for (int k = 0; k < KernelBlock::inputs; ++k)
        input[k][i] = block.input[k][later[first + (i < size ? i : size - 1)]];
    follow_pack<V, true>(&input[0][0], &output[0][0], width, asked, {given_up, unsure, put_off});
    for (int i = 0; i < size; ++i) {
      const int slot = later[first + i];
      block.given_up[slot] = given_up[i];
      block.unsure[slot] = unsure[i];
      for (int k = from; k < KernelBlock::columns; ++k) block.output[k][slot] = output[k][i];
    }
  }
}

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
