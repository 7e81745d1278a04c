// Packs of every width, as vectors and as halves, against the same operations on numbers, to the bit.
#include "pindrive/numbers/pack.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>

namespace pk = pindrive::detail;

namespace {

int wrong = 0;
void expect(bool good, const char* what, int width) {
  if (good) return;
  if (++wrong <= 10) std::printf("packs of %d: %s\n", width, what);
}

/// A number at random, among them zeros of both signs, infinities and NaN.
double any_number(std::mt19937_64& random) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double edges[] = {0.0, -0.0, 1.0, -1.0, inf, -inf, 0x1p-1074, -0x1p1023};
  const auto drawn = random();
  if (drawn % 4 == 0) return edges[drawn / 4 % 8];
  if (drawn % 97 == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::ldexp(static_cast<double>(static_cast<std::int64_t>(drawn)), -62);
}
bool same(double a, double b) {
  return pk::bits(a) == pk::bits(b) || (std::isnan(a) && std::isnan(b));
}

template <int N>
struct Test {
  using V = pk::Pack<N>;
  double a[N], b[N], column[64];
  int places[N];

  explicit Test(std::mt19937_64& random) {
    for (double& value : column) value = any_number(random);
    for (int i = 0; i < N; ++i) {
      a[i] = any_number(random);
      b[i] = random() % 5 == 0 ? a[i] : any_number(random);
      places[i] = static_cast<int>(random() % 64);
    }
  }

  /// `of_pack` and `of_number` are one operation on a pair.
  template <class OfPack, class OfNumber>
  void numbers(OfPack of_pack, OfNumber of_number, const char* what) const {
    double found[N];
    pk::store(V(of_pack(pk::load<V>(a), pk::load<V>(b))), found);
    for (int i = 0; i < N; ++i) expect(same(found[i], of_number(a[i], b[i])), what, N);
  }
  template <class Of>
  void answers(Of of, const char* what) const {
    const auto found = of(pk::load<V>(a), pk::load<V>(b));
    bool some = false;
    for (int i = 0; i < N; ++i) {
      expect(pk::answer(found, i) == of(a[i], b[i]), what, N);
      some = some || of(a[i], b[i]);
    }
    using pk::any;
    expect(any(found) == some, "any", N);
  }

  void run() const {
    const auto both = [&](auto of, const char* what) { numbers(of, of, what); };
    both([](auto x, auto y) { return x + y; }, "+");
    both([](auto x, auto y) { return x - y; }, "-");
    both([](auto x, auto y) { return x * y; }, "*");
    both([](auto x, auto y) { return x / y; }, "/");
    both([](auto x, auto) { return pk::root(x); }, "root");
    both([](auto x, auto) { return pk::absolute(x); }, "absolute");
    both([](auto x, auto y) { return pk::with_sign(x, y); }, "with_sign");
    both([](auto x, auto y) { return pk::smaller(x, y); }, "smaller");
    both([](auto x, auto y) { return pk::larger(x, y); }, "larger");
    both([](auto x, auto y) { return pk::select(x < y, x, y); }, "select");
    answers([](auto x, auto y) { return x < y; }, "<");
    answers([](auto x, auto y) { return x <= y; }, "<=");
    answers([](auto x, auto y) { return x == y; }, "==");
    answers([](auto x, auto y) { return (x < y) | (x == y); }, "|");
    answers([](auto x, auto y) { return (x <= y) & (y <= x); }, "&");
    const auto bitwise = [&](auto of, const char* what) {
      numbers(
          [&](const V& x, const V& y) { return pk::from_bits<V>(of(pk::bits(x), pk::bits(y))); },
          [&](double x, double y) { return pk::from_bits<double>(of(pk::bits(x), pk::bits(y))); },
          what);
    };
    bitwise([](auto x, auto y) { return x + y; }, "+ of bits");
    bitwise([](auto x, auto y) { return x - y; }, "- of bits");
    bitwise([](auto x, auto y) { return (x & y) | (x ^ y); }, "&, |, ^ of bits");
    bitwise([](auto x, auto) { return (x << 7) + (x >> 52); }, "shifts");
    double found[N];
    pk::store(pk::gather<V>(column, places), found);
    for (int i = 0; i < N; ++i) expect(same(found[i], column[places[i]]), "gather", N);
  }
};

template <int N>
void test(std::mt19937_64& random) {
  for (int i = 0; i < 10'000; ++i) Test<N>(random).run();
}

}  // namespace

int main() {
  std::mt19937_64 random(3);
  test<2>(random);
  test<4>(random);
  test<8>(random);
  test<16>(random);
  std::printf("%d wrong\n", wrong);
  return wrong == 0 ? 0 : 1;
}
