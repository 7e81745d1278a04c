// The ways to hold a pack's numbers, each operation of each beside the same on numbers, to the bit: as halves and,
// where the compiler has them, as vectors.
#include "pindrive/numbers/lanes.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "check.hpp"

namespace pk = pindrive::detail;
using check::expect;
using Scalar = pk::ScalarLanes;

namespace {

struct Drawn {
  double numbers[8], others[8], column[32];
  std::uint64_t bits[8], more[8];
  int places[8];

  explicit Drawn(std::mt19937_64& random) {
    constexpr double edges[] = {0.0,
                                -0.0,
                                1.0,
                                std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN(),
                                -3.0};
    const auto number = [&] {
      return random() % 3 == 0 ? edges[random() % 6]
                               : std::ldexp(double(random() % 1000) - 500, -7);
    };
    for (double& value : column) value = number();
    for (int i = 0; i < 8; ++i) {
      numbers[i] = number();
      others[i] = random() % 3 == 0 ? numbers[i] : number();
      bits[i] = random();
      more[i] = random();
      places[i] = static_cast<int>(random() % 32);
    }
  }
};

/// One number, integer or truth of lanes at a place, by the operations themselves.
template <class Lanes, int N>
struct Reader {
  typename Lanes::Number numbers(const double* from) const {
    int places[N];
    for (int i = 0; i < N; ++i) places[i] = i;
    return Lanes::gather(from, places);
  }
  /// Compares with a value at each place, of which a NaN is no other's equal.
  bool are(const typename Lanes::Number& found, const double (&expected)[N]) const {
    for (int i = 0; i < N; ++i) {
      const auto all = Lanes::all(expected[i]);
      const bool equal = Lanes::at(Lanes::equal(found, all), i);
      // A zero's sign shows in its reciprocal.
      const auto one = Lanes::divide(Lanes::all(1.0), found),
                 other = Lanes::divide(Lanes::all(1.0), all);
      const bool number = Lanes::at(Lanes::equal(found, found), i);
      const bool reciprocal = Lanes::at(Lanes::equal(one, other), i);
      if (std::isnan(expected[i]) ? number : !(equal && reciprocal)) return false;
    }
    return true;
  }
};

template <class Lanes, int N>
bool numbers(const Drawn& drawn) {
  const Reader<Lanes, N> read;
  const auto a = read.numbers(drawn.numbers), b = read.numbers(drawn.others);
  bool right = true;
  const auto by = [&](const auto& of_lanes, const auto& of_number) {
    double expected[N];
    for (int i = 0; i < N; ++i) expected[i] = of_number(drawn.numbers[i], drawn.others[i]);
    right = right && read.are(of_lanes, expected);
  };
  by(Lanes::add(a, b), Scalar::add);
  by(Lanes::subtract(a, b), Scalar::subtract);
  by(Lanes::multiply(a, b), Scalar::multiply);
  by(Lanes::divide(a, b), Scalar::divide);
  by(Lanes::root(a), [](double x, double) { return Scalar::root(x); });
  by(Lanes::choose(Lanes::less(a, b), a, b), [](double x, double y) { return x < y ? x : y; });
  double gathered[N];
  for (int i = 0; i < N; ++i) gathered[i] = drawn.column[drawn.places[i]];
  return right && read.are(Lanes::gather(drawn.column, drawn.places), gathered);
}

template <class Lanes, int N>
bool truths(const Drawn& drawn) {
  const Reader<Lanes, N> read;
  const auto a = read.numbers(drawn.numbers), b = read.numbers(drawn.others);
  const auto less = Lanes::less(a, b), at_most = Lanes::less_equal(a, b),
             equal = Lanes::equal(a, b);
  bool right = true, some = false;
  for (int i = 0; i < N; ++i) {
    const double x = drawn.numbers[i], y = drawn.others[i];
    some = some || x < y;
    right = right && Lanes::at(less, i) == (x < y) && Lanes::at(at_most, i) == (x <= y) &&
            Lanes::at(equal, i) == (x == y) &&
            Lanes::at(Lanes::both(less, at_most), i) == (x < y) &&
            Lanes::at(Lanes::either(less, equal), i) == (x < y || x == y) &&
            Lanes::at(Lanes::opposite(less), i) == !(x < y);
  }
  return right && Lanes::any(less) == some && Lanes::any(Lanes::truth(true)) &&
         !Lanes::any(Lanes::truth(false));
}

/// By a number that every place has: what differs between places is moved by shifts alone.
template <class Lanes, int N>
bool integers(const Drawn& drawn) {
  const std::uint64_t x = drawn.bits[0], y = drawn.more[0];
  const auto a = Lanes::all(x), b = Lanes::all(y);
  const auto is = [](const auto& found, std::uint64_t expected) {
    std::uint64_t held[N];
    static_assert(sizeof found == sizeof held);
    std::memcpy(held, &found, sizeof held);
    for (const std::uint64_t one : held)
      if (one != expected) return false;
    return true;
  };
  return is(Lanes::plus(a, b), x + y) && is(Lanes::minus(a, b), x - y) &&
         is(Lanes::conjunction(a, b), x & y) && is(Lanes::disjunction(a, b), x | y) &&
         is(Lanes::difference(a, b), x ^ y) && is(Lanes::left(a, 52), x << 52) &&
         is(Lanes::right(a, 11), x >> 11);
}

template <class Lanes, int N>
void lanes(const char* what) {
  std::mt19937_64 random(3);
  bool right = true;
  for (int i = 0; i < 2000; ++i) {
    const Drawn drawn(random);
    right =
        right && numbers<Lanes, N>(drawn) && truths<Lanes, N>(drawn) && integers<Lanes, N>(drawn);
  }
  expect(right, what);
}

}  // namespace

int main() {
  lanes<Scalar, 1>("one number");
  lanes<pk::PairLanes<2>, 2>("two as halves");
  lanes<pk::PairLanes<4>, 4>("four as halves");
  lanes<pk::PairLanes<8>, 8>("eight as halves");
#ifdef PINDRIVE_VECTOR_LANES
  lanes<pk::VectorLanes<2>, 2>("two as a vector");
  if constexpr (PINDRIVE_VECTOR_LANES >= 4) lanes<pk::VectorLanes<4>, 4>("four as a vector");
  if constexpr (PINDRIVE_VECTOR_LANES >= 8) lanes<pk::VectorLanes<8>, 8>("eight as a vector");
#endif
  return check::status();
}
