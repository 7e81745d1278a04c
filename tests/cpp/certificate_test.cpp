// The worst of a certificate is the largest of all its laws, and each of its numbers is that of one law alone.
#include "pindrive/certificate/certificate.hpp"

#include <iterator>
#include <set>
#include <string>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using Certificate = pd::Certificate<double>;

int main() {
  constexpr double Certificate::* laws[] = {
      &Certificate::motion_law,  &Certificate::kinematics,   &Certificate::friction_law,
      &Certificate::force_bound, &Certificate::sliding_sign, &Certificate::sticking,
      &Certificate::continuity,  &Certificate::transitions,  &Certificate::energy,
      &Certificate::dissipation, &Certificate::period,       &Certificate::steady_since,
  };
  const auto& numbers = pd::certificate_numbers<double>;
  expect(Certificate{}.worst() == 0, "nothing found, nothing wrong");
  expect(std::size(numbers) == std::size(laws), "a number for each law");
  std::set<std::string> names;
  for (const auto law : laws) {
    Certificate found;
    found.*law = 3e-7;
    expect(found.worst() == 3e-7, "the worst is that of any law");
    int told = 0;
    for (const auto& number : numbers)
      if (number.of(found) == 3e-7) {
        ++told;
        names.insert(number.name);
      }
    expect(told == 1, "and one number tells it");
  }
  expect(names.size() == std::size(laws), "each by a name of its own");
  return check::status();
}
