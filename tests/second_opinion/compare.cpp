// The core against the one that chose each next mode by the kind of event and its history, on random
// drives: the modes of both contacts, and when they change.
//
//   compare COUNT SEED [FROM]
//
// Every drive on which the two differ is printed with the first difference. What lasts no longer than
// rounding is left out: the older core has modes that last no time. 155 of 1 000 000 drives of seed 7 and
// 164 of seed 11 differ, in five ways (the numbers are cases of seed 7):
//
// - An elastic stick whose vibration reaches its limit by no more than rounding: the older core slips for
//   some 1e-9 s, this one stays, or the other way round where both are rounding (29771, 41213, 84990).
// - A contact exactly at its limit where the plate begins to pull or the mouse sets off: the older core
//   asked the other contact first, or none again; this one finds the contact that can hold, or the
//   departure at once (93211, 112169, 339712).
// - A motion that has faded to the rounding of its position: whether its last swings of 1e-18 m/s cross or
//   stick, and when, is rounding in both (992536, 98686, 565248); near critical damping the older core
//   sticks long after (237642, 37952).
// - A pin at rest whose forces cancel to rounding beside a contact without friction, or a plate without
//   load: whether that contact sticks or slips says nothing of the motion (16955, 47979, 190202).
// - A pin without damping that touches the plate's velocity once a period: a free oscillation for the
//   older core, grazing for this one, with a stick of some 1e-9 s or without (36710, 150539).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "../fuzz/draw.hpp"
#include "../fuzz/judge.hpp"
#include "simulate.hpp"

namespace so = second_opinion;

namespace {

/// From when on the contacts do what.
struct Phase {
  double begin;
  int plate, finger;
};

struct Course {
  std::vector<Phase> phases;
  int status{0}, end{0};
  double until{0};
  double rounding;  ///< what lasts no longer has no time, s

  template <class Segment>
  void add(const Segment& segment) {
    const Phase next{segment.begin, static_cast<int>(segment.mode.plate),
                     static_cast<int>(segment.mode.finger)};
    while (!phases.empty() && next.begin - phases.back().begin <= rounding) phases.pop_back();
    if (!phases.empty() && phases.back().plate == next.plate && phases.back().finger == next.finger)
      return;
    phases.push_back(next);
  }
  template <class Outcome>
  void finish(const Outcome& outcome) {
    status = static_cast<int>(outcome.status);
    end = static_cast<int>(outcome.end);
    until = outcome.until;
  }
};

Course new_course(const fuzz::Given& given, double rounding) {
  Course course;
  course.rounding = rounding;
  course.finish(pindrive::simulate(given.drive, given.inputs,
                                   [&](const auto& segment) { course.add(segment); }));
  return course;
}

Course old_course(const fuzz::Case& c, const fuzz::Given& given, double rounding) {
  const auto branches = [](const auto& rows) {
    std::vector<so::Region<double>> branches;
    branches.reserve(rows.size());
    for (const auto& row : rows)
      branches.push_back({row.from, row.to, row.force, row.slope, row.rounding});
    return branches;
  };
  const auto profile = [](const fuzz::Rows& rows) {
    return rows.at.size() == 1
               ? so::Profile<double>(rows.value[0])
               : so::Profile<double>(rows.at.data(), rows.value.data(), rows.at.size());
  };
  const auto plate = branches(given.plate), finger = branches(given.finger);
  const so::Drive<double> drive{
      c.mass,
      c.stiffness,
      c.damping,
      {c.curve[0].value[0], c.limit[0], fuzz::never, plate.data(), static_cast<int>(plate.size())},
      {c.curve[1].value[0], c.limit[1], c.skin, finger.data(), static_cast<int>(finger.size())}};
  const so::Inputs<double> inputs{profile(c.mouse_velocity), c.displacement, c.velocity, c.duration,
                                  profile(c.plate_load)};
  Course course;
  course.rounding = rounding;
  course.finish(so::simulate(drive, inputs, [&](const auto& segment) { course.add(segment); }));
  return course;
}

/// Prints the first difference, if there is one.
bool differ(long long number, const Course& old, const Course& now, double tolerance) {
  // A cycle may be found a round earlier or later.
  const double until = std::min(old.until, now.until);
  const std::size_t count = std::max(old.phases.size(), now.phases.size());
  const Phase none{fuzz::never, 9, 9};
  for (std::size_t i = 0; i < count; ++i) {
    const Phase a = i < old.phases.size() ? old.phases[i] : none;
    const Phase b = i < now.phases.size() ? now.phases[i] : none;
    if (std::min(a.begin, b.begin) >= until) break;
    if (a.plate == b.plate && a.finger == b.finger && std::abs(a.begin - b.begin) <= tolerance)
      continue;
    std::printf(
        "%lld: phase %zu, old at %.17g plate %d finger %d, new at %.17g plate %d finger %d\n",
        number, i, a.begin, a.plate, a.finger, b.begin, b.plate, b.finger);
    return true;
  }
  // Whether a vibration that has died out has another event far beyond the duration is no difference.
  const bool ends_alike = old.end == now.end || old.end == 0 || now.end == 0;
  if (old.status == now.status && ends_alike) return false;
  std::printf("%lld: old status %d end %d, new status %d end %d\n", number, old.status, old.end,
              now.status, now.end);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: compare COUNT SEED [FROM]\n");
    return 2;
  }
  const auto number_of = [&](int i) { return std::strtoll(argv[i], nullptr, 10); };
  const long long count = number_of(1), from = argc > 3 ? number_of(3) : 0;
  const auto seed = static_cast<std::uint64_t>(number_of(2));
  long long different = 0;
  for (long long number = from; number < from + count; ++number) {
    const fuzz::Case c = fuzz::Draw(seed, static_cast<std::uint64_t>(number)).next();
    // The core before this one refused a curve under a changing load.
    if (c.curve[0].at.size() > 1 && c.plate_load.at.size() > 1) continue;
    const fuzz::Given given(c);
    const double unit = std::sqrt(c.mass / c.stiffness);
    const double rounding = 1e-10 * unit;
    different += differ(number, old_course(c, given, rounding), new_course(given, rounding),
                        1e-7 * unit + 1e-12 * c.duration)
                     ? 1
                     : 0;
  }
  std::printf("%lld drives of seed %lld, %lld differ\n", count, number_of(2), different);
  return different == 0 ? 0 : 1;
}
