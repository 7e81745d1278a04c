/// Long computations that Python's Ctrl-C ends.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>

/// Looks for a signal that Python has not handled yet, now and then; only the main thread finds any.
class Interrupt {
 public:
  /// Returns true to continue; called without Python's lock, after a segment, panel or point.
  bool go_on() {
    if (++calls_ % calls_between_times != 0) return !found_;
    const Clock::time_point now = Clock::now();
    if (now - looked_ < pause) return !found_;
    looked_ = now;
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
  using Clock = std::chrono::steady_clock;
  static constexpr unsigned calls_between_times = 16;
  static constexpr std::chrono::milliseconds pause{10};

  unsigned calls_{0};
  Clock::time_point looked_{Clock::now()};  ///< time of the last look
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
    return computation([&interrupt] { return interrupt.go_on(); });
  }();
  if (interrupt.found()) throw nanobind::python_error();
  return result;
}
