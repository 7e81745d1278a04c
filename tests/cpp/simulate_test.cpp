// One motion: what its sink sees, how it is stopped, and the limits that end it.
#include "pindrive/events/simulate.hpp"

#include <vector>

#include "check.hpp"
#include "pindrive/model/named_function.hpp"

namespace pd = pindrive;
using check::expect;

namespace {

const pd::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.020}, {0.005, 0.005}};
const pd::Inputs<double> inputs{0.10, 1.5e-3, 0.10};

/// A pin that a plate takes along over the finger to the end of a stroke has its smallest velocities within rounding.
void ends_of_strokes() {
  int turned = 0, carried = 0;
  for (int i = 0; i < 500; ++i) {
    const double lasts = 0.05 + 0.3 * (i * 37 % 101) / 101, way = 0.005 + 0.05 * (i * 53 % 97) / 97;
    const double end = 0.013 * (i % 3) + lasts;
    const auto stroke = pd::named_function<double>(*pd::function_kind("minimum_jerk"),
                                                   {way, lasts, end - lasts, 0});
    std::vector<pd::InputPiece<double>> pieces;
    pieces.reserve(stroke.count);
    for (std::size_t k = 0; k < stroke.count; ++k) pieces.push_back(stroke.pieces[k].piece);
    const pd::Drive<double> body{
        0.01 + 0.001 * (i % 7), 100, 0.32, {0.022, 0.0265}, {0.005, 0.0075}};
    const pd::Inputs<double> hand{{pieces.data(), pieces.size()}, 1e-3 * (i * 29 % 41) / 41, 0, 1};
    pd::simulate(body, hand, [&](const pd::Segment<double>& segment) {
      const bool nearly = segment.end < end && segment.end > (1 - 1e-6) * end;
      turned += nearly && segment.event.finger != pd::Transition{};
      carried += segment.end == end && segment.mode.plate == pd::ContactState::stick;
    });
  }
  expect(carried > 50, "strokes take pins along");
  expect(turned == 0, "... that do not turn shortly before the end");
}

/// Counts the brief segments of carried and resting pins, under a hand that swings by a part of its mean velocity.
int brief_segments(double part, int& held) {
  int brief = 0;
  for (int i = 0; i < 600; ++i) {
    constexpr double frequencies[] = {1, 2, 5, 8, 10, 12.5, 20, 50};
    const double mean = 0.012 * (1 + i % 5), frequency = frequencies[i % 8];
    const auto hand =
        pd::named_function<double>(*pd::function_kind("harmonic"),
                                   {mean, part * mean, frequency, (i % 3) * 1.5707963267948966});
    const pd::InputPiece<double> piece = hand.pieces[0].piece;
    const double plate = i % 2 ? 0.005 : 0.02, finger = 0.025 - plate;
    const pd::Drive<double> body{
        0.01, 20.0 + 7 * (i % 11), 0.2, {plate, 1.3 * plate}, {finger, 1.5 * finger}};
    const pd::Inputs<double> given{{&piece, 1}, 1e-3 * (i * 29 % 41) / 41, 0, 3 / frequency};
    pd::simulate(body, given, [&](const pd::Segment<double>& segment) {
      const bool stuck = segment.mode.stuck();
      held += stuck;
      brief += stuck && segment.end - segment.begin < 1e-5 / frequency;
    });
  }
  return brief;
}

/// A velocity that only touches rest is negative there by rounding.
void hands_that_touch_rest() {
  int held = 0;
  for (const double part : {1.0, 1 + 2.2e-16, 1 - 2.2e-16})
    expect(brief_segments(part, held) == 0, "a pin does not turn where the hand only touches rest");
  expect(held > 1000, "though many are held then");
  expect(brief_segments(1 + 1e-12, held) > 100, "but where it turns by a little");
}

}  // namespace

int main() {
  ends_of_strokes();
  hands_that_touch_rest();
  int segments = 0;
  double until = 0;
  bool joined = true;
  const auto outcome = pd::simulate(drive, inputs, [&](const pd::Segment<double>& segment) {
    joined = joined && segment.begin == until;
    until = segment.end;
    ++segments;
  });
  expect(outcome.status == pd::Status::ok && outcome.end == pd::End::resting && segments == 6,
         "the example comes to rest after five events");
  expect(joined && until == outcome.until, "its segments join");

  int seen = 0;
  const auto stopped = pd::simulate(drive, inputs, [&](const auto&) { return ++seen < 3; });
  expect(stopped.status == pd::Status::stopped && seen == 3, "a sink that has enough stops it");

  pd::Inputs<double> brief = inputs;
  brief.duration = 0.02;
  const auto cut = pd::simulate(drive, brief, [&](const auto& segment) { until = segment.end; });
  expect(cut.end == pd::End::moving && cut.until == 0.02 && until == 0.02,
         "a duration ends it there, to the bit");

  // Without damping they would be events for ever.
  pd::Drive<double> undamped = drive;
  undamped.damping = 0;
  pd::Inputs<double> unloaded{0.10, 5e-3, 0.10};
  unloaded.plate_load = unloaded.finger_load = 0.0;
  unloaded.force = 0.01;
  const auto free = pd::simulate(undamped, unloaded, [&](const pd::Segment<double>& segment) {
    seen =
        segment.mode.plate == segment.mode.finger && segment.mode.plate == pd::ContactState::absent;
  });
  expect(free.end == pd::End::free && seen, "contacts that are never loaded are absent");
  return check::status();
}
