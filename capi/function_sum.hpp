/// Sums of functions of time in pieces, as the interfaces in Python and C have them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "owned_motion.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive {

using Pieces = std::vector<PieceNumbers>;

/// A piece from a time after its begin (s) on.
inline PieceNumbers later(const PieceNumbers& piece, double after) {
  if (after == 0) return piece;
  PieceNumbers found;
  found.begin = piece.begin + after;
  InputPiece<double> polynomial;
  polynomial.polynomial = piece.polynomial;
  polynomial.expand(after, 1, found.polynomial, InputPiece<double>::degree);
  for (const auto& [cosine, sine, decay, frequency] : piece.terms) {
    const double part = detail::exp(-decay * after), phase = frequency * after;
    const double c = detail::cos(phase) * part, s = detail::sin(phase) * part;
    found.terms.push_back({cosine * c + sine * s, sine * c - cosine * s, decay, frequency});
  }
  return found;
}

/// A function from a time on (s), until its next begin; before the first piece, its first value.
inline PieceNumbers piece_from(const Pieces& pieces, double time) {
  PieceNumbers found;
  const auto next =
      std::find_if(pieces.begin(), pieces.end(), [&](const auto& p) { return p.begin > time; });
  if (next != pieces.begin()) {
    const PieceNumbers& piece = *(next - 1);
    found = later(piece, time - piece.begin);
  } else {
    found.polynomial[0] = pieces[0].polynomial[0];
    for (const auto& term : pieces[0].terms) found.polynomial[0] += term[0];
  }
  found.begin = time;
  return found;
}

/// Sum of two functions.
inline Pieces sum_of(const Pieces& one, const Pieces& other) {
  std::vector<double> begins;
  for (const Pieces* pieces : {&one, &other})
    for (const PieceNumbers& piece : *pieces) begins.push_back(piece.begin);
  std::sort(begins.begin(), begins.end());
  begins.erase(std::unique(begins.begin(), begins.end()), begins.end());
  Pieces sum;
  for (const double begin : begins) {
    PieceNumbers piece = piece_from(one, begin);
    const PieceNumbers added = piece_from(other, begin);
    for (std::size_t n = 0; n < piece.polynomial.size(); ++n)
      piece.polynomial[n] += added.polynomial[n];
    piece.terms.insert(piece.terms.end(), added.terms.begin(), added.terms.end());
    sum.push_back(std::move(piece));
  }
  return sum;
}

/// An input as a function; of two rows at one time, the later value holds.
inline Pieces as_function(const InputNumbers& input) {
  if (!input.pieces.empty()) return input.pieces;
  Pieces pieces;
  for (std::size_t i = 0; i < input.rows.size(); ++i) {
    const bool last = i + 1 == input.rows.size();
    const auto [time, value] = input.rows[i];
    if (!last && input.rows[i + 1].first == time) continue;
    PieceNumbers& piece = pieces.emplace_back();
    piece.begin = time;
    piece.polynomial[0] = value;
    if (!last)
      piece.polynomial[1] = (input.rows[i + 1].second - value) / (input.rows[i + 1].first - time);
  }
  return pieces;
}

}  // namespace pindrive
