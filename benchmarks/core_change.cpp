// What a change of the core must keep: the work of one release, and the bits of motions.
//
//   core_change release COUNT         follows the README's release so many times
//   core_change summary COUNT         the same, with all its numbers
//   core_change FAMILY COUNT SEED     a hash of the bits of so many random motions, for each 1000
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "draw.hpp"
#include "given.hpp"
#include "pindrive.hpp"

namespace {

/// The hash of Fowler, Noll and Vo, of the bits of numbers.
class Hash {
 public:
  void add(double value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001b3ULL;
  }
  unsigned long long value() const { return hash_; }

 private:
  std::uint64_t hash_{0xcbf29ce484222325ULL};
};

void add_motion(Hash& hash, const fuzz::Case& c) {
  const fuzz::Given given(c);
  std::vector<pindrive::Segment<double>> segments;
  const auto outcome = fuzz::run(given, segments);
  for (const auto& segment : segments) {
    hash.add(segment.begin);
    hash.add(segment.end);
    hash.add(segment.flow.position.start);
    hash.add(segment.flow.velocity.start);
    hash.add(segment.plate_force.start);
    hash.add(segment.finger_force.start);
  }
  hash.add(outcome.until);
  hash.add(static_cast<double>(outcome.end));
  hash.add(static_cast<double>(outcome.status));
}

int hashes(fuzz::Family family, std::uint64_t count, std::uint64_t seed) {
  Hash hash;
  for (std::uint64_t number = 0; number < count; ++number) {
    add_motion(hash, fuzz::Draw(seed, number, family).next());
    if ((number + 1) % 1000 == 0 || number + 1 == count) {
      std::printf("%llu %016llx\n", static_cast<unsigned long long>(number), hash.value());
      hash = {};
    }
  }
  return 0;
}

int releases(bool numbers, long count) {
  const pindrive::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.020}, {0.005, 0.005}};
  const pindrive::Inputs<double> release{0.10, 1.5e-3, 0.10};
  std::vector<pindrive::Segment<double>> segments;
  segments.reserve(64);
  double sum = 0;
  for (long i = 0; i < count; ++i) {
    segments.clear();
    if (numbers) {
      sum += pindrive::summarise(drive, release, pindrive::settling_band, segments)
                 .transient.settling_time;
    } else {
      pindrive::simulate(drive, release, [&](const auto& segment) { segments.push_back(segment); });
      sum += segments.back().begin;
    }
  }
  std::printf("%.17g\n", sum);
  return 0;
}

constexpr struct {
  const char* name;
  fuzz::Family family;
} families[] = {{"any", fuzz::Family::any},
                {"aligned", fuzz::Family::aligned},
                {"oblique", fuzz::Family::oblique},
                {"stops", fuzz::Family::stops},
                {"skin", fuzz::Family::skin}};

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (argc == 3 && (what == "release" || what == "summary"))
    return releases(what == "summary", std::strtol(argv[2], nullptr, 10));
  for (const auto& family : families)
    if (argc == 4 && what == family.name)
      return hashes(family.family, std::strtoull(argv[2], nullptr, 10),
                    std::strtoull(argv[3], nullptr, 10));
  std::fprintf(stderr, "core_change release|summary COUNT, or FAMILY COUNT SEED\n");
  return 2;
}
