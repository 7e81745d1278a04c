/// A drive as a functional mock-up unit has it: variables by number, a life in phases, states that are kept.
/// What FMI 2 and FMI 3 have in common, over the C interface.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "pindrive.h"
#include "pindrive/device/coil.hpp"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/electromagnet.hpp"
#include "pindrive/device/scan_inputs.hpp"
#include "variables.hpp"

namespace pindrive_fmu {

struct FreeStepper {
  void operator()(pindrive_stepper* stepper) const { pindrive_stepper_free(stepper); }
};
using Stepper = std::unique_ptr<pindrive_stepper, FreeStepper>;

/// State of a control block that samples an input.
struct ControlState {
  double luminance{1};
  bool decision{false};         ///< after the last sample
  double sample{0};             ///< time of the next sample, s
  std::vector<double> pending;  ///< times of the switchings that are due, s

  double due() const {
    return pending.empty() ? std::numeric_limits<double>::infinity() : pending.front();
  }
};

/// Magnet of a unit, its coil, and the control block of a unit with one; without a magnet, none.
struct Magnet {
  std::unique_ptr<const pindrive::device::Electromagnet<double>> electromagnet;
  std::unique_ptr<pindrive::device::Coil<double>> coil;
  std::unique_ptr<const pindrive::device::Controller> controller;
  ControlState control;
  pindrive::device::Pressing<double> pressing{1};

  bool present() const { return coil != nullptr; }
  /// Time of the next change by itself, or of the next switching, s.
  double next() const { return std::min(coil->next(), control.due()); }
  /// Time of the next switching while the luminance holds, s: one that is due, or that of the next sample.
  double next_switching() const {
    const bool follows =
        controller && controller->decides(control.decision, control.luminance) != control.decision;
    return follows ? std::min(control.due(), control.sample + controller->latency) : control.due();
  }
  /// Time of the next sample, s.
  double next_sample() const {
    return controller ? control.sample : std::numeric_limits<double>::infinity();
  }
  /// Goes beyond all samples, switchings and changes until a time, s; a switching comes before a change.
  void pass(double until);
  /// Factor of the friction of the plate by the present piece of the pull and a touch over the usual one.
  pindrive::OwnedPiece<double> load(const pindrive::LineSince<double>& touch) const {
    return pressing.load_under(coil->pull_piece(), 0.0, touch);
  }
};

/// Variable state of an instance, beside its stepper and its magnet.
struct Values {
  std::vector<double> start;  ///< parameters and inputs, by number; a command is 0 or 1
  double begin{0};            ///< start time, s
  bool initialised{false};
};

/// After a rejected call pindrive_last_error reports the given and the allowed value.
class Instance {
 public:
  /// `folder` holds `drive.txt`, which lists the variables with their start values. Refused where it cannot
  /// be read, or belongs to another unit.
  pindrive_error begin(const char* folder, const char* token);

  pindrive_error set_start_time(double time);
  pindrive_error initialise();  ///< ends the initialisation
  void reset();

  pindrive_error number(std::size_t reference, double& value);
  pindrive_error whole(std::size_t reference, int& value);  ///< states of the contacts
  pindrive_error flag(std::size_t reference, bool& value);  ///< command of the magnet
  pindrive_error set(std::size_t reference, double value);
  pindrive_error set_flag(std::size_t reference, bool value);
  pindrive_error set_rate(std::size_t reference, double rate);  ///< rate of an input

  pindrive_error now(double& time);
  pindrive_error next_event(double& time);
  /// Goes on by a step, to the first event where it may end early; whether there is an event.
  pindrive_error step(double from, double size, bool may_end_early, bool& happens);
  /// Derivative of `unknown` along the seeds of inputs; before the end of the initialisation also
  /// along parameters.
  pindrive_error derivative(std::size_t unknown, const unsigned* knowns, const double* seeds,
                            std::size_t count, double& value);

  struct State {
    Values values;
    pindrive::device::CoilState<double> coil;
    ControlState control;
    Stepper stepper;
  };
  pindrive_error keep(std::unique_ptr<State>& state) const;
  pindrive_error go_back(const State& state);
  static pindrive_error write(const State& state, std::vector<unsigned char>& bytes);
  pindrive_error read(const unsigned char* bytes, std::size_t size,
                      std::unique_ptr<State>& state) const;

 private:
  const Variable* variable(std::size_t reference) const;
  int place(std::size_t reference, Variable::Kind kind) const;
  const char* name(std::size_t reference) const;
  double value_of_input(std::size_t place, const double* values) const;
  pindrive_error make(Stepper& stepper, Magnet& magnet) const;
  pindrive_error settable(std::size_t reference, const Variable*& given) const;
  pindrive_error followed();
  pindrive_error instant(pindrive_instant& now);

  std::vector<char> list_;  ///< holds the names
  std::vector<Variable> variables_;
  Values values_;
  Magnet magnet_;
  Stepper stepper_;
};

}  // namespace pindrive_fmu
