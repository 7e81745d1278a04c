/// Shared parts of the C interface for a device under a moving hand: its handles.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "owned_motion.hpp"
#include "pindrive.h"
#include "pindrive/device/device_stream.hpp"
#include "pindrive/device/evaluation.hpp"
#include "pindrive/device/raster.hpp"
#include "pindrive/device/scan_inputs.hpp"

struct pindrive_device {
  std::vector<std::pair<std::string, double>> numbers;       ///< by key
  std::vector<std::pair<std::string, pindrive::Rows>> rows;  ///< by key
  std::vector<pindrive::device::Place> spots{{0, 0}};
};

namespace pindrive_c {

/// A device with the friction curves to which it refers.
struct OwnedDevice {
  pindrive::OwnedContact<double> plate, finger;
  pindrive::device::Device device;
  pindrive::device::Criteria criteria;  ///< criteria of a felt line
};

/// A page that owns its luminance.
struct OwnedPage {
  std::vector<double> luminance{1};
  std::int64_t rows{1}, columns{1};
  double pixel{1e-3};
  pindrive::device::Place corner{0, 0};

  pindrive::device::Raster raster() const {
    return {luminance.data(), rows, columns, pixel, corner};
  }
};

/// Checks a device and makes what the core simulates.
pindrive_error made_of(const pindrive_device& device, std::shared_ptr<const OwnedDevice>& made);

}  // namespace pindrive_c

struct pindrive_scan {
  std::shared_ptr<const pindrive_c::OwnedDevice> owned;
  std::shared_ptr<const pindrive_c::OwnedPage> page;
  std::unique_ptr<pindrive::device::DeviceStream> stream;
  std::vector<pindrive_pin_event> events;  ///< that were not collected yet
};
