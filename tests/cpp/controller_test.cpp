// Control block: its samples, and its decisions with hysteresis.
#include "pindrive/device/controller.hpp"

#include <vector>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

std::vector<double> samples(double rate, double begin, double end) {
  std::vector<double> found;
  device::Controller{rate, 0, 0.5, 0.2}.each_sample(begin, end, [&](double t) {
    found.push_back(t);
    return true;
  });
  return found;
}

}  // namespace

int main() {
  expect(samples(100, 0, 0.05) == std::vector<double>{0, 0.01, 0.02, 0.03, 0.04},
         "samples at the multiples of the interval, without the end");
  expect(samples(1000, 0.0035, 0.0061) == std::vector<double>{0.004, 0.005, 0.006},
         "from the first one within");
  expect(samples(3, 2.0 / 3, 1) == std::vector<double>{2.0 / 3}, "a begin at a sample has it");
  expect(samples(10, 0.01, 0.02).empty(), "none between two samples");
  const device::Controller controller{100, 0, 0.5, 0.2};
  expect(controller.decides(false, 0.39) && controller.decides(true, 0.45), "dark switches on");
  expect(!controller.decides(false, 0.45) && !controller.decides(true, 0.61), "light off");
  expect(controller.decides(true, 0.6) && !controller.decides(false, 0.4), "the band keeps it");
  // One after another they are those of each_sample, to the bit.
  const device::Controller odd{970, 0, 0.5, 0.2};
  std::vector<double> one_by_one;
  for (double at = odd.sample_from(0.37); at < 1.9; at = odd.sample_after(at))
    one_by_one.push_back(at);
  expect(one_by_one == samples(970, 0.37, 1.9), "samples follow one another");
  int calls = 0;
  controller.each_sample(0, 1, [&](double) { return ++calls < 3; });
  expect(calls == 3, "a visitor may end the samples");
  return check::status();
}
