/// What goes into the core and what comes out of it. SI units throughout.
#pragma once

#include <limits>

#include "pindrive/flow.hpp"

namespace pindrive {

/// Every limit that is not physics, named once.
inline constexpr long long event_limit = 1'000'000;  ///< events after which a motion is given up
inline constexpr double settling_band = 0.05;        ///< default band, as a part of |x(0) − x_end|

/// Dry friction at one surface. Without friction (both 0) the contact is absent.
template <class T>
struct Contact {
  T kinetic{0};       ///< friction force while it slides, N; >= 0
  T static_limit{0};  ///< largest friction force while it sticks, N; >= kinetic

  bool present() const { return static_limit > 0; }
};

template <class T>
struct Drive {
  T mass;       ///< electromagnet and pin, kg; > 0
  T stiffness;  ///< spring, N/m; > 0
  T damping;    ///< damper, N s/m; >= 0
  Contact<T> plate, finger;
};

/// The release at t = 0 and what happens after it.
template <class T>
struct Inputs {
  T mouse_velocity;  ///< v_p: the plate's velocity in the housing's frame, m/s
  T displacement;    ///< x(0), m
  T velocity;        ///< x'(0), m/s
  T duration{std::numeric_limits<T>::infinity()};  ///< s; infinite: until the ending is known
};

/// What a contact does: the sign of its sliding velocity, stuck, or no contact.
enum class Slide : signed char { backward = -1, stuck = 0, forward = 1, absent = 2 };

inline int sign(Slide slide) { return slide == Slide::absent ? 0 : static_cast<int>(slide); }
inline Slide opposite(Slide slide) { return static_cast<Slide>(-sign(slide)); }

struct Mode {
  Slide plate, finger;

  bool stuck() const { return plate == Slide::stuck || finger == Slide::stuck; }
};

/// What ended a segment, and at which contacts.
enum class Kind : signed char { none, stick, slip, cross };

struct Event {
  Kind kind{Kind::none};
  bool plate{false}, finger{false};
};

/// One mode from begin to end (infinite for one that lasts for ever).
template <class T>
struct Segment {
  T begin, end;  ///< s
  Mode mode;
  Flow<T> flow;
  Event event;  ///< at the end
};

/// How a motion ends.
enum class End : signed char {
  moving,     ///< not known within the duration
  resting,    ///< at rest for ever
  decaying,   ///< free decay, no further event
  free,       ///< undamped oscillation, no further event
  grazing,    ///< the same, touching the plate's velocity once a period
  stick_slip  ///< a cycle of carried and sliding phases, repeated exactly
};

enum class Status : signed char { ok, too_many_events };

template <class T>
struct Outcome {
  Status status{Status::ok};
  End end{End::moving};
  T since{std::numeric_limits<T>::quiet_NaN()};   ///< when the ending began, s
  T period{std::numeric_limits<T>::quiet_NaN()};  ///< of a steady oscillation, s
  T until{0};        ///< end of the last segment, s; then a stick-slip cycle begins again …
  T cycle_begin{0};  ///< … from here, s
};

}  // namespace pindrive
