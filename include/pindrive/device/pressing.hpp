/// Normal force of a plate: weight and preload, a share of the touch, and the pull of the magnet.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "pindrive/device/coil.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::device {

/// Normal force of a plate without a pull, and the touch that is a part of the force.
template <class T>
struct Pressing {
  T normal_force;  ///< at the usual touch, N; > 0
  T touch{0};      ///< N

  /// Factor of the plate friction under a pull (N) and a touch, over the usual one.
  T load(T pull, T touched) const { return 1 + (pull + touch * (touched - 1)) / normal_force; }
  /// Factor of the plate friction under a piece of a pull, on a clock that begins at a time (s), and under a touch: its
  /// factor on the usual one.
  OwnedPiece<T> load_under(const PullPiece<T>& pull, T begin,
                           const LineSince<T>& touched = {T(0), {T(1), T(0)}}) const {
    OwnedPiece<T> found;
    InputPiece<T>& piece = found.piece;
    piece.begin = pull.begin - begin;
    piece.polynomial[0] = 1 + pull.constant / normal_force;
    if (touch != 0) {
      const T part = touch / normal_force;
      piece.polynomial[0] += part * (touched.line.at(piece.begin - touched.since) - 1);
      piece.polynomial[1] = part * touched.line.rate;
    }
    if (pull.once != 0) found.add({pull.once / normal_force, T(0), pull.rate, T(0)});
    if (pull.twice != 0) found.add({pull.twice / normal_force, T(0), 2 * pull.rate, T(0)});
    return found;
  }
};

/// A load from a later time on, s.
template <class T>
OwnedPiece<T> later(OwnedPiece<T> load, const T& time) {
  using detail::exp;
  const T after = time - load.piece.begin;
  load.piece.begin = time;
  load.piece.polynomial[0] += load.piece.polynomial[1] * after;
  for (std::size_t j = 0; j < load.piece.count; ++j)
    load.terms[j].cosine *= exp(-load.terms[j].decay * after);
  return load;
}

/// Factor of the plate friction over time: a piece for each piece of the pull and each line of the touch, on a clock that
/// begins at a time, s.
template <class T>
std::vector<OwnedPiece<T>> loads_under(const std::vector<PullPiece<T>>& pulls,
                                       const Pressing<T>& pressing, const T& begin,
                                       const Profile<double>& touch) {
  const auto touched = [&](double time) -> LineSince<T> {
    const LineSince<double> of = touch.given_line(time);
    return {T(of.since), {T(of.line.value), T(of.line.rate)}};
  };
  std::vector<OwnedPiece<T>> found;
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    const double from = std::max(plain(pulls[i].begin - begin), 0.0);
    const double until = i + 1 < pulls.size() ? plain(pulls[i + 1].begin - begin)
                                              : std::numeric_limits<double>::infinity();
    found.push_back(pressing.load_under(pulls[i], begin, touched(from)));
    if (pressing.touch == 0) continue;
    double before = from;
    for (double row; (row = touch.next_breakpoint(before)) < until; before = row)
      if (touch.turns(before, row))
        found.push_back(later(pressing.load_under(pulls[i], begin, touched(row)), T(row)));
  }
  return found;
}

}  // namespace pindrive::device
