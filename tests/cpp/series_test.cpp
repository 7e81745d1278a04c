// The power series of modes without a closed form: against forty digits, against the closed form where
// there is one, against polynomials whose zeros are known; and the bounds of what they leave out.
#include "pindrive/series/series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "pindrive/numbers/dual.hpp"
#include "pindrive/series/series_mode.hpp"

#ifndef PINDRIVE_SERIES
#define PINDRIVE_SERIES "tests/oracle/series_cases.txt"  // from the root
#endif

namespace pd = pindrive;

namespace {

using std::abs;

int failures = 0;

void expect(bool holds, const char* what, double found) {
  if (holds) return;
  ++failures;
  std::printf("%s: %.17g\n", what, found);
}

/// A case of tests/oracle/make_series.py, with its answer.
struct Case {
  double mass, damping, stiffness, v_p[2], load[2], across[2];
  double plate, plate_branch[4], plate_static;
  double finger, finger_stiffness, finger_branch[4], finger_static;
  double x, v, skin, duration;
  int guard;
  double time, x_end, v_end, force_end;
};

std::vector<Case> stored() {
  std::vector<Case> cases;
  std::ifstream file(PINDRIVE_SERIES);
  for (std::string line; std::getline(file, line);) {
    std::istringstream in(line);
    Case c{};
    const auto read = [&](auto& values) {
      for (auto& value : values) in >> value;
    };
    in >> c.mass >> c.damping >> c.stiffness;
    read(c.v_p);
    read(c.load);
    read(c.across);
    in >> c.plate;
    read(c.plate_branch);
    in >> c.plate_static >> c.finger >> c.finger_stiffness;
    read(c.finger_branch);
    in >> c.finger_static >> c.x >> c.v >> c.skin >> c.duration;
    in >> c.guard >> c.time >> c.x_end >> c.v_end >> c.force_end;
    expect(!in.fail(), "a line of the cases", double(cases.size()));
    cases.push_back(c);
  }
  return cases;
}

/// A mode and what ends it.
template <class T>
struct Followed {
  T time, x, v, force;
  int guard{0}, steps{0};
};

/// A case as a drive in a mode: of constant numbers, or of one that carries a derivative.
template <class T>
struct Stored {
  const Case& c;
  T mass, stiffness, load, x, v;

  static bool slides(double state) { return abs(state) == 1 || state == 5; }

  pd::Branch<T> branch(const double* b) const {
    const T end = b[2] < 1e300 ? T(b[2]) : std::numeric_limits<T>::infinity();
    return {T(b[1]), end, T(b[0]), T(b[3]), T(0)};
  }

  /// Tension of the skin, N.
  T tension(const pd::Mode& mode, T skin, T pressed) const {
    if (c.finger_stiffness == 0) return T(0);
    if (!pd::is_slip(mode.finger)) return skin;
    const pd::Branch<T> b = branch(c.finger_branch);
    const T at_zero = b.force - b.slope * b.from, side = int(mode.finger) < 0 ? T(-1) : T(1);
    return pressed * (side * at_zero + b.slope * skin);
  }

  Followed<T> follow() const {
    using pd::detail::ActiveGuard;
    const pd::Branch<T> of_plate = branch(c.plate_branch), of_finger = branch(c.finger_branch);
    pd::Drive<T> drive{mass, stiffness, T(c.damping), {}, {}};
    drive.plate = {T(0), T(c.plate_static), std::numeric_limits<T>::infinity(), &of_plate, 1};
    drive.finger = {T(0), T(c.finger_static), std::numeric_limits<T>::infinity(), &of_finger, 1};
    if (c.finger_stiffness > 0) drive.finger.stiffness = c.finger_stiffness;
    const auto state_of = [](double state) {
      return static_cast<pd::ContactState>(state == 5 ? 1 : int(state));
    };
    const pd::Mode mode{state_of(c.plate), state_of(c.finger)};
    pd::InputCurves<T> inputs{
        {T(c.v_p[0]), T(c.v_p[1])}, {load, T(c.load[1])}, {T(c.across[0]), T(c.across[1])}};
    typename pd::detail::SeriesMode<T>::Reached at;
    const double speed = abs(c.v - c.v_p[0]);  // does it begin at an end of its branch?
    if (abs(c.plate) == 1 && abs(speed - c.plate_branch[1]) < 1e-14 * speed)
      at.plate = ActiveGuard::lower;
    if (abs(c.plate) == 1 && abs(speed - c.plate_branch[2]) < 1e-14 * speed)
      at.plate = ActiveGuard::upper;

    pd::detail::SeriesState<T> state{x, v, T(c.skin)};
    Followed<T> found{T(0), x, v, T(0)};
    for (;;) {
      const pd::detail::SeriesMode<T> series(drive, mode, inputs);
      const bool flat = c.plate_branch[3] == 0 && c.across[0] == 0 && c.finger_stiffness == 0;
      expect(series.has_closed_form() == flat, "a closed form", double(flat));
      const pd::detail::SeriesEquation<T> equation = series.equation();
      const auto step = pd::detail::series_step(equation, state, T(c.duration) - found.time);
      const auto guards = series.guards(step, at);
      const auto* ends = guards.earliest();
      const T tau = ends != nullptr ? ends->zero : T(step.span());
      state = step.at(tau);
      inputs = inputs.from(tau);
      found.time += tau;
      ++found.steps;
      if (ends != nullptr || !(found.time < c.duration * (1 - 1e-15)) || found.steps > 100000) {
        found.x = state.x;
        found.v = state.v;
        found.force = tension(mode, state.skin, inputs.finger_load.value);
        if (ends != nullptr) found.guard = number(*ends, mode);
        return found;
      }
      at = {};
    }
  }

  /// As the oracle numbers them.
  template <class Guard>
  static int number(const Guard& guard, const pd::Mode& mode) {
    using pd::detail::ActiveGuard;
    if (guard.bound != ActiveGuard::none)
      return (guard.plate ? 1 : 3) + (guard.bound == ActiveGuard::upper);
    const bool skin = mode.finger == pd::ContactState::elastic_stick;
    return (skin ? 5 : 7) + (guard.side < 0);
  }
};

/// 650 references of forty digits: event, time and state agree to a relative 1e-11.
void oracle() {
  const std::vector<Case> cases = stored();
  expect(cases.size() == 650, "cases", double(cases.size()));
  double worst = 0;
  long long steps = 0;
  for (const Case& c : cases) {
    const Followed<double> f = Stored<double>{c, c.mass, c.stiffness, c.load[0], c.x, c.v}.follow();
    const double omega = std::sqrt(c.stiffness / c.mass);
    const double size = std::max(
        {std::abs(c.x_end), std::abs(c.x), std::abs(c.v) / omega, std::abs(c.v_p[0]) / omega});
    const double off = std::max(
        {std::abs(f.time - c.time) / c.duration, std::abs(f.x - c.x_end) / size,
         std::abs(f.v - c.v_end) / (size * omega),
         std::abs(f.force - c.force_end) / std::max(std::abs(c.force_end), c.stiffness * size)});
    worst = std::max(worst, off);
    steps += f.steps;
    if (f.guard == c.guard && off < 1e-11) continue;
    ++failures;
    std::printf("case %d: guard %d, not %d; off by %.2g\n", int(&c - cases.data()), f.guard,
                c.guard, off);
  }
  std::printf("%zu cases, %lld steps: within %.1e of forty digits\n", cases.size(), steps, worst);
}

/// With a constant load it is the closed form of flow.hpp.
void closed_form() {
  for (const double drag : {0.4, 3.0, -0.2}) {
    pd::detail::SeriesEquation<double> e{0.01, 0.4, 100.0};
    e.force = {0.03, -0.5};
    e.plate_velocity = {0.1, 0.7};
    e.load = {1.5, 0};
    e.plate_slope = drag / 1.5;
    e.side = -1;
    const pd::Oscillator<double> oscillator(0.01, 0.4 + drag, 100.0);
    const double pull = 0.03 + drag * 0.1, drift = (-0.5 + drag * 0.7) / 100;
    const double x = 1e-3, v = 0.05;
    const double a = (pull - (0.4 + drag) * v - 100 * x) / 0.01;
    const auto exact = pd::Flow<double>::free(
        oscillator, x, v, a, -(pull - 100 * x - (0.4 + drag) * drift) / 100, drift);
    pd::detail::SeriesState<double> state{x, v, 0};
    double t = 0;
    for (int i = 0; i < 12; ++i) {
      const pd::detail::SeriesFlow<double> flow(e, state, 1.0);
      for (const double part : {0.3, 0.8}) {
        const double tau = part * flow.span(), moment = t + tau;
        const double off = flow.at(tau).x - exact.position.at(oscillator, moment);
        expect(abs(off) < 4e-18, "beside the closed form: x", off);
        const double rate = flow.velocity.derivative().at(tau);
        const double off_rate = rate - exact.acceleration().at(oscillator, moment);
        expect(abs(off_rate) < 1e-13, "beside the closed form: x''", off_rate);
      }
      state = flow.at(flow.span());
      e = e.from(flow.span());
      t += flow.span();
    }
  }
}

/// The truncation error of a step is within its bound, which is rounding: beside steps of an eighth in long
/// double, whose own bound is 2000 times smaller.
void bounds() {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double largest = 0;
  for (int i = 0; i < 400; ++i) {
    pd::detail::SeriesEquation<double> e{0.01, 0.5 + 0.5 * uniform(random), 100.0};
    e.force = {0.05 * uniform(random), uniform(random)};
    e.plate_velocity = {0.1 * uniform(random), uniform(random)};
    e.load = {1, 20 * uniform(random)};
    e.plate_force = 0.3 + 0.2 * uniform(random);
    e.plate_slope = 0.5 * uniform(random);
    if (i % 2 == 0) e.across = {0.02 * std::pow(10, uniform(random)), 0.3 * uniform(random)};
    e.side = i % 2 == 0 ? 0 : 1;
    if (i % 3 == 0) {
      e.skin_factor.value = 0.3 * (i % 2 == 0 ? 1 : -1);
      e.skin_stiffness = e.skin_decay = 30;
    }
    if (i % 4 == 1) e.damping_rate = 30 * uniform(random);
    if (i % 12 == 6) {  // a slider under a load that changes, from zero too
      e.skin_factor = {i % 24 == 6 ? 0 : 0.3, 20 * uniform(random)};
      if (e.skin_factor.value == 0) e.skin_factor.rate = std::abs(e.skin_factor.rate);
      e.skin_drift = 0.5 * uniform(random);
    }
    pd::detail::SeriesState<double> start{1e-3 * uniform(random), 0.1 * uniform(random),
                                          0.1 * uniform(random)};
    if (e.skin_factor.value == 0 && e.skin_factor.rate != 0)
      start.skin =
          (e.skin_stiffness * start.v - e.skin_drift) / (e.skin_decay + e.skin_factor.rate);
    const pd::detail::SeriesFlow<double> flow(e, start, 0.01);
    using L = long double;
    const auto wide = [](pd::Line<double> given) { return pd::Line<L>{given.value, given.rate}; };
    pd::detail::SeriesEquation<L> fine{e.mass, e.damping, e.stiffness};
    fine.force = wide(e.force);
    fine.plate_velocity = wide(e.plate_velocity.line());
    fine.load = wide(e.load.line());
    fine.across = wide(e.across.line());
    fine.plate_force = e.plate_force;
    fine.plate_slope = e.plate_slope;
    fine.side = e.side;
    fine.damping_rate = e.damping_rate;
    fine.skin_factor = wide(e.skin_factor);
    fine.skin_stiffness = e.skin_stiffness;
    fine.skin_decay = e.skin_decay;
    fine.skin_drift = e.skin_drift;
    pd::detail::SeriesState<L> state{start.x, start.v, start.skin};
    if (fine.skin_factor.value == 0 && fine.skin_factor.rate != 0)
      state.skin = (fine.skin_stiffness * state.v - fine.skin_drift) /
                   (fine.skin_decay + fine.skin_factor.rate);
    L t = 0;
    while (t < flow.span() * (1 - 1e-18L)) {
      const pd::detail::SeriesFlow<L> step(fine, state,
                                           std::min(L(flow.span()) / 8, flow.span() - t));
      state = step.at(step.span());
      fine = fine.from(step.span());
      t += step.span();
    }
    const pd::detail::SeriesState<double> end = flow.at(flow.span());
    const double v_size = abs(end.v) + abs(start.v) + abs(flow.velocity.c[1]);
    const double off = double(abs(end.v - state.v));
    expect(off <= flow.v_bound + 2e-15 * v_size, "beyond its bound: velocity", off / flow.v_bound);
    expect(flow.v_bound < 1e-15 * v_size, "a bound beyond rounding", flow.v_bound / v_size);
    const double off_x = double(abs(end.x - state.x));
    expect(off_x <= flow.x_bound + 4e-16 * (abs(start.x) + abs(end.x) + flow.span() * v_size),
           "beyond its bound: position", off_x);
    const double off_skin = double(abs(end.skin - state.skin));
    expect(off_skin <= flow.skin_bound + 1e-15 * (abs(start.skin) + abs(end.skin) + v_size),
           "beyond its bound: skin", off_skin);
    largest = std::max(largest, off / v_size);
  }
  std::printf("bounds hold; largest error of a step %.1e\n", largest);

  // The bound itself, where it is no rounding: a step that is too long for its order.
  for (const double across : {0.05, 0.02}) {
    pd::detail::SeriesEquation<double> e{0.01, 0.1, 100.0};
    e.plate_force = 0.3;
    e.plate_velocity = {0.1, 0};
    e.across = {across, 0};
    const pd::detail::SeriesFlow<double> flow(e, {1e-3, 0.02, 0}, 1.0);
    const pd::detail::SeriesFlow<double> half(e, {1e-3, 0.02, 0}, flow.span() / 2);
    const auto middle = flow.at(flow.span() / 2);
    expect(half.velocity.degree < flow.velocity.degree, "no fewer terms in a shorter step",
           half.velocity.degree);
    expect(abs(middle.v - half.at(half.span()).v) < 4e-17, "two steps differ", middle.v);
  }

  // A pin at rest: its series has no terms, but the rounding of another start would grow in a step.
  pd::detail::SeriesEquation<double> rests{0.01, 0.4, 100.0};
  rests.side = 1;
  rests.force = {0.02, 0};
  const double rate = 0.4 / 0.01 + 100;
  const pd::detail::SeriesFlow<double> flow(rests, {2e-4, 0, 0, 0}, 10.0);
  expect(flow.span() > 7 / rate && flow.span() <= 8 / rate, "a step at rest lasts", flow.span());
}

/// The product of factors (root − σ), scaled.
pd::detail::Polynomial<double> with_roots(const std::vector<double>& roots, double scale) {
  pd::detail::Polynomial<double> p;
  p.c[0] = scale;
  for (const double root : roots) {
    ++p.degree;
    for (int n = p.degree; n >= 0; --n) p.c[n] = root * p.c[n] - (n > 0 ? p.c[n - 1] : 0);
  }
  return p;
}

/// The first zero of polynomials whose zeros are known: none is missed, invented or misplaced.
void zeros() {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr double never = std::numeric_limits<double>::infinity();
  int found = 0, none = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<double> roots;
    roots.reserve(16);
    const int count = 1 + i % 7;
    for (int k = 0; k < count; ++k) roots.push_back(0.02 + 1.6 * uniform(random));
    std::sort(roots.begin(), roots.end());
    double apart = 1;
    for (int k = 0; k + 1 < count; ++k) apart = std::min(apart, roots[k + 1] - roots[k]);
    if (apart < 1e-2 || abs(roots[0] - 1) < 1e-3) continue;
    const double first = roots[0];
    for (int k = 0; k < (i / 7) % 6; ++k) roots.push_back(-0.1 - 3 * uniform(random));
    double positive = 1;  // its sign at 0
    for (const double root : roots) positive *= root > 0 ? 1 : -1;
    pd::detail::Polynomial<double> p =
        with_roots(roots, positive * std::pow(10, 20 * uniform(random) - 10));
    p.span = 1e-3;
    const double zero = pd::detail::first_zero(p);
    if (first > 1) {
      expect(zero == never, "a zero that is none", zero);
      ++none;
    } else {
      expect(abs(zero / p.span - first) < 1e-9, "a zero misplaced", zero / p.span - first);
      ++found;
    }
  }
  expect(found > 5000 && none > 300, "too few polynomials", found);
  // Two zeros a millionth apart, and a touch: zero to rounding, and never below.
  expect(abs(pd::detail::first_zero(with_roots({0.4, 0.400001, 3}, 1)) - 0.4) < 1e-9,
         "two near zeros", 0);
  pd::detail::Polynomial<double> touch;  // (σ − 1/2)²
  touch.degree = 2;
  touch.c = {0.25, -1, 1};
  expect(pd::detail::first_zero(touch) == never, "a touch", pd::detail::first_zero(touch));
  touch.c[0] += 1e-15;
  expect(pd::detail::first_zero(touch) == never, "just no touch", pd::detail::first_zero(touch));
  touch.c[0] = 0.25 - 1e-12;
  expect(abs(pd::detail::first_zero(touch) - (0.5 - 1e-6)) < 1e-9, "just a crossing",
         pd::detail::first_zero(touch));
  // It leaves a zero at its start to its positive side: straight, tangentially, and but for rounding.
  pd::detail::Polynomial<double> leaves = with_roots({0.6}, 1);
  for (int order = 1; order < 4; ++order) {
    for (int n = ++leaves.degree; n > 0; --n) leaves.c[n] = leaves.c[n - 1];
    leaves.c[0] = 0;
    expect(abs(pd::detail::first_zero(leaves) - 0.6) < 1e-15, "leaves its zero",
           pd::detail::first_zero(leaves));
  }
  leaves.c[0] = -1e-18;
  expect(abs(pd::detail::first_zero(leaves) - 0.6) < 1e-15, "below by rounding",
         pd::detail::first_zero(leaves));
}

/// Derivatives through the event beside differences of two answers.
void derivatives() {
  using D = pd::Dual<double>;
  int compared = 0;
  double worst = 0;
  for (const Case& c : stored()) {
    const double nominal[] = {c.mass, c.stiffness, c.load[0], c.x, c.v};
    const double omega = std::sqrt(c.stiffness / c.mass);
    const double size = abs(c.x) + abs(c.x_end) + (abs(c.v) + abs(c.v_p[0])) / omega;
    const bool at_end = abs(abs(c.v - c.v_p[0]) - c.plate_branch[1]) < 1e-12 ||
                        abs(abs(c.v - c.v_p[0]) - c.plate_branch[2]) < 1e-12;
    if (at_end) continue;  // moved off that end it is another mode
    for (int k = 0; k < 5; ++k) {
      if ((k == 4 && (c.plate == 0 || c.finger == 0)) || nominal[k] == 0) continue;
      const auto moved = [&](double factor) {
        double p[5];
        std::copy(nominal, nominal + 5, p);
        p[k] *= 1 + factor;
        return Stored<double>{c, p[0], p[1], p[2], p[3], p[4]}.follow();
      };
      D p[5];
      for (int i = 0; i < 5; ++i) p[i] = nominal[i];
      p[k].slope = nominal[k];
      const Followed<D> f = Stored<D>{c, p[0], p[1], p[2], p[3], p[4]}.follow();
      const double h = 1e-5;
      const Followed<double> more = moved(h), less = moved(-h);
      if (more.guard != c.guard || less.guard != c.guard) continue;
      // A difference is as good as the third derivative lets it; far from a tangent it is enough.
      const Followed<double> twice = moved(2 * h), half = moved(-2 * h);
      const auto slope = [&](auto of) {
        return (8 * (of(more) - of(less)) - (of(twice) - of(half))) / (12 * h);
      };
      const double off =
          std::max(abs(f.x.slope - slope([](const auto& g) { return g.x; })) / size,
                   abs(f.time.slope - slope([](const auto& g) { return g.time; })) / c.duration);
      const double large = 1 + abs(f.time.slope) / c.duration + abs(f.x.slope) / size;
      worst = std::max(worst, off / (large * large * large));
      ++compared;
    }
  }
  expect(compared > 1500, "too few derivatives", compared);
  expect(worst < 1e-7, "a derivative", worst);
  std::printf("%d derivatives, within %.1e of differences\n", compared, worst);
}

}  // namespace

int main() {
  oracle();
  closed_form();
  bounds();
  zeros();
  derivatives();
  return failures == 0 ? 0 : 1;
}
