/// Blocks of standard releases, simulated in packs, round by round. Releases that need another
/// round are gathered, so that packs stay full.
#pragma once

#include "pindrive/kernel/kernel.hpp"

namespace pindrive::detail {

/// Requested output of a block.
enum class Asked : signed char { state, numbers, settling };

/// Releases and results, one per slot; columns as in PlainRelease, followed by these.
struct KernelBlock {
  static constexpr int capacity = 1024, widest = 16;  ///< number of slots; largest number in a pack
  /// Distance between columns: not a power of two, which would map all columns to few sets of the
  /// cache.
  static constexpr int stride = capacity + widest;
  static constexpr int inputs = 14, most_progress = 26;
  /// Columns of the output for the state; else PlainNumber.
  enum State : signed char {
    rest_position = PlainNumber::count,
    final_position,
    final_velocity,
    rest_time,
    columns
  };

  double input[inputs][stride];
  double* output[columns];  ///< destination of each column, slot by slot; null if not requested
  bool given_up[capacity];  ///< true: left to the general core
  bool unsure[capacity];    ///< true: settling time left to the general core, if requested

  double progress[most_progress][stride];  ///< progress of releases that need another round
  double rest[stride];  ///< place of rest of releases simulated again with this knowledge, m
};

inline constexpr int no_column = -1;  ///< column of a number that standard releases do not have
/// Columns of the transient_numbers in the output, in their order.
inline constexpr int transient_columns[] = {
    PlainNumber::peak_displacement,
    PlainNumber::peak_time,
    PlainNumber::trough_displacement,
    PlainNumber::trough_time,
    PlainNumber::swing,
    PlainNumber::return_velocity,
    PlainNumber::return_velocity_time,
    PlainNumber::first_reversal_time,
    PlainNumber::settling_time,
    KernelBlock::rest_time,
    KernelBlock::rest_time,  // the last event is that it comes to rest
    no_column,               // the stretch of a compliant finger, and its rate
    no_column,
    PlainNumber::end_time,
    PlainNumber::plate_reversals,
    PlainNumber::plate_time_stuck,
    PlainNumber::plate_distance_slid,
    PlainNumber::plate_dissipated,
    PlainNumber::plate_peak_force,
    PlainNumber::finger_reversals,
    PlainNumber::finger_time_stuck,
    PlainNumber::finger_distance_slid,
    PlainNumber::finger_dissipated,
    PlainNumber::finger_peak_force,
    KernelBlock::rest_position,
    no_column,  // numbers of a steady oscillation
    no_column,
    no_column,
    no_column,
    no_column,
    no_column,
    no_column,  // the energy of a decay; velocity and lag of a drift, growth
    no_column,
    no_column,
    no_column,
    no_column,  // the plate in a period of a steady oscillation
    no_column,
    no_column,
    no_column,
    PlainNumber::plate_power,
    no_column,  // and the finger
    no_column,
    no_column,
    no_column,
    PlainNumber::finger_power,
};

inline namespace PINDRIVE_TARGET {

/// Slots of a pack: consecutive, or from a list.
struct Slots {
  int first;
  const int* list;  ///< list of slots; null if consecutive
  int size;         ///< number of valid slots
  int operator[](int i) const { return list ? list[i] : first + i; }
#ifdef __GNUC__
  __attribute__((noinline))
#endif
  void scatter(const double* from, double* column) const {
    for (int i = 0; i < size; ++i) column[(*this)[i]] = from[i];
  }
};

/// List of slots for a later round.
struct SlotList {
  int slots[KernelBlock::capacity + KernelBlock::widest];
  int size{0};
  template <class Mask>
  void add(const Slots& from, const Mask& which) {
    for (int i = 0; i < from.size;
         ++i) {  // without a branch that the processor would have to guess
      slots[size] = from[i];
      size += answer(which, i) ? 1 : 0;
    }
  }
};

/// Round of a pack, in two parts.
template <class V, bool Later, bool Measured>
class PackRound {
 public:
  /// Loads a pack; `knows_rest`: with the place of rest from the block.
  PackRound(const KernelBlock& block, const Slots& slots, bool knows_rest)
      : slots_(slots), release_(release(block, slots)), round_(release_) {
    auto& progress = round_.progress();
    if constexpr (Later) {
      const double* column = block.progress[0];
      progress.columns([&](V& value) {
        value = in(column, slots);
        column += KernelBlock::stride;
      });
    } else if constexpr (Measured) {
      if (knows_rest)
        progress.settling = KernelSettling<V>(in(block.rest, slots) * release_.mirror);
    }
    round_.to_first_rest();
  }

  /// Stores a pack. Releases that need another round are added to `later`; releases whose settling
  /// time needs the place of rest first, to `again`.
  void finish(KernelBlock& block, bool settling, SlotList& later, SlotList& again) {
    constexpr double none = __builtin_nan("");
    round_.to_end();
    const auto& end = round_.progress().standing;
    const Mask resting = round_.resting();
    const V position = end.position * release_.mirror;
    Mask knew_rest(false);
    if constexpr (Measured) {
      auto& weighed = round_.progress().settling;
      knew_rest = weighed.knows_rest();
      if (settling) weighed.weigh(release_, resting, end.position);
    }
    if (any(round_.goes_on())) {
      double* column = block.progress[0];
      round_.progress().columns([&](V& value) {
        out(column, value);
        column += KernelBlock::stride;
      });
      later.add(slots_, round_.goes_on());
    }
    const auto give = [&](int name, const V& value) {
      if (block.output[name]) out(block.output[name], value);
    };
    Mask unsure(false);
    if constexpr (Measured) {
      auto& progress = round_.progress();
      if (settling) {
        const auto found = progress.settling.settled(release_, round_.last_turns());
        give(PlainNumber::settling_time, select(resting, found.time, V(none)));
        unsure = resting & found.unsure;
        if constexpr (Later) {
          const Mask which = resting & found.within & !knew_rest & !round_.given_up();
          if (any(which)) {
            out(block.rest, position);
            again.add(slots_, which);
          }
        }
      }
      progress.numbers.give(release_, resting, end.position, end.time, end.released, give);
    }
    give(KernelBlock::rest_position, select(resting, position, V(none)));
    give(KernelBlock::final_position, position);
    give(KernelBlock::final_velocity, end.velocity * release_.mirror);
    give(KernelBlock::rest_time, select(resting, end.time, V(none)));
    // Few of the packs have any.
    if (any(round_.given_up() | unsure))
      for (int i = 0; i < slots_.size; ++i) {
        block.given_up[slots_[i]] = answer(round_.given_up(), i);
        block.unsure[slots_[i]] = answer(unsure, i);
      }
  }

 private:
  using Mask = MaskOf<V>;

  static V in(const double* column, const Slots& slots) {
    return slots.list ? gather<V>(column, slots.list) : load<V>(column + slots.first);
  }
  static ForwardRelease<V> release(const KernelBlock& block, const Slots& slots) {
    const auto input = [&](int k) { return in(block.input[k], slots); };
    return ForwardRelease<V>(PlainRelease<V>{input(0), input(1), input(2), input(3), input(4),
                                             input(5), input(6), input(7), input(8), input(9),
                                             input(10), input(11), input(12)});
  }
  void out(double* column, const V& value) const {
    if (!slots_.list && slots_.size == Traits<V>::width) {
      store(value, column + slots_.first);
    } else {
      double one[Traits<V>::width];
      store(value, one);
      slots_.scatter(one, column);
    }
  }

  Slots slots_;
  ForwardRelease<V> release_;
  Round<V, Later, Measured> round_;
};

/// Simulates a round of `count` slots: from a list, or the first slots.
template <class V, bool Later, bool Measured>
#if defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__)
// A pack that is handed over in memory costs more than what is done with it.
__attribute__((flatten, noinline))
#endif
void follow_round(KernelBlock& block, const int* list, int count, bool settling, bool knows_rest,
                  SlotList& later, SlotList& again) {
  constexpr int width = Traits<V>::width;
  for (int first = 0; first < count; first += width) {
    const int size = count - first < width ? count - first : width;
    PackRound<V, Later, Measured> pack(block, {first, list ? list + first : nullptr, size},
                                       knows_rest);
    pack.finish(block, settling, later, again);
  }
}

/// Type for first rounds: for the state alone two packs at once, if there are enough registers, so
/// that latencies overlap.
template <class V, bool Measured>
struct FirstRound {
  using type = V;
};
#if defined(PINDRIVE_VECTOR_LANES) && PINDRIVE_VECTOR_LANES == 8
template <>
struct FirstRound<Pack<8>, false> {
  using type = Pack<16>;
};
#endif

/// Simulates all rounds of `count` slots.
template <class V, bool Measured>
void follow_all(KernelBlock& block, int* list, int count, bool settling, bool knows_rest,
                SlotList& again) {
  constexpr int width = Traits<V>::width;
  // A pack that is not full repeats the last slot.
  const auto fill = [](SlotList& some) {
    for (int i = 0; i < width && some.size > 0; ++i)
      some.slots[some.size + i] = some.slots[some.size - 1];
  };
  SlotList lists[2];
  using First = typename FirstRound<V, Measured>::type;
  follow_round<First, false, Measured>(block, list, count, settling, knows_rest, lists[0], again);
  int now = 0;
  for (int round = 1; lists[now].size > 0; ++round, now = 1 - now) {
    if (round == most_rounds) {
      for (int i = 0; i < lists[now].size; ++i) block.given_up[lists[now].slots[i]] = true;
      break;
    }
    fill(lists[now]);
    lists[1 - now].size = 0;
    follow_round<V, true, Measured>(block, lists[now].slots, lists[now].size, settling, false,
                                    lists[1 - now], again);
  }
  fill(again);
}

/// Simulates the first `count` releases of a block.
template <class V>
void follow_block(KernelBlock& block, int count, Asked asked) {
  constexpr int widest = KernelBlock::widest;
  for (int k = 0; k < KernelBlock::inputs; ++k)
    for (int i = count; i < (count + widest - 1) / widest * widest; ++i)
      block.input[k][i] = block.input[k][count - 1];
  for (int i = 0; i < count; ++i) block.given_up[i] = block.unsure[i] = false;
  SlotList again, none;
  if (asked == Asked::state) {
    follow_all<V, false>(block, nullptr, count, false, false, none);
    return;
  }
  const bool settling = asked == Asked::settling;
  follow_all<V, true>(block, nullptr, count, settling, false, again);
  if (again.size > 0) follow_all<V, true>(block, again.slots, again.size, settling, true, none);
}

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
