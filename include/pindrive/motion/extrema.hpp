/// Extrema of a quantity in a segment: in closed form, or from roots of its derivative.
#pragma once

#include <cmath>

#include "pindrive/flow/roots.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/motion/trajectory.hpp"

namespace pindrive::detail {

/// Calls visit(τ, value) at the turning points of an oscillation without drift between two times.
/// Times and values are computed from its start; at `from` a decayed oscillation may have fewer
/// digits.
template <class T, class Visitor>
void turns(const Oscillator<T>& oscillator, const Path<T>& path, T from, T to, Visitor& visit) {
  const Path<T> slope = path.derivative(oscillator);
  const int side = side_after_start(oscillator, slope);
  const Zeros<T> zeros = oscillator.zeros(slope.value, slope.slope);
  if (side == 0 || !(zeros.first < to)) return;
  const T reach = side * oscillator.reach(slope.value, slope.slope);
  T count = zeros.first > from ? T(0) : floor((from - zeros.first) / zeros.spacing);
  for (T tau; (tau = zeros.at(count)) < to; count += T(1)) {
    if (!(tau > from)) continue;
    const bool even = count / 2 == floor(count / 2);
    visit(tau, path.centre() + (even ? reach : -reach) * exp(oscillator.alpha() * tau));
  }
}

/// Calls visit(τ, value) at both ends of a stretch of a path in a segment and at each extremum between
/// them.
template <class T, class Visitor>
void extrema(const ClosedForm<T>& along, const Path<T>& path, T from, T to, Visitor&& visit) {
  visit(from, along.at(path, from));
  if (path.constant() || !(to > from)) return;
  const Oscillator<T>& oscillator = along.oscillator();
  if (path.straight() && oscillator.oscillates()) {
    turns(oscillator, path, from, to, visit);
  } else {
    const Path<T> rest = from > 0 ? path.from(oscillator, from) : path;
    const Path<T> slope = rest.derivative(oscillator);
    const int side = side_after_start(oscillator, slope);
    if (side != 0)
      each_root(oscillator, slope, side, to - from, [&](T tau) {
        visit(from + tau, rest.at(oscillator, tau));
        return true;
      });
  }
  visit(to, along.at(path, to));
}
template <class Trajectory, class Quantity, class T, class Visitor>
void extrema(const Trajectory& along, const Quantity& path, T from, T to, Visitor&& visit) {
  visit(from, path.at(from));
  if (!(to > from)) return;
  const Quantity slope = path.derivative();
  const int side = along.side_after_start(slope);
  if (side != 0)
    along.each_root(slope, side, to, [&](T tau) {
      if (tau > from) visit(tau, path.at(tau));
      return true;
    });
  visit(to, path.at(to));
}

/// Calls visit(τ, value) at the highest and lowest value of a path only. An oscillation with drift
/// has these within a period of an end; the part between is skipped.
template <class T, class Visitor>
void highest_and_lowest(const ClosedForm<T>& along, const Path<T>& path, T from, T to,
                        Visitor&& visit) {
  const T period = along.oscillator().period();
  if (!path.oscillates() || !(to - from > 2 * period)) {
    extrema(along, path, from, to, visit);
    return;
  }
  extrema(along, path, from, from + period, visit);
  extrema(along, path, to - period, to, visit);
}
template <class Trajectory, class Quantity, class T, class Visitor>
void highest_and_lowest(const Trajectory& along, const Quantity& path, T from, T to,
                        Visitor&& visit) {
  extrema(along, path, from, to, visit);
}

}  // namespace pindrive::detail
