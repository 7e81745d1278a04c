#include "parameters.hpp"

#include <algorithm>
#include <cstring>

namespace pindrive_fmu {

Given::Given(const std::vector<Variable>& variables, const double* values, const double* seeds)
    : variables_(variables), values_(values), seeds_(seeds) {
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (variables[i].kind == Variable::parameter) parameters_.add(variables[i].name, at(i));
}

bool Given::has_luminance() const {
  return std::any_of(variables_.begin(), variables_.end(),
                     [](const Variable& variable) { return variable.kind == Variable::luminance; });
}

pindrive_error Given::fill(pindrive_drive* drive, pindrive_release* release,
                           double Number::* part) const {
  constexpr const char table[] = "motion.";
  constexpr std::size_t length = sizeof table - 1;
  pindrive_error error = parameters_.fill(drive, part);
  for (std::size_t i = 0; i < variables_.size() && !error; ++i) {
    const Variable& variable = variables_[i];
    const double value = at(i).*part;
    if (variable.kind == Variable::input && variable.place % 2 == 0)
      error = pindrive_release_set(release, variable.name, value);
    if (variable.kind == Variable::parameter && std::strncmp(variable.name, table, length) == 0)
      error = pindrive_release_set(release, variable.name + length, value);
  }
  return error;
}

}  // namespace pindrive_fmu
