// Functions made of a few numbers: their values beside their formulas, and derivatives beside differences.
#include "pindrive/model/named_function.hpp"

#include <array>
#include <cmath>

#include "check.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

using Numbers = std::array<double, 4>;

template <class T>
T value_at(const pd::FunctionKind& kind, const std::array<T, 4>& numbers, double t) {
  const pd::NamedFunction<T> made = pd::named_function(kind, numbers);
  std::array<pd::InputPiece<T>, 3> pieces{};
  for (std::size_t i = 0; i < made.count; ++i) pieces[i] = made.pieces[i].piece;
  return pd::Profile<T>(pieces.data(), made.count).from(T(t)).value;
}

double formula(int kind, const Numbers& p, double t) {
  if (kind == 0) return p[0] + p[1] * std::sin(2 * M_PI * p[2] * t + p[3]);
  if (kind == 1) {
    const double s = std::min(std::max((t - p[2]) / p[1], 0.0), 1.0);
    return 30 * p[0] / p[1] * s * s * (1 - s) * (1 - s);
  }
  return t < p[3] ? p[0] : p[1] + (p[0] - p[1]) * std::exp(-(t - p[3]) / p[2]);
}

}  // namespace

int main() {
  const std::array<Numbers, 3> given{
      Numbers{0.06, 0.02, 8, 0.7}, {0.05, 0.3, 0.04, 0}, {3, 0.5, 0.02, 0.05}};
  double worst = 0, along = 0;
  for (int k = 0; k < 3; ++k) {
    const pd::FunctionKind& kind = pd::function_kinds[k];
    expect(pd::function_kind(kind.name) == &kind, kind.name);
    for (double t = 0; t < 0.5; t += 0.01) {
      worst = std::max(worst, std::abs(value_at(kind, given[k], t) - formula(k, given[k], t)));
      for (std::size_t i = 0; i < kind.count(); ++i) {
        const double step = 1e-6 * given[k][i];
        Numbers low = given[k], high = given[k];
        low[i] -= step;
        high[i] += step;
        std::array<pd::Dual<double>, 4> moved;
        for (std::size_t j = 0; j < 4; ++j) moved[j] = {given[k][j], j == i ? 1.0 : 0.0};
        const double difference = (formula(k, high, t) - formula(k, low, t)) / (2 * step);
        const bool bends = k > 0 && (std::abs(t - given[k][k == 1 ? 2 : 3]) < 1e-6 ||
                                     std::abs(t - given[1][1] - given[1][2]) < 1e-6);
        const double apart = std::abs(value_at(kind, moved, t).slope - difference);
        if (!bends) along = std::max(along, apart / (1 + std::abs(difference)));
      }
    }
  }
  std::printf("# values within %.1e, derivatives within %.1e of differences\n", worst, along);
  expect(worst < 1e-14, "functions have the values of their formulas");
  expect(along < 1e-8, "and their derivatives, begins included");
  expect(pd::function_kind("sawtooth") == nullptr, "an unknown kind is none");
  return check::status();
}
