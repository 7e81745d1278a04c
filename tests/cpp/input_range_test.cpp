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
  const pd::InputPiece<double> bends[]{{0, {1, -2e5, 1}, nullptr, 0}};
  expect(std::abs(pd::lowest_value(Profile(bends, 1), never).value - (1 - 1e10)) < 1e-4,
         "a parabola has its vertex");
  const pd::InputPiece<double> ramp[]{{0, {1, 0.2}, terms, 1}};
  const pd::InputPoint first = pd::lowest_value(Profile(ramp, 1), never);
  expect(first.time < 0.1 && std::abs(first.value - 0.268) < 1e-3,
         "a sinusoid on a ramp is lowest in its first period");
  const pd::InputPiece<double> sinks[]{{0, {1, 0, -1e-9}, terms, 1}};
  expect(pd::lowest_value(Profile(sinks, 1), never).value == -never, "a sinking sinusoid falls");
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
