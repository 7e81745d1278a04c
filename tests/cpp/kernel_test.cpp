// The kernel beside the general core on random plain releases: the same events and the same numbers to
// a few roundings; the same bits alone, in packs of every width, and followed at once or put off first.
//
//     kernel_test [COUNT [SEED]]    so many releases of each of two kinds, 50 000 unless given
#include "pindrive/kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "pindrive/batch.hpp"

namespace pd = pindrive;
namespace pk = pindrive::detail;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr int inputs = 11, outputs = 24;
enum Kind { length, path, speed, time, hard_time, force, count };
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
                                   {"plate reversals", count},
                                   {"plate time stuck", time},
                                   {"plate distance slid", path},
                                   {"plate peak force", force},
                                   {"finger reversals", count},
                                   {"finger time stuck", time},
                                   {"finger distance slid", path},
                                   {"finger peak force", force},
                                   {"duration", time},
                                   {"events", count},
                                   {"last position", length},
                                   {"last velocity", speed},
                                   {"at rest since", time},
                                   {"given up", count},
                                   {"put off", count}};

struct Releases {
  std::vector<double> of[inputs];
  std::size_t size() const { return of[0].size(); }
};

/// The drives of the benchmark; or of every kind that the kernel follows, and some that it does not.
Releases drawn(std::size_t size, unsigned seed, bool wide) {
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
                        uniform(20e-3, 0.3),
                        uniform(0.5e-3, 3e-3),
                        0,
                        0.3};
    p[9] = p[7];
    if (wide) {
      if (one_in(2)) p[4] *= uniform(1, 2);
      if (one_in(2)) p[6] *= uniform(1, 2);
      if (one_in(2)) p[7] = -p[7];
      if (one_in(2)) p[8] = -p[8];
      if (one_in(10)) p[8] *= 10;
      p[9] = one_in(3) ? p[7] : one_in(3) ? 0 : uniform(-0.3, 0.3);
      p[10] = one_in(3) ? 0.3 : one_in(2) ? inf : one_in(2) ? 0.05 : 1e-3;
      if (one_in(50)) p[7] = 0;
    }
    for (int j = 0; j < inputs; ++j) all.of[j].push_back(p[j]);
  }
  return all;
}

struct Answers {
  std::vector<double> of[outputs];
};

/// All numbers of releases in packs; `again`: with those that were put off followed afterwards.
template <class V>
Answers by_kernel(const Releases& releases, bool again) {
  constexpr int width = pk::Traits<V>::width;
  Answers all;
  for (auto& column : all.of) column.resize(releases.size());
  for (std::size_t i = 0; i + width <= releases.size(); i += width) {
    pk::PlainRelease<V> r;
    V* into = &r.mass;
    for (int j = 0; j < inputs; ++j) into[j] = pk::load<V>(&releases.of[j][i]);
    const auto last = again ? pk::Kernel<V, false, false>(r).run(V(0.0), V(0.0))
                            : pk::Kernel<V, true, false>(r).run(V(0.0), V(0.0));
    const V rest = pk::select(last.time == last.time, last.position, last.time);
    pk::Kernel<V, true, true> kernel(r);
    const auto state = kernel.run(again ? V(std::nan("")) : rest, V(pd::settling_band));
    const auto numbers = kernel.numbers();
    const V* from = &numbers.peak_displacement;
    for (int j = 0; j < 21; ++j) pk::store(from[j], &all.of[j][i]);
    pk::store(again ? last.position : state.position, &all.of[19][i]);
    pk::store(again ? last.velocity : state.velocity, &all.of[20][i]);
    pk::store(again ? last.time : state.time, &all.of[21][i]);
    for (int j = 0; j < width; ++j) {
      const std::size_t at = i + static_cast<std::size_t>(j);
      all.of[22][at] = pk::answer(state.given_up, j) ? 1 : 0;
      all.of[23][at] = pk::answer(last.put_off, j) ? 1 : 0;
    }
  }
  return all;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool agree(const Answers& one, const Answers& other, int width) {
  for (int j = 0; j < outputs; ++j)
    for (std::size_t i = 0; i < one.of[j].size() / 8 * 8; ++i) {
      if (j < 22 && one.of[22][i] != 0) continue;  // nothing is said of what was given up
      if (same(one.of[j][i], other.of[j][i])) continue;
      std::printf("release %zu, %s: %a alone, %a in a pack of %d\n", i, names[j].name, one.of[j][i],
                  other.of[j][i], width);
      return false;
    }
  return true;
}

bool plain(const Releases& r, std::size_t i) {
  const double ratio = r.of[2][i] / (2 * std::sqrt(r.of[0][i] * r.of[1][i]));
  return r.of[4][i] > 0 && r.of[6][i] > 0 && r.of[7][i] != 0 && ratio < 0.98;
}

bool beside_core(const Releases& releases, const Answers& found, bool wide) {
  double worst[outputs] = {};
  std::size_t given_up = 0, outside = 0, cycles = 0, wrong = 0;
  std::vector<pd::Segment<double>> segments;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    double p[inputs];
    for (int j = 0; j < inputs; ++j) p[j] = releases.of[j][i];
    const pd::Drive<double> drive{p[0], p[1], p[2], {p[3], p[4]}, {p[5], p[6]}};
    const pd::Inputs<double> release{p[7], p[8], p[9], p[10]};
    const auto s = pd::summarise(drive, release, pd::settling_band, segments);
    if (found.of[22][i] != 0) {
      ++given_up;
      if (!plain(releases, i)) {
        ++outside;
      } else if (s.outcome.cycles()) {
        ++cycles;
      }
      continue;
    }
    const pd::Motion<double> motion(drive, release, segments.data(), segments.size(), s.outcome);
    const auto at = [&](double t) {
      const auto [segment, tau] = motion.locate(t, pd::Side::left);
      const auto moved = segment->after(tau);
      return std::array<double, 2>{segment->flow.position.at(moved, tau),
                                   segment->flow.velocity.at(moved, tau)};
    };
    const auto& t = s.transient;
    const auto last = at(s.duration);
    const double right[outputs] = {
        t.peak_displacement,
        t.peak_time,
        t.trough_displacement,
        t.trough_time,
        t.swing,
        t.return_velocity,
        t.return_velocity_time,
        t.first_reversal_time,
        t.settling_time,
        t.plate.reversals,
        t.plate.time_stuck,
        t.plate.distance_slid,
        t.plate.peak_force,
        t.finger.reversals,
        t.finger.time_stuck,
        t.finger.distance_slid,
        t.finger.peak_force,
        s.duration,
        static_cast<double>(s.events),
        last[0],
        last[1],
        s.outcome.end == pd::End::resting ? s.outcome.since : std::nan("")};
    const double rate = std::sqrt(p[1] / p[0]);
    const double reach = std::abs(p[8]) + (std::abs(p[7]) + std::abs(p[9])) / rate;
    const double sizes[] = {reach,
                            reach + t.plate.distance_slid + t.finger.distance_slid,
                            rate * reach,
                            1 / rate + s.duration,
                            1,
                            p[1] * reach + p[2] * std::abs(p[7]) + p[3] + p[5],
                            1};
    // An event at a velocity that all but grazes the plate's keeps half of its digits.
    const double most[] = {1e-12, 1e-12, 1e-12, 1e-10, 1e-12, 1e-11, 0};
    for (int j = 0; j < 22; ++j) {
      const Kind kind = names[j].kind;
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
  std::printf("%zu releases %s: given up %zu, of which not plain %zu, cycles %zu, rounding %zu\n",
              releases.size(), wide ? "of all kinds" : "of the benchmark", given_up, outside,
              cycles, rounding);
  for (int j = 0; j < 22; ++j) std::printf("  %-22s within %.1e\n", names[j].name, worst[j]);
  return wrong == 0 && rounding <= releases.size() / 1000;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t size = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 50'000;
  const auto seed = static_cast<unsigned>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 12);
  bool good = true;
  // In pieces, so that the memory does not grow with their number.
  constexpr std::size_t piece = 1'000'000;
  for (const bool wide : {false, true})
    for (std::size_t first = 0; first < size; first += piece) {
      const auto releases = drawn(std::min(piece, size - first) / 8 * 8,
                                  seed + static_cast<unsigned>(first / piece), wide);
      const Answers found = by_kernel<double>(releases, false);
      good = beside_core(releases, found, wide) && good;
      good = agree(found, by_kernel<pk::Pack<2>>(releases, false), 2) && good;
      good = agree(found, by_kernel<pk::Pack<4>>(releases, false), 4) && good;
      good = agree(found, by_kernel<pk::Pack<8>>(releases, false), 8) && good;
      // Whatever is not put off ends where it ends if all is followed at once.
      const Answers again = by_kernel<double>(releases, true);
      for (std::size_t i = 0; i < releases.size(); ++i)
        for (const int j : {19, 20, 21})
          if (again.of[22][i] == 0 && again.of[23][i] == 0 &&
              !same(again.of[j][i], found.of[j][i])) {
            std::printf("release %zu ends elsewhere if what meets the plate is put off\n", i);
            return 1;
          }
    }
  return good ? 0 : 1;
}
