#pragma once

#include <cstdlib>

/// Number of random cases of a program: all where PINDRIVE_EXPLORE is set, as by
/// `python3 run.py explore`; otherwise a fifth, or a twentieth under sanitizers, which take
/// twenty times as long.
inline int cases(int count) {
#ifdef PINDRIVE_SANITIZED
  return count / 20;
#else
  return std::getenv("PINDRIVE_EXPLORE") ? count : count / 5;
#endif
}
