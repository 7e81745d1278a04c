// Releases a pin and prints its segments: what a C++ program does with the core, as pindrive.hpp says.
#include <cstdio>
#include <pindrive.hpp>
#include <vector>

int main() {
  const pindrive::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.020}, {0.005, 0.005}};
  const pindrive::Inputs<double> release{0.10, 1.5e-3, 0.10};  // mouse velocity, x(0), x'(0)
  std::vector<pindrive::Segment<double>> segments;
  const auto outcome =
      pindrive::simulate(drive, release, [&](const auto& segment) { segments.push_back(segment); });
  const pindrive::Motion<double> motion(drive, release, segments.data(), segments.size(), outcome);
  const auto [segment, tau] = motion.locate(0.02, pindrive::Side::right);
  const double x = segment->flow.position.at(segment->flow.oscillator, tau);  // x(0.02 s)
  for (const auto& each : segments) std::printf("%.9f s\n", each.begin);
  std::printf("x(0.02 s) = %.6e m\n", x);
  std::printf("%s\n", outcome.end == pindrive::End::resting ? "resting" : "not resting");
}
