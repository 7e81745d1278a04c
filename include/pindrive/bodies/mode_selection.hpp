/// Next mode of a system: each guard is decided by the first of its Taylor coefficients that its error leaves.
#pragma once

#include <algorithm>
#include <array>
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
  using Inputs = InputsAt<T>;

  explicit ModeSelection(const bodies::System<T>& system)
      : system_(&system), series_(system), zero_(system.modes()) {}

  /// Changes the mode of `active` contacts, and of all that contradict it; false if no mode is consistent.
  bool select(const bodies::State<T>& state, const Inputs& inputs, const std::vector<int>& active,
              Real step, Mode& mode) {
    const Mode before = mode;
    state_ = &state;
    inputs_ = &inputs;
    step_ = step;
    read(few_orders);
    trials_.clear();
    met_ = active;
    for (const int contact : active) {
      mode[contact] = bodies::Slip::stick;
      trial_of(contact);
    }
    for (Trial& trial : trials_) trial.seen.insert(part_of(trial, mode));
    bool several = false;  // contacts that changed
    for (int last = -1;;) {
      bodies::Slip instead{};
      const int wrong = first_wrong(mode, instead);
      if (wrong < 0) {
        if (several) hold_on(before, mode);
        return true;
      }
      several = several || (last >= 0 && wrong != last);
      last = wrong;
      mode[wrong] = instead;
      while (!next_of(trial_of(wrong), mode))
        if (!merge(trial_of(wrong))) return false;
    }
  }

  /// True if a guard on one side of a contact is zero in all its orders: it stays so until the mode changes.
  bool stays_zero(int contact, int side) const { return zero_[contact][side > 0]; }

 private:
  using Number = Uncertain<T>;
  static constexpr int few_orders = 3, all_orders = 12, most_contacts = 6;

  /// Modes that the active contacts of one body, or of several that were decided in vain alone, were tried in.
  struct Trial {
    int body;
    std::vector<int> contacts;
    std::set<Mode> seen;
  };

  /// Lets contacts stick that stuck or were met, and were found to slip before others changed.
  void hold_on(const Mode& before, Mode& mode) {
    bodies::Slip instead{};
    for (std::size_t j = 0; j < system_->contacts.size(); ++j) {
      const bool was_met = std::find(met_.begin(), met_.end(), static_cast<int>(j)) != met_.end();
      if (mode[j] == bodies::Slip::stick || (before[j] != bodies::Slip::stick && !was_met))
        continue;
      Mode tried = mode;
      tried[j] = bodies::Slip::stick;
      if (first_wrong(tried, instead) < 0)
        mode = std::move(tried);
      else
        first_wrong(mode, instead);
    }
  }

  void read(int orders) {
    series_.read(*inputs_, state_->time, step_, orders);
    read_ = orders;
  }
  int body_of(int contact) const {
    const bodies::Pair c = system_->pair(contact);
    if (c.other == bodies::ground) return c.one;
    return system_->bodies[c.other].mass < system_->bodies[c.one].mass ? c.other : c.one;
  }
  /// Trial of the body of a contact, with that contact.
  Trial& trial_of(int contact) {
    const auto has = [&](const Trial& trial, int of) {
      return std::find(trial.contacts.begin(), trial.contacts.end(), of) != trial.contacts.end();
    };
    const int body = body_of(contact);
    auto found = std::find_if(trials_.begin(), trials_.end(),
                              [&](const Trial& trial) { return has(trial, contact); });
    if (found == trials_.end())
      found = std::find_if(trials_.begin(), trials_.end(),
                           [&](const Trial& trial) { return trial.body == body; });
    if (found == trials_.end()) found = trials_.insert(trials_.end(), Trial{body, {}, {}});
    if (!has(*found, contact)) {
      found->contacts.push_back(contact);
      found->seen.clear();
    }
    return *found;
  }
  bool shares_body(const Trial& one, const Trial& other) const {
    const auto touches = [&](int contact, int body) {
      const bodies::Pair c = system_->pair(contact);
      return body != bodies::ground && (c.one == body || c.other == body);
    };
    for (const int j : one.contacts)
      for (const int k : other.contacts)
        if (touches(j, system_->pair(k).one) || touches(j, system_->pair(k).other)) return true;
    return false;
  }
  /// Joins a trial with another one, best with that of a neighbouring body, so that both are decided together; false
  /// without any.
  bool merge(Trial& trial) {
    if (trials_.size() == 1) return false;
    auto other = std::find_if(trials_.begin(), trials_.end(), [&](const Trial& each) {
      return &each != &trial && shares_body(each, trial);
    });
    if (other == trials_.end()) other = trials_.begin() + (&trial == &trials_.front() ? 1 : 0);
    trial.contacts.insert(trial.contacts.end(), other->contacts.begin(), other->contacts.end());
    trial.seen.clear();
    trials_.erase(other);
    return true;
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
    if (best.empty()) return false;
    for (std::size_t i = 0; i < size; ++i) mode[trial.contacts[i]] = best[i];
    trial.seen.insert(std::move(best));
    return true;
  }

  /// First contact with a guard that becomes negative, and what to try instead; −1 without any. Most are decided by their
  /// first orders.
  int first_wrong(const Mode& mode, bodies::Slip& instead) {
    series_.set(mode, *inputs_, met_);
    for (orders_ = few_orders;; orders_ = all_orders) {
      if (orders_ > read_) read(orders_);
      series_.expand(*state_, *inputs_, orders_);
      undecided_ = false;
      std::fill(zero_.begin(), zero_.end(), std::array<bool, 2>{});
      for (std::size_t j = 0; j < mode.size(); ++j)
        if (!is_right(j, mode[j], instead)) return static_cast<int>(j);
      if (!undecided_ || orders_ == all_orders) return -1;
    }
  }
  /// True if no guard of a contact becomes negative; else the mode to try next.
  bool is_right(std::size_t contact, bodies::Slip slip, bodies::Slip& instead) {
    if (series_.is_stop(static_cast<int>(contact))) return is_right_stop(contact, slip, instead);
    const auto sliding = [&](int n) { return series_.sliding(contact)[n]; };
    instead = bodies::Slip::stick;
    const int way = static_cast<int>(slip);
    if (way != 0) {
      const int sign = sign_of(sliding);
      zero_[contact][way > 0] = sign == 0;
      return sign * way >= 0;
    }
    if (series_.may_part(static_cast<int>(contact))) {
      const int parts = sign_of(sliding, 1);
      instead = static_cast<bodies::Slip>(parts);
      if (parts != 0) return false;
    }
    for (const int side : {1, -1}) {
      instead = static_cast<bodies::Slip>(-side);
      const int left = excess(contact, side);
      zero_[contact][side > 0] = left == 0;
      if (left < 0) return false;
    }
    return true;
  }
  /// The same of a stop.
  bool is_right_stop(std::size_t j, bodies::Slip slip, bodies::Slip& instead) {
    const std::size_t stop = series_.stop_of(static_cast<int>(j));
    const bool rigid = system_->stops[stop].rigid();
    const auto sign_in = [&](const auto& series) {
      return sign_of([&](int n) { return series[n]; });
    };
    const auto sign_now = [&](const auto& series) {
      return series[0].may_vanish() ? 0 : series[0].value > 0 ? 1 : -1;
    };
    zero_[j] = {};
    if (slip == bodies::Slip::backward) {
      const int depth = sign_in(series_.depth(stop));
      instead = bodies::Slip::stick;
      zero_[j][0] = depth == 0;
      return depth <= 0;
    }
    const int depth = rigid ? sign_now(series_.depth(stop)) : sign_in(series_.depth(stop));
    const int push = sign_in(series_.push(stop));
    const auto open = depth > 0 && !rigid ? bodies::Slip::forward : bodies::Slip::backward;
    if (slip == bodies::Slip::stick) {
      instead = open;
      zero_[j][1] = push == 0;
      const auto& approach = series_.approach(stop);
      const bool parts = rigid && (series_.may_part(static_cast<int>(j)) ? sign_in(approach)
                                                                         : sign_now(approach)) < 0;
      return depth >= 0 && push >= 0 && !parts;
    }
    instead = depth < 0 || rigid ? bodies::Slip::backward : bodies::Slip::stick;
    zero_[j] = {depth == 0, push == 0};
    return !rigid && depth > 0 && push <= 0;
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
  const bodies::State<T>* state_{nullptr};  ///< state, inputs and unit of time of a selection
  const Inputs* inputs_{nullptr};
  Real step_{1};
  int read_{0};  ///< orders of the inputs that were read
  std::vector<Trial> trials_;
  std::vector<int> met_;  ///< contacts that may begin to stick, while others do already
  int orders_{all_orders};
  bool undecided_{false};
  std::vector<std::array<bool, 2>> zero_;  ///< by contact and side
};

}  // namespace pindrive::detail
