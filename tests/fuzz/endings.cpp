// Compares the endings of drives with round numbers in other units, mirrored and with a later end.
//
//   endings COUNT SEED [FROM]     reports each drive whose ending, settling time or status differs
//   endings --cycles COUNT SEED [FROM]    finds the cycles of self-excited drives anew, by sampling
//   endings --write COUNT SEED    writes the drives, as case.hpp reads them
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

#include "judge.hpp"
#include "pindrive/motion/duration.hpp"
#include "pindrive/motion/transient.hpp"
#include "round_numbers.hpp"

namespace {

using namespace fuzz;

/// Ending of a motion, in the units of the drive that it is compared with.
struct Ending {
  pd::Status status{};
  pd::End end{};
  double settling{}, shown{}, until{};
  std::size_t segments{};
};

Ending ending(const Case& c, double time) {
  const Given given(c);
  std::vector<pd::Segment<double>> segments;
  const auto outcome = run(given, segments);
  Ending found{outcome.status, outcome.end, std::nan(""), 0, outcome.until / time, segments.size()};
  if (outcome.status != pd::Status::ok) return found;
  const pd::Motion<double> motion(given.drive, given.inputs, segments.data(), segments.size(),
                                  outcome);
  found.shown = pd::duration_of(motion, pd::settling_band) / time;
  const pd::Measurement<double> measured(motion, c.duration);
  found.settling = measured.settling_time(pd::settling_band) / time;
  return found;
}

bool same(const Ending& one, const Ending& other) {
  if (one.status != other.status || one.end != other.end) return false;
  if (std::isnan(one.settling) || std::isnan(other.settling))
    return std::isnan(one.settling) == std::isnan(other.settling);
  return std::abs(one.settling - other.settling) <= 1e-6 * one.shown;
}

struct Variant {
  const char* name;
  double force, length, time;
};
constexpr Variant variants[] = {{"forces x 10", 10, 1, 1},
                                {"lengths x 7", 1, 7, 1},
                                {"times x 3", 1, 1, 3},
                                {"other units", 0.1, 3, 7}};

void print(const char* name, const Ending& e) {
  std::printf("  %-14s status %d, end %d, settled %.9g, until %.6g, %zu segments\n", name,
              static_cast<int>(e.status), static_cast<int>(e.end), e.settling, e.until, e.segments);
}

bool judged(std::uint64_t seed, std::uint64_t number, std::uint64_t& given_up) {
  const Case c = round_drive(seed, number);
  const Ending first = ending(c, 1);
  bool good = true;
  given_up += first.status != pd::Status::ok;
  std::vector<std::pair<const char*, Ending>> others;
  for (const Variant& v : variants)
    others.emplace_back(v.name, ending(in_units(c, v.force, v.length, v.time), v.time));
  others.emplace_back("mirrored", ending(mirror(c), 1));
  Case later = c;
  later.duration = 2 * std::max(first.shown, std::isinf(first.until) ? 0 : first.until);
  if (first.status == pd::Status::ok) others.emplace_back("with an end", ending(later, 1));
  for (const auto& other : others) good = good && same(first, other.second);
  if (good) return true;
  std::printf("%llu:", static_cast<unsigned long long>(number));
  for (const std::size_t feature : features_of(number)) std::printf(" %s,", features[feature].name);
  std::printf("\n");
  print("", first);
  for (const auto& [name, other] : others)
    if (!same(first, other) || other.status != pd::Status::ok) print(name, other);
  std::fflush(stdout);
  return false;
}

// ---- cycles ----------------------------------------------------------------------------------------

struct Cycles {
  int none{}, other{}, late_found{}, early{}, late{}, cycles{};
};

void judge_cycle(std::uint64_t seed, std::uint64_t number, Cycles& found) {
  const Case c = self_excited_drive(seed, number);
  const Given given(c);
  std::vector<pd::Segment<double>> segments;
  const auto outcome = run(given, segments);
  const pd::Motion<double> motion(given.drive, given.inputs, segments.data(), segments.size(),
                                  outcome);
  const auto name = [&](const char* what) {
    std::printf("%llu: %s, status %d, end %d, until %.6g, %zu segments",
                static_cast<unsigned long long>(number), what, static_cast<int>(outcome.status),
                static_cast<int>(outcome.end), outcome.until, segments.size());
  };
  if (outcome.status != pd::Status::ok) {
    ++found.none;
    name("given up");
    std::printf("\n");
  } else if (!outcome.cycles()) {
    ++found.other;
  } else {
    ++found.cycles;
    const double since = pd::steady_since(motion), period = outcome.period;
    const pd::detail::PeriodSamples<double> samples(motion);
    const double begin = samples.begin(1e-8), after = since + 2 * samples.step();
    const bool early = begin > after && samples.begin(3e-8) > after;
    // Sampling sees a difference between two events where the motion itself changes at these only.
    const bool late = begin < since - period;
    const double rounds = (outcome.until - begin) / period;
    found.early += early;
    found.late += late;
    found.late_found += rounds > 30;
    if (!early && !late && !(rounds > 30)) return;
    name(early ? "early" : late ? "late" : "found late");
    std::printf(", since %.9g, by sampling %.9g, period %.6g, %.1f rounds\n", since, begin, period,
                rounds);
  }
}

int judge_cycles(std::uint64_t count, std::uint64_t seed, std::uint64_t from) {
  Cycles found;
  for (std::uint64_t i = from; i < from + count; ++i) judge_cycle(seed, i, found);
  std::printf(
      "%d cycles, %d other endings, %d given up; %d found after more than 30 periods, %d early, %d "
      "late\n",
      found.cycles, found.other, found.none, found.late_found, found.early, found.late);
  return found.none > 0 || found.early > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const bool writes = argc == 4 && std::strcmp(argv[1], "--write") == 0;
  const bool cycles = argc > 3 && std::strcmp(argv[1], "--cycles") == 0;
  if (argc < 3) {
    std::fprintf(stderr, "usage: endings [--write] COUNT SEED [FROM]\n");
    return 2;
  }
  const auto number = [&](int i) { return std::strtoull(argv[i], nullptr, 10); };
  if (writes) {
    for (std::uint64_t i = 0; i < number(2); ++i) write(std::cout, round_drive(number(3), i));
    return 0;
  }
  if (cycles) return judge_cycles(number(2), number(3), argc > 4 ? number(4) : 0);
  const std::uint64_t count = number(1), seed = number(2), from = argc > 3 ? number(3) : 0;
  std::uint64_t differ = 0, given_up = 0;
  for (std::uint64_t i = from; i < from + count; ++i) differ += judged(seed, i, given_up) ? 0 : 1;
  std::printf("%llu of %llu drives differ, %llu were given up\n",
              static_cast<unsigned long long>(differ), static_cast<unsigned long long>(count),
              static_cast<unsigned long long>(given_up));
  return 1000 * differ > count ? 1 : 0;
}
