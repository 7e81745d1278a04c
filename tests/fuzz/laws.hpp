/// Laws that hold between two motions: that of a drive and of its mirror image, and one that is cut in two.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "given.hpp"
#include "pindrive/motion/motion.hpp"

namespace fuzz {

inline constexpr double largest_residual = 1e-9;

/// A motion with all that it refers to.
class Followed {
 public:
  explicit Followed(Case c) : case_(std::move(c)) { run_on(); }
  /// From a state: a position, a velocity and the stretch of the skin, NaN where that slides.
  Followed(Case c, double x, double v, double stretch) : case_(std::move(c)) {
    given_.inputs.displacement = x;
    given_.inputs.velocity = v;
    given_.inputs.skin_stretch = stretch;
    run_on();
  }

  Followed(const Followed&) = delete;
  Followed& operator=(const Followed&) = delete;

  bool ok() const { return outcome_.status == pd::Status::ok; }
  pd::Motion<double> motion() const {
    return {given_.drive, given_.inputs, segments_.data(), segments_.size(), outcome_};
  }

 private:
  void run_on() { outcome_ = run(given_, segments_); }

  const Case case_;
  Given given_{case_};
  std::vector<pd::Segment<double>> segments_;
  pd::Outcome<double> outcome_;
};

/// Position and velocity.
using Place = std::array<double, 2>;

inline Place place(const pd::Motion<double>& motion, const pd::Segment<double>& segment,
                   double tau) {
  return motion.along(segment, [&](const auto& along) {
    return Place{along.at(along.position(), tau), along.at(along.velocity(), tau)};
  });
}
inline Place place(const pd::Motion<double>& motion, double t) {
  const auto at = motion.locate(t, pd::Side::right);
  return place(motion, *at.segment, at.tau);
}
/// The largest position and velocity as its segments begin and at times ever closer to that, as what springs back
/// may be fastest soon. A transverse velocity counts: the sliding direction has its rounding.
inline Place size(const pd::Motion<double>& motion, double duration) {
  Place most{};
  const double natural_time = std::sqrt(motion.drive().mass / motion.drive().stiffness);
  for (const auto& segment : motion) {
    const double across = std::abs(motion.inputs().across_velocity.from(segment.begin).value);
    most[0] = std::max(most[0], across * natural_time);
    most[1] = std::max(most[1], across);
    const double span = std::min(segment.end, duration) - segment.begin;
    motion.along(segment, [&](const auto& along) {
      for (const double part : {0.0, 1.0 / 512, 1.0 / 128, 1.0 / 32, 1.0 / 8, 1.0 / 2}) {
        const double tau = part * span;
        most[0] = std::max(most[0], std::abs(along.at(along.position(), tau)));
        most[1] = std::max(most[1], std::abs(along.at(along.velocity(), tau)));
      }
    });
  }
  return most;
}
/// Largest terms of the sums for position and velocity, whose rounding the sums have: a force that changes
/// while the pin hardly moves makes the terms far larger than the sums.
inline Place terms(const pd::Motion<double>& motion, double duration) {
  Place most{};
  for (const auto& segment : motion) {
    const double span = std::min(segment.end, duration) - segment.begin;
    motion.along(segment, [&](const auto& along) {
      most[0] = std::max(most[0], along.terms(along.position(), span));
      most[1] = std::max(most[1], along.terms(along.velocity(), span));
    });
  }
  return most;
}
/// Beside a size; what differs from none at all is far.
inline double beside(double difference, double size) {
  return difference == 0 ? 0 : size > 0 ? std::abs(difference) / size : never;
}

// ---- the mirror ----------------------------------------------------------------------------------

inline Case mirror(Case c) {
  const auto turn = [](Rows& rows) {
    for (double& value : rows.value) value = 0 - value;  // a zero stays as it is
  };
  turn(c.mouse_velocity);
  turn(c.force);
  turn(c.across);
  for (const Input input : {mouse_velocity, force, across_velocity})
    for (Piece& piece : c.functions[input]) {
      for (double& p : piece.polynomial) p = 0 - p;
      for (Term& term : piece.terms) {
        term.cosine = 0 - term.cosine;
        term.sine = 0 - term.sine;
      }
    }
  c.displacement = 0 - c.displacement;
  c.velocity = 0 - c.velocity;
  return c;
}

inline bool mirrored(pd::ContactState one, pd::ContactState other) {
  return pd::sign(one) == 0 ? one == other : pd::sign(one) == -pd::sign(other);
}
inline bool mirrored(const pd::Segment<double>& one, const pd::Segment<double>& other) {
  const pd::Mode &a = one.mode, &b = other.mode;
  return one.begin == other.begin && one.end == other.end && mirrored(a.plate, b.plate) &&
         mirrored(a.finger, b.finger) && a.plate_branch == b.plate_branch &&
         a.finger_branch == b.finger_branch &&
         static_cast<int>(a.stop) == -static_cast<int>(b.stop) &&
         one.event.plate == other.event.plate && one.event.finger == other.event.finger &&
         one.event.stop == other.event.stop && one.eliminated == other.eliminated;
}

/// Distance of the motion of the mirror image from the mirror image of the motion; infinite where an event
/// differs. To turn a sign is exact, so that it has to be zero.
inline double mirror_residual(const pd::Motion<double>& motion, const Case& c) {
  const Followed image(mirror(c));
  const pd::Motion<double> other = image.motion();
  if (other.outcome().status != motion.outcome().status ||
      other.outcome().end != motion.outcome().end ||
      other.end() - other.begin() != motion.end() - motion.begin())
    return never;
  const Place most = size(motion, c.duration);
  double worst = 0;
  const pd::Segment<double>* twin = other.begin();
  for (const auto& segment : motion) {
    if (!mirrored(segment, *twin)) return never;
    const Place a = place(motion, segment, 0), b = place(other, *twin, 0);
    for (std::size_t i = 0; i < 2; ++i) worst = std::max(worst, beside(a[i] + b[i], most[i]));
    ++twin;
  }
  return worst;
}

// ---- cut in two ----------------------------------------------------------------------------------

/// Every row of a drive's inputs, in order of time.
inline std::vector<double> all_rows(const Case& c) {
  std::vector<double> times;
  for (const Rows* rows : {&c.mouse_velocity, &c.plate_load, &c.force, &c.across, &c.finger_load})
    times.insert(times.end(), rows->at.begin(), rows->at.end());
  for (const Function& function : c.functions)
    for (const Piece& piece : function) times.push_back(piece.begin);
  std::sort(times.begin(), times.end());
  return times;
}

/// The last of the rows that are one with a row, to the rounding of its time: what is one must stay so where
/// times are counted from a later instant, and their rounding is less.
inline double as_one(const std::vector<double>& rows, double t) {
  for (const double row : rows)
    if (row > t && row - t <= 4 * std::numeric_limits<double>::epsilon() * t) t = row;
  return t;
}

/// An input from a time on.
inline Rows from(const Rows& rows, double t, const std::vector<double>& all) {
  if (rows.at.size() == 1) return rows;
  Rows later{{0}, {Given::profile(rows).from(t).value}};
  for (std::size_t i = 0; i < rows.at.size(); ++i) {
    if (!(rows.at[i] > t)) continue;
    later.at.push_back(as_one(all, rows.at[i]) - t);
    later.value.push_back(rows.value[i]);
  }
  return later;
}

/// A function from a time on.
inline Function from(const Function& function, double t, const std::vector<double>& all) {
  Function later;
  for (std::size_t i = 0; i < function.size(); ++i) {
    if (i + 1 < function.size() && function[i + 1].begin <= t) continue;
    later.push_back(function[i]);
    later.back().begin =
        (function[i].begin > t ? as_one(all, function[i].begin) : function[i].begin) - t;
  }
  return later;
}

/// True if the load of skin grows from zero while its friction falls with speed.
inline bool begins_anyhow(const Case& c) {
  const Rows &load = c.finger_load, &curve = c.curve[1];
  bool grows = false, falls = false;
  for (std::size_t i = 1; i < load.at.size(); ++i)
    grows = grows || (load.value[i - 1] == 0 && load.value[i] > 0 && load.at[i] > load.at[i - 1]);
  for (std::size_t i = 1; i < curve.at.size(); ++i)
    falls = falls || curve.value[i] < curve.value[i - 1];
  return !std::isinf(c.skin) && grows && falls;
}

/// Time at which a motion is cut, and the drive from there on. A case is always cut at one time.
struct Cut {
  Cut(const pd::Motion<double>& motion, const Case& whole) : rest(whole) {
    // Far from the rows, inside of a segment that lasts.
    const auto count = static_cast<std::size_t>(motion.end() - motion.begin());
    segment = motion.begin() + count * 2 / 5;
    while (segment != motion.end() && !(segment->end > segment->begin)) ++segment;
    possible = segment != motion.end();
    if (!possible) return;
    // A release cannot say how fast skin slips on a curve, nor which way as its load changes.
    const bool damped = whole.skin_damping > 0;
    const bool either =
        damped && whole.limit[1] > whole.curve[1].value[0];  // it may stick, or slip on
    const bool known = whole.curve[1].at.size() == 1 && !either &&
                       (damped || Given::profile(whole.finger_load).from(segment->begin).rate == 0);
    possible = std::isinf(whole.skin) || known || !pd::is_slip(segment->mode.finger);
    // Skin that has no first mode as its load grows from zero begins with one at a time that the rows tell.
    possible = possible && !begins_anyhow(whole);
    if (!possible) return;
    tau = 0.61803398874989 * (std::min(segment->end, whole.duration) - segment->begin);
    time = segment->begin + tau;
    tau = time - segment->begin;
    const std::vector<double> all = all_rows(whole);
    for (Rows* rows :
         {&rest.mouse_velocity, &rest.plate_load, &rest.force, &rest.across, &rest.finger_load})
      *rows = from(*rows, time, all);
    for (Function& function : rest.functions) function = from(function, time, all);
    rest.duration = whole.duration - time;
    const Place now = place(motion, *segment, tau);
    const pd::Mode mode = segment->mode;
    x = now[0];
    v = mode.plate == pd::ContactState::stick    ? motion.inputs().mouse_velocity.from(time).value
        : mode.finger == pd::ContactState::stick ? 0
                                                 : now[1];
    held = mode.stuck();
    if (damped)
      stretch = pd::sampled_in(motion, *segment, tau, pd::Sampled::stretch);
    else if (mode.finger == pd::ContactState::elastic_stick)
      stretch = -motion.friction(*segment, tau).finger / whole.skin;
  }

  /// Motion after the cut, from a state moved by a part of the sizes of the motion, with damping and force
  /// changed as much: a pin that strikes a stop or comes to rest forgets its start.
  Followed follow(const Place& most, double part) const {
    Case moved = rest;
    moved.damping += part * std::sqrt(rest.mass * rest.stiffness);
    for (double& value : moved.force.value) value += part * rest.stiffness * most[0];
    for (Piece& piece : moved.functions[force])
      piece.polynomial[0] += part * rest.stiffness * most[0];
    // No farther than a rigid stop, nor than the skin can hold.
    const double reach = std::isinf(rest.stop_stiffness) ? rest.travel : never;
    const double held_by = rest.limit[1] * rest.finger_load.value[0] / rest.skin;
    const double grip = rest.skin_damping > 0 ? never : held_by;
    const auto within = [](double value, double end) { return std::clamp(value, -end, end); };
    return {moved, within(x + part * most[0], reach), held ? v : v + part * most[1],
            within(stretch + part * most[0], grip)};
  }

  const pd::Segment<double>* segment{};
  bool possible{}, held{};
  double tau{}, time{}, x{}, v{}, stretch{std::numeric_limits<double>::quiet_NaN()};
  Case rest;
};

/// True if two motions, from a segment on, part where the pin slips by no more than a speed and comes to rest
/// in either of the motions.
inline bool part_at_rest(const pd::Motion<double>& one, const pd::Segment<double>* a,
                         const pd::Motion<double>& other, double still) {
  for (const auto& b : other) {
    if (a == one.end() || a->mode.plate != b.mode.plate || a->mode.finger != b.mode.finger ||
        a->mode.stop != b.mode.stop)
      return false;
    if (a->event.finger != b.event.finger)
      return std::abs(place(one, *a, a->end - a->begin)[1]) <= still &&
             std::abs(place(other, b, b.end - b.begin)[1]) <= still;
    ++a;
  }
  return false;
}

/// Distance of a motion that continues from a state within a motion from that motion, as a part of the
/// largest position and velocity, at times ever closer to the cut. Rounding of the state may have the effect
/// of a start moved by a part of 1e-12, either way: the difference is reduced by four times the distance of
/// these motions, again for each stop on the way, and by the rounding of the summed terms.
inline double cut_residual(const pd::Motion<double>& motion, const Case& c) {
  const Cut cut(motion, c);
  if (!cut.possible || !(cut.rest.duration > 0)) return 0;
  const Place most = size(motion, c.duration);
  // A pin that slides by less than the rounding of its velocity may as well be at rest, and on skin a release
  // cannot say how that is stretched.
  const double stop = std::isinf(c.stop_stiffness) ? 0 : c.stop_stiffness;
  const double fastest =
      (c.damping + c.stop_damping) / c.mass + std::sqrt((c.stiffness + stop) / c.mass);
  const double still =
      16 * std::numeric_limits<double>::epsilon() * std::max(most[1], fastest * most[0]);
  if (!cut.held && std::abs(cut.v) <= still) return 0;
  const Followed rest = cut.follow(most, 0);
  if (!rest.ok()) return never;
  constexpr int times = 16;
  std::array<Place, times> apart;
  std::array<double, times> at;
  double worst = 0, after = cut.rest.duration;
  for (std::size_t k = 0; k < times; ++k, after *= 0.6) {
    const double t = std::min(cut.time + after, c.duration);
    at[k] = t - cut.time;
    const Place one = place(motion, t), other = place(rest.motion(), at[k]);
    for (std::size_t i = 0; i < 2; ++i) {
      apart[k][i] = beside(other[i] - one[i], most[i]);
      worst = std::max(worst, apart[k][i]);
    }
  }
  if (worst <= largest_residual) return worst;
  if (part_at_rest(motion, cut.segment, rest.motion(), still)) return 0;
  const Followed up = cut.follow(most, 1e-12), down = cut.follow(most, -1e-12);
  if (!up.ok() || !down.ok()) return never;
  const Place sums = terms(motion, c.duration);
  // One that grazes its stops is off anew at each.
  const auto met = [](const pd::Segment<double>& one) {
    return one.event.stop != pd::Transition::none;
  };
  const double times_off = 4.0 + static_cast<double>(std::count_if(cut.segment, motion.end(), met));
  worst = 0;
  for (std::size_t k = 0; k < times; ++k) {
    const Place a = place(up.motion(), at[k]), b = place(down.motion(), at[k]);
    for (std::size_t i = 0; i < 2; ++i) {
      const double rounded = 64 * std::numeric_limits<double>::epsilon() * sums[i];
      worst = std::max(
          worst, apart[k][i] - times_off * beside(a[i] - b[i], most[i]) - beside(rounded, most[i]));
    }
  }
  return worst;
}

}  // namespace fuzz
