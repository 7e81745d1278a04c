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

/// Selects stick where it is consistent, else a slip. The contacts of a body are decided together, and body after body: a
/// contact of two bodies belongs to the lighter one, whose motion it changes most.
template <class T>
class ModeSelection {
 public:
  using Real = detail::Real<T>;
  using Mode = std::vector<bodies::Slip>;

  explicit ModeSelection(const bodies::System<T>& system) : system_(&system), series_(system) {}

  /// Changes the mode of `active` contacts, and of all that contradict it; false if no mode is consistent.
  bool select(const bodies::State<T>& state, const std::vector<int>& active, Real step,
              Mode& mode) {
    trials_.clear();
    for (const int contact : active) {
      mode[contact] = bodies::Slip::stick;
      trial_of(contact);
    }
    for (Trial& trial : trials_) trial.seen.insert(part_of(trial, mode));
    for (;;) {
      bodies::Slip instead{};
      const int wrong = first_wrong(state, step, mode, instead);
      if (wrong < 0) return true;
      mode[wrong] = instead;
      if (!next_of(trial_of(wrong), mode)) return false;
    }
  }

 private:
  using Number = Uncertain<T>;
  static constexpr int few_orders = 3, all_orders = 12, most_contacts = 6, most_begins = 3;

  /// Modes that the active contacts of one body were tried in.
  struct Trial {
    int body;
    std::vector<int> contacts;
    std::set<Mode> seen;
    int begins;  ///< times that they were tried anew, as other bodies had changed
  };

  int body_of(int contact) const {
    const bodies::Contact<T>& c = system_->contacts[contact];
    if (c.other == bodies::ground) return c.one;
    return system_->bodies[c.other].mass < system_->bodies[c.one].mass ? c.other : c.one;
  }
  /// Trial of the body of a contact, with that contact.
  Trial& trial_of(int contact) {
    const int body = body_of(contact);
    auto found = std::find_if(trials_.begin(), trials_.end(),
                              [&](const Trial& trial) { return trial.body == body; });
    if (found == trials_.end()) found = trials_.insert(trials_.end(), Trial{body, {}, {}, 0});
    std::vector<int>& contacts = found->contacts;
    if (std::find(contacts.begin(), contacts.end(), contact) == contacts.end()) {
      contacts.push_back(contact);
      found->seen.clear();
    }
    return *found;
  }
  static Mode part_of(const Trial& trial, const Mode& mode) {
    Mode part;
    for (const int contact : trial.contacts) part.push_back(mode[contact]);
    return part;
  }
  /// Takes another mode of one body: a new one with the most sticks, and then the nearest; false without any.
  static bool next_of(Trial& trial, Mode& mode) {
    const std::size_t size = std::min(trial.contacts.size(), std::size_t{most_contacts});
    std::size_t count = 1;
    for (std::size_t i = 0; i < size; ++i) count *= 3;
    const Mode near = part_of(trial, mode);
    Mode best;
    int least = std::numeric_limits<int>::max();
    for (std::size_t code = 0; code < count; ++code) {
      Mode tried = near;
      int cost = 0;
      std::size_t rest = code;
      for (std::size_t i = 0; i < size; ++i, rest /= 3) {
        tried[i] = static_cast<bodies::Slip>(rest % 3 == 2 ? -1 : static_cast<int>(rest % 3));
        cost += (rest % 3 != 0 ? 4 : 0) + (tried[i] != near[i] ? 1 : 0);
      }
      if (cost >= least || trial.seen.count(tried) != 0) continue;
      least = cost;
      best = std::move(tried);
    }
    if (best.empty()) {
      trial.seen.clear();
      return ++trial.begins <= most_begins;
    }
    for (std::size_t i = 0; i < size; ++i) mode[trial.contacts[i]] = best[i];
    trial.seen.insert(std::move(best));
    return true;
  }

  /// First contact with a guard that becomes negative, and what to try instead; −1 without any. Most are decided by their
  /// first orders.
  int first_wrong(const bodies::State<T>& state, Real step, const Mode& mode,
                  bodies::Slip& instead) {
    series_.set(mode, state.time);
    for (orders_ = few_orders;; orders_ = all_orders) {
      series_.expand(state, step, orders_);
      undecided_ = false;
      for (std::size_t j = 0; j < mode.size(); ++j)
        if (!is_right(j, mode[j], instead)) return static_cast<int>(j);
      if (!undecided_ || orders_ == all_orders) return -1;
    }
  }
  /// True if no guard of a contact becomes negative; else the mode to try next.
  bool is_right(std::size_t contact, bodies::Slip slip, bodies::Slip& instead) {
    const auto sliding = [&](int n) { return series_.sliding(contact)[n]; };
    instead = bodies::Slip::stick;
    if (slip != bodies::Slip::stick) return sign_of(sliding) * static_cast<int>(slip) >= 0;
    if (series_.may_part(static_cast<int>(contact))) {
      const int parts = sign_of(sliding, 1);
      instead = static_cast<bodies::Slip>(parts);
      if (parts != 0) return false;
    }
    for (const int side : {1, -1}) {
      instead = static_cast<bodies::Slip>(-side);
      if (excess(contact, side) < 0) return false;
    }
    return true;
  }
  /// Sign of the static friction that is left on one side of a contact in stick.
  int excess(std::size_t contact, int side) {
    const auto coefficient = [&](int n) {
      return series_.limit(contact, n) - T(side) * series_.friction(contact)[n];
    };
    return sign_of(coefficient);
  }
  /// Sign after the instant: that of the first coefficient, from an order on, beyond its error.
  template <class Coefficient>
  int sign_of(Coefficient&& coefficient, int first = 0) {
    for (int n = first; n <= orders_; ++n) {
      const Number c = coefficient(n);
      if (!c.may_vanish()) return c.value > 0 ? 1 : -1;
    }
    undecided_ = true;
    return 0;
  }

  const bodies::System<T>* system_;
  Expansion<T, Number> series_;
  std::vector<Trial> trials_;
  int orders_{all_orders};
  bool undecided_{false};
};

}  // namespace pindrive::detail
