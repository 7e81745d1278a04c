// Falling friction that cancels the damper, or the critical amount of it, in round numbers: rounding
// decides neither how a motion ends nor how much work it is.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <type_traits>
#include <vector>

#include "pindrive/certificate/certify.hpp"
#include "pindrive/motion/batch.hpp"

namespace {

/// A number that counts how often a damped wave is evaluated.
struct Counted {
  double value{0};
  static inline long long waves{0};

  constexpr Counted() = default;
  template <class N, class = std::enable_if_t<std::is_arithmetic_v<N>>>
  constexpr Counted(N number) : value(static_cast<double>(number)) {}  // NOLINT

  friend constexpr Counted operator-(Counted a) { return -a.value; }
  friend constexpr Counted operator+(Counted a, Counted b) { return a.value + b.value; }
  friend constexpr Counted operator-(Counted a, Counted b) { return a.value - b.value; }
  friend constexpr Counted operator*(Counted a, Counted b) { return a.value * b.value; }
  friend constexpr Counted operator/(Counted a, Counted b) { return a.value / b.value; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  friend constexpr bool operator==(Counted a, Counted b) { return a.value == b.value; }
  friend constexpr bool operator!=(Counted a, Counted b) { return a.value != b.value; }
  friend constexpr bool operator<(Counted a, Counted b) { return a.value < b.value; }
  friend constexpr bool operator>(Counted a, Counted b) { return a.value > b.value; }
  friend constexpr bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
  friend constexpr bool operator>=(Counted a, Counted b) { return a.value >= b.value; }

  friend double plain(Counted a) { return a.value; }
  friend bool isfinite(Counted a) { return std::isfinite(a.value); }
  friend bool isnan(Counted a) { return std::isnan(a.value); }
  friend Counted floor(Counted a) { return std::floor(a.value); }
  friend Counted abs(Counted a) { return std::abs(a.value); }
  friend Counted sqrt(Counted a) { return std::sqrt(a.value); }
  friend Counted hypot(Counted a, Counted b) { return std::hypot(a.value, b.value); }
  friend Counted exp(Counted a) { return ++waves, std::exp(a.value); }
  friend Counted expm1(Counted a) { return ++waves, std::expm1(a.value); }
  friend Counted log(Counted a) { return std::log(a.value); }
  friend Counted log1p(Counted a) { return std::log1p(a.value); }
  friend Counted sin(Counted a) { return std::sin(a.value); }
  friend Counted cos(Counted a) { return std::cos(a.value); }
  friend Counted atan2(Counted y, Counted x) { return std::atan2(y.value, x.value); }
};

}  // namespace

namespace std {
template <>
struct numeric_limits<Counted> : numeric_limits<double> {
  static constexpr Counted infinity() noexcept { return numeric_limits<double>::infinity(); }
  static constexpr Counted quiet_NaN() noexcept { return numeric_limits<double>::quiet_NaN(); }
  static constexpr Counted epsilon() noexcept { return numeric_limits<double>::epsilon(); }
};
}  // namespace std

namespace pd = pindrive;

namespace {

struct Setting {
  double mass, stiffness, damping, slope, finger, mouse_velocity;
};

/// The ending of a release on a plate whose friction falls from 20 mN along the slope.
template <class T>
struct Run {
  pd::Summary<T> summary;
  std::vector<pd::Segment<T>> segments;
  T residual{0};  ///< the largest of the certificate

  explicit Run(const Setting& s) {
    const double to = std::min(0.03, 0.01 / s.slope);
    const T speeds[] = {0, to}, forces[] = {0.02, 0.02 - s.slope * to};
    pd::Branch<T> branches[3];
    pd::Drive<T> drive{s.mass, s.stiffness, s.damping, {}, {}};
    drive.plate.kinetic = drive.plate.static_limit = forces[0];
    drive.plate.curve = branches;
    drive.plate.branches = pd::branches_of(speeds, forces, 2, branches);
    drive.finger.kinetic = drive.finger.static_limit = s.finger;
    const pd::Inputs<T> inputs{T(s.mouse_velocity), 2e-3, s.mouse_velocity};
    summary = pd::summarise(drive, inputs, T(0.05), segments);
    if constexpr (std::is_same_v<T, double>) {
      const pd::Motion<T> motion(drive, inputs, segments.data(), segments.size(), summary.outcome);
      residual = pd::Certifier<T>(motion, summary.duration).certify().worst();
    }
  }
};

/// Friction falls by as much as the damper rises: no pin of whatever mass and spring is damped or
/// driven in between, so a pin under no finger swings for ever as it first can without touching
/// anything, one under a finger comes to rest.
int cancelled() {
  int failures = 0, drives = 0;
  for (const double damping : {0.1, 0.2})
    for (const double finger : {0.0, 2e-3})
      for (const double mouse_velocity : {0.01, 0.02, 0.03})
        for (const double mass : {2e-3, 3e-3, 5e-3, 7e-3, 10e-3, 20e-3, 30e-3, 40e-3})
          for (const double stiffness : {25., 50., 100., 150., 200., 300., 500., 700., 1000.}) {
            const Setting s{mass, stiffness, damping, damping, finger, mouse_velocity};
            const Run<double> run(s);
            const pd::Transient<double>& transient = run.summary.transient;
            const pd::Outcome<double>& outcome = run.summary.outcome;
            const auto expected = finger > 0 ? pd::End::resting : pd::End::grazing;
            const double omega = std::sqrt(stiffness / mass);
            const bool swings =
                finger > 0 ||
                (std::abs(transient.steady.amplitude * omega / mouse_velocity - 1) < 1e-12 &&
                 transient.settling_time < 1e3 / omega);
            ++drives;
            if (outcome.end == expected && swings && run.residual < 1e-12) continue;
            ++failures;
            std::printf("cancelled: m %g k %g b %g finger %g v_p %g: end %d, residual %.2g\n", mass,
                        stiffness, damping, finger, mouse_velocity, static_cast<int>(outcome.end),
                        run.residual);
          }
  std::printf("%d drives whose friction cancels the damper, %d failures\n", drives, failures);
  return failures;
}

/// Friction falls by the critical amount, and by a little more or less: the work for a segment does not
/// depend on how near to critical the growing wave is.
int critical() {
  long long most = 0;
  int drives = 0;
  for (const double off :
       {0., 1e-16, -1e-16, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8, 1e-4, -1e-4})
    for (const double part : {0.1, 0.3, 1.})
      for (const double mass : {1e-3, 2e-3, 4e-3, 10e-3, 40e-3})
        for (const double stiffness : {25., 100., 250., 400.}) {
          const double twice = 2 * std::sqrt(mass * stiffness), damping = part * twice;
          const Setting s{mass, stiffness, damping, (damping + twice) * (1 + off), 0, 0.06};
          Counted::waves = 0;
          const Run<Counted> run(s);
          most = std::max(most, Counted::waves / static_cast<long long>(run.segments.size()));
          ++drives;
        }
  std::printf(
      "%d drives whose friction falls by the critical amount: at most %lld waves a segment\n",
      drives, most);
  return most < 200 ? 0 : 1;
}

/// Friction falls by a little more or less than the damper rises, under a hand that speeds up for hours:
/// a wave that hardly grows or decays, on a line, for a million periods.
int ramp() {
  long long most = 0;
  for (const double off : {1e-6, 1e-8, 1e-10, 0., -1e-10, -1e-8, -1e-6}) {
    const Counted times[] = {0, 1e4}, velocities[] = {0.05, 0.055};
    const Counted speeds[] = {0, 0.1}, forces[] = {0.02, 0.02 - 0.1 * (1 + off) * 0.1};
    pd::Branch<Counted> branches[3];
    pd::Drive<Counted> drive{0.01, 100, 0.1, {}, {}};
    drive.plate.kinetic = drive.plate.static_limit = forces[0];
    drive.plate.curve = branches;
    drive.plate.branches = pd::branches_of(speeds, forces, 2, branches);
    const pd::Inputs<Counted> inputs{{times, velocities, 2}, 1e-4, 0.02};
    std::vector<pd::Segment<Counted>> segments;
    Counted::waves = 0;
    pd::simulate(drive, inputs, [&](const auto& segment) { segments.push_back(segment); });
    most = std::max(most, Counted::waves / static_cast<long long>(segments.size()));
  }
  std::printf("a million periods on a ramp: at most %lld waves a segment\n", most);
  return most < 2000 ? 0 : 1;
}

}  // namespace

int main() { return cancelled() + critical() + ramp() == 0 ? 0 : 1; }
