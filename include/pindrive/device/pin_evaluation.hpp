/// Evaluation of one pin: its answer to each time with the magnet on, its lines and its false lines.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/monotone_pieces.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::device {

/// Evaluation of one pin. Deflections count forward, in the direction in which the plate passes under the mouse.
/// Times are since the begin of the path, s.
class PinEvaluation {
 public:
  /// The pin must outlive it.
  PinEvaluation(const ScanSetting& setting, const ScannedPin& pin)
      : setting_(setting), pin_(pin), drive_(pin.motion->drive()), origin_(setting.path.begin()) {
    end_ = setting.path.end() - origin_;
    pieces_.read(*pin.motion, end_);
    touches_ = touches(pin.motion->inputs().finger_load);
    for (const double t : *setting.turnings) stops_.push_back(t - origin_);
    find_pulls();
  }

  /// Time with the magnet switched on, and the answer of the pin.
  struct Pull {
    double on, off;
    double begin;    ///< time at which the pin came forward; NaN: never
    double dip;      ///< time of the lowest position before that
    double release;  ///< time of the break-away from the plate
    double sign;     ///< direction of the plate

    bool moved() const { return !std::isnan(begin); }
  };
  const std::vector<Pull>& pulls() const { return pulls_; }

  /// Adds each line that passed whole under the pin.
  void add_lines(std::vector<EvaluatedLine>& found) const {
    std::vector<bool> assigned(pulls_.size());
    for (std::size_t i = 0; i < pin_.lines.size(); ++i) {
      const Span line = since_begin(pin_.lines[i]);
      const Pull *first = nullptr, *last = nullptr;
      bool seen = false;
      for (std::size_t k = 0; k < pulls_.size(); ++k) {
        const double on = pulls_[k].on - setting_.latency, off = pulls_[k].off - setting_.latency;
        const bool during = on <= line.end && off >= line.begin;
        if (!during) continue;
        seen = true;
        last = &pulls_[k];
        if (!first && !assigned[k]) first = last;
        assigned[k] = true;
      }
      const bool stays_on = last && i + 1 < pin_.lines.size() &&
                            last->off - setting_.latency >= since_begin(pin_.lines[i + 1]).begin;
      if (pin_.lines[i].whole)
        found.push_back(line_of(line, first, stays_on ? nullptr : last, seen));
    }
  }

  /// Adds the swings forward without a magnet that the criteria count as lines.
  void add_false_lines(std::vector<FalseLine>& found) const {
    double begin = 0;
    const auto stroke = [&](double end) {
      if (!(end > begin)) return;
      if (plate_velocity(0.5 * (begin + end)) != 0) add_false_lines(begin, end, found);
      begin = end;
    };
    for (const double stop : stops_)
      if (stop > 0 && stop < end_) stroke(stop);
    stroke(end_);
  }

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

  Span since_begin(const PrintedLine& line) const {
    return {line.begin - origin_, line.end - origin_};
  }
  double plate_velocity(double t) const {
    return setting_.axis.along(setting_.path.velocity(on_path(t)));
  }
  double on_path(double t) const { return std::min(origin_ + t, setting_.path.end()); }
  /// Direction of the plate; forward at rest.
  double direction(double t) const { return plate_velocity(t) < 0 ? -1 : 1; }
  /// Next stop or turn of the hand after a time, or the end.
  double next_stop(double t) const {
    const auto stop = std::upper_bound(stops_.begin(), stops_.end(), t);
    return stop == stops_.end() ? end_ : std::min(*stop, end_);
  }
  Place spot(double t) const { return setting_.path.position(on_path(t)) + pin_.spot; }
  Signal deflection(double sign) const { return {false, sign}; }
  Signal skin(double sign) const { return {true, sign}; }

  void find_pulls() {
    std::vector<Span> held;
    pieces_.each_hold([&](double begin, double end) { held.push_back({begin, end}); });
    auto hold = held.begin();
    for (std::size_t k = 0; k < pin_.energised.size(); ++k) {
      const double on = pin_.energised[k].begin - origin_, off = pin_.energised[k].end - origin_;
      const double next =
          k + 1 < pin_.energised.size() ? pin_.energised[k + 1].begin - origin_ : end_;
      const double sign = direction(std::max(0.0, on - setting_.latency));
      const auto climb = pieces_.climb(deflection(sign), setting_.criteria.felt, on,
                                       std::min(next, next_stop(off)));
      while (hold != held.end() && hold->end <= off) ++hold;
      const bool holds = hold != held.end() && hold->begin <= off;
      pulls_.push_back({on, off, climb.time, climb.low_time, holds ? hold->end : off, sign});
    }
  }

  /// End of the time that belongs to a pull: the next pull, or the stop of the hand.
  double end_of(const Pull& pull) const {
    const double stop = std::max(next_stop(pull.off), pull.off);
    if (&pull == &pulls_.back()) return stop;
    const Pull& next = (&pull)[1];
    return std::min(stop, next.moved() ? next.dip : next.on);
  }

  EvaluatedLine line_of(const Span& line, const Pull* first, const Pull* last, bool seen) const {
    const double sign = direction(line.begin);
    const Signal x = deflection(sign);
    EvaluatedLine found{pin_.number,
                        LineOutcome::shown,
                        edge_at(line.begin),
                        edge_at(line.end),
                        nan,
                        nan,
                        nan,
                        nan,
                        nan,
                        nan,
                        nan,
                        nan};
    if (!first) {
      found.outcome = seen ? LineOutcome::merged : LineOutcome::unseen;
    } else if (still_out(*first)) {
      found.outcome = LineOutcome::merged;
    } else {
      answer(found.begin, first->on, first->begin);
      if (first->moved()) {
        const Point peak = pieces_.highest(x, first->begin, end_of(*first));
        found.stroke = peak.value - pieces_.at(x, first->dip);
        feel(found.begin, skin_motion(skin(sign), first->dip, peak.time));
      }
    }
    if (last) evaluate_return(*last, x, found);
    const bool felt = found.begin.cue != Cue::none || found.end.cue != Cue::none;
    const bool answered = felt && !std::isnan(found.begin.response);
    if (found.outcome == LineOutcome::shown && !answered) found.outcome = LineOutcome::faint;
    return found;
  }

  /// Return of the pin after the last pull of a line.
  void evaluate_return(const Pull& pull, const Signal& x, EvaluatedLine& found) const {
    const double limit = end_of(pull), release = std::min(pull.release, limit);
    const Point peak = pieces_.highest(x, pull.on, limit);
    const double low = -pieces_.highest(-x, peak.time, limit).value;
    const auto back = pieces_.climb(-x, setting_.criteria.felt, pull.off, limit);
    answer(found.end, pull.off, back.time);
    if (back.found()) feel(found.end, skin_motion(skin(-x.sign), peak.time, limit));
    found.height = peak.value;
    found.returned = peak.value - low;
    found.contrast = peak.value > low ? found.returned / (std::abs(peak.value) + std::abs(low)) : 0;
    found.release = origin_ + release;
    if (!(limit > release)) return;
    const double last = pieces_.at(x, limit);
    const double band = settling_band * std::abs(pieces_.at(x, release) - last);
    const double since = pieces_.last_beyond(x, last, band, release, limit);
    const bool settles = limit - since >= settling_patience(drive_) || pieces_.rests(limit);
    const double rest = settles ? last : drag(limit);
    // A pin that did not return has no overshoot.
    if (peak.value - rest > detail::rounding<double> * std::abs(peak.value))
      found.overshoot = std::max(0.0, (rest - low) / (peak.value - rest));
    if (!settles) return;
    found.settled = origin_ + since;
    found.smear = setting_.way->between(found.release, found.settled);
  }

  /// Deflection at which the spring balances the dragging plate, m; 0 in stick on the finger.
  double drag(double t) const {
    const Profile<double>& touch = pin_.motion->inputs().finger_load;
    const double load = setting_.pressing.load(setting_.residual, touch.given_from(t).value);
    return drag_of_plate(drive_, drive_.plate.kinetic * load, touch.from(t).value);
  }

  /// True if the pin had not come back from the pull before when a pull moved it on.
  bool still_out(const Pull& pull) const {
    if (&pull == &pulls_.front()) return false;
    const Pull& before = (&pull)[-1];
    if (before.sign != pull.sign || !before.moved()) return false;
    const double until = pull.moved() ? pull.begin : end_of(pull);
    const Signal x = deflection(pull.sign);
    const double way = pieces_.highest(x, before.on, until).value - drag(until);
    const double least = std::max(setting_.criteria.felt, setting_.criteria.distinct * way);
    return !pieces_.climb(-x, least, before.off, until).found();
  }

  EvaluatedEdge edge_at(double t) const {
    return {origin_ + t, spot(t), nan, nan, nan, nan, Cue::none};
  }
  void answer(EvaluatedEdge& edge, double command, double response) const {
    edge.command = origin_ + command;
    edge.response = origin_ + response;
    edge.lag = setting_.way->between(edge.time, edge.response);
  }

  /// Motion of the skin, m, and its cue.
  struct Felt {
    double moved;
    Cue cue;
  };
  static void feel(EvaluatedEdge& edge, const Felt& felt) {
    edge.skin = felt.moved;
    edge.cue = felt.cue;
  }

  /// Largest motion of the skin between two times within one touch, and its cue.
  Felt skin_motion(const Signal& skin, double from, double to) const {
    Felt most{0, Cue::none};
    for (const Span& touch : touches_) {
      const double begin = std::max(from, touch.begin), end = std::min(to, touch.end);
      if (!(begin < end)) continue;
      const Felt found = skin_motion_in_touch(skin, begin, end);
      if (found.cue > most.cue || (found.cue == most.cue && found.moved > most.moved) ||
          touches_.size() == 1)
        most = found;
    }
    return most;
  }
  Felt skin_motion_in_touch(const Signal& skin, double from, double to) const {
    const Criteria& limits = setting_.criteria;
    const double base = pieces_.at(skin, from, Side::left);
    const double moved = pieces_.highest(skin, from, to).value - base;
    const double soon = from + limits.direction_sure / limits.direction_speed;
    if (moved >= limits.direction_sure &&
        pieces_.first_at(skin, base + limits.direction_sure, from, to) <= soon)
      return {moved, Cue::sure};
    if (moved < limits.felt) return {moved, Cue::none};
    return {moved, moved >= limits.direction ? Cue::direction : Cue::felt};
  }

  /// Last pull with a part in a swing; null without one.
  const Pull* pull_of(const Swing& swing) const {
    for (auto pull = pulls_.rbegin(); pull != pulls_.rend(); ++pull)
      if (pull->on < swing.high.time && std::max(pull->off, pull->release) > swing.low.time)
        return &*pull;
    return nullptr;
  }

  /// False lines of one stroke of the hand.
  void add_false_lines(double begin, double end, std::vector<FalseLine>& found) const {
    const double sign = direction(0.5 * (begin + end));
    const std::vector<Swing> swings = pieces_.swings(deflection(sign), begin, end);
    std::vector<double> heights(pulls_.size());  // highest swing of each pull
    const Pull* first = nullptr;
    for (const Swing& swing : swings)
      if (const Pull* const pull = pull_of(swing)) {
        double& height = heights[pull - pulls_.data()];
        height = std::max(height, swing.height());
        if (!first) first = pull;
      }
    double before = first ? heights[first - pulls_.data()] : 0;  // height of the line before
    for (const Swing& swing : swings) {
      if (const Pull* const pull = pull_of(swing)) {
        before = heights[pull - pulls_.data()];
        continue;
      }
      const Criteria& limits = setting_.criteria;
      const double usual = limits.false_line * before;
      const double least = usual > 0 ? limits.direction : limits.direction_sure;
      if (swing.height() < std::max(usual, least)) continue;
      if (skin_motion(skin(sign), swing.low.time, swing.high.time).moved < least) continue;
      found.push_back(
          {pin_.number, origin_ + swing.high.time, spot(swing.high.time), swing.height()});
    }
  }

  const ScanSetting& setting_;
  const ScannedPin& pin_;
  const Drive<double>& drive_;
  double origin_, end_{0};
  MonotonePieces pieces_;
  std::vector<Span> touches_;
  std::vector<double> stops_;
  std::vector<Pull> pulls_;
};

}  // namespace pindrive::device
