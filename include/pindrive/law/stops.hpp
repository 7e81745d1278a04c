/// End stops of the travel: candidate states and force (docs/theory.md, section 6).
#pragma once

#include <array>
#include <cmath>

#include "pindrive/law/guards.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// End stops at an instant. A rigid stop holds the pin. An elastic stop pushes the pin, and may
/// have separated from a pin that is still beyond the end of the travel.
template <class T>
class EndStops {
 public:
  explicit EndStops(const Stops<T>& given) : stops_(given) {}

  StopState state{StopState::apart};
  bool released{false};  ///< the force has just become exactly zero
  bool met{false};       ///< the pin has just reached an end of the travel

  /// Sets the state at the release and after a jump of the velocity. Returns true if the pin
  /// strikes a rigid stop and loses its velocity.
  bool initialize(State<T>& s) {
    released = met = false;
    const int end = s.x < 0 ? -1 : 1;
    if (stops_.rigid()) return end * s.x == stops_.travel && end * s.v > 0 && reach_end(s, end);
    if (end * s.x > stops_.travel) state = at_end(end, push(s, end) > 0);
    return false;
  }

  /// Enumerates the candidate states.
  void enumerate_candidates(const State<T>& s) {
    if (!stops_.present()) return;
    const int end = s.x < 0 ? -1 : 1;
    const bool edge = end * s.x == stops_.travel;
    const StopState touching = at_end(end, true);
    guard_ = ActiveGuard::none;
    count_ = 1;
    push_is_zero_ = released;
    force_jumped_ = met && stops_.damping > 0;
    met = false;
    options_ = {state, StopState::apart};
    if (edge && s.v == 0) {
      guard_ = ActiveGuard::edge;
      options_[0] = touching;
      count_ = 2;
    } else if (edge || stops_.rigid()) {
      options_[0] = edge && end * s.v > 0 ? touching : StopState::apart;
    } else if (released) {
      guard_ = ActiveGuard::push;
      options_ = {touching, at_end(end, false)};
      count_ = 2;
    }
    released = false;
  }
  int count() const { return count_; }
  void choose(int option) { state = options_[option]; }

  bool rigid() const { return stops_.rigid(); }
  bool is_holding() const { return in_contact(state) && stops_.rigid(); }
  bool is_pushing() const { return in_contact(state) && !stops_.rigid(); }
  T stiffness() const { return is_pushing() ? stops_.stiffness : T(0); }
  T damping() const { return is_pushing() ? stops_.damping : T(0); }
  T spring_force(const State<T>& s) const {
    return is_pushing() ? stops_.stiffness * (stop_sign(state) * stops_.travel - s.x) : T(0);
  }
  /// Force of an elastic stop on the pin, N.
  T force(const State<T>& s) const { return spring_force(s) - damping() * s.v; }
  /// Magnitude of the terms of the force, N.
  T force_scale(const State<T>& s) const {
    if ((state == StopState::apart && guard_ == ActiveGuard::none) || stops_.rigid()) return T(0);
    return stops_.stiffness * (s.position_scale + stops_.travel) + stops_.damping * abs(s.v);
  }

  /// True if only the derivatives of the motion decide between contact and separation.
  bool is_undecided() const { return guard_ != ActiveGuard::none; }
  bool at_edge() const { return guard_ == ActiveGuard::edge; }
  /// True if the chosen state agrees with the first derivative of the motion that is not zero.
  bool is_consistent(T v, T acceleration, const Line<T>& jerk) const {
    if (guard_ == ActiveGuard::none) return true;
    T first = acceleration, second = jerk.value, third = jerk.rate;
    if (guard_ == ActiveGuard::push) {
      first = stops_.stiffness * v + stops_.damping * acceleration;
      second = stops_.stiffness * acceleration + stops_.damping * jerk.value;
      third = stops_.stiffness * jerk.value + stops_.damping * jerk.rate;
    }
    const T outwards = T(stop_sign(options_[0])) * (first != 0    ? first
                                                    : second != 0 ? second
                                                                  : third);
    return in_contact(state) ? outwards >= 0 : outwards <= 0;
  }

  /// Adds the guard of the push of a rigid stop that holds the pin. Returns false if the push is
  /// negative or becomes negative at once.
  bool try_hold(Path<T> push, bool exactly, T force_error, Guards<T>& guards) const {
    if (push.start < -force_error && !exactly) return false;
    if (!(push.start > force_error) || exactly) {
      push.start = T(0);
      if ((push.drift != 0 ? push.drift : push.curvature) < 0) return false;
    }
    guards.clear();
    guards.add(push, ActiveGuard::push, false, stop_sign(state));
    return true;
  }

  /// Adds the guards of the stops in a mode in which no rigid stop holds the pin.
  void add_guards(Guards<T>& guards, const State<T>& s, const Flow<T>& flow) const {
    if (!stops_.present() || decays_at_edge(s, flow)) return;
    const auto beyond = [&](int end, int sense) {
      Path<T> path = T(sense * end) * flow.position;
      path.start = sense * (end * s.x - stops_.travel);
      guards.add(path, ActiveGuard::edge, false, end);
    };
    const int end = stop_sign(state);
    if (state == StopState::apart) {
      Path<T> position = flow.position;
      position.start = s.x;
      const int near = leading_sign(position);
      beyond(near, -1);
      beyond(-near, -1);
      return;
    }
    const int sense = in_contact(state) ? 1 : -1;
    if (stops_.damping == 0 || sense < 0) beyond(end, 1);
    if (stops_.damping == 0) return;
    Path<T> path =
        T(sense * end) * (stops_.stiffness * flow.position + stops_.damping * flow.velocity);
    path.start = push_is_zero_ ? T(0) : sense * push(s, end);
    guards.add(path, ActiveGuard::push, false, end);
  }

  /// Moves the pin to the end of the travel exactly. Returns true if the stop is rigid.
  bool reach_end(State<T>& s, int end) {
    met = true;
    s.x = end * stops_.travel;
    if (!stops_.rigid()) return false;
    s.v = T(0);
    return true;
  }
  /// Makes exact a zero that coincides with another event. Returns true if the pin strikes a rigid
  /// stop.
  bool snap(State<T>& s) {
    if (!stops_.present()) return false;
    const bool apart = state == StopState::apart;
    const int end = !apart ? stop_sign(state) : s.x < 0 ? -1 : 1;
    const T depth = end * s.x - stops_.travel;
    if (apart) {
      if (depth < 0) return false;
      s.x = end * stops_.travel;
      return end * s.v > 0 && reach_end(s, end);
    }
    if (stops_.rigid()) return false;
    if (in_contact(state) ? stops_.damping == 0 && !(depth > 0) : !(depth > 0))
      s.x = end * stops_.travel;
    const T pushes = push(s, end);
    if (stops_.damping > 0 && (in_contact(state) ? !(pushes > 0) : pushes >= 0)) released = true;
    return false;
  }
  bool force_jumped() const {
    return force_jumped_;
  }  ///< the force jumped when the pin reached the stop
  bool no_push() const { return push_is_zero_; }  ///< the force is exactly zero

 private:
  /// True if the pin is at rest by the rest criterion (MODEL, section 10) while it decays about the edge of an elastic
  /// stop. Its further contacts with the stop are then no events.
  bool decays_at_edge(const State<T>& s, const Flow<T>& flow) const {
    const Path<T>& x = flow.position;
    if (stops_.rigid() || !x.straight() || !(flow.oscillator.alpha() < 0)) return false;
    const T still = T(rest_tolerance) * stops_.travel;
    const T swing = abs(x.value) + abs(flow.velocity.start) / sqrt(flow.oscillator.hurry_squared());
    return swing <= still && abs(abs(s.x) - stops_.travel) <= still;
  }

  static StopState at_end(int end, bool touching) {
    return static_cast<StopState>(touching ? end : 2 * end);
  }
  T push(const State<T>& s, int end) const {
    return stops_.stiffness * (end * s.x - stops_.travel) + stops_.damping * end * s.v;
  }

  const Stops<T> stops_;
  std::array<StopState, 2> options_{};
  int count_{1};
  /// active guard: distance to the end of the travel, or push
  ActiveGuard guard_{ActiveGuard::none};
  bool push_is_zero_{false}, force_jumped_{false};
};

/// Transition of the stops between two modes; `struck` if the pin has struck a rigid stop.
inline Transition change(StopState before, StopState after, bool struck) {
  if (struck) return in_contact(after) ? Transition::stick : Transition::cross;
  if (in_contact(before) == in_contact(after)) return Transition::none;
  return in_contact(after) ? Transition::stick : Transition::slip;
}

}  // namespace pindrive::detail
