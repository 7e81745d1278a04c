#pragma once

/// How many of so many random cases a program takes: a twentieth where sanitizers make each of them cost
/// twenty times as much.
constexpr int cases(int count) {
#ifdef PINDRIVE_SANITIZED
  return count / 20;
#else
  return count;
#endif
}
