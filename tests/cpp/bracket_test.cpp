// The root of a path in a bracket, of a parabola, and the exact start of a path.
#include "pindrive/flow/bracket.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

int main() {
  using Path = pd::Path<double>;
  const pd::Oscillator<double> o(0.01, 0, 100);  // 100 rad/s
  const Path cosine{1, 1, 0};
  const double quarter = 0.0157079632679489662;
  expect(near(pd::detail::root_between(o, cosine, 0.01, 0.02, 1), quarter, 1e-17),
         "the root of a cosine is found to rounding");
  expect(near(pd::detail::root_between(o, cosine, 0.01, 0.02, 1, 0.0199), quarter, 1e-17),
         "from any guess");

  using Dual = pd::Dual<double>;
  const pd::Oscillator<Dual> dual(Dual(0.01), Dual(0.0), Dual(100.0, 1.0));
  const pd::Path<Dual> falling{Dual(1), Dual(1), Dual(0)};
  const Dual root = pd::detail::Rooted<Dual>::at(dual, falling, Dual(quarter));
  expect(near(root.slope, -quarter / 200, 1e-17), "the root moves with the stiffness: -τ/2k");

  expect(pd::detail::parabola_root(Path{1, 0, 0, -2}, 1) == 0.5, "a line falls to zero");
  expect(pd::detail::parabola_root(Path{1, 0, 0, 0, -2}, 1) == 1, "a parabola falls to zero");
  expect(!(pd::detail::parabola_root(Path{1, 0, 0, 2}, 1) < 1e300), "what rises has no root");

  const Path below = pd::detail::exact_at_start(o, Path{-1e-20, 0, 0, 1}, 1);
  expect(below.start == 0 && below.drift == 1, "a start beyond zero by rounding is zero");
  const Path still = pd::detail::exact_at_start(o, Path{0, 0, 0, -1e-20}, 1);
  expect(still.drift == 0, "a slope to the wrong side is zero");
  return check::status();
}
