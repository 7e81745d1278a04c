/// Guards of a segment for the certificate: speeds against the ends of a branch, stick forces
/// against their limits, distance to a stop or its push.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <utility>

#include "pindrive/certificate/certificate.hpp"
#include "pindrive/certificate/evaluated_segment.hpp"
#include "pindrive/flow/positivity.hpp"

namespace pindrive::detail {

template <class T>
PositivityBound<T> positive(const ClosedForm<T>& along, const Path<T>& path) {
  return {along.oscillator(), path};
}
template <class Trajectory, class Quantity>
Quantity positive(const Trajectory&, const Quantity& path) {
  return path;
}

template <class T, class Trajectory>
class SegmentGuards {
  using Evaluated = EvaluatedSegment<T, Trajectory>;
  using Quantity = typename Evaluated::Quantity;

 public:
  static constexpr int capacity = 6;

  /// Guard, and the law that is violated where the guard is negative.
  struct Watch {
    decltype(positive(std::declval<Trajectory>(), std::declval<Quantity>())) guard;
    T Certificate<T>::* law;
    T scale;
    T error{0};  ///< error from the time resolution
  };

  explicit SegmentGuards(const Evaluated& segment) : evaluated_(segment), along_(segment.along) {
    const Drive<T>& drive = segment.drive;
    const Mode& mode = segment.mode();
    const T of_plate = std::max(segment.scales.v, segment.scales.across);
    if (!segment.oblique())
      slipping(drive.plate, mode.plate, mode.plate_branch,
               along_.velocity() + T(-1) * along_.input(segment.plate_velocity), of_plate);
    else if constexpr (std::is_same_v<Trajectory, BySeries<T>>)
      within(drive.plate.branch(mode.plate_branch), along_.sliding_speed(), false, of_plate);
    // A slider is slower than the pin by what its skin stretches.
    const int others = count_;
    if (drive.finger.compliant()) {
      slipping(drive.finger, mode.finger, mode.finger_branch,
               along_.velocity() + 1 / drive.finger.stiffness * segment.stretch_force_rate,
               segment.scales.v);
      known_from(others, segment.slider_unsure);
    } else {
      slipping(drive.finger, mode.finger, mode.finger_branch, along_.velocity(), segment.scales.v);
      if (count_ > others) known_from(others, segment.velocity_unsure());
    }
    beyond_stops(drive.stops, mode.stop);
    if (held_by_stop(drive, mode)) return;
    const Quantity at_plate = drive.plate.static_limit * along_.input(segment.load);
    const Quantity at_finger = drive.finger.static_limit * along_.input(segment.finger_load);
    if (mode.both_stuck()) {
      sticking(along_.plate_force(), at_plate + at_finger);
    } else {
      if (mode.plate == ContactState::stick) sticking(along_.plate_force(), at_plate);
      if (mode.finger == ContactState::stick || mode.finger == ContactState::elastic_stick)
        sticking(along_.finger_force(), at_finger);
    }
  }

  int size() const { return count_; }
  const Watch& operator[](int i) const { return watches_[i]; }
  const Watch* begin() const { return watches_.data(); }
  const Watch* end() const { return watches_.data() + count_; }

 private:
  static constexpr T never = std::numeric_limits<T>::infinity();

  /// Sets the error of the last guards.
  void known_from(int first, T error) {
    for (int i = first; i < count_; ++i) watches_[i].error = error;
  }
  template <class Path>
  void watch(const Path& path, T Certificate<T>::* law, T scale) {
    watches_[count_++] = {positive(along_, path), law, scale, T(0)};
  }

  /// Adds the distance of a speed from the ends of its branch; at the begin of the first branch, a
  /// speed without a direction is excluded.
  template <class Path>
  void within(const Branch<T>& branch, const Path& speed, bool directed, T scale) {
    if (directed || branch.from > 0)
      watch(along_.above(speed, branch.from), &Certificate<T>::sliding_sign, scale);
    if (branch.to < never)
      watch(along_.above(T(-1) * speed, -branch.to), &Certificate<T>::sliding_sign, scale);
  }
  template <class Path>
  void slipping(const Contact<T>& contact, ContactState does, int branch, const Path& sliding,
                T scale) {
    if (!is_slip(does)) return;
    const int last = std::max(contact.branches - 1, 0);
    within(contact.branch(std::clamp(branch, 0, last)), T(sign(does)) * sliding, true, scale);
  }
  void sticking(const Quantity& force, const Quantity& most) {
    const T scale = evaluated_.scales.force;
    watch(most + force, &Certificate<T>::force_bound, scale);
    watch(most + T(-1) * force, &Certificate<T>::force_bound, scale);
  }
  /// Adds the distance to the end stops or, for an elastic stop, its depth and its push.
  void beyond_stops(const Stops<T>& stops, StopState does) {
    if (!stops.present()) return;
    const auto beyond = [&](int end, int sense) {
      watch(along_.above(T(sense * end) * along_.position(), sense * stops.travel),
            &Certificate<T>::sliding_sign, evaluated_.scales.x);
    };
    if (does == StopState::apart || stops.rigid()) {
      beyond(1, -1);
      beyond(-1, -1);
      return;
    }
    const int end = stop_sign(does), sense = in_contact(does) ? 1 : -1;
    beyond(end, 1);
    auto push = T(sense * end) * stops.damping * along_.velocity();
    push = T(sense * end) * stops.stiffness * along_.position() + push;
    watch(along_.above(push, sense * stops.stiffness * stops.travel), &Certificate<T>::force_bound,
          evaluated_.scales.stop);
  }

  const Evaluated& evaluated_;
  const Trajectory& along_;
  std::array<Watch, capacity> watches_{};
  int count_{0};
};

}  // namespace pindrive::detail
