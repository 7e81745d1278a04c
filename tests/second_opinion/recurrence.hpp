/// Finds the state to which a motion comes back, by keeping one of them ever longer (Brent).
#pragma once

#include <cmath>

#include "model.hpp"

namespace second_opinion {

/// A state at which a motion may come by again.
template <class T>
struct Visit {
  T time, x, v;
  T skin;        ///< force in a gripping skin, N
  T hold_begin;  ///< when the plate last took the pin along, s
  Mode mode;
  bool released;  ///< by the plate; kept: since then, too
};

template <class T>
class Recurrence {
 public:
  /// The earlier visit to the same state, or none.
  template <class Drive>
  const Visit<T>* earlier(const Drive& drive, const Visit<T>& now) {
    if (visits_ > 0 && same(drive, now)) return &kept_;
    kept_.released = kept_.released || now.released;
    if (visits_ == next_) {
      kept_ = now;
      next_ += next_ / 4 + 1;
    }
    ++visits_;
    return nullptr;
  }

 private:
  template <class Drive>
  bool same(const Drive& drive, const Visit<T>& now) const {
    using std::abs;
    using std::sqrt;
    const T close = T(recurrence) + T(recurrence_per_round) * T(visits_);
    const auto alike = [&](T one, T other, T scale) { return abs(one - other) <= close * scale; };
    const T size = abs(now.x) + abs(now.v) * sqrt(drive.mass / drive.stiffness);
    return kept_.mode.plate == now.mode.plate && kept_.mode.finger == now.mode.finger &&
           kept_.mode.plate_region == now.mode.plate_region && alike(kept_.x, now.x, size) &&
           alike(kept_.v, now.v, size * sqrt(drive.stiffness / drive.mass)) &&
           alike(kept_.skin, now.skin, drive.finger.static_limit);
  }

  Visit<T> kept_{};
  long long visits_{0}, next_{0};  ///< so far, and when the one that is kept is renewed
};

}  // namespace second_opinion
