/// How a motion ends: in a mode that lasts for ever, or in a cycle, which an observer of the events
/// finds by keeping one state ever longer (Brent).
#pragma once

#include <algorithm>
#include <cmath>

#include "pindrive/friction.hpp"
#include "pindrive/limits.hpp"
#include "pindrive/model.hpp"

namespace pindrive::detail {

/// How a mode that lasts for ever ends the motion.
template <class T>
void end_with(const Segment<T>& last, Outcome<T>& outcome) {
  const Flow<T>& flow = last.flow;
  const T alpha = flow.oscillator.alpha();
  if (!flow.position.oscillates()) {
    if (flow.velocity.start == 0 && flow.velocity.straight()) outcome.end = End::resting;
  } else if (alpha < 0) {
    outcome.end = End::decaying;
  } else if (alpha == 0) {
    // Released without a relative acceleration it touches the plate's velocity once a period.
    const bool grazes = slips(last.mode.plate) && flow.velocity.slope == 0 &&
                        flow.velocity.start == last.plate_velocity.value;
    outcome.end = grazes ? End::grazing : End::free;
    outcome.steady_since = last.begin;
    outcome.period = flow.oscillator.period();
  }
}

/// Finds the state to which a motion between constant inputs comes back: it looks at releases from
/// the plate, and where the pin slides past a breakpoint of the plate's curve.
template <class T>
class Return {
 public:
  /// Whether an event is one that it looks at.
  static bool watches(const Mode& before, const Mode& after) {
    return released(before, after) || after.plate_branch > before.plate_branch;
  }
  /// Meets such an event between a segment and the mode that follows; if the state has been there before,
  /// says in the outcome what cycle it closes.
  void meet(const Drive<T>& drive, const Segment<T>& ended, const Mode& after,
            const State<T>& state, Outcome<T>& outcome) {
    const bool release = released(ended.mode, after);
    if (release) stick_begin_ = ended.begin;
    const Visit now{ended.end, stick_begin_, state, after, release};
    if (visits_ > 0 && same(drive, now)) {
      outcome.end = release || kept_.released ? End::stick_slip : End::limit_cycle;
      outcome.period = now.time - kept_.time;
      outcome.cycle_begin = outcome.steady_since = kept_.time;
      // It began where the first carried phase joined the one that it repeats.
      if (release && after.finger != ContactState::elastic_stick)
        outcome.steady_since = std::max(kept_.stick_begin, kept_.time - (now.time - stick_begin_));
    }
    kept_.released = kept_.released || release;
    if (visits_ == next_) {
      kept_ = now;
      next_ += next_ / 4 + 1;
    }
    ++visits_;
  }

 private:
  static bool released(const Mode& before, const Mode& after) {
    return before.plate == ContactState::stick && after.plate != ContactState::stick;
  }

  struct Visit {
    T time, stick_begin;  ///< when, and when the plate last took the pin along, s
    State<T> state;
    Mode mode;
    bool released;  ///< by the plate; kept: since then, too
  };

  bool same(const Drive<T>& drive, const Visit& now) const {
    using std::abs;
    using std::sqrt;
    const T close = T(return_tolerance) + T(return_tolerance_per_round) * T(visits_);
    const auto alike = [&](T one, T other, T scale) { return abs(one - other) <= close * scale; };
    const T omega0 = sqrt(drive.stiffness / drive.mass);
    const T size = abs(now.state.x) + abs(now.state.v) / omega0;
    return kept_.mode.plate == now.mode.plate && kept_.mode.stop == now.mode.stop &&
           kept_.mode.finger == now.mode.finger &&
           kept_.mode.plate_branch == now.mode.plate_branch &&
           alike(kept_.state.x, now.state.x, size) &&
           alike(kept_.state.v, now.state.v, size * omega0) &&
           alike(kept_.state.skin, now.state.skin, drive.finger.static_limit);
  }

  T stick_begin_{0};
  Visit kept_{};
  long long visits_{0}, next_{0};  ///< so far, and when the one that is kept is renewed
};

}  // namespace pindrive::detail
