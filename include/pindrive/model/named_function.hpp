/// Functions of time that are made of a few numbers: a sinusoid, a stroke of minimum jerk, an exponential.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "pindrive/model/input_function.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive {

/// A kind of function: its name, and the names of its parameters in order; null beyond the last.
struct FunctionKind {
  const char* name;
  std::array<const char*, 4> parameters;

  std::size_t count() const {
    std::size_t n = 0;
    while (n < parameters.size() && parameters[n] != nullptr) ++n;
    return n;
  }
};

inline constexpr FunctionKind function_kinds[] = {
    {"harmonic", {"mean", "amplitude", "frequency", "phase"}},
    {"minimum_jerk", {"distance", "duration", "begin", nullptr}},
    {"exponential", {"start", "end", "time_constant", "begin"}}};

/// The kind of that name; null for an unknown name.
inline const FunctionKind* function_kind(const char* name) {
  for (const FunctionKind& kind : function_kinds)
    if (std::strcmp(kind.name, name) == 0) return &kind;
  return nullptr;
}

/// Pieces of a function, which it owns: at most three, with at most one term each.
template <class T>
struct NamedFunction {
  using Polynomial = std::array<T, InputPiece<T>::degree + 1>;

  std::array<OwnedPiece<T>, 3> pieces{};
  std::size_t count{0};

  OwnedPiece<T>& add(const T& begin, const Polynomial& polynomial) {
    OwnedPiece<T>& added = pieces[count++];
    added.piece.begin = begin;
    added.piece.polynomial = polynomial;
    return added;
  }
};

/// mean + amplitude sin(2π frequency t + phase); the frequency in Hz, the phase in rad. A zero of the sinusoid
/// within the rounding of the phase, as at π, is exact.
template <class T>
NamedFunction<T> harmonic(const T& mean, const T& amplitude, const T& frequency, const T& phase) {
  using std::abs, detail::cos, detail::sin;
  constexpr double turn = 6.283185307179586;  // rad
  const auto exact = [&](T part) {
    const auto error = std::numeric_limits<detail::Real<T>>::epsilon() * abs(plain(phase));
    return abs(plain(part)) <= error ? part - plain(part) : part;
  };
  NamedFunction<T> made;
  made.add(T(0), {mean})
      .add({amplitude * exact(sin(phase)), amplitude * exact(cos(phase)), T(0),
            T(turn) * frequency});
  return made;
}

/// Velocity of a stroke from rest to rest, 30 distance/duration (s² − 2 s³ + s⁴) with s = (t − begin)/duration.
template <class T>
NamedFunction<T> minimum_jerk(const T& distance, const T& duration, const T& begin) {
  const T second = 30 * distance / (duration * duration * duration);
  NamedFunction<T> made;
  if (begin != 0) made.add(T(0), {});
  made.add(begin, {T(0), T(0), second, T(-2) * second / duration, second / (duration * duration)});
  made.add(begin + duration, {});
  return made;
}

/// `start` until its begin, then end + (start − end) e^(−(t − begin)/time_constant).
template <class T>
NamedFunction<T> exponential(const T& start, const T& end, const T& time_constant, const T& begin) {
  NamedFunction<T> made;
  if (begin != 0) made.add(T(0), {start});
  made.add(begin, {end}).add({start - end, T(0), 1 / time_constant, T(0)});
  return made;
}

/// The function of a kind, by its parameters in order.
template <class T>
NamedFunction<T> named_function(const FunctionKind& kind, const std::array<T, 4>& p) {
  if (&kind == &function_kinds[0]) return harmonic(p[0], p[1], p[2], p[3]);
  if (&kind == &function_kinds[1]) return minimum_jerk(p[0], p[1], p[2]);
  return exponential(p[0], p[1], p[2], p[3]);
}

}  // namespace pindrive
