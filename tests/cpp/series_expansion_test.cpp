// A step of a series whose coefficients are known: how long it may be, the same quantities over a part of
// it, and the last terms that are left out.
#include "pindrive/series/series_expansion.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

namespace {

constexpr double unit = std::numeric_limits<double>::epsilon();

/// v = 1/(1 − q σ), σ = τ/span: the coefficients are powers of q.
struct Geometric : pd::detail::SeriesExpansion<double> {
  explicit Geometric(double q, double length = 2) {
    begin(pd::detail::SeriesEquation<double>{}, length);
    double power = 1;
    for (int n = 0; n <= N; ++n, power *= q) velocity.c[n] = power;
    for (int n = 0; n <= N; ++n) position.c[n + 1] = length * velocity.c[n] / (n + 1);
  }
  using SeriesExpansion<double>::suggested_part, SeriesExpansion<double>::rescale,
      SeriesExpansion<double>::trim;
  using SeriesExpansion<double>::N;
};

void lengths() {
  Geometric step(0.9);
  expect(step.span() == 2 && step.velocity.degree == Geometric::N &&
             step.position.degree == Geometric::N + 1,
         "a step begins with its length and the order of the series, a position one higher");
  const double part = step.suggested_part(), v = step.at(0.1).v, x = step.at(0.1).x;
  expect(part < 1, "a series of slowly falling terms takes a shorter step");
  step.rescale(part);
  const double last = step.velocity.c[Geometric::N - 2];
  expect(near(4 * last / unit, 1, 1e-12), "... in which the last terms are rounding of the first");
  expect(near(step.span(), 2 * part, unit) && near(step.at(0.1).v, v, 1e-15) &&
             near(step.at(0.1).x, x, 1e-15),
         "the quantities at a time are the same over a part of the step");
  expect(Geometric(0.01).suggested_part() > 1, "a series of fast falling terms takes a longer one");
}

void shortens() {
  Geometric step(1e-3);
  const auto whole = step;
  step.trim();
  expect(step.velocity.degree < 8 && step.velocity.degree >= 5, "terms that are rounding go");
  expect(step.position.degree == step.velocity.degree + 1, "... of the position one later");
  const double v_left = whole.velocity.at(2) - step.velocity.at(2);
  expect(step.v_bound > 0 && v_left <= step.v_bound + unit, "... and the bounds say how much");
  double dropped = 0;
  for (int n = step.velocity.degree + 1; n <= Geometric::N; ++n) dropped += whole.velocity.c[n];
  expect(near(step.v_bound / dropped, 1, 1e-12), "... by the sum of what was left out");
  expect(step.skin_bound == 0 && step.speed_bound == 0, "what is zero loses nothing");
}

}  // namespace

int main() {
  lengths();
  shortens();
  return check::status();
}
