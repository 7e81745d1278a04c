// Extrema and crossings of random drives against samples of the motion: every sample lies between its
// neighbouring extrema and on the side of the level that the crossing before it leads to; crossings
// alternate and lie on the level; a cycle goes on as it was simulated.
#include "pindrive/motion/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "../fuzz/draw.hpp"
#include "../fuzz/judge.hpp"
#include "cases.hpp"

namespace pd = pindrive;

namespace {

constexpr int samples = 300;
constexpr pd::Quantity quantities[] = {pd::Quantity::position, pd::Quantity::velocity,
                                       pd::Quantity::acceleration};

struct Point {
  double time, value;
};

struct Course {
  const pd::Motion<double>& motion;
  pd::Quantity quantity;
  double until;

  double at(double time, pd::Side side) const {
    const auto place = motion.locate(time, side);
    return motion.along(*place.segment, [&](const auto& along) {
      return along.at(pd::detail::quantity_of(along, quantity), place.tau);
    });
  }
  /// The rounding of a value: of the forces behind an acceleration and of the time at which it is.
  double rounding(double largest) const {
    const auto& drive = motion.drive();
    const double stiffness =
        drive.stiffness +
        (drive.finger.rigid() || !drive.finger.present() ? 0 : drive.finger.stiffness);
    const double rate = std::sqrt(stiffness / drive.mass) + drive.damping / drive.mass;
    double terms = largest;
    for (const auto& segment : motion) {
      const auto& flow = segment.flow;
      const double x = std::abs(flow.position.start) + std::abs(flow.position.value),
                   v = std::abs(flow.velocity.start) + std::abs(flow.velocity.value);
      terms = std::max(terms, quantity == pd::Quantity::position   ? x
                              : quantity == pd::Quantity::velocity ? v + rate * x
                                                                   : rate * (v + rate * x));
    }
    return 1e-12 * terms * (1 + 1e-2 * rate * until);
  }
};

int failures = 0;

void expect(bool good, const std::string& what) {
  if (good) return;
  std::printf("FAIL %s\n", what.c_str());
  ++failures;
}

/// Between two neighbouring extrema the quantity stays within them.
void between(const Course& course, const std::vector<Point>& extrema, const std::string& name) {
  expect(extrema.size() >= 2 && extrema.front().time == 0 && extrema.back().time == course.until,
         name + ": from begin to end");
  double largest = 0;
  for (const Point& p : extrema) largest = std::max(largest, std::abs(p.value));
  const double rounding = course.rounding(largest);
  std::size_t next = 1;
  for (int i = 0; i <= samples && next < extrema.size(); ++i) {
    const double time = course.until * i / samples;
    while (next + 1 < extrema.size() && extrema[next].time < time) ++next;
    const Point a = extrema[next - 1], b = extrema[next];
    if (time - a.time < 1e-9 * course.until || b.time - time < 1e-9 * course.until) continue;
    const double value = course.at(time, pd::Side::left);
    expect(value >= std::min(a.value, b.value) - rounding &&
               value <= std::max(a.value, b.value) + rounding,
           name + ": beyond its extrema at " + std::to_string(time));
  }
}

struct Crossing {
  double time;
  int side;
};

/// Crossings alternate, and lead to the side where the samples are.
void across(const Course& course, double level, const std::string& name) {
  std::vector<Crossing> found;
  pd::crossings(course.motion, course.quantity, level, course.until,
                [&](double time, int side) { found.push_back({time, side}); });
  const double rounding = course.rounding(std::abs(level));
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i > 0) {
      expect(found[i].side == -found[i - 1].side, name + ": crossings alternate");
      expect(found[i].time >= found[i - 1].time, name + ": crossings in order");
    }
    // In a cycle the time of a jump is that of another round, to rounding.
    const double time = found[i].time, beside = 1e-14 * course.until;
    const double left = course.at(std::max(time - beside, 0.0), pd::Side::left) - level,
                 right = course.at(std::min(time + beside, course.until), pd::Side::right) - level;
    expect(std::min(left, right) <= rounding && std::max(left, right) >= -rounding,
           name + ": a crossing lies on the level");
  }
  for (int i = 1; i < samples; ++i) {
    const double time = course.until * (i + 0.5) / samples;
    const double off = course.at(time, pd::Side::right) - level;
    if (std::abs(off) <= 10 * rounding) continue;
    const auto after = std::partition_point(found.begin(), found.end(),
                                            [&](const Crossing& c) { return c.time <= time; });
    const bool side = after != found.begin() ? std::prev(after)->side * off > 0
                      : found.empty()        ? (course.at(0, pd::Side::right) - level) * off >= 0
                                             : found.front().side * off < 0;
    expect(side, name + ": a sample on the other side of the level at " + std::to_string(time));
  }
}

void judge(const pd::Motion<double>& motion, double until, const std::string& name) {
  for (const pd::Quantity quantity : quantities) {
    const Course course{motion, quantity, until};
    const std::string which = name + " quantity " + std::to_string(static_cast<int>(quantity));
    std::vector<Point> extrema;
    pd::extrema(motion, quantity, until,
                [&](double time, double value) { extrema.push_back({time, value}); });
    between(course, extrema, which);
    const auto [low, high] =
        std::minmax_element(extrema.begin(), extrema.end(),
                            [](const Point& a, const Point& b) { return a.value < b.value; });
    for (const double part : {0.5, 0.0, 0.31})
      across(course, part == 0 ? 0 : low->value + part * (high->value - low->value), which);
  }
}

/// A pin that comes to rest tangentially reaches zero velocity at the end of a segment only to
/// rounding: its velocity crosses zero as often as its position turns.
void coming_to_rest(std::vector<pd::Segment<double>>& segments) {
  for (const int number : {656, 694, 976, 1053, 2279, 2305, 2473, 2747, 2769, 2785}) {
    const fuzz::Case c = fuzz::Draw(1, number, fuzz::Family::aligned).next();
    const fuzz::Given given(c);
    const auto outcome = fuzz::run(given, segments);
    const pd::Motion<double> motion(given.drive, given.inputs, segments.data(), segments.size(),
                                    outcome);
    int visits = 0, zeros = 0;
    pd::extrema(motion, pd::Quantity::position, c.duration, [&](double, double) { ++visits; });
    pd::crossings(motion, pd::Quantity::velocity, 0.0, c.duration, [&](double, int) { ++zeros; });
    expect(zeros == visits - 2, "case " + std::to_string(number) + ": zeros of the velocity");
  }
}

/// At a kink of the external force the acceleration is continuous: no extremum but for a turn.
void kinks() {
  for (int i = 0; i < 20; ++i) {
    const double times[] = {0, 0.003, 0.007, 0.013, 0.021};
    const double forces[] = {0, 0.0004 * i, -0.001 * i, 0.0003 * i, 0};
    const pd::Drive<double> drive{0.01, 100.0, 0.02 * i, {0.02, 0.02}, {0.005, 0.005}};
    pd::Inputs<double> inputs{0.1, 1.5e-3, 0.1};
    inputs.force = pd::Profile<double>(times, forces, 5);
    std::vector<pd::Segment<double>> segments;
    const auto outcome =
        pd::simulate(drive, inputs, [&](const auto& segment) { segments.push_back(segment); });
    const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
    double last = -1;
    pd::extrema(motion, pd::Quantity::acceleration, 0.05, [&](double time, double) {
      const bool kink = std::find(times, times + 5, time) != times + 5;
      expect(!kink || time != last, "drive " + std::to_string(i) + ": a kink is no jump");
      last = time;
    });
  }
}

}  // namespace

int main() {
  std::vector<pd::Segment<double>> segments;
  coming_to_rest(segments);
  kinks();
  int judged = 0, cycles = 0;
  for (int number = 0; number < cases(4000); ++number) {
    const fuzz::Case c = fuzz::Draw(5, number).next();
    const fuzz::Given given(c);
    const auto outcome = fuzz::run(given, segments);
    if (outcome.status != pd::Status::ok || segments.size() > 300) continue;
    const pd::Motion<double> motion(given.drive, given.inputs, segments.data(), segments.size(),
                                    outcome);
    const double until = outcome.cycles() ? outcome.until + 2.5 * outcome.period : c.duration;
    int turns = 0;  // stiff skin rings for long
    pd::extrema(motion, pd::Quantity::acceleration, until,
                [&](double, double) { return ++turns < 3000; });
    if (turns >= 3000) continue;
    judge(motion, until, "case " + std::to_string(number));
    cycles += outcome.cycles() ? 1 : 0;
    ++judged;
    // The events of a cycle come again after a period.
    if (!outcome.cycles()) continue;
    std::vector<double> once, again;
    const double margin = 1e-6 * outcome.period;
    pd::events(motion, outcome.cycle_begin + margin, outcome.until + margin,
               [&](double time, const auto&) { once.push_back(time); });
    pd::events(motion, outcome.until + margin, outcome.until + outcome.period + margin,
               [&](double time, const auto&) { again.push_back(time); });
    bool same = once.size() == again.size();  // without events over a plate that slides across
    for (std::size_t i = 0; same && i < once.size(); ++i)
      same = std::abs(again[i] - once[i] - outcome.period) <= 1e-9 * outcome.period;
    expect(same, "case " + std::to_string(number) + ": events of a cycle come again");
  }
  std::printf("%d motions, %d of them cycles, %d failures\n", judged, cycles, failures);
  return failures == 0 && judged > cases(2000) && cycles >= cases(7) ? 0 : 1;
}
