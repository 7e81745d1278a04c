/// Results of a run so far, and their log.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <string>
#include <utility>
#include <vector>

#include "draw.hpp"
#include "judge.hpp"
#include "round_numbers.hpp"

namespace fuzz {

struct Law {
  const char* name;
  double (*residual)(const Verdict&);
};
inline constexpr std::array<Law, 14> laws{{
    {"motion_law", [](const Verdict& v) { return v.certificate.motion_law; }},
    {"kinematics", [](const Verdict& v) { return v.certificate.kinematics; }},
    {"friction_law", [](const Verdict& v) { return v.certificate.friction_law; }},
    {"force_bound", [](const Verdict& v) { return v.certificate.force_bound; }},
    {"sliding_sign", [](const Verdict& v) { return v.certificate.sliding_sign; }},
    {"sticking", [](const Verdict& v) { return v.certificate.sticking; }},
    {"continuity", [](const Verdict& v) { return v.certificate.continuity; }},
    {"transitions", [](const Verdict& v) { return v.certificate.transitions; }},
    {"energy", [](const Verdict& v) { return v.certificate.energy; }},
    {"dissipation", [](const Verdict& v) { return v.certificate.dissipation; }},
    {"period", [](const Verdict& v) { return v.certificate.period; }},
    {"steady_since", [](const Verdict& v) { return v.certificate.steady_since; }},
    {"mirror", [](const Verdict& v) { return v.mirror; }},
    {"cut", [](const Verdict& v) { return v.cut; }},
}};

/// The largest of a number, and the first case that has it.
struct Largest {
  double value{0};
  long long at{-1};

  void meet(Largest other) {
    if (other.value > value || (other.value == value && other.at < at)) *this = other;
  }
};

/// Sums and maxima, independent of the distribution of cases over threads.
struct Totals {
  long long drives{0}, segments{0};
  long long instants{0};      ///< segments of zero length
  long long inconsistent{0};  ///< drives in which no candidate was consistent
  long long beyond_limit{0};  ///< drives with more events than are followed
  Largest most_segments;
  std::array<Largest, laws.size()> worst;
  std::vector<long long> failed;
  double seconds{0};

  void add(long long number, const Verdict& verdict) {
    ++drives;
    const auto count = static_cast<long long>(verdict.segments);
    segments += count;
    instants += static_cast<long long>(verdict.instants);
    inconsistent += verdict.status == pd::Status::inconsistent ? 1 : 0;
    beyond_limit += verdict.beyond_limit() ? 1 : 0;
    most_segments.meet({static_cast<double>(count), number});
    for (std::size_t i = 0; i < laws.size(); ++i)
      worst[i].meet({laws[i].residual(verdict), number});
    if (!verdict.good()) failed.push_back(number);
  }

  void add(const Totals& other) {
    drives += other.drives;
    segments += other.segments;
    instants += other.instants;
    inconsistent += other.inconsistent;
    beyond_limit += other.beyond_limit;
    most_segments.meet(other.most_segments);
    for (std::size_t i = 0; i < laws.size(); ++i) worst[i].meet(other.worst[i]);
    failed.insert(failed.end(), other.failed.begin(), other.failed.end());
    std::sort(failed.begin(), failed.end());
    seconds += other.seconds;
  }
};

inline constexpr std::array<const char*, 10> families{"any",    "aligned",   "oblique", "stops",
                                                      "skin",   "functions", "laws",    "strokes",
                                                      "damped", "round"};

/// The family of a name; false if there is none.
inline bool read(const std::string& name, Family& family) {
  const auto found = std::find(families.begin(), families.end(), name);
  family = static_cast<Family>(found - families.begin());
  return found != families.end();
}

/// Range of the cases of a seed.
struct Range {
  long long count{0}, seed{0}, from{0};
  Family family{Family::any};

  Case at(long long number) const {
    const auto of = static_cast<std::uint64_t>(seed), which = static_cast<std::uint64_t>(number);
    if (family == Family::round) return round_drive_under_functions(of, which);
    return Draw(of, which, family).next();
  }
  friend bool operator==(const Range& a, const Range& b) {
    return a.seed == b.seed && a.from == b.from && a.family == b.family;
  }
};

inline void write(std::ostream& out, const Range& range, const Totals& totals) {
  out << "seed " << range.seed << " from " << range.from << " family "
      << families[static_cast<std::size_t>(range.family)] << '\n'
      << "drives " << totals.drives << " of " << range.count << '\n'
      << "segments " << totals.segments << '\n'
      << "of_zero_length " << totals.instants << '\n'
      << "inconsistent " << totals.inconsistent << '\n'
      << "beyond_event_limit " << totals.beyond_limit << '\n'
      << "most_segments " << totals.most_segments.value << " case " << totals.most_segments.at
      << '\n'
      << "seconds " << totals.seconds << '\n';
  for (std::size_t i = 0; i < laws.size(); ++i)
    out << laws[i].name << ' ' << totals.worst[i].value << " case " << totals.worst[i].at << '\n';
  out << "failed " << totals.failed.size();
  for (const long long number : totals.failed) out << ' ' << number;
  out << '\n';
}

/// False if the text is no such log.
inline bool read(std::istream& in, Range& range, Totals& totals) {
  std::string word, family;
  std::size_t failures = 0;
  in >> word >> range.seed >> word >> range.from >> word >> family >> word >> totals.drives >>
      word >> range.count >> word >> totals.segments >> word >> totals.instants >> word >>
      totals.inconsistent >> word >> totals.beyond_limit >> word >> totals.most_segments.value >>
      word >> totals.most_segments.at >> word >> totals.seconds;
  for (Largest& largest : totals.worst) in >> word >> largest.value >> word >> largest.at;
  in >> word >> failures;
  for (long long number = 0; failures > 0 && in >> number; --failures)
    totals.failed.push_back(number);
  return in && read(family, range.family);
}

/// Replaces the log whole, so that it is never half-written.
inline bool save(const std::string& path, const Range& range, const Totals& totals) {
  const std::string beside = path + ".new";
  {
    std::ofstream out(beside);
    out << std::setprecision(17);
    write(out, range, totals);
    if (!out.flush()) return false;
  }
  return std::rename(beside.c_str(), path.c_str()) == 0;
}

}  // namespace fuzz
