// Where the slider of a compliant contact goes from an end of its branch.
#include "pindrive/law/slider.hpp"

#include <array>

#include "check.hpp"

namespace {

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::detail::ActiveGuard;

// Rises to 3 at 0.1 m/s, falls to 1 at 0.2, and stays there from 0.3 on after a rise to 2.
constexpr std::array<double, 4> speeds{0, 0.1, 0.2, 0.3}, forces{1, 3, 1, 2};
constexpr std::array<double, 5> level_speeds{0, 0.1, 0.2, 0.3, 0.4}, level_forces{1, 3, 1, 2, 2};

template <std::size_t N>
auto landings(const std::array<double, N>& u, const std::array<double, N>& f,
              std::array<pd::Branch<double>, N + 1>& branches, double pin, double follows = 0) {
  const int count = pd::branches_of(u.data(), f.data(), static_cast<int>(N), branches.data());
  static pd::Contact<double> contact;
  contact = {f[0], 1.5, 1000.0, branches.data(), count};
  return pd::detail::Slider<double>(contact, pin, follows);
}

void faster_and_slower() {
  std::array<pd::Branch<double>, 5> rising{};
  const auto goes = landings(speeds, forces, rising, 0.01);
  auto found = goes.next_faster(0, 1.5);
  expect(found.branch == 0 && near(found.speed, 0.025, 1e-15) && !found.shortens_skin,
         "from the limit of its grip to the speed that carries it");
  found = goes.next_faster(1, 3.0);
  expect(found.branch == 2 && near(found.speed, 0.4, 1e-15) && !found.shortens_skin,
         "over a fall to the next speed that carries as much");
  found = goes.next_slower(2, 1.0);
  expect(found.sticks && found.friction == 1.0, "below the lowest rise it grips");
  found = goes.next_slower(2, 2.0);
  expect(found.branch == 0 && near(found.speed, 0.05, 1e-15), "or slides more slowly");

  std::array<pd::Branch<double>, 6> level{};
  found = landings(level_speeds, level_forces, level, 0.5).next_faster(1, 3.0);
  expect(found.shortens_skin && found.friction == 2.0 && found.speed == 0.5 &&
             found.guard == ActiveGuard::none,
         "where no speed carries it, the skin is shorter at once and the pin's speed the slider's");
  found = landings(level_speeds, level_forces, level, 0.01).next_faster(1, 3.0);
  expect(found.shortens_skin && found.branch == 2 && found.guard == ActiveGuard::upper,
         "and beside a slow pin it goes on down from there");
  expect(pd::detail::Slider<double>(pd::Contact<double>{}, 1e-4, 1e-4 / 0.7)
                 .stationary_speed(0.7 * (1 + 3e-16)) == 0,
         "a pin as fast as the stretch to rounding leaves it without a speed");
}

/// As a load grows from zero the slider has the speed that is left of the pin's: at a row of its curve, to rounding.
void from_no_load() {
  std::array<pd::Branch<double>, 5> rising{};
  for (const double pin : {0.3, 0.3 * (1 + 3e-16)}) {
    const auto found = landings(speeds, forces, rising, pin, 0.1).at_first_load();
    expect(found.branch == 2 && found.speed == 0.2 && found.guard == ActiveGuard::lower,
           "at the row");
  }
  // At a peak it would run away as the pin gets faster: it grips.
  std::array<pd::Branch<double>, 4> peaked{};
  constexpr std::array<double, 3> to_peak{0, 0.1, 0.5}, up_and_down{1, 3, 1};
  expect(landings(to_peak, up_and_down, peaked, 0.4, 0.1).at_first_load().sticks, "at a peak");
}

}  // namespace

int main() {
  faster_and_slower();
  from_no_load();
  return check::status();
}
