/// Electromagnet of a drive, simulated from command to command: commands to current, current to
/// pull, and the pull over time as the lines of a scan of the Python package
/// (pindrive.device.electromagnet derives them).
#pragma once

#include <cstdint>
#include <vector>

#include "parameters.hpp"

namespace pindrive_fmu {

/// State of the magnet: its last switching, or closing or opening of its gap, and the time since
/// then.
struct CoilState {
  double since{0};    ///< time of that change, s
  double flux{0};     ///< the flux linkage then, a part of that of the full current, the gap closed
  double pull{0};     ///< then, N
  double warming{0};  ///< then, above 20 °C, K
  double level{1};    ///< the voltage across it while it is on, a part of the full one
  double commanded{0};    ///< time of the command to switch on, s, if commanded
  double period{0};       ///< number of the present or next pulse
  std::uint64_t step{0};  ///< present row of the voltage
  std::uint64_t row{0};   ///< present row of the pull
  std::uint32_t command{0}, on{0};
};

class Magnet {
 public:
  /// Refused where a parameter is out of its range.
  pindrive_error begin(const Given& given, double time);
  bool present() const { return present_; }
  static Number first_load(const Given& given);

  void command(bool on, double time);
  /// End of the line of the pull, s: pass() crosses it.
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
  /// Continuation of the flux linkage at constant voltage and gap.
  struct Piece {
    double target, constant, inductance;  ///< the last over that of the closed gap
    double end;  ///< time of the closing or opening of the gap, s; infinity: never
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
  double frequency_{0}, duty_{1};  // pulses: Hz, and part
  double own_resistance_{0}, outer_resistance_{0}, power_{0}, cooling_resistance_{0};
  double heat_capacity_{0};  // 0: the temperature is not followed
  double edge_{0};           // the flux linkage beyond which the gap is closed
  double opened_{1};         // the inductance while it is open over that while it is closed
  std::vector<Row> steps_;   // voltage over time, as a part of the full voltage
  std::vector<double> rising_, falling_;
  std::vector<Row> rows_;  // pull since the last switching
  CoilState state_;
};

}  // namespace pindrive_fmu
