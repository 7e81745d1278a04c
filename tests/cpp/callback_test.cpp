// Callbacks: what a call returns, and what reaches the object.
#include "pindrive/numbers/callback.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

/// Calls a callback until it ends the count.
int counted(pd::Callback<int> more) {
  int count = 0;
  while (count < 5 && more(count)) ++count;
  return count;
}

}  // namespace

int main() {
  expect(counted({}) == 5, "an empty callback continues");
  int sum = 0;
  expect(counted([&](int i) { sum += i; }) == 5 && sum == 10,
         "an object that returns nothing continues and receives each argument");
  expect(counted([](int i) { return i < 3; }) == 3,
         "an object that returns false ends the computation");
  const auto constant = [](int i) { return i < 2; };
  const pd::Callback<int> once = constant, copy = once;
  expect(counted(copy) == 2, "a copy calls the same object");
  int done = 0;
  const auto attended = [&](int more = 2) { return (done += more) < 3; };
  const pd::GoOn go_on = attended;
  expect(go_on() && !go_on() && done == 4, "default arguments of the object apply");
  return check::status();
}
