// The core against the one that chose each next mode by the kind of event and its history, on random
// drives: the modes of both contacts, and when they change.
//
//   compare COUNT SEED [FROM [THREADS]]
//
// What lasts no longer than rounding is left out: the older core has modes that last no time. Every
// drive on which the two differ is explained by a condition on the first difference, in both motions and in
// the drive: a quantity on which the choice of the mode depends is zero there to rounding, which is
// 1e-12 of the largest position, velocity or force so far. One that fits no kind is printed, and the
// program fails.
//
// - elastic limit: one elastic stick goes on, the other slips, and in both its force just before is the
//   stick limit.
// - stick limit: a pin at rest on a surface, and the force that would keep it there, beside a contact that
//   does what it does in one of the motions or slips to either side, is the stick limit.
// - no force: the same with a limit that is no more than rounding of the forces; whether such a
//   contact sticks or slips says nothing of the motion.
// - touch: a speed relative to a surface comes to zero, which ends the mode in one motion; in the other it
//   goes on and its speed is never on the other side of zero. So do pins without damping that graze
//   the plate's velocity once a period, and motions that have faded.
// - row: one motion has an event less than 1e-6 radians before a row of an input, at which
//   a speed or what is left of a stick force is zero in the other.
// - growth: the same modes at other times, and falling friction has amplified a difference that was rounding:
//   by no more than the growth rates allow.
// - ending: the same events, and a last mode in which, from when both are in it, nothing moves: the one
//   motion says resting, the other decaying, free or a cycle; or a speed that comes to the plate's and turns: the one
//   says free, the other grazing.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "../fuzz/draw.hpp"
#include "../fuzz/judge.hpp"
#include "simulate.hpp"

namespace so = second_opinion;

namespace {

constexpr double to_rounding = 1e-12;

/// From when on the contacts do what.
struct Phase {
  double begin;
  std::array<int, 2> state;  ///< of plate and finger
};

struct Course {
  std::vector<Phase> phases;
  int status{0}, end{0};
  double until{0};
  double rounding;  ///< what lasts no longer has no time, s

  template <class Segment>
  void add(const Segment& segment) {
    const Phase next{segment.begin,
                     {static_cast<int>(segment.mode.plate), static_cast<int>(segment.mode.finger)}};
    while (!phases.empty() && next.begin - phases.back().begin <= rounding) phases.pop_back();
    if (!phases.empty() && phases.back().state == next.state) return;
    phases.push_back(next);
  }
  /// The index of the phase at a time.
  const Phase& at(double t) const {
    std::size_t i = phases.size() - 1;
    while (i > 0 && phases[i].begin > t) --i;
    return phases[i];
  }
};

/// The pin at an instant; what both stuck contacts carry is the plate's.
struct Instant {
  double x, v, a;
  std::array<double, 2> force;
  std::array<int, 2> state;
  double begin, end;
};

/// Every segment of a motion.
struct Walk {
  struct Stretch {
    double begin, end, growth;
    std::function<Instant(double)> at;
  };
  std::vector<Stretch> stretches;

  template <class Segment>
  void add(const Segment& s) {
    const auto at = [s](double t) {
      const double tau = std::clamp(t, s.begin, s.end) - s.begin;
      const auto moved = s.flow.after(tau);
      return Instant{s.flow.position.at(moved, tau),
                     s.flow.velocity.at(moved, tau),
                     s.flow.acceleration().at(moved, tau),
                     {s.plate_force.at(moved, tau), s.finger_force.at(moved, tau)},
                     {static_cast<int>(s.mode.plate), static_cast<int>(s.mode.finger)},
                     s.begin,
                     s.end};
    };
    const bool waves = s.flow.velocity.oscillates();
    const double rate = waves ? std::max(s.flow.oscillator.slowest_rate(), 0.0) : 0.0;
    stretches.push_back({s.begin, s.end, rate, at});
  }
  /// Just before a time, or from it on.
  Instant before(double t) const {
    return last([&](const Stretch& s) { return s.begin < t; })(t);
  }
  Instant from(double t) const {
    return last([&](const Stretch& s) { return s.begin <= t; })(t);
  }
  /// What has grown by e has grown by this power of it between two times.
  double growth(double begin, double end) const {
    double sum = 0;
    for (const Stretch& s : stretches)
      sum += s.growth * std::max(0.0, std::min(s.end, end) - std::max(s.begin, begin));
    return sum;
  }

 private:
  template <class Test>
  const std::function<Instant(double)>& last(Test&& test) const {
    std::size_t i = stretches.size() - 1;
    while (i > 0 && !test(stretches[i])) --i;
    return stretches[i].at;
  }
};

template <class Simulate>
Course course(double rounding, Simulate&& simulate, Walk* walk) {
  Course made;
  made.rounding = rounding;
  const auto outcome = simulate([&](const auto& segment) {
    made.add(segment);
    if (walk != nullptr) walk->add(segment);
  });
  made.status = static_cast<int>(outcome.status);
  made.end = static_cast<int>(outcome.end);
  made.until = outcome.until;
  return made;
}

Course new_course(const fuzz::Given& given, double rounding, Walk* walk = nullptr) {
  return course(
      rounding, [&](auto&& add) { return pindrive::simulate(given.drive, given.inputs, add); },
      walk);
}

Course old_course(const fuzz::Case& c, const fuzz::Given& given, double rounding,
                  Walk* walk = nullptr) {
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
  return course(rounding, [&](auto&& add) { return so::simulate(drive, inputs, add); }, walk);
}

enum Kind { elastic_limit, stick_limit, no_force, touch, row, growth, ending, unexplained };
constexpr std::array<const char*, 8> names{
    "elastic limit", "stick limit", "no force", "touch", "row", "growth", "ending", "unexplained"};

/// The first difference of two courses.
struct Difference {
  double begin,
      other;  ///< when one motion is in another phase, and the other one comes to its next, s
  Phase old_next, new_next;
  bool at_end;  ///< only how they end differs
};

bool differ(const Course& old, const Course& now, double tolerance, Difference& found) {
  // A cycle may be found a round earlier or later.
  const double until = std::min(old.until, now.until);
  const std::size_t count = std::max(old.phases.size(), now.phases.size());
  const Phase none{fuzz::never, {9, 9}};
  for (std::size_t i = 0; i < count; ++i) {
    const Phase a = i < old.phases.size() ? old.phases[i] : none;
    const Phase b = i < now.phases.size() ? now.phases[i] : none;
    if (std::min(a.begin, b.begin) >= until) break;
    if (a.state == b.state && std::abs(a.begin - b.begin) <= tolerance) continue;
    found = {std::min(a.begin, b.begin), std::max(a.begin, b.begin), a, b, false};
    return true;
  }
  // Whether a vibration that has died out has another event far beyond the duration is no difference.
  const bool ends_alike = old.end == now.end || old.end == 0 || now.end == 0;
  found = {
      until, until, {old.until, {old.status, old.end}}, {now.until, {now.status, now.end}}, true};
  return old.status != now.status || !ends_alike;
}

bool slips(int state) { return state == 1 || state == -1; }

/// The kinds that a difference is of, by how close to zero that is which decides.
class Explanation {
 public:
  Explanation(const fuzz::Case& c, const Course& old, const Course& now, const Walk& of_old,
              const Walk& of_new, const Difference& difference)
      : c_(c),
        courses_{&old, &now},
        walks_{&of_old, &of_new},
        difference_(difference),
        t_(difference.begin),
        unit_(std::sqrt(c.mass / c.stiffness)) {
    level_.fill(fuzz::never);
    plate_ = fuzz::Given::profile(c.mouse_velocity).from(t_);
    load_ = fuzz::Given::profile(c.plate_load).from(t_).value;
    double x = 0, v = 0;
    for (const auto& s : of_new.stretches) {
      if (s.begin > t_ && s.begin > 0) break;
      const Instant at = s.at(s.begin);
      x = std::max({x, std::abs(at.x), std::abs(at.v) * unit_});
      v = std::max(v, std::abs(at.v));
    }
    const auto largest = [](const fuzz::Rows& rows) {
      double most = 0;
      for (const double value : rows.value) most = std::max(most, std::abs(value));
      return most;
    };
    v_size_ = std::max({v, x / unit_, largest(c.mouse_velocity)});
    x_size_ = std::max(x, v_size_ * unit_);
    f_size_ = c.stiffness * x_size_ + c.damping * v_size_ + c.limit[0] * largest(c.plate_load) +
              c.limit[1] + c.mass * std::abs(plate_.rate);
    if (difference.at_end) {
      endings();
    } else {
      for (int contact = 0; contact < 2; ++contact) {
        const std::array<Instant, 2> before{of_old.before(t_), of_new.before(t_)};
        for (int i = 0; i < 2; ++i) at_rest(contact, walks_[i]->from(t_), before);
        if (state(0)[contact] != state(1)[contact]) choices(contact, before);
      }
      rows();
      grows();
    }
  }

  /// The first kind whose condition holds.
  Kind kind() const {
    for (int k = 0; k < unexplained; ++k)
      if (level_[k] <= to_rounding) return static_cast<Kind>(k);
    return unexplained;
  }
  double level(Kind kind) const {
    return kind == unexplained ? *std::min_element(level_.begin(), level_.end() - 1) : level_[kind];
  }

 private:
  void meet(Kind kind, double level) {
    if (level < level_[kind]) level_[kind] = level;
  }
  /// What a motion's contacts do from the difference on.
  std::array<int, 2> state(int motion) const { return courses_[motion]->at(t_).state; }
  double surface(int contact, double t) const {
    return contact == 0 ? fuzz::Given::profile(c_.mouse_velocity).from(t).value : 0.0;
  }
  double relative(int contact, const Instant& at, double t) const {
    return std::abs(at.v - surface(contact, t)) / v_size_;
  }
  double capacity(int contact) const { return c_.limit[contact] * (contact == 0 ? load_ : 1); }

  void choices(int contact, const std::array<Instant, 2>& before) {
    const std::array<int, 2> after{state(0)[contact], state(1)[contact]};
    if (contact == 1 && before[0].state[1] == 3 && before[1].state[1] == 3 &&
        (after[0] == 3) != (after[1] == 3))
      meet(elastic_limit, std::max(std::abs(c_.limit[1] - std::abs(before[0].force[1])),
                                   std::abs(c_.limit[1] - std::abs(before[1].force[1]))) /
                              f_size_);
    for (int i = 0; i < 2; ++i) goes_on(contact, i, after[i]);
  }

  /// Whether a stick of the contact would carry its limit.
  void at_rest(int contact, const Instant& at, const std::array<Instant, 2>& before) {
    double speed = relative(contact, at, t_);
    if (t_ > 0)
      speed = std::max({speed, relative(contact, before[0], t_), relative(contact, before[1], t_)});
    const double w = contact == 0 ? plate_.rate : 0.0;
    const double pull = c_.stiffness * at.x + c_.damping * at.v - c_.mass * (plate_.rate - w);
    const int other = 1 - contact;
    const auto judge = [&](double of_other, double limit) {
      const double rest = std::max(speed, std::abs(limit - std::abs(pull - of_other)) / f_size_);
      meet(limit <= to_rounding * f_size_ ? no_force : stick_limit, rest);
    };
    if (at.state[0] == 0 && at.state[1] == 0)
      judge(0, capacity(0) + capacity(1));
    else
      judge(at.force[other], capacity(contact));
    const double kinetic = c_.curve[other].value[0] * (other == 0 ? load_ : 1);
    if (relative(other, at, t_) > to_rounding || at.state[other] == 3) return;
    for (const double of_other : {kinetic, -kinetic}) judge(of_other, capacity(contact));
    if (plate_.rate == 0) judge(0, capacity(0) + capacity(1));
  }

  /// How far on the other side of zero the speed of a contact comes that goes on slipping, while it does.
  void goes_on(int contact, int motion, int state_after) {
    const Instant before = walks_[motion]->before(t_);
    if (!slips(state_after) || before.state[contact] != state_after) return;
    double dip = relative(contact, before, t_);
    for (const auto& s : walks_[motion]->stretches) {
      if (s.end <= t_ || s.begin > t_ + 20 * unit_) continue;
      if (s.at(s.begin).state[contact] != state_after) break;
      const double begin = std::max(s.begin, t_),
                   end = std::min({s.end, c_.duration, begin + 20 * unit_});
      for (int i = 0; i <= 64; ++i) {
        const double t = begin + (end - begin) * i / 64;
        dip = std::max(dip, -state_after * (s.at(t).v - surface(contact, t)) / v_size_);
      }
    }
    meet(touch, dip);
  }

  void rows() {
    for (const fuzz::Rows* input : {&c_.mouse_velocity, &c_.plate_load})
      for (const double at : input->at) {
        if (std::abs(at - t_) > 1e-6 * unit_ || at == 0) continue;
        for (int i = 0; i < 2; ++i) {
          const auto event = [&](int motion) {
            for (const auto& s : walks_[motion]->stretches)
              if (s.end < at && at - s.end < 1e-6 * unit_) return true;
            return false;
          };
          if (!event(i) || event(1 - i)) continue;
          const Instant now = walks_[1 - i]->before(at);
          const double load = fuzz::Given::profile(c_.plate_load)
                                  .from(std::nextafter(at, 0.0))
                                  .at(at - std::nextafter(at, 0.0));
          double carried = 0, limit = 0;
          for (int contact = 0; contact < 2; ++contact) {
            const bool sticks = now.state[contact] == 0;
            if (slips(now.state[contact])) meet(row, relative(contact, now, at));
            if (sticks) limit += c_.limit[contact] * (contact == 0 ? load : 1);
            if (sticks || now.state[contact] == 3)
              meet(row, std::abs((contact == 0 ? load : 1) * c_.limit[contact] -
                                 std::abs(now.force[contact])) /
                            f_size_);
            if (sticks) carried += now.force[contact];
          }
          if (limit > 0) meet(row, std::abs(limit - std::abs(carried)) / f_size_);
        }
      }
  }

  void grows() {
    if (difference_.old_next.state != difference_.new_next.state) return;
    const double apart = (difference_.other - t_) / unit_;
    meet(growth, apart * std::exp(-walks_[1]->growth(0, t_)));
  }

  void endings() {
    const std::array<int, 2> ends{courses_[0]->end, courses_[1]->end};
    std::array<Instant, 2> last;
    const double when =
        std::max(walks_[0]->stretches.back().begin, walks_[1]->stretches.back().begin);
    for (int i = 0; i < 2; ++i) last[i] = walks_[i]->from(when);
    const auto still = [&](const Instant& at) {
      return std::max(std::abs(at.v) / v_size_, c_.mass * std::abs(at.a) / f_size_);
    };
    const auto either = [&](int one, int other) {
      return std::min(ends[0], ends[1]) == one && std::max(ends[0], ends[1]) == other;
    };
    if (either(3, 4))
      meet(ending, std::max(relative(0, last[0], when), relative(0, last[1], when)));
    if (either(1, 2) || either(1, 3) || either(1, 6) || either(2, 6))
      meet(ending, std::max(still(last[0]), still(last[1])));
  }

  const fuzz::Case& c_;
  std::array<const Course*, 2> courses_;
  std::array<const Walk*, 2> walks_;
  Difference difference_;
  double t_, unit_, x_size_, v_size_, f_size_, load_;
  pindrive::Line<double> plate_;
  std::array<double, unexplained> level_;
};

struct Totals {
  std::array<long long, 8> count{};
  std::array<double, 8> worst{};
};

void compare(std::uint64_t seed, long long number, Totals& totals) {
  const fuzz::Case c = fuzz::Draw(seed, static_cast<std::uint64_t>(number)).next();
  const fuzz::Given given(c);
  const double unit = std::sqrt(c.mass / c.stiffness);
  // Twice: what lasts about as long as the bound may be left out in one motion alone.
  const double tolerance = 1e-7 * unit + 1e-12 * c.duration;
  double rounding = 1e-10 * unit;
  Difference d{};
  for (int i = 0; i < 2; ++i, rounding *= 2)
    if (!differ(old_course(c, given, rounding), new_course(given, rounding), tolerance, d)) return;
  rounding /= 2;
  Walk of_old, of_new;
  const Course old = old_course(c, given, rounding, &of_old);
  const Course now = new_course(given, rounding, &of_new);
  const Explanation why(c, old, now, of_old, of_new, d);
  const Kind kind = why.kind();
  ++totals.count[kind];
  totals.worst[kind] = std::max(totals.worst[kind], why.level(kind));
  if (kind != unexplained && std::getenv("ALL") == nullptr) return;
  static std::mutex one_line;
  const std::lock_guard<std::mutex> lock(one_line);
  std::printf("%lld %s %.1e: old (%d %d) at %.17g, new (%d %d) at %.17g\n", number, names[kind],
              why.level(kind), d.old_next.state[0], d.old_next.state[1], d.old_next.begin,
              d.new_next.state[0], d.new_next.state[1], d.new_next.begin);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::fprintf(stderr, "usage: compare COUNT SEED [FROM [THREADS]]\n");
    return 2;
  }
  const auto number_of = [&](int i, long long otherwise) {
    return argc > i ? std::strtoll(argv[i], nullptr, 10) : otherwise;
  };
  const long long count = number_of(1, 0), from = number_of(3, 0), few = 256;
  const auto seed = static_cast<std::uint64_t>(number_of(2, 0));
  std::atomic<long long> next{from};
  std::vector<Totals> found(static_cast<std::size_t>(number_of(4, 1)));
  const auto work = [&](Totals& totals) {
    for (;;) {
      const long long first = next.fetch_add(few);
      if (first >= from + count) return;
      for (long long i = first; i < std::min(first + few, from + count); ++i)
        compare(seed, i, totals);
    }
  };
  std::vector<std::thread> threads;
  for (Totals& totals : found) threads.emplace_back(work, std::ref(totals));
  for (std::thread& thread : threads) thread.join();
  Totals all;
  for (const Totals& part : found)
    for (std::size_t k = 0; k < names.size(); ++k) {
      all.count[k] += part.count[k];
      all.worst[k] = std::max(all.worst[k], part.worst[k]);
    }
  std::printf("%lld drives of seed %lld from %lld\n", count, number_of(2, 0), from);
  for (std::size_t k = 0; k < names.size(); ++k)
    std::printf("%-14s %6lld  %.1e\n", names[k], all.count[k], all.worst[k]);
  return all.count[unexplained] == 0 ? 0 : 1;
}
