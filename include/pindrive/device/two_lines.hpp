/// Trial of two lines under an even hand: return of the pin between them, and motion of the skin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "pindrive/device/controller.hpp"
#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/printed_lines.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/device/scan.hpp"
#include "pindrive/device/scan_evaluation.hpp"
#include "pindrive/device/scan_inputs.hpp"

namespace pindrive::device {

/// Two lines at one speed: the worst of all phases of the control block's samples.
struct LineTrial {
  double speed;               ///< m/s
  double back;                ///< return of the pin between the lines, over its distance from rest
  double skin;                ///< motion of the skin by the fainter line, m
  bool shown;                 ///< both lines are felt, and do not merge
  std::vector<double> until;  ///< of each phase, the time at which the second line moves the pin, s
  std::vector<double> ahead;  ///< phases: distances by which a spot is ahead, m
  Status status{Status::ok};  ///< reason for an incomplete trial

  /// True if both lines are felt, each with a motion of the skin, m.
  bool distinct(double direction) const { return shown && skin >= direction; }
};

/// Friction along the axis of a plate that moves to the right under a pin with its magnet off, N.
inline double dragging_friction(const Device& device) {
  const double residual = device.load(device.magnet.given().residual);
  return device.drive.plate.kinetic * residual * std::abs(device.axis.along({1, 0}));
}

/// State of a pin under a hand in long uniform motion: dragged, and at rest.
inline PinState steady_state(const Device& device) {
  const Drive<double>& drive = device.drive;
  const double along = device.axis.along({1, 0}), plate = dragging_friction(device);
  PinState state = at_rest(0);
  state.position = std::copysign(drag_of_plate(drive, plate, 1), along);
  if (std::isfinite(drive.finger.stiffness)) {
    const double held = plate <= drive.finger.static_limit ? plate : drive.finger.kinetic;
    state.stretch = std::copysign(held / drive.finger.stiffness, along);
  }
  return state;
}

/// Two lines at right angles to an even hand, of which one pin is evaluated. Phases of the samples with
/// the same numbers of samples on the lines and between them shift the whole motion in time, so that one phase
/// between each two of the four edges stands for all of them.
class TwoLines {
 public:
  TwoLines(const Device& device, double pitch, double width, const Criteria& criteria)
      : device_(device),
        pitch_(pitch),
        width_(width),
        criteria_(criteria),
        pixel_(std::min(width, pitch - width) / fine),
        frequency_(std::sqrt(device.drive.stiffness / device.drive.mass)) {}

  /// Trial at a speed, m/s; go_on() is called after each event and row.
  LineTrial at(double speed, GoOn go_on) {
    LineTrial trial{speed, infinity, infinity, true, {}, phases(speed)};
    const Found found = pass(2, speed, clear() + 4 * pi / frequency_, trial.ahead, go_on);
    trial.status = found.status;
    if (trial.status != Status::ok) return trial;
    const std::vector<EvaluatedLine>& lines = found.evaluation.lines;
    for (std::size_t i = 0; i < trial.ahead.size(); ++i) {
      const EvaluatedLine &first = lines[2 * i], &second = lines[2 * i + 1];
      trial.back = std::min(trial.back, part_back(first));
      trial.shown = trial.shown && first.outcome == LineOutcome::shown &&
                    second.outcome == LineOutcome::shown;
      for (const EvaluatedLine* const line : {&first, &second})
        trial.skin =
            std::min(trial.skin, zero_for_nan(std::fmax(line->begin.skin, line->end.skin)));
      const std::vector<double>& dips = found.evaluation.dips[i];
      trial.until.push_back(dips.size() > 1 ? dips[1] : 0);
    }
    return trial;
  }

  /// Transient after the first line alone.
  struct Settling {
    bool in_time;   ///< over before the second line of a trial moves the pin
    Status status;  ///< reason for an incomplete simulation
  };

  /// Goes over the first line alone, as in a trial of both.
  Settling settling(const LineTrial& trial, GoOn go_on) {
    const Found alone = pass(1, trial.speed, clear() + followed(), trial.ahead, go_on);
    bool in_time = alone.status == Status::ok;
    for (std::size_t i = 0; in_time && i < trial.until.size(); ++i)
      in_time = alone.evaluation.lines[i].settled <= trial.until[i];
    return {in_time, alone.status};
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr double pi = 0x1.921fb54442d18p+1;
  static constexpr double fine = 40;      // pixels in the thinner of line and gap
  static constexpr double moment = 2e-3;  // from the begin to the first line, s, and a sample more
  static constexpr double longest = 200;  // longest transient, in radians of the natural frequency

  static double zero_for_nan(double value) { return std::isnan(value) ? 0 : value; }

  double interval() const { return 1 / device_.controller.sample_rate; }
  /// Position of the hand at the begin of the trial, m; the first line begins at 0.
  double begin(double speed) const { return -speed * (moment + interval()); }
  /// Time from the end of a line until the pull of its magnet has decayed, s.
  double clear() const {
    return device_.controller.latency + 8 * device_.magnet.given().fall_constant;
  }
  /// Time in which a transient settles, s.
  double followed() const {
    return 8 / std::max(slowest_rate(device_.drive), 8 / longest * frequency_);
  }

  /// Return of the pin after a line, over its distance from the rest position.
  double part_back(const EvaluatedLine& line) const {
    const double rest = drag_of_plate(device_.drive, dragging_friction(device_), 1);
    const double high = line.height - rest;
    return high > 0 ? zero_for_nan(line.returned / high) : 0;
  }

  /// Draws the first lines between two places, m; a border between pixels is as dark as it covers.
  Raster draw(int lines, double left, double right) {
    const auto covered = [&](double border) {
      double sum = 0;
      for (int i = 0; i < lines; ++i) sum += std::clamp(border, i * pitch_, i * pitch_ + width_);
      return sum;
    };
    const double first = std::floor(left / pixel_), last = std::ceil(right / pixel_);
    row_.clear();
    for (double i = first; i < last; ++i) {
      const double dark = (covered(pixel_ * (i + 1)) - covered(pixel_ * i)) / pixel_;
      row_.push_back(1 - std::clamp(dark, 0.0, 1.0));
    }
    return {row_.data(), 1, static_cast<std::int64_t>(row_.size()), pixel_, {first * pixel_, 0}};
  }

  /// One phase for each sequence of samples: distances by which a spot is ahead, m.
  std::vector<double> phases(double speed) {
    const double step = speed * interval(), beside = 4 * pixel_;
    const Controller& control = device_.controller;
    const Raster page = draw(2, -beside, pitch_ + width_ + beside);
    std::vector<double> met;
    const auto add_passes = [&](double sign, double level) {
      const auto value = [&](std::int64_t i) { return sign * page.luminance[i] - level; };
      for (std::int64_t i = 0; i + 1 < page.columns; ++i) {
        const double low = value(i), high = value(i + 1);
        const bool passes = low <= 0 && high > 0;
        if (!passes) continue;
        const double middle = page.corner.x + pixel_ * (static_cast<double>(i) + 0.5);
        met.push_back(remainder(middle - low / (high - low) * pixel_ - begin(speed), step));
      }
    };
    add_passes(-1, 0.5 * control.hysteresis - control.threshold);
    add_passes(1, control.threshold + 0.5 * control.hysteresis);
    if (met.empty()) return {0};
    std::sort(met.begin(), met.end());
    // Edges that one sample meets together count once.
    const auto together = [&](double one, double next) { return next - one <= 1e-9 * step; };
    met.erase(std::unique(met.begin(), met.end(), together), met.end());
    std::vector<double> found;
    for (std::size_t i = 0; i < met.size(); ++i) {
      const double next = i + 1 < met.size() ? met[i + 1] : met[0] + step;
      found.push_back(remainder(0.5 * (met[i] + next), step));
    }
    return found;
  }
  static double remainder(double value, double step) {
    return value - step * std::floor(value / step);
  }

  struct Found {
    Evaluation evaluation;
    Status status;
  };

  /// Goes evenly over the first lines, once for each phase, and for some time more, s.
  Found pass(int lines, double speed, double after, const std::vector<double>& ahead, GoOn go_on) {
    const double from = begin(speed), to = (lines - 1) * pitch_ + width_ + speed * after;
    const double lasts = (to - from) / speed;
    const Raster page = draw(lines, from - pixel_, to + speed * interval() + pixel_);
    const double times[] = {0, lasts}, vx[] = {speed, speed}, vy[] = {0, 0};
    const double x[] = {from, from + speed * lasts}, y[] = {0.5 * pixel_, 0.5 * pixel_};
    const HandPath path{times, vx, vy, x, y, 2};
    device_.spots.clear();
    for (const double distance : ahead) device_.spots.push_back({distance, 0});
    const PlateVelocity velocity(path, device_.axis);
    const ScanInputs inputs{device_, page, path, velocity, {1.0}, 0};
    const ScanEvaluation evaluation(inputs, criteria_);
    const PinState steady = steady_state(device_);
    Found found{{}, Status::ok};
    for (std::size_t i = 0; i < ahead.size(); ++i) {
      run_.energise(inputs, i, steady, std::numeric_limits<std::size_t>::max());
      run_.simulate(inputs, steady, go_on);
      found.status = run_.outcome.status;
      if (found.status != Status::ok) return found;
      std::vector<PrintedLine> printed;
      for (int k = 0; k < lines; ++k) {
        const double time = (k * pitch_ - from - ahead[i]) / speed;
        printed.push_back({time, time + width_ / speed, true});
      }
      evaluation.add(i, run_, run_.motion(inputs, steady), std::move(printed), found.evaluation);
    }
    return found;
  }

  Device device_;
  double pitch_, width_;
  Criteria criteria_;
  double pixel_, frequency_;  ///< m, rad/s
  std::vector<double> row_;   ///< luminance of the page
  PinRun run_;
};

}  // namespace pindrive::device
