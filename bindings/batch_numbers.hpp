/// Numbers of a batch in Python and C, with their sources in the general core and in the kernel.
#pragma once

#include <cstring>
#include <iterator>

#include "pindrive/kernel/kernel_block.hpp"
#include "pindrive/motion/batch.hpp"
#include "pindrive/motion/energy.hpp"

namespace pindrive::batch {

using Block = pindrive::detail::KernelBlock;
using pindrive::detail::PlainNumber;

/// Result of one point: all numbers, and the final state.
struct Summary : pindrive::Summary<double> {
  double final_position, final_velocity;
};

using pindrive::detail::no_column;
using pindrive::detail::transient_columns;
static_assert(std::size(transient_columns) == std::size(transient_numbers<double>));

/// Numbers of a batch beside the transient's numbers and the terms of the ledger.
inline constexpr NamedNumber<double, Summary> state_numbers[] = {
    {"duration", [](const Summary& s) { return s.duration; }},
    {"final.position", [](const Summary& s) { return s.final_position; }},
    {"final.velocity", [](const Summary& s) { return s.final_velocity; }},
};
inline constexpr int state_columns[] = {PlainNumber::duration, Block::final_position,
                                        Block::final_velocity};

/// A row of the results: a number of a summary, a column of the kernel's, or a term of the ledger, which is
/// called "energy." and its name there.
struct Row {
  double (*transient)(const Transient<double>&){nullptr};
  double (*state)(const Summary&){nullptr};
  double (*energy)(const Ledger<double>&){nullptr};
  int column = no_column;

  /// That of a name; without one it has nothing.
  explicit Row(const char* name) {
    std::size_t k = 0;
    for (const auto& each : transient_numbers<double>) {
      if (std::strcmp(name, each.name) == 0) transient = each.of, column = transient_columns[k];
      ++k;
    }
    k = 0;
    for (const auto& each : state_numbers) {
      if (std::strcmp(name, each.name) == 0) state = each.of, column = state_columns[k];
      ++k;
    }
    constexpr char prefix[] = "energy.";
    if (std::strncmp(name, prefix, sizeof prefix - 1) != 0) return;
    for (const auto& each : ledger_numbers<double>)
      if (std::strcmp(name + sizeof prefix - 1, each.name) == 0) energy = each.of;
  }
  bool exists() const { return transient || state || energy; }
  double of(const Summary& summary) const {
    return transient ? transient(summary.transient) : state(summary);
  }
  /// Part of the kernel that computes the number.
  pindrive::detail::Asked asked() const {
    using pindrive::detail::Asked;
    if (column == no_column || column >= Block::rest_position) return Asked::state;
    return column == PlainNumber::settling_time ? Asked::settling : Asked::numbers;
  }
};

/// The numbers of a motion by the general core, as summarise() has them.
inline Summary with_end(const pindrive::Summary<double>& numbers, const Motion<double>& motion) {
  const auto [segment, tau] = motion.locate(numbers.duration, Side::left);
  Summary all{numbers, 0, 0};
  all.final_position = motion.value(*segment, tau, pindrive::Quantity::position);
  all.final_velocity = motion.value(*segment, tau, pindrive::Quantity::velocity);
  return all;
}

}  // namespace pindrive::batch
