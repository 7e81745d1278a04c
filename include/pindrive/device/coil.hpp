/// Coil of one pin over time: commands to voltage, flux and the pieces of the pull.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/device/electromagnet.hpp"

namespace pindrive::device {

/// State of a coil: its last change of voltage, gap or resistance, and the position since then.
template <class T>
struct CoilState {
  T since{0};      ///< time of that change, s
  T flux{0};       ///< flux linkage then
  T warming{0};    ///< above 20 °C then, K
  T level{1};      ///< voltage while it is on
  T commanded{0};  ///< time of the command to switch on, s
  bool on{false};  ///< voltage across it
  bool command{false};
};

/// Coil that is simulated from change to change: next() is the time of the next one, pass() goes
/// beyond. Between changes the pull is one piece.
template <class T>
class Coil {
 public:
  /// A coil without current, switched off.
  Coil(const Electromagnet<T>& magnet, T time) : magnet_(&magnet) {
    state_.since = time;
    begin_piece();
  }
  /// A coil in a state that was kept; pass() goes to the present piece of the pull.
  Coil(const Electromagnet<T>& magnet, const CoilState<T>& state)
      : magnet_(&magnet), state_(state) {
    begin_piece();
  }

  /// A coil at a time, from a state before. A last change after that time, as on another clock, counts as one
  /// at the time.
  static Coil begun(const Electromagnet<T>& magnet, CoilState<T> from, T time) {
    from.since = std::min(from.since, time);
    from.commanded = std::min(from.commanded, time);
    const bool ends = from.on && !from.command;  // the command ends at that time
    from.command = from.command || ends;
    Coil coil(magnet, from);
    coil.pass(time);
    if (ends) {
      coil.command(false, time);
      coil.pass(time);
    }
    return coil;
  }

  const CoilState<T>& state() const { return state_; }
  const FluxPiece<T>& piece() const { return piece_; }

  /// Follows a command; a command that is in force changes nothing.
  void command(bool on, T time) {
    if (on == state_.command) return;
    state_.command = on;
    if (!on) {
      if (state_.on) change(false, 1, time);
      return;
    }
    state_.commanded = time;
    if (!magnet_->steps().empty())
      change(true, magnet_->steps()[0].level, time);
    else if (!magnet_->pulses() || time < pulse_end())
      change(true, 1, time);
  }

  /// Time at which the present piece of the pull ends, s; infinite without a change to come.
  T next() const {
    return std::min({saturated_ ? infinity : saturating_, closing_, heating_, next_voltage()});
  }

  /// Goes beyond all changes until a time.
  void pass(T until) {
    for (T time = next(); time <= until; time = next()) pass_next(time);
  }

  const PullPiece<T>& pull_piece() const { return pull_; }
  T pull(T time) const { return pull_.at(time); }
  /// Flux linkage; at the instant at which the gap closes or opens, exactly that of the change.
  T flux(T time) const {
    return time == closing_ ? magnet_->given().closing_flux
                            : piece_.flux_after(time - piece_.begin);
  }
  /// Current, a part of the full one.
  T current(T time) const { return piece_.current(flux(time)); }
  /// Warming above 20 °C, K; 0 where the temperature is not simulated.
  T warming(T time) const { return magnet_->warming_after(piece_, time - piece_.begin); }

 private:
  static constexpr T infinity{std::numeric_limits<double>::infinity()};

  /// Time from which the present voltage follows: the command or the last change.
  T reference() const { return std::max(state_.since, state_.commanded); }
  /// Number of the pulse that began last at that time: pulses begin at multiples of the period.
  T pulse() const {
    const T frequency = magnet_->given().pulse_frequency, time = reference();
    const T number = floor(time * frequency);
    if ((number + 1) / frequency <= time) return number + 1;  // rounded down
    return number / frequency <= time ? number : number - 1;
  }
  T pulse_end() const {
    return (pulse() + magnet_->given().pulse_duty) / magnet_->given().pulse_frequency;
  }
  /// Index of the next voltage step.
  std::size_t next_step() const {
    const std::vector<VoltageStep<T>>& steps = magnet_->steps();
    std::size_t next = 1;
    while (next < steps.size() && state_.commanded + steps[next].time <= reference()) ++next;
    return next;
  }

  T next_voltage() const {
    if (!state_.command) return infinity;
    if (const std::vector<VoltageStep<T>>& steps = magnet_->steps(); !steps.empty()) {
      const std::size_t next = next_step();
      return next < steps.size() ? state_.commanded + steps[next].time : infinity;
    }
    if (!magnet_->pulses()) return infinity;
    return state_.on ? pulse_end() : (pulse() + 1) / magnet_->given().pulse_frequency;
  }

  void pass_next(T time) {
    const T voltage = next_voltage(), own = std::min(closing_, heating_);
    if (time < std::min(voltage, own)) {
      saturated_ = true;
      pull_ = magnet_->pull_piece(piece_, true);
    } else if (own < voltage) {
      change(state_.on, state_.level, own);
    } else if (!magnet_->steps().empty()) {
      change(true, magnet_->steps()[next_step()].level, time);
    } else {
      change(!state_.on, 1, time);
    }
  }

  /// Begins a piece, in which the flux continues.
  void change(bool on, T level, T time) {
    const T linked = flux(time), warm = warming(time);
    state_.since = time;
    state_.flux = linked;
    state_.warming = warm;
    state_.on = on;
    state_.level = level;
    begin_piece();
  }
  void begin_piece() {
    const CoilState<T>& s = state_;
    piece_ = magnet_->piece(s.since, s.flux, s.warming, s.on, s.level);
    closing_ = s.since + magnet_->closing_after(piece_);
    heating_ = s.since + magnet_->heating_after(piece_);
    saturating_ = s.since + magnet_->saturating_after(piece_);
    saturated_ = false;
    pull_ = magnet_->pull_piece(piece_, false);
  }

  const Electromagnet<T>* magnet_;
  CoilState<T> state_;
  FluxPiece<T> piece_{};
  PullPiece<T> pull_{};
  T closing_{infinity}, heating_{infinity};  ///< times of the next change by itself, s
  T saturating_{infinity};  ///< time at which the iron saturates, or ceases to be saturated, s
  bool saturated_{false};   ///< that time has passed
};

}  // namespace pindrive::device
