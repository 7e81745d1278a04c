// The elementary functions are within 2 units in the last place of quadruple precision over the whole
// range that is used, and give the same bits for a number and for packs of every width.
//
//     elementary_test [COUNT]    so many arguments for each function, 200 000 unless given
#include "pindrive/numbers/elementary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "cases.hpp"

#ifdef PINDRIVE_QUADRUPLE
#include <quadmath.h>
using Long = __float128;
#define EXACT(name) name##q
#else
using Long = long double;
#define EXACT(name) std::name
#endif

namespace pd = pindrive::detail;

namespace {

template <class V>
V function(int which, const V& a, const V& b) {
  switch (which) {
    case 0:
      return pd::sine_and_cosine(a).sine;
    case 1:
      return pd::sine_and_cosine(a).cosine;
    case 2:
      return pd::exponential(a);
    case 3:
      return pd::exponential_minus_1(a);
    case 4:
      return pd::logarithm(a);
    case 5:
      return pd::logarithm_of_1_plus(a);
    case 6:
      return pd::angle_of(a, b);
    case 7:
      return pd::sine_and_cosine_in_turn(a).sine;
    case 8:
      return pd::sine_and_cosine_in_turn(a).cosine;
    default:
      return pd::exponential_in_range(a);
  }
}
Long exact(int which, double a, double b) {
  switch (which) {
    case 0:
      return EXACT(sin)(Long(a));
    case 1:
      return EXACT(cos)(Long(a));
    case 2:
      return EXACT(exp)(Long(a));
    case 3:
      return EXACT(expm1)(Long(a));
    case 4:
      return EXACT(log)(Long(a));
    case 5:
      return EXACT(log1p)(Long(a));
    case 6:
      return EXACT(atan2)(Long(a), Long(b));
    case 7:
      return EXACT(sin)(Long(a));
    case 8:
      return EXACT(cos)(Long(a));
    default:
      return EXACT(exp)(Long(a));
  }
}
constexpr const char* names[] = {"sine",
                                 "cosine",
                                 "exponential",
                                 "exponential_minus_1",
                                 "logarithm",
                                 "logarithm_of_1_plus",
                                 "angle_of",
                                 "sine in a turn",
                                 "cosine in a turn",
                                 "exponential in range"};
/// Ranges of the functions that have a bounded range.
bool outside(int which, double a, double b) {
  if (which == 6) return !(std::max(std::abs(a), std::abs(b)) < 0x1p1022);
  if (which == 9) return !(std::abs(a) <= 700);
  return which > 6 && !(std::abs(a) <= 6.283185307179586);
}

/// An argument of a function: small, large, near what is hard for it.
double drawn(int which, std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double sign = uniform(-1, 1) < 0 ? -1 : 1;
  const double any = sign * std::exp2(uniform(-60, 28)), kind = uniform(0, 1);
  switch (which) {
    case 0:
    case 1:
      if (kind < 0.4) return uniform(-3.2, 3.2);
      if (kind < 0.5) return std::round(uniform(-2.6e8, 2.6e8)) * 1.5707963267948966;
      return any;
    case 2:
    case 3:
      if (kind < 0.3) return uniform(-1, 1);
      if (kind < 0.7) return uniform(-746, 710);
      return sign * std::exp2(uniform(-60, 9));
    case 4:
      if (kind < 0.3) return uniform(0.5, 2);
      if (kind < 0.5) return 1 + sign * std::exp2(uniform(-52, -1));
      return std::exp2(uniform(-1074, 1024));
    case 5:
      if (kind < 0.3) return uniform(-1, 2);
      if (kind < 0.8) return sign * std::exp2(uniform(-1000, -1));
      return std::exp2(uniform(-60, 1024));
    case 7:
    case 8:
      return kind < 0.9 ? uniform(-6.2831853, 6.2831853)
                        : std::round(uniform(-4, 4)) * 1.5707963267948966;
    case 9:
      return kind < 0.5 ? uniform(-30, 1) : uniform(-700, 700);
    default:
      return kind < 0.5 ? uniform(-1, 1) : sign * std::exp2(uniform(-1000, 1000));
  }
}

/// Error of a double in units in the last place.
double off(double found, Long right) {
  const double near = static_cast<double>(right);
  if (std::isnan(near)) return std::isnan(found) ? 0 : INFINITY;
  if (std::isinf(near) || std::isinf(found)) return found == near ? 0 : INFINITY;
  int exponent = 0;
  std::frexp(near, &exponent);
  const double unit = std::ldexp(1.0, std::max(exponent - 53, -1074));
  const Long error = Long(found) - right;
  return static_cast<double>(error < 0 ? -error : error) / unit;
}

bool same(double a, double b) {
  return pd::bits(a) == pd::bits(b) || (std::isnan(a) && std::isnan(b));
}

template <int N>
bool packs_agree(int which, const std::vector<double>& a, const std::vector<double>& b,
                 const std::vector<double>& alone) {
  for (std::size_t i = 0; i + N <= a.size(); i += N) {
    double found[N];
    pd::store(function(which, pd::load<pd::Pack<N>>(&a[i]), pd::load<pd::Pack<N>>(&b[i])), found);
    for (std::size_t k = 0; k < N; ++k)
      if (!same(found[k], alone[i + k])) {
        std::printf("%s(%a, %a): %a in a pack of %d, alone %a\n", names[which], a[i + k], b[i + k],
                    found[k], N, alone[i + k]);
        return false;
      }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : cases(200'000);
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const std::vector<double> edges{0.0,     -0.0,   1.0,     -1.0,   inf,   -inf,  nan,  5e-324,
                                  -5e-324, 1e-308, -745.13, 709.78, 709.8, -800., 800., 1e300};
  bool good = true;
  for (int which = 0; which < 10; ++which) {
    std::mt19937_64 random(12);
    std::vector<double> a(edges), b(edges.size(), 1.0);
    while (a.size() < count) {
      a.push_back(drawn(which, random));
      b.push_back(std::generate_canonical<double, 53>(random) < 0.5
                      ? a.back() * drawn(2, random) / 700
                      : drawn(which, random));
    }
    std::vector<double> alone(a.size());
    double worst = 0, at = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      alone[i] = function(which, a[i], b[i]);
      if (outside(which, a[i], b[i])) continue;
      const bool none = which < 2 && !(std::abs(a[i]) <= pd::largest_angle);
      const double error =
          none ? (std::isnan(alone[i]) ? 0 : INFINITY) : off(alone[i], exact(which, a[i], b[i]));
      if (!(error <= worst)) worst = error, at = a[i];
    }
    good = good && worst <= 2;
    good = packs_agree<2>(which, a, b, alone) && packs_agree<4>(which, a, b, alone) &&
           packs_agree<8>(which, a, b, alone) && good;
    std::printf("%-20s %zu arguments, largest error %.3f units in the last place, at %.17g\n",
                names[which], a.size(), worst, at);
  }
  return good ? 0 : 1;
}
