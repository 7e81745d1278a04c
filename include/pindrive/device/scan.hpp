/// Scan: a hand moves a device over a page, and the motion of each pin is simulated exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/device/coil.hpp"
#include "pindrive/device/coil_course.hpp"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/electromagnet.hpp"
#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::device {

/// Device whose pins are alike.
struct Device {
  Drive<double> drive;
  double normal_force;  ///< normal force of the plate without a pull, N
  Electromagnet magnet;
  Controller controller;
  Axis axis;
  std::vector<Place> spots;  ///< offset of the spot of each pin from the hand, m

  /// Factor of the plate friction under a pull, N.
  double load(double pull) const { return 1 + pull / normal_force; }
};

/// State of a pin, its coil and its control block at the begin of a scan.
struct PinState {
  double position{0};                                        ///< m
  double velocity{0};                                        ///< m/s; NaN: carried by the plate
  double stretch{std::numeric_limits<double>::quiet_NaN()};  ///< skin stretch, m; NaN: not kept
  CoilState coil{};
  bool decision{false};         ///< last decision of the control block
  std::vector<double> pending;  ///< times of the switchings that are due, s
};

/// Input with rows over time; a constant where all rows have one value.
inline Profile<double> profile_of(const std::vector<double>& times,
                                  const std::vector<double>& values) {
  const auto differs = [&](double value) { return value != values[0]; };
  if (std::none_of(values.begin(), values.end(), differs)) return {values[0]};
  return {times.data(), values.data(), values.size()};
}

/// Velocity of the plate under the mouse, over the time since the begin of a path.
struct PlateVelocity {
  std::vector<double> times, along, across;
  bool oblique{false};

  PlateVelocity(const HandPath& path, const Axis& axis) {
    // Part of the speed to which the product with the direction of the axis is rounded.
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    double fastest = 0, most = 0;
    for (std::size_t i = 0; i < path.count; ++i) {
      const Vector v{path.vx[i], path.vy[i]};
      times.push_back(path.times[i] - path.begin());
      along.push_back(axis.along(v));
      across.push_back(axis.across(v));
      fastest = std::max(fastest, detail::hypot(v.x, v.y));
      most = std::max(most, std::abs(across.back()));
    }
    oblique = most > rounding * fastest;
  }
};

/// Inputs of a scan that all pins share. Owns no memory but that of its rows.
struct ScanInputs {
  const Device& device;
  Raster raster;
  HandPath path;
  PlateVelocity plate;
  Profile<double> finger_load;  ///< over the time since the begin of the path

  ScanInputs(const Device& with, const Raster& page, const HandPath& along,
             const Profile<double>& pressed)
      : device(with), raster(page), path(along), plate(path, device.axis), finger_load(pressed) {}

  /// Luminance under the spot of a pin.
  double luminance(std::size_t pin, double t) const {
    return raster.at(path.position(t) + device.spots[pin]);
  }
};

/// One pin of a scan: decisions of its control block, course of its coil, and its motion.
struct PinRun {
  std::vector<double> switchings;  ///< switchings of the command within the path, s
  bool commanded{false};           ///< before the first
  bool decision{false};            ///< last decision of the control block
  std::vector<double> pending;     ///< switchings that are due at the end of the path or later, s
  CoilCourse coil;
  std::vector<double> load_times, loads;  ///< rows of the factor of the plate friction
  std::vector<Segment<double>> segments;
  Outcome<double> outcome{};

  /// Samples the page and switches the coil, until its course has more than `most` pieces or rows.
  void energise(const ScanInputs& scan, std::size_t pin, const PinState& from, std::size_t most) {
    const Controller& controller = scan.device.controller;
    const double begin = scan.path.begin(), end = scan.path.end();
    std::vector<double> due = from.pending;
    decision = from.decision;
    controller.each_sample(begin, end, [&](double time) {
      const bool on = controller.decides(decision, scan.luminance(pin, time));
      if (on != decision) due.push_back(time + controller.latency);
      decision = on;
      return true;
    });
    const auto later = std::find_if(due.begin(), due.end(), [&](double t) { return !(t < end); });
    switchings.assign(due.begin(), later);
    pending.assign(later, due.end());
    commanded = from.coil.command;
    coil.follow(scan.device.magnet, from.coil, switchings.data(), switchings.size(), begin, end,
                most);
    load_times.clear();
    loads.clear();
    if (coil.idle()) {
      load_times.push_back(0);
      loads.push_back(scan.device.load(scan.device.magnet.given().residual));
      coil.end = from.coil;
      return;
    }
    for (std::size_t i = 0; i < coil.times.size(); ++i) {
      load_times.push_back(coil.times[i] - begin);
      loads.push_back(scan.device.load(coil.pulls[i]));
    }
  }

  /// Times with the command to be on, s.
  std::vector<Span> energised(const ScanInputs& scan) const {
    std::vector<Span> found;
    bool on = commanded;
    if (on) found.push_back({scan.path.begin(), scan.path.end()});
    for (const double time : switchings) {
      on = !on;
      if (on)
        found.push_back({time, scan.path.end()});
      else if (time > found.back().begin)
        found.back().end = time;
      else
        found.pop_back();
    }
    return found;
  }

  /// Inputs of the motion; refer to the rows of the scan and of the pin.
  Inputs<double> inputs(const ScanInputs& scan, const PinState& from) const {
    const PlateVelocity& plate = scan.plate;
    const double velocity = std::isnan(from.velocity) ? plate.along[0] : from.velocity;
    Inputs<double> found{profile_of(plate.times, plate.along), from.position, velocity,
                         plate.times.back()};
    found.plate_load = profile_of(load_times, loads);
    found.skin_stretch = held_stretch(scan, from.stretch);
    if (plate.oblique) found.across_velocity = profile_of(plate.times, plate.across);
    found.finger_load = scan.finger_load;
    return found;
  }

  /// Simulates the motion; go_on() is called after each segment.
  template <class GoOn>
  void simulate(const ScanInputs& scan, const PinState& from, GoOn&& go_on) {
    segments.clear();
    outcome = pindrive::simulate(scan.device.drive, inputs(scan, from),
                                 [&](const Segment<double>& segment) {
                                   segments.push_back(segment);
                                   return go_on();
                                 });
  }

 private:
  /// Stretch that the skin keeps as a load begins, m: beyond static friction it slips.
  static double held_stretch(const ScanInputs& scan, double stretch) {
    const Contact<double>& finger = scan.device.drive.finger;
    const double pressed = scan.finger_load.from(0).value;
    if (std::isnan(stretch) ||
        std::abs(stretch) <= finger.static_limit * pressed / finger.stiffness)
      return stretch;
    return std::copysign(finger.kinetic * pressed / finger.stiffness, stretch);
  }
};

}  // namespace pindrive::device
