/// Packs of 2, 4 or 8 numbers with common operations, and the corresponding operations of a single
/// number.
///
/// A pack is a vector register if the compiler targets one, else two halves. Every operation rounds
/// like that of a double, so that one text gives identical bits for a number and for a pack of any
/// width.
#pragma once

#include <cmath>
#include <cstring>

#include "pindrive/numbers/lanes.hpp"

namespace pindrive::detail {
inline namespace PINDRIVE_TARGET {

// ---- packs -------------------------------------------------------------------------------------

/// Results of a comparison, one for each number of a pack.
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

/// Pack of N numbers.
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

/// Types and size that belong to a number or a pack: count, mask and bits.
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

inline double root(double a) { return std::sqrt(a); }
template <int N>
Pack<N> root(const Pack<N>& a) {
  return Pack<N>::of(Pack<N>::Lanes::root(a.held));
}

/// Reinterprets the bits of numbers.
template <class To, class From>
To same_bits(const From& from) {
  static_assert(sizeof(To) == sizeof(From), "nothing may be left out");
  To to;
  std::memcpy(&to, &from, sizeof to);
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

/// Loads and stores a pack at consecutive places.
template <class V>
V load(const double* from) {
  V a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
/// Loads a pack from given places of a column.
template <class V>
V gather(const double* column, const int* places) {
  if constexpr (Traits<V>::width == 1)
    return column[places[0]];
  else
    return V::of(V::Lanes::gather(column, places));
}
template <class V>
void store(const V& a, double* to) {
  std::memcpy(to, &a, sizeof a);
}

/// Result of a comparison for one number of a pack.
inline bool answer(bool a, int) { return a; }
template <int N>
bool answer(const Mask<N>& a, int i) {
  return a[i];
}

template <class V>
V absolute(const V& a) {
  return from_bits<V>(bits(a) & BitsOf<V>(0x7fffffffffffffffULL));
}
/// Absolute value of a number with the sign of another number.
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
