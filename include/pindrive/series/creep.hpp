/// Creep: motion of a pin on a plate that also slides in the transverse direction.
///
/// With a transverse velocity w, friction λ(F u/ρ + S u), ρ = √(u² + w²), drives the velocity
/// within a time ε = m ρ³/(λ F w²) to the value whose friction balances all further forces. For short
/// ε a Taylor series of the whole motion would need steps of a few ε. The slow motion without this
/// fast transient solves
///
///     λ (F t/√(1 + t²) + S w t) + m a + b v + k x + f y = force,   v = x' = v_p + w t,   a = v',
///
/// which is the reduced creep equation if a is omitted, and holds through w = 0, where v = v_p.
/// Here a comes from the series of the preceding iteration, and the remaining residual is bounded.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/creep_balance.hpp"
#include "pindrive/series/overdamped.hpp"
#include "pindrive/series/series.hpp"
#include "pindrive/series/slow_slider.hpp"

namespace pindrive::detail {

/// Step of creep; valid if velocity and series agree with creep within rounding.
template <class T>
class CreepFlow : public SlowStep<T> {
 public:
  using typename SeriesExpansion<T>::Real;
  using SeriesExpansion<T>::position, SeriesExpansion<T>::velocity, SeriesExpansion<T>::skin,
      SeriesExpansion<T>::speed;
  using SeriesExpansion<T>::plate_force, SeriesExpansion<T>::span;
  using SeriesExpansion<T>::x_bound, SeriesExpansion<T>::v_bound, SeriesExpansion<T>::skin_bound;
  using SeriesExpansion<T>::speed_bound;

  /// Expands the series at a state, up to a limit (s; may be infinite) and to the zero of w;
  /// `within_step`: the limit is known to lie within one step. A step is not valid if it would be below `shortest`, s.
  CreepFlow(const SeriesEquation<T>& e, const SeriesState<T>& start, T limit,
            bool within_step = false, Real shortest = 0)
      : balance_(e) {
    this->eliminated = EliminatedPart::of_friction;
    this->set_small(0, e.plate_velocity.rate);  // initial guess: acceleration of the plate
    const Real farthest = balance_.farthest(e, plain(limit));
    const Real step = balance_.span(e, start, farthest);
    if (!(step > 0)) return;
    this->begin(e, step);
    if (balance_.side() < 0) across_.negate();
    Real before{0}, last{0};  // preceding iteration: initial creep velocity, change
    Real left = farthest / step;
    // Best iterate, for a known step whose iterations do not converge within rounding.
    SeriesStep<T> nearest;
    Real least = std::numeric_limits<Real>::infinity();
    for (int round = 0; round < slow_iterations && balance_.solve(e, start, small_[0]); ++round) {
      // The iteration contracts.
      const Real v = plain(e.plate_velocity.value + across_[0] * balance_.ratio());
      const Real off = plain(start.v) - v;
      if (!within_step && round > 0 &&
          abs(off) >
              4 * abs(v - before) + direction_error<Real> * (abs(v) + abs(off)) + unsure(e, start))
        return;
      before = v;
      // The first iteration computes a and its rate, enough to decide about convergence.
      expand(e, start, step, round == 0 ? 2 : N);
      if (round == 0) continue;
      Real part = within_step ? left : until_zero(e, std::min(this->suggested_part(), left), step);
      if (part * step < shortest) return;
      const bool converged = converged_;
      const Real changed = last_change(part);
      const Real allowed = last_digit<Real> * this->size_of(plate_force, part) / plain(e.mass);
      converged_ = changed <= allowed;
      // Changes decrease ever slower: at the present rate they would not be small in time. They decrease faster over
      // a shorter part of the step.
      const bool slow =
          !within_step && round > 2 && !converged_ &&
          (changed > last / 2 ||
           changed * exp(log(changed / last) * (slow_iterations - 2 - round)) > allowed);
      if (slow && shortest == 0) return;
      if (slow) left = part / 4;
      last = slow ? last_change(left) : changed;
      if (within_step && changed < least) {
        least = changed;
        nearest = *this;
      }
      // Dual derivatives converge one iteration later.
      const bool ends = within_step && round + 1 == slow_iterations;
      if (!converged && !ends) continue;
      if (!converged) static_cast<SeriesStep<T>&>(*this) = nearest;
      if (!within_step && !starts_from(e, start)) return;
      this->rescale(part);
      this->hold(within_step, part,
                 [&](Real used) { return bound(e, plain(e.mass) * last_change(used)); });
      break;
    }
  }

 private:
  using SlowStep<T>::small_, SlowStep<T>::last_change;
  using SeriesExpansion<T>::across_;
  using SeriesExpansion<T>::N, SeriesExpansion<T>::falling_plate_,
      SeriesExpansion<T>::falling_finger_;
  using typename SeriesExpansion<T>::Sums;

  Polynomial<T>& inner(int i) { return this->inner_[i]; }  // t, √(1 + t²), t/√(1 + t²)

  /// Part of the step up to the first zero of a transverse velocity that is not linear.
  Real until_zero(const SeriesEquation<T>& e, Real part, Real step) const {
    if (e.across.straight() || !(part < std::numeric_limits<Real>::infinity())) return part;
    const auto w = T(balance_.side()) * polynomial_of(e.across, part * step);
    return std::min(part, plain(zero_beyond(w, e.across.rounding(T(part * step)))) / step);
  }

  /// One iteration in the time σ = τ/step: the series of t from that of a, and from t a new a below
  /// an order.
  void expand(const SeriesEquation<T>& e, const SeriesState<T>& start, Real step, int order) {
    auto &x = position.c, &v = velocity.c, &y = skin.c;
    auto &t = inner(0).c, &s = inner(1).c, &d = inner(2).c;
    const T w = across_[0];
    const bool falls = e.plate_falling.present(), finger_falls = e.finger_falling.present();
    // Falling friction at the plate, along the axis, and at the finger, whose speed is given.
    const auto at_plate = [&](int n) {
      speed.c[n] = across_.times(s, n);
      falling_plate_.extend(e.plate_falling, speed.c, T(1), n);
      return sum_of_products(falling_plate_.friction().c, d, n, 0, n);
    };
    x[0] = start.x;
    y[0] = start.skin;
    std::array<T, N + 1> friction;  // F d + S u
    for (int n = 0;; ++n) {
      // Terms without t of this order; then t and its contribution.
      const T squares = inner_square(t, n) - inner_square(s, n);
      const T product = sum_of_products(s, d, n, 1, n - 1);
      t[n] = n == 0 ? balance_.ratio() : T(0);
      s[n] = n == 0 ? sqrt(1 + t[0] * t[0]) : squares / (2 * s[0]);
      d[n] = n == 0 ? t[0] / s[0] : -(product + s[n] * d[0]) / s[0];
      T u = across_.times(t, n);
      friction[n] = e.plate_force * d[n] + e.plate_slope * u;
      const T v_p = this->plate_velocity_[n];
      T others = e.stiffness * x[n] + e.skin_pull.value * y[n] - this->given_force(e, n, step) +
                 e.mass * small_[n];
      if (n > 0) others += step * (e.damping_rate * v[n - 1] + e.skin_pull.rate * y[n - 1]);
      others += this->bent_damper_force(e, n);
      if (n > 0 && n < N) {
        const T free = (1 - d[0] * d[0]) / s[0];
        T slope = e.plate_force * free + e.plate_slope * w, fallen{0};
        T damping = e.damping + e.skin_drag();
        if (falls) {
          fallen = at_plate(n);
          const T r = speed.c[0];
          slope += e.plate_falling.at(r) * free + e.plate_falling.slope(r) * w * d[0] * d[0];
        }
        if (finger_falls) {
          v[n] = v_p + u;
          others += this->falling_finger_force(e, n);
          damping += e.finger_load.value * e.finger_falling.slope(T(e.finger_side) * v[0]);
        }
        const T missing = this->load_.times(friction, n) + e.load.value * fallen +
                          (e.damping + e.skin_drag()) * (v_p + u) + others;
        t[n] = -missing / (e.load.value * slope + damping * w);
        s[n] += d[0] * t[n];
        d[n] += free * t[n];
        u += w * t[n];
        friction[n] += (e.plate_force * free + e.plate_slope * w) * t[n];
      }
      if (falls) friction[n] += at_plate(n);
      v[n] = v_p + u;
      if (finger_falls) this->falling_finger_force(e, n);
      speed.c[n] = across_.times(s, n);
      plate_force.c[n] = -this->load_.times(friction, n);
      x[n + 1] = T(step) / T(n + 1) * v[n];
      if (n > 0) e.damp(y, v, n);
      this->follow_skin(e, y, v, n, step);
      if (n == order) break;
    }
    this->take_acceleration(step, order);
  }

  /// Bounds the truncation error; true if within rounding. The error of the velocity decreases
  /// where γ (the slope of friction) times the error exceeds the residual plus the forces from the
  /// errors of position and skin, h and g h times the velocity error.
  bool bound(const SeriesEquation<T>& e, Real missed) {
    using std::max;
    const Real h = span(), k = plain(e.stiffness), b = plain(e.damping);
    const Real b_change = plain(e.damping_rate) * h, decay = plain(e.skin_decay);
    const Real f = plain(e.skin_factor.value), f_change = plain(e.skin_factor.rate) * h;
    const Real g = plain(e.skin_pull.value);
    const Real K = plain(e.skin_stiffness);
    const Real F = plain(e.plate_force), S = plain(e.plate_slope);
    const auto& load = this->load_;
    const Real most_load = load.most(), least_load = load.least(), most_w = across_.most();
    const auto last = [](const Polynomial<T>& p, int n) { return abs(plain(p.c[n])); };
    const Sums t = sums_of(inner(0).c), s = sums_of(inner(1).c), d = sums_of(inner(2).c);
    const Sums v = sums_of(velocity.c);
    const Real root = beyond(s, s) + beyond(t, t), direction = beyond(s, d) + d[0] * root;
    missed += max(abs(b), abs(b + b_change)) * last(velocity, N) +
              abs(b_change) * last(velocity, N - 1) +
              k * (last(position, N) + last(position, N + 1)) +
              max(abs(g), abs(g + f_change)) * last(skin, N) + abs(f_change) * last(skin, N - 1) +
              this->missed_inputs(e) +
              abs(S) * (load.beyond(v) + most_load * this->plate_velocity_.missed()) +
              F * (load.beyond(d) + most_load * direction);
    Real falls{0};           // slopes of falling friction, N s/m
    Real least_friction{F};  // at a load factor of 1, N
    if (e.plate_falling.present()) {
      const auto& phi = falling_plate_.friction().c;
      std::array<T, N + 2> directed{};
      for (int n = 0; n <= N; ++n) directed[n] = sum_of_products(phi, inner(2).c, n, 0, n);
      const auto [parts, slope, error] =
          falling_plate_.bounds(e.plate_falling, sums_of(speed.c), most_w * root);
      missed += load.beyond(sums_of(directed)) +
                most_load * (beyond(parts, d) + d[0] * error + parts[0] * direction);
      falls += most_load * slope;
      least_friction += max(Real(0), 2 * abs(plain(phi[0])) - parts[0] - error);
    }
    if (e.finger_falling.present()) {
      const auto& pressed = this->finger_load_;
      const auto [parts, slope, error] = falling_finger_.bounds(e.finger_falling, v, Real(0));
      missed += pressed.beyond(parts) + pressed.most() * error;
      falls += pressed.most() * slope;
    }
    const Real missed_skin = K * last(velocity, N) +
                             (abs(decay) + (N + 1) * abs(f_change) / h) * last(skin, N) +
                             this->missed_drift(e);
    const Real steep = sqrt(1 + t[0] * t[0]);
    const Real gamma = std::min(b, b + b_change) + plain(e.skin_drag()) - this->bent_damping(e) +
                       least_load * least_friction / (most_w * steep * steep * steep) +
                       std::min(S * least_load, S * most_load) - falls;
    const Real grown = exp(max(Real(0), f < 0 ? -decay / f : Real(0)) * h) * h;
    const Real left = gamma - k * h - K * grown;
    if (!(left > 0)) return false;
    v_bound = (missed + grown * missed_skin) / left + beyond(sums_of(across_.from_order(0)), t) +
              across_.missed() * t[0];
    x_bound = h * v_bound;
    skin_bound = e.skin_error(h, grown * (K * v_bound + missed_skin), v_bound, missed_skin);
    speed_bound = v_bound + most_w * root;
    return v_bound <= rounding_of(v) && (K == 0 || skin_bound <= rounding_of(sums_of(skin.c)));
  }
  static Real rounding_of(const Sums& sums) { return eliminated_error<Real> * sums[0]; }

  /// True if the pin has the velocity of creep: a deviation within rounding decays at once
  /// (rounding: tests/hard/creep-across-a-falling-curve.txt).
  bool starts_from(const SeriesEquation<T>& e, const SeriesState<T>& start) const {
    return abs(plain(start.v - velocity.c[0])) <=
           difference_error<Real> * sums_of(velocity.c)[0] + unsure(e, start);
  }
  /// Error of the creep velocity from the rounding of forces, inputs and time: large near the friction limit, but at most a
  /// small part of the velocity there.
  Real unsure(const SeriesEquation<T>& e, const SeriesState<T>& start) const {
    const Real sizes = abs(plain(e.force.value)) + abs(plain(e.mass) * plain(small_[0])) +
                       abs(plain(e.damping) * plain(start.v)) +
                       plain(e.stiffness) * abs(plain(start.x)) +
                       abs(plain(e.skin_pull.value) * plain(start.skin));
    const Real changes =
        abs(plain(e.plate_velocity.rate)) + abs(plain(balance_.across().rate * balance_.ratio()));
    // rounding: tests/hard/creep-turn-within-rounding-at-breakpoint.txt and creep-with-weak-friction-and-strong-skin.txt
    const Real by_forces = difference_error<Real> * sizes * plain(balance_.across().value) /
                           plain(e.load.value * balance_.friction(e));
    const Real root = hypot(Real(1), plain(balance_.ratio()));
    const Real here =
        std::min(by_forces * root * root * root, creep_error<Real> * abs(plain(start.v)));
    // rounding: tests/hard/creep-velocity-known-to-the-time.txt
    return std::max(by_forces, here) + rounding<Real> * plain(start.time) * changes +
           rounding_of(e.plate_velocity) + abs(plain(balance_.ratio())) * rounding_of(e.across);
  }
  /// Rounding of a function at the start; a line is exact.
  static Real rounding_of(const Curve<T>& input) {
    return input.straight() ? Real(0) : input.rounding();
  }

  CreepBalance<T> balance_;  // at the start
  bool converged_{false};
};

/// Returns a step of creep; none if the pin has a fast transient, or the step would be too short.
template <class T>
std::optional<CreepFlow<T>> creep(const SeriesEquation<T>& e, const SeriesState<T>& start, T limit,
                                  bool within_step = false, Real<T> shortest = 0) {
  return valid_step<CreepFlow<T>>(e, start, limit, within_step, shortest);
}

/// True if the plate begins to slide across with zero transverse acceleration, while the pin has the velocity and the
/// acceleration of the plate. The equation is singular there, and creep is its only solution.
template <class T>
bool follows_plate(const SeriesEquation<T>& e, const SeriesState<T>& start) {
  if (start.v != e.plate_velocity.value || e.across.value != 0 || e.across.rate != 0) return false;
  return start.acceleration == e.plate_velocity.rate;
}
/// Force on a pin that moves as the plate, beside friction, N.
template <class T>
T pull_on(const SeriesEquation<T>& e, const SeriesState<T>& start) {
  return e.force.value - e.mass * e.plate_velocity.rate - e.damping * start.v -
         e.stiffness * start.x - e.skin_pull.value * start.skin;
}
/// Returns the velocity, relative to the plate, of a pin at its friction limit a time after the plate began to slide
/// across, m/s. Friction balances the pull, and the pin lags behind the plate: m u' = λF w²/(2u²) while w is much smaller
/// than u.
template <class T>
[[gnu::noinline]] T lag_at_limit(const SeriesEquation<T>& e, T pull, T time) {
  const T friction = e.load.value * (e.plate_force + e.plate_falling.excess);
  if (abs(pull) < friction) return T(0);
  const T w = e.across.at(time), order = time * e.across.rate_at(time) / w;
  const T cube = T(1.5) * friction / e.mass * w * w * time / (2 * order + 1);
  return cube > 0 ? (pull < 0 ? -1 : 1) * exp(log(cube) / 3) : T(0);
}
/// Returns a step in which a pin at its friction limit moves with the plate for a short time.
template <class T>
[[gnu::noinline]] SeriesStep<T> carried_by_plate(SeriesEquation<T> e, const SeriesState<T>& start,
                                                 T limit) {
  const T pull = pull_on(e, start);
  e.side = pull < 0 ? -1 : 1;
  // Friction without a constant part is −λ S u along the axis, whatever the sliding direction.
  if (e.plate_force + e.plate_falling.excess == 0) return SeriesFlow<T>(e, start, limit);
  e.held = true;
  e.surface = e.plate_velocity;
  SeriesStep<T> step = SeriesFlow<T>(e, start, limit);
  step.velocity.degree = std::max(step.velocity.degree, 2);
  step.velocity.c[2] += lag_at_limit(e, pull, T(step.span()));
  return step;
}
/// Returns the time for which a pin at its friction limit moves with the plate, s, at most `longest`: until friction has
/// turned by `turned_by_carrying`.
template <class T>
T time_carried(const SeriesEquation<T>& e, const SeriesState<T>& start, T longest) {
  const T lag = abs(lag_at_limit(e, pull_on(e, start), longest)), w = abs(e.across.at(longest));
  if (!(w > T(turned_by_carrying) * lag) || lag == 0) return longest;
  // (w/lag)³ grows as w/τ.
  const T over = T(turned_by_carrying) * lag / w;
  const T order = longest * e.across.rate_at(longest) / e.across.at(longest);
  const T shorter = longest * exp(3 * log(over) / (order - 1));
  return std::min(longest, shorter);
}
/// Returns a step of a pin that follows the plate. The series diverges, but is exact to rounding over a short time.
template <class T>
SeriesStep<T> creep_from_rest(const SeriesEquation<T>& e, const SeriesState<T>& start, T limit) {
  const Real<T> natural_time = sqrt(plain(e.mass / e.stiffness));
  for (T span = creep_span(e, start, limit); span > rounding<T> * natural_time; span *= T(0.125))
    if (const auto flow = creep(e, start, span)) return *flow;
  return carried_by_plate(e, start,
                          std::min(limit, time_carried(e, start, T(carried_time) * natural_time)));
}

/// Step from a state: the Taylor series, or the slow motion where the fast transient is over: in
/// creep, on a slider of stiff skin, or of an overdamped pin.
template <class T>
SeriesStep<T> series_step(const SeriesEquation<T>& e, const SeriesState<T>& start, T limit) {
  if (const auto slow = slow_slider(e, start, limit)) return *slow;
  if (const auto slow = overdamped(e, start, limit)) return *slow;
  if (e.held || e.side != 0) return SeriesFlow<T>(e, start, limit);
  if (follows_plate(e, start)) return creep_from_rest(e, start, limit);
  SeriesStep<T> step;
  const bool slides = plain(start.v) != plain(e.plate_velocity.value) || plain(e.across.value) != 0;
  if (slides) step = SeriesFlow<T>(e, start, limit);
  if (slides && !(step.span() < plain(limit))) return step;
  if (slides && creep_span(e, start, limit) < Real<T>(creep_steps) * step.span()) return step;
  if (const auto flow = creep(e, start, limit, false, slides ? step.span() : 0);
      flow && !(slides && flow->span() < step.span()))
    return *flow;
  return slides ? step : SeriesFlow<T>(e, start, limit);
}

}  // namespace pindrive::detail
