/// When a plain release that comes to rest comes within the settling band to stay there.
#pragma once

#include "pindrive/kernel/plain_release.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// A stretch of motion between two events: a slide whose turning point is at its start (side 1) or at,
/// or beyond, its end (−1), or a stretch that the plate carries it (0).
template <class V>
struct Slide {
  V start{__builtin_nan("")};               ///< position; NaN is none
  V time{0.0};                              ///< of the turning point, or of the start
  V distance{1.0}, centre{0.0}, side{0.0};  ///< of the turning point from the centre
};

/// The half turns that end at rest.
template <class V>
struct LastTurns {
  V from{0.0}, begin{0.0}, count{0.0};  ///< distance from the middle, time of the first; how many
  V end{0.0};                           ///< the distance after them
};

template <class V>
class Settling {
 public:
  using Mask = MaskOf<V>;

  /// Of a release whose place of rest is known beforehand, or NaN.
  explicit Settling(const V& known_rest = V(__builtin_nan(""))) : rest_(known_rest) {}

  /// What must be known of the stretches before those that follow.
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

  /// Looks at the stretches remembered; those that come to rest do so at a position.
  void weigh(const ForwardRelease<V>& r, const Mask& resting, const V& position) {
    rest_ = select(rest_ == rest_, rest_, select(resting, position, rest_));
    for (int i = 0; i < count_; ++i) weigh(slides_[i], r);
    count_ = 0;
  }

  struct Settled {
    V time;
    Mask unsure;  ///< whether rounding could decide when
    Mask within;  ///< none of the stretches that were looked at begins outside the band
  };
  /// Of those that rest.
  Settled settled(const ForwardRelease<V>& r, const LastTurns<V>& last) const {
    const V zero(0.0), one(1.0), width = this->width(r);
    const V target = rest_ + with_sign(width, entry_.start - rest_);
    V time = entry_.time, side = entry_.side, turning = entry_.distance;
    V distance = target - entry_.centre;
    const Mask entered = entry_.start == entry_.start;
    // Of the half turns, what is an even number before the end is on its side.
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

  /// Whether the place of rest is known.
  Mask knows_rest() const { return rest_ == rest_; }

 private:
  static V width(const V& rest, const ForwardRelease<V>& r) {
    return r.band * absolute(r.start - rest);
  }
  V width(const ForwardRelease<V>& r) const { return width(rest_, r); }
  /// Whether an end so far off is on the edge of the band; at the start it is as far off as the width
  /// says, however little rounding leaves of it.
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
  Slide<V> entry_;  ///< the last stretch that begins outside the band
  V entry_unsure_{0.0};
  static constexpr int most_slides = 5;  ///< of a round of the kernel
  Slide<V> slides_[most_slides];
  int count_{0};
};

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
