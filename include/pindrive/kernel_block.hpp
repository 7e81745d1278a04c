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
  static constexpr int inputs = 12;
  /// Those of PlainNumbers in their order, then four of the state.
  enum Column : signed char {
    peak_displacement,
    peak_time,
    trough_displacement,
    trough_time,
    swing,
    return_velocity,
    return_velocity_time,
    first_reversal_time,
    settling_time,
    plate_reversals,
    plate_time_stuck,
    plate_distance_slid,
    plate_dissipated,
    plate_peak_force,
    finger_reversals,
    finger_time_stuck,
    finger_distance_slid,
    finger_dissipated,
    finger_peak_force,
    duration,
    events,
    rest_position,
    final_position,
    final_velocity,
    rest_time,
    columns
  };

  double input[inputs][stride];
  double output[columns][stride];
  bool given_up[capacity];  ///< left to the general core
};

inline namespace PINDRIVE_TARGET {

/// Follows the pack of releases that begins at `input`, each column `stride` after the one before. Its
/// answers go to `output` likewise; which it gave up and which it put off, to the flags.
template <class V, bool Meets>
void follow_pack(const double* input, double* output, std::ptrdiff_t stride, Asked asked,
                 bool* given_up, bool* put_off) {
  constexpr int width = Traits<V>::width, measured = KernelBlock::rest_position;
  PlainRelease<V> release;
  V* into = &release.mass;
  for (int k = 0; k < KernelBlock::inputs; ++k) into[k] = load<V>(input + k * stride);
  LastState<V> last;
  V rest(__builtin_nan(""));
  if (asked != Asked::numbers) {
    last = Kernel<V, Meets, false>(release).run(rest);
    rest = select(last.time == last.time, last.position, rest);
  }
  if (asked != Asked::state) {
    Kernel<V, Meets, true> kernel(release);
    last = kernel.run(rest);
    const PlainNumbers<V> numbers = kernel.numbers();
    const V* from = &numbers.peak_displacement;
    for (int k = 0; k < measured; ++k) store(from[k], output + k * stride);
  }
  const V resting = select(last.time == last.time, last.position, last.time);
  store(resting, output + KernelBlock::rest_position * stride);
  store(last.position, output + KernelBlock::final_position * stride);
  store(last.velocity, output + KernelBlock::final_velocity * stride);
  store(last.time, output + KernelBlock::rest_time * stride);
  for (int i = 0; i < width; ++i) {
    given_up[i] = answer(last.given_up, i);
    put_off[i] = answer(last.put_off, i) && !given_up[i];
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
                          asked, &block.given_up[first], put_off);
    for (int i = 0; i < width && first + i < count; ++i)
      if (put_off[i]) later[number++] = first + i;
  }
  double input[KernelBlock::inputs][width], output[KernelBlock::columns][width];
  bool given_up[width];
  const int from = asked == Asked::state ? KernelBlock::rest_position : 0;
  for (int first = 0; first < number; first += width) {
    const int size = number - first < width ? number - first : width;
    for (int i = 0; i < width; ++i)
      for (int k = 0; k < KernelBlock::inputs; ++k)
        input[k][i] = block.input[k][later[first + (i < size ? i : size - 1)]];
    follow_pack<V, true>(&input[0][0], &output[0][0], width, asked, given_up, put_off);
    for (int i = 0; i < size; ++i) {
      const int slot = later[first + i];
      block.given_up[slot] = given_up[i];
      for (int k = from; k < KernelBlock::columns; ++k) block.output[k][slot] = output[k][i];
    }
  }
}

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
