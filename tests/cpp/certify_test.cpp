// The certificate objects: a motion in which one thing has been made wrong breaks the law of that
// thing, and the motion as it was breaks none.
#include "pindrive/certificate/certify.hpp"

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;

using Drive = pd::Drive<double>;
using Segments = std::vector<pd::Segment<double>>;
using Certificate = pd::Certificate<double>;

namespace {

/// The example of examples/tactile-mouse.toml: slides, crosses, is carried, comes to rest.
const Drive drive{0.010, 100.0, 0.32, {0.022, 0.0265}, {0.005, 0.0075}};
const pd::Inputs<double> inputs{pd::Profile<double>(0.06), 2e-3, 0.06};  // NOLINT: cannot throw

/// Swings freely for three whole periods, from x = 0 to x = 0.
double free_swing() {
  const Drive free{0.010, 100.0, 0.0, {}, {}};
  const double duration = 6 * 3.14159265358979323846 / 100;
  const pd::Inputs<double> kicked{pd::Profile<double>(0.0), 0.0, 0.25, duration};
  Segments segments;
  const auto outcome = pd::simulate(
      free, kicked, [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
  const pd::Motion<double> motion(free, kicked, segments.data(), segments.size(), outcome);
  return pd::Certifier<double>(motion, duration).certify().worst();
}

Certificate certificate(const std::function<void(Segments&, Drive&)>& spoil) {
  Segments segments;
  const auto outcome = pd::simulate(
      drive, inputs, [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
  Drive judged = drive;
  spoil(segments, judged);
  const pd::Motion<double> motion(judged, inputs, segments.data(), segments.size(), outcome);
  return pd::Certifier<double>(motion, 0.2).certify();
}

struct Wrong {
  const char* what;
  double Certificate::* law;
  std::function<void(Segments&, Drive&)> spoil;
};

}  // namespace

int main() {
  const std::vector<Wrong> wrongs{
      {"mass", &Certificate::motion_law, [](Segments&, Drive& d) { d.mass *= 1.01; }},
      {"position", &Certificate::kinematics,
       [](Segments& s, Drive&) { s[1].flow.position.slope += 1e-3; }},
      {"held by too little", &Certificate::force_bound,
       [](Segments&, Drive& d) { d.plate.static_limit = d.plate.kinetic; }},
      {"slides the other way", &Certificate::sliding_sign,
       [](Segments& s, Drive&) { s[1].mode.finger = pd::ContactState::slip_forward; }},
      {"an event late", &Certificate::sliding_sign,
       [](Segments& s, Drive&) { s[1].end = s[2].begin += 1e-3; }},
      {"stuck while it slides", &Certificate::sticking,
       [](Segments& s, Drive&) { s[1].mode.finger = pd::ContactState::stick; }},
      {"a jump", &Certificate::continuity,
       [](Segments& s, Drive&) { s[2].flow.position.start += 1e-5; }},
      {"crosses where it could hold", &Certificate::transitions,
       [](Segments&, Drive& d) { d.finger.static_limit = 10.0; }},
      {"damping", &Certificate::energy, [](Segments&, Drive& d) { d.damping *= 1.01; }},
      {"a damper that drives", &Certificate::dissipation,
       [](Segments&, Drive& d) { d.damping *= -1.0; }},
  };
  int failures = 0;
  const auto expect = [&](bool good, const std::string& what, double residual) {
    std::printf("%s %-28s %.1e\n", good ? "ok  " : "FAIL", what.c_str(), residual);
    if (!good) ++failures;
  };
  const double clean = certificate([](Segments&, Drive&) {}).worst();
  expect(clean < 1e-14, "as simulated", clean);
  expect(free_swing() < 1e-14, "whole periods from nothing", free_swing());
  for (const Wrong& wrong : wrongs) {
    const Certificate found = certificate(wrong.spoil);
    expect(found.*wrong.law > 1e-4, wrong.what, found.*wrong.law);
    expect(found.worst() >= found.*wrong.law, "... and the worst", found.worst());
  }
  return failures == 0 ? 0 : 1;
}
