/// Settling time of a standard release that comes to rest.
#pragma once

#include "pindrive/kernel/plain_release.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// Stretch of motion between two events: a slide with its turning point at the start (side 1) or at
/// or beyond its end (side −1), or stick on the plate (0).
template <class V>
struct Slide {
  V start{__builtin_nan("")};  ///< initial position, m; NaN: no stretch
  V time{0.0};                 ///< time of the turning point, or of the start, s
  V distance{1.0}, centre{0.0},
      side{0.0};  ///< distance of the turning point from the centre, m; centre, m; side
};

/// Half periods before rest.
template <class V>
struct LastTurns {
  V from{0.0}, begin{0.0}, count{0.0};  ///< distance from the middle; time of the first; number
  V end{0.0};                           ///< distance after the last
};

template <class V>
class KernelSettling {
 public:
  using Mask = MaskOf<V>;

  /// Starts with a known place of rest, or NaN.
  explicit KernelSettling(const V& known_rest = V(__builtin_nan(""))) : rest_(known_rest) {}

  /// Calls f with all members that later stretches need.
  template <class F>
  void columns(const F& f) {
    f(rest_), f(entry_.start), f(entry_.time), f(entry_.distance), f(entry_.centre), f(entry_.side);
    f(entry_unsure_);
  }
  static constexpr int column_count = 7;

  void remember(const Mask& which, const V& start, const V& time, const V& distance,
                const V& centre, const V& side) {
    slides_[count_++] = {select(which, start, V(__builtin_nan(""))), time, distance, centre, side};
  }

  /// Evaluates the stored stretches for releases that come to rest at a position.
  void weigh(const ForwardRelease<V>& r, const Mask& resting, const V& position) {
    rest_ = select(rest_ == rest_, rest_, select(resting, position, rest_));
    for (int i = 0; i < count_; ++i) weigh(slides_[i], r);
    count_ = 0;
  }

  struct Settled {
    V time;
    Mask unsure;  ///< mask: rounding could decide the time
    Mask within;  ///< mask: no evaluated stretch begins outside the band
  };
  /// Settling times of releases that rest.
  Settled settled(const ForwardRelease<V>& r, const LastTurns<V>& last) const {
    const V zero(0.0), one(1.0), width = this->width(r);
    const V target = rest_ + with_sign(width, entry_.start - rest_);
    V time = entry_.time, side = entry_.side, turning = entry_.distance;
    V distance = target - entry_.centre;
    const Mask entered = entry_.start == entry_.start;
    // Half turns at an even distance from the end are on its side.
    const V friction = r.ff * r.flexibility, loss = friction * (one + r.swing.shrink);
    V w = absolute(last.from), end = last.end * one_or_minus_one(last.count), n = zero;
    V from = zero, far = w, near = end;
    Mask found(false), unsure = !(entry_unsure_ == zero);
    for (Mask more = zero < last.count; any(more); more = more & (n < last.count)) {
      const V off = w - end;
      const Mask away = more & (width < off);
      unsure = (unsure & !away) | (more & on_edge(off, width, n + last.begin == zero, r));
      found = found | away;
      from = select(away, n, from);
      far = select(away, w, far);
      near = select(away, end, near);
      w = r.swing.shrink * w - loss;
      end = zero - end;
      n = n + one;
    }
    time = select(found, last.begin + from * r.swing.half, time);
    turning = select(found, far - friction, turning);
    distance = select(found, near + (width - friction), distance);
    side = select(found, one, side);
    // Past the middle of a half turn its end is the nearer turning point; near e^(−πρ/2), that is.
    const V linear = larger(one - V(0x1.921fb54442d18p-2) * r.swing.rho, zero);
    const V fourth = (linear * linear) * (linear * linear);
    const Mask past = found & (distance < r.swing.rho * fourth * turning);
    time = select(past, time + r.swing.half, time);
    turning = select(past, zero - r.swing.shrink * turning, turning);
    side = select(past, V(-1.0), side);
    const Mask enters = found | entered, turned = enters & !(side == zero);
    const V part = distance / select(turning == zero, one, turning);
    const V angle = past_turn(select(turned, part, one), side * r.swing.rho).angle;
    V settled = select(turned, time + side * angle * r.swing.per_omega, zero);
    settled = select(enters & !turned, time + (target - entry_.start) / r.vp, settled);
    return {settled, unsure, !enters};
  }

  /// Mask of releases with a known place of rest.
  Mask knows_rest() const { return rest_ == rest_; }

 private:
  static V width(const V& rest, const ForwardRelease<V>& r) {
    return r.band * absolute(r.start - rest);
  }
  V width(const ForwardRelease<V>& r) const { return width(rest_, r); }
  /// Mask of ends on the edge of the band; the start has exactly the distance that defines the
  /// width.
  static Mask on_edge(const V& off, const V& width, const Mask& at_start,
                      const ForwardRelease<V>& r) {
    return !((r.slack() < absolute(off - width)) | (at_start & (r.slack() < off)));
  }
  void weigh(const Slide<V>& slide, const ForwardRelease<V>& r) {
    const V off = absolute(slide.start - rest_), width = this->width(r);
    const Mask here = off == off, away = here & (width < off);
    const Mask edge = here & on_edge(off, width, slide.start == r.start, r);
    entry_unsure_ = select(edge, V(1.0), select(away, V(0.0), entry_unsure_));
    entry_.start = select(away, slide.start, entry_.start);
    entry_.time = select(away, slide.time, entry_.time);
    entry_.distance = select(away, slide.distance, entry_.distance);
    entry_.centre = select(away, slide.centre, entry_.centre);
    entry_.side = select(away, slide.side, entry_.side);
  }

  V rest_;
  Slide<V> entry_;  ///< last stretch that begins outside the band
  V entry_unsure_{0.0};
  static constexpr int most_slides = 5;  ///< slides in a round of the kernel
  Slide<V> slides_[most_slides];
  int count_{0};
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
