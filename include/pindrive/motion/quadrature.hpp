/// Integrals along a mode by quadrature, independent of its closed form; used to check the solver.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "pindrive/flow/flow.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Positive nodes and weights of a Gauss–Legendre rule on [−1, 1].
template <std::size_t Half>
struct GaussRule {
  std::array<long double, Half> nodes, weights;
};
/// Exact to rounding for e^(κs) with |κ| up to 8 and to 1.2.
inline constexpr GaussRule<8> gauss16{
    {0.0950125098376374401853193354249581L, 0.2816035507792589132304605014604961L,
     0.4580167776572273863424194429835776L, 0.6178762444026437484466717640487910L,
     0.7554044083550030338951011948474423L, 0.8656312023878317438804678977123931L,
     0.9445750230732325760779884155346083L, 0.9894009349916499325961541734503326L},
    {0.1894506104550684962853967232082831L, 0.1826034150449235888667636679692199L,
     0.1691565193950025381893120790303600L, 0.1495959888165767320815017305474785L,
     0.1246289712555338720524762821920164L, 0.0951585116824927848099251076022462L,
     0.0622535239386478928628438369943777L, 0.0271524594117540948517805724560181L}};
inline constexpr GaussRule<4> gauss8{
    {0.1834346424956498049394761423601840L, 0.5255324099163289858177390491892463L,
     0.7966664774136267395915539364758304L, 0.9602898564975362316835608685694730L},
    {0.3626837833783619829651504492771956L, 0.3137066458778872873379622019866013L,
     0.2223810344533744705443559944262409L, 0.1012285362903762591525313543099622L}};

/// Calls visit(τ, weight) at the nodes of a rule from low to high, in order of τ.
template <class T, std::size_t Half, class Visitor>
void gauss_nodes(const GaussRule<Half>& rule, T low, T high, Visitor&& visit) {
  const T middle = (low + high) / 2, half = (high - low) / 2;
  for (std::size_t i = Half; i-- > 0;)
    visit(middle - half * T(rule.nodes[i]), half * T(rule.weights[i]));
  for (std::size_t i = 0; i < Half; ++i)
    visit(middle + half * T(rule.nodes[i]), half * T(rule.weights[i]));
}

/// ∫ f from low to high by the 16-point rule.
template <class T, class Function>
T gauss(Function&& f, T low, T high) {
  T sum{0};
  gauss_nodes(gauss16, low, high, [&](T tau, T weight) { sum += weight * f(tau); });
  return sum;
}

/// Number of time constants of the fastest rate of a mode over which the 16-point rule is exact to
/// rounding, also for a product of two quantities.
inline constexpr int exact_over = 8;

/// ∫ f from 0 to `to` for a function of a mode: panels that resolve its oscillation and, where there
/// is none, grow with time.
template <class T, class Function>
T panels(const Oscillator<T>& oscillator, T to, Function&& f) {
  // The ends of panels do not affect the integral: plain numbers, as rates have a cusp at critical
  // damping, and no derivative there.
  const T quick = exact_over / plain(oscillator.fastest_rate());
  T sum{0};
  T low{0};
  while (low < to) {
    const bool grows = !oscillator.oscillates() || -oscillator.alpha() * low > 40;
    const T high = std::min(low + (grows ? std::max(quick, low / 2) : quick), to);
    sum += gauss<T>(f, low, high);
    low = high;
  }
  return sum;
}

/// ∫₀^to p q for two quantities of a mode, each a line plus an oscillation.
template <class T>
T product_integral(const Oscillator<T>& oscillator, const Path<T>& p, const Path<T>& q, T to) {
  const T alpha = oscillator.alpha(), omega = oscillator.omega();
  const auto product = [&](T tau) { return p.at(oscillator, tau) * q.at(oscillator, tau); };
  if (!p.oscillates() && !q.oscillates()) return gauss<T>(product, T(0), to);  // a polynomial
  if (!oscillator.oscillates() || omega * to < 16) return panels(oscillator, to, product);

  // Lines with lines.
  const T a0 = p.centre(), a1 = p.drift, b0 = q.centre(), b1 = q.drift;
  T sum = to * (a0 * b0 + to * ((a0 * b1 + a1 * b0) / 2 + to * a1 * b1 / 3));

  // Lines with oscillations: ∫w = (2α w − w')/ω₀², and ∫τ w = τ ∫w − ∫∫w.
  const auto antiderivative = [&](const Path<T>& w) {
    const T scale = 1 / oscillator.omega0_squared();
    const T bend = oscillator.bend(w.value, w.slope);
    return Path<T>{T(0), scale * (2 * alpha * w.value - w.slope),
                   scale * (2 * alpha * w.slope - bend)};
  };
  const auto wave_at = [&](const Path<T>& w, T tau) { return w.value + w.change(oscillator, tau); };
  const auto with_line = [&](const Path<T>& path, T constant, T slope) {
    const Path<T> wave{T(0), path.value, path.slope};
    const Path<T> once = antiderivative(wave), twice = antiderivative(once);
    return constant * (wave_at(once, to) - once.value) + slope * to * wave_at(once, to) -
           slope * (wave_at(twice, to) - twice.value);
  };
  sum += with_line(p, b0, b1) + with_line(q, a0, a1);

  // Oscillations: e^2ατ times a constant and a wave of 2ω.
  const T pa = p.value, pb = (p.slope - alpha * p.value) / omega;
  const T qa = q.value, qb = (q.slope - alpha * q.value) / omega;
  const T c = (pa * qa - pb * qb) / 2, d = (pa * qb + pb * qa) / 2;
  const T u = (alpha * c - omega * d) / (2 * oscillator.omega0_squared());
  const T v = (omega * c + alpha * d) / (2 * oscillator.omega0_squared());
  const T mean = alpha == 0 ? to : expm1(2 * alpha * to) / (2 * alpha);
  const auto [sine, cosine] = sine_and_cosine_of(2 * omega * to);
  return sum + (pa * qa + pb * qb) / 2 * mean + exp(2 * alpha * to) * (u * cosine + v * sine) - u;
}

/// ∫ p q over a stretch of a mode.
template <class T>
T product_integral(const Oscillator<T>& oscillator, const Path<T>& p, const Path<T>& q, T from,
                   T to) {
  if (from > 0)
    return product_integral(oscillator, p.from(oscillator, from), q.from(oscillator, from),
                            to - from);
  return product_integral(oscillator, p, q, to);
}

}  // namespace pindrive::detail
