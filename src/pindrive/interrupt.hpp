/// Long computations that Python's Ctrl-C ends.
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>

/// Looks for a signal that Python has not handled yet, now and then; only the main thread finds any.
class Interrupt {
 public:
  /// Returns true to continue; called without Python's lock, after a number of segments, panels or
  /// points.
  bool go_on(std::size_t done = 1) {
    done_ += done;
    if (done_ < between_looks) return !found_;
    done_ = 0;
    return look();
  }
  /// Returns true to continue, with an immediate check.
  bool look() {
    const nanobind::gil_scoped_acquire locked;
    if (!found_ && PyErr_CheckSignals() != 0) found_ = true;
    return !found_;
  }
  bool found() const { return found_; }

 private:
  static constexpr std::size_t between_looks = 1U << 14;  // some milliseconds

  std::size_t done_{0};  ///< since the last look
  bool found_{false};
};

/// Returns the result of a computation during which Python's other threads run. The computation
/// receives a function that returns true to continue, and ends early otherwise; Python's error is
/// then raised.
template <class Computation>
auto interruptible(Computation&& computation) {
  Interrupt interrupt;
  auto result = [&] {
    const nanobind::gil_scoped_release unlocked;
    return computation([&interrupt](std::size_t done = 1) { return interrupt.go_on(done); });
  }();
  if (interrupt.found()) throw nanobind::python_error();
  return result;
}
