/// Whole device under a hand that is given as it moves.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "pindrive/device/live_hand.hpp"
#include "pindrive/device/pin_follower.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/device/scan_inputs.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::device {

/// State of a device at a time: a stream constructed from it gives identical bits.
struct DeviceState {
  double now;    ///< s
  double least;  ///< earliest end of the next advance, s
  LiveHand hand;
  std::vector<PinState> begins;          ///< before the second row of the hand
  std::vector<PinFollower::State> pins;  ///< from then on
};

/// Pins of a device over a page, advanced from time to time. The times at which the caller pauses do not change a
/// bit. The device is referenced; the raster may change between calls.
class DeviceStream {
 public:
  /// Receives the number of a pin, each segment of the pin that ends, and the state of the pin after.
  using Sink = Callback<std::size_t, const Segment<double>&, const detail::State<double>&>;

  /// Pins at their states, one each, under a hand at rest or moving at a place.
  DeviceStream(const Device& device, const LiveHand::Row& first, Place place,
               std::vector<PinState> begins)
      : device_(device),
        now_(first.time),
        least_(now_),
        hand_(first, place, device.axis),
        begins_(std::move(begins)) {}
  DeviceStream(const Device& device, const Raster& raster, const DeviceState& state)
      : device_(device),
        now_(state.now),
        least_(state.least),
        hand_(state.hand),
        begins_(state.begins) {
    for (const PinFollower::State& pin : state.pins)
      pins_.push_back(std::make_unique<PinFollower>(inputs(raster), pin));
  }

  DeviceState state() const {
    DeviceState found{now_, least_, hand_, begins_, {}};
    for (const auto& pin : pins_) found.pins.push_back(pin->state());
    return found;
  }

  /// Gives the next row of the hand, later than the last one.
  void move(const Raster& raster, const LiveHand::Row& row) {
    hand_.add(row, device_.axis);
    if (!pins_.empty()) return;
    for (const PinState& begin : begins_)
      pins_.push_back(std::make_unique<PinFollower>(inputs(raster), begin));
    begins_.clear();
  }

  /// Advances all pins to a time (s) from least() to hand().end(). `sink(pin, segment, after)` is called with each
  /// segment that ends and the state of the pin after, and `go_on` after each event and row. False if the advance is
  /// incomplete: status() is not ok, or go_on() returned false; the next call continues from there.
  bool advance(const Raster& raster, double until, GoOn go_on = {}, Sink sink = {}) {
    const ScanInputs given = inputs(raster);
    least_ = until;
    for (std::size_t i = 0; i < pins_.size(); ++i) {
      pins_[i]->sample(given, i, until);
      if (!pins_[i]->advance(
              given, until, go_on,
              [&](const Segment<double>& segment, const auto& after) { sink(i, segment, after); }))
        return false;
    }
    now_ = until;
    hand_.forget(now_);
    return true;
  }

  double now() const { return now_; }      ///< s
  double least() const { return least_; }  ///< earliest end of the next advance, s
  const LiveHand& hand() const { return hand_; }
  const Device& device() const { return device_; }
  std::size_t size() const { return pins_.size(); }  ///< pins; none before the second row
  const PinFollower& pin(std::size_t i) const { return *pins_[i]; }
  /// First status of a pin that is not ok.
  Status status() const {
    for (const auto& pin : pins_)
      if (pin->stepper().status() != Status::ok) return pin->stepper().status();
    return Status::ok;
  }

 private:
  ScanInputs inputs(const Raster& raster) const {
    return {device_,      raster, hand_.path(), hand_.plate(), hand_.touch(device_.load_exponent),
            hand_.begin()};
  }

  const Device& device_;
  double now_, least_;
  LiveHand hand_;
  std::vector<PinState> begins_;  ///< states of the pins until they exist
  std::vector<std::unique_ptr<PinFollower>> pins_;
};

}  // namespace pindrive::device
