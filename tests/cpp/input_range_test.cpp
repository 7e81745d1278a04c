// Lowest value and jumps of an input.
#include "pindrive/series/input_range.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using Profile = pd::Profile<double>;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

void lowest_values() {
  const pd::InputTerm<double> terms[]{{0, 0.75, 0, 50}, {0.25, 0, 8, 0}};
  const pd::InputPiece<double> wave[]{{0, {1}, terms, 1}};
  const pd::InputPoint trough = pd::lowest_value(Profile(wave, 1), never);
  expect(std::abs(trough.value - 0.25) < 1e-12,
         "a sinusoid has its lowest value, mean - amplitude");
  const pd::InputPiece<double> dies[]{{0, {0.1}, terms + 1, 1}};
  const pd::InputPoint end = pd::lowest_value(Profile(dies, 1), never);
  expect(end.value > 0.1 - 1e-12 && end.value < 0.1 + 1e-9, "an exponential has its limit");
  const pd::InputPiece<double> falls[]{{0, {1, -2}, nullptr, 0}};
  expect(pd::lowest_value(Profile(falls, 1), never).value == -never &&
             std::abs(pd::lowest_value(Profile(falls, 1), 0.75).value + 0.5) < 1e-15,
         "a falling line falls for ever, or until the end");
  const pd::InputPiece<double> stroke[]{{0, {0.5, 0, -3, 2}, nullptr, 0}, {1, {-0.5}, nullptr, 0}};
  expect(std::abs(pd::lowest_value(Profile(stroke, 2), never).value + 0.5) < 1e-14,
         "each piece counts");
}

void jumps() {
  const pd::InputPiece<double> pieces[]{
      {0, {1, 1}, nullptr, 0}, {0.5, {1.5}, nullptr, 0}, {2, {1.25}, nullptr, 0}};
  const pd::InputJump jump = pd::first_jump(Profile(pieces, 3));
  expect(jump.time == 2 && jump.before == 1.5 && jump.after == 1.25, "a jump is found");
  expect(!(pd::first_jump(Profile(pieces, 2)).time < never), "... and none where there is none");
}

}  // namespace

int main() {
  lowest_values();
  jumps();
  return check::status();
}
