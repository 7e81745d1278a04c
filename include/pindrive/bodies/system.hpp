/// Bodies on one axis with springs, dampers and dry friction between them: what is simulated (MODEL, section 14).
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/model/model.hpp"

namespace pindrive::bodies {

/// Index in place of a body: the ground.
inline constexpr int ground = -1;

template <class T>
struct Body {
  T mass;                  ///< kg; > 0
  Profile<T> force{T(0)};  ///< external force, N
};

/// Spring and damper between two bodies, or between a body and the ground.
template <class T>
struct Link {
  int one, other{ground};
  T stiffness{0};           ///< N/m; >= 0
  T damping{0};             ///< N s/m; >= 0
  Profile<T> length{T(0)};  ///< distance of `one` from `other` at which the spring rests, m
};

/// Dry friction between a body and another one, or the ground.
template <class T>
struct Contact {
  int one, other{ground};
  T kinetic{0}, static_limit{0};                    ///< N; static_limit >= kinetic >= 0
  T stiffness{std::numeric_limits<T>::infinity()};  ///< skin between them, N/m; infinite: rigid
  T damping{0};                                     ///< parallel to the stiffness, N s/m; >= 0
  Profile<T> load{T(1)};                            ///< factor of both frictions; >= 0
  Profile<T> velocity{T(0)};                        ///< surface that moves along `other`, m/s
  int pressed_by{-1};  ///< mode of another contact or of an elastic stop; −1: none
  T share{0};          ///< load per load of that contact, or per force of that stop (1/N); >= 0

  bool rigid() const { return !(stiffness < std::numeric_limits<T>::infinity()); }
};

/// Stop of a body at another one, or at the ground, which pushes and never pulls.
template <class T>
struct Stop {
  int one, other{ground};
  T position{0};  ///< of `one` less that of `other` where they touch, m
  int side{1};    ///< 1: `one` goes no farther; −1: `one` comes no nearer
  T stiffness{std::numeric_limits<T>::infinity()};  ///< N/m; > 0, infinite: rigid
  T damping{0};                                     ///< of an elastic stop, N s/m; >= 0
  T restitution{0};  ///< of a rigid stop: speed after an impact over that before, 0 to 1

  bool rigid() const { return !(stiffness < std::numeric_limits<T>::infinity()); }
};

/// Force of a controller that leads the distance of two bodies along a reference. A sampled one holds its force between
/// its samples at multiples of a period, and sums the error at them.
template <class T>
struct Feedback {
  int one, other{ground};         ///< bodies on which the force and its opposite act
  int measured, against{ground};  ///< bodies whose distance is measured
  T proportional{0}, derivative{0}, integral{0};  ///< gains, N/m, N s/m and N/(m s)
  Profile<T> reference{T(0)};                     ///< intended distance, m
  detail::Real<T> period{0};                      ///< s; 0: continuous

  bool sampled() const { return period > 0; }
  /// Force from an error, its rate, and its integral.
  template <class N>
  N force(const N& error, const N& rate, const N& sum) const {
    return proportional * error + derivative * rate + integral * sum;
  }
};

/// Both bodies of a contact or a stop.
struct Pair {
  int one, other;
};

/// Refers to the rows and pieces of its inputs.
template <class T>
struct System {
  std::vector<Body<T>> bodies;
  std::vector<Link<T>> links;
  std::vector<Contact<T>> contacts;
  std::vector<Stop<T>> stops{};
  std::vector<Feedback<T>> feedbacks{};

  /// Contacts, and after them stops: what has a mode of its own.
  std::size_t modes() const { return contacts.size() + stops.size(); }
  bool is_stop(int mode) const { return static_cast<std::size_t>(mode) >= contacts.size(); }
  std::size_t stop_of(int mode) const { return static_cast<std::size_t>(mode) - contacts.size(); }
  Pair pair(std::size_t j) const {
    if (j < contacts.size()) return {contacts[j].one, contacts[j].other};
    const Stop<T>& stop = stops[j - contacts.size()];
    return {stop.one, stop.other};
  }

  /// Calls a function with each input.
  template <class Look>
  void each_input(Look&& look) const {
    for (const Body<T>& body : bodies) look(body.force);
    for (const Link<T>& link : links) look(link.length);
    for (const Contact<T>& contact : contacts) {
      look(contact.load);
      look(contact.velocity);
    }
    for (const Feedback<T>& feedback : feedbacks) look(feedback.reference);
  }
  /// First breakpoint of any input after a time, s; infinite without one.
  T next_breakpoint(T t) const {
    T next = std::numeric_limits<T>::infinity();
    each_input([&](const Profile<T>& input) { next = std::min(next, input.next_breakpoint(t)); });
    return next;
  }
};

/// State of a contact: slip of `one` over `other` backward or forward, or stick. A stop that pushes has that of stick, one
/// that is open that of backward, and an elastic one that is still pressed in but does not push that of forward.
enum class Slip : signed char { backward = -1, stick = 0, forward = 1 };

/// Positions and velocities of bodies, and the stretch of skin, at a time.
template <class T>
struct State {
  T time{0};                  ///< s
  std::vector<T> position;    ///< m, body by body
  std::vector<T> velocity;    ///< m/s
  std::vector<T> stretch;     ///< m, contact by contact; 0 of a rigid one
  std::vector<T> integral{};  ///< of the error of each feedback, m s
  std::vector<T> held{};      ///< force that each sampled feedback holds, N
  /// Errors of these numbers, since the time is known to rounding; none of given ones.
  struct Errors {
    std::vector<detail::Real<T>> position, velocity, stretch, integral;
  } errors{};
};

}  // namespace pindrive::bodies
