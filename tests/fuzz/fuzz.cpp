// fuzz COUNT SEED      draws drives and inputs over many decades, runs each and judges it by certify
// fuzz --replay FILE…  judges the drives written in these files
//
// A motion that fails is written to fuzz-SEED-CASE.txt, to be replayed and kept in tests/hard.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "pindrive/certify.hpp"
#include "pindrive/simulate.hpp"

namespace pd = pindrive;

namespace {

constexpr double largest_residual = 1e-9;
constexpr double never = std::numeric_limits<double>::infinity();

struct Rows {
  std::vector<double> at, value;
};

/// A drive and its inputs, owned.
struct Case {
  double mass{}, stiffness{}, damping{};
  std::array<double, 2> limit{};    ///< static friction of plate and finger
  std::array<Rows, 2> curve;        ///< kinetic friction over speed; one row is Coulomb
  double skin{never};               ///< stiffness of the finger
  Rows mouse_velocity, plate_load;  ///< over time; one row is a constant
  double displacement{}, velocity{}, duration{};
};

void write(std::ostream& out, const Case& c) {
  const auto rows = [&](const char* name, const Rows& r) {
    out << name << ' ' << r.at.size();
    for (std::size_t i = 0; i < r.at.size(); ++i) out << "  " << r.at[i] << ' ' << r.value[i];
    out << '\n';
  };
  out << std::setprecision(17) << "drive " << c.mass << ' ' << c.stiffness << ' ' << c.damping
      << '\n';
  out << "static " << c.limit[0] << ' ' << c.limit[1] << '\n';
  rows("plate", c.curve[0]);
  rows("finger", c.curve[1]);
  out << "skin " << (std::isinf(c.skin) ? 0.0 : c.skin) << '\n';
  rows("mouse_velocity", c.mouse_velocity);
  rows("plate_load", c.plate_load);
  out << "start " << c.displacement << ' ' << c.velocity << ' ' << c.duration << '\n';
}

bool read(std::istream& in, Case& c) {
  std::string name;
  const auto rows = [&](Rows& r) {
    std::size_t count = 0;
    in >> name >> count;
    r.at.resize(count);
    r.value.resize(count);
    for (std::size_t i = 0; i < count; ++i) in >> r.at[i] >> r.value[i];
  };
  in >> name >> c.mass >> c.stiffness >> c.damping >> name >> c.limit[0] >> c.limit[1];
  rows(c.curve[0]);
  rows(c.curve[1]);
  in >> name >> c.skin;
  if (c.skin == 0) c.skin = never;
  rows(c.mouse_velocity);
  rows(c.plate_load);
  in >> name >> c.displacement >> c.velocity >> c.duration;
  return static_cast<bool>(in);
}

// ---- drawing -------------------------------------------------------------------------------------

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  Case next() {
    Case c;
    round_ = chance(0.25);
    const double omega = decade(0.5, 3.5), length = decade(-4, -2);
    c.mass = decade(-4, -1);
    c.stiffness = c.mass * omega * omega;
    const double critical = 2 * c.mass * omega;
    const double pick = uniform(0, 1);
    c.damping = pick < 0.15   ? 0
                : pick < 0.7  ? critical * decade(-4, 0)
                : pick < 0.85 ? critical * (1 + (chance(0.5) ? 1 : -1) * decade(-15, -2))
                              : critical * decade(0, 1.7);
    force_ = c.stiffness * length;
    speed_ = omega * length * decade(-1.5, 0.5);
    period_ = 6.3 / omega;
    for (int i = 0; i < 2; ++i) {
      c.curve[i] = curve();
      c.limit[i] = c.curve[i].value[0] * (chance(0.5) ? 1 : tidy(uniform(1, 2.5)));
    }
    const bool coulomb = c.curve[1].at.size() == 1 && c.curve[1].value[0] > 0;
    if (coulomb && chance(0.6)) c.skin = c.stiffness * decade(0, 6);
    double last = 0;
    c.mouse_velocity =
        profile([&] { return chance(0.3) ? 0 : tidy(speed_ * uniform(-1, 1)); }, last);
    c.plate_load = {{0}, {1}};
    if (c.curve[0].at.size() == 1 && chance(0.4))
      c.plate_load = profile([&] { return chance(0.3) ? 0 : tidy(uniform(0, 2)); }, last);
    c.displacement = chance(0.1) ? 0 : tidy(length * uniform(-1, 1));
    c.velocity = chance(0.6)   ? c.mouse_velocity.value[0]
                 : chance(0.3) ? 0
                               : speed_ * uniform(-2, 2);
    c.duration = last + period_ * uniform(0.5, 12);
    return c;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double p) { return uniform(0, 1) < p; }
  double decade(double low, double high) { return tidy(std::pow(10, uniform(low, high))); }
  /// Now and then few digits, so that things coincide.
  double tidy(double value) const {
    if (!round_ || value == 0) return value;
    const double unit = std::pow(10, std::floor(std::log10(std::abs(value))));
    return std::round(value / unit) * unit;
  }

  Rows curve() {
    Rows rows{{0}, {chance(0.15) ? 0 : force_ * decade(-2.5, 0.3)}};
    if (chance(0.65)) return rows;
    const int more = static_cast<int>(uniform(1, 4));
    for (int i = 0; i < more; ++i) {
      rows.at.push_back(rows.at.back() + tidy(speed_ * decade(-1.5, 0.3)));
      rows.value.push_back(tidy(force_ * decade(-2.5, 0)));
    }
    return rows;
  }

  template <class Value>
  Rows profile(Value&& value, double& last) {
    Rows rows{{0}, {value()}};
    if (chance(0.4)) return rows;
    const int more = static_cast<int>(uniform(1, 6));
    for (int i = 0; i < more; ++i) {
      rows.at.push_back(rows.at.back() + tidy(period_ * decade(-1.5, 0.7)));
      rows.value.push_back(chance(0.25) ? rows.value.back() : value());
    }
    last = std::max(last, rows.at.back());
    return rows;
  }

  std::mt19937_64 random_;
  bool round_{false};
  double force_{}, speed_{}, period_{};
};

// ---- judging -------------------------------------------------------------------------------------

/// The rows of a curve as regions; the last slope goes on until the force is zero.
std::vector<pd::Region<double>> regions(const Rows& rows) {
  std::vector<pd::Region<double>> all;
  if (rows.at.size() == 1) return all;
  double slope = 0;
  for (std::size_t i = 0; i + 1 < rows.at.size(); ++i) {
    slope = (rows.value[i + 1] - rows.value[i]) / (rows.at[i + 1] - rows.at[i]);
    all.push_back({rows.at[i], rows.at[i + 1], rows.value[i], slope});
  }
  double from = rows.at.back(), force = rows.value.back();
  if (slope < 0) {
    if (force > 0) {
      const double zero = from - force / slope;
      all.push_back({from, zero, force, slope});
      from = zero;
    }
    force = slope = 0;
  }
  all.push_back({from, never, force, slope});
  return all;
}

struct Verdict {
  pd::Certificate<double> certificate;
  pd::Status status{};
  std::size_t segments{};

  bool good() const { return status == pd::Status::ok && certificate.worst() <= largest_residual; }
};

Verdict judge(const Case& c, std::vector<pd::Segment<double>>& segments) {
  const auto plate = regions(c.curve[0]), finger = regions(c.curve[1]);
  const pd::Drive<double> drive{
      c.mass,
      c.stiffness,
      c.damping,
      {c.curve[0].value[0], c.limit[0], never, plate.data(), static_cast<int>(plate.size())},
      {c.curve[1].value[0], c.limit[1], c.skin, finger.data(), static_cast<int>(finger.size())}};
  const auto profile = [](const Rows& rows) {
    return rows.at.size() == 1
               ? pd::Profile<double>(rows.value[0])
               : pd::Profile<double>(rows.at.data(), rows.value.data(), rows.at.size());
  };
  const pd::Inputs<double> inputs{profile(c.mouse_velocity), c.displacement, c.velocity, c.duration,
                                  profile(c.plate_load)};
  segments.clear();
  const auto outcome = pd::simulate(
      drive, inputs, [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
  const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
  if (outcome.status != pd::Status::ok) return {{}, outcome.status, segments.size()};
  pd::Certifier<double> certifier(motion, c.duration);
  return {certifier.certify(), outcome.status, segments.size()};
}

void print(const char* name, const Verdict& verdict) {
  const auto& r = verdict.certificate;
  std::printf(
      "%s: status %d, %zu segments; law %.1e kinematics %.1e friction %.1e bound %.1e "
      "sign %.1e sticking %.1e continuity %.1e transitions %.1e energy %.1e dissipation %.1e\n",
      name, static_cast<int>(verdict.status), verdict.segments, r.motion_law, r.kinematics,
      r.friction_law, r.force_bound, r.sliding_sign, r.sticking, r.continuity, r.transitions,
      r.energy, r.dissipation);
}

int replay(int count, char** files) {
  std::vector<pd::Segment<double>> segments;
  int bad = 0;
  for (int i = 0; i < count; ++i) {
    std::ifstream file(files[i]);
    Case c;
    if (!read(file, c)) {
      std::fprintf(stderr, "%s: cannot be read as a drive\n", files[i]);
      return 2;
    }
    const Verdict verdict = judge(c, segments);
    print(files[i], verdict);
    bad += verdict.good() ? 0 : 1;
  }
  std::printf("%d drives replayed, %d failed\n", count, bad);
  return bad == 0 ? 0 : 1;
}

int fuzz(long long count, std::uint64_t seed) {
  std::vector<pd::Segment<double>> segments;
  Verdict worst;
  long long bad = 0, all_segments = 0;
  for (long long i = 0; i < count; ++i) {
    // Each case has its own generator, so that any of them can be drawn again alone.
    const Case c = Draw(seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(i)).next();
    const Verdict verdict = judge(c, segments);
    all_segments += static_cast<long long>(verdict.segments);
    const auto raise = [](double& most, double value) { most = std::max(most, value); };
    raise(worst.certificate.motion_law, verdict.certificate.motion_law);
    raise(worst.certificate.kinematics, verdict.certificate.kinematics);
    raise(worst.certificate.friction_law, verdict.certificate.friction_law);
    raise(worst.certificate.force_bound, verdict.certificate.force_bound);
    raise(worst.certificate.sliding_sign, verdict.certificate.sliding_sign);
    raise(worst.certificate.sticking, verdict.certificate.sticking);
    raise(worst.certificate.continuity, verdict.certificate.continuity);
    raise(worst.certificate.transitions, verdict.certificate.transitions);
    raise(worst.certificate.energy, verdict.certificate.energy);
    raise(worst.certificate.dissipation, verdict.certificate.dissipation);
    worst.segments = std::max(worst.segments, verdict.segments);
    if (verdict.good()) continue;
    if (++bad > 20) continue;
    const std::string name = "fuzz-" + std::to_string(seed) + "-" + std::to_string(i) + ".txt";
    std::ofstream file(name);
    write(file, c);
    print(name.c_str(), verdict);
  }
  print("worst", worst);
  std::printf("%lld drives (seed %llu), %lld segments, %lld failed\n", count,
              static_cast<unsigned long long>(seed), all_segments, bad);
  return bad == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2 && std::strcmp(argv[1], "--replay") == 0) return replay(argc - 2, argv + 2);
  if (argc == 3)
    return fuzz(std::strtoll(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10));
  std::fprintf(stderr, "usage: fuzz COUNT SEED | fuzz --replay FILE...\n");
  return 2;
}
