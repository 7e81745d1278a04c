// An input as Python hands it over.
#pragma once

#include <array>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "owned_motion.hpp"

/// Begin, polynomial, and terms (cosine, sine, decay, frequency) of a piece of a function.
using Piece = std::tuple<double, std::array<double, 6>, std::vector<std::array<double, 4>>>;
/// Rows (time, value) of an input, one row for a constant; or the pieces of a function.
using Input = std::variant<pindrive::Rows, std::vector<Piece>>;

/// Converts a Python tuple to the struct with equal fields.
template <class Struct, class Tuple>
Struct as(Tuple&& tuple) {
  return std::apply([](auto&&... field) { return Struct{std::forward<decltype(field)>(field)...}; },
                    std::forward<Tuple>(tuple));
}

inline pindrive::InputNumbers input_of(Input&& input) {
  if (pindrive::Rows* rows = std::get_if<pindrive::Rows>(&input)) return {std::move(*rows)};
  pindrive::InputNumbers found;
  for (Piece& piece : std::get<std::vector<Piece>>(input))
    found.pieces.push_back(as<pindrive::PieceNumbers>(std::move(piece)));
  return found;
}
