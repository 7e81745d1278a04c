/// Problems of the values of a device file: each out of its bounds, or in contradiction to others.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pindrive.h"
#include "wording.hpp"

namespace pindrive_c {

constexpr int most_pins = 10000;  ///< pins of a device; each is a motion by itself

/// A value that is rejected, in words: "plate.curve[1] speed must be …, got …".
struct Problem {
  const char* key;  ///< in full: "plate.curve"
  Text part;        ///< part of the value: "[1] speed", " slope"; empty: the value itself
  Text required, given;
  std::array<const char*, 4> with;  ///< keys that it contradicts, from the left; null: no more
};

/// Checks values that a device file gives, SI. A key may stand once.
///
/// `whole`: also what only a whole device with magnet, control block and array requires. A key without a
/// value has its usual one. A value that is given but not known contradicts nothing by its size.
std::vector<Problem> problems_of(const pindrive_given* given, std::size_t count, bool whole);

}  // namespace pindrive_c
