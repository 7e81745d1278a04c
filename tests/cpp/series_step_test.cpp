// A step of a series: its state at a time, and an input over its span.
#include "pindrive/series/series_step.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

int main() {
  pd::detail::SeriesStep<double> step;
  for (auto* quantity : {&step.position, &step.velocity, &step.skin}) {
    quantity->span = 2;
    quantity->degree = 1;
  }
  step.position.c = {1, 2};
  step.velocity.c = {3, -1};
  step.skin.c = {0, 4};
  const auto half = step.at(1);
  expect(step.span() == 2, "the span is that of the quantities");
  expect(half.x == 2 && half.v == 2.5 && half.skin == 2, "the state half way along the step");
  const auto input = step.input({5, 0.25});
  expect(input.span == 2 && input.at(0) == 5 && near(input.at(2), 5.5, 1e-15),
         "an input is a polynomial over the same span");
  return check::status();
}
