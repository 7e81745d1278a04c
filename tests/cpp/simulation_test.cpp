// The selection of the next mode: two surfaces that part against the one solution of the force law,
// whichever of them is called the plate; no mode that lasts no time; and three drives on which a
// selection from history went wrong.
#include "pindrive/events/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "../fuzz/draw.hpp"
#include "../fuzz/judge.hpp"
#include "cases.hpp"

#ifndef PINDRIVE_HARD
#define PINDRIVE_HARD "tests/hard"  // from the root
#endif

namespace pd = pindrive;

namespace {

using Segments = std::vector<pd::Segment<double>>;

int failures = 0;

void expect(bool good, const std::string& what) {
  std::printf("%s %s\n", good ? "ok  " : "FAIL", what.c_str());
  failures += good ? 0 : 1;
}

/// A pin at rest at x on plate and finger, both at rest; the plate sets off with acceleration w.
pd::Segment<double> first_mode(double mass, double stiffness, pd::Contact<double> plate,
                               pd::Contact<double> finger, double w, double x) {
  const double times[] = {0, 1}, velocities[] = {0, w};
  const pd::Drive<double> drive{mass, stiffness, 0, plate, finger};
  const pd::Inputs<double> inputs{pd::Profile<double>(times, velocities, 2), x, 0, 1e-9};
  Segments segments;
  pd::simulate(drive, inputs, [&](const auto& segment) { segments.push_back(segment); });
  return segments.front();
}

double acceleration(const pd::Segment<double>& segment) {
  return segment.flow.velocity.slope + segment.flow.velocity.drift;
}

/// m a in f − F_p Sgn(a − w) − F_f Sgn(a) has one solution, where it crosses zero: the middle of five.
void parting_surfaces() {
  std::mt19937_64 random(298);
  const auto one_of = [&](std::initializer_list<double> list) {
    return list.begin()[random() % list.size()];
  };
  double worst = 0, swapped_off = 0;
  int ties = 0;
  for (int i = 0; i < cases(100'000); ++i) {
    // In small whole numbers and halves, so that limits are met exactly in a good part of them.
    const double mass = one_of({1, 2}), stiffness = one_of({1, 4}),
                 w = one_of({-2, -1, -0.5, 0.5, 1, 2});
    const double at_plate = one_of({0.5, 1, 1.5, 2}), at_finger = one_of({0.5, 1, 2.5});
    const double x = one_of({-4, -3, -2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5, 2, 3}) / stiffness;
    const pd::Contact<double> plate{at_plate, at_plate}, finger{at_finger, at_finger};
    const double f = mass * w - stiffness * x, e = w > 0 ? 1 : -1;
    double candidates[] = {(f + at_plate + at_finger) / mass, (f - at_plate - at_finger) / mass,
                           (f + e * (at_plate - at_finger)) / mass, 0, w};
    std::sort(candidates, candidates + 5);
    const double a = acceleration(first_mode(mass, stiffness, plate, finger, w, x));
    worst = std::max(worst, std::abs(a - candidates[2]));
    ties += candidates[2] == candidates[1] || candidates[2] == candidates[3] ? 1 : 0;
    // The same seen from the plate: the finger sets off with −w.
    const double b =
        acceleration(first_mode(mass, stiffness, finger, plate, -w, x - mass * w / stiffness));
    swapped_off = std::max(swapped_off, std::abs(a - w - b));
  }
  expect(worst == 0, "parting surfaces: the one solution, " + std::to_string(ties) + " at a limit");
  expect(ties > cases(10'000), "... of which many are at a limit");
  expect(swapped_off == 0, "... whichever of the two is called the plate");
}

void no_mode_without_time() {
  std::size_t instants = 0, stopped = 0;
  Segments segments;
  for (int number = 0; number < cases(100'000); ++number) {
    const auto verdict = fuzz::simulated(fuzz::Draw(1, number).next(), segments);
    instants += verdict.instants;
    stopped += verdict.status != pd::Status::ok ? 1 : 0;
  }
  expect(stopped == 0, "random drives: in each a mode is consistent at every instant");
  // Skin of one drive vibrates faster than the resolution of the time.
  expect(instants <= 8, "... and " + std::to_string(instants) + " modes last no time");
}

/// At rest on the finger while the plate passes at the speed of a breakpoint of its curve, with next to
/// no force: every mode is tied.
void tied_at_rest() {
  const double speeds[] = {0, 0.05, 0.1}, at_plate[] = {0.1, 0.2, 0.05},
               at_finger[] = {0, 0.01, 0.02};
  pd::Branch<double> plate[4], finger[4];
  const int in_plate = pd::branches_of(speeds, at_plate, 3, plate);
  const int in_finger = pd::branches_of(speeds, at_finger, 3, finger);
  int stopped = 0, instants = 0;
  for (const double limit : {0.0, 1e-23, 1e-17, 0.01})
    for (const double force : {0.0, 1e-23, -1e-23, 1e-18, -1e-18, 3e-17, -3e-17, 1e-15, -1e-15})
      for (const double v_p : {0.05, -0.05}) {
        const pd::Drive<double> drive{0.01, 1.0, 0.1, {0.1, 0.1}, {limit, limit}};
        pd::Drive<double> curved = drive;
        curved.plate.curve = plate;
        curved.plate.branches = in_plate;
        if (limit == 0) curved.finger.curve = finger, curved.finger.branches = in_finger;
        const pd::Inputs<double> inputs{v_p, (v_p > 0 ? 0.2 : -0.2) + force, 0.0, 1.0};
        const auto outcome = pd::simulate(curved, inputs, [&](const auto& segment) {
          instants += segment.end > segment.begin ? 0 : 1;
        });
        stopped += outcome.status == pd::Status::ok ? 0 : 1;
      }
  expect(stopped == 0, "at rest with every mode tied and forces down to 1e-23: one is consistent");
  expect(instants == 0, "... and lasts");
}

Segments hard(const std::string& name) {
  std::ifstream file(std::string(PINDRIVE_HARD) + "/" + name + ".txt");
  fuzz::Case c;
  Segments segments;
  if (fuzz::read(file, c)) fuzz::simulated(c, segments);
  return segments;
}

void hard_drives() {
  using pd::ContactState;
  const auto starts = [](const Segments& s, ContactState plate, ContactState finger) {
    return !s.empty() && s[0].end > 0 && s[0].mode.plate == plate && s[0].mode.finger == finger;
  };
  expect(starts(hard("plate-at-stick-limit-at-mouse-start"), ContactState::slip_forward,
                ContactState::stick),
         "the plate, at its limit, would hold for no time: the finger holds");
  expect(starts(hard("finger-stick-with-inadmissible-plate-stick"), ContactState::slip_backward,
                ContactState::stick),
         "the finger can hold where the plate cannot");
  const Segments turns = hard("skin-turn-at-stick-limit-within-rounding");
  expect(turns.size() > 10 && std::none_of(turns.begin() + 1, turns.end(),
                                           [](const auto& s) {
                                             return is_slip(s.mode.finger) &&
                                                    s.end - s.begin < 1e-6 && s.begin > 1.5;
                                           }),
         "skin whose vibration reaches its limit by rounding turns there");
  const Segments row = hard("finger-at-stick-limit-under-load-falling-to-breakpoint");
  expect(!row.empty() && std::all_of(row.begin(), row.end(),
                                     [](const auto& s) {
                                       return s.mode.finger == ContactState::stick &&
                                              s.end > s.begin;
                                     }),
         "what a load that falls to its row would break loose to rounding holds on there");
  const Segments rest = hard("finger-at-stick-limit-by-rest-criterion");
  expect(std::any_of(rest.begin(), rest.end(),
                     [](const auto& s) {
                       return s.begin == 0.6000000000000001 && s.end > s.begin &&
                              s.mode.finger == ContactState::stick;
                     }),
         "a pin at rest by the rest criterion has its stick force within its limit");
  const Segments instant = hard("finger-breakaway-at-curve-point-under-rising-load");
  expect(std::any_of(instant.begin(), instant.end(),
                     [](const auto& s) {
                       return !(s.end > s.begin) && s.flow.acceleration().start < -1e-6;
                     }),
         "a step of a series that lasts no time has its acceleration");

  // Almost critically damped: at rest against the finger the next zero of the velocity is extinct.
  const pd::Drive<double> drive{0.0010455045324713026,
                                98.735127259354456,
                                0.64258236223452592,
                                {0.1069, 0.2215},
                                {0.0027537094242184013, 0.0053289360215388621}};
  const pd::Inputs<double> inputs{0.5236, 6.21087e-4, 0.5236};
  double since = 0;  // when the last mode began
  const auto outcome =
      pd::simulate(drive, inputs, [&](const auto& segment) { since = segment.begin; });
  expect(outcome.end == pd::End::decaying && since < 0.01,
         "near critical damping nothing sticks after the vibration has died out");
}

/// An undamped pin under a finger with almost no friction reverses every half period, at times known exactly.
void event_times_do_not_drift() {
  const pd::Drive<double> drive{0.01, 100, 0, {}, {1e-9, 1e-9}};
  const pd::Inputs<double> inputs{0.1, 1.5e-3, 0.1, 314.2};
  const long double omega = sqrtl(100.0L / drive.mass), pi = 3.14159265358979323846264L;
  const long double first = atan2l(0.1L, omega * (drive.finger.kinetic / 100.0L + 1.5e-3)) / omega;
  double worst = 0;
  int count = 0;
  pd::simulate(drive, inputs, [&](const auto& segment) {
    if (segment.event.finger != pd::Transition::cross) return;
    const long double exact = first + count++ * pi / omega;
    const auto apart = static_cast<double>(std::abs(segment.end - exact));
    worst = std::max(worst, apart / (std::nextafter(segment.end, 1e9) - segment.end));
  });
  std::printf("# %d reversals, times within %.2f ulp\n", count, worst);
  expect(count > 10'000 && worst <= 4, "10 000 reversals later an event is within 4 ulp");
}

}  // namespace

int main() {
  event_times_do_not_drift();
  parting_surfaces();
  no_mode_without_time();
  tied_at_rest();
  hard_drives();
  return failures == 0 ? 0 : 1;
}
