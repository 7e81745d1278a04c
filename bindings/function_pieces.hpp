/// Functions that are made of a few numbers, as pieces of pindrive.h.
#pragma once

#include <algorithm>
#include <cstddef>

#include "pindrive.h"
#include "pindrive/model/named_function.hpp"

namespace pindrive_c {

/// Writes the pieces of a function, each number through `number`; there is room for three pieces, and a term of each.
template <class T, class Number>
void write_pieces(const pindrive::NamedFunction<T>& function, Number&& number,
                  pindrive_piece* pieces, pindrive_term* terms) {
  for (std::size_t i = 0; i < function.count; ++i) {
    const pindrive::InputPiece<T>& piece = function.pieces[i].piece;
    if (piece.count > 0) {
      const pindrive::InputTerm<T>& term = piece.terms[0];
      terms[i] = {number(term.cosine), number(term.sine), number(term.decay),
                  number(term.frequency)};
    }
    pieces[i].begin = number(piece.begin);
    std::transform(piece.polynomial.begin(), piece.polynomial.end(), pieces[i].polynomial, number);
    pieces[i].terms = piece.count > 0 ? &terms[i] : nullptr;
    pieces[i].count = piece.count;
  }
}

}  // namespace pindrive_c
