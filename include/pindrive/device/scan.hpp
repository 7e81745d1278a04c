/// Scan: a hand moves a device over a page, and the motion of each pin is simulated exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/device/coil_course.hpp"
#include "pindrive/device/controller.hpp"
#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/pin_follower.hpp"
#include "pindrive/device/scan_inputs.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/motion/motion.hpp"

namespace pindrive::device {

/// One pin of a scan: decisions of its control block, course of its coil, and its motion.
struct PinRun {
  std::vector<double> switchings;  ///< switchings of the command within the path, s
  bool commanded{false};           ///< before the first
  bool decision{false};            ///< last decision of the control block
  std::vector<double> pending;     ///< switchings that are due at the end of the path or later, s
  CoilCourse<double> coil;
  std::vector<OwnedPiece<double>> owned;  ///< pieces of the load
  std::vector<InputPiece<double>> loads;  ///< factor of the plate friction, by these pieces
  std::vector<Segment<double>> segments;
  Outcome<double> outcome{};
  StepperState<double> ended{};  ///< for a scan that begins at the end

  /// Samples the page and switches the coil, until its course has more than `most` pieces.
  void energise(const ScanInputs& scan, std::size_t pin, const PinState& from, std::size_t most) {
    const Controller& controller = scan.device.controller;
    const double begin = scan.path.begin(), end = scan.path.end();
    std::vector<double> due = from.pending;
    decision = from.decision;
    controller.each_sample(begin, end, [&](double time) {
      controller.sample(time, scan.luminance(pin, time), decision, due);
      return true;
    });
    const auto later = std::find_if(due.begin(), due.end(), [&](double t) { return !(t < end); });
    switchings.assign(due.begin(), later);
    pending.assign(later, due.end());
    commanded = from.coil.command;
    coil.follow(scan.device.magnet, from.coil, switchings.data(), switchings.size(), begin, end,
                most);
    if (coil.idle()) coil.end = from.coil;
    owned = loads_under(coil.pulls, scan.device.pressing, begin, scan.finger_load);
    loads.clear();
    for (const OwnedPiece<double>& load : owned) loads.push_back(load.piece);
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
    const Profile<double> along = plate.whole_along();
    const double velocity = std::isnan(from.velocity) ? along.from(0).value : from.velocity;
    Inputs<double> found{along, from.position, velocity, plate.end()};
    if (loads.size() == 1 && loads[0].straight() && loads[0].polynomial[1] == 0)
      found.plate_load = {loads[0].polynomial[0]};
    else
      found.plate_load = {loads.data(), loads.size()};
    found.skin_stretch = scan.held_stretch(from.stretch);
    found.across_velocity = plate.whole_across();
    found.finger_load = scan.finger_load;
    return found;
  }

  /// Motion that was simulated; refers to the rows and segments of the pin.
  Motion<double> motion(const ScanInputs& scan, const PinState& from) const {
    return {scan.device.drive, inputs(scan, from), segments.data(), segments.size(), outcome};
  }

  /// Simulates the motion; go_on() is called after each event and row.
  void simulate(const ScanInputs& scan, PinState from, GoOn go_on) {
    segments.clear();
    from.pending = switchings;
    PinFollower follower(scan, from);
    const auto sink = [&](const Segment<double>& segment, const auto&) {
      segments.push_back(segment);
    };
    const bool whole = follower.advance(scan, scan.path.end(), go_on, sink);
    segments.push_back(follower.stepper().segment_until_now());
    ended = follower.hand_over(scan);
    outcome = {follower.stepper().status()};
    outcome.until = segments.back().end;
    if (!whole && outcome.status == Status::ok) outcome.status = Status::stopped;
  }
};

}  // namespace pindrive::device
