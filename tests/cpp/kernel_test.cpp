// The kernel beside the general core on random plain releases: the same events and the same numbers to
// a few roundings, and the same bits with all numbers or a few. That every width gives the same bits is
// shown by tests/motion/test_kernel.py, where all of them are compiled anyway.
//
// The motions of the general core that it is held against are judged by the certificate, which knows no
// solver. A part of the releases ends at a random instant, so that the motions agree on the way, too.
//
//     kernel_test [COUNT [SEED [EVERY]]]    so many releases of each of three kinds, 100 000 unless
//                                           given, and of one in EVERY (32) the certificate
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "cases.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/kernel/kernel_block.hpp"
#include "pindrive/motion/batch.hpp"

namespace pd = pindrive;
namespace pk = pindrive::detail;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
using Block = pk::KernelBlock;
constexpr int inputs = Block::inputs, outputs = Block::columns;
enum Kind : unsigned char { length, path, speed, time, hard_time, force, work, count };
struct Output {
  const char* name;
  Kind kind;
};
constexpr Output names[outputs] = {{"peak displacement", length},
                                   {"peak time", time},
                                   {"trough displacement", length},
                                   {"trough time", time},
                                   {"swing", length},
                                   {"return velocity", speed},
                                   {"return velocity time", time},
                                   {"first reversal time", time},
                                   {"settling time", hard_time},
                                   {"end of the transient", time},
                                   {"plate reversals", count},
                                   {"plate time stuck", time},
                                   {"plate distance slid", path},
                                   {"plate dissipated", work},
                                   {"plate peak force", force},
                                   {"finger reversals", count},
                                   {"finger time stuck", time},
                                   {"finger distance slid", path},
                                   {"finger dissipated", work},
                                   {"finger peak force", force},
                                   {"plate power", work},
                                   {"finger power", work},
                                   {"duration", time},
                                   {"events", count},
                                   {"resting place", length},
                                   {"last position", length},
                                   {"last velocity", speed},
                                   {"rest time", time}};

struct Releases {
  std::vector<double> of[inputs];
  std::size_t size() const { return of[0].size(); }
};

/// Kinds of releases: the benchmark; every kind that the kernel follows, and some
/// that it leaves; and delicate releases, next to critical damping or with a velocity, at
/// the start or later, next to a surface velocity.
enum class Drawn : unsigned char { benchmark, wide, delicate };
constexpr const char* drawn_names[] = {"of the benchmark", "of all kinds", "next to a limit"};

Releases drawn(std::size_t size, unsigned seed, Drawn kind) {
  const bool wide = kind != Drawn::benchmark;
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto one_in = [&](int n) { return uniform(0, n) < 1; };
  Releases all;
  for (std::size_t i = 0; i < size; ++i) {
    const double m = uniform(2e-3, 20e-3), k = uniform(20, 400);
    const double ratio = wide ? (one_in(8) ? 0 : uniform(0, 1.02)) : uniform(0.01, 0.5);
    const double plate = uniform(5e-3, 0.1), finger = one_in(9) && wide ? 0 : uniform(1e-3, 0.05);
    double p[inputs] = {m,
                        k,
                        2 * ratio * std::sqrt(m * k),
                        plate,
                        plate,
                        finger,
                        finger,
                        inf,
                        uniform(20e-3, 0.3),
                        uniform(0.5e-3, 3e-3),
                        0,
                        0.3,
                        pd::settling_band};
    p[10] = p[8];
    if (wide) {
      if (one_in(2)) p[4] *= uniform(1, 2);
      if (one_in(2)) p[6] *= uniform(1, 2);
      if (one_in(2)) p[8] = -p[8];
      if (one_in(2)) p[9] = -p[9];
      if (one_in(10)) p[9] *= 10;
      p[10] = one_in(3) ? p[8] : one_in(3) ? 0 : uniform(-0.3, 0.3);
      p[11] = one_in(3) ? 0.3 : one_in(2) ? inf : one_in(2) ? 0.05 : uniform(1e-4, 0.2);
      if (one_in(50)) p[8] = 0;
      if (one_in(3)) p[12] = one_in(9) ? 1 : std::exp(uniform(std::log(1e-4), 0));
    }
    if (kind == Drawn::delicate) {
      const auto small = [&](double least, double most) {
        return std::exp(uniform(std::log(least), std::log(most)));
      };
      const double beside = small(1e-17, 1e-8) * (one_in(2) ? 1 : -1);
      if (one_in(3) || ratio > 0.98) {
        p[2] = 2 * std::sqrt(m * k) * (1 - small(1e-16, 1e-2));
      } else if (one_in(2)) {
        p[10] = (one_in(2) ? p[8] : 0) + p[8] * beside;
      } else {  // from rest, with an extreme velocity next to that of the plate
        const double alpha = -p[2] / (2 * m), omega = std::sqrt(k / m - alpha * alpha);
        const double extreme =
            std::sqrt(k / m) * std::exp(alpha / omega * std::atan2(omega, -alpha));
        p[9] = (p[3] - p[5]) / k - std::abs(p[8]) * (1 + beside) / extreme;
        if (p[8] < 0) p[9] = -p[9];
        p[10] = 0;
      }
    }
    for (int j = 0; j < inputs; ++j) all.of[j].push_back(p[j]);
  }
  return all;
}

struct Answers {
  std::vector<double> of[outputs];
  std::vector<char> given_up, unsure;

  explicit Answers(std::size_t size) : given_up(size), unsure(size) {
    for (auto& column : of) column.resize(size);
  }
};

/// Requested outputs of releases, in blocks of packs of two; other outputs stay 0.
Answers by_blocks(const Releases& releases, pk::Asked asked) {
  Answers all(releases.size());
  const auto block = std::make_unique<Block>();
  for (std::size_t first = 0; first < releases.size(); first += Block::capacity) {
    const std::size_t size = std::min<std::size_t>(Block::capacity, releases.size() - first);
    for (int j = 0; j < inputs; ++j) std::copy_n(&releases.of[j][first], size, block->input[j]);
    for (int j = 0; j < outputs; ++j) block->output[j] = &all.of[j][first];
    if (asked != pk::Asked::settling) block->output[pk::PlainNumber::settling_time] = nullptr;
    pk::follow_block<pk::Pack<2>>(*block, static_cast<int>(size), asked);
    std::copy_n(block->given_up, size, &all.given_up[first]);
    std::copy_n(block->unsure, size, &all.unsure[first]);
  }
  return all;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// True if the outputs agree from a column on; releases left to the core are not compared, and may
/// be fewer where fewer outputs are requested.
bool agree(const Answers& one, const Answers& other, int from, const char* how) {
  for (std::size_t i = 0; i < one.given_up.size(); ++i) {
    if (one.given_up[i] != 0 && (from > 0 || other.given_up[i] != 0)) continue;
    bool good = one.given_up[i] == other.given_up[i];
    for (int j = from; j < outputs; ++j) good = good && same(one.of[j][i], other.of[j][i]);
    if (good) continue;
    std::printf("release %zu: other answers %s\n", i, how);
    return false;
  }
  return true;
}

bool plain(const Releases& r, std::size_t i) {
  const double ratio = r.of[2][i] / (2 * std::sqrt(r.of[0][i] * r.of[1][i]));
  return r.of[4][i] > 0 && r.of[6][i] > 0 && r.of[8][i] != 0 && ratio < 0.98;
}

bool beside_core(const Releases& releases, const Answers& found, Drawn drawn_kind,
                 std::size_t every) {
  double worst[outputs] = {}, residual = 0;
  std::size_t certified = 0;
  std::size_t given_up = 0, unsure = 0, outside = 0, cycles = 0, wrong = 0;
  std::vector<pd::Segment<double>> segments;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    double p[inputs];
    for (int j = 0; j < inputs; ++j) p[j] = releases.of[j][i];
    const pd::Drive<double> drive{p[0], p[1], p[2], {p[3], p[4]}, {p[5], p[6]}};
    const pd::Inputs<double> release{p[8], p[9], p[10], p[11]};
    const auto s = pd::summarise(drive, release, p[12], segments);
    const pd::Motion<double> motion(drive, release, segments.data(), segments.size(), s.outcome);
    if (i % every == 0) {
      const auto certificate = pd::Certifier<double>(motion, s.duration).certify();
      ++certified;
      residual = std::max(residual, certificate.worst());
      if (!(certificate.worst() <= 1e-9)) {
        ++wrong;
        std::printf("release %zu breaks a law by %.1e\n", i, certificate.worst());
      }
    }
    if (found.given_up[i] != 0) {
      ++given_up;
      if (!plain(releases, i)) {
        ++outside;
      } else if (s.outcome.cycles()) {
        ++cycles;
      }
      continue;
    }
    const auto at = [&](double t) {
      const auto [segment, tau] = motion.locate(t, pd::Side::left);
      const auto moved = segment->after(tau);
      return std::array<double, 2>{segment->flow.position.at(moved),
                                   segment->flow.velocity.at(moved)};
    };
    const auto& t = s.transient;
    const auto last = at(s.duration);
    const double right[outputs] = {t.peak_displacement,
                                   t.peak_time,
                                   t.trough_displacement,
                                   t.trough_time,
                                   t.swing,
                                   t.return_velocity,
                                   t.return_velocity_time,
                                   t.first_reversal_time,
                                   t.settling_time,
                                   t.end_time,
                                   t.plate.reversals,
                                   t.plate.time_stuck,
                                   t.plate.distance_slid,
                                   t.plate.dissipated,
                                   t.plate.peak_force,
                                   t.finger.reversals,
                                   t.finger.time_stuck,
                                   t.finger.distance_slid,
                                   t.finger.dissipated,
                                   t.finger.peak_force,
                                   t.plate_afterwards.power,
                                   t.finger_afterwards.power,
                                   s.duration,
                                   static_cast<double>(s.events),
                                   s.outcome.end == pd::End::resting ? last[0] : std::nan(""),
                                   last[0],
                                   last[1],
                                   t.rest_time};
    const double rate = std::sqrt(p[1] / p[0]);
    const double reach = std::abs(p[9]) + (std::abs(p[8]) + std::abs(p[10])) / rate;
    const double slid = reach + t.plate.distance_slid + t.finger.distance_slid;
    const double largest = p[1] * reach + p[2] * std::abs(p[8]) + p[3] + p[5];
    const double sizes[] = {reach, slid,    rate * reach,         1 / rate + s.duration,
                            1,     largest, (p[3] + p[5]) * slid, 1};
    // An event at a velocity that all but grazes the plate's keeps half of its digits.
    const double most[] = {1e-12, 1e-12, 1e-12, 1e-10, 1e-12, 1e-11, 1e-12, 0};
    for (int j = 0; j < outputs; ++j) {
      const Kind kind = names[j].kind;
      if (kind == hard_time && found.unsure[i] != 0) {
        ++unsure;
        continue;
      }
      double error = std::abs(found.of[j][i] - right[j]) / sizes[kind];
      // A settling time is as good as its position, which hardly changes near a turning point.
      if (kind == hard_time && !(error * rate <= 1e-12))
        error = std::abs(at(found.of[j][i])[0] - at(right[j])[0]) / reach;
      if (same(found.of[j][i], right[j])) error = 0;
      if (error <= most[kind]) {
        worst[j] = std::max(worst[j], error);
        continue;
      }
      if (++wrong <= 10)
        std::printf("release %zu, %s: %.17g, of the core %.17g\n", i, names[j].name, found.of[j][i],
                    right[j]);
    }
  }
  const std::size_t rounding = given_up - outside - cycles;
  std::printf(
      "%zu releases %s: given up %zu, of which not plain %zu, cycles %zu, rounding %zu; "
      "settling time left to the core %zu\n",
      releases.size(), drawn_names[static_cast<int>(drawn_kind)], given_up, outside, cycles,
      rounding, unsure);
  std::printf("  %zu disagreements; of %zu motions the certificate finds residuals up to %.1e\n",
              wrong, certified, residual);
  for (int j = 0; j < outputs; ++j) std::printf("  %-22s within %.1e\n", names[j].name, worst[j]);
  return wrong == 0 && (drawn_kind == Drawn::delicate || rounding <= releases.size() / 1000);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t size = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : cases(100'000);
  const auto seed = static_cast<unsigned>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 12);
  const std::size_t every = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 32;
  bool good = true;
  // In pieces, so that the memory does not grow with their number.
  constexpr std::size_t piece = 1'000'000;
  for (const Drawn kind : {Drawn::benchmark, Drawn::wide, Drawn::delicate})
    for (std::size_t first = 0; first < size; first += piece) {
      const auto releases =
          drawn(std::min(piece, size - first), seed + static_cast<unsigned>(first / piece), kind);
      using pk::Asked;
      const Answers found = by_blocks(releases, Asked::settling);
      good = beside_core(releases, found, kind, every) && good;
      const auto as_found = [&](Asked less, int from, const char* how) {
        good = agree(found, by_blocks(releases, less), from, how) && good;
      };
      as_found(Asked::state, Block::rest_position, "of the state");
      as_found(Asked::numbers, pk::PlainNumber::plate_reversals,
               "where no settling time is asked for");
    }
  return good ? 0 : 1;
}
