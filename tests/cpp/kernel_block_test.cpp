// A block of plain releases: what becomes of one does not depend on its neighbours, on the rounds that they
// need or on what else is asked for. That the answers are right kernel_test shows.
#include "pindrive/kernel/kernel_block.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pk = pindrive::detail;
using Block = pk::KernelBlock;
using check::expect;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(), unwritten = -77;
using Release = std::array<double, Block::inputs>;

/// Mass, stiffness, damping, kinetic and static friction of plate and finger, stiffness of the finger, mouse
/// velocity, displacement, velocity, duration, band.
Release release(double damping, double finger, double speed, double displacement) {
  return {0.01, 100,   damping,      0.02,  0.02, finger, finger,
          inf,  speed, displacement, speed, inf,  0.05};
}

/// At rest after one round, after several, and without friction at the finger, which the kernel leaves.
std::vector<Release> releases() {
  return {release(0.4, 0.005, 0.1, 1.5e-3),  release(0.02, 0.001, 0.02, 4e-3),
          release(0.4, 0.0, 0.1, 1.5e-3),    release(0.05, 0.0005, 0.03, -2e-3),
          release(0.01, 0.002, 0.05, 3e-3),  release(1.0, 0.01, 0.2, 1e-3),
          release(0.0, 0.0015, -0.04, 2e-3), release(0.03, 0.0008, 0.025, 5e-3)};
}

struct Answer {
  std::array<double, Block::columns> numbers;
  bool given_up, unsure;

  /// To the bit, in the numbers from a first one on.
  bool same(const Answer& other, int first = 0) const {
    const auto size = sizeof(double) * (Block::columns - first);
    return given_up == other.given_up && unsure == other.unsure &&
           std::memcmp(&numbers[first], &other.numbers[first], size) == 0;
  }
};

/// Results of releases in one block; nothing is written beyond them or where no output is asked for.
std::vector<Answer> followed(const std::vector<Release>& all, pk::Asked asked, int first = 0) {
  const auto block = std::make_unique<Block>();
  const int count = static_cast<int>(all.size());
  std::vector<std::vector<double>> columns(Block::columns,
                                           std::vector<double>(all.size() + 1, unwritten));
  for (int k = 0; k < Block::columns; ++k)
    block->output[k] = k < first ? nullptr : columns[k].data();
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < Block::inputs; ++k) block->input[k][i] = all[i][k];
  pk::follow_block<pk::Pack<2>>(*block, count, asked);
  bool clean = true;
  for (int k = 0; k < Block::columns; ++k)
    clean = clean && columns[k].back() == unwritten && (k >= first || columns[k][0] == unwritten);
  if (!clean) expect(false, "nothing is written but what is asked for");
  std::vector<Answer> answers(all.size());
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < Block::columns; ++k) answers[i].numbers[k] = columns[k][i];
    answers[i].given_up = block->given_up[i];
    answers[i].unsure = block->unsure[i];
  }
  return answers;
}

/// A pin that passes the plate's velocity 11 000 times before it rests, beside the general core.
void times_do_not_drift() {
  const Release slow{0.01, 100, 0, 4e-6, 4e-6, 4e-7, 4e-7, inf, 0.002, 1e-3, 0.002, inf, 0.05};
  const double rest = followed({slow}, pk::Asked::settling)[0].numbers[Block::rest_time];
  const pindrive::Drive<double> drive{0.01, 100, 0, {4e-6, 4e-6}, {4e-7, 4e-7}};
  double expected = 0;
  int passed = 0;
  pindrive::simulate(drive, pindrive::Inputs<double>{0.002, 1e-3, 0.002}, [&](const auto& segment) {
    expected = segment.begin;
    passed += segment.event.plate != pindrive::Transition::none;
  });
  const double apart = std::abs(rest - expected) / (std::nextafter(rest, inf) - rest);
  std::printf("# at rest after %d passages of the plate's velocity, %.0f ulp apart\n", passed,
              apart);
  expect(passed > 10'000 && apart <= 8,
         "thousands of rounds later times are those of the general core");
}

/// Without damping and kinetic friction a pin passes the plate's velocity for ever; with
/// little of both it passes more often than the kernel follows.
void what_never_rests_is_given_up() {
  const Release lossless{0.01, 200, 0, 0, 0.1, 0, 0.02, inf, 0.2, 2e-3, 0.2, inf, 0.05};
  bool left = followed({lossless}, pk::Asked::settling)[0].given_up;
  for (const int loss : {2, 3, 5}) {
    Release lossy = lossless;
    lossy[loss] = 1e-12;
    left = left && followed({lossy}, pk::Asked::state)[0].given_up;
  }
  expect(left, "a release that nearly loses no energy is left to the general core");
}

}  // namespace

int main() {
  times_do_not_drift();
  what_never_rests_is_given_up();
  const std::vector<Release> all = releases();
  const auto together = followed(all, pk::Asked::settling);
  const auto backward = followed({all.rbegin(), all.rend()}, pk::Asked::settling);
  bool alone = true, reversed = true, left = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    left = left && together[i].given_up == (i == 2);
    if (i == 2) continue;  // of what is given up nothing is said
    alone = alone && followed({all[i]}, pk::Asked::settling)[0].same(together[i]);
    reversed = reversed && backward[all.size() - 1 - i].same(together[i]);
  }
  expect(left, "a release outside the kernel's world is left to the general core, and no other");
  expect(alone, "one alone, in a pack that it does not fill, has the same bits");
  expect(reversed, "so have all of them in another order");

  const auto states = followed(all, pk::Asked::state, Block::rest_position);
  const auto numbers = followed(all, pk::Asked::numbers);
  bool same = true, settled = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == 2) continue;
    same = same && states[i].same(numbers[i], Block::rest_position) &&
           states[i].same(together[i], Block::rest_position);
    settled = settled && numbers[i].numbers[pk::PlainNumber::settling_time] == unwritten &&
              together[i].numbers[pk::PlainNumber::settling_time] >= 0;
  }
  expect(same, "the last state has the same bits whatever else is asked for");
  expect(settled, "a settling time is given where it is asked for alone");

  // More than a pack, and not a whole number of packs: rounds are gathered across them.
  std::vector<Release> many;
  many.reserve(37);
  for (int i = 0; i < 37; ++i) many.push_back(all[i % 8 == 2 ? 3 : i % 8]);
  const auto gathered = followed(many, pk::Asked::settling);
  bool in_place = true;
  for (int i = 0; i < 37; ++i)
    in_place = in_place && gathered[i].same(together[i % 8 == 2 ? 3 : i % 8]);
  expect(in_place, "what is gathered for another round comes back to its own slot");
  return check::status();
}
