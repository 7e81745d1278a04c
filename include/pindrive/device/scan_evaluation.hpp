/// Evaluation of all pins of a scan, its counts, and the spread of its numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/pin_evaluation.hpp"
#include "pindrive/device/scan.hpp"

namespace pindrive::device {

/// Numbers of lines.
struct LineCounts {
  std::size_t crossed{0};
  std::size_t shown{0}, unseen{0}, merged{0}, faint{0};  ///< by outcome
  std::size_t false_lines{0};
  std::size_t unsettled{0};           ///< shown, without a settling time
  std::size_t direction{0}, sure{0};  ///< shown, with at least this cue at the begin
};

/// Number of a line that a study summarises.
enum class LineNumber : signed char {
  latency_on,
  latency_off,
  lag_on,
  lag_off,
  stroke,
  skin_on,
  skin_off,
  smear_time,
  smear,
  overshoot,
  contrast
};
/// Names of these numbers, in their order.
inline constexpr const char* line_number_names[] = {
    "latency_on", "latency_off", "lag_on", "lag_off",   "stroke",  "skin_on",
    "skin_off",   "smear_time",  "smear",  "overshoot", "contrast"};

/// Least, median and largest of a number; NaN where no line has it.
struct Spread {
  double least, median, largest;
};

/// Lines and false lines under all pins of a scan.
struct Evaluation {
  std::vector<EvaluatedLine> lines;
  std::vector<FalseLine> false_lines;
  /// Of each pin, the times of its lowest position before each motion by its magnet, s since the begin.
  std::vector<std::vector<double>> dips;

  static double number(const EvaluatedLine& line, LineNumber name) {
    switch (name) {
      case LineNumber::latency_on:
        return line.begin.response - line.begin.time;
      case LineNumber::latency_off:
        return line.end.response - line.end.time;
      case LineNumber::lag_on:
        return line.begin.lag;
      case LineNumber::lag_off:
        return line.end.lag;
      case LineNumber::stroke:
        return line.stroke;
      case LineNumber::skin_on:
        return line.begin.skin;
      case LineNumber::skin_off:
        return line.end.skin;
      case LineNumber::smear_time:
        return line.settled - line.release;
      case LineNumber::smear:
        return line.smear;
      case LineNumber::overshoot:
        return line.overshoot;
      case LineNumber::contrast:
        return line.contrast;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  LineCounts counts() const {
    LineCounts found;
    found.crossed = lines.size();
    found.false_lines = false_lines.size();
    for (const EvaluatedLine& line : lines) {
      switch (line.outcome) {
        case LineOutcome::shown:
          ++found.shown;
          break;
        case LineOutcome::unseen:
          ++found.unseen;
          break;
        case LineOutcome::merged:
          ++found.merged;
          break;
        case LineOutcome::faint:
          ++found.faint;
          break;
      }
      if (line.outcome != LineOutcome::shown) continue;
      if (std::isnan(line.settled)) ++found.unsettled;
      if (line.begin.cue >= Cue::direction) ++found.direction;
      if (line.begin.cue >= Cue::sure) ++found.sure;
    }
    return found;
  }

  /// Spread of a number over the lines that were shown.
  Spread spread(LineNumber name) const {
    std::vector<double> known;
    for (const EvaluatedLine& line : lines)
      if (const double value = number(line, name);
          line.outcome == LineOutcome::shown && !std::isnan(value))
        known.push_back(value);
    if (known.empty()) {
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      return {nan, nan, nan};
    }
    std::sort(known.begin(), known.end());
    const std::size_t half = known.size() / 2;
    const double median = known.size() % 2 ? known[half] : 0.5 * (known[half - 1] + known[half]);
    return {known.front(), median, known.back()};
  }
};

/// Evaluation of scans that have their inputs in common. Refers to the inputs.
class ScanEvaluation {
 public:
  ScanEvaluation(const ScanInputs& scan, const Criteria& criteria)
      : scan_(&scan),
        way_(scan.path),
        turnings_(device::turnings(scan.path, scan.device.axis)),
        setting_{scan.path,
                 scan.device.axis,
                 &way_,
                 &turnings_,
                 scan.device.controller.latency,
                 scan.device.pressing,
                 scan.device.magnet.given().residual,
                 criteria} {}
  ScanEvaluation(const ScanEvaluation&) = delete;
  ScanEvaluation& operator=(const ScanEvaluation&) = delete;

  /// Adds the lines printed along the path of one pin.
  void add(std::size_t pin, const PinRun& run, const Motion<double>& motion,
           std::vector<PrintedLine> printed, Evaluation& found) const {
    const ScannedPin scanned{static_cast<int>(pin), scan_->device.spots[pin], &motion,
                             run.energised(*scan_), std::move(printed)};
    const PinEvaluation evaluation(setting_, scanned);
    evaluation.add_lines(found.lines);
    evaluation.add_false_lines(found.false_lines);
    std::vector<double>& dips = found.dips.emplace_back();
    for (const auto& pull : evaluation.pulls()) dips.push_back(pull.dip);
  }

 private:
  const ScanInputs* scan_;
  Way way_;
  std::vector<double> turnings_;
  ScanSetting setting_;
};

}  // namespace pindrive::device
