/// Motion of a system that is kept: the polynomials of its steps, evaluated at any time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "pindrive/bodies/follow.hpp"
#include "pindrive/bodies/system.hpp"
#include "pindrive/flow/polynomial.hpp"

namespace pindrive::bodies {

/// Bodies and contacts at a time.
template <class T>
struct Quantities {
  std::vector<T> position, velocity, acceleration;  ///< body by body; m, m/s, m/s²
  std::vector<T> stretch;                           ///< m, contact by contact; 0 of a rigid one
  std::vector<T> friction;                          ///< on the first body, N, contact by contact
  std::vector<T> sliding;  ///< speed over the surface, m/s, contact by contact
  std::vector<Slip> slip;  ///< contact by contact
  std::vector<T> push;     ///< force with which a stop pushes, N, stop by stop
  std::vector<T> control;  ///< force of a feedback on its first body, N, one by one
};

/// Steps of a motion, one after another, as their polynomials.
template <class T>
class StoredMotion {
 public:
  using Real = detail::Real<T>;

  explicit StoredMotion(const System<T>& system)
      : bodies_(system.bodies.size()),
        contacts_(system.contacts.size()),
        stops_(system.stops.size()),
        feedbacks_(system.feedbacks.size()) {}

  void add(const Step<T>& step) {
    kept_.push_back({step.begin(), step.length(), step.span(), step.order(), numbers_.size()});
    for (std::size_t i = 0; i < bodies_; ++i) keep(step, step.position_series(i));
    for (std::size_t j = 0; j < contacts_; ++j) {
      keep(step, step.stretch_series(j));
      keep(step, step.friction_series(j));
      keep(step, step.sliding_series(j));
      slips_.push_back(step.slip(static_cast<int>(j)));
    }
    for (std::size_t s = 0; s < stops_; ++s) {
      keep(step, step.push_series(s));
      pushes_.push_back(step.pushes(static_cast<int>(s)));
    }
    for (std::size_t f = 0; f < feedbacks_; ++f) keep(step, step.control_series(f));
  }

  std::size_t steps() const { return kept_.size(); }
  T end() const { return kept_.empty() ? T(0) : kept_.back().begin + kept_.back().length; }

  /// Quantities at a time, s: limits from the right or, of an event, from the left.
  void at(Real time, bool right, Quantities<T>& found) const {
    const std::size_t k = step_at(time, right);
    const Kept& step = kept_[k];
    const T tau = T(time) - step.begin;
    const std::size_t size = static_cast<std::size_t>(step.order) + 1;
    const T* c = numbers_.data() + step.first;
    found.position.resize(bodies_);
    found.velocity.resize(bodies_);
    found.acceleration.resize(bodies_);
    for (std::size_t i = 0; i < bodies_; ++i, c += size) {
      found.position[i] = value(c, step, tau, 0);
      found.velocity[i] = value(c, step, tau, 1);
      found.acceleration[i] = value(c, step, tau, 2);
    }
    found.stretch.resize(contacts_);
    found.friction.resize(contacts_);
    found.sliding.resize(contacts_);
    found.slip.resize(contacts_);
    for (std::size_t j = 0; j < contacts_; ++j, c += 3 * size) {
      found.stretch[j] = value(c, step, tau, 0);
      found.friction[j] = value(c + size, step, tau, 0);
      found.sliding[j] = value(c + 2 * size, step, tau, 0);
      found.slip[j] = slips_[k * contacts_ + j];
    }
    found.push.resize(stops_);
    for (std::size_t s = 0; s < stops_; ++s, c += size)
      found.push[s] = pushes_[k * stops_ + s] ? value(c, step, tau, 0) : T(0);
    found.control.resize(feedbacks_);
    for (std::size_t f = 0; f < feedbacks_; ++f, c += size)
      found.control[f] = value(c, step, tau, 0);
  }

  /// Least and largest position of a body, m.
  std::pair<T, T> range(std::size_t body) const {
    std::pair<T, T> found{std::numeric_limits<Real>::infinity(),
                          -std::numeric_limits<Real>::infinity()};
    for (const Kept& step : kept_) {
      const T* c = numbers_.data() + step.first + body * (static_cast<std::size_t>(step.order) + 1);
      const auto look = [&](const T& tau) {
        const T x = value(c, step, tau, 0);
        found = {std::min(found.first, x), std::max(found.second, x)};
      };
      detail::Polynomial<T> velocity;
      velocity.span = step.span;
      velocity.degree = step.order - 1;
      for (int n = 1; n <= step.order; ++n) velocity.c[n - 1] = T(n) * c[n];
      look(T(0));
      look(step.length);
      const auto turn = [&](const T& tau) {
        if (tau < step.length) look(tau);
        return tau < step.length;
      };
      int first = 0;
      while (first < velocity.degree && velocity.c[first] == 0) ++first;
      detail::sign_changes(velocity, velocity.c[first] < 0 ? -1 : 1, turn);
    }
    return found;
  }

 private:
  struct Kept {
    T begin, length;
    Real span;
    int order;
    std::size_t first;  ///< place of its coefficients
  };

  template <class Series>
  void keep(const Step<T>& step, const Series& series) {
    numbers_.insert(numbers_.end(), series.begin(), series.begin() + step.order() + 1);
  }
  std::size_t step_at(Real time, bool right) const {
    const auto before = [right](const Kept& step, Real t) {
      return right ? plain(step.begin) <= t : plain(step.begin) < t;
    };
    const auto next = std::lower_bound(kept_.begin(), kept_.end(), time, before);
    return next == kept_.begin() ? 0 : static_cast<std::size_t>(next - kept_.begin()) - 1;
  }
  /// A derivative of a polynomial.
  static T value(const T* c, const Kept& step, T tau, int derivative) {
    const T s = tau / step.span;
    T sum{0};
    for (int n = step.order; n >= derivative; --n) {
      T factor{1};
      for (int k = 0; k < derivative; ++k) factor *= T(n - k) / step.span;
      sum = sum * s + factor * c[n];
    }
    return sum;
  }

  std::size_t bodies_, contacts_, stops_, feedbacks_;
  std::vector<Kept> kept_;
  std::vector<T> numbers_;
  std::vector<Slip> slips_;
  std::vector<char> pushes_;  ///< stops that push, step by step
};

}  // namespace pindrive::bodies
