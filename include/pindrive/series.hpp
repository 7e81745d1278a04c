/// The power series of the modes that have no closed form: a friction curve under a changing load, a
/// friction curve on a compliant finger, a plate that also slides across the axis.
///
/// Each mode is one differential equation, whose Taylor coefficients follow from recurrences. Order and
/// length of a step follow from the series itself, with a proven bound of what it leaves out.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/polynomial.hpp"

namespace pindrive {

/// The pin, and what is known of its skin: see SeriesEquation.
template <class T>
struct SeriesState {
  T x, v;     ///< m, m/s
  T skin{0};  ///< N, or m/s
  /// Of a pin that is not held, where it is known, so that a tangential departure is one exactly; m/s².
  T acceleration{std::numeric_limits<T>::quiet_NaN()};
};

/// A mode without a closed form:
///
///     m x'' + b x' + k x = force + R − f y,   R = −λ (F d + S u),   u = x' − v_p,   y' = g x' − h y,
///
/// where d is the sign of u or, with a velocity w across, u / √(u² + w²); u and w are then never both 0.
/// y is the state of a compliant finger of stiffness K: its force (f = 1, g = K, h = 0) while it sticks
/// elastically; while it slips on a sloped branch, kinetic friction F_c + S_c (|y| − from), its sliding
/// velocity (f = S_c, g = h = K/S_c), and its constant part is in `force`. A pin that is held moves as the
/// surface that holds it, and a stick force makes up for what is missing.
template <class T>
struct SeriesEquation {
  T mass, damping, stiffness;          ///< the damping may be negative
  Line<T> force{T(0), T(0)};           ///< inertia and all that is given over time, N
  Line<T> plate_velocity{T(0), T(0)};  ///< v_p, m/s
  Line<T> load{T(1), T(0)};            ///< λ >= 0
  T plate_force{0};                    ///< F: the branch's friction force, continued to no speed, N
  T plate_slope{0};                    ///< S, N s/m
  int side{0};                         ///< the sign of u; 0: the plate slides across too
  Line<T> across{T(0), T(0)};          ///< w, m/s
  T skin_factor{0};                    ///< f: 1, or N s/m
  T skin_gain{0}, skin_decay{0};       ///< g: N/m, or 1/s; h: 1/s
  bool held{false};                    ///< by a surface of this velocity, m/s
  Line<T> surface{T(0), T(0)};

  /// The same with time counted from τ on.
  SeriesEquation from(T tau) const {
    SeriesEquation later = *this;
    for (Line<T> SeriesEquation::* line :
         {&SeriesEquation::force, &SeriesEquation::plate_velocity, &SeriesEquation::load,
          &SeriesEquation::across, &SeriesEquation::surface})
      (later.*line).value = (this->*line).at(tau);
    return later;
  }
};

/// The relative acceleration p with which a pin of mass m sets out from a plate that begins to slide across
/// with the acceleration w': m p + λF p/√(p² + w'²) = what else pulls, N. It grows with the pull: one root.
template <class T>
T setting_out(T mass, T friction, T across_rate, T pull) {
  using std::abs;
  using std::sqrt;
  const T w = abs(across_rate);
  // In t = p/w', from above in size: there the left side bends away from its tangent.
  T t = pull / (mass * w);
  bool converged = false;  // the derivative of a dual number does so one round later
  for (int tries = 0; tries < 200; ++tries) {
    const T root = sqrt(1 + t * t);
    const T missed = mass * w * t + friction * t / root - pull;
    const T move = -missed / (mass * w + friction / (root * root * root));
    const T next = t + move;
    // What falls beyond zero has overshot.
    const T kept = next * t < 0 ? t / 64 : next;
    const bool done = converged;
    converged = abs(kept - t) <= 2 * std::numeric_limits<detail::Real<T>>::epsilon() * abs(t);
    t = kept;
    if (done) break;
  }
  return t * w;
}

/// One step of such a mode, for as long as its series holds to rounding.
template <class T>
class SeriesStep {
 public:
  using Real = detail::Real<T>;

  Polynomial<T> position, velocity, skin;
  Polynomial<T> plate_force;  ///< R, N
  Polynomial<T> stick_force;  ///< of the surface that holds the pin, N; else 0
  Polynomial<T> speed;        ///< of sliding on the plate, across too: s u or √(u² + w²), m/s
  /// Bounds of what is left out: |position|, |velocity|, |skin| and |speed| differ by no more over the step.
  Real x_bound{0}, v_bound{0}, skin_bound{0}, speed_bound{0};
  bool creeps{false};  ///< without its fast part: see creep.hpp

  Real span() const { return velocity.span; }
  SeriesState<T> at(T tau) const { return {position.at(tau), velocity.at(tau), skin.at(tau)}; }

 protected:
  static constexpr int N = series_order;
  static constexpr Real unit = std::numeric_limits<Real>::epsilon();

  /// Makes them series of the order N over a length of time.
  void begin(Real step) {
    each([&](Polynomial<T>& p) {
      p.span = step;
      p.degree = N;
    });
    position.degree = N + 1;
  }

  /// The part of the step at which the last terms are rounding of the first ones.
  Real suggested_part() const {
    using std::abs;
    using std::pow;
    Real least = std::numeric_limits<Real>::infinity();
    for (const Polynomial<T>* p : {&velocity, &skin, &speed}) {
      const auto size = [&](int n) { return abs(plain(p->c[n])); };
      const Real largest = std::max({size(0), size(1), size(2)});
      for (int n = N - 2; n <= N; ++n)
        if (size(n) > 0 && largest > 0)
          least = std::min(least, pow(unit / 4 * largest / size(n), Real(1) / n));
    }
    return least;
  }

  void rescale(Real part) {
    each([&](Polynomial<T>& p) {
      p.span *= part;
      Real factor{1};
      for (int n = 0; n <= p.degree; ++n, factor *= part) p.c[n] *= factor;
    });
  }

  /// Sums of the sizes of coefficients, from each on to the last.
  using Sums = std::array<Real, N + 2>;
  static Sums sums_of(const std::array<T, N + 2>& c) {
    Sums sums{};
    for (int n = N; n >= 0; --n) sums[n] = sums[n + 1] + std::abs(plain(c[n]));
    return sums;
  }
  /// The most that a product of two series comes to beyond its order N.
  static Real beyond(const Sums& p, const Sums& q) {
    Real sum{0};
    for (int i = 1; i <= N; ++i) sum += (p[i] - p[i + 1]) * q[N + 1 - i];
    return sum;
  }

  /// Leaves out the last terms that are rounding of what they are added to, as a short step needs fewer.
  void trim() {
    using std::abs;
    int needed = 1;
    Real dropped{0};
    for (const Polynomial<T>* p : {&velocity, &skin, &speed, &plate_force, &stick_force}) {
      const auto size = [&](int n) { return abs(plain(p->c[n])); };
      Real total{0}, tail{0};
      for (int n = 0; n <= N; ++n) total += size(n);
      int n = N;
      while (n > needed && tail + size(n) <= unit / 8 * total) tail += size(n--);
      needed = std::max(needed, n);
    }
    const auto drop = [&](Polynomial<T>& p, int degree, Real& bound) {
      for (dropped = 0; p.degree > degree; --p.degree) {
        dropped += abs(plain(p.c[p.degree]));
        p.c[p.degree] = T(0);
      }
      bound += dropped;
    };
    Real unused{0};
    drop(position, needed + 1, x_bound);
    drop(velocity, needed, v_bound);
    drop(skin, needed, skin_bound);
    drop(speed, needed, speed_bound);
    drop(plate_force, needed, unused);
    drop(stick_force, needed, unused);
  }

  std::array<Polynomial<T>, 3> inner_;  // what the recurrences need beside these

 private:
  template <class Visitor>
  void each(Visitor&& visit) {
    for (Polynomial<T>* p : {&position, &velocity, &skin, &plate_force, &stick_force, &speed})
      visit(*p);
    for (Polynomial<T>& p : inner_) visit(p);
  }
};

/// Its Taylor series at a state.
template <class T>
class SeriesFlow : public SeriesStep<T> {
 public:
  using typename SeriesStep<T>::Real;
  using SeriesStep<T>::position, SeriesStep<T>::velocity, SeriesStep<T>::skin, SeriesStep<T>::speed;
  using SeriesStep<T>::plate_force, SeriesStep<T>::stick_force, SeriesStep<T>::span;
  using SeriesStep<T>::x_bound, SeriesStep<T>::v_bound, SeriesStep<T>::skin_bound;
  using SeriesStep<T>::speed_bound;

  /// Expands the mode at a state, no farther than the limit (s; may be infinite); or as far, where that is
  /// known to be within a step.
  SeriesFlow(const SeriesEquation<T>& equation, const SeriesState<T>& start, T limit,
             bool within_step = false) {
    const Real farthest = plain(limit), rate = linear_rate(equation);
    Real step = std::min(1 / (rate + turning_rate(equation, start)), farthest);
    expand(equation, start, step);
    if (within_step) {
      this->rescale(farthest / step);
      bound(equation);
      this->trim();
      return;
    }
    step = std::min({this->suggested_part(), longest / (rate * step), farthest / step, farther});
    for (int tries = 0; tries < most_tries; ++tries, step = Real(0.75)) {
      this->rescale(step);
      if (bound(equation)) break;
    }
    this->trim();
  }

 private:
  using SeriesStep<T>::N, SeriesStep<T>::unit, SeriesStep<T>::beyond, SeriesStep<T>::sums_of;
  using typename SeriesStep<T>::Sums;
  /// So many times the time of the fastest rate at most, even where nothing changes: what rounding puts into
  /// the start is then followed too, and remains rounding. And so often a step is made shorter.
  static constexpr Real longest = 8;
  static constexpr Real farther =
      1024;  // than the step that was tried, whose powers must be numbers
  static constexpr int most_tries = 200;

  int begins_{0};  // the order at which u and w begin

  Polynomial<T>& inner(int i) { return this->inner_[i]; }  // d, u

  /// About the fastest rate of the equation without an across velocity, …
  static Real linear_rate(const SeriesEquation<T>& e) {
    using std::abs;
    using std::sqrt;
    const Real m = plain(e.mass), coupling = plain(e.skin_factor) * plain(e.skin_gain);
    return (abs(plain(e.damping)) + abs(plain(e.load.value) * plain(e.plate_slope))) / m +
           abs(plain(e.skin_decay)) + sqrt((plain(e.stiffness) + abs(coupling)) / m);
  }
  /// … and the one at which that turns the direction of sliding.
  static Real turning_rate(const SeriesEquation<T>& e, const SeriesState<T>& s) {
    using std::abs;
    using std::hypot;
    if (e.side != 0) return Real(0);
    const Real m = plain(e.mass), load = abs(plain(e.load.value));
    const Real w = plain(e.across.value), u = plain(s.v) - plain(e.plate_velocity.value);
    const Real pull = abs(plain(e.force.value)) + abs(plain(e.stiffness) * plain(s.x)) +
                      abs(plain(e.damping) * plain(s.v)) +
                      abs(plain(e.skin_factor) * plain(s.skin)) +
                      load * (abs(plain(e.plate_slope) * u) + abs(plain(e.plate_force)));
    const Real turns = abs(plain(e.plate_velocity.rate)) + abs(plain(e.across.rate));
    const Real rates = e.held ? turns : pull / m + turns;
    return sets_out(e, s) ? rates / turns * linear_rate(e) : rates / hypot(u, w);
  }

  /// Whether the plate begins to slide from here on: u and w are 0 but not their rates.
  static bool sets_out(const SeriesEquation<T>& e, const SeriesState<T>& start) {
    return e.side == 0 && e.across.value == 0 &&
           plain(e.held ? e.surface.value : start.v) == plain(e.plate_velocity.value);
  }

  /// The recurrences, in the time σ = τ/step.
  void expand(const SeriesEquation<T>& e, const SeriesState<T>& start, Real step) {
    if (sets_out(e, start)) return expand_from_rest(e, start, step);
    using std::isnan;
    using std::sqrt;
    this->begin(step);
    auto &x = position.c, &v = velocity.c, &y = skin.c, &r = speed.c;
    auto &d = inner(0).c, &u_ = inner(1).c;
    x[0] = start.x;
    v[0] = e.held ? e.surface.value : start.v;
    y[0] = start.skin;
    const std::array<T, 2> force{e.force.value, e.force.rate * step};
    const std::array<T, 2> v_p{e.plate_velocity.value, e.plate_velocity.rate * step};
    const std::array<T, 2> w{e.across.value, e.across.rate * step};
    const std::array<T, 3> w_squared{w[0] * w[0], 2 * w[0] * w[1], w[1] * w[1]};
    const T load_rate = e.load.rate * step;
    T before{0};  // F d + S u, of the order before
    for (int n = 0;; ++n) {
      const T u = u_[n] = n < 2 ? v[n] - v_p[n] : v[n];
      if (e.side != 0) {
        r[n] = T(e.side) * u;
        d[n] = n == 0 ? T(e.side) : T(0);
      } else {
        T square = n < 3 ? w_squared[n] : T(0), product = u;
        for (int i = 0; i <= n; ++i) square += u_[i] * u_[n - i];
        for (int i = 1; i < n; ++i) square -= r[i] * r[n - i];
        r[n] = n == 0 ? sqrt(square) : square / (2 * r[0]);
        for (int i = 1; i <= n; ++i) product -= r[i] * d[n - i];
        d[n] = product / r[0];
      }
      const T friction = e.plate_force * d[n] + e.plate_slope * u;
      plate_force.c[n] = -(e.load.value * friction + load_rate * before);
      before = friction;
      const T part = T(step) / T(n + 1);
      x[n + 1] = part * v[n];
      const T forces = plate_force.c[n] - e.damping * v[n] - e.stiffness * x[n] -
                       e.skin_factor * y[n] + (n < 2 ? force[n] : T(0));
      if (e.held) stick_force.c[n] = (n == 0 ? e.mass * e.surface.rate : T(0)) - forces;
      if (n == N) return;
      v[n + 1] = !e.held ? part * forces / e.mass : n == 0 ? e.surface.rate * step : T(0);
      if (n == 0 && !e.held && !isnan(start.acceleration)) v[1] = start.acceleration * step;
      y[n + 1] = part * (e.skin_gain * v[n] - e.skin_decay * y[n]);
    }
  }

  /// The same where u and w begin at 0: the direction is that of u/σ and w/σ, so that its order n needs the
  /// velocity of the order n + 1, in which the equation is linear.
  void expand_from_rest(const SeriesEquation<T>& e, const SeriesState<T>& start, Real step) {
    using std::sqrt;
    this->begin(step);
    begins_ = 1;
    auto &x = position.c, &v = velocity.c, &y = skin.c, &r = speed.c;
    auto &d = inner(0).c, &u = inner(1).c;
    x[0] = start.x;
    v[0] = e.plate_velocity.value;
    y[0] = start.skin;
    const T w = e.across.rate * step, load_rate = e.load.rate * step;
    const T strength = e.load.value * e.plate_force;
    T slope{0}, before{0};  // of the direction by u/σ; F d + S u, of the order before
    for (int n = 0;; ++n) {
      const T part = T(step) / T(n + 1);
      x[n + 1] = part * v[n];
      // All forces of this order but the plate's.
      const T others = -e.damping * v[n] - e.stiffness * x[n] - e.skin_factor * y[n] +
                       (n == 0   ? e.force.value
                        : n == 1 ? e.force.rate * step
                                 : T(0));
      T product{0}, square{0};  // what d and ρ of this order are without u of the next
      for (int i = 1; i < n; ++i) {
        product -= r[i + 1] * d[n - i];
        square -= r[i + 1] * r[n - i + 1];
      }
      for (int i = 1; i < n; ++i) square += u[i + 1] * u[n - i + 1];
      const T known = e.plate_slope * u[n];
      if (n == 0) {
        const T rest = others - e.mass * e.plate_velocity.rate;
        const T out = e.held ? e.surface.rate - e.plate_velocity.rate
                             : setting_out(e.mass, strength, e.across.rate, rest);
        u[1] = out * step;
        r[1] = sqrt(u[1] * u[1] + w * w);
        d[0] = u[1] / r[1];
        slope = w * w / (r[1] * r[1] * r[1]);
        v[1] = u[1] + e.plate_velocity.rate * step;
      } else {
        // d = slope û + …: with û 0 first, then what it adds.
        r[n + 1] = square / (2 * r[1]);
        d[n] = (product - r[n + 1] * d[0]) / r[1];
        const T friction = e.plate_force * d[n] + known;
        const T forces = others - e.load.value * friction - load_rate * before;
        if (!e.held && n < N) {
          u[n + 1] = forces / (e.mass / part + strength * slope);
          r[n + 1] += d[0] * u[n + 1];
          d[n] += slope * u[n + 1];
          v[n + 1] = u[n + 1];
        }
      }
      const T friction = e.plate_force * d[n] + known;
      plate_force.c[n] = -(e.load.value * friction + load_rate * before);
      before = friction;
      if (e.held)
        stick_force.c[n] = (n == 0 ? e.mass * e.surface.rate : T(0)) - others - plate_force.c[n];
      if (n == N) return;
      y[n + 1] = part * (e.skin_gain * v[n] - e.skin_decay * y[n]);
    }
  }

  /// Bounds what the series leave out, from what they miss of the equation: the error e of a mode, with
  /// 2 E² = m e_v² + k e_x² + (f/g) e_y², grows by no more than the energy that this puts in, since
  /// friction's own slope takes energy but where it falls. Whether the bound is rounding.
  bool bound(const SeriesEquation<T>& e) {
    using std::abs;
    using std::exp;
    using std::max;
    using std::sqrt;
    const Real h = span(), m = plain(e.mass), k = plain(e.stiffness), b = plain(e.damping);
    const Real f = plain(e.skin_factor), g = plain(e.skin_gain), decay = plain(e.skin_decay);
    const Real F = abs(plain(e.plate_force)), S = plain(e.plate_slope);
    const Real load = plain(e.load.value), load_change = plain(e.load.rate) * h;
    const Real most_load = max(abs(load), abs(load + load_change));
    const auto last = [](const Polynomial<T>& p, int n) { return abs(plain(p.c[n])); };
    const auto from_rest = [&](std::array<T, N + 2> c) {  // of p/σ, where p begins at 0
      if (begins_ > 0) std::copy(c.begin() + 1, c.end(), c.begin());
      return sums_of(c);
    };
    const Sums r = from_rest(speed.c), d = sums_of(inner(0).c), u = sums_of(inner(1).c);
    const Sums p = from_rest(inner(1).c);

    Real root{0},
        direction{0};  // what the truncated r and d differ from √(u² + w²) and u/√(u² + w²)
    if (e.side == 0) {
      const Real w_rate = plain(e.across.rate) * h,
                 w = begins_ > 0 ? w_rate : plain(e.across.value);
      const Real w_end = begins_ > 0 ? w_rate : w + w_rate;
      const Real w_least = w * w_end > 0 ? std::min(abs(w), abs(w_end)) : Real(0);
      const Real least = max({w_least, r[0] - 2 * r[1], p[0] - 2 * p[1]});
      if (!(least > 0)) return false;
      root = (beyond(r, r) + beyond(p, p)) / least;
      direction = (beyond(r, d) + d[0] * root) / least;
    }
    // What is left of the equation: the terms from the order N on.
    const Real missed =
        e.held ? Real(0)
               : abs(b) * last(velocity, N) + k * (last(position, N) + last(position, N + 1)) +
                     abs(f) * last(skin, N) + most_load * abs(S) * (u[N]) +
                     abs(load_change) * (abs(S) * (u[N - 1] - u[N]) + F * (d[N - 1] - d[N])) +
                     most_load * F * (d[N] + direction);
    const Real missed_skin = abs(g) * last(velocity, N) + abs(decay) * last(skin, N);
    const Real ratio = g != 0 ? f / g : Real(0);
    const Real falls = b + std::min({Real(0), S * load, S * (load + load_change)});
    const Real growth = exp(max({Real(0), -falls / m, -decay}) * h);
    const Real error = h * growth * (missed / sqrt(m) + sqrt(ratio) * missed_skin);  // sqrt(2 E²)
    v_bound = error / sqrt(m);
    x_bound = std::min(h * v_bound, error / sqrt(k));
    skin_bound = ratio > 0 ? error / sqrt(ratio) : Real(0);
    speed_bound = v_bound + root;
    const auto rounding_of = [&](const Sums& sums) { return 2 * unit * sums[0]; };
    return v_bound <= rounding_of(sums_of(velocity.c)) &&
           (ratio == 0 || skin_bound <= rounding_of(sums_of(skin.c))) &&
           speed_bound <= rounding_of(r) + rounding_of(sums_of(velocity.c)) &&
           !(e.held && direction > 64 * unit);
  }
};

}  // namespace pindrive
