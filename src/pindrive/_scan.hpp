/// Device and scan with the arrays to which they refer, as Python gives them.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <iterator>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "_contact.hpp"
#include "arrays.hpp"
#include "bytes.hpp"
#include "interrupt.hpp"
#include "owned_motion.hpp"
#include "pindrive/device/compliant_hand.hpp"
#include "pindrive/device/hand_path.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/device/scan.hpp"

namespace pindrive_python {

namespace nb = nanobind;
namespace pd = pindrive;
namespace device = pindrive::device;

using Table = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
/// Luminance (rows, columns); size of a pixel; left and top of the page.
using RasterNumbers = std::tuple<Table, double, double, double>;
/// Times, velocity (x, y), place (x, y), one row each; bends (x, y) of the stretches, or none.
using PathNumbers = std::tuple<Column, Column, Column, Column, Column, Table, Table>;

inline device::Raster raster_of(const RasterNumbers& given) {
  const auto& [luminance, pixel, left, top] = given;
  return {luminance.data(),
          static_cast<std::int64_t>(luminance.shape(0)),
          static_cast<std::int64_t>(luminance.shape(1)),
          pixel,
          {left, top}};
}
inline device::HandPath path_of(const PathNumbers& given) {
  const auto& [times, vx, vy, x, y, bend_x, bend_y] = given;
  const auto bends = [](const Table& of) {
    return of.shape(0) > 0 ? reinterpret_cast<const device::Bend*>(of.data()) : nullptr;
  };
  return {times.data(), vx.data(),    vy.data(),     x.data(),
          y.data(),     times.size(), bends(bend_x), bends(bend_y)};
}

/// Mass, stiffness, damping; plate, finger; travel, stiffness and damping of the end stops.
using DriveNumbers = std::tuple<double, double, double, ContactNumbers, ContactNumbers,
                                std::tuple<double, double, double>>;
/// Numbers of an electromagnet in the order of MagnetParameters; rows (time, level) of its voltage.
using MagnetNumbers = std::pair<std::vector<double>, pd::Rows>;
/// Sample rate, latency, threshold, hysteresis.
using ControlNumbers = std::tuple<double, double, double, double>;
/// Since, flux, warming, level, commanded; on, command.
using CoilNumbers = std::tuple<double, double, double, double, double, bool, bool>;
/// Position, velocity, stretch; coil; decision, pending switchings; numbers of the motion, none of a release.
using StateNumbers =
    std::tuple<double, double, double, CoilNumbers, bool, std::vector<double>, std::vector<double>>;

/// Numbers of a state, in the order of its bytes.
struct ToNumbers {
  std::vector<double> list;

  template <class N>
  void item(const N& number) {
    list.push_back(static_cast<double>(number));
  }
};
struct FromNumbers {
  const std::vector<double>& list;
  std::size_t next{0};

  template <class N>
  void item(N& number) {
    number = static_cast<N>(list.at(next++));
  }
};

inline std::vector<double> numbers_of(pd::StepperState<double> state) {
  ToNumbers numbers;
  pindrive_c::exchange(numbers, state);
  return std::move(numbers.list);
}
inline std::optional<pd::StepperState<double>> motion_of(const std::vector<double>& given) {
  if (given.empty()) return {};
  pd::StepperState<double> state{};
  FromNumbers numbers{given};
  pindrive_c::exchange(numbers, state);
  return state;
}

/// An electromagnet whose numbers are each made of a number and its derivative.
template <class T, class Made>
device::Electromagnet<T> magnet_with(const MagnetNumbers& given, const MagnetNumbers& along,
                                     Made&& made) {
  const auto number = [&](std::size_t i) { return made(given.first.at(i), along.first.at(i)); };
  std::vector<device::VoltageStep<T>> steps;
  for (std::size_t i = 0; i < given.second.size(); ++i)
    steps.push_back(
        {given.second[i].first, made(given.second[i].second, along.second.at(i).second)});
  return device::Electromagnet<T>(
      {number(0), number(1), number(2), number(3), number(4), number(5), number(6), number(7),
       number(8), number(9), number(10), number(11), number(12), number(13)},
      std::move(steps));
}
inline device::Electromagnet<double> magnet_of(const MagnetNumbers& given) {
  return magnet_with<double>(given, given, [](double value, double) { return value; });
}

inline device::CoilState<double> coil_of(const CoilNumbers& given) {
  const auto& [since, flux, warming, level, commanded, on, command] = given;
  return {since, flux, warming, level, commanded, on, command};
}
inline CoilNumbers numbers_of(const device::CoilState<double>& s) {
  return {s.since, s.flux, s.warming, s.level, s.commanded, s.on, s.command};
}

/// Device with the arrays to which it refers.
class OwnedDevice {
 public:
  OwnedDevice(const DriveNumbers& drive, std::pair<double, double> pressing,
              const MagnetNumbers& magnet, const ControlNumbers& control, double axis,
              const Table& spots)
      : plate_(contact_of(std::get<3>(drive)), contact_of(std::get<3>(drive))),
        finger_(contact_of(std::get<4>(drive)), contact_of(std::get<4>(drive))),
        device_{drive_of(drive),
                {pressing.first, pressing.second},
                std::get<6>(std::get<4>(drive)),
                magnet_of(magnet),
                controller_of(control),
                device::Axis(axis),
                spots_of(spots)} {}
  OwnedDevice(const OwnedDevice&) = delete;
  OwnedDevice& operator=(const OwnedDevice&) = delete;

  const device::Device& view() const { return device_; }

 private:
  pd::Drive<double> drive_of(const DriveNumbers& given) const {
    const auto& [travel, stiffness, damping] = std::get<5>(given);
    return {std::get<0>(given), std::get<1>(given), std::get<2>(given),
            plate_.contact,     finger_.contact,    {travel, stiffness, damping}};
  }
  static device::Controller controller_of(const ControlNumbers& given) {
    const auto& [rate, latency, threshold, hysteresis] = given;
    return {rate, latency, threshold, hysteresis};
  }
  static std::vector<device::Place> spots_of(const Table& spots) {
    std::vector<device::Place> found;
    for (std::size_t i = 0; i < spots.shape(0); ++i) found.push_back({spots(i, 0), spots(i, 1)});
    return found;
  }

  pd::OwnedContact<double> plate_, finger_;
  device::Device device_;
};

/// Scan with all that it refers to.
class Scan {
 public:
  /// The device must outlive it.
  Scan(const OwnedDevice& device, RasterNumbers raster, PathNumbers path, const pd::Rows& touch,
       const std::vector<StateNumbers>& states)
      : raster_(std::move(raster)),
        path_(std::move(path)),
        touch_(touch, touch),
        velocity_(path_of(path_), device.view().axis),
        inputs_{device.view(),
                raster_of(raster_),
                path_of(path_),
                velocity_,
                touch_.profile().to_the(device.view().load_exponent),
                path_of(path_).begin()} {
    for (const auto& [position, velocity, stretch, coil, decision, pending, motion] : states)
      states_.push_back(
          {position, velocity, stretch, coil_of(coil), decision, pending, motion_of(motion)});
    runs_.resize(states_.size());
    motions_.resize(states_.size());
  }
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  std::size_t size() const { return runs_.size(); }

  /// Samples the page and switches the coils; returns the numbers of switchings and of input rows until
  /// one of them exceeds its limit, and the number of pins so far.
  nb::tuple energise(std::size_t most_switchings, std::size_t most_rows) {
    std::size_t switchings = 0, rows = 0, pins = 0;
    interruptible([&](auto go_on) {
      while (pins < size() && switchings <= most_switchings && rows <= most_rows && go_on()) {
        device::PinRun& run = runs_[pins];
        run.energise(inputs_, pins, states_[pins], std::max(most_switchings, most_rows));
        switchings += run.coil.pieces.size() - 1;
        rows += run.loads.size() + inputs_.path.count + touch_rows();
        ++pins;
      }
      return 0;
    });
    return nb::make_tuple(switchings, rows, pins);
  }

  /// Simulates the pins with several threads, until they have more than the largest number of segments;
  /// returns the numbers of segments and of pins.
  /// The caller's thread is the first one; it alone checks for an interrupt and reports the progress.
  nb::tuple simulate(std::size_t threads, std::size_t most_segments, const nb::object& progress) {
    std::atomic<std::size_t> next{0}, done{0}, segments{0};
    std::atomic<bool> stopped{false};
    std::size_t reported = 0;
    Interrupt interrupt;
    const auto work = [&](auto go_on, auto report) {
      for (std::size_t i = next++; i < size() && !stopped; i = next++) {
        simulate_pin(i, go_on);
        segments += motions_[i]->segments().size();
        ++done;
        if (segments > most_segments) stopped = true;
        if (!stopped) report();
      }
    };
    const auto report = [&] {
      if (progress.is_none() || interrupt.found() || stopped) return;
      const nb::gil_scoped_acquire locked;
      for (std::size_t now = done; reported < now;) progress(++reported, size());
    };
    {
      const nb::gil_scoped_release unlocked;
      std::vector<std::future<void>> others;
      try {
        while (others.size() + 1 < std::min(threads, size()))
          others.push_back(std::async(std::launch::async, [&] {
            work([&] { return !stopped.load(std::memory_order_relaxed); }, [] {});
          }));
        work([&] { return interrupt.go_on() && !stopped; }, report);
        if (interrupt.found()) stopped = true;
        for (auto& other : others)
          while (other.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
            if (!interrupt.look()) stopped = true;
            report();
          }
        report();
      } catch (...) {
        stopped = true;
        throw;
      }
    }
    if (interrupt.found()) throw nb::python_error();
    return nb::make_tuple(segments.load(), done.load());
  }

  /// Follows a hand (mass, stiffness, damping, kinetic and static friction) that its arm leads along the path, with the
  /// pins; returns times, velocities and bends of the path that the hand takes, ambiguous samples, status, steps, and the deflections of the pins at the end.
  nb::tuple hand(const std::array<double, 5>& given) const {
    const auto& [mass, stiffness, damping, kinetic, fixed] = given;
    device::CompliantHand hand({mass, stiffness, damping, kinetic, fixed}, inputs_, states_);
    interruptible([&](auto go_on) { return hand.advance(go_on); });
    std::vector<double> bends;
    for (const device::Bend& bend : hand.rows().bends)
      bends.insert(bends.end(), std::begin(bend.b), std::end(bend.b));
    return nb::make_tuple(
        to_array(std::vector<double>(hand.rows().times)),
        to_array(std::vector<double>(hand.rows().velocity)), to_array(std::move(bends)),
        to_array(std::vector<double>(hand.ambiguous())), static_cast<int>(hand.status()),
        hand.steps(), mapped<double>(size(), [&](std::size_t i) { return hand.deflection(i); }));
  }

  const pd::StoredMotion<double>& motion(std::size_t pin) const { return *motions_.at(pin); }
  const device::PinRun& run(std::size_t pin) const { return runs_.at(pin); }
  const device::ScanInputs& inputs() const { return inputs_; }

 private:
  std::size_t touch_rows() const { return std::max<std::size_t>(touch_.first.size(), 1); }

  template <class GoOn>
  void simulate_pin(std::size_t i, GoOn&& go_on) {
    device::PinRun& run = runs_[i];
    run.simulate(inputs_, states_[i], go_on);
    motions_[i] = std::make_unique<pd::StoredMotion<double>>(inputs_.device.drive,
                                                             run.inputs(inputs_, states_[i]),
                                                             std::move(run.segments), run.outcome);
  }

  RasterNumbers raster_;
  PathNumbers path_;
  pd::OwnedRows<double> touch_;
  device::PlateVelocity velocity_;
  device::ScanInputs inputs_;
  std::vector<device::PinState> states_;
  std::vector<device::PinRun> runs_;
  std::vector<std::unique_ptr<pd::StoredMotion<double>>> motions_;
};

}  // namespace pindrive_python
