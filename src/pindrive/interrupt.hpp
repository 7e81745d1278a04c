/// Long computations that Python's Ctrl-C ends.
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>

/// Looks for a signal that Python has not handled yet, now and then; only the main thread finds any.
class Interrupt {
 public:
  /// Whether to go on; called without Python's lock, once a segment, panel or point.
  bool go_on() {
    if (++calls_ % between_looks != 0) return !found_;
    return look();
  }
  /// The same, looking at once.
  bool look() {
    const nanobind::gil_scoped_acquire locked;
    if (!found_ && PyErr_CheckSignals() != 0) found_ = true;
    return !found_;
  }
  bool found() const { return found_; }

 private:
  static constexpr std::size_t between_looks = 1U << 14;  // some milliseconds

  std::size_t calls_{0};
  bool found_{false};
};

/// What a computation returns, during which Python's other threads run. It is handed a function that
/// says whether to go on, and ends early where that returns false: then Python's error is raised.
template <class Computation>
auto interruptible(Computation&& computation) {
  Interrupt interrupt;
  auto result = [&] {
    const nanobind::gil_scoped_release unlocked;
    return computation([&interrupt] { return interrupt.go_on(); });
  }();
  if (interrupt.found()) throw nanobind::python_error();
  return result;
}
