/// The electromagnet of a drive, followed from command to command: commands to current, current to pull,
/// and the pull over time as the lines that a scan of the Python package makes of it
/// (pindrive.device.electromagnet, which derives them).
#pragma once

#include <cstdint>
#include <vector>

#include "parameters.hpp"

namespace pindrive_fmu {

/// What of it changes: its last switching, or closing or opening of its gap, and how far it has been
/// followed since.
struct CoilState {
  double since{0};    ///< when that was, s
  double flux{0};     ///< the flux linkage then, a part of that of the full current, the gap closed
  double pull{0};     ///< then, N
  double warming{0};  ///< then, above 20 °C, K
  double level{1};    ///< the voltage across it while it is on, a part of the full one
  double commanded{0};    ///< when it was commanded on, s, if it is
  double period{0};       ///< of pulses: the number of the one that goes on, or comes next
  std::uint64_t step{0};  ///< of the voltage: which of its rows holds
  std::uint64_t row{0};   ///< which row of the pull holds
  std::uint32_t command{0}, on{0};
};

class Magnet {
 public:
  /// Refused where a parameter is out of its range.
  pindrive_error begin(const Given& given, double time);
  bool present() const { return present_; }
  static Number first_load(const Given& given);

  void command(bool on, double time);
  /// When the line of the pull ends, s: pass() goes over that.
  double next() const;
  void pass(double until);

  double load(double time) const { return 1 + pull(time) / normal_force_; }
  double load_rate() const { return rate() / normal_force_; }
  double pull(double time) const;
  double current(double time) const;
  double warming(double time) const;

  const CoilState& state() const { return state_; }
  pindrive_error go_back(const CoilState& state);  ///< refused where that is none

 private:
  struct Row {
    double time, pull;
  };
  /// How the flux linkage goes on while the voltage stays, and the gap closed or open.
  struct Piece {
    double target, constant, inductance;  ///< the last over that of the closed gap
    double end;                           ///< when the gap closes or opens, s; infinity: never
  };

  pindrive_error read(const Given& given);
  pindrive_error read_coil(const Given& given);
  void make_levels();
  void make_rows();
  void make_rows_between(const Piece& piece);
  void change(bool on, double level, double time);
  double next_switching() const;
  Piece piece() const;
  double flux(double time) const;
  double resistance() const;
  double pull_of(double flux) const;
  double rate() const;

  bool present_{false};
  double hold_force_{0}, residual_{0}, saturation_{0}, rise_constant_{0}, fall_constant_{0};
  double deviation_{0}, tolerance_{0}, normal_force_{0};
  double frequency_{0}, duty_{1};  // of pulses
  double own_resistance_{0}, outer_resistance_{0}, power_{0}, cooling_resistance_{0};
  double heat_capacity_{0};  // 0: the temperature is not followed
  double edge_{0};           // the flux linkage beyond which the gap is closed
  double opened_{1};         // the inductance while it is open over that while it is closed
  std::vector<Row> steps_;   // of the voltage: a part of the full one
  std::vector<double> rising_, falling_;
  std::vector<Row> rows_;  // of the pull since then
  CoilState state_;
};

}  // namespace pindrive_fmu
