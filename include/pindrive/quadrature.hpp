/// Integrals along a mode, apart from its closed form: what the solver says is checked with them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "pindrive/flow.hpp"

namespace pindrive {

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

/// ∫ f from low to high for a function of a mode: panels that resolve its oscillation and, once that
/// has decayed or where there is none, grow with time.
template <class T, class Function>
T integral(const Oscillator<T>& oscillator, T low, T high, Function&& f) {
  using std::abs;
  using std::sqrt;
  const T decay = -oscillator.alpha();
  const T quick = 1 / (abs(oscillator.alpha()) + sqrt(oscillator.omega0_squared()));
  T sum{0};
  while (low < high) {
    const bool grows = !oscillator.oscillates() || decay * low > 40;
    const T next = std::min(low + (grows ? std::max(quick, low / 2) : quick), high);
    sum += gauss<T>(f, low, next);
    low = next;
  }
  return sum;
}

}  // namespace pindrive
