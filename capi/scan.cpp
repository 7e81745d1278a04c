// The C interface: a device under a hand that is given as it moves.
#include "scan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "bytes.hpp"
#include "interface.hpp"
#include "pindrive.h"
#include "stepper.hpp"

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

namespace device = pd::device;

/// A touch that changes under skin which follows it by lines, at an exponent of the friction other than 1.
pindrive_error check_touch(const device::Device& device, double before, double finger_load) {
  const pd::Contact<double>& finger = device.drive.finger;
  const bool lags = finger.compliant() && (!finger.damped() || finger.branches > 0);
  if (finger_load == before || device.load_exponent == 1 || !lags) return PINDRIVE_OK;
  return fail(PINDRIVE_UNSUPPORTED,
              "finger_load must stay %.17g at a finger.load_exponent of %g beside a "
              "finger.stiffness, unless the finger has damping and Coulomb friction",
              before, device.load_exponent);
}

pindrive_error check_row(double time, device::Vector velocity, double finger_load) {
  pindrive_error error = check("time", time, std::isfinite(time), "finite");
  if (!error) error = check("vx", velocity.x, in_range(velocity.x, true), range_of(true));
  if (!error) error = check("vy", velocity.y, in_range(velocity.y, true), range_of(true));
  if (!error)
    error = check("finger_load", finger_load, in_range(finger_load, false), range_of(false));
  return error;
}

// ---- bytes -------------------------------------------------------------------------------------

constexpr std::uint32_t magic = 0x70647331;  // "pds1"

template <class Bytes>
void exchange(Bytes& bytes, device::PinState& s) {
  const auto number = [&](auto&... each) { (bytes.item(each), ...); };
  number(s.position, s.velocity, s.stretch, s.decision);
  exchange(bytes, s.coil);
  exchange_list(bytes, s.pending, sizeof(double), number);
}

template <class Bytes>
void exchange(Bytes& bytes, device::PinFollower::State& s) {
  const auto number = [&](auto&... each) { (bytes.item(each), ...); };
  exchange(bytes, s.motion);
  exchange(bytes, s.coil);
  number(s.sampled, s.passed, s.decision);
  exchange_list(bytes, s.pending, sizeof(double), number);
}

/// State of a scan as bytes hold it.
struct Kept {
  double now{0}, least{0}, begin{0};
  std::vector<std::pair<device::LiveHand::Row, device::Place>> rows;
  std::vector<device::PinState> begins;
  std::vector<device::PinFollower::State> pins;

  template <class Bytes>
  void operator()(Bytes& bytes) {
    const auto number = [&](auto&... each) { (bytes.item(each), ...); };
    number(now, least, begin);
    exchange_list(bytes, rows, 6 * sizeof(double), [&](auto& each) {
      auto& [row, place] = each;
      number(row.time, row.velocity.x, row.velocity.y, row.finger_load, place.x, place.y);
    });
    exchange_list(bytes, begins, 12 * sizeof(double), [&](auto& pin) { exchange(bytes, pin); });
    exchange_list(bytes, pins, 32 * sizeof(double), [&](auto& pin) { exchange(bytes, pin); });
  }
};

Kept kept(const pindrive_scan& scan) {
  device::DeviceState state = scan.stream->state();
  Kept found{state.now,
             state.least,
             state.hand.begin(),
             {},
             std::move(state.begins),
             std::move(state.pins)};
  for (std::size_t i = 0; i < state.hand.size(); ++i)
    found.rows.emplace_back(state.hand.row(i), state.hand.place(i));
  return found;
}

// ---- values ------------------------------------------------------------------------------------

double value_of(const pindrive_scan& scan, std::size_t i, pindrive_quantity quantity) {
  const device::DeviceStream& stream = *scan.stream;
  const device::PinFollower& pin = stream.pin(i);
  const double now = stream.now();
  switch (quantity) {
    case PINDRIVE_PULL:
      return pin.coil().pull(now);
    case PINDRIVE_CURRENT:
      return pin.coil().current(now);
    case PINDRIVE_WARMING:
      return pin.coil().warming(now);
    case PINDRIVE_COMMAND:
      return pin.coil().state().command ? 1 : 0;
    case PINDRIVE_LUMINANCE:
      return scan.page->raster().at(stream.hand().path().position(now) + stream.device().spots[i]);
    default:
      return pindrive::sampled_now(pin.stepper(), static_cast<pindrive::Sampled>(quantity));
  }
}

pindrive_error begun(const pindrive_scan& scan) {
  if (scan.stream->size() > 0) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "the hand must have a second row before the pins are evaluated");
}

}  // namespace

extern "C" {

pindrive_error pindrive_scan_new(const pindrive_device* device, double time, double x, double y,
                                 double vx, double vy, double finger_load, pindrive_scan** scan) {
  if (!device) return null_pointer("device");
  if (!scan) return null_pointer("scan");
  return guarded([&]() -> pindrive_error {
    auto made = std::make_unique<pindrive_scan>();
    pindrive_error error = made_of(*device, made->owned);
    if (!error) error = check_row(time, {vx, vy}, finger_load);
    if (!error) error = check("x", x, std::abs(x) <= 1000, "from -1000 to 1000");
    if (!error) error = check("y", y, std::abs(y) <= 1000, "from -1000 to 1000");
    if (error) return error;
    made->page = std::make_shared<OwnedPage>();
    const device::PinState begin = device::at_rest(time);
    made->stream = std::make_unique<device::DeviceStream>(
        made->owned->device, device::LiveHand::Row{time, {vx, vy}, finger_load},
        device::Place{x, y},
        std::vector<device::PinState>(made->owned->device.spots.size(), begin));
    *scan = made.release();
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_scan_copy(const pindrive_scan* scan, pindrive_scan** copy) {
  if (!scan) return null_pointer("scan");
  if (!copy) return null_pointer("copy");
  return guarded([&]() -> pindrive_error {
    *copy = new pindrive_scan{scan->owned, scan->page,
                              std::make_unique<device::DeviceStream>(
                                  scan->owned->device, scan->page->raster(), scan->stream->state()),
                              scan->events};
    return PINDRIVE_OK;
  });
}

void pindrive_scan_free(pindrive_scan* scan) { delete scan; }

pindrive_error pindrive_scan_set_page(pindrive_scan* scan, const double* luminance, size_t rows,
                                      size_t columns, double pixel, double left, double top) {
  if (!scan) return null_pointer("scan");
  if (!luminance) return null_pointer("luminance");
  if (rows == 0 || columns == 0)
    return fail(PINDRIVE_BAD_VALUE, "a page must have pixels, not %zu rows of %zu", rows, columns);
  pindrive_error error = check("pixel", pixel, pixel >= 1e-7 && pixel <= 1, "from 1e-07 to 1");
  if (!error) error = check("left", left, std::abs(left) <= 1000, "from -1000 to 1000");
  if (!error) error = check("top", top, std::abs(top) <= 1000, "from -1000 to 1000");
  if (error) return error;
  const double* const end = luminance + rows * columns;
  const double* const bad =
      std::find_if_not(luminance, end, [](double y) { return y >= 0 && y <= 1; });
  if (bad != end)
    return fail(PINDRIVE_BAD_VALUE, "luminance must be from 0 to 1, not %.17g at pixel %zu", *bad,
                static_cast<std::size_t>(bad - luminance));
  return guarded([&]() -> pindrive_error {
    scan->page = std::make_shared<OwnedPage>(OwnedPage{std::vector<double>(luminance, end),
                                                       static_cast<std::int64_t>(rows),
                                                       static_cast<std::int64_t>(columns),
                                                       pixel,
                                                       {left, top}});
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_scan_move(pindrive_scan* scan, double time, double vx, double vy,
                                  double finger_load) {
  if (!scan) return null_pointer("scan");
  const double last = scan->stream->hand().end();
  if (const pindrive_error error = check_row(time, {vx, vy}, finger_load)) return error;
  if (!(time > last))
    return fail(PINDRIVE_BAD_VALUE,
                "time must be later than that of the last row, %.17g s, not %.17g", last, time);
  const double before = scan->stream->hand().row(scan->stream->hand().size() - 1).finger_load;
  if (const pindrive_error error = check_touch(scan->owned->device, before, finger_load))
    return error;
  return guarded([&]() -> pindrive_error {
    scan->stream->move(scan->page->raster(), {time, {vx, vy}, finger_load});
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_scan_advance(pindrive_scan* scan, double until, pindrive_go_on go_on,
                                     void* context) {
  if (!scan) return null_pointer("scan");
  device::DeviceStream& stream = *scan->stream;
  if (const bool known = until >= stream.least() && until <= stream.hand().end(); !known)
    return fail(PINDRIVE_BAD_VALUE,
                "until must be from %.17g s to the last row of the hand, %.17g s, not %.17g",
                stream.least(), stream.hand().end(), until);
  return guarded([&]() -> pindrive_error {
    Attended attended(go_on, context);
    const auto sink = [&](std::size_t pin, const pd::Segment<double>& segment, const auto& after) {
      if (segment.event.any())
        scan->events.push_back({pin,
                                {stream.hand().begin() + segment.end, after.x, after.v,
                                 static_cast<pindrive_transition>(segment.event.plate),
                                 static_cast<pindrive_transition>(segment.event.finger),
                                 static_cast<pindrive_transition>(segment.event.stop)}});
    };
    const bool whole =
        stream.advance(scan->page->raster(), until, [&] { return attended.go_on(); }, sink);
    if (whole) return PINDRIVE_OK;
    return attended.stopped() ? stopped() : given_up(stream.status());
  });
}

pindrive_error pindrive_scan_now(const pindrive_scan* scan, pindrive_scan_instant* instant) {
  if (!scan) return null_pointer("scan");
  if (!instant) return null_pointer("instant");
  const device::DeviceStream& stream = *scan->stream;
  const device::LiveHand& hand = stream.hand();
  const bool moves = hand.size() > 1;
  const device::Place place = moves ? hand.path().position(stream.now()) : hand.place(0);
  const device::Vector velocity = moves ? hand.path().velocity(stream.now()) : hand.row(0).velocity;
  *instant = {stream.now(),
              hand.end(),
              place.x,
              place.y,
              velocity.x,
              velocity.y,
              stream.device().spots.size()};
  return PINDRIVE_OK;
}

pindrive_error pindrive_scan_evaluate(const pindrive_scan* scan, pindrive_quantity quantity,
                                      double* values) {
  if (!scan) return null_pointer("scan");
  if (!values) return null_pointer("values");
  if (quantity < PINDRIVE_POSITION || quantity > PINDRIVE_LUMINANCE)
    return fail(PINDRIVE_BAD_VALUE, "a quantity must be from 0 to %d, not %d", PINDRIVE_LUMINANCE,
                quantity);
  if (const pindrive_error error = begun(*scan)) return error;
  for (std::size_t i = 0; i < scan->stream->size(); ++i) values[i] = value_of(*scan, i, quantity);
  return PINDRIVE_OK;
}

pindrive_error pindrive_scan_pin(const pindrive_scan* scan, size_t pin, pindrive_instant* instant) {
  if (!scan) return null_pointer("scan");
  if (!instant) return null_pointer("instant");
  if (const pindrive_error error = begun(*scan)) return error;
  const device::DeviceStream& stream = *scan->stream;
  if (pin >= stream.size())
    return fail(PINDRIVE_BAD_VALUE, "a pin must be from 0 to %zu, not %zu", stream.size() - 1, pin);
  *instant = instant_of(stream.pin(pin).stepper(), stream.hand().begin());
  return PINDRIVE_OK;
}

pindrive_error pindrive_scan_events(pindrive_scan* scan, pindrive_pin_event* events,
                                    size_t capacity, size_t* count) {
  if (!scan) return null_pointer("scan");
  if (!count) return null_pointer("count");
  if (capacity > 0 && !events) return null_pointer("events");
  *count = std::min(capacity, scan->events.size());
  const auto end = scan->events.begin() + static_cast<std::ptrdiff_t>(*count);
  std::copy(scan->events.begin(), end, events);
  scan->events.erase(scan->events.begin(), end);
  return scan->events.empty() ? PINDRIVE_OK : PINDRIVE_MORE;
}

size_t pindrive_scan_size(const pindrive_scan* scan) { return scan ? framed_size(kept(*scan)) : 0; }

pindrive_error pindrive_scan_write(const pindrive_scan* scan, void* bytes, size_t size) {
  if (!scan) return null_pointer("scan");
  if (!bytes) return null_pointer("bytes");
  const std::size_t needed = pindrive_scan_size(scan);
  if (size != needed)
    return fail(PINDRIVE_BAD_VALUE, "size must be %zu, as pindrive_scan_size says, not %zu", needed,
                size);
  write_framed(magic, bytes, size, kept(*scan));
  return PINDRIVE_OK;
}

pindrive_error pindrive_scan_read(const pindrive_device* device, const void* bytes, size_t size,
                                  pindrive_scan** scan) {
  if (!device) return null_pointer("device");
  if (!bytes) return null_pointer("bytes");
  if (!scan) return null_pointer("scan");
  return guarded([&]() -> pindrive_error {
    Kept found;
    auto made = std::make_unique<pindrive_scan>();
    if (const pindrive_error error = made_of(*device, made->owned)) return error;
    const std::size_t pins = made->owned->device.spots.size();
    if (!read_framed(magic, bytes, size, found) || found.rows.empty() ||
        found.begins.size() + found.pins.size() != pins)
      return fail(PINDRIVE_BAD_VALUE,
                  "the bytes must be those of a scan of %zu pins, whole and of interface %d", pins,
                  PINDRIVE_INTERFACE);
    made->page = std::make_shared<OwnedPage>();
    const device::LiveHand hand(found.begin, found.rows, made->owned->device.axis);
    made->stream = std::make_unique<device::DeviceStream>(
        made->owned->device, made->page->raster(),
        device::DeviceState{found.now, found.least, hand, std::move(found.begins),
                            std::move(found.pins)});
    *scan = made.release();
    return PINDRIVE_OK;
  });
}

}  // extern "C"
