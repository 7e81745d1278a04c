/// Elementary functions sin, cos, exp, expm1, log, log1p and atan2 from + − × ÷ and the bits of
/// numbers.
///
/// One text for a number and for packs of numbers gives identical bits everywhere, unlike the libraries of systems and compilers. Each function is within 2 units in
/// the last place over its stated range. The coefficients are minimax polynomials from
/// tests/oracle/make_polynomials.py.
#pragma once

#include "pindrive/numbers/pack.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// Largest angle of `sine_and_cosine`, rad; neighbouring doubles beyond are at least 6e-8 rad
/// apart.
inline constexpr double largest_angle = 4.2e8;

/// terms[0] + terms[1] x + … in two independent halves.
template <class V, int Count>
V by_halves(const V& x, const V (&terms)[Count]) {
  if constexpr (Count == 1) {
    return terms[0];
  } else {
    V halves[(Count + 1) / 2];
    for (int i = 0; i < Count / 2; ++i) halves[i] = terms[2 * i] + x * terms[2 * i + 1];
    if constexpr (Count % 2 == 1) halves[Count / 2] = terms[Count - 1];
    return by_halves(x * x, halves);
  }
}

/// c[0] + c[1] x + …
template <class V, int Count>
V polynomial(const V& x, const double (&c)[Count]) {
  V terms[Count];
  for (int i = 0; i < Count; ++i) terms[i] = V(c[i]);
  return by_halves(x, terms);
}

/// Sum with its rounding error.
template <class V>
struct Sum {
  V value, rest;
};
template <class V>
Sum<V> exact_sum(const V& a, const V& b) {
  const V sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// Nearest integer to a number below 2^51 in size, as a number and in the low bits of a second
/// number.
template <class V>
struct Nearest {
  V value;
  BitsOf<V> low;

  explicit Nearest(const V& a) {
    const V shifter(6755399441055744.0);  // 1.5 · 2^52: what is added to it rounds to an integer
    const V shifted = a + shifter;
    value = shifted - shifter;
    low = bits(shifted);
  }
  /// 2 to this power, within the range of doubles.
  V power_of_two() const { return from_bits<V>((low + BitsOf<V>(1023)) << 52); }
};

// ---- sine and cosine ---------------------------------------------------------------------------

template <class V>
struct Circular {
  V sine, cosine;
};

/// Sine and cosine of a number of quarter turns plus the angle r + low, |r| <= π/4.
template <class V>
Circular<V> quarters_and_rest(const BitsOf<V>& quarters, const V& r, const V& low) {
  using Bits = BitsOf<V>;
  const V z = r * r;
  static constexpr double of_sine[] = {-0x1.555555555554cp-3,  0x1.111111110fc3bp-7,
                                       -0x1.a01a019c74e08p-13, 0x1.71de35c1d84fep-19,
                                       -0x1.ae5e9990905b5p-26, 0x1.5da06ab559f2fp-33};
  static constexpr double of_cosine[] = {0x1.5555555555554p-5,  -0x1.6c16c16c16138p-10,
                                         0x1.a01a019e1c170p-16, -0x1.27e4f8fd5ae45p-22,
                                         0x1.1eea86e70074bp-29, -0x1.8ffa3fbcc3456p-37};
  const V half = V(0.5) * z, whole = V(1.0) - half;
  const V sine = r + (r * z * polynomial(z, of_sine) + low * whole);
  const V cosine =
      whole + (((V(1.0) - whole) - half) + (z * z * polynomial(z, of_cosine) - r * low));

  // The number of quarters exchanges sine and cosine and changes signs.
  const Bits odd = Bits(0) - (quarters & Bits(1));
  const Bits exchanged = (bits(sine) ^ bits(cosine)) & odd;
  const Bits of_sine_sign = (quarters & Bits(2)) << 62;
  const Bits of_cosine_sign = ((quarters + Bits(1)) & Bits(2)) << 62;
  return {from_bits<V>((bits(sine) ^ exchanged) ^ of_sine_sign),
          from_bits<V>((bits(cosine) ^ exchanged) ^ of_cosine_sign)};
}

/// Sine and cosine of |angle| <= largest_angle, rad; NaN beyond.
template <class V>
Circular<V> sine_and_cosine(const V& angle) {
  constexpr double outside = __builtin_nan("");
  const V x = select(absolute(angle) <= V(largest_angle), angle, V(outside));
  const Nearest<V> turns(x * V(0x1.45f306dc9c883p-1));  // quarters of a turn, below 2^28
  // π/2 in parts of 25 bits, whose products are exact; the differences with the first two are, too.
  const V n = turns.value;
  const V near = (x - n * V(0x1.921fb5p+0)) - n * V(0x1.110b46p-26);
  const Sum<V> third = exact_sum(near, V(0.0) - n * V(0x1.1a6263p-54));
  const Sum<V> fourth = exact_sum(third.value, V(0.0) - n * V(0x1.8a2e03p-81));
  const V rest =
      (third.rest + fourth.rest) - (n * V(0x1.c1cd12p-107) + n * V(0x1.2049c1114cf99p-132));
  const V r = fourth.value + rest;
  return quarters_and_rest(turns.low, r, (fourth.value - r) + rest);
}

/// Sine and cosine of |angle| <= 2π, rad, at less cost.
template <class V>
Circular<V> sine_and_cosine_in_turn(const V& angle) {
  const Nearest<V> turns(angle * V(0x1.45f306dc9c883p-1));
  // The first part of π/2 has 50 bits: its products and the difference are exact.
  const V near = angle - turns.value * V(0x1.921fb54442d18p+0);
  const V rest = turns.value * V(0x1.1a62633145c07p-54), r = near - rest;
  return quarters_and_rest(turns.low, r, (near - r) - rest);
}

// ---- exponentials ------------------------------------------------------------------------------

/// x = n log 2 + r with |r| <= log(2)/2, and e^r − 1 = r + change.
template <class V>
struct Exponent {
  Nearest<V> n;
  V r, change;

  explicit Exponent(const V& x) : n(x * V(0x1.71547652b82fep+0)) {
    const V high = x - n.value * V(0x1.62e42fefa2p-1), low = n.value * V(0x1.9ef35793c7673p-41);
    r = high - low;
    const V rest = (high - r) - low;
    static constexpr double of_rest[] = {
        0x1.5555555555558p-3,  0x1.5555555555558p-5,  0x1.111111110f981p-7,  0x1.6c16c16c14c7fp-10,
        0x1.a01a01aee73dbp-13, 0x1.a01a01aed289cp-16, 0x1.71ddfa995ceefp-19, 0x1.27e4c8ddccfb8p-22,
        0x1.af5b1583d1e5fp-26, 0x1.1f9136411727ep-29};
    const V z = r * r;
    change = rest + (V(0.5) * z + z * r * polynomial(r, of_rest));
  }
};

/// e^x for |x| <= 700, for less.
template <class V>
V exponential_in_range(const V& x) {
  const Exponent<V> e(x);
  return (V(1.0) + (e.r + e.change)) * e.n.power_of_two();
}

/// e^x for every x, with subnormal, zero and infinite results.
template <class V>
V exponential(const V& given) {
  const V x = smaller(larger(given, V(-746.0)), V(710.0));
  const Exponent<V> e(x);
  const V value = V(1.0) + (e.r + e.change);
  // In two factors, so that the last one alone rounds where the result is subnormal.
  const Nearest<V> half(V(0.5) * e.n.value), other(e.n.value - half.value);
  const V result = value * half.power_of_two() * other.power_of_two();
  return select(given == given, result, given);
}

/// e^x − 1 for |x| <= 50, for less.
template <class V>
V exponential_minus_1_in_range(const V& x) {
  const Exponent<V> e(x);
  const V scale = e.n.power_of_two();
  const Sum<V> sum = exact_sum(scale - V(1.0), scale * e.r);
  return sum.value + (sum.rest + scale * e.change);
}

/// e^x − 1 for every x.
template <class V>
V exponential_minus_1(const V& x) {
  const V near = exponential_minus_1_in_range(smaller(larger(x, V(-50.0)), V(50.0)));
  return select(absolute(x) < V(50.0), near, exponential(x) - V(1.0));
}

// ---- logarithms --------------------------------------------------------------------------------

/// log(x + rest), x > 0 and normal, rest less than half a unit in the last place of x.
template <class V>
V logarithm_of_sum(const V& x, const V& rest) {
  using Bits = BitsOf<V>;
  // x = 2^e m with m in [√½, √2).
  const Bits one(0x3ff0000000000000ULL), root_of_half(0x3fe6a09e667f3bcdULL);
  const Bits exponent = (bits(x) + (one - root_of_half)) >> 52;
  const V m = from_bits<V>((bits(x) - (exponent << 52)) + one);
  const V e = from_bits<V>(exponent | Bits(0x4330000000000000ULL)) - V(0x1p52 + 1023.0);
  // With s = f/(2 + f), log(1 + f) = 2 artanh s = 2s + s R(s²) and 2s = f − s f.
  const V f = m - V(1.0), s = f / (V(2.0) + f), z = s * s;
  static constexpr double of_rest[] = {
      0x1.555555555556fp-1, 0x1.9999999989a9ep-2, 0x1.2492493a5fbebp-2, 0x1.c71c578fbf36ep-3,
      0x1.74653524ff3eep-3, 0x1.39ba98fb43cd0p-3, 0x1.2e1a68b3bd55bp-3};
  const V correction = s * (f - z * polynomial(z, of_rest));
  const Sum<V> sum = exact_sum(e * V(0x1.62e42fefa2p-1), f);
  return sum.value + ((sum.rest + (e * V(0x1.9ef35793c7673p-41) + rest / x)) - correction);
}

/// log x for x >= 0; −∞ at 0, NaN below.
template <class V>
V logarithm(const V& x) {
  const MaskOf<V> tiny = x < V(0x1p-1022);  // subnormal
  const V scaled = select(tiny, x * V(0x1p54), x);
  const V value = logarithm_of_sum(scaled, V(0.0));
  const V result = select(tiny, value - V(54 * 0x1.62e42fefa39efp-1), value);
  constexpr double infinite = __builtin_inf(), none = __builtin_nan("");
  const V edge = select(x == V(0.0), V(-infinite), select(x == V(infinite), x, V(none)));
  return select((V(0.0) < x) & (x < V(infinite)), result, edge);
}

/// log(1 + x) for x >= −1; −∞ at −1, NaN below.
template <class V>
V logarithm_of_1_plus(const V& x) {
  const Sum<V> sum = exact_sum(V(1.0), x);
  constexpr double infinite = __builtin_inf(), none = __builtin_nan("");
  const V value = logarithm_of_sum(sum.value, sum.rest);
  const V edge = select(x == V(-1.0), V(-infinite), select(x == V(infinite), x, V(none)));
  return select((V(-1.0) < x) & (x < V(infinite)), value, edge);
}

// ---- the angle of a point ----------------------------------------------------------------------

/// Angle in [−π, π] of the point (x, y) with |x|, |y| < 2^1022; 0 at the origin. −0 as x counts as
/// 0.
template <class V>
V angle_of(const V& y, const V& x) {
  using Mask = MaskOf<V>;
  const V height = absolute(y), width = absolute(x);
  const Mask steep = width < height, backward = x < V(0.0);
  const V less = select(steep, width, height), more = select(steep, height, width);
  // Beyond π/8 the angle is counted from π/4.
  const Mask from_middle = V(0x1.a827999fcef32p-2) * more < less;
  const V numerator = select(from_middle, less - more, less);
  const V denominator = select(from_middle, less + more, more);
  const V t = numerator / select(denominator == V(0.0), V(1.0), denominator);
  static constexpr double of_rest[] = {
      -0x1.555555555554dp-2, 0x1.999999999769ap-3, -0x1.249249235209ap-3, 0x1.c71c711f3bdc2p-4,
      -0x1.745cfeaba060ep-4, 0x1.3b1177cad5e61p-4, -0x1.10ef9c164fb7dp-4, 0x1.df441417ba7ecp-5,
      -0x1.9db1eb8c7d57dp-5, 0x1.39ec88aa999e4p-5, -0x1.29c05c11dc2d7p-6};
  const V z = t * t, rest = t * z * polynomial(z, of_rest);
  // So many quarters of π, plus or minus arctan t; their products with the 50 bits are exact.
  V quarters = select(from_middle, V(1.0), V(0.0)), side(1.0);
  quarters = select(steep, V(2.0) - quarters, quarters);
  side = select(steep, V(0.0) - side, side);
  quarters = select(backward, V(4.0) - quarters, quarters);
  side = select(backward, V(0.0) - side, side);
  const V angle = quarters * V(0x1.921fb54442d18p-1) +
                  (side * t + (side * rest + quarters * V(0x1.1a62633145c07p-55)));
  return with_sign(angle, y);
}

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
