/// Control block: samples of the luminance at its own rate, threshold with hysteresis, latency.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace pindrive::device {

/// Control block that switches the coil of one pin.
struct Controller {
  double sample_rate;            ///< Hz; > 0
  double latency;                ///< from a sample to the switching, s
  double threshold, hysteresis;  ///< luminance; below the band on, above it off

  /// Decision after a sample, from the one before.
  bool decides(bool on, double luminance) const {
    if (luminance < threshold - 0.5 * hysteresis) return true;
    return on && !(luminance > threshold + 0.5 * hysteresis);
  }

  /// Decides after a sample at a time, s; adds the switching that follows to those that are due.
  void sample(double time, double luminance, bool& decision, std::vector<double>& due) const {
    const bool on = decides(decision, luminance);
    if (on != decision) due.push_back(time + latency);
    decision = on;
  }
  /// First sample at a time or later, s.
  double sample_from(double time) const {
    double k = std::ceil(time * sample_rate) - 1;
    while (k / sample_rate < time) ++k;
    return k / sample_rate;
  }
  /// Sample after a sample, s.
  double sample_after(double sample) const {
    return (std::round(sample * sample_rate) + 1) / sample_rate;
  }

  /// Calls visit(time) for each sample in [begin, end), s, at multiples of the sampling interval, until
  /// visit returns false.
  template <class Visitor>
  void each_sample(double begin, double end, Visitor&& visit) const {
    const double last = std::ceil(end * sample_rate) + 1;
    for (double k = std::ceil(begin * sample_rate) - 1; k < last; ++k) {
      const double time = k / sample_rate;
      if (begin <= time && time < end && !visit(time)) return;
    }
  }
};

}  // namespace pindrive::device
