/// Results of an evaluation, what the finger feels, and the inputs: the lines that pins showed against the
/// lines that are printed.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/pressing.hpp"
#include "pindrive/device/printed_lines.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/motion/motion.hpp"

namespace pindrive::device {

/// Criteria of a felt line.
struct Criteria {
  double felt;             ///< smallest motion that is felt as a pulse, m
  double direction;        ///< smallest skin motion with a perceived direction, m
  double direction_sure;   ///< smallest skin motion whose direction is recognised, m
  double direction_speed;  ///< least mean speed of that motion, m/s
  double false_line;       ///< least height of a false line over that of the line before
  double distinct;  ///< least return between two lines, over the distance to the rest position
};

/// Outcome of a printed line.
enum class LineOutcome : signed char { shown, unseen, merged, faint };
/// Perceived motion of the skin: none, a pulse, its direction, its direction with certainty.
enum class Cue : signed char { none, felt, direction, sure };

/// Interval of time, s.
struct Span {
  double begin, end;
};

/// One end of a printed line, with its response; NaN where there is none.
struct EvaluatedEdge {
  double time;      ///< time of passage under the spot, s
  Place spot;       ///< m
  double command;   ///< time of the switching of the magnet, s
  double response;  ///< time of the response of the pin, s
  double lag;       ///< path length of the hand from `time` to `response`, m
  double skin;      ///< motion of the skin, m
  Cue cue;
};

/// Printed line as one pin showed it; NaN where a number does not exist.
struct EvaluatedLine {
  int pin;
  LineOutcome outcome;
  EvaluatedEdge begin, end;
  double stroke;    ///< displacement of the pin, m
  double height;    ///< largest deflection, m
  double returned;  ///< return of the pin before the next line or the stop of the hand, m
  double release;   ///< time of the break-away from the plate, s
  double settled;   ///< time from which the pin is settled, s
  double smear;     ///< path length of the hand from `release` to `settled`, m
  double overshoot, contrast;
};

/// Swing of a pin that feels like a line.
struct FalseLine {
  int pin;
  double time;    ///< time of the peak, s
  Place spot;     ///< its place at the peak, m
  double height;  ///< height of the swing, m
};

/// One pin of a scan, with what all pins share. Times are those of the path of the hand.
struct ScannedPin {
  int number;
  Place spot;                      ///< offset of its spot from the hand, m
  const Motion<double>* motion;    ///< over the time since the begin of the path
  std::vector<Span> energised;     ///< times with the magnet switched on
  std::vector<PrintedLine> lines;  ///< printed along the path of the pin
};

/// Inputs of an evaluation that all pins share.
struct ScanSetting {
  HandPath path;
  Axis axis;
  const Way* way;
  const std::vector<double>* turnings;  ///< stops and turns of the path, s
  double latency;                       ///< latency of the control block, s
  Pressing<double> pressing;
  double residual;  ///< pull of a magnet that is switched off, N
  Criteria criteria;
};

/// Time after which a pin that stays in its band counts as settled, s: half a period of the undamped
/// drive or, if longer, the time constant of the slowest decay.
inline double settling_patience(const Drive<double>& drive) {
  const double frequency = std::sqrt(drive.stiffness / drive.mass);
  const double ratio = drive.damping / (2 * std::sqrt(drive.mass * drive.stiffness));
  const double half_period = 0x1.921fb54442d18p+1 / frequency;
  if (!(ratio > 1)) return half_period;
  const double slowest = (ratio + std::sqrt(ratio - 1) * std::sqrt(ratio + 1)) / frequency;
  return std::max(half_period, slowest);
}

/// Rate at which the slowest part of a free motion decays, 1/s; 0 without damping.
inline double slowest_rate(const Drive<double>& drive) {
  const double frequency = std::sqrt(drive.stiffness / drive.mass);
  const double ratio = drive.damping / (2 * std::sqrt(drive.mass) * std::sqrt(drive.stiffness));
  if (!(ratio > 1)) return ratio * frequency;
  return frequency / (ratio + std::sqrt(ratio - 1) * std::sqrt(ratio + 1));
}

/// Deflection at which the spring balances a dragging plate, m; 0 in stick on the finger.
inline double drag_of_plate(const Drive<double>& drive, double plate_friction, double finger_load) {
  if (plate_friction <= drive.finger.static_limit * finger_load) return 0;
  return (plate_friction - drive.finger.kinetic * finger_load) / drive.stiffness;
}

/// Times at which a finger under a load touches the pin, s; between them it is lifted.
inline std::vector<Span> touches(const Profile<double>& load) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<Span> found;
  double begin = -infinity;
  while (begin < infinity) {
    const double end = load.next_breakpoint(begin);
    const Line<double> line =
        begin > -infinity ? load.from(begin).line() : Line<double>{load.first(), 0};
    const bool at_begin = line.value > 0;
    if (at_begin || line.rate > 0) {
      if (at_begin && !found.empty() && found.back().end == begin)
        found.back().end = end;
      else
        found.push_back({begin, end});
    }
    begin = end;
  }
  return found;
}

}  // namespace pindrive::device
