/// Bounds of the rates of free motions of a system in a mode, from which the length of a step follows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pindrive/bodies/system.hpp"

namespace pindrive::detail {

/// Bounds of the rates of all free motions: of springs by the largest row sum, and so of dampers. Skin that slips, and a
/// stop that does not push, hold no body.
template <class T>
class FreeRates {
 public:
  using Real = detail::Real<T>;
  using Mode = std::vector<bodies::Slip>;

  explicit FreeRates(const bodies::System<T>& system) : system_(&system) {
    clear();
    for (const bodies::Link<T>& link : system.links)
      add(link.one, link.other, link.stiffness, link.damping);
    for (const bodies::Feedback<T>& feedback : system.feedbacks)
      if (!feedback.sampled()) add(feedback);
    always_ = rows_;
    for (const bodies::Contact<T>& c : system.contacts)
      if (!c.rigid()) add(c.one, c.other, c.stiffness, c.damping);
    for (const bodies::Stop<T>& stop : system.stops)
      if (!stop.rigid()) add(stop.one, stop.other, stop.stiffness, stop.damping);
    largest_ = fastest();
    for (const bodies::Contact<T>& c : system.contacts) largest_ = std::max(largest_, of_skin(c));
  }

  /// Bound in any mode, 1/s.
  Real largest() const { return largest_; }
  /// Bound in a mode, 1/s. `settled` tells of a contact if its skin slips and keeps its stretch.
  template <class Settled>
  Real in(const Mode& mode, Settled&& settled) {
    rows_ = always_;
    Real skin{0};
    for (std::size_t j = 0; j < mode.size(); ++j) {
      const bool holds = mode[j] == bodies::Slip::stick;
      if (system_->is_stop(static_cast<int>(j))) {
        const bodies::Stop<T>& stop = system_->stops[system_->stop_of(static_cast<int>(j))];
        if (holds && !stop.rigid()) add(stop.one, stop.other, stop.stiffness, stop.damping);
        continue;
      }
      const bodies::Contact<T>& c = system_->contacts[j];
      if (holds && !c.rigid()) add(c.one, c.other, c.stiffness, c.damping);
      if (!holds && !settled(j)) skin = std::max(skin, of_skin(c));
    }
    return std::max(skin, fastest());
  }

 private:
  struct Row {
    Real stiffness, damping, integral;  ///< over the masses
  };

  void clear() { rows_.assign(system_->bodies.size(), {}); }
  Real mass(int body) const { return plain(system_->bodies[static_cast<std::size_t>(body)].mass); }
  /// Rate at which the stretch of skin that slips comes to rest, 1/s.
  static Real of_skin(const bodies::Contact<T>& c) {
    return c.rigid() || c.damping == 0 ? Real(0) : plain(c.stiffness / c.damping);
  }
  void add(int one, int other, const T& stiffness, const T& damping) {
    using std::sqrt;
    for (const bool first : {true, false}) {
      const int i = first ? one : other, j = first ? other : one;
      if (i == bodies::ground) continue;
      const Real part = 1 / mass(i) + (j == bodies::ground ? Real(0) : 1 / sqrt(mass(i) * mass(j)));
      rows_[i].stiffness += plain(stiffness) * part;
      rows_[i].damping += plain(damping) * part;
    }
  }
  void add(const bodies::Feedback<T>& c) {
    using std::abs, std::sqrt;
    for (const int i : {c.one, c.other})
      for (const int j : {c.measured, c.against}) {
        if (i == bodies::ground || j == bodies::ground) continue;
        const Real part = 1 / sqrt(mass(i) * mass(j));
        rows_[i].stiffness += part * abs(plain(c.proportional));
        rows_[i].damping += part * abs(plain(c.derivative));
        rows_[i].integral += part * abs(plain(c.integral));
      }
  }
  /// Bound of the roots of s³ = damping s² + stiffness s + integral.
  Real fastest() const {
    using std::cbrt, std::sqrt;
    Real found{0};
    for (const auto& [stiffness, damping, integral] : rows_)
      found = std::max(found, Real(sqrt(stiffness + damping * damping / 4)) + damping / 2 +
                                  Real(cbrt(integral)));
    return found;
  }

  const bodies::System<T>* system_;
  std::vector<Row> rows_, always_;
  Real largest_{0};
};

}  // namespace pindrive::detail
