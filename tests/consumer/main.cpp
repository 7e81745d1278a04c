// Releases a pin and prints its segments: what a C++ program does with the core.
#include <cstdio>
#include <pindrive/simulate.hpp>

int main() {
  pindrive::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.020}, {0.005, 0.005}};
  pindrive::Inputs<double> inputs{0.10, 1.5e-3, 0.10};
  const auto outcome = pindrive::simulate(
      drive, inputs, [](const auto& segment) { std::printf("%.9f s\n", segment.begin); });
  std::printf("%s\n", outcome.end == pindrive::End::resting ? "resting" : "not resting");
}
