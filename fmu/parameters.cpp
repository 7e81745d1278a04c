#include "parameters.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "function_pieces.hpp"

namespace pindrive_fmu {

namespace {

constexpr char table[] = "motion.";

/// Name of a parameter of the motion without its table, "mouse_velocity.amplitude"; null for another.
const char* of_motion(const Variable& variable) {
  constexpr std::size_t length = sizeof table - 1;
  const bool found =
      variable.kind == Variable::parameter && std::strncmp(variable.name, table, length) == 0;
  return found ? variable.name + length : nullptr;
}

bool of_function(const char* name) { return name != nullptr && std::strchr(name, '.') != nullptr; }

/// Gives an input as a function: values or, by `part`, derivatives.
pindrive_error set_function(pindrive_release* release, const char* input,
                            const pindrive::NamedFunction<Number>& function,
                            double Number::* part) {
  std::array<pindrive_piece, 3> pieces{};
  std::array<pindrive_term, 3> terms{};
  pindrive_c::write_pieces(
      function, [&](const Number& number) { return number.*part; }, pieces.data(), terms.data());
  return pindrive_release_set_function(release, input, pieces.data(), function.count);
}

}  // namespace

Given::Given(const std::vector<Variable>& variables, const double* values, const double* seeds)
    : variables_(variables), values_(values), seeds_(seeds) {
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (const char* const name = of_motion(variables[i]); of_function(name))
      of_functions_.emplace_back(name, at(i));
    else if (variables[i].kind == Variable::parameter)
      parameters_.add(variables[i].name, at(i));
}

bool Given::has_luminance() const {
  return std::any_of(variables_.begin(), variables_.end(),
                     [](const Variable& variable) { return variable.kind == Variable::luminance; });
}

const Number* Given::find(const char* input, const char* parameter) const {
  const std::size_t length = std::strlen(input);
  for (const auto& [name, number] : of_functions_)
    if (std::strncmp(name, input, length) == 0 && name[length] == '.' &&
        std::strcmp(name + length + 1, parameter) == 0)
      return &number;
  return nullptr;
}

bool Given::make_function(const char* input, Function& function) const {
  for (const pindrive::FunctionKind& kind : pindrive::function_kinds) {
    std::array<Number, 4> numbers{};
    std::size_t found = 0;
    for (; found < kind.count(); ++found) {
      const Number* const number = find(input, kind.parameters[found]);
      if (number == nullptr) break;
      numbers[found] = *number;
    }
    if (found < kind.count()) continue;
    function = pindrive::named_function(kind, numbers);
    return true;
  }
  return false;
}

pindrive_error Given::fill(pindrive_drive* drive, pindrive_release* release,
                           double Number::* part) const {
  pindrive_error error = parameters_.fill(drive, part);
  for (std::size_t i = 0; i < variables_.size() && !error; ++i) {
    const Variable& variable = variables_[i];
    const char* const name = variable.kind == Variable::input && variable.place % 2 == 0
                                 ? variable.name
                                 : of_motion(variable);
    if (name != nullptr && !of_function(name))
      error = pindrive_release_set(release, name, at(i).*part);
  }
  for (const Input& input : inputs)
    if (Function function; !error && make_function(input.name, function))
      error = set_function(release, input.name, function, part);
  return error;
}

}  // namespace pindrive_fmu
