// The C interface: many releases, by the kernel as far as it follows them.
#include "pindrive/motion/batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "batch_numbers.hpp"
#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"
#include "pindrive/kernel/kernel_block.hpp"
#ifdef PINDRIVE_KERNELS
#include "_kernel.hpp"
#endif

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

using pd::batch::Block, pd::batch::no_column, pd::batch::PlainNumber, pd::batch::Row;
using pd::detail::Asked;

/// Simulates in packs of the processor's width if the kernel is compiled for several widths; the
/// bits do not depend on the width.
void run_kernel(Block& block, std::size_t count, Asked asked) {
#ifdef PINDRIVE_KERNELS
  pindrive_extension::kernel_of(0)->follow(block, static_cast<int>(count), asked);
#else
  pd::detail::follow_block<double>(block, static_cast<int>(count), asked);
#endif
}

/// Arguments of the core for a point without curves and varying inputs, with the plate load
/// included in the friction, in the order of the kernel's blocks.
std::array<double, Block::inputs> arguments(const pd::Numbers& at, double band) {
  const double load = at.plate_load.value(), velocity = at.mouse_velocity.value();
  const double finger_load = pindrive_c::initial(at.finger_load, at.finger.load_exponent);
  return {at.mass,
          at.stiffness,
          at.damping,
          load == 1 ? at.plate.kinetic : at.plate.kinetic * load,
          load == 1 ? at.plate.static_limit : at.plate.static_limit * load,
          at.finger.kinetic * finger_load,
          at.finger.static_limit * finger_load,
          at.finger.stiffness,
          velocity,
          at.displacement,
          at.velocity,
          at.duration,
          band,
          load};
}
bool constant(const pd::Numbers& at) {
  const auto coulomb = [](const pd::ContactNumbers& contact) {
    return contact.curve.empty() && contact.law.shape() == pd::FallingShape::none &&
           contact.law.viscous == 0;
  };
  return coulomb(at.plate) && coulomb(at.finger) && at.mouse_velocity.constant() &&
         at.plate_load.constant() && std::isnan(at.skin_stretch) && at.force.is(0) &&
         at.across_velocity.is(0) && at.finger_load.constant() && !at.stops.present();
}
/// Contact with its load included in its friction.
pd::Numbers pressed(pd::Numbers at) {
  const double load = at.plate_load.value();
  if (load != 1)
    for (double* force : {&at.plate.kinetic, &at.plate.static_limit}) *force *= load;
  const double touched = pindrive_c::initial(at.finger_load, at.finger.load_exponent);
  for (double* force : {&at.finger.kinetic, &at.finger.static_limit}) *force *= touched;
  at.plate_load = at.finger_load = {{{0, 1}}};
  return at;
}

/// Outputs of a batch; all but the numbers may be null.
struct Filled {
  double* numbers;
  int* events;
  pindrive_status* status;
  pindrive_end* end;
  pindrive_error* errors;
};

/// A batch as its caller describes it.
class Batch {
 public:
  Batch(const pindrive_drive& drive, const pindrive_release& release, const pindrive_varied* varied,
        std::size_t varied_count, double band, std::vector<Row> rows, const Filled& filled)
      : drive_(drive),
        release_(release),
        varied_(varied),
        varied_count_(varied_count),
        band_(band),
        rows_(std::move(rows)),
        asked_(filled.events ? Asked::numbers : Asked::state),
        filled_(filled) {
    for (const Row& row : rows_) {
      asked_ = std::max(asked_, row.asked());
      energy_ = energy_ || row.energy;
    }
  }

  /// Points [first, first + count), at most a block.
  void follow(std::size_t first, std::size_t count, Attended& attended) {
    std::fill_n(kinds_.begin(), count, Kind::refused);
    for (std::size_t i = 0; i < count; ++i) read(first, i);
    by_kernel(first, count);
    for (std::size_t i = 0; i < count && !attended.stopped(); ++i) finish(first + i, i, attended);
  }

 private:
  enum class Kind : signed char { refused, general, kernel };

  void read(std::size_t first, std::size_t i) {
    for (std::size_t j = 0; j < varied_count_; ++j)
      if (const double value = varied_[j].values[first + i]; !set(drive_, varied_[j].name, value))
        set(release_, varied_[j].name, value);
    pindrive_error error = check(drive_, release_);
    if (!error) error = check_duration(release_);
    if (filled_.errors) filled_.errors[first + i] = error;
    if (!error) {
      pd::Numbers& at = points_[i] = numbers_of(drive_, release_);
      start(at, at);
      kinds_[i] = constant(at) ? Kind::kernel : Kind::general;
      if (kinds_[i] == Kind::kernel) at = pressed(at);
    }
    // In place of what the kernel is not asked for: a release without friction, which it gives up.
    std::array<double, Block::inputs> in{1, 1};
    if (kinds_[i] == Kind::kernel) in = arguments(points_[i], band_);
    for (std::size_t k = 0; k < in.size(); ++k) block_->input[k][i] = in[k];
  }

  void by_kernel(std::size_t first, std::size_t count) {
    std::fill_n(block_->output, Block::columns, nullptr);
    block_->output[Block::rest_time] = columns_[Block::rest_time];
    if (filled_.events) block_->output[PlainNumber::events] = columns_[PlainNumber::events];
    for (const Row& row : rows_)
      if (row.column != no_column) block_->output[row.column] = columns_[row.column];
    run_kernel(*block_, count, asked_);
    for (std::size_t i = 0; i < count; ++i) {
      const bool known = kinds_[i] == Kind::kernel;
      for (std::size_t k = 0; k < rows_.size(); ++k)
        numbers_of_point(first + i)[k] =
            known && rows_[k].column != no_column ? columns_[rows_[k].column][i] : none;
      if (filled_.events)
        filled_.events[first + i] = known ? static_cast<int>(columns_[PlainNumber::events][i]) : 0;
      const bool rests = !std::isnan(columns_[Block::rest_time][i]);
      const bool refused = kinds_[i] == Kind::refused;
      say(first + i, refused ? pd::Status::inconsistent : pd::Status::ok,
          rests && !refused ? pd::End::resting : pd::End::moving);
    }
  }

  /// Part of a point that the kernel leaves to the general core: everything, its settling time, or
  /// its energies.
  void finish(std::size_t point, std::size_t i, Attended& attended) {
    if (kinds_[i] == Kind::refused) return;
    const bool all = kinds_[i] == Kind::general || block_->given_up[i];
    const bool settling = block_->unsure[i];
    if (!all && !settling && !energy_) return;
    const pd::Numbers& at = points_[i];
    const pd::OwnedMotion<double> motion(at, at, [&](const auto&) { return attended.go_on(); });
    if (attended.stopped()) return;
    const auto view = motion.view();
    pd::Summary<double> summary{{}, motion.outcome(), pd::duration_of(view, band_), 0};
    summary.transient = pd::transient_of(view, summary.duration, band_);
    for (const auto& segment : motion.segments()) summary.events += pd::events_at_end(segment);
    const pd::batch::Summary found = pd::batch::with_end(summary, view);
    for (std::size_t k = 0; k < rows_.size(); ++k)
      if (!rows_[k].energy && (all || (settling && rows_[k].column == PlainNumber::settling_time)))
        numbers_of_point(point)[k] = rows_[k].of(found);
    if (all) say(point, summary.outcome.status, summary.outcome.end);
    if (all && filled_.events) filled_.events[point] = static_cast<int>(summary.events);
    if (!energy_) return;
    const auto ledger = pd::energy_ledger(view, summary.duration);
    for (std::size_t k = 0; k < rows_.size(); ++k)
      if (rows_[k].energy) numbers_of_point(point)[k] = rows_[k].energy(ledger);
  }

  double* numbers_of_point(std::size_t point) const {
    return filled_.numbers + point * rows_.size();
  }
  void say(std::size_t point, pd::Status status, pd::End end) const {
    if (filled_.status) filled_.status[point] = static_cast<pindrive_status>(status);
    if (filled_.end) filled_.end[point] = static_cast<pindrive_end>(end);
  }

  pindrive_drive drive_;
  pindrive_release release_;
  const pindrive_varied* varied_;
  std::size_t varied_count_;
  double band_;
  std::vector<Row> rows_;
  Asked asked_;
  bool energy_{false};
  Filled filled_;

  std::unique_ptr<Block> block_{std::make_unique<Block>()};
  double columns_[Block::columns][Block::capacity];
  std::array<Kind, Block::capacity> kinds_{};
  std::vector<pd::Numbers> points_{Block::capacity};
};

}  // namespace

extern "C" pindrive_error pindrive_batch(
    const pindrive_drive* drive, const pindrive_release* release, const pindrive_varied* varied,
    size_t varied_count, size_t points, double settling_band, const char* const* outputs,
    size_t output_count, pindrive_go_on go_on, void* context, double* numbers, int* events,
    pindrive_status* status, pindrive_end* end, pindrive_error* errors) {
  if (!drive) return null_pointer("drive");
  if (!release) return null_pointer("release");
  if (varied_count > 0 && !varied) return null_pointer("varied");
  if (output_count > 0 && !outputs) return null_pointer("outputs");
  if (points > 0 && output_count > 0 && !numbers) return null_pointer("numbers");
  if (const pindrive_error error = check_band(settling_band)) return error;
  return guarded([&]() -> pindrive_error {
    pindrive_drive tried_drive = *drive;
    pindrive_release tried_release = *release;
    for (std::size_t j = 0; j < varied_count; ++j) {
      if (!varied[j].name || !varied[j].values) return null_pointer("name and values of a varied");
      if (!set(tried_drive, varied[j].name, 0) && !set(tried_release, varied[j].name, 0))
        return fail(PINDRIVE_BAD_NAME, "neither a drive nor a release has %.40s, but %s; %s",
                    varied[j].name, drive_names, release_names);
    }
    std::vector<Row> rows;
    for (std::size_t k = 0; k < output_count; ++k) {
      if (!outputs[k]) return null_pointer("the name of an output");
      if (!rows.emplace_back(outputs[k]).exists())
        return fail(
            PINDRIVE_BAD_NAME,
            "a batch has no number %.40s, but those of pindrive_number_name, \"energy.\" and "
            "those of pindrive_energy_name, duration, final.position, final.velocity",
            outputs[k]);
    }
    const Filled filled{numbers, events, status, end, errors};
    const auto batch = std::make_unique<Batch>(*drive, *release, varied, varied_count,
                                               settling_band, std::move(rows), filled);
    Attended attended(go_on, context);
    for (std::size_t first = 0; first < points && !attended.stopped(); first += Block::capacity)
      batch->follow(first, std::min<std::size_t>(Block::capacity, points - first), attended);
    if (!attended.stopped()) return PINDRIVE_OK;
    return stopped();
  });
}
