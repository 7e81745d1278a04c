// The list of the numbers of a motion: each has a name of its own and reads a member of its own.
#include "pindrive/motion/transient_numbers.hpp"

#include <cmath>
#include <cstring>
#include <set>
#include <string>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

int main() {
  pd::Transient<double> numbers;
  std::set<std::string> names;
  std::set<double> values;
  auto* members = reinterpret_cast<double*>(&numbers);
  for (std::size_t i = 0; i < sizeof numbers / sizeof(double); ++i) members[i] = double(i);
  for (const auto& number : pd::transient_numbers<double>) {
    names.insert(number.name);
    values.insert(number.of(numbers));
  }
  constexpr std::size_t count = std::size(pd::transient_numbers<double>);
  expect(names.size() == count, "no two numbers have one name");
  expect(values.size() == count, "no two numbers read one member");
  const pd::Transient<double> none;
  bool missing = true;
  for (const auto& number : pd::transient_numbers<double>)
    if (std::strstr(number.name, "transient.plate") == nullptr &&
        std::strstr(number.name, "transient.finger") == nullptr)
      missing = missing && std::isnan(number.of(none));
  expect(missing, "a number that does not exist is NaN");
  return check::status();
}
