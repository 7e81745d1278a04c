#pragma once

#include <cstdlib>

/// How many of so many random cases a program takes: all where PINDRIVE_EXPLORE is set, as by
/// `python3 run.py explore`; otherwise a fifth, or a twentieth where sanitizers make each of them
/// cost twenty times as much.
inline int cases(int count) {
#ifdef PINDRIVE_SANITIZED
  return count / 20;
#else
  return std::getenv("PINDRIVE_EXPLORE") ? count : count / 5;
#endif
}
