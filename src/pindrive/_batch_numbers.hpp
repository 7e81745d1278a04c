// Which numbers a batch has, and where each comes from: of the general core, and of the kernel.
#pragma once

#include <iterator>
#include <stdexcept>
#include <string>

#include "pindrive/batch.hpp"
#include "pindrive/energy.hpp"
#include "pindrive/kernel_block.hpp"

namespace pindrive_extension {

namespace pd = pindrive;
using Block = pd::detail::KernelBlock;
using pd::detail::PlainNumber;

/// Of one point: all its numbers, and where it is in the end.
struct Summary : pd::Summary<double> {
  double final_position, final_velocity;
};
using Ledger = pd::Ledger<double>;

using pd::detail::no_column;
using pd::detail::transient_columns;
static_assert(std::size(transient_columns) == std::size(pd::transient_numbers<double>));

/// What a batch has beside the transient's numbers and the terms of the ledger.
inline constexpr pd::NamedNumber<double, Summary> state_numbers[] = {
    {"duration", [](const Summary& s) { return s.duration; }},
    {"final.position", [](const Summary& s) { return s.final_position; }},
    {"final.velocity", [](const Summary& s) { return s.final_velocity; }},
};
inline constexpr int state_columns[] = {PlainNumber::duration, Block::final_position,
                                        Block::final_velocity};

/// A row of the results: a number of a summary, a column of the kernel's, or a term of the ledger.
struct Row {
  double (*transient)(const pd::Transient<double>&){nullptr};
  double (*state)(const Summary&){nullptr};
  double (*energy)(const Ledger&){nullptr};
  int column = no_column;

  explicit Row(const std::string& name) {
    std::size_t k = 0;
    for (const auto& each : pd::transient_numbers<double>) {
      if (name == each.name) transient = each.of, column = transient_columns[k];
      ++k;
    }
    k = 0;
    for (const auto& each : state_numbers) {
      if (name == each.name) state = each.of, column = state_columns[k];
      ++k;
    }
    for (const auto& each : pd::ledger_numbers<double>)
      if (name == std::string("energy.") + each.name) energy = each.of;
    if (!transient && !state && !energy) throw std::invalid_argument("there is no number " + name);
  }
  double of(const Summary& summary) const {
    return transient ? transient(summary.transient) : state(summary);
  }
  /// What the kernel must be asked for it.
  pd::detail::Asked asked() const {
    using pd::detail::Asked;
    if (column == no_column || column >= Block::rest_position) return Asked::state;
    return column == PlainNumber::settling_time ? Asked::settling : Asked::numbers;
  }
};

}  // namespace pindrive_extension
