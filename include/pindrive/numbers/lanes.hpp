/// Storage of a pack: a vector register if the compiler targets one, else two halves.
#pragma once

#include <cmath>
#include <cstdint>

#ifdef PINDRIVE_PLAIN_PACKS  // numbers alone, as for a compiler without vector extensions
#elif defined(__AVX512F__) && defined(__GNUC__)
#include <immintrin.h>
#define PINDRIVE_VECTOR_LANES 8
#elif defined(__AVX2__) && defined(__GNUC__)
#include <immintrin.h>
#define PINDRIVE_VECTOR_LANES 4
#elif defined(__SSE2__) && defined(__GNUC__)
#include <emmintrin.h>
#define PINDRIVE_VECTOR_LANES 2
#elif defined(__GNUC__)
#define PINDRIVE_VECTOR_LANES 2
#endif

/// Name of the instruction set of a translation unit, so that functions for one set are never
/// linked into code for another.
#ifndef PINDRIVE_TARGET
#define PINDRIVE_TARGET baseline
#endif

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

/// Storage as a single number.
struct ScalarLanes {
  using Number = double;
  using Integer = std::uint64_t;
  using Truth = bool;

  static Number all(double a) { return a; }
  static Integer all(std::uint64_t a) { return a; }
  static Number gather(const double* from, const int* places) { return from[places[0]]; }
  static Number add(Number a, Number b) { return a + b; }
  static Number subtract(Number a, Number b) { return a - b; }
  static Number multiply(Number a, Number b) { return a * b; }
  static Number divide(Number a, Number b) { return a / b; }
  static Number root(Number a) { return std::sqrt(a); }
  static Truth less(Number a, Number b) { return a < b; }
  static Truth less_equal(Number a, Number b) { return a <= b; }
  static Truth equal(Number a, Number b) { return a == b; }
  static Number choose(Truth t, Number a, Number b) { return t ? a : b; }
  static Truth both(Truth a, Truth b) { return a && b; }
  static Truth either(Truth a, Truth b) { return a || b; }
  static Truth opposite(Truth a) { return !a; }
  static Truth truth(bool a) { return a; }
  static bool any(Truth a) { return a; }
  static bool at(Truth a, int) { return a; }
  static Integer plus(Integer a, Integer b) { return a + b; }
  static Integer minus(Integer a, Integer b) { return a - b; }
  static Integer conjunction(Integer a, Integer b) { return a & b; }
  static Integer disjunction(Integer a, Integer b) { return a | b; }
  static Integer difference(Integer a, Integer b) { return a ^ b; }
  static Integer left(Integer a, int count) { return a << count; }
  static Integer right(Integer a, int count) { return a >> count; }
};

template <int N>
struct LanesOf;

/// Storage as two packs of half the width.
template <int N>
struct PairLanes {
  using Half = typename LanesOf<N / 2>::type;
  struct Number {
    typename Half::Number low, high;
  };
  struct Integer {
    typename Half::Integer low, high;
  };
  struct Truth {
    typename Half::Truth low, high;
  };

  static Number all(double a) { return {Half::all(a), Half::all(a)}; }
  static Integer all(std::uint64_t a) { return {Half::all(a), Half::all(a)}; }
  static Number gather(const double* from, const int* places) {
    return {Half::gather(from, places), Half::gather(from, places + N / 2)};
  }
  static Number add(const Number& a, const Number& b) {
    return {Half::add(a.low, b.low), Half::add(a.high, b.high)};
  }
  static Number subtract(const Number& a, const Number& b) {
    return {Half::subtract(a.low, b.low), Half::subtract(a.high, b.high)};
  }
  static Number multiply(const Number& a, const Number& b) {
    return {Half::multiply(a.low, b.low), Half::multiply(a.high, b.high)};
  }
  static Number divide(const Number& a, const Number& b) {
    return {Half::divide(a.low, b.low), Half::divide(a.high, b.high)};
  }
  static Number root(const Number& a) { return {Half::root(a.low), Half::root(a.high)}; }
  static Truth less(const Number& a, const Number& b) {
    return {Half::less(a.low, b.low), Half::less(a.high, b.high)};
  }
  static Truth less_equal(const Number& a, const Number& b) {
    return {Half::less_equal(a.low, b.low), Half::less_equal(a.high, b.high)};
  }
  static Truth equal(const Number& a, const Number& b) {
    return {Half::equal(a.low, b.low), Half::equal(a.high, b.high)};
  }
  static Number choose(const Truth& t, const Number& a, const Number& b) {
    return {Half::choose(t.low, a.low, b.low), Half::choose(t.high, a.high, b.high)};
  }
  static Truth both(const Truth& a, const Truth& b) {
    return {Half::both(a.low, b.low), Half::both(a.high, b.high)};
  }
  static Truth either(const Truth& a, const Truth& b) {
    return {Half::either(a.low, b.low), Half::either(a.high, b.high)};
  }
  static Truth opposite(const Truth& a) { return {Half::opposite(a.low), Half::opposite(a.high)}; }
  static Truth truth(bool a) { return {Half::truth(a), Half::truth(a)}; }
  static Integer plus(const Integer& a, const Integer& b) {
    return {Half::plus(a.low, b.low), Half::plus(a.high, b.high)};
  }
  static Integer minus(const Integer& a, const Integer& b) {
    return {Half::minus(a.low, b.low), Half::minus(a.high, b.high)};
  }
  static Integer conjunction(const Integer& a, const Integer& b) {
    return {Half::conjunction(a.low, b.low), Half::conjunction(a.high, b.high)};
  }
  static Integer disjunction(const Integer& a, const Integer& b) {
    return {Half::disjunction(a.low, b.low), Half::disjunction(a.high, b.high)};
  }
  static Integer difference(const Integer& a, const Integer& b) {
    return {Half::difference(a.low, b.low), Half::difference(a.high, b.high)};
  }
  static Integer left(const Integer& a, int count) {
    return {Half::left(a.low, count), Half::left(a.high, count)};
  }
  static Integer right(const Integer& a, int count) {
    return {Half::right(a.low, count), Half::right(a.high, count)};
  }
  static bool any(const Truth& a) { return Half::any(Half::either(a.low, a.high)); }
  static bool at(const Truth& a, int i) {
    return i < N / 2 ? Half::at(a.low, i) : Half::at(a.high, i - N / 2);
  }
};

#ifdef PINDRIVE_VECTOR_LANES
/// Storage as a vector of GCC and Clang, with a type for each width: GCC does not recognise a
/// vector type that depends on a parameter.
template <int N>
struct VectorTypes;
template <>
struct VectorTypes<2> {
  using Number __attribute__((vector_size(16))) = double;
  using Integer __attribute__((vector_size(16))) = std::uint64_t;
  using Truth __attribute__((vector_size(16))) = std::int64_t;
};
template <>
struct VectorTypes<4> {
  using Number __attribute__((vector_size(32))) = double;
  using Integer __attribute__((vector_size(32))) = std::uint64_t;
  using Truth __attribute__((vector_size(32))) = std::int64_t;
};
template <>
struct VectorTypes<8> {
  using Number __attribute__((vector_size(64))) = double;
  using Integer __attribute__((vector_size(64))) = std::uint64_t;
  using Truth __attribute__((vector_size(64))) = std::int64_t;
};

template <int N>
struct VectorLanes {
  using Number = typename VectorTypes<N>::Number;
  using Integer = typename VectorTypes<N>::Integer;
  using Truth = typename VectorTypes<N>::Truth;

  static Number all(double a) {
    Number result{};
    for (int i = 0; i < N; ++i) result[i] = a;
    return result;
  }
  static Integer all(std::uint64_t a) { return Integer{} + a; }
  static Number gather(const double* from, const int* places) {
    Number result{};
    for (int i = 0; i < N; ++i) result[i] = from[places[i]];
    return result;
  }
  static Number add(Number a, Number b) { return a + b; }
  static Number subtract(Number a, Number b) { return a - b; }
  static Number multiply(Number a, Number b) { return a * b; }
  static Number divide(Number a, Number b) { return a / b; }
  static Number root(Number a) {
#if defined(__AVX2__)
    if constexpr (N == 4) return (Number)_mm256_sqrt_pd((__m256d)a);
#endif
#if defined(__SSE2__)
    if constexpr (N == 2) return (Number)_mm_sqrt_pd((__m128d)a);
#endif
    for (int i = 0; i < N; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  }
  static Truth less(Number a, Number b) { return (Truth)(a < b); }
  static Truth less_equal(Number a, Number b) { return (Truth)(a <= b); }
  /// Comparison without == of vectors, which GCC 12 compiles wrongly in halves at -O1 and -O2.
  static Truth equal(Number a, Number b) {
#if defined(__AVX2__)
    if constexpr (N == 4) return (Truth)_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_EQ_OQ);
#endif
#if defined(__SSE2__)
    if constexpr (N == 2) return (Truth)_mm_cmpeq_pd((__m128d)a, (__m128d)b);
#endif
    return (Truth)((a <= b) & (b <= a));
  }
  static Number choose(Truth t, Number a, Number b) {
    return (Number)(((Truth)a & t) | ((Truth)b & ~t));
  }
  static Truth both(Truth a, Truth b) { return a & b; }
  static Truth either(Truth a, Truth b) { return a | b; }
  static Truth opposite(Truth a) { return ~a; }
  static Truth truth(bool a) { return Truth{} - (a ? 1 : 0); }
  static bool any(Truth a) {
#if defined(__AVX2__)
    if constexpr (N == 4) return _mm256_testz_si256((__m256i)a, (__m256i)a) == 0;
#endif
#if defined(__SSE2__)
    if constexpr (N == 2) return _mm_movemask_pd((__m128d)a) != 0;
#endif
    bool found = false;
    for (int i = 0; i < N; ++i) found = found || a[i] != 0;
    return found;
  }
  static bool at(Truth a, int i) { return a[i] != 0; }
  static Integer plus(Integer a, Integer b) { return a + b; }
  static Integer minus(Integer a, Integer b) { return a - b; }
  static Integer conjunction(Integer a, Integer b) { return a & b; }
  static Integer disjunction(Integer a, Integer b) { return a | b; }
  static Integer difference(Integer a, Integer b) { return a ^ b; }
  static Integer left(Integer a, int count) { return a << count; }
  static Integer right(Integer a, int count) { return a >> count; }
};
#endif

#if defined(PINDRIVE_VECTOR_LANES) && PINDRIVE_VECTOR_LANES == 8
/// Storage of AVX-512, whose comparisons return a register of bits.
struct MaskedLanes : VectorLanes<8> {
  using Truth = __mmask8;

  static __m512d raw(Number a) { return (__m512d)a; }
  static Number root(Number a) { return (Number)_mm512_maskz_sqrt_pd(0xff, raw(a)); }
  static Truth less(Number a, Number b) { return _mm512_cmp_pd_mask(raw(a), raw(b), _CMP_LT_OQ); }
  static Truth less_equal(Number a, Number b) {
    return _mm512_cmp_pd_mask(raw(a), raw(b), _CMP_LE_OQ);
  }
  static Truth equal(Number a, Number b) { return _mm512_cmp_pd_mask(raw(a), raw(b), _CMP_EQ_OQ); }
  static Number choose(Truth t, Number a, Number b) {
    return (Number)_mm512_mask_blend_pd(t, raw(b), raw(a));
  }
  static Truth both(Truth a, Truth b) { return _kand_mask8(a, b); }
  static Truth either(Truth a, Truth b) { return _kor_mask8(a, b); }
  static Truth opposite(Truth a) { return _knot_mask8(a); }
  static Truth truth(bool a) { return static_cast<Truth>(a ? 0xff : 0); }
  static bool any(Truth a) { return a != 0; }
  static bool at(Truth a, int i) { return ((a >> i) & 1) != 0; }
};
#endif

template <int N>
struct LanesOf {
  using type = PairLanes<N>;
};
template <>
struct LanesOf<1> {
  using type = ScalarLanes;
};
#ifdef PINDRIVE_VECTOR_LANES
template <>
struct LanesOf<2> {
  using type = VectorLanes<2>;
};
#if PINDRIVE_VECTOR_LANES >= 4
template <>
struct LanesOf<4> {
  using type = VectorLanes<4>;
};
#endif
#if PINDRIVE_VECTOR_LANES >= 8
template <>
struct LanesOf<8> {
  using type = MaskedLanes;
};
#endif
#endif
}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
