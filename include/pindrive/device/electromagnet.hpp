/// Electromagnet of a pin: flux linkage from the voltage, and pull from the flux. A flux linkage is a part of that of the full current
/// with a closed gap, a voltage a part of the full one.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "pindrive/numbers/functions.hpp"

namespace pindrive::device {

/// Voltage from a time since the coil was switched on, until the next step.
struct VoltageStep {
  double time;   ///< s; the first 0
  double level;  ///< part of the full voltage, from 0 to 1
};

/// Exponential approach of the flux linkage at constant voltage and gap.
struct FluxPiece {
  double begin;       ///< s
  double start;       ///< flux linkage at the begin
  double target;      ///< flux linkage that it tends to
  double constant;    ///< time constant, s
  double inductance;  ///< over that with the closed gap
  double warming;     ///< warming of the coil at the begin, K
  double resistance;  ///< resistance of the winding, over that at 20 °C
  bool on;
  double level;  ///< voltage while it is on

  double swing() const { return start - target; }
  double flux_after(double lasts) const {
    const double left = detail::exp(-lasts / constant);
    return target == 1 ? 1 - (1 - start) * left : target + swing() * left;
  }
  /// Current, a part of the full one, with a flux linkage.
  double current(double flux) const { return flux / inductance; }
};

/// Pull from a time on: constant + once·E + twice·E², where E = e^(−rate·(t − begin)).
struct PullPiece {
  double begin;        ///< s
  double constant;     ///< N
  double once, twice;  ///< N
  double rate;         ///< 1/s

  double at(double time) const {
    const double left = detail::exp(-rate * (time - begin));
    return constant + (once + twice * left) * left;
  }
};

/// Parameters of an electromagnet, SI.
struct MagnetParameters {
  double hold_force, residual;  ///< pull at full and without current, N
  double saturation;            ///< flux linkage from which on the pull is constant
  double rise_constant,
      fall_constant;          ///< time constants of the flux linkage, gap closed, 20 °C, s
  double closing_flux{0};     ///< flux linkage at which the gap closes and opens
  double open_inductance{1};  ///< inductance with the open gap over that with the closed one
  double pulse_frequency{0};  ///< Hz; 0 for a continuous voltage
  double pulse_duty{1};       ///< part of each period for which the coil is on
  double winding_resistance{0}, outer_resistance{0};  ///< resistances of coil and decay path, ohm
  double power{0};                                    ///< at full current and 20 °C, W
  double thermal_resistance{0};                       ///< K/W
  double heat_capacity{0};                            ///< J/K; 0: the temperature is not simulated
};

/// Electromagnet with constant parameters.
class Electromagnet {
 public:
  explicit Electromagnet(const MagnetParameters& given, std::vector<VoltageStep> steps = {})
      : given_(given), steps_(std::move(steps)) {}

  const MagnetParameters& given() const { return given_; }
  const std::vector<VoltageStep>& steps() const { return steps_; }
  bool pulses() const {
    return steps_.empty() && given_.pulse_duty < 1 && given_.pulse_frequency > 0;
  }
  bool heats() const { return given_.heat_capacity > 0; }

  /// Pull at a flux linkage, N: with its square until the iron saturates.
  double pull(double flux) const {
    const double part = flux / given_.saturation;
    return given_.residual + (given_.hold_force - given_.residual) * std::min(part * part, 1.0);
  }

  /// Piece from a flux linkage and a warming on. Just where the gap closes or opens, the direction of
  /// the flux decides.
  FluxPiece piece(double begin, double start, double warming, bool on, double level) const {
    const double resistance = heats() ? resistance_in_piece(start, warming, on, level) : 1;
    double target = 0, constant = given_.fall_constant;
    if (on) {
      target = level / resistance;
      constant = given_.rise_constant / resistance;
    } else if (resistance != 1) {
      constant *= (given_.winding_resistance + given_.outer_resistance) /
                  (resistance * given_.winding_resistance + given_.outer_resistance);
    }
    const double edge = given_.closing_flux;
    const bool closed = start > edge || (start == edge && target > edge);
    const double inductance = closed ? 1 : given_.open_inductance;
    return {begin,      start,   target * inductance, constant * inductance,
            inductance, warming, resistance,          on,
            level};
  }

  /// Time after the begin of a piece at which the gap closes or opens, s; infinite if it does not.
  double closing_after(const FluxPiece& piece) const {
    const double edge = given_.closing_flux;
    const bool passes = piece.inductance == 1 ? piece.start > edge && edge > piece.target
                                              : piece.start < edge && edge < piece.target;
    if (!passes) return infinity;
    return piece.constant * detail::log(piece.swing() / (edge - piece.target));
  }

  /// Time after the begin of a piece for which its constant resistance is within `resistance_step` of
  /// that of the warming coil, s. While the coil is off its current has decayed long before.
  double heating_after(const FluxPiece& piece) const {
    if (!heats() || !piece.on) return infinity;
    const double rate = std::max(heating_rate(piece), piece.warming / cooling_constant());
    return rate > 0 ? resistance_step / (copper_rise * rate) : infinity;
  }

  /// Warming of the coil at a time after the begin of a piece, K: a closed form.
  double warming_after(const FluxPiece& piece, double lasts) const {
    if (!heats()) return 0;
    const double target = piece.current(piece.target), swing = piece.current(piece.swing());
    const double cooling = 1 / cooling_constant();
    const double heating = given_.power * piece.resistance / given_.heat_capacity;
    const double shares[]{target * target, 2 * target * swing, swing * swing};
    double found = piece.warming * detail::exp(-cooling * lasts);
    for (int i = 0; i < 3; ++i) {
      const double rate = i / piece.constant, apart = std::abs(cooling - rate) * lasts;
      const double mean = apart > 0 ? -detail::expm1(-apart) / apart : 1;
      found += heating * shares[i] * lasts * detail::exp(-std::min(rate, cooling) * lasts) * mean;
    }
    return found;
  }

  /// Time after the begin of a piece at which the iron saturates, or ceases to be saturated, s; infinite if it
  /// does not.
  double saturating_after(const FluxPiece& piece) const {
    const double edge = given_.saturation;
    if ((piece.start > edge) == (piece.target > edge) || piece.start == edge) return infinity;
    return piece.constant * detail::log(piece.swing() / (edge - piece.target));
  }

  /// Pull in a piece before or after the time at which the iron saturates, or ceases to be saturated.
  PullPiece pull_piece(const FluxPiece& piece, bool after) const {
    const double edge = given_.saturation, whole = given_.hold_force - given_.residual;
    const double begin = after ? piece.begin + saturating_after(piece) : piece.begin;
    const double from = after ? edge : piece.start;
    const bool saturated = after ? piece.target > edge : from >= edge && piece.target >= edge;
    if (saturated || (!after && from > edge)) return {begin, given_.hold_force, 0, 0, 0};
    const double target = piece.target / edge, swing = from / edge - target;
    return {begin, given_.residual + whole * target * target, 2 * whole * target * swing,
            whole * swing * swing, 1 / piece.constant};
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  /// Part by which the resistance of annealed copper grows per kelvin from 20 °C (IEC 60028).
  static constexpr double copper_rise = 3.93e-3;
  /// Largest change of the resistance within a piece. Without it a coil that is held on pulls by 17 %
  /// too much after 20 s at 2 V; with it the pull is within 0.1 % of the coupled equations.
  static constexpr double resistance_step = 5e-4;

  double cooling_constant() const { return given_.thermal_resistance * given_.heat_capacity; }
  /// Largest heating in a piece at its resistance, K/s.
  double heating_rate(const FluxPiece& piece) const {
    const double current = piece.current(std::max(piece.start, piece.target));
    return given_.power * piece.resistance * current * current / given_.heat_capacity;
  }

  /// Resistance half a step later: the mean of a piece that lasts as long as it may.
  double resistance_in_piece(double flux, double warming, bool on, double level) const {
    const double now = 1 + copper_rise * warming;
    if (!on) return now;
    const double current = std::max(flux, level / now);
    const double heating = given_.power * now * current * current / given_.heat_capacity;
    const double cooling = warming / cooling_constant();
    const double most = std::max(heating, cooling);
    return most > 0 ? now + 0.5 * resistance_step * (heating - cooling) / most : now;
  }

  MagnetParameters given_;
  std::vector<VoltageStep> steps_;
};

}  // namespace pindrive::device
