/// Course of a coil under commands: the pieces of its flux and of its pull.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pindrive/device/coil.hpp"
#include "pindrive/device/electromagnet.hpp"

namespace pindrive::device {

/// Course of a coil from a state on.
template <class T>
struct CoilCourse {
  std::vector<FluxPiece<T>> pieces;  ///< from the state on, in order
  std::vector<PullPiece<T>> pulls;   ///< from the begin on, in order
  CoilState<T> end;                  ///< state at the last change before the end

  /// True if the coil was never on and had no current: the pull is the residual one throughout.
  bool idle() const {
    for (const FluxPiece<T>& piece : pieces)
      if (piece.on || piece.start != 0) return false;
    return true;
  }

  /// Replaces the course by that under a command which each switching before `until` changes. With more than
  /// `most` pieces the course is incomplete. A last change after `begin`, as on another clock, counts as one at
  /// `begin`.
  void follow(const Electromagnet<T>& magnet, CoilState<T> from, const T* switchings,
              std::size_t count, T begin, T until, std::size_t most) {
    most_ = most;
    from.since = std::min(from.since, begin);
    pieces.clear();
    add(Coil<T>(magnet, from));
    Coil<T> coil = Coil<T>::begun(magnet, from, begin);
    pulls.clear();
    add(coil);
    for (std::size_t i = 0; i < count && switchings[i] < until; ++i) {
      pass_before(coil, switchings[i]);
      coil.command(!coil.state().command, switchings[i]);
      add(coil);
    }
    pass_before(coil, until);
    end = coil.state();
  }

 private:
  bool full() const { return pieces.size() > most_; }

  /// A change at the time itself comes after a command at that time.
  void pass_before(Coil<T>& coil, T to) {
    for (T time = coil.next(); time < to && !full(); time = coil.next()) {
      coil.pass(time);
      add(coil);
    }
  }
  /// Adds the present pieces; a piece without a duration is replaced.
  void add(const Coil<T>& coil) {
    put(pieces, coil.piece());
    put(pulls, coil.pull_piece());
  }
  template <class Piece>
  static void put(std::vector<Piece>& all, const Piece& piece) {
    if (!all.empty() && !(piece.begin > all.back().begin))
      all.back() = piece;
    else
      all.push_back(piece);
  }

  std::size_t most_{0};
};

}  // namespace pindrive::device
