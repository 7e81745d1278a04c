/// The variables of a unit: inputs and outputs by their names, and the list that the archive carries.
#pragma once

#include <vector>

#include "pindrive.h"

namespace pindrive_fmu {

struct Input {
  const char* name;
  double pindrive_instant::* value;
  double pindrive_instant::* rate;
};
constexpr Input inputs[] = {
    {"mouse_velocity", &pindrive_instant::mouse_velocity, &pindrive_instant::mouse_velocity_rate},
    {"plate_load", &pindrive_instant::plate_load, &pindrive_instant::plate_load_rate},
    {"force", &pindrive_instant::force, &pindrive_instant::force_rate},
    {"across_velocity", &pindrive_instant::across_velocity,
     &pindrive_instant::across_velocity_rate},
    {"finger_load", &pindrive_instant::finger_load, &pindrive_instant::finger_load_rate}};
constexpr const char* rate_ending = "_rate";

/// The places of outputs that are none of pindrive_quantity, which come first.
enum Output : signed char {
  next_event_time = PINDRIVE_HOUSING_FORCE + 1,
  magnet_current,
  magnet_pull,
  magnet_warming,
  plate_state
};

/// A variable of the unit; its number is its place in the list, from 1 on. Number 0 is the time.
struct Variable {
  enum Kind : signed char {
    parameter,
    input,
    command,
    luminance,
    output
  } kind;  ///< a command is a Boolean input; luminance, an input without a rate, is in its place
  const char* name;
  double start;
  int place;  ///< among the inputs, each followed by its rate, or among the outputs; −1: of another kind
};

/// A list of variables as `drive.txt` has it: a head with the token, then a line for each: kind, name and the
/// bits of its start value, which no locale changes. The text of the list holds the names.
pindrive_error read_variables(const char* path, const char* token, std::vector<char>& list,
                              std::vector<Variable>& variables);

}  // namespace pindrive_fmu
