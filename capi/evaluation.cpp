// The C interface: lines that a finger feels, and the largest hand speed over two lines.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "interface.hpp"
#include "pindrive.h"
#include "pindrive/device/printed_lines.hpp"
#include "pindrive/device/scan.hpp"
#include "pindrive/device/scan_evaluation.hpp"
#include "pindrive/device/speed_limit.hpp"
#include "scan.hpp"
#include "stepper.hpp"

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

namespace device = pd::device;

pindrive_line_edge edge_of(const device::EvaluatedEdge& edge) {
  return {edge.time,     edge.spot.x, edge.spot.y, edge.command,
          edge.response, edge.lag,    edge.skin,   static_cast<int>(edge.cue)};
}
pindrive_line line_of(const device::EvaluatedLine& line) {
  return {static_cast<std::size_t>(line.pin),
          static_cast<int>(line.outcome),
          edge_of(line.begin),
          edge_of(line.end),
          line.stroke,
          line.height,
          line.returned,
          line.release,
          line.settled,
          line.smear,
          line.overshoot,
          line.contrast};
}

/// A false line has the time, the place and the height of its swing.
pindrive_line line_of(const device::FalseLine& line) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const pindrive_line_edge missing{none, none, none, none, none, none, none, PINDRIVE_NO_CUE};
  pindrive_line_edge begin = missing;
  begin.time = line.time;
  begin.x = line.spot.x;
  begin.y = line.spot.y;
  return {static_cast<std::size_t>(line.pin),
          PINDRIVE_FALSE,
          begin,
          missing,
          none,
          line.height,
          none,
          none,
          none,
          none,
          none,
          none};
}

/// Refuses a scan that was advanced, or without a second row of the hand.
pindrive_error check_begin(const pindrive_scan& scan) {
  const device::LiveHand& hand = scan.stream->hand();
  if (scan.stream->now() == hand.begin() && hand.size() >= 2) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE,
              "the scan must have two rows of the hand or more, and not be advanced yet");
}
/// Inputs of a scan under its hand so far.
device::ScanInputs inputs_of(const pindrive_scan& scan) {
  const device::LiveHand& hand = scan.stream->hand();
  return {scan.owned->device,
          scan.page->raster(),
          hand.path(),
          hand.plate(),
          hand.touch(scan.owned->device.load_exponent),
          hand.begin()};
}

constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

}  // namespace

extern "C" {

pindrive_error pindrive_scan_lines(const pindrive_scan* scan, pindrive_go_on go_on, void* context,
                                   pindrive_line* lines, size_t capacity, size_t* count) {
  if (!scan) return null_pointer("scan");
  if (!count) return null_pointer("count");
  if (capacity > 0 && !lines) return null_pointer("lines");
  if (const pindrive_error error = check_begin(*scan)) return error;
  return guarded([&]() -> pindrive_error {
    const device::ScanInputs inputs = inputs_of(*scan);
    const device::Device& reader = inputs.device;
    const device::PageAlongPath page(inputs.raster, inputs.path, reader.axis,
                                     reader.controller.threshold);
    const device::ScanEvaluation evaluation(inputs, scan->owned->criteria);
    const device::PinState begin = device::at_rest(inputs.begin);
    Attended attended(go_on, context);
    device::Evaluation found;
    device::PinRun run;
    std::size_t edges = 0;
    for (std::size_t pin = 0; pin < reader.spots.size(); ++pin) {
      run.energise(inputs, pin, begin, unlimited);
      run.simulate(inputs, begin, [&] { return attended.go_on(); });
      if (attended.stopped()) return stopped();
      if (run.outcome.status != pd::Status::ok) return given_up(run.outcome.status);
      evaluation.add(pin, run, run.motion(inputs, begin),
                     page.lines(reader.spots[pin], unlimited, edges), found);
    }
    *count = found.lines.size() + found.false_lines.size();
    std::size_t written = 0;
    const auto write = [&](const auto& line) {
      if (written < capacity) lines[written++] = line_of(line);
    };
    for (const device::EvaluatedLine& line : found.lines) write(line);
    for (const device::FalseLine& line : found.false_lines) write(line);
    return written < *count ? PINDRIVE_MORE : PINDRIVE_OK;
  });
}

pindrive_error pindrive_scan_load(const pindrive_scan* scan, size_t pin, pindrive_piece* pieces,
                                  pindrive_term* terms, size_t capacity, size_t* count) {
  if (!scan) return null_pointer("scan");
  if (!count) return null_pointer("count");
  if (capacity > 0 && (!pieces || !terms)) return null_pointer("pieces and terms");
  if (const pindrive_error error = check_begin(*scan)) return error;
  const device::ScanInputs inputs = inputs_of(*scan);
  const std::size_t pins = inputs.device.spots.size();
  if (pin >= pins)
    return fail(PINDRIVE_BAD_VALUE, "a pin must be from 0 to %zu, not %zu", pins - 1, pin);
  return guarded([&]() -> pindrive_error {
    device::PinRun run;
    run.energise(inputs, pin, device::at_rest(inputs.begin), unlimited);
    *count = run.loads.size();
    for (std::size_t i = 0; i < std::min(capacity, *count); ++i) {
      const pd::InputPiece<double>& load = run.loads[i];
      pindrive_term* const own = terms + 2 * i;
      for (std::size_t j = 0; j < load.count; ++j)
        own[j] = {load.terms[j].cosine, load.terms[j].sine, load.terms[j].decay,
                  load.terms[j].frequency};
      pieces[i] = {load.begin, {load.polynomial[0], load.polynomial[1]}, own, load.count};
    }
    return capacity < *count ? PINDRIVE_MORE : PINDRIVE_OK;
  });
}

pindrive_error pindrive_device_speed_limit(const pindrive_device* device, double pitch,
                                           double width, double slowest, double fastest,
                                           pindrive_go_on go_on, void* context,
                                           pindrive_speed_limit* limit) {
  if (!device) return null_pointer("device");
  if (!limit) return null_pointer("limit");
  const auto within = [](double value, double least, double most) {
    return value >= least && value <= most;
  };
  pindrive_error error = check("pitch", pitch, within(pitch, 1e-6, 10), "from 1e-06 to 10");
  if (!error)
    error = check("width", width, width >= 1e-7 && width < pitch, "from 1e-07 to below the pitch");
  if (!error) error = check("slowest", slowest, within(slowest, 1e-4, 100), "from 0.0001 to 100");
  if (!error)
    error =
        check("fastest", fastest, fastest > slowest && fastest <= 100, "above the slowest, to 100");
  if (error) return error;
  return guarded([&]() -> pindrive_error {
    std::shared_ptr<const OwnedDevice> owned;
    if (const pindrive_error refused = made_of(*device, owned)) return refused;
    Attended attended(go_on, context);
    const device::TwoLines lines(owned->device, pitch, width, owned->criteria);
    device::SpeedLimitSearch search(lines, owned->criteria.direction, {{slowest, fastest}});
    const device::SpeedLimit found = search.found([&] { return attended.go_on(); }, [](int) {});
    if (attended.stopped()) return stopped();
    if (found.status != pd::Status::ok) return given_up(found.status);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    *limit = {nan, nan, nan, found.distinct.size()};
    if (!found.distinct.empty()) {
      limit->distinct_from = found.distinct[0].slowest;
      limit->distinct_to = found.distinct[0].fastest;
    }
    if (!found.settled.empty()) limit->settled_to = found.settled[0].fastest;
    return PINDRIVE_OK;
  });
}

}  // extern "C"
