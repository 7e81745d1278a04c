/// Power series of modes without a closed form (docs/theory.md, section 12).
///
/// The Taylor coefficients follow from the equation by recurrences. Order and length of a step
/// follow from the series, with a proven bound of the truncation error.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/flow/polynomial.hpp"
#include "pindrive/law/oblique.hpp"
#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/series_equation.hpp"
#include "pindrive/series/series_expansion.hpp"
#include "pindrive/series/straight_path.hpp"

namespace pindrive::detail {

/// Taylor series of a mode at a state.
template <class T>
class SeriesFlow : public SeriesExpansion<T> {
 public:
  using typename SeriesExpansion<T>::Real;
  using SeriesExpansion<T>::position, SeriesExpansion<T>::velocity, SeriesExpansion<T>::skin,
      SeriesExpansion<T>::speed;
  using SeriesExpansion<T>::plate_force, SeriesExpansion<T>::stick_force, SeriesExpansion<T>::span;
  using SeriesExpansion<T>::x_bound, SeriesExpansion<T>::v_bound, SeriesExpansion<T>::skin_bound;
  using SeriesExpansion<T>::speed_bound, SeriesExpansion<T>::falling_plate_,
      SeriesExpansion<T>::falling_finger_;

  /// Expands the mode at a state, up to a limit (s; may be infinite); `within_step`: the limit is
  /// known to lie within one step, whose error has been bounded.
  SeriesFlow(const SeriesEquation<T>& equation, const SeriesState<T>& start, T limit,
             bool within_step = false) {
    const Real farthest = plain(limit);
    if (equation.held && equation.side == 0)
      path_ = straight_path(equation.plate_velocity, equation.across);
    const Real rate = linear_rate(equation) + falling_rate(equation, start);
    const Real reach = equation.input_reach();
    const Real turns = along_path() ? Real(0) : turning_rate(equation, start);
    Real step = std::min({1 / (rate + turns), farthest, reach});
    expand(equation, start, step);
    if (within_step) {
      this->rescale(farthest / step);
      this->trim();
      return;
    }
    step = std::min({this->suggested_part(),
                     1 / ((rate / Real(longest_step) + rising_rate(equation)) * step),
                     farthest / step, reach / step, Real(farthest_step)});
    for (int tries = 0; tries < most_reductions; ++tries) {
      this->rescale(step);
      const Real excess = bound(equation);
      if (excess <= 1) break;
      // The error grows with the power N + 1 of the step.
      step = std::max(Real(0.25), Real(0.95) * exp(-log(std::min(excess, Real(1e30))) / (N + 1)));
    }
    if (along_path()) this->rescale(turns_back(equation) / span());
    this->trim();
  }

 protected:
  using SeriesExpansion<T>::N;
  using SeriesExpansion<T>::plate_velocity_, SeriesExpansion<T>::load_, SeriesExpansion<T>::across_;
  using SeriesExpansion<T>::finger_load_, SeriesExpansion<T>::surface_;
  using typename SeriesExpansion<T>::Sums;

 private:
  Slant<T> path_{T(0), T(0)};  // direction of a plate that moves along a straight path
  bool along_path() const { return path_.along != 0 || path_.across != 0; }
  int begins_{0};  // order k at which the first of u and w begins

  Polynomial<T>& inner(int i) { return this->inner_[i]; }  // d, u, φ d of oblique slip

  /// Coefficient sums of p/σᵏ.
  Sums from_rest(std::array<T, N + 2> c) const {
    std::copy(c.begin() + begins_, c.end(), c.begin());
    std::fill(c.end() - begins_, c.end(), T(0));
    return sums_of(c);
  }

  /// Estimate of the fastest rate of the equation without transverse velocity, 1/s.
  static Real linear_rate(const SeriesEquation<T>& e) {
    const Real m = plain(e.mass);
    // Damping delays no pin that is held.
    const Real damping =
        e.held ? Real(0) : abs(plain(e.damping)) + abs(plain(e.load.value) * plain(e.plate_slope));
    return damping / m + e.skin_rate() + sqrt((plain(e.stiffness) + plain(e.skin_stiffness)) / m);
  }
  /// Part of the rate by the falling parts of friction, 1/s.
  static Real falling_rate(const SeriesEquation<T>& e, const SeriesState<T>& s) {
    const T v = e.held ? e.surface.value : s.v, u = v - e.plate_velocity.value;
    Real slopes{0};
    if (e.plate_falling.present()) {
      const T slides = e.side != 0 ? T(e.side) * u : hypot(u, e.across.value);
      slopes += abs(plain(e.load.value * e.plate_falling.slope(slides)));
    }
    if (e.finger_falling.present())
      slopes += abs(plain(e.finger_load.value * e.finger_falling.slope(T(e.finger_side) * v)));
    return slopes / plain(e.mass);
  }
  /// Rate at which the skin factor has grown from zero, 1/s. All solutions but one are singular
  /// there, so a longer step would amplify rounding of the start.
  static Real rising_rate(const SeriesEquation<T>& e) {
    const Real f = plain(e.skin_factor.value), rate = plain(e.skin_factor.rate);
    return f * rate > 0 ? rate / f : Real(0);
  }
  /// True if the plate begins to slide now: u and w are 0.
  static bool starts_to_slide(const SeriesEquation<T>& e, const SeriesState<T>& start) {
    return e.side == 0 && e.across.value == 0 &&
           plain(e.held ? e.surface.value : start.v) == plain(e.plate_velocity.value);
  }

 protected:
  SeriesFlow() = default;

  /// Rate at which the sliding direction turns, 1/s.
  static Real turning_rate(const SeriesEquation<T>& e, const SeriesState<T>& s) {
    if (e.side != 0) return Real(0);
    const Real m = plain(e.mass), w = plain(e.across.value);
    const Real u = plain(s.v) - plain(e.plate_velocity.value), speed = hypot(u, w);
    const Real friction = abs(plain(e.load.value * (e.plate_force + e.plate_falling.at(T(speed)))));
    const Real pull = plain(e.force.value) - plain(e.stiffness) * plain(s.x) -
                      plain(e.damping) * plain(s.v) - plain(e.skin_pull.value) * plain(s.skin) -
                      plain(e.load.value) * plain(e.plate_slope) * u;
    const Real turns = abs(plain(e.plate_velocity.rate)) + abs(plain(e.across.rate));
    if (starts_to_slide(e, s)) {
      if (e.held) return linear_rate(e);
      if (turns == 0)
        return abs(plain(e.across.second())) / abs(plain(s.acceleration - e.plate_velocity.rate));
      return ((abs(pull) + friction) / m + turns) / turns * linear_rate(e);
    }
    const Real along = u / speed, across = w / speed;
    // Friction in the balance of forces, and its turning rate with the velocity.
    // The plate may accelerate.
    const Real apart = pull - m * plain(e.plate_velocity.rate);
    const Real left = abs(apart - friction * along) + friction * across * across;
    return (e.held ? turns : left / m + abs(plain(e.across.rate))) / speed;
  }

  /// Truncation errors of r = √(u² + w²) and d = u/r, and the resulting error of the force, N.
  struct Turning {
    bool known{true};
    Real root{0}, direction{0}, missed{0};
    /// Bounds of the falling parts of friction at a load factor of 1.
    typename FallingSeries<T>::Bounds falling{}, falling_at_finger{};
  };
  Turning bound_turning(const SeriesEquation<T>& e) {
    using std::max;
    const Real F = abs(plain(e.plate_force));
    const Sums d = sums_of(inner(0).c);
    Turning found;
    if (along_path()) {
      found.root = plate_velocity_.missed() + across_.missed();
    } else if (e.side == 0) {
      const Sums r = from_rest(speed.c), p = from_rest(this->inner_[1].c);
      const auto across = across_.from_order(begins_);
      const Sums w = sums_of(across);
      const Real first = plain(across[0]), second = plain(across[0] + across[1]);
      const Real w_least = first * second > 0 ? std::min(abs(first), abs(second)) - w[2] : Real(0);
      const Real least = max({w_least, r[0] - 2 * r[1], p[0] - 2 * p[1]});
      // The error of r² is the rounding of its largest value.
      found.known = least > r[0] / 16;
      found.root = (beyond(r, r) + beyond(p, p) + beyond(w, w)) / least + plate_velocity_.missed() +
                   across_.missed();
      found.direction = (beyond(r, d) + d[0] * found.root) / least;
    }
    if (e.side != 0) found.root = plate_velocity_.missed();
    found.missed = F * (load_.beyond(d) + load_.most() * found.direction);
    auto& falling = found.falling;
    if (e.plate_falling.present()) {
      falling = falling_plate_.bounds(e.plate_falling, sums_of(speed.c), found.root);
      const Sums directed = e.side != 0 ? falling.friction : sums_of(inner(2).c);
      const Real cut = e.side != 0 ? Real(0) : beyond(falling.friction, d);
      found.missed +=
          load_.beyond(directed) +
          load_.most() * (cut + d[0] * falling.error + falling.friction[0] * found.direction);
    }
    auto& at_finger = found.falling_at_finger;
    if (e.finger_falling.present()) {
      at_finger = falling_finger_.bounds(e.finger_falling, sums_of(velocity.c), Real(0));
      found.missed +=
          finger_load_.beyond(at_finger.friction) + finger_load_.most() * at_finger.error;
    }
    return found;
  }

  /// Evaluates the recurrences in the time σ = τ/step.
  void expand(const SeriesEquation<T>& e, const SeriesState<T>& start, Real step) {
    if (!along_path() && starts_to_slide(e, start)) return expand_from_rest(e, start, step);
    this->begin(e, step);
    auto &x = position.c, &v = velocity.c, &y = skin.c, &r = speed.c;
    auto &d = inner(0).c, &u_ = inner(1).c;
    x[0] = start.x;
    v[0] = e.held ? e.surface.value : start.v;
    y[0] = start.skin;
    const bool falls = e.plate_falling.present();
    const T side = along_path() ? T(sense_of_path()) : T(1), per_mass = 1 / e.mass;
    T per_speed{0};                 // 1/r
    std::array<T, N + 1> friction;  // F d + S u
    for (int n = 0;; ++n) {
      this->follow_skin(e, y, v, n, step);
      const T u = u_[n] = v[n] - plate_velocity_[n];
      if (e.side != 0) {
        r[n] = T(e.side) * u;
        if (n == 0) d[0] = T(e.side);
      } else if (along_path()) {
        r[n] = side * (path_.along * plate_velocity_[n] + path_.across * across_[n]);
        d[n] = n == 0 ? -side * path_.along : T(0);
      } else {
        const T squares = across_.square(n) + inner_square(u_, n) - inner_square(r, n);
        r[n] = n == 0 ? sqrt(squares + u * u) : (squares / 2 + u_[0] * u) * per_speed;
        if (n == 0) per_speed = 1 / r[0];
        d[n] = (u - sum_of_products(r, d, n, 1, n)) * per_speed;
      }
      friction[n] = e.plate_force * d[n] + e.plate_slope * u;
      if (falls) friction[n] += directed_falling(e, n, n);
      plate_force.c[n] = -load_.times(friction, n);
      const T part = T(step) / T(n + 1);
      x[n + 1] = part * v[n];
      T forces = plate_force.c[n] - this->damper_force(e, n, step) - e.stiffness * x[n] -
                 e.skin_pull.value * y[n] + this->given_force(e, n, step);
      if (n > 0) forces -= step * e.skin_pull.rate * y[n - 1];
      if (e.finger_falling.present()) forces -= this->falling_finger_force(e, n);
      if (e.held) stick_force.c[n] = e.mass * surface_.rate(n) - forces;
      if (n == N) return;
      v[n + 1] = e.held ? surface_[n + 1] : part * forces * per_mass;
      if (n == 0 && !e.held && !isnan(start.acceleration)) v[1] = start.acceleration * step;
      e.damp(y, v, n + 1);
    }
  }

  /// Time at which a plate turns back on a straight path; the end of the step if the plate does not.
  Real turns_back(const SeriesEquation<T>& e) const {
    const T end(span());
    const Real error = e.plate_velocity.rounding(end) + e.across.rounding(end);
    return std::min(span(), plain(zero_beyond(speed, error)));
  }
  /// Sign of the velocity along a straight path with which the step begins.
  int sense_of_path() const {
    for (int n = 0; n <= N; ++n) {
      const T order = path_.along * plate_velocity_[n] + path_.across * across_[n];
      if (order != 0) return order < 0 ? -1 : 1;
    }
    return 1;
  }

  /// Computes order n of φ and returns that of φ d, from the orders of d up to `known`.
  T directed_falling(const SeriesEquation<T>& e, int n, int known) {
    const auto &d = inner(0).c, &phi = falling_plate_.friction().c;
    falling_plate_.extend(e.plate_falling, speed.c, T(1), n);
    if (e.side != 0) return T(e.side) * phi[n];
    return inner(2).c[n] = sum_of_products(phi, d, n, n - known, n);
  }

 private:
  /// First order at which u or w is not 0, where the plate begins to slide: 1 for a pin that is not held.
  int begin_of_sliding(const SeriesEquation<T>& e) const {
    int k = 1;
    while (e.held && k < N && across_[k] == 0 && surface_[k] == plate_velocity_[k]) ++k;
    return k;
  }
  /// Evaluates the recurrences where u and w begin at order k. The direction is that of u/σᵏ and w/σᵏ. A pin that is
  /// not held has k = 1, so that order n needs the velocity of order n + 1, in which the equation is linear.
  void expand_from_rest(const SeriesEquation<T>& e, const SeriesState<T>& start, Real step) {
    this->begin(e, step);
    begins_ = begin_of_sliding(e);
    auto &x = position.c, &v = velocity.c, &y = skin.c, &r = speed.c;
    auto &d = inner(0).c, &u = inner(1).c;
    x[0] = start.x;
    v[0] = e.plate_velocity.value;
    y[0] = start.skin;
    const int k = begins_;
    const T w = across_[k];
    const bool falls = e.plate_falling.present();
    const T at_rest = falls ? e.plate_force + e.plate_falling.excess : e.plate_force;
    const T strength = e.load.value * at_rest;
    T slope{0};                     // ∂d/∂(u/σ)
    std::array<T, N + 1> friction;  // F d + S u
    for (int n = 0;; ++n) {
      const T part = T(step) / T(n + 1);
      x[n + 1] = part * v[n];
      this->follow_skin(e, y, v, n, step);
      // All forces of this order except plate friction.
      T others = this->given_force(e, n, step) - this->damper_force(e, n, step) -
                 e.stiffness * x[n] - e.skin_pull.value * y[n];
      if (n > 0) others -= step * e.skin_pull.rate * y[n - 1];
      if (e.finger_falling.present()) others -= this->falling_finger_force(e, n);
      // d and ρ/σᵏ of this order without u/σᵏ
      const int last = std::min(n + k - 1, N + 1), first = n + 2 * k - last;
      const T product = -sum_of_products(r, d, n + k, k + 1, last);
      const T square = sum_of_products(u, u, n + 2 * k, first, last) -
                       sum_of_products(r, r, n + 2 * k, first, last) + across_.square(n + 2 * k);
      T known = e.plate_slope * u[n];
      if (falls && n > 0) known += directed_falling(e, n, n - 1);  // without its part of order 0
      if (n == 0) {
        const T rest = others - e.mass * e.plate_velocity.rate;
        u[k] = e.held ? surface_[k] - plate_velocity_[k]
                      : departure_of(e.mass, strength, e.across.rate, rest).acceleration * step;
        r[k] = sqrt(u[k] * u[k] + w * w);
        d[0] = u[k] / r[k];
        slope = w * w / (r[k] * r[k] * r[k]);
        v[1] = e.held ? surface_[1] : u[1] + plate_velocity_[1];
      } else {
        // d is linear in û: first with û = 0, then its contribution.
        const T slower = square / (2 * r[k]);
        d[n] = (product - slower * d[0]) / r[k];
        friction[n] = at_rest * d[n] + known;
        const T forces = others - load_.times(friction, n);
        T further{0};  // u/σᵏ of this order
        if (e.held) {
          v[n + 1] = surface_[n + 1];
          further = surface_[n + k] - plate_velocity_[n + k];
        } else if (n < N) {
          const T inertia = e.mass * plate_velocity_.rate(n);
          further = (forces - inertia) / (e.mass / part + strength * slope);
          v[n + 1] = further + plate_velocity_[n + 1];
        }
        d[n] += slope * further;
        if (n + k <= N + 1) {
          u[n + k] = further;
          r[n + k] = slower + d[0] * further;
        }
      }
      if (falls && n == 0) directed_falling(e, 0, 0);
      friction[n] = at_rest * d[n] + known;
      if (falls && n > 0) inner(2).c[n] += e.plate_falling.excess * d[n];
      plate_force.c[n] = -load_.times(friction, n);
      if (e.held) stick_force.c[n] = e.mass * surface_.rate(n) - others - plate_force.c[n];
      if (n == N) return;
      e.damp(y, v, n + 1);
    }
  }

  /// Bounds the truncation error from the residual of the equation; returns its largest ratio to
  /// rounding, at most 1 for a step that may be used. The error e of a mode, with
  /// 2 E² = m e_v² + k e_x² + (f e_y − B e_v)²/K, grows at most by the energy that the residual supplies, as the slope of friction dissipates energy unless it is
  /// negative.
  Real bound(const SeriesEquation<T>& e) {
    using std::max;
    constexpr Real never = std::numeric_limits<Real>::infinity();
    const Real h = span(), m = plain(e.mass), k = plain(e.stiffness), b = plain(e.damping);
    const Real b_change = plain(e.damping_rate) * h, decay = plain(e.skin_decay);
    const Real f = plain(e.skin_factor.value), f_change = plain(e.skin_factor.rate) * h;
    const Real K = plain(e.skin_stiffness), g = plain(e.skin_pull.value);
    const Real most_g = max(abs(g), abs(g + f_change));
    const Real S = plain(e.plate_slope), most_load = load_.most();
    const auto last = [](const Polynomial<T>& p, int n) { return abs(plain(p.c[n])); };
    const Sums u = sums_of(e.side != 0 ? speed.c : inner(1).c);
    const Turning turning = bound_turning(e);
    if (!turning.known) return never;
    // Residual of the equation: terms from order N on.
    const Real missed =
        e.held ? Real(0)
               : max(abs(b), abs(b + b_change)) * last(velocity, N) +
                     abs(b_change) * last(velocity, N - 1) +
                     k * (last(position, N) + last(position, N + 1)) + most_g * last(skin, N) +
                     abs(f_change) * last(skin, N - 1) +
                     abs(S) * (load_.beyond(u) + most_load * plate_velocity_.missed()) +
                     turning.missed + this->missed_inputs(e);
    const Real missed_skin = K * last(velocity, N) +
                             (abs(decay) + (N + 1) * abs(f_change) / h) * last(skin, N) +
                             this->missed_drift(e);
    const Real falls = std::min(b, b + b_change) - this->bent_damping(e) +
                       std::min(Real(0), S * most_load) - most_load * turning.falling.slope -
                       finger_load_.most() * turning.falling_at_finger.slope;
    const Real growth = exp(max({Real(0), -falls / m, f < 0 ? -decay / f : Real(0)}) * h);
    const Real error =
        h * growth * (missed / sqrt(m) + (K > 0 ? missed_skin / sqrt(K) : Real(0)));  // sqrt(2 E²)
    v_bound = e.held ? Real(0) : error / sqrt(m);
    x_bound = std::min(h * v_bound, error / sqrt(k));
    skin_bound = e.skin_error(h, sqrt(K) * error, v_bound, missed_skin);
    speed_bound = v_bound + turning.root;
    const auto rounding_of = [&](const Sums& sums) { return step_error<Real> * sums[0]; };
    // Slider beside a pin at rest: error of its velocity from the rounding of the forces.
    const Real forces =
        decay != 0 ? most_g * sums_of(skin.c)[0] + k * sums_of(position.c)[0] : Real(0);
    const Real of_velocity = rounding_of(sums_of(velocity.c));
    const auto over = [](Real missing, Real allowed) {
      if (missing <= allowed) return Real(0);
      return missing < never && allowed > 0 ? missing / allowed : never;
    };
    Real excess = max(over(v_bound, of_velocity + step_error<Real> * forces * h / m),
                      over(speed_bound, rounding_of(from_rest(speed.c)) + of_velocity));
    if (K != 0) excess = max(excess, over(skin_bound, rounding_of(sums_of(skin.c))));
    if (!e.held) return excess;
    const auto allowed = [](const FallingFriction<T>& law) {
      return direction_error<Real> * plain(law.excess);
    };
    return max({excess, over(turning.direction, direction_error<Real>),
                over(turning.falling.error, allowed(e.plate_falling)),
                over(turning.falling_at_finger.error, allowed(e.finger_falling))});
  }
};

}  // namespace pindrive::detail
