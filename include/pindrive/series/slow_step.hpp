/// Step of a slow motion that is left when a fast transient is over.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "pindrive/numbers/limits.hpp"
#include "pindrive/series/series_expansion.hpp"

namespace pindrive::detail {

/// Step of a slow motion, with the smallest term of the equation from the series of the preceding iteration.
///
/// `Base` expands the remaining terms. The residual of the last iteration is the change of the small term.
template <class T, class Base = SeriesExpansion<T>>
class SlowStep : public Base {
 public:
  using typename SeriesExpansion<T>::Real;

  /// True if the pin has the slow motion within rounding, and the step may be used.
  bool is_valid() const { return holds_; }

 protected:
  using SeriesExpansion<T>::N;

  /// Sets order n of the small term, in the time σ = τ/step.
  void set_small(int n, const T& value) {
    changes_[n] = std::abs(plain(value - small_[n]));
    small_[n] = value;
  }
  /// Sets the small term to the acceleration below an order, m/s².
  void take_acceleration(Real step, int order) {
    for (int n = 0; n < order; ++n) set_small(n, T(n + 1) / T(step) * this->velocity.c[n + 1]);
  }
  /// Change of the small term in the last iteration, over a part of the step.
  Real last_change(Real part) const {
    Real sum{0}, power{1};
    for (int n = 0; n <= N; ++n, power *= part) sum += changes_[n] * power;
    return sum;
  }
  /// Iterates `expand()` until the change of the small term, in the unit of `allowed(part)`, is within that; sets the part
  /// of the step to use. Returns false without convergence.
  template <class Expand, class Allowed>
  bool iterate(bool within_step, Real left, Real reach, Real unit, Real& part, Expand&& expand,
               Allowed&& allowed) {
    Real last{0};
    bool converged = false;
    for (int round = 0;; ++round) {
      expand();
      part =
          within_step ? left : std::min({this->suggested_part(), left, Real(longest_step), reach});
      if (converged) return true;  // dual derivatives converge one iteration later
      const Real changed = unit * last_change(part);
      converged = changed <= allowed(part);
      if (round == slow_iterations || (round > 2 && !converged && changed > last / 2)) return false;
      last = changed;
    }
  }
  /// Shortens a rescaled step until `bound(part)` holds; a step within a longer one has been bounded.
  template <class Bound>
  void hold(bool within_step, Real part, Bound&& bound) {
    holds_ = within_step || bound(part);
    for (int tries = 0; !holds_ && tries < slow_reductions; ++tries) {
      this->rescale(Real(step_reduction));
      holds_ = bound(part *= Real(step_reduction));
    }
    if (holds_) this->trim();
  }

  std::array<T, N + 1> small_{};  // in the time σ

 private:
  std::array<Real, N + 1> changes_{};  // changes in the last iteration
  bool holds_{false};
};

/// Returns a step if it is valid.
template <class Flow, class... Given>
std::optional<Flow> valid_step(Given&&... given) {
  std::optional<Flow> flow;
  if (!flow.emplace(std::forward<Given>(given)...).is_valid()) flow.reset();
  return flow;
}

}  // namespace pindrive::detail
