/// Functions of time in pieces: sums, and the force of a housing that does not accelerate.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "pindrive/model/model.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive {

/// Piece of an input that is a function: its begin (s), its polynomial in the time since then, and its
/// terms (cosine, sine, decay in 1/s, frequency in rad/s).
template <class T>
struct FunctionPiece {
  T begin{0};
  std::array<T, InputPiece<T>::degree + 1> polynomial{};
  std::vector<std::array<T, 4>> terms{};
};
template <class T>
using FunctionPieces = std::vector<FunctionPiece<T>>;

/// A piece from a time after its begin (s) on.
template <class T>
FunctionPiece<T> later(const FunctionPiece<T>& piece, const T& after) {
  if (detail::vanishes(after)) return piece;
  FunctionPiece<T> found;
  found.begin = piece.begin + after;
  InputPiece<T> polynomial;
  polynomial.polynomial = piece.polynomial;
  polynomial.expand(after, T(1), found.polynomial, InputPiece<T>::degree);
  using detail::cos, detail::exp, detail::sin;
  for (const auto& [cosine, sine, decay, frequency] : piece.terms) {
    const T part = exp(-decay * after), phase = frequency * after;
    const T c = cos(phase) * part, s = sin(phase) * part;
    found.terms.push_back({cosine * c + sine * s, sine * c - cosine * s, decay, frequency});
  }
  return found;
}

/// A function from a time on (s), until its next begin; before the first piece, its first value.
template <class T>
FunctionPiece<T> piece_from(const FunctionPieces<T>& pieces, const T& time) {
  FunctionPiece<T> found;
  const auto next =
      std::find_if(pieces.begin(), pieces.end(), [&](const auto& p) { return p.begin > time; });
  if (next != pieces.begin()) {
    const FunctionPiece<T>& piece = *(next - 1);
    found = later(piece, T(time - piece.begin));
  } else {
    found.polynomial[0] = pieces[0].polynomial[0];
    for (const auto& term : pieces[0].terms) found.polynomial[0] += term[0];
  }
  found.begin = time;
  return found;
}

/// Sum of two functions, each with begins that increase.
template <class T>
FunctionPieces<T> sum_of(const FunctionPieces<T>& one, const FunctionPieces<T>& other) {
  FunctionPieces<T> sum;
  for (std::size_t i = 0, j = 0; i < one.size() || j < other.size();) {
    const bool first = j == other.size() || (i < one.size() && one[i].begin < other[j].begin);
    const T begin = first ? one[i].begin : other[j].begin;
    while (i < one.size() && !(begin < one[i].begin)) ++i;
    while (j < other.size() && !(begin < other[j].begin)) ++j;
    FunctionPiece<T> piece = piece_from(one, begin);
    const FunctionPiece<T> added = piece_from(other, begin);
    for (std::size_t n = 0; n < piece.polynomial.size(); ++n)
      piece.polynomial[n] += added.polynomial[n];
    for (const auto& term : added.terms) piece.terms.push_back(term);
    sum.push_back(std::move(piece));
  }
  return sum;
}

/// The derivative of a function times a factor; zero before the first piece.
template <class T>
FunctionPieces<T> derivative_of(const FunctionPieces<T>& function, const T& factor) {
  FunctionPieces<T> found;
  if (function[0].begin > 0) found.emplace_back();
  for (const FunctionPiece<T>& of : function) {
    FunctionPiece<T>& piece = found.emplace_back();
    piece.begin = of.begin;
    for (std::size_t n = 0; n + 1 < of.polynomial.size(); ++n)
      piece.polynomial[n] = factor * of.polynomial[n + 1] * static_cast<double>(n + 1);
    for (const auto& [cosine, sine, decay, frequency] : of.terms)
      piece.terms.push_back({factor * (frequency * sine - decay * cosine),
                             -factor * (frequency * cosine + decay * sine), decay, frequency});
  }
  return found;
}

/// The integral of a function from t = 0 on, where it is zero. The highest power of a polynomial must be zero.
template <class T>
FunctionPieces<T> integral_of(const FunctionPieces<T>& function) {
  FunctionPieces<T> found{piece_from(function, T(0))};
  for (const FunctionPiece<T>& piece : function)
    if (piece.begin > 0) found.push_back(piece);
  T value{0};  // integral at the begin of a piece
  for (std::size_t i = 0; i < found.size(); ++i) {
    FunctionPiece<T>& piece = found[i];
    for (std::size_t n = piece.polynomial.size(); n-- > 1;)
      piece.polynomial[n] = piece.polynomial[n - 1] / static_cast<double>(n);
    piece.polynomial[0] = value;
    std::vector<std::array<T, 4>> terms;
    for (const auto& [cosine, sine, decay, frequency] : piece.terms) {
      const T size = decay * decay + frequency * frequency;
      if (size == 0) {
        piece.polynomial[1] += cosine;
        continue;
      }
      const T begin = -(decay * cosine + frequency * sine) / size;
      terms.push_back({begin, (frequency * cosine - decay * sine) / size, decay, frequency});
      piece.polynomial[0] -= begin;
    }
    piece.terms = std::move(terms);
    if (i + 1 == found.size()) break;
    const FunctionPiece<T> next = later(piece, T(found[i + 1].begin - piece.begin));
    value = next.polynomial[0];
    for (const auto& term : next.terms) value += term[0];
  }
  return found;
}

}  // namespace pindrive
