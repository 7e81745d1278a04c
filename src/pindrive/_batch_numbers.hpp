// Which numbers a batch has, and where each comes from: of the general core, and of the kernel.
#pragma once

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

inline constexpr int no_column = -1;  // of the kernel: a number that plain releases do not have

/// A number that is read off a summary or a ledger, or a column of the kernel's.
template <class Source>
struct Number {
  const char* name;  ///< in the table of quantities
  double (*of)(const Source&);
  int column = no_column;
};

inline constexpr Number<Summary> numbers[] = {
    {"transient.peak_displacement", [](const Summary& s) { return s.transient.peak_displacement; },
     PlainNumber::peak_displacement},
    {"transient.peak_time", [](const Summary& s) { return s.transient.peak_time; },
     PlainNumber::peak_time},
    {"transient.trough_displacement",
     [](const Summary& s) { return s.transient.trough_displacement; },
     PlainNumber::trough_displacement},
    {"transient.trough_time", [](const Summary& s) { return s.transient.trough_time; },
     PlainNumber::trough_time},
    {"transient.swing", [](const Summary& s) { return s.transient.swing; }, PlainNumber::swing},
    {"transient.return_velocity", [](const Summary& s) { return s.transient.return_velocity; },
     PlainNumber::return_velocity},
    {"transient.return_velocity_time",
     [](const Summary& s) { return s.transient.return_velocity_time; },
     PlainNumber::return_velocity_time},
    {"transient.first_reversal_time",
     [](const Summary& s) { return s.transient.first_reversal_time; },
     PlainNumber::first_reversal_time},
    {"transient.settling_time", [](const Summary& s) { return s.transient.settling_time; },
     PlainNumber::settling_time},
    {"transient.rest_time", [](const Summary& s) { return s.transient.rest_time; },
     Block::rest_time},
    {"transient.last_event_time", [](const Summary& s) { return s.transient.last_event_time; },
     Block::rest_time},  // the event is that it comes to rest
    {"transient.peak_stretch", [](const Summary& s) { return s.transient.peak_stretch; }},
    {"transient.peak_stretch_rate", [](const Summary& s) { return s.transient.peak_stretch_rate; }},
    {"transient.plate.reversals", [](const Summary& s) { return s.transient.plate.reversals; },
     PlainNumber::plate_reversals},
    {"transient.plate.time_stuck", [](const Summary& s) { return s.transient.plate.time_stuck; },
     PlainNumber::plate_time_stuck},
    {"transient.plate.distance_slid",
     [](const Summary& s) { return s.transient.plate.distance_slid; },
     PlainNumber::plate_distance_slid},
    {"transient.plate.dissipated", [](const Summary& s) { return s.transient.plate.dissipated; },
     PlainNumber::plate_dissipated},
    {"transient.plate.peak_force", [](const Summary& s) { return s.transient.plate.peak_force; },
     PlainNumber::plate_peak_force},
    {"transient.finger.reversals", [](const Summary& s) { return s.transient.finger.reversals; },
     PlainNumber::finger_reversals},
    {"transient.finger.time_stuck", [](const Summary& s) { return s.transient.finger.time_stuck; },
     PlainNumber::finger_time_stuck},
    {"transient.finger.distance_slid",
     [](const Summary& s) { return s.transient.finger.distance_slid; },
     PlainNumber::finger_distance_slid},
    {"transient.finger.dissipated", [](const Summary& s) { return s.transient.finger.dissipated; },
     PlainNumber::finger_dissipated},
    {"transient.finger.peak_force", [](const Summary& s) { return s.transient.finger.peak_force; },
     PlainNumber::finger_peak_force},
    {"ending.position", [](const Summary& s) { return s.transient.end_position; },
     Block::rest_position},
    {"ending.steady_since", [](const Summary& s) { return s.transient.steady_since; }},
    {"ending.amplitude", [](const Summary& s) { return s.transient.amplitude; }},
    {"ending.period", [](const Summary& s) { return s.outcome.period; }},
    {"duration", [](const Summary& s) { return s.duration; }, PlainNumber::duration},
    {"final.position", [](const Summary& s) { return s.final_position; }, Block::final_position},
    {"final.velocity", [](const Summary& s) { return s.final_velocity; }, Block::final_velocity},
};
inline constexpr Number<Ledger> energies[] = {
    {"energy.kinetic_start", [](const Ledger& l) { return l.kinetic_start; }},
    {"energy.kinetic_end", [](const Ledger& l) { return l.kinetic_end; }},
    {"energy.spring_start", [](const Ledger& l) { return l.spring_start; }},
    {"energy.spring_end", [](const Ledger& l) { return l.spring_end; }},
    {"energy.skin_start", [](const Ledger& l) { return l.skin_start; }},
    {"energy.skin_end", [](const Ledger& l) { return l.skin_end; }},
    {"energy.plate_work", [](const Ledger& l) { return l.plate_work; }},
    {"energy.inertia_work", [](const Ledger& l) { return l.inertia_work; }},
    {"energy.force_work", [](const Ledger& l) { return l.force_work; }},
    {"energy.damper_dissipated", [](const Ledger& l) { return l.damper_dissipated; }},
    {"energy.plate_dissipated", [](const Ledger& l) { return l.plate_dissipated; }},
    {"energy.finger_dissipated", [](const Ledger& l) { return l.finger_dissipated; }},
    {"energy.residual", [](const Ledger& l) { return l.residual(); }},
};
/// A row of the results: one of those tables.
struct Row {
  const Number<Summary>* number{nullptr};
  const Number<Ledger>* energy{nullptr};

  explicit Row(const std::string& name) {
    for (const auto& each : numbers)
      if (name == each.name) number = &each;
    for (const auto& each : energies)
      if (name == each.name) energy = &each;
    if (!number && !energy) throw std::invalid_argument("there is no number " + name);
  }
  /// What the kernel must be asked for it.
  pd::detail::Asked asked() const {
    using pd::detail::Asked;
    if (!number || number->column == no_column || number->column >= Block::rest_position)
      return Asked::state;
    return number->column == PlainNumber::settling_time ? Asked::settling : Asked::numbers;
  }
};

}  // namespace pindrive_extension
