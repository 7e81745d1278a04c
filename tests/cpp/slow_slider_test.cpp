// The slider of stiff skin without its fast part: beside the Taylor series of the whole motion in more digits, up to
// a load of zero, and what it leaves out.
#include "pindrive/series/slow_slider.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "pindrive/numbers/dual.hpp"
#include "slow_steps.hpp"

namespace pd = pindrive;
using slow_steps::expect, slow_steps::failures, slow_steps::follow;

namespace {

/// A pin of 10 g that skin of this stiffness holds back with 0.5 N s/m and 0.2 N, under a load that changes by
/// this part a second.
template <class T>
pd::detail::SeriesEquation<T> held_back(T stiffness, T rate, T damping = T(0.64)) {
  pd::detail::SeriesEquation<T> e{T(0.01), damping, T(100.0)};
  e.plate_force = T(0.3);
  e.side = -1;
  e.plate_velocity = {T(0.2), T(0)};
  e.skin_factor = {T(0.5), T(0.5) * rate};
  e.skin_stiffness = e.skin_decay = stiffness;
  e.skin_drift = T(0.2) * rate;
  e.force = {T(-0.2), T(-0.2) * rate};
  return e;
}

/// Within rounding of the Taylor series in 19 digits, in a hundredth of its steps.
void beside_taylor() {
  using L = long double;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double worst = 0, slider = 0;
  long long few = 0, many = 0;
  for (int i = 0; i < 40; ++i) {
    const double stiffness = 3e5 * std::pow(10, uniform(random)), rate = 20 * uniform(random);
    const double x = 2e-3 * uniform(random), v = 0.05 + 0.04 * uniform(random);
    const auto changed = [&](auto e) {
      e.held = i % 8 == 0;
      if (e.held) e.surface.value = v;
      e.surface.rate = 2;
      e.load.rate = i % 3;
      e.plate_slope = 0.05 * (i % 5);
      e.damping_rate = 0.1 * (i % 2);
      if (i % 4 == 3) {  // the plate slides across, too
        e.side = 0;
        e.across = {0.03, 1};
      }
      return e;
    };
    // From its state after the fast part.
    const auto e = changed(held_back(stiffness, rate));
    const auto begins = follow(e, {x, v, v}, 3e-4, false).state;
    const auto from = e.from(3e-4);
    const auto fine = changed(held_back(L(stiffness), L(rate))).from(L(3e-4));
    const auto slow = follow(from, begins, 0.01, true);
    const auto whole = follow(fine, {begins.x, begins.v, begins.skin}, 0.01, false);
    worst = std::max({worst, double(std::abs(slow.state.x - whole.state.x)) / 3e-3,
                      double(std::abs(slow.state.v - whole.state.v)) / 0.1});
    slider = std::max(slider, double(std::abs(slow.state.skin - whole.state.skin)) / 0.1);
    few += slow.steps;
    many += whole.steps;
  }
  expect(worst < 3e-15, "the pin beside the Taylor series", worst);
  expect(slider < 1e-14, "the slider beside the Taylor series", slider);
  expect(100 * few < many, "no fewer steps", double(few));
  std::printf(
      "slow slider: within %.1e of the Taylor series, its slider within %.1e, %lld steps instead "
      "of %lld\n",
      worst, slider, few, many);
}

/// A load that falls to zero is followed up to there, to the velocity of section 4 of docs/theory.md.
void up_to_no_load() {
  const auto e = held_back(1e6, -50.0);
  const auto begins = follow(e, {1e-3, 0.05, 0.05}, 1e-4, false).state;
  const auto end = follow(e.from(1e-4), begins, 0.02 - 1e-4, true);
  const double tends = (1e6 * end.state.v + 0.2 * 50) / (1e6 - 0.5 * 50);
  expect(end.steps < 30, "steps", end.steps);
  expect(std::abs(end.state.skin - tends) < 1e-14 * 0.05, "at no load", end.state.skin - tends);
  // To the rounding of the time, as at 0.1 s.
  auto last = e.from(0.0199);
  last.skin_factor.value -= 25 * 5e-17;
  auto before = follow(e.from(1e-4), begins, 0.0199 - 1e-4, true).state;
  before.time = 0.1;
  const pd::detail::SlowSliderFlow<double> step(last, before, 1e-4);
  expect(step.is_valid() && step.span() == 1e-4, "to where rounding has it below zero",
         step.span());
}

/// It holds also up to a row that comes much sooner than anything changes.
void shortly_before_a_row() {
  auto e = held_back(4e8, -1e5);
  const double row = 1e-10;
  auto begins = follow(e, {1e-3, 1e-3, 1e-3}, 1e-6, false).state;
  e = e.from(1e-6);
  expect(pd::detail::slow_slider(e, begins, row).has_value(), "up to a row", 0);
  begins.skin *= 1 + 1e-13;
  expect(!pd::detail::slow_slider(e, begins, row), "off by more than rounding", 0);
}

/// A slider that is off that velocity is followed through its fast part, and soft skin all the way.
void refuses() {
  const auto e = held_back(1e6, 5.0);
  expect(!pd::detail::slow_slider<double>(e, {1e-3, 0.05, 0.06}, 0.01), "off", 0);
  expect(!pd::detail::SlowSliderFlow<double>::stiff(held_back(3e3, 5.0), {1e-3, 0.05, 0.05}),
         "soft", 0);
  expect(!pd::detail::SlowSliderFlow<double>::stiff(held_back(1e6, -1e5), {1e-3, 0.05, 0.05}),
         "a load that falls quickly", 0);
}

/// Derivatives beside differences.
void derivatives() {
  using D = pd::Dual<double>;
  const auto end = [](auto stiffness, auto rate, auto damping) {
    using T = decltype(stiffness + rate + damping);
    return follow(held_back<T>(stiffness, rate, damping), {T(1e-3), T(0.05), T(0.05)}, 0.02, true)
        .state;
  };
  const auto differs = [&](const char* what, const D& exact, double up, double down, double step) {
    const double difference = (up - down) / (2 * step);
    expect(std::abs(exact.slope / difference - 1) < 1e-5, what, exact.slope - difference);
  };
  const double k = 1e5, r = 5, b = 0.64;
  differs("by the damping", end(D(k), D(r), D(b, 1)).x, end(k, r, b * 1.001).x,
          end(k, r, b * 0.999).x, 0.001 * b);
  differs("by the rate of the load", end(D(k), D(r, 1), D(b)).skin, end(k, r * 1.001, b).skin,
          end(k, r * 0.999, b).skin, 0.001 * r);
  differs("by the stiffness of the skin", end(D(k, 1), D(r), D(b)).skin, end(k * 1.001, r, b).skin,
          end(k * 0.999, r, b).skin, 0.001 * k);
}

}  // namespace

int main() {
  beside_taylor();
  up_to_no_load();
  shortly_before_a_row();
  refuses();
  derivatives();
  return failures == 0 ? 0 : 1;
}
