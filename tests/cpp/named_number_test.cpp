// The lists of named numbers: what every interface of pindrive writes under each name.
#include "pindrive/numbers/named_number.hpp"

#include <cstring>
#include <set>
#include <string>

#include "check.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/motion/energy.hpp"
#include "pindrive/motion/transient.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

struct Sizes {
  double width, height;
};
constexpr pd::NamedNumber<double, Sizes> sizes[] = {
    {"width", [](const Sizes& s) { return s.width; }},
    {"height", [](const Sizes& s) { return s.height; }},
};

/// True if all numbers of a list have names, and no two one name.
template <class T, class Result, int count>
bool distinct(const pd::NamedNumber<T, Result> (&numbers)[count]) {
  std::set<std::string> names;
  for (const auto& number : numbers) names.insert(number.name);
  return static_cast<int>(names.size()) == count && names.count("") == 0;
}

}  // namespace

int main() {
  const Sizes result{2, 3};
  double total = 0;
  for (const auto& number : sizes)
    total += std::strcmp(number.name, "height") == 0 ? 10 * number.of(result) : number.of(result);
  expect(total == 32, "a list gives each number under its name");
  expect(distinct(pd::transient_numbers<double>),
         "the names of a transient's numbers are distinct");
  expect(distinct(pd::ledger_numbers<double>), "... of an energy ledger's");
  expect(distinct(pd::certificate_numbers<double>), "... and of a certificate's");
  return check::status();
}
