/// A drive as a functional mock-up unit has it: variables by number, a life in phases, states that are kept.
/// What FMI 2 and FMI 3 have in common, over the C interface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "pindrive.h"

namespace pindrive_fmu {

struct FreeStepper {
  void operator()(pindrive_stepper* stepper) const { pindrive_stepper_free(stepper); }
};
using Stepper = std::unique_ptr<pindrive_stepper, FreeStepper>;

/// A variable of the unit; its number is its place in the list, from 1 on. Number 0 is the time.
struct Variable {
  enum Kind : signed char { parameter, input, output } kind;
  std::string name;
  double start{0};
};

/// Which of the outputs, and of the inputs, a variable is: the places in these lists. The first outputs are
/// those of pindrive_quantity.
enum Output : signed char {
  position,
  velocity,
  acceleration,
  plate_force,
  finger_force,
  stretch,
  stretch_rate,
  next_event_time,
  plate_state,
  finger_state,
  output_count
};
enum Input : signed char { mouse_velocity, mouse_velocity_rate, plate_load, plate_load_rate };

/// What of an instance changes while it lives, but for its stepper.
struct Values {
  std::vector<double> start;  ///< of parameters and inputs, by number
  double begin{0};            ///< start time, s
  bool initialised{false};
};

/// What a failed call was given and what is allowed.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Instance {
 public:
  /// `folder` holds `drive.txt`, which lists the variables with their start values.
  /// Throws Failure where it cannot be read, or belongs to another unit.
  Instance(const std::string& folder, const std::string& token);

  // All that follow throw Failure where a call is refused.
  void set_start_time(double time);
  void initialise();  ///< ends the initialisation
  void reset();

  double number(std::size_t reference);
  int whole(std::size_t reference);  ///< of the states of the contacts
  void set(std::size_t reference, double value);
  void set_rate(std::size_t reference, double rate);  ///< of an input

  double now();
  double next_event();
  /// Goes on by a step, to the first event where it may end early; whether there is an event.
  bool step(double from, double size, bool may_end_early);
  /// Of `unknown` along the seeds of inputs; before the initialisation has ended, of parameters too.
  double derivative(std::size_t unknown, const unsigned* knowns, const double* seeds,
                    std::size_t count);

  struct State {
    Values values;
    Stepper stepper;
  };
  State* keep();
  void go_back(const State& state);
  static std::vector<unsigned char> written(const State& state);
  State* read(const unsigned char* bytes, std::size_t size) const;

 private:
  const Variable& variable(std::size_t reference) const;
  int place(std::size_t reference, Variable::Kind kind) const;
  Stepper made(const std::vector<double>& numbers, const double* seeds) const;
  pindrive_stepper* stepper();
  pindrive_instant instant();

  std::vector<Variable> variables_;
  Values values_;
  Stepper stepper_;
};

}  // namespace pindrive_fmu
