/// Bodies that rigid contacts hold together: their accelerations, and the friction in the contacts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "pindrive/bodies/system.hpp"
#include "pindrive/bodies/uncertain.hpp"

namespace pindrive::detail {

/// Groups of bodies that rigid contacts in stick join. A group moves as the ground if it contains it, or else by the sum
/// of its forces. The friction forces follow from what each body then needs. Where they are not unique, as for a body
/// between two surfaces, the contacts share it in proportion to static friction: stick then lasts as long as it can.
template <class T>
class JoinedBodies {
 public:
  explicit JoinedBodies(const bodies::System<T>& system)
      : system_(&system), root_(system.bodies.size()), mass_(system.bodies.size()) {
    join();
  }

  /// Forgets what holds the bodies.
  void clear() {
    stuck_.clear();
    limits_.clear();
  }
  /// Adds a rigid contact that sticks, or a rigid stop that pushes, with its share in forces that are not unique: static
  /// friction, N.
  void add(int contact, const T& limit) {
    stuck_.push_back(contact);
    limits_.push_back(limit);
  }
  /// Joins the bodies by what was added.
  void join() {
    for (std::size_t i = 0; i < root_.size(); ++i) root_[i] = static_cast<int>(i);
    walk();
    std::fill(mass_.begin(), mass_.end(), T(0));
    for (std::size_t i = 0; i < root_.size(); ++i)
      if (root_[i] != bodies::ground) mass_[root_[i]] += system_->bodies[i].mass;
    factorise();
  }

  /// Numbers of one order of a series, by body and by contact.
  template <class N>
  struct Order {
    std::vector<N> force;               ///< on each body but for rigid contacts that stick, N
    std::vector<N> surface;             ///< acceleration of the surface of each contact, m/s²
    std::vector<N> acceleration;        ///< m/s², body by body
    std::vector<N> friction;            ///< rigid contacts that stick, on `one`, N
    std::vector<N> offset, sum, level;  ///< in between

    Order(std::size_t bodies, std::size_t contacts)
        : force(bodies),
          surface(contacts),
          acceleration(bodies),
          friction(contacts),
          offset(bodies),
          sum(bodies) {}
  };

  /// Computes accelerations and friction from forces and surfaces.
  template <class N>
  void solve(Order<N>& order) const {
    const auto& bodies = system_->bodies;
    if (!stuck_.empty()) return solve_together(order);
    for (std::size_t i = 0; i < bodies.size(); ++i)
      order.acceleration[i] = order.force[i] / bodies[i].mass;
  }
  bool all_grounded() const {
    return std::all_of(root_.begin(), root_.end(), [](int root) { return root == bodies::ground; });
  }
  const std::vector<int>& stuck() const { return stuck_; }
  /// True of a contact that joins two bodies which no other contact joins.
  bool joins(int contact) const {
    return std::any_of(tree_.begin(), tree_.end(),
                       [&](const Edge& edge) { return edge.contact == contact; });
  }

 private:
  struct Edge {
    int from, to, contact, side;  ///< side: 1 if `to` is the first body of the contact
  };

  /// Computes accelerations and friction where rigid contacts stick.
  template <class N>
  void solve_together(Order<N>& order) const {
    const auto& bodies = system_->bodies;
    std::fill(order.offset.begin(), order.offset.end(), N(T(0)));
    std::fill(order.sum.begin(), order.sum.end(), N(T(0)));
    for (const Edge& edge : tree_) {
      order.offset[edge.to] = T(edge.side) * order.surface[edge.contact];
      if (edge.from != bodies::ground) order.offset[edge.to] += order.offset[edge.from];
    }
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (root_[i] != bodies::ground)
        order.sum[root_[i]] += order.force[i] - bodies[i].mass * order.offset[i];
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      order.acceleration[i] = order.offset[i];
      if (root_[i] != bodies::ground)
        order.acceleration[i] += order.sum[root_[i]] / mass_[root_[i]];
    }
    order.level.resize(free_.size());
    for (std::size_t k = 0; k < free_.size(); ++k)
      order.level[k] = bodies[free_[k]].mass * order.acceleration[free_[k]] - order.force[free_[k]];
    substitute(order.level);
    for (std::size_t k = 0; k < stuck_.size(); ++k) {
      const bodies::Pair c = system_->pair(stuck_[k]);
      order.friction[stuck_[k]] =
          limits_[k] * (level_of(order.level, c.one) - level_of(order.level, c.other));
    }
  }

  /// Finds the contacts that join two bodies which no earlier one joins.
  void find_joining() {
    group_.resize(root_.size() + 1);  // the ground is the last
    for (std::size_t i = 0; i < group_.size(); ++i) group_[i] = static_cast<int>(i);
    const auto group_of = [&](int body) {
      int i = body == bodies::ground ? static_cast<int>(root_.size()) : body;
      while (group_[i] != i) i = group_[i];
      return i;
    };
    left_.clear();
    for (const int contact : stuck_) {
      const bodies::Pair c = system_->pair(contact);
      const int one = group_of(c.one), other = group_of(c.other);
      if (one == other) continue;
      group_[one] = other;
      left_.push_back(contact);
    }
  }
  /// Grows a tree of joining contacts through each group, from the ground if that is in the group.
  void walk() {
    find_joining();
    tree_.clear();
    place_.assign(root_.size(), -1);
    free_.clear();
    grow(bodies::ground);
    for (std::size_t i = 0; i < root_.size() && !left_.empty(); ++i)
      if (root_[i] == static_cast<int>(i) && place_[i] < 0) grow(static_cast<int>(i));
  }
  void grow(int start) {
    reached_.assign(1, start);
    for (std::size_t k = 0; k < reached_.size(); ++k) {
      const int from = reached_[k];
      const auto leads_on = [&](int contact) {
        const bodies::Pair c = system_->pair(contact);
        if (c.one != from && c.other != from) return false;
        const int to = c.other == from ? c.one : c.other;
        root_[to] = start;
        tree_.push_back({from, to, contact, c.other == from ? 1 : -1});
        place_[to] = static_cast<int>(free_.size());
        free_.push_back(to);
        reached_.push_back(to);
        return true;
      };
      left_.erase(std::remove_if(left_.begin(), left_.end(), leads_on), left_.end());
    }
  }
  template <class N>
  N level_of(const std::vector<N>& level, int body) const {
    return body == bodies::ground || place_[body] < 0 ? N(T(0)) : level[place_[body]];
  }

  /// Cholesky factor of the matrix of the groups, in which a contact counts by its static friction. A row is zero
  /// before its first column, and remains so.
  void factorise() {
    const std::size_t n = free_.size();
    factor_.assign(n * n, T(0));
    begin_.resize(n);
    for (std::size_t i = 0; i < n; ++i) begin_[i] = i;
    const auto at = [&](int body) { return body == bodies::ground ? -1 : place_[body]; };
    for (std::size_t k = 0; k < stuck_.size(); ++k) {
      const bodies::Pair c = system_->pair(stuck_[k]);
      const int i = at(c.one), j = at(c.other);
      const T weight = limits_[k];
      if (i >= 0) factor_[i * n + i] += weight;
      if (j >= 0) factor_[j * n + j] += weight;
      if (i >= 0 && j >= 0) {
        factor_[i * n + j] -= weight;
        factor_[j * n + i] -= weight;
        std::size_t& begin = begin_[std::max(i, j)];
        begin = std::min(begin, static_cast<std::size_t>(std::min(i, j)));
      }
    }
    using std::sqrt;
    lost_.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = begin_[i]; j <= i; ++j) {
        T sum = factor_[i * n + j];
        const T whole = sum;
        for (std::size_t k = std::max(begin_[i], begin_[j]); k < j; ++k)
          sum -= factor_[i * n + k] * factor_[j * n + k];
        if (i == j) lost_[i] = plain(whole / sum);
        factor_[i * n + j] = i == j ? sqrt(sum) : sum / factor_[j * n + j];
      }
  }
  template <class N>
  void substitute(std::vector<N>& x) const {
    const std::size_t n = free_.size();
    const auto divide = [&](std::size_t i) {
      x[i] = x[i] / factor_[i * n + i];
      widen(x[i], lost_[i]);
    };
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = begin_[i]; k < i; ++k) x[i] -= factor_[i * n + k] * x[k];
      divide(i);
    }
    for (std::size_t i = n; i-- > 0;) {
      divide(i);
      for (std::size_t k = begin_[i]; k < i; ++k) x[k] -= factor_[i * n + k] * x[i];
    }
  }

  const bodies::System<T>* system_;
  std::vector<int> stuck_;
  std::vector<T> limits_;
  std::vector<int> root_;  ///< root of the group, body by body
  std::vector<T> mass_;    ///< sum of a group, at its root, kg
  std::vector<Edge> tree_;
  std::vector<int> free_,
      place_;  ///< bodies whose level is sought, and where each stands among them
  std::vector<int> group_, left_, reached_;  ///< of the walk
  std::vector<T> factor_;
  std::vector<std::size_t> begin_;     ///< first column of each row of the factor
  std::vector<detail::Real<T>> lost_;  ///< roundings of each pivot, which is a difference
};

}  // namespace pindrive::detail
