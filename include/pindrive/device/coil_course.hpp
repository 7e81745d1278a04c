/// Course of a coil under commands: its pieces, and the pull as rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pindrive/device/coil.hpp"
#include "pindrive/device/electromagnet.hpp"

namespace pindrive::device {

/// Course of a coil from a state on.
struct CoilCourse {
  std::vector<FluxPiece> pieces;     ///< from the state on, in order
  std::vector<double> times, pulls;  ///< rows of the pull: s, N
  CoilState end;                     ///< state at the last change before the end

  /// True if the coil was never on and had no current: the pull is the residual one throughout.
  bool idle() const {
    for (const FluxPiece& piece : pieces)
      if (piece.on || piece.start != 0) return false;
    return true;
  }

  /// Replaces the course by that under a command which each switching before `until` changes. The rows
  /// begin with the last one until `begin` and end with the first one from `until` on. With more than
  /// `most` pieces or rows the course is incomplete. A last change after `begin`, as on another clock,
  /// counts as one at `begin`.
  void follow(const Electromagnet& magnet, CoilState from, const double* switchings,
              std::size_t count, double begin, double until, std::size_t most) {
    most_ = most;
    from.since = std::min(from.since, begin);
    pieces.clear();
    times.clear();
    pulls.clear();
    add(Coil(magnet, from));
    Coil coil = Coil::begun(magnet, from, begin);
    add(coil);
    times.assign(1, coil.line_begin());
    pulls.assign(1, coil.pull(coil.line_begin()));
    for (std::size_t i = 0; i < count && switchings[i] < until; ++i) {
      pass_before(coil, switchings[i]);
      coil.command(!coil.state().command, switchings[i]);
      add(coil);
    }
    pass_before(coil, until);
    if (const double beyond = coil.next_row(); std::isfinite(beyond))
      add_row(beyond, coil.next_pull());
    end = coil.state();
  }

 private:
  bool full() const { return pieces.size() > most_ || times.size() > most_; }

  /// A change at the time itself comes after a command at that time.
  void pass_before(Coil& coil, double to) {
    for (double time = coil.next(); time < to && !full(); time = coil.next()) {
      coil.pass(time);
      add(coil);
    }
  }
  /// Adds the present piece and the row at the begin of the present line, unless they are there.
  void add(const Coil& coil) {
    const FluxPiece& piece = coil.piece();
    if (!pieces.empty() && pieces.back().begin == piece.begin)
      pieces.back() = piece;
    else
      pieces.push_back(piece);
    add_row(coil.line_begin(), coil.pull(coil.line_begin()));
  }
  void add_row(double time, double pull) {
    if (!times.empty() && !(time > times.back())) return;
    times.push_back(time);
    pulls.push_back(pull);
  }

  std::size_t most_{0};
};

}  // namespace pindrive::device
