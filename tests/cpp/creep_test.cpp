// Creep under a hand that is oblique by little: beside the Taylor series of the whole motion, through an
// across velocity of zero, and into the aligned case; and the bound of what it leaves out.
#include "pindrive/series/creep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "pindrive/motion/quadrature.hpp"
#include "pindrive/numbers/dual.hpp"
#include "slow_steps.hpp"

namespace pd = pindrive;
using slow_steps::expect, slow_steps::failures, slow_steps::follow;

namespace {

/// A pin at full pull under a hand of 60 mm/s.
template <class T>
pd::detail::SeriesEquation<T> pulled(T across) {
  pd::detail::SeriesEquation<T> e{T(0.01), T(0.64), T(100.0)};
  e.force = {T(-0.02), T(0)};
  e.plate_velocity = {T(0.06), T(0)};
  e.across = {across, T(0)};
  e.plate_force = T(0.697);
  return e;
}

/// 200 random cases agree with the Taylor series to rounding, in fewer steps.
void beside_taylor() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double worst = 0;
  long long few = 0, many = 0;
  for (int i = 0; i < 200; ++i) {
    auto e = pulled(0.06 * std::pow(10, -1.7 + 0.7 * uniform(random)));
    e.across.rate = e.across.value * 8 * uniform(random);
    if (i % 4 == 0) e.across = {-e.across.value, -e.across.rate};
    e.plate_velocity.rate = 0.3 * uniform(random);
    e.load = {1 + 0.3 * uniform(random), 3 * uniform(random)};
    e.plate_slope = i % 3 == 0 ? 0.2 * uniform(random) : 0;
    e.force.rate = 0.2 * uniform(random);
    if (i % 2 == 0) {
      e.skin_factor = {1, 0};
      e.skin_stiffness = 300;
    }
    if (i % 5 == 0) {  // a slider, and a damper, under a load that changes
      e.skin_factor = {0.2, 2 * uniform(random)};
      e.skin_stiffness = e.skin_decay = 300;
      e.skin_drift = 0.5 * uniform(random);
      e.damping_rate = 5 * uniform(random);
    }
    const pd::detail::SeriesState<double> start{2e-3 * uniform(random), 0.1 * uniform(random), 0};
    const auto whole = follow(e, start, 0.05, false), reduced = follow(e, start, 0.05, true);
    const double off = std::max(std::abs(whole.state.x - reduced.state.x) / 3e-3,
                                std::abs(whole.state.v - reduced.state.v) / 0.06);
    worst = std::max(worst, off);
    few += reduced.steps;
    many += whole.steps;
  }
  expect(worst < 1e-13, "creep beside the Taylor series", worst);
  expect(4 * few < many, "no fewer steps", double(few));
  std::printf("creep: within %.1e of the Taylor series, %lld steps instead of %lld\n", worst, few,
              many);
}

/// Towards the aligned case nothing jumps: the displacement comes to that of a pin that sticks as the
/// across velocity goes to zero, in a number of steps that does not grow.
void joins_the_aligned_case() {
  const pd::detail::SeriesState<double> start{1e-3, 0.06, 0};
  const double carried = 1e-3 + 0.06 * 0.05;
  double before = 1;
  for (double across = 1e-3; across > 1e-20; across /= 10) {
    const auto end = follow(pulled(across), start, 0.05, true);
    const double short_of = carried - end.state.x;
    expect(end.steps < 120, "steps", end.steps);
    expect(short_of <= before && short_of > -1e-17, "short of the plate", short_of);
    // By ∫ w ϱ/√(1 − ϱ²), of the force that a pin needs that sticks, and by what that changes it.
    const auto rate = [&](double t) {
      const double part = (0.02 + 100 * (1e-3 + 0.06 * t) + 0.64 * 0.06) / 0.697;
      return part / std::sqrt(1 - part * part);
    };
    const double first = across * pd::detail::gauss<double>(rate, 0.0, 0.05);
    expect(std::abs(short_of - first) <= 300 * across * first + 2e-18, "reduced creep",
           short_of - first);
    before = short_of;
  }
  const auto end = follow(pulled(0.0), start, 0.05, true);
  expect(std::abs(end.state.x - carried) < 1e-18, "aligned", end.state.x - carried);
  expect(end.state.v == 0.06, "aligned", end.state.v);
}

/// An across velocity that comes to zero and goes on: the laws hold all along, and a hand that wobbles
/// beyond zero moves the pin as a hand that wobbles back.
void through_zero() {
  auto e = pulled(0.004);
  e.across.rate = -0.2;
  auto mirrored = pulled(-0.004);
  mirrored.across.rate = 0.2;
  pd::detail::SeriesState<double> state{1e-3, 0.058, 0}, other = state;
  double t = 0, energy = 0, worst = 0;
  const auto stored = [](const pd::detail::SeriesState<double>& s) {
    return 0.005 * s.v * s.v + 50 * s.x * s.x;
  };
  const double at_start = stored(state);
  int steps = 0;
  for (; t < 0.04 * (1 - 1e-15) && steps < 2000; ++steps) {
    const auto step = pd::detail::series_step(e, state, 0.04 - t);
    const auto twin = pd::detail::series_step(mirrored, other, 0.04 - t);
    for (const double part : {0.0, 0.3, 0.7, 1.0}) {
      const double tau = part * step.span(), v = step.velocity.at(tau);
      const double w = e.across.at(tau), u = v - 0.06, force = step.plate_force.at(tau);
      const double a = step.velocity.derivative().at(tau);
      const double law = 0.01 * a + 0.64 * v + 100 * step.position.at(tau) + 0.02 - force;
      worst = std::max(worst, std::abs(law));
      const double friction = -0.697 * u / std::hypot(u, w), known = 1e-16 / std::hypot(u, w);
      if (std::abs(w) > 1e-9)
        expect(std::abs(force - friction) < 1e-13 + 2 * known, "friction", force - friction);
      expect(std::abs(step.speed.at(tau) - std::hypot(u, w)) < 1e-15, "sliding speed", w);
    }
    energy += pd::detail::gauss<double>(
        [&](double tau) {
          const double v = step.velocity.at(tau);
          return step.plate_force.at(tau) * v - 0.02 * v - 0.64 * v * v;
        },
        0.0, step.span());
    state = step.at(step.span());
    other = twin.at(twin.span());
    e = e.from(step.span());
    mirrored = mirrored.from(twin.span());
    t += step.span();
    expect(state.x == other.x && state.v == other.v, "mirrored", state.x - other.x);
  }
  expect(worst < 1e-12, "the law of motion", worst);
  expect(std::abs(stored(state) - at_start - energy) < 1e-15 * at_start * 100, "energy",
         stored(state) - at_start - energy);
  expect(steps < 150, "steps", steps);
  expect(e.across.value < -0.0039, "to the other side", e.across.value);
}

/// The truncation error of a step is within its bound, and the bound is rounding.
void bounds() {
  using L = long double;
  int held = 0;
  for (int i = 0; i < 40; ++i) {
    const double across = 1e-4 * (1 + i % 7), x = 1e-4 * i;
    auto state = follow(pulled(across), {x, 0.06, 0}, 0.003, true).state;
    const pd::detail::CreepFlow<double> step(pulled(across), state, 0.002);
    if (!step.is_valid()) continue;
    ++held;
    const auto fine = follow(pulled(L(across)), {state.x, state.v, 0}, step.span(), false);
    const auto end = step.at(step.span());
    const double off = double(std::abs(end.v - fine.state.v));
    expect(off <= step.v_bound + 16 * 2.3e-16 * 0.06, "beyond its bound", off);
    expect(step.v_bound < 1e-14 * 0.06, "a bound beyond rounding", step.v_bound);
    expect(std::abs(double(end.x - fine.state.x)) <= step.x_bound + 1e-17, "beyond its bound: x",
           double(end.x - fine.state.x));
  }
  expect(held > 30, "creeps too seldom", held);
  // A pin that is off the velocity of creep, or cannot be held, does not creep.
  expect(!pd::detail::creep<double>(pulled(1e-3), {1e-3, 0.05, 0}, 0.01), "off", 0);
  expect(!pd::detail::creep<double>(pulled(1e-3), {8e-3, 0.06, 0}, 0.01), "not held", 0);
}

/// Derivatives beside differences.
void derivatives() {
  using D = pd::Dual<double>;
  for (const double across : {1e-3, 1e-5}) {
    const auto at = [&](double w, double x) {
      return follow(pulled(w), {x, 0.06, 0}, 0.03, true).state.x;
    };
    const double h = 1e-3 * across, k = 1e-7;
    const double by_w =
        follow(pulled(D(across, 1)), {D(1e-3), D(0.06), D(0)}, 0.03, true).state.x.slope;
    const double by_x =
        follow(pulled(D(across)), {D(1e-3, 1), D(0.06), D(0)}, 0.03, true).state.x.slope;
    const double w_difference = (at(across + h, 1e-3) - at(across - h, 1e-3)) / (2 * h);
    const double x_difference = (at(across, 1e-3 + k) - at(across, 1e-3 - k)) / (2 * k);
    expect(std::abs(by_w / w_difference - 1) < 1e-5, "by the across velocity", by_w - w_difference);
    expect(std::abs(by_x - x_difference) < 1e-7, "by the start", by_x - x_difference);
  }
}

}  // namespace

int main() {
  beside_taylor();
  joins_the_aligned_case();
  through_zero();
  bounds();
  derivatives();
  return failures == 0 ? 0 : 1;
}
