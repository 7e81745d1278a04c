/// Wording of a refused value, common to all interfaces.
#pragma once

#include <cmath>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "pindrive/device/inputs.hpp"

namespace pindrive_c {

/// Text in a buffer of fixed size; an overflow is left out.
class Text {
 public:
  const char* get() const { return text_; }

#if defined(__GNUC__)
  __attribute__((format(printf, 2, 3)))
#endif
  void add(const char* format, ...) {
    std::va_list given;
    va_start(given, format);
    std::vsnprintf(text_ + std::strlen(text_), sizeof text_ - std::strlen(text_), format, given);
    va_end(given);
  }
  /// Adds a number with up to six digits: "1e-6".
  void add_brief(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", value);
    char* const exponent = std::strchr(digits, 'e');
    if (!exponent) return add("%s", digits);
    const char* rest = exponent + 1;
    const bool negative = *rest == '-';
    rest += std::strspn(rest, "+-");
    rest += std::strspn(rest, "0");
    *exponent = 0;
    add("%se%s%s", digits, negative ? "-" : "", rest);
  }
  /// Adds a number with the fewest digits that identify it, as Python writes it: "0.02", "1.0", "1e-05".
  void add_number(double value) {
    char digits[400];
    int decimals = 0;
    do {
      std::snprintf(digits, sizeof digits, "%.*e", decimals, value);
    } while (std::strtod(digits, nullptr) != value && ++decimals < 17);
    const char* const mark = std::strchr(digits, 'e');
    if (!std::isfinite(value) || !mark) return add("%s", std::isnan(value) ? "nan" : digits);
    const int exponent = std::atoi(mark + 1);
    if (exponent >= -4 && exponent < 16) {
      const int places = decimals - exponent;
      std::snprintf(digits, sizeof digits, "%.*f", places > 1 ? places : 1, value);
    }
    add("%s", digits);
  }
  /// Adds a number with its unit, which may be empty.
  void add_number(double value, const char* unit) {
    add_number(value);
    if (*unit != 0) add(" %s", unit);
  }

 private:
  char text_[192] = "";
};

/// Adds bounds in words: "finite and greater than 0 kg".
inline void add_bounds(Text& text, const pindrive::device::Bounds& bounds, const char* unit) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto end = [&](double value) {
    text.add_brief(value);
    if (*unit != 0) text.add(" %s", unit);
  };
  const bool beside = !std::isnan(bounds.also);
  if (beside) {
    if (bounds.also == never)
      text.add("infinite");
    else
      end(bounds.also);
    text.add(" or ");
  }
  bool first = true;
  const auto part = [&](const char* words) {
    text.add("%s%s", first ? "" : " and ", words);
    first = false;
  };
  if (!beside && !(bounds.upper == never && bounds.upper_closed)) part("finite");
  if (bounds.lower > -never) {
    part(bounds.lower_closed ? "at least " : "greater than ");
    end(bounds.lower);
  }
  if (bounds.upper < never) {
    part(bounds.upper_closed ? "at most " : "less than ");
    end(bounds.upper);
  }
}

/// Unit of an input as it follows a number; empty for a plain number.
inline const char* unit_of(const pindrive::device::InputQuantity& input) {
  return std::strcmp(input.unit, "1") == 0 ? "" : input.unit;
}

}  // namespace pindrive_c
