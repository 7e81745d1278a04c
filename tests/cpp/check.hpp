/// Reports of a test: a line for each expectation, and the exit status.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace check {

inline int failures = 0;

inline void expect(bool good, const char* what) {
  std::printf("%s %s\n", good ? "ok  " : "FAIL", what);
  failures += good ? 0 : 1;
}

/// True if two numbers differ by no more than a part of the larger, or of 1.
inline bool near(double one, double other, double part) {
  return std::abs(one - other) <= part * std::max({std::abs(one), std::abs(other), 1.0});
}

inline int status() { return failures == 0 ? 0 : 1; }

}  // namespace check
