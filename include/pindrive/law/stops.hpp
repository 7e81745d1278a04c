/// The end stops of the pin's travel: what they may do next, and their force (docs/theory.md, section 13).
#pragma once

#include <array>
#include <cmath>

#include "pindrive/law/guards.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// The stops of a drive at an instant. A rigid one holds the pin; an elastic one pushes it, and may have let
/// go of a pin that is still beyond the end of its travel.
template <class T>
class EndStops {
 public:
  explicit EndStops(const Stops<T>& given) : stops_(given) {}

  StopState does{StopState::apart};
  bool released{false};  ///< its force has just come to zero, exactly
  bool met{false};       ///< the pin has just come to an end of its travel

  /// At the start, and where the velocity has jumped; whether the pin strikes a rigid one, which takes it.
  bool begin(State<T>& s) {
    released = met = false;
    const int end = s.x < 0 ? -1 : 1;
    if (stops_.rigid()) return end * s.x == stops_.travel && end * s.v > 0 && meet(s, end);
    if (end * s.x > stops_.travel) does = at_end(end, push(s, end) > 0);
    return false;
  }

  /// Finds out what they may do.
  void ask(const State<T>& s) {
    if (!stops_.present()) return;
    const int end = s.x < 0 ? -1 : 1;
    const bool edge = end * s.x == stops_.travel;
    const StopState touching = at_end(end, true);
    at_ = Bound::none;
    count_ = 1;
    exactly_ = released;
    jumped_ = met && stops_.damping > 0;
    met = false;
    options_ = {does, StopState::apart};
    if (edge && s.v == 0) {
      at_ = Bound::edge;
      options_[0] = touching;
      count_ = 2;
    } else if (edge || stops_.rigid()) {
      options_[0] = edge && end * s.v > 0 ? touching : StopState::apart;
    } else if (released) {
      at_ = Bound::push;
      options_ = {touching, at_end(end, false)};
      count_ = 2;
    }
    released = false;
  }
  int count() const { return count_; }
  void take(int option) { does = options_[option]; }

  bool rigid() const { return stops_.rigid(); }
  bool holds() const { return touches(does) && stops_.rigid(); }
  bool pushes() const { return touches(does) && !stops_.rigid(); }
  T stiffness() const { return pushes() ? stops_.stiffness : T(0); }
  T damping() const { return pushes() ? stops_.damping : T(0); }
  T spring_force(const State<T>& s) const {
    return pushes() ? stops_.stiffness * (side(does) * stops_.travel - s.x) : T(0);
  }
  /// Of an elastic one on the pin, N, …
  T force(const State<T>& s) const { return spring_force(s) - damping() * s.v; }
  /// … and how large the terms of it are.
  T size(const State<T>& s) const {
    using std::abs;
    if ((does == StopState::apart && at_ == Bound::none) || stops_.rigid()) return T(0);
    return stops_.stiffness * (s.x_size + stops_.travel) + stops_.damping * abs(s.v);
  }

  /// Whether nothing but how the pin goes on tells whether they touch it, …
  bool ask_further() const { return at_ != Bound::none; }
  bool at_edge() const { return at_ == Bound::edge; }
  /// … and whether the one that was taken agrees with that.
  bool allows(T v, T acceleration, const Line<T>& jerk) const {
    if (at_ == Bound::none) return true;
    T first = acceleration, second = jerk.value, third = jerk.rate;
    if (at_ == Bound::push) {
      first = stops_.stiffness * v + stops_.damping * acceleration;
      second = stops_.stiffness * acceleration + stops_.damping * jerk.value;
      third = stops_.stiffness * jerk.value + stops_.damping * jerk.rate;
    }
    const T outwards = T(side(options_[0])) * (first != 0 ? first : second != 0 ? second : third);
    return touches(does) ? outwards >= 0 : outwards <= 0;
  }

  /// Adds the push of a rigid one that holds the pin; false if it is negative, or becomes so at once.
  bool holds_under(Path<T> push, T rate_size, bool exactly, T roundoff, Guards<T>& guards) const {
    using std::abs;
    if (push.start < -roundoff && !exactly) return false;
    if (!(push.start > roundoff) || exactly) {
      push.start = T(0);
      if (abs(push.drift) <= rounding<T> * rate_size) push.drift = T(0);
      if ((push.drift != 0 ? push.drift : push.curvature) < 0) return false;
    }
    guards.clear();
    guards.add(push, Bound::push, false, side(does));
    return true;
  }

  /// Adds what ends their part in a mode, of a pin that none of them holds.
  void add_guards(Guards<T>& guards, const State<T>& s, const Flow<T>& flow) const {
    if (!stops_.present() || decays_at_edge(s, flow)) return;
    const auto beyond = [&](int end, int sense) {
      Path<T> path = T(sense * end) * flow.position;
      path.start = sense * (end * s.x - stops_.travel);
      guards.add(path, Bound::edge, false, end);
    };
    const int end = side(does);
    if (does == StopState::apart) {
      Path<T> position = flow.position;
      position.start = s.x;
      const int near = sense(position);
      beyond(near, -1);
      beyond(-near, -1);
      return;
    }
    const int sense = touches(does) ? 1 : -1;
    if (stops_.damping == 0 || sense < 0) beyond(end, 1);
    if (stops_.damping == 0) return;
    Path<T> path =
        T(sense * end) * (stops_.stiffness * flow.position + stops_.damping * flow.velocity);
    path.start = exactly_ ? T(0) : sense * push(s, end);
    guards.add(path, Bound::push, false, end);
  }

  /// The pin has come to an end of its travel; whether it strikes what does not yield.
  bool meet(State<T>& s, int end) {
    met = true;
    s.x = end * stops_.travel;
    if (!stops_.rigid()) return false;
    s.v = T(0);
    return true;
  }
  /// Makes exact what rounding has left of a zero at another event; whether the pin has struck a rigid one.
  bool settles(State<T>& s) {
    if (!stops_.present()) return false;
    const bool apart = does == StopState::apart;
    const int end = !apart ? side(does) : s.x < 0 ? -1 : 1;
    const T depth = end * s.x - stops_.travel;
    if (apart) {
      if (depth < 0) return false;
      s.x = end * stops_.travel;
      return end * s.v > 0 && meet(s, end);
    }
    if (stops_.rigid()) return false;
    if (touches(does) ? stops_.damping == 0 && !(depth > 0) : !(depth > 0))
      s.x = end * stops_.travel;
    const T pushes = push(s, end);
    if (stops_.damping > 0 && (touches(does) ? !(pushes > 0) : pushes >= 0)) released = true;
    return false;
  }
  bool jumped() const { return jumped_; }    ///< its force, as the pin met it
  bool no_push() const { return exactly_; }  ///< its force is exactly zero

 private:
  /// True if the pin decays about the edge of an elastic stop, so little beside its position that it is at rest
  /// (MODEL, section 10): what it still does with the stop is no event.
  bool decays_at_edge(const State<T>& s, const Flow<T>& flow) const {
    using std::abs;
    using std::sqrt;
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
  Bound at_{Bound::none};  ///< what is exactly zero: the way to the end of the travel, or the push
  bool exactly_{false}, jumped_{false};
};

/// What happens to the stops between two modes, where a pin may have struck a rigid one.
inline Transition change(StopState before, StopState after, bool struck) {
  if (struck) return touches(after) ? Transition::stick : Transition::cross;
  if (touches(before) == touches(after)) return Transition::none;
  return touches(after) ? Transition::stick : Transition::slip;
}

}  // namespace pindrive::detail
