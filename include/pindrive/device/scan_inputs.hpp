/// Inputs of a scan: device, page, hand and touch, and the state of each pin at the begin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "pindrive/device/coil.hpp"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/electromagnet.hpp"
#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/pressing.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/events/stepper_state.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::device {

/// Device whose pins are alike.
struct Device {
  Drive<double> drive;
  Pressing<double> pressing;
  double load_exponent;  ///< of the finger friction over the touch
  Electromagnet<double> magnet;
  Controller controller;
  Axis axis;
  std::vector<Place> spots;  ///< offset of the spot of each pin from the hand, m

  /// Factor of the plate friction under a pull (N) and a touch, over the usual one.
  double load(double pull, double touch = 1) const { return pressing.load(pull, touch); }
};

/// State of a pin, its coil and its control block at the begin of a scan.
struct PinState {
  double position{0};                                        ///< m
  double velocity{0};                                        ///< m/s; NaN: carried by the plate
  double stretch{std::numeric_limits<double>::quiet_NaN()};  ///< skin stretch, m; NaN: not kept
  CoilState<double> coil{};
  bool decision{false};         ///< last decision of the control block
  std::vector<double> pending;  ///< times of the switchings that are due, s
  /// Position, velocity, skin and contacts at the end of another scan; without, those of a release.
  std::optional<StepperState<double>> motion;
};

/// State of a pin with its spring at rest, switched off, at a time, s.
inline PinState at_rest(double time) {
  PinState state;
  state.coil.since = time;
  return state;
}

/// Velocity of the plate under the mouse along and across the axis, over the time since the begin of a path.
class PlateVelocity {
 public:
  /// Velocity at the rows; of a path with bends, pieces.
  struct Component {
    std::vector<double> rows;
    std::vector<InputPiece<double>> pieces;

    Component() = default;
    Component(const HandPath& path, const Speed& speed) : rows(speed.rows()) {
      if (!speed.bent()) return;
      for (std::size_t i = 0; i < path.stretches(); ++i) {
        const double lasts = path.times[i + 1] - path.times[i];
        InputPiece<double>& piece = pieces.emplace_back();
        piece.begin = path.times[i] - path.begin();
        double power = 1;
        for (std::size_t k = 0; k < 5; ++k, power *= lasts)
          piece.polynomial[k] = speed.coefficients(i)[k] / power;
      }
      InputPiece<double>& last = pieces.emplace_back();
      last.begin = path.end() - path.begin();
      last.polynomial[0] = rows.back();
    }
  };
  PlateVelocity() = default;
  PlateVelocity(const HandPath& path, const Axis& axis)
      : along_(path, Speed(path, [&](Vector v) { return axis.along(v); })),
        across_(path, Speed(path, [&](Vector v) { return axis.across(v); })) {
    for (std::size_t i = 0; i < path.count; ++i) times_.push_back(path.times[i] - path.begin());
  }
  /// Adds a row.
  void add(double time, Vector v, const Axis& axis) {
    times_.push_back(time);
    along_.rows.push_back(axis.along(v));
    across_.rows.push_back(axis.across(v));
  }
  /// Forgets the first rows.
  void forget(std::size_t count) {
    for (auto* column : {&times_, &along_.rows, &across_.rows})
      column->erase(column->begin(), column->begin() + static_cast<std::ptrdiff_t>(count));
  }

  double end() const { return times_.back(); }
  const std::vector<double>& times() const { return times_; }
  const Component& along_axis() const { return along_; }
  const Component& across_axis() const { return across_; }
  Profile<double> along() const { return profile(along_); }
  Profile<double> across() const { return profile(across_); }
  /// Velocities over the whole path, a constant where only one value occurs.
  Profile<double> whole_along() const { return whole(along_); }
  Profile<double> whole_across() const { return whole(across_); }
  bool oblique() const {
    return !across_.pieces.empty() ||
           std::any_of(across_.rows.begin(), across_.rows.end(), [](double w) { return w != 0; });
  }
  /// Input with a value at each row.
  Profile<double> profile(const std::vector<double>& values) const {
    return {times_.data(), values.data(), times_.size()};
  }

 private:
  Profile<double> profile(const Component& of) const {
    if (!of.pieces.empty()) return {of.pieces.data(), of.pieces.size()};
    return profile(of.rows);
  }
  Profile<double> whole(const Component& of) const {
    const auto differs = [&](double v) { return v != of.rows[0]; };
    const bool changes = std::any_of(of.rows.begin(), of.rows.end(), differs);
    return of.pieces.empty() && !changes ? Profile<double>(of.rows[0]) : profile(of);
  }

  std::vector<double> times_;
  Component along_, across_;
};

/// Inputs of a scan that all pins share. Owns no memory.
struct ScanInputs {
  const Device& device;
  Raster raster;
  HandPath path;
  const PlateVelocity& plate;
  Profile<double>
      finger_load;  ///< touch over the usual one to the power of its friction, over the time since the begin
  double begin;  ///< of the scan, s

  /// Luminance under the spot of a pin.
  double luminance(std::size_t pin, double t) const {
    return raster.at(path.position(t) + device.spots[pin]);
  }
  /// Touch over the usual one at a time, s since the begin.
  LineSince<double> touch(double time) const { return finger_load.given_line(time); }
  /// Time of the next row of the hand or the touch after a time, s since the begin.
  double next_row(double after) const {
    return std::min(plate.along().next_breakpoint(after), finger_load.next_breakpoint(after));
  }
  /// Stretch that the skin keeps as a load begins, m: beyond static friction, undamped skin slips.
  double held_stretch(double stretch) const {
    const Contact<double>& finger = device.drive.finger;
    const double pressed = finger_load.from(0).value;
    if (std::isnan(stretch) || finger.damped() ||
        std::abs(stretch) <= finger.static_limit * pressed / finger.stiffness)
      return stretch;
    return std::copysign(finger.kinetic * pressed / finger.stiffness, stretch);
  }
};

}  // namespace pindrive::device
