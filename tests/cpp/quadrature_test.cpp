// Integrals along a mode: the Gauss rules on what they are exact for, and products of two quantities in every
// damping regime against many small panels.
#include "pindrive/motion/quadrature.hpp"

#include "check.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

/// e^(κs) over [−1, 1].
template <class Rule>
double error_of(const Rule& rule, double kappa) {
  double sum = 0;
  pd::detail::gauss_nodes(rule, -1.0, 1.0,
                          [&](double s, double weight) { sum += weight * std::exp(kappa * s); });
  return std::abs(sum / (2 * std::sinh(kappa) / kappa) - 1);
}

}  // namespace

int main() {
  expect(error_of(pd::detail::gauss16, 8) < 1e-14 && error_of(pd::detail::gauss16, 0.1) < 1e-14,
         "16 nodes are exact to rounding for e^(8 s)");
  expect(error_of(pd::detail::gauss8, 1.2) < 1e-14 && error_of(pd::detail::gauss8, 8) > 1e-9,
         "8 nodes for e^(1.2 s), and not for e^(8 s)");

  double worst = 0, additive = 0;
  for (const double ratio : {0.0, 0.01, 0.9, 1 - 1e-9, 1.0, 1 + 1e-9, 2.0, 30.0, -0.05})
    for (const double to : {1e-3, 0.02, 0.3}) {
      const pd::Oscillator<double> o(0.01, 2 * ratio, 100);
      const pd::Path<double> p{0.1, 0.3, -20, 0.5, 0}, q{-0.2, 0.7, 5, -1, 0};
      const auto product = [&](double t) { return p.at(o, t) * q.at(o, t); };
      double sum = 0, size = 0;
      for (int i = 0; i < 200; ++i) {
        const double part = pd::detail::gauss<double>(product, to * i / 200, to * (i + 1) / 200);
        sum += part;
        size += std::abs(part);
      }
      const double whole = pd::detail::product_integral(o, p, q, 0.0, to);
      worst = std::max(worst, std::abs(whole - sum) / size);
      const double middle = 0.3 * to;
      const double parts = pd::detail::product_integral(o, p, q, 0.0, middle) +
                           pd::detail::product_integral(o, p, q, middle, to);
      additive = std::max(additive, std::abs(whole - parts) / size);
    }
  std::printf("worst %.1e, in two parts %.1e\n", worst, additive);
  expect(worst < 1e-12, "products are integrated to rounding in every damping regime");
  expect(additive < 1e-12, "an integral is the sum of those over its parts");
  return check::status();
}
