// A mode followed for a time by slow steps or by Taylor series, for the tests of creep and of slow sliders.
#pragma once

#include <cstdio>

#include "pindrive/series/creep.hpp"

namespace slow_steps {

namespace pd = pindrive;

inline int failures = 0;

inline void expect(bool holds, const char* what, double found) {
  if (holds) return;
  ++failures;
  std::printf("%s: %.17g\n", what, found);
}

template <class T>
struct End {
  pd::detail::SeriesState<T> state;
  int steps{0};
  T bounds{0};  ///< sum of the velocity bounds
};

/// Follows a mode for a time: by slow steps where these are valid, or by the Taylor series alone.
template <class T>
End<T> follow(pd::detail::SeriesEquation<T> e, pd::detail::SeriesState<T> state, double duration,
              bool slow) {
  End<T> end{state};
  for (double t = 0; t < duration * (1 - 1e-15) && end.steps < 200000; ++end.steps) {
    const T left = duration - t;
    const pd::detail::SeriesStep<T> step = slow ? pd::detail::series_step(e, end.state, left)
                                                : pd::detail::SeriesFlow<T>(e, end.state, left);
    end.state = step.at(step.span());
    e = e.from(step.span());
    end.bounds += step.v_bound;
    t += double(step.span());
  }
  return end;
}

}  // namespace slow_steps
