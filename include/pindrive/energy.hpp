/// Where the energy of a motion comes from and where it goes.
///
/// The damper's share is integrated on its own, not taken as what is left over, so that the terms
/// add up only if the motion is right.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "pindrive/motion.hpp"

namespace pindrive {

template <class T>
struct Ledger {
  T kinetic_start, kinetic_end;  ///< J
  T spring_start, spring_end;    ///< J
  T plate_work;                  ///< what the moving plate puts in through friction, J
  T damper_dissipated, plate_dissipated, finger_dissipated;  ///< J

  T residual() const {
    return (kinetic_end - kinetic_start) + (spring_end - spring_start) - plate_work +
           damper_dissipated + plate_dissipated + finger_dissipated;
  }
  /// The largest energy in the ledger: what the residual is measured against.
  T scale() const {
    using std::abs;
    return std::max({kinetic_start, kinetic_end, spring_start, spring_end, abs(plate_work),
                     damper_dissipated, plate_dissipated, finger_dissipated});
  }
};

/// ∫ f from low to high by the 16-point Gauss–Legendre rule.
template <class T, class Function>
T gauss(Function&& f, T low, T high) {
  static constexpr std::array<long double, 8> nodes{
      0.0950125098376374401853193354249581L, 0.2816035507792589132304605014604961L,
      0.4580167776572273863424194429835775L, 0.6178762444026437484466717640487910L,
      0.7554044083550030338951011948474422L, 0.8656312023878317438804678977123931L,
      0.9445750230732325760779884155346083L, 0.9894009349916499325961541734503326L};
  static constexpr std::array<long double, 8> weights{
      0.1894506104550684962853967232082831L, 0.1826034150449235888667636679692199L,
      0.1691565193950025381893120790303599L, 0.1495959888165767320815017305474785L,
      0.1246289712555338720524762821920164L, 0.0951585116824927848099251076022462L,
      0.0622535239386478928628438369943776L, 0.0271524594117540948517805724560181L};
  const T middle = (low + high) / 2, half = (high - low) / 2;
  T sum{0};
  for (std::size_t i = 0; i < nodes.size(); ++i)
    sum += T(weights[i]) * (f(middle - half * T(nodes[i])) + f(middle + half * T(nodes[i])));
  return sum * half;
}

/// ∫₀^to w² for the free oscillation w = value·Φ + slope·Ψ.
template <class T>
T square_integral(const Oscillator<T>& oscillator, T value, T slope, T to) {
  using std::abs;
  using std::cos;
  using std::exp;
  using std::expm1;
  using std::sin;
  using std::sqrt;
  const T alpha = oscillator.alpha(), omega = oscillator.omega();
  const T omega0 = sqrt(oscillator.omega0_squared());
  if (oscillator.oscillates() && omega > omega0 / 4 && omega * to > 2) {
    // w = e^ατ (A cos ωτ + B sin ωτ); its square is a constant and a wave of 2ω, both times e^2ατ.
    const T a = value, b = (slope - alpha * value) / omega;
    const T steady = (a * a + b * b) / 2;
    const T c = (a * a - b * b) / 2, d = a * b;
    const T p = (alpha * c - omega * d) / (2 * oscillator.omega0_squared());
    const T q = (omega * c + alpha * d) / (2 * oscillator.omega0_squared());
    const T mean = alpha == 0 ? to : expm1(2 * alpha * to) / (2 * alpha);
    const T angle = 2 * omega * to;
    return steady * mean + exp(2 * alpha * to) * (p * cos(angle) + q * sin(angle)) - p;
  }
  // Where those terms would cancel, and beyond critical damping: panels that grow with time, as
  // the decay allows.
  const auto square = [&](T tau) {
    const Path<T> wave{value, value, slope, T(0)};
    const T w = wave.at(oscillator, tau);
    return w * w;
  };
  T sum{0};
  T low{0}, panel = 1 / (abs(alpha) + omega0);
  while (low < to) {
    const T high = std::min(low + panel, to);
    sum += gauss<T>(square, low, high);
    panel = std::max(panel, high / 2);
    low = high;
  }
  return sum;
}

template <class T>
Ledger<T> energy_ledger(const Motion<T>& motion, T duration) {
  using std::abs;
  const Drive<T>& drive = motion.drive();
  const Friction<T> friction = motion.friction();
  const T v_plate = motion.inputs().mouse_velocity;
  Ledger<T> ledger{};
  const auto state = [&](T t, T& kinetic, T& spring) {
    const auto [segment, tau] = motion.locate(t, Side::left);
    const T x = segment->flow.position.at(segment->flow.oscillator, tau);
    const T v = segment->flow.velocity.at(segment->flow.oscillator, tau);
    kinetic = drive.mass * v * v / 2;
    spring = drive.stiffness * x * x / 2;
  };
  state(T(0), ledger.kinetic_start, ledger.spring_start);
  state(duration, ledger.kinetic_end, ledger.spring_end);

  motion.stretches(duration, [&](const Segment<T>& segment, T from, T to, T times) {
    const Flow<T>& flow = segment.flow;
    const T x_from = flow.position.at(flow.oscillator, from);
    const T x_to = flow.position.at(flow.oscillator, to);
    const T span = to - from;
    const T moved =
        flow.position.change(flow.oscillator, to) - flow.position.change(flow.oscillator, from);

    // v = constant + oscillation w, and ∫w is what the position moved beyond the constant.
    const Path<T>& v = flow.velocity;
    const T constant = v.centre();
    const auto squares = [&](T tau) {
      return square_integral(flow.oscillator, v.value, v.slope, tau);
    };
    const T oscillation = v.value == 0 && v.slope == 0 ? T(0) : squares(to) - squares(from);
    const T v_squared =
        constant * constant * span + 2 * constant * (moved - constant * span) + oscillation;
    ledger.damper_dissipated += times * drive.damping * v_squared;

    const auto at_from = friction.forces(segment.mode, x_from);
    const auto at_to = friction.forces(segment.mode, x_to);
    ledger.plate_work += times * v_plate * span * (at_from.plate + at_to.plate) / 2;
    if (segment.mode.plate != Slide::stuck)
      ledger.plate_dissipated += times * abs(at_from.plate * (moved - v_plate * span));
    if (segment.mode.finger != Slide::stuck)
      ledger.finger_dissipated += times * abs(at_from.finger * moved);
  });
  return ledger;
}

}  // namespace pindrive
