/// Closed form of a mode under functions: particular solution and free oscillation
/// (docs/theory.md, section 3).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/series_equation.hpp"
#include "pindrive/series/series_step.hpp"
#include "pindrive/series/term_sum.hpp"

namespace pindrive::detail {

/// True if motions under functions are in closed form where they can be. A library that must be small does without:
/// by series it finds the same motion in more segments.
#ifdef PINDRIVE_SMALL
inline constexpr bool uses_driven_motion = false;
#else
inline constexpr bool uses_driven_motion = true;
#endif

/// Motion in a mode whose equation has constant coefficients, from its begin on.
template <class T>
class DrivenMotion {
 public:
  /// True if a sum holds the terms of all inputs, of the free oscillation and of the skin.
  static bool holds(const SeriesEquation<T>& e) {
    std::size_t terms = e.skin_decay != 0 ? 3 : 2;
    for (const Curve<T>* input : {&e.pushes, &e.plate_velocity, &e.load, &e.finger_load})
      terms += input->terms();
    return terms <= std::size_t{TermSum<T>::most_terms};
  }

  using Path = TermSum<T>;
  static constexpr bool creeps() { return false; }

  TermSum<T> position, velocity;
  TermSum<T> skin;         ///< state of the skin (see SeriesEquation); else 0
  TermSum<T> plate_force;  ///< R, N
  TermSum<T> stick_force;  ///< stick force of the surface that holds the pin, N; else 0
  TermSum<T> speed;        ///< sliding speed on the plate, m/s

  DrivenMotion(const SeriesEquation<T>& e, const SeriesState<T>& start)
      : loads_{e.load, e.finger_load} {
    const T side = T(e.side), drag = e.load.value * e.plate_slope;
    const TermSum<T> surface = e.plate_velocity;
    // All forces but those of the spring, the dampers and the skin.
    TermSum<T> given = e.pushes;
    given.add(e.mass, surface.derivative()).add(-e.finger_force, e.finger_load);
    given.begin_at(e.force.value);
    plate_force.add(-side * e.plate_force, e.load).add(drag, surface);
    given.add(T(1), plate_force);
    const T elastic = e.skin_pull.value * e.skin_stiffness;
    if (e.held) {
      velocity = e.surface;
      position = integral(velocity);
    } else {
      TermSum<T> pull = given;  // skin relaxed where it was
      pull.polynomial[0] += elastic * start.x - e.skin_pull.value * start.skin;
      solve(e.mass, e.damping + drag, e.stiffness + elastic, pull, start);
      velocity = position.derivative();
      velocity.begin_at(start.v);
    }
    position.begin_at(start.x);
    if (e.skin_decay != 0) {
      follow(e, start.skin);
    } else if (e.skin_stiffness != 0) {
      skin.add(e.skin_stiffness, position);
      skin.begin_at(start.skin);
    }
    plate_force.add(-drag, velocity);
    if (e.held)
      stick_force.add(e.mass, velocity.derivative())
          .add(e.damping + drag, velocity)
          .add(e.stiffness, position)
          .add(e.skin_pull.value, skin)
          .add(T(-1), given);
    speed.add(side, velocity).add(-side, surface);
  }

  /// True if its parts are not much larger at τ than its largest position before, or that at τ: near resonance
  /// and near critical damping they cancel.
  bool is_accurate(T largest, T tau) const {
    if (!(slider_forced_ <= T(most_cancelled) * std::max(velocity.size(tau), abs(skin.start()))))
      return false;  // infinite at resonance
    return std::max(position.size(tau), forced_) <=
           T(most_cancelled) * std::max(largest, abs(position.at(tau)));
  }
  /// Time in which a velocity that decays to zero has decayed to rounding, s; infinite for any other velocity.
  T decay_time() const {
    constexpr Real<T> never = std::numeric_limits<Real<T>>::infinity();
    Real<T> slowest = never;
    for (const InputTerm<T>& term : velocity)
      if (term.cosine != 0 || term.sine != 0) slowest = std::min(slowest, plain(term.decay));
    for (const T& lasting : velocity.polynomial)
      if (abs(plain(lasting)) > difference_error<Real<T>> * plain(velocity.size(T(0))))
        return never;
    return slowest > 0 && slowest < never ? -log(rounding<Real<T>>) / slowest : never;
  }
  SeriesState<T> at(T tau) const { return {position.at(tau), velocity.at(tau), skin.at(tau)}; }
  TermSum<T> input(const Curve<T>& curve) const { return curve; }
  /// Step from τ on, of a length within reach.
  SeriesStep<T> step(T tau, Real<T> length) const {
    SeriesStep<T> found;
    found.position = position.from(tau).expanded(length);
    found.velocity = velocity.from(tau).expanded(length);
    found.skin = skin.from(tau).expanded(length);
    found.stick_force = stick_force.from(tau).expanded(length);
    found.speed = speed.from(tau).expanded(length);
    return found;
  }
  /// Longest step after τ over which all quantities and both loads are their Taylor polynomials, s.
  Real<T> reach(Real<T> tau) const {
    Real<T> least = std::numeric_limits<Real<T>>::infinity();
    for (const TermSum<T>* sum : {&velocity, &skin, &plate_force, &stick_force, &speed})
      least = std::min(least, sum->from(tau).reach());
    for (const Curve<T>& load : loads_)
      if (!load.straight())
        least = std::min(least, load.reach(T(tau), series_order, longest_input));
    return least;
  }

 private:
  /// Sum of the parts of a sum, each over a polynomial a z² + b z + c in the rate z of the part.
  static TermSum<T> response(const TermSum<T>& of, T a, T b, T c) {
    constexpr int degree = TermSum<T>::degree;
    TermSum<T> found;
    std::array<T, degree + 1>& p = found.polynomial;
    for (int n = degree; n >= 0 && c != 0; --n) {
      T rest = of.polynomial[n];
      if (n < degree) rest -= b * T(n + 1) * p[n + 1];
      if (n + 1 < degree) rest -= a * T((n + 1) * (n + 2)) * p[n + 2];
      p[n] = rest / c;
    }
    for (const InputTerm<T>& t : of) {
      // z = iΩ − δ
      const T real = a * (t.decay * t.decay - t.frequency * t.frequency) - b * t.decay + c;
      const T imaginary = t.frequency * (b - 2 * a * t.decay);
      const T size = real * real + imaginary * imaginary;
      found.add({(t.cosine * real - t.sine * imaginary) / size,
                 (t.sine * real + t.cosine * imaginary) / size, t.decay, t.frequency});
    }
    return found;
  }
  static TermSum<T> integral(const TermSum<T>& of) {
    TermSum<T> found = response(of, T(0), T(1), T(0));
    for (int n = 0; n < TermSum<T>::degree; ++n)
      found.polynomial[n + 1] = of.polynomial[n] / T(n + 1);
    return found;
  }

  /// Sets the velocity of a slider that does not pull the pin: f y' + D y = K x' + B x'' − F λ'.
  void follow(const SeriesEquation<T>& e, const T& start) {
    const T f = e.skin_factor.value, decay = e.skin_decay;
    TermSum<T> stretching = e.skin_stiffness * velocity;
    stretching.add(e.skin_damping, velocity.derivative())
        .add(-e.finger_force, TermSum<T>(e.finger_load).derivative());
    skin = response(stretching, T(0), f, decay);
    slider_forced_ = skin.size(T(0));
    skin.add({start - skin.at(T(0)), T(0), decay / f, T(0)});
    skin.begin_at(start);
  }

  /// Sets the position: particular solution of m x'' + b x' + k x = `pull`, and free oscillation.
  void solve(T m, T b, T k, const TermSum<T>& pull, const SeriesState<T>& start) {
    position = response(pull, m, b, k);
    forced_ = position.size(T(0));
    const T y = start.x - position.at(T(0)), rate = start.v - position.derivative().at(T(0));
    const T half = b / (2 * m), squared = k / m - half * half;
    const T root = sqrt(abs(squared));
    if (squared > 0) {
      position.add({y, (rate + half * y) / root, half, root});
    } else {
      const T quick = half + root, slow = k / m / quick;
      // Near critical damping both parts are large; their sum is y.
      const T part = (slow * y + rate) / (quick - slow);
      position.add({y + part, T(0), slow, T(0)});
      position.add({-part, T(0), quick, T(0)});
    }
  }

  std::array<Curve<T>, 2> loads_;
  T forced_{
      0};  ///< size of the particular solution, m: a term at resonance merges with the free oscillation
  T slider_forced_{0};  ///< size of the particular solution of the slider, m/s
};

}  // namespace pindrive::detail
