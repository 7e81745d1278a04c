// Slow motion by iteration: convergence of the small term, and the length of a valid step.
#include "pindrive/series/slow_step.hpp"

#include <cmath>
#include <optional>

#include "check.hpp"

namespace detail = pindrive::detail;
using check::expect;
using check::near;

namespace {

/// Step with a small term that changes less by a factor in each iteration.
class Relaxation : public detail::SlowStep<double> {
 public:
  explicit Relaxation(double factor, double longest) {
    this->begin({1, 1, 1}, 1);
    double part{1};
    const auto expand = [&] { this->set_small(0, 1 + factor * (this->small_[0] - 1)); };
    converged = this->iterate(true, 1, 1, 1, part, expand, [](double) { return 1e-15; });
    if (!converged) return;
    this->velocity.c[0] = this->small_[0];
    this->hold(false, part, [&](double) { return this->span() <= longest; });
  }
  double value() const { return this->velocity.c[0]; }
  bool converged{false};
};

}  // namespace

int main() {
  const Relaxation quick(1e-3, 1);
  expect(quick.converged && quick.is_valid() && near(quick.value(), 1, 1e-15),
         "an iteration that contracts converges");
  expect(!Relaxation(0.9, 1).converged, "one that contracts slowly is given up");
  const Relaxation shorter(1e-3, 0.5);
  expect(shorter.is_valid() && shorter.span() <= 0.5 && shorter.span() > 0.3,
         "a step is shortened until its bound holds");
  expect(!Relaxation(1e-3, 1e-9).is_valid(), "but not below a limit");
  expect(detail::valid_step<Relaxation>(1e-3, 1.0).has_value() &&
             !detail::valid_step<Relaxation>(0.9, 1.0).has_value(),
         "a step is returned if it is valid");
  return check::status();
}
