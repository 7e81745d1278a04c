// The core on dual numbers: derivatives of event times, positions and the transient's numbers, along
// every parameter, against central differences of the same motions in long double.
#include "pindrive/numbers/dual.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "cases.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/transient.hpp"

namespace pd = pindrive;
using Dual = pd::Dual<double>;

constexpr double followed = 0.4;
/// Mass, stiffness, damping, kinetic and static friction of plate and finger, skin stiffness, four
/// rows (time, value) of mouse velocity, three of load, start.
enum Parameter : unsigned char {
  m,
  k,
  b,
  fp,
  sp,
  ff,
  sf,
  skin,
  t1,
  t2,
  v0,
  v1,
  v2,
  l0,
  l1,
  x,
  v,
  fall,
  knee,
  all
};

template <class T>
struct Run {
  std::vector<pd::Segment<T>> segments;
  std::vector<T> quantities;
};

template <class T>
Run<T> run(const std::vector<T>& p, int variant) {
  const bool curved = variant % 4 == 1, soft = variant % 4 == 2, loaded = variant % 4 == 3;
  const T never = std::numeric_limits<T>::infinity();
  const T speeds[] = {T(0), p[knee], 3 * p[knee]}, forces[] = {p[fp], p[fall] * p[fp], p[fp]};
  pd::Branch<T> branches[4];
  pd::Drive<T> drive{p[m], p[k], p[b], {p[fp], p[sp]}, {p[ff], p[sf], soft ? p[skin] : never}};
  if (curved) {
    drive.plate.curve = branches;
    drive.plate.branches = pd::branches_of(speeds, forces, 3, branches);
  }
  const T times[] = {T(0), p[t1], p[t2]}, values[] = {p[v0], p[v1], p[v2]};
  const T load_times[] = {T(0), p[t2]}, loads[] = {p[l0], p[l1]};
  const bool moving = (variant / 4) % 2 == 1;
  const pd::Profile<T> mouse = moving ? pd::Profile<T>(times, values, 3) : pd::Profile<T>(p[v0]);
  const pd::Profile<T> load = loaded ? pd::Profile<T>(load_times, loads, 2) : pd::Profile<T>(T(1));
  const pd::Inputs<T> inputs{mouse, p[x], p[v], T(followed), load};

  Run<T> result;
  const auto outcome =
      pd::simulate(drive, inputs, [&](const pd::Segment<T>& s) { result.segments.push_back(s); });
  const pd::Motion<T> motion(drive, inputs, result.segments.data(), result.segments.size(),
                             outcome);
  for (const auto& segment : result.segments) result.quantities.push_back(segment.end);
  for (int i = 1; i < 8; ++i) {
    const auto [segment, tau] = motion.locate(T(followed) * i / 8, pd::Side::right);
    result.quantities.push_back(segment->flow.position.at(segment->flow.oscillator, tau));
    result.quantities.push_back(segment->flow.velocity.at(segment->flow.oscillator, tau));
  }
  const auto n = pd::Measurement<T>(motion, T(followed)).transient(T(0.05));
  for (const T number :
       {n.peak_displacement, n.peak_time, n.trough_displacement, n.trough_time, n.swing,
        n.return_velocity, n.return_velocity_time, n.first_reversal_time, n.settling_time,
        n.peak_stretch, n.end_position, n.plate.time_stuck, n.plate.distance_slid,
        n.plate.dissipated, n.finger.distance_slid, n.finger.dissipated})
    result.quantities.push_back(number);
  return result;
}

template <class A, class B>
bool same_course(const Run<A>& one, const Run<B>& other) {
  return std::equal(one.segments.begin(), one.segments.end(), other.segments.begin(),
                    other.segments.end(), [](const auto& s, const auto& r) {
                      return s.mode.plate == r.mode.plate && s.mode.finger == r.mode.finger &&
                             s.event.plate == r.event.plate && s.event.finger == r.event.finger;
                    });
}

int main() {
  std::mt19937_64 random(298);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double worst = 0;
  int compared = 0, other_course = 0;
  for (int variant = 0; variant < cases(500); ++variant) {
    std::vector<double> p(all);
    p[m] = between(2e-3, 2e-2);
    p[k] = between(20, 400);
    const double omega = std::sqrt(p[k] / p[m]);
    p[b] = 2 * p[m] * omega * (variant % 3 == 0 ? between(0.01, 1.5) : between(0.01, 0.3));
    if (variant % 11 == 10) p[b] = 0;
    p[fp] = between(5e-3, 0.1);
    p[ff] = between(1e-3, 0.05);
    p[sp] = p[fp] * between(1.05, 2);
    p[sf] = p[ff] * between(1.05, 2);
    p[skin] = p[k] * between(1, 50);
    p[t1] = between(0.02, 0.1);
    p[t2] = between(0.12, 0.3);
    for (const int i : {v0, v1, v2}) p[i] = between(-0.3, 0.3);
    p[l0] = between(0, 2);
    p[l1] = between(0, 2);
    p[x] = between(-3e-3, 3e-3);
    p[v] = between(-0.3, 0.3);
    p[fall] = between(0.3, 0.9);
    p[knee] = between(0.01, 0.1);

    for (int along = 0; along < all; ++along) {
      if (p[along] == 0) continue;  // at the end of its range
      std::vector<Dual> dual(p.begin(), p.end());
      dual[along].slope = 1;
      const auto exact = run(dual, variant);
      std::vector<long double> up(p.begin(), p.end()), down = up;
      const long double step = 1e-6L * std::abs(p[along]);
      up[along] += step;
      down[along] -= step;
      const auto above = run(up, variant), below = run(down, variant);
      if (!same_course(exact, above) || !same_course(exact, below)) {
        ++other_course;
        continue;
      }
      for (std::size_t i = 0; i < exact.quantities.size(); ++i) {
        const Dual q = exact.quantities[i];
        if (!std::isfinite(q.value) || !std::isfinite(above.quantities[i]) ||
            !std::isfinite(below.quantities[i]))
          continue;
        const long double central = (above.quantities[i] - below.quantities[i]) / (2 * step);
        // The second difference tells a number that jumps between the two from one that does not.
        const long double bent =
            above.quantities[i] + below.quantities[i] - 2 * static_cast<long double>(q.value);
        // Of a quantity that has died away, the derivative is judged by a nanometre or the like.
        const long double size = std::max(1e-9L, std::abs(static_cast<long double>(q.value)));
        const long double scale = std::max(std::abs(central), size / std::abs(p[along]));
        if (std::abs(bent) > 1e-3L * step * scale) continue;
        const double error = double(std::abs(q.slope - central) / scale);
        if (!(error <= 1e-5))
          std::printf("variant %d, parameter %d, quantity %zu of %zu segments: %g, not %Lg\n",
                      variant, along, i, exact.segments.size(), q.slope, central);
        worst = std::max(worst, std::isnan(error) ? 1 : error);
        ++compared;
      }
    }
  }
  std::printf("%d derivatives, worst relative error %.1e; %d times another course nearby\n",
              compared, worst, other_course);
  return worst <= 1e-5 && compared > cases(300000) ? 0 : 1;
}
