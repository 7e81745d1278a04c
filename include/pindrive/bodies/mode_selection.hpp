/// Next mode of a system: each guard is decided by the first of its Taylor coefficients that its error leaves.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "pindrive/bodies/expansion.hpp"
#include "pindrive/bodies/system.hpp"
#include "pindrive/bodies/uncertain.hpp"

namespace pindrive::detail {

/// Selects stick where it is consistent, else a slip, contact by contact (pivoting by the least index).
template <class T>
class ModeSelection {
 public:
  using Real = detail::Real<T>;
  using Mode = std::vector<bodies::Slip>;

  explicit ModeSelection(const bodies::System<T>& system) : system_(&system), series_(system) {}

  /// Changes the mode of `active` contacts, and of all that contradict it; false if no mode is consistent.
  bool select(const bodies::State<T>& state, std::vector<int> active, Real step, Mode& mode) {
    std::set<Mode> seen;
    for (;;) {
      if (!next_of(active, seen, mode)) return false;
      series_.set(mode, state.time);
      series_.expand(state, step, deciding_orders);
      std::size_t wrong = 0;
      bodies::Slip instead{};
      while (wrong < mode.size() && is_right(wrong, mode[wrong], instead)) ++wrong;
      if (wrong == mode.size()) return true;
      if (std::find(active.begin(), active.end(), static_cast<int>(wrong)) == active.end())
        active.push_back(static_cast<int>(wrong));  // without an event of its own, by the others
      mode[wrong] = instead;
    }
  }

 private:
  using Number = Uncertain<T>;
  static constexpr int deciding_orders = 12, most_tried = 729;

  /// Next mode to try, with other states of active contacts: a new one with the most sticks, and then the nearest to the
  /// mode; false if there is none.
  static bool next_of(const std::vector<int>& active, std::set<Mode>& seen, Mode& mode) {
    std::size_t count = 1;
    for (std::size_t i = 0; i < active.size() && count < most_tried; ++i) count *= 3;
    Mode best;
    bool found = false;
    int least = std::numeric_limits<int>::max();
    for (std::size_t code = 0; code < std::min(count, std::size_t{most_tried}); ++code) {
      Mode tried = mode;
      int cost = 0;
      std::size_t rest = code;
      for (const int contact : active) {
        const int digit = static_cast<int>(rest % 3);
        rest /= 3;
        tried[contact] = static_cast<bodies::Slip>(digit == 2 ? -1 : digit);
        cost += (digit != 0 ? 4 : 0) + (tried[contact] != mode[contact] ? 1 : 0);
      }
      if (cost < least && seen.count(tried) == 0) {
        least = cost;
        best = std::move(tried);
        found = true;
      }
    }
    if (!found) return false;
    mode = best;
    seen.insert(std::move(best));
    return true;
  }

  /// True if no guard of a contact becomes negative; else the mode to try next.
  bool is_right(std::size_t contact, bodies::Slip slip, bodies::Slip& instead) const {
    const auto sliding = [&](int n) { return series_.sliding(contact)[n]; };
    instead = bodies::Slip::stick;
    if (slip != bodies::Slip::stick) return sign_of(sliding) * static_cast<int>(slip) >= 0;
    const int parts = sign_of(sliding, 1);  // stuck to surfaces of different motion
    instead = static_cast<bodies::Slip>(parts);
    if (parts != 0) return false;
    for (const int side : {1, -1}) {
      instead = static_cast<bodies::Slip>(-side);
      if (excess(contact, side) < 0) return false;
    }
    return true;
  }
  /// Sign of the static friction that is left on one side of a contact in stick.
  int excess(std::size_t contact, int side) const {
    const auto coefficient = [&](int n) {
      return series_.limit(contact, n) - T(side) * series_.friction(contact)[n];
    };
    return sign_of(coefficient);
  }
  /// Sign after the instant: that of the first coefficient, from an order on, beyond its error.
  template <class Coefficient>
  static int sign_of(Coefficient&& coefficient, int first = 0) {
    for (int n = first; n < deciding_orders; ++n) {
      const Number c = coefficient(n);
      if (!c.may_vanish()) return c.value > 0 ? 1 : -1;
    }
    return 0;
  }

  const bodies::System<T>* system_;
  Expansion<T, Number> series_;
};

}  // namespace pindrive::detail
