/// Packs of 2, 4, 8 or 16 numbers that are computed with as one, and the same operations for a number.
///
/// A pack is a vector register where the compiler targets one that holds it, else two halves. Every
/// operation rounds as that of a single double does, so a text that is written with these gives the
/// same bits for a number, for a pack of any width, and for a GPU thread.
#pragma once

#ifndef __CUDACC__
#include <cmath>
#include <cstdint>
#include <cstring>
#else
namespace std {
using int64_t = long long;
using uint64_t = unsigned long long;
}  // namespace std
#endif

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
#elif defined(__GNUC__) && !defined(__CUDACC__)
#define PINDRIVE_VECTOR_LANES 2
#endif

/// Names the instruction set that a translation unit is compiled for, so that functions of one are
/// never linked into the code of another.
#ifndef PINDRIVE_TARGET
#define PINDRIVE_TARGET baseline
#endif

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

// ---- how a pack is held ------------------------------------------------------------------------

/// As a number by itself.
struct ScalarLanes {
  using Number = double;
  using Integer = std::uint64_t;
  using Truth = bool;

  static Number all(double a) { return a; }
  static Integer all(std::uint64_t a) { return a; }
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

/// As two packs of half the width.
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
/// As a vector of GCC's and Clang's, a type for each width: of one that depends on a parameter GCC
/// does not see that it is a vector.
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
  static Integer all(std::uint64_t a) {
    Integer result{};
    for (int i = 0; i < N; ++i) result[i] = a;
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
  static Truth equal(Number a, Number b) { return (Truth)(a == b); }
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
/// Comparisons of AVX-512 answer in a register of bits.
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

// ---- packs -------------------------------------------------------------------------------------

/// The answers of a comparison, one for each number of a pack.
template <int N>
struct Mask {
  using Lanes = typename LanesOf<N>::type;
  typename Lanes::Truth held;

  Mask() = default;
  Mask(bool all) : held(Lanes::truth(all)) {}  // NOLINT: one answer for all
  static Mask of(const typename Lanes::Truth& held) {
    Mask result;
    result.held = held;
    return result;
  }
  bool operator[](int i) const { return Lanes::at(held, i); }

  friend Mask operator&(const Mask& a, const Mask& b) { return of(Lanes::both(a.held, b.held)); }
  friend Mask operator|(const Mask& a, const Mask& b) { return of(Lanes::either(a.held, b.held)); }
  friend Mask operator!(const Mask& a) { return of(Lanes::opposite(a.held)); }
  friend bool any(const Mask& a) { return Lanes::any(a.held); }
};

/// N numbers.
template <int N>
struct Pack {
  using Lanes = typename LanesOf<N>::type;
  typename Lanes::Number held;

  Pack() = default;
  Pack(double all) : held(Lanes::all(all)) {}  // NOLINT: one number for all
  static Pack of(const typename Lanes::Number& held) {
    Pack result;
    result.held = held;
    return result;
  }

  friend Pack operator+(const Pack& a, const Pack& b) { return of(Lanes::add(a.held, b.held)); }
  friend Pack operator-(const Pack& a, const Pack& b) {
    return of(Lanes::subtract(a.held, b.held));
  }
  friend Pack operator*(const Pack& a, const Pack& b) {
    return of(Lanes::multiply(a.held, b.held));
  }
  friend Pack operator/(const Pack& a, const Pack& b) { return of(Lanes::divide(a.held, b.held)); }
  friend Mask<N> operator<(const Pack& a, const Pack& b) {
    return Mask<N>::of(Lanes::less(a.held, b.held));
  }
  friend Mask<N> operator<=(const Pack& a, const Pack& b) {
    return Mask<N>::of(Lanes::less_equal(a.held, b.held));
  }
  friend Mask<N> operator>(const Pack& a, const Pack& b) { return b < a; }
  friend Mask<N> operator>=(const Pack& a, const Pack& b) { return b <= a; }
  friend Mask<N> operator==(const Pack& a, const Pack& b) {
    return Mask<N>::of(Lanes::equal(a.held, b.held));
  }
};

/// The 64 bits of each number of a pack, as unsigned integers.
template <int N>
struct PackBits {
  using Lanes = typename LanesOf<N>::type;
  typename Lanes::Integer held;

  PackBits() = default;
  PackBits(std::uint64_t all) : held(Lanes::all(all)) {}  // NOLINT: the same for all
  static PackBits of(const typename Lanes::Integer& held) {
    PackBits result;
    result.held = held;
    return result;
  }

  friend PackBits operator+(const PackBits& a, const PackBits& b) {
    return of(Lanes::plus(a.held, b.held));
  }
  friend PackBits operator-(const PackBits& a, const PackBits& b) {
    return of(Lanes::minus(a.held, b.held));
  }
  friend PackBits operator&(const PackBits& a, const PackBits& b) {
    return of(Lanes::conjunction(a.held, b.held));
  }
  friend PackBits operator|(const PackBits& a, const PackBits& b) {
    return of(Lanes::disjunction(a.held, b.held));
  }
  friend PackBits operator^(const PackBits& a, const PackBits& b) {
    return of(Lanes::difference(a.held, b.held));
  }
  friend PackBits operator<<(const PackBits& a, int count) {
    return of(Lanes::left(a.held, count));
  }
  friend PackBits operator>>(const PackBits& a, int count) {
    return of(Lanes::right(a.held, count));
  }
};

// ---- the same for a number -----------------------------------------------------------------------

/// What goes with a number or a pack: how many it holds, its mask and its bits.
template <class V>
struct Traits;
template <>
struct Traits<double> {
  static constexpr int width = 1;
  using Mask = bool;
  using Bits = std::uint64_t;
};
template <int N>
struct Traits<Pack<N>> {
  static constexpr int width = N;
  using Mask = detail::Mask<N>;
  using Bits = PackBits<N>;
};
template <class V>
using MaskOf = typename Traits<V>::Mask;
template <class V>
using BitsOf = typename Traits<V>::Bits;

inline bool any(bool a) { return a; }
inline double select(bool which, double a, double b) { return which ? a : b; }
template <int N>
Pack<N> select(const Mask<N>& which, const Pack<N>& a, const Pack<N>& b) {
  return Pack<N>::of(Pack<N>::Lanes::choose(which.held, a.held, b.held));
}

inline double root(double a) {
#ifdef __CUDACC__
  return sqrt(a);
#else
  return std::sqrt(a);
#endif
}
template <int N>
Pack<N> root(const Pack<N>& a) {
  return Pack<N>::of(Pack<N>::Lanes::root(a.held));
}

/// The bits of numbers, and back.
template <class To, class From>
To same_bits(const From& from) {
  static_assert(sizeof(To) == sizeof(From), "nothing may be left out");
  To to;
#ifdef __CUDACC__
  memcpy(&to, &from, sizeof to);
#else
  std::memcpy(&to, &from, sizeof to);
#endif
  return to;
}
template <class V>
BitsOf<V> bits(const V& a) {
  return same_bits<BitsOf<V>>(a);
}
template <class V>
V from_bits(const BitsOf<V>& a) {
  return same_bits<V>(a);
}

/// As many numbers as a pack holds, from and to consecutive places.
template <class V>
V load(const double* from) {
  V a;
#ifdef __CUDACC__
  memcpy(&a, from, sizeof a);
#else
  std::memcpy(&a, from, sizeof a);
#endif
  return a;
}
template <class V>
void store(const V& a, double* to) {
#ifdef __CUDACC__
  memcpy(to, &a, sizeof a);
#else
  std::memcpy(to, &a, sizeof a);
#endif
}

/// The answer for one number of a pack.
inline bool answer(bool a, int) { return a; }
template <int N>
bool answer(const Mask<N>& a, int i) {
  return a[i];
}

template <class V>
V absolute(const V& a) {
  return from_bits<V>(bits(a) & BitsOf<V>(0x7fffffffffffffffULL));
}
/// The size of one with the sign of the other.
template <class V>
V with_sign(const V& size, const V& sign) {
  const BitsOf<V> mark(0x8000000000000000ULL);
  return from_bits<V>(bits(absolute(size)) | (bits(sign) & mark));
}
template <class V>
V smaller(const V& a, const V& b) {
  return select(b < a, b, a);
}
template <class V>
V larger(const V& a, const V& b) {
  return select(a < b, b, a);
}

}  // namespace PINDRIVE_TARGET
}  // namespace pindrive::detail
