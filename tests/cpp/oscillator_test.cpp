// The free oscillator: its propagator against the textbook's closed forms, and its rates.
#include "pindrive/flow/oscillator.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

int main() {
  using Oscillator = pd::Oscillator<double>;
  const double w = 100;  // rad/s, of mass 0.01 and stiffness 100
  const Oscillator undamped(0.01, 0, 100), critical(0.01, 2, 100), over(0.01, 5, 100);
  bool sinusoid = true, exponential = true, two = true;
  for (const double t : {1e-9, 1e-4, 1e-3, 0.01, 0.05}) {
    const auto u = undamped.after(t);
    const double half = std::sin(w * t / 2);
    sinusoid = sinusoid && near(u.decline, -2 * half * half, 4e-16) &&
               near(w * u.gain, std::sin(w * t), 4e-16);
    const auto c = critical.after(t);
    exponential = exponential && near(w * c.gain, w * t * std::exp(-w * t), 4e-16) &&
                  near(1 + c.decline, (1 + w * t) * std::exp(-w * t), 4e-16);
    const double root = std::sqrt(250.0 * 250 - w * w);
    const double slow = -250 + root, fast = -250 - root;
    two = two && near(over.after(t).gain * w,
                      w * (std::exp(slow * t) - std::exp(fast * t)) / (slow - fast), 1e-15);
  }
  expect(sinusoid, "without damping it is cos and sin");
  expect(exponential, "at critical damping it is (1 + ωt) e^(−ωt) and t e^(−ωt)");
  expect(two, "beyond, it is the difference of two exponentials");
  expect(near(undamped.half_period(), 0.0314159265358979324, 1e-16) && undamped.oscillates(),
         "half a period without damping is π/ω");
  expect(!critical.oscillates() && !over.oscillates(), "from critical damping on it has no period");
  expect(near(over.slowest_rate(), -250 + std::sqrt(52500.0), 1e-12) &&
             near(over.fastest_rate(), 250 + std::sqrt(52500.0), 1e-12),
         "its rates are the two eigenvalues");
  const auto zeros = undamped.zeros(1, 0);
  expect(near(zeros.first, 0.0157079632679489662, 1e-17) &&
             near(zeros.at(1) - zeros.first, 0.0314159265358979324, 1e-16),
         "its zeros are half a period apart");
  return check::status();
}
