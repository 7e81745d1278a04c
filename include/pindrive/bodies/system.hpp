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

  /// Contacts, and after them stops: what has a mode of its own.
  std::size_t modes() const { return contacts.size() + stops.size(); }
  Pair pair(std::size_t j) const {
    if (j < contacts.size()) return {contacts[j].one, contacts[j].other};
    const Stop<T>& stop = stops[j - contacts.size()];
    return {stop.one, stop.other};
  }

  /// First breakpoint of any input after a time, s; infinite without one.
  T next_breakpoint(T t) const {
    T next = std::numeric_limits<T>::infinity();
    const auto look = [&](const Profile<T>& input) {
      next = std::min(next, input.next_breakpoint(t));
    };
    for (const Body<T>& body : bodies) look(body.force);
    for (const Link<T>& link : links) look(link.length);
    for (const Contact<T>& contact : contacts) {
      look(contact.load);
      look(contact.velocity);
    }
    return next;
  }
};

/// State of a contact: slip of `one` over `other` backward or forward, or stick. A stop that pushes has that of stick, one
/// that is open that of backward, and an elastic one that is still pressed in but does not push that of forward.
enum class Slip : signed char { backward = -1, stick = 0, forward = 1 };

/// Positions and velocities of bodies, and the stretch of skin, at a time.
template <class T>
struct State {
  T time{0};                ///< s
  std::vector<T> position;  ///< m, body by body
  std::vector<T> velocity;  ///< m/s
  std::vector<T> stretch;   ///< m, contact by contact; 0 of a rigid one
  /// Errors of these numbers, since the time is known to rounding; none of given ones.
  struct Errors {
    std::vector<detail::Real<T>> position, velocity, stretch;
  } errors{};
};

}  // namespace pindrive::bodies
