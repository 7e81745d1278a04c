// Many points at once: arrays in and out of the core, shared out among threads. No physics here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <future>
#include <iterator>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "_batch_rows.hpp"
#include "_kernel.hpp"
#include "batch_numbers.hpp"
#include "interrupt.hpp"
#include "pindrive/engine.hpp"
#include "pindrive/motion/batch.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
namespace pe = pindrive_extension;
using nb::literals::operator""_a;

namespace {

using pd::batch::Block, pd::batch::no_column, pd::batch::PlainNumber, pd::batch::Row;
using pe::Column, pe::Rows;

constexpr std::size_t least_share = 64;  // points that a thread takes at a time, at most a block
constexpr std::size_t keep = 1U << 12;   // segments that a thread keeps room for

// ---- in ------------------------------------------------------------------------------------------

/// The arguments of a point, in the order of `inputs` below and of the kernel's blocks.
enum : std::size_t {
  mass,
  stiffness,
  damping,
  plate_kinetic,
  plate_static,
  finger_kinetic,
  finger_static,
  finger_stiffness,
  mouse_velocity,
  displacement,
  velocity,
  duration,
  settling_band,
  plate_load,
  input_count
};
static_assert(input_count == Block::inputs, "the kernel takes them all");
using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
/// What the kernel does not know, of all points or of each, NaN where it is refused: travel, stiffness
/// and damping of the end stops, damping of the skin. Nothing: neither stops nor damped skin.
using OtherNumbers = std::vector<Numbers>;
using Input = nb::ndarray<const double, nb::device::cpu>;
using Inputs = std::array<Input, input_count>;
using Point = std::array<double, input_count>;

/// Marks the arrays with one value.
std::array<bool, input_count> with_one_value(const Inputs& inputs) {
  std::array<bool, input_count> found{};
  for (std::size_t k = 0; k < input_count; ++k) {
    found[k] = true;
    for (std::size_t axis = 0; axis < inputs[k].ndim(); ++axis)
      found[k] = found[k] && (inputs[k].stride(axis) == 0 || inputs[k].shape(axis) == 1);
  }
  return found;
}

/// Columns of points first to first + count, in C order, of arrays with one shape; along an axis an
/// array may have stride zero. Nothing is written for arrays that are not `asked`.
void points(const Inputs& inputs, std::size_t first, std::size_t count,
            const std::array<bool, input_count>& asked, double (*columns)[Block::stride]) {
  const std::size_t axes = inputs[0].ndim();
  const std::size_t along = axes == 0 ? 1 : inputs[0].shape(axes - 1);
  for (std::size_t done = 0; done < count;) {
    // Range of the last axis.
    std::array<std::int64_t, input_count> offset{};
    std::size_t rest = first + done;
    for (std::size_t axis = axes; axis-- > 0;) {
      const auto index = static_cast<std::int64_t>(rest % inputs[0].shape(axis));
      rest /= inputs[0].shape(axis);
      for (std::size_t k = 0; k < input_count; ++k) offset[k] += index * inputs[k].stride(axis);
    }
    const std::size_t run = std::min(count - done, along - (first + done) % along);
    for (std::size_t k = 0; k < input_count; ++k) {
      if (!asked[k]) continue;
      const double* from = inputs[k].data() + offset[k];
      const std::int64_t stride = axes == 0 ? 0 : inputs[k].stride(axes - 1);
      double* to = columns[k] + done;
      if (stride == 1)
        std::copy_n(from, run, to);
      else if (stride == 0)
        std::fill_n(to, run, *from);
      else
        for (std::size_t i = 0; i < run; ++i) to[i] = from[static_cast<std::int64_t>(i) * stride];
    }
    done += run;
  }
}

/// Status of a point that breaks the first bound, less one; all further bounds follow, as in
/// quantities/status.py.
constexpr std::int8_t refused = 15;
/// Status of a point with a rejected travel; the other numbers follow.
constexpr std::size_t first_of_others = refused + 1 + std::tuple_size<pe::Bounds>::value;

pd::Drive<double> drive_of(const Point& p, const pd::Stops<double>& stops, double skin_damping) {
  return {p[mass],
          p[stiffness],
          p[damping],
          {p[plate_kinetic], p[plate_static]},
          {p[finger_kinetic], p[finger_static], p[finger_stiffness], {}, {}, skin_damping},
          stops};
}

pd::Inputs<double> inputs_of(const Point& p) {
  return {p[mouse_velocity], p[displacement], p[velocity], p[duration]};
}

// ---- between -------------------------------------------------------------------------------------

class Batch {
 public:
  /// A point that breaks a bound is left out, and marked.
  Batch(const Inputs& inputs, const pe::Bounds& bounds, const std::vector<std::string>& outputs,
        bool events, const pe::KernelFunctions& kernel, const OtherNumbers& others)
      : inputs_(inputs),
        bounds_(bounds),
        size_(size_of(inputs)),
        names_(outputs),
        rows_(rows_of(outputs)),
        asked_(events ? pd::detail::Asked::numbers : pd::detail::Asked::state),
        kernel_(kernel),
        others_(others),
        numbers_(rows_.size(), size()),
        varies_(with_one_value(inputs)),
        status_(size()),
        ending_(size()),
        events_(events ? size() : 0) {
    const bool fit = std::all_of(others.begin(), others.end(), [&](const Numbers& each) {
      return each.size() == 1 || each.size() == size();
    });
    if (!(others.empty() || (others.size() == 4 && fit)))
      throw std::invalid_argument("others must be four arrays of one value or one of each point");
    for (bool& each : varies_) each = !each;
    constexpr double infinite = std::numeric_limits<double>::infinity();
    ends_.fill({infinite, -infinite});
    // The factors of the load are written for each block, unless they are constant.
    if (varies_[plate_load] || (size() > 0 && *inputs[plate_load].data() != 1.0))
      varies_[plate_kinetic] = varies_[plate_static] = varies_[plate_load] = true;
    for (std::size_t k = 0; k < input_count; ++k)
      if (!varies_[k] && size() > 0) ends_[k] = {*inputs[k].data(), *inputs[k].data()};
    for (const Row& row : rows_) {
      asked_ = std::max(asked_, row.asked());
      energy_ = energy_ || row.energy;
    }
  }

  std::size_t size() const { return size_; }

  /// Computes all points with several threads. The caller's thread is the first one and alone
  /// checks for an interrupt, which stops all threads.
  void run(std::size_t threads, Interrupt& interrupt) {
    share_ = std::clamp<std::size_t>(size() / (4 * threads), least_share, Block::capacity);
    const auto go_on = [&] { return !stopped_.load(std::memory_order_relaxed); };
    std::vector<std::future<void>> others;
    try {
      while (others.size() + 1 < std::min(threads, size() / share_ + 1))
        others.push_back(std::async(std::launch::async, [this, go_on] { work(go_on); }));
      work([&] { return interrupt.go_on(); });
    } catch (...) {
      stopped_ = true;
      throw;
    }
    if (interrupt.found()) stopped_ = true;
    for (auto& other : others) {
      while (other.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready)
        if (!interrupt.look()) stopped_ = true;
      other.get();
    }
  }

  /// The columns; how many points the general core followed; the extremes of the inputs.
  nb::dict table() {
    nb::dict columns;
    for (std::size_t k = 0; k < rows_.size(); ++k) columns[names_[k].c_str()] = numbers_.array(k);
    columns["status"] = status_.array();
    columns["ending"] = ending_.array();
    if (events_.size() > 0 || size() == 0) columns["events"] = events_.array();
    columns["general"] = general_.load();
    nb::list extremes;
    for (const pe::Extremes& each : ends_)
      extremes.append(nb::make_tuple(each.least, each.largest));
    columns["extremes"] = extremes;
    return columns;
  }

 private:
  /// Workspace of a thread.
  struct Space {
    signed char broken[Block::capacity];
    Block block;
    double rest_time[Block::capacity], events[Block::capacity];  // without requested rows
    std::vector<pd::Segment<double>> segments;
  };

  static std::vector<Row> rows_of(const std::vector<std::string>& names) {
    std::vector<Row> rows;
    for (const std::string& name : names)
      if (!rows.emplace_back(name.c_str()).exists())
        throw std::invalid_argument("there is no number " + name);
    return rows;
  }
  static std::size_t size_of(const Inputs& inputs) {
    std::size_t size = 1;
    for (std::size_t axis = 0; axis < inputs[0].ndim(); ++axis) size *= inputs[0].shape(axis);
    return size;
  }

  /// Work of one thread.
  template <class GoOn>
  void work(GoOn go_on) {
    const auto space = std::make_unique<Space>();
    fill(space->block, std::min(share_, size()));
    std::array<pe::Extremes, input_count> ends = ends_;
    follow(go_on, *space, ends);
    const std::lock_guard<std::mutex> one_thread(merging_);
    for (std::size_t k = 0; k < input_count; ++k) merge(ends_[k], ends[k]);
  }

  /// Arguments that are equal for all points are written once.
  void fill(Block& block, std::size_t count) {
    for (std::size_t k = 0; k < input_count; ++k)
      if (!varies_[k]) std::fill_n(block.input[k], count, size() > 0 ? *inputs_[k].data() : 0.0);
  }
  /// NaN stays.
  static void merge(pe::Extremes& all, const pe::Extremes& some) {
    if (all.least == all.least && !(all.least <= some.least)) all.least = some.least;
    if (all.largest == all.largest && !(all.largest >= some.largest)) all.largest = some.largest;
  }

  template <class GoOn>
  void follow(GoOn go_on, Space& space, std::array<pe::Extremes, input_count>& ends) {
    for (;;) {
      const std::size_t first = next_.fetch_add(share_);
      if (first >= size()) return;
      const std::size_t count = std::min(share_, size() - first);
      if (!go_on()) return;
      Block& block = space.block;
      points(inputs_, first, count, varies_, block.input);
      std::array<pe::Extremes, input_count> of_share = ends;
      for (std::size_t k = 0; k < input_count; ++k)
        if (varies_[k]) merge(ends[k], of_share[k] = kernel_.extremes(block.input[k], count));
      const bool good =
          kernel_.judge(block, static_cast<int>(count), of_share.data(), bounds_, space.broken);
      press(block, count);
      // The kernel knows no stops, and before it has followed a pin nobody knows whether that meets one.
      const bool followed = others_.empty() && by_kernel(first, count, space);
      if (good && followed && !energy_) continue;
      for (std::size_t i = 0; i < count; ++i) {
        if (space.broken[i] != 0) {
          leave_out(first + i, static_cast<std::int8_t>(refused + space.broken[i]));
          continue;
        }
        if (const std::int8_t status = broken_other(first + i)) {
          leave_out(first + i, status);
          continue;
        }
        const pd::Stops<double> stops = stops_of(first + i);
        if (stops.within(block.input[displacement][i]) != block.input[displacement][i]) {
          leave_out(first + i, static_cast<std::int8_t>(refused + 1 + displacement));
          continue;
        }
        const Left left = others_.empty() ? left_by_kernel(block, i) : Left::all;
        if (left == Left::nothing && !energy_) continue;
        if (!go_on()) return;
        Point p;
        for (std::size_t k = 0; k < input_count; ++k) p[k] = block.input[k][i];
        by_general_core(first + i, p, stops, left, space.segments, go_on);
        if (space.segments.capacity() > keep)
          std::vector<pd::Segment<double>>().swap(space.segments);
      }
    }
  }

  double other_number(std::size_t k, std::size_t i) const {
    return others_[k].data()[others_[k].size() > 1 ? i : 0];
  }
  pd::Stops<double> stops_of(std::size_t i) const {
    if (others_.empty()) return {};
    return {other_number(0, i), other_number(1, i), other_number(2, i)};
  }
  /// The status of a point with a refused number of stops or skin, or 0.
  std::int8_t broken_other(std::size_t i) const {
    for (std::size_t k = 0; k < others_.size(); ++k)
      if (std::isnan(other_number(k, i))) return static_cast<std::int8_t>(first_of_others + k);
    return 0;
  }

  /// The load of the plate multiplies its friction forces.
  void press(Block& block, std::size_t count) const {
    if (!varies_[plate_load]) return;  // the load is 1
    for (const std::size_t force : {plate_kinetic, plate_static})
      for (std::size_t i = 0; i < count; ++i) block.input[force][i] *= block.input[plate_load][i];
  }

  /// Part of a point that the general core computes.
  enum class Left : signed char { nothing, settling_time, all };
  static Left left_by_kernel(const Block& block, std::size_t i) {
    if (block.given_up[i]) return Left::all;
    return block.unsure[i] ? Left::settling_time : Left::nothing;
  }

  /// Computes all points of a share and writes their numbers into the rows. True if the kernel leaves no point to
  /// the general core, which overwrites those left.
  bool by_kernel(std::size_t first, std::size_t count, Space& space) {
    Block& block = space.block;
    std::fill_n(block.output, Block::columns, nullptr);
    block.output[Block::rest_time] = space.rest_time;
    if (events_.size() > 0) block.output[PlainNumber::events] = space.events;
    for (std::size_t k = 0; k < rows_.size(); ++k)
      if (rows_[k].column != no_column) block.output[rows_[k].column] = numbers_[k] + first;
    kernel_.follow(block, static_cast<int>(count), asked_);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rows_[k].energy) continue;
      const int column = rows_[k].column;
      if (column == no_column)
        std::fill_n(numbers_[k] + first, count, std::numeric_limits<double>::quiet_NaN());
      else if (block.output[column] != numbers_[k] + first)  // two rows of one column
        std::copy_n(block.output[column], count, numbers_[k] + first);
    }
    constexpr auto resting = static_cast<std::int8_t>(pd::End::resting);
    constexpr auto moving = static_cast<std::int8_t>(pd::End::moving);
    const double* since = block.output[Block::rest_time];
    std::fill_n(&status_[first], count, static_cast<std::int8_t>(pd::Status::ok));
    for (std::size_t i = 0; i < count; ++i)
      ending_[first + i] = since[i] == since[i] ? resting : moving;
    if (events_.size() > 0)
      for (std::size_t i = 0; i < count; ++i)
        events_[first + i] = static_cast<std::int32_t>(space.events[i]);
    const auto none = [&](const bool* flags) {
      return std::find(flags, flags + count, true) == flags + count;
    };
    return none(block.given_up) && none(block.unsure);
  }

  void leave_out(std::size_t i, std::int8_t status) {
    status_[i] = status;
    ending_[i] = -1;
    if (events_.size() > 0) events_[i] = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k)
      numbers_[k][i] = std::numeric_limits<double>::quiet_NaN();
  }

  /// Computes one point, or the rest of a point, and its energies.
  template <class GoOn>
  void by_general_core(std::size_t i, const Point& p, const pd::Stops<double>& stops, Left left,
                       std::vector<pd::Segment<double>>& segments, GoOn go_on) {
    const pd::Drive<double> drive = drive_of(p, stops, others_.empty() ? 0 : other_number(3, i));
    const pd::Inputs<double> inputs = inputs_of(p);
    const pd::Summary<double> summary =
        pd::summarise(drive, inputs, p[settling_band], segments, go_on);
    const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(),
                                    summary.outcome);
    if (left != Left::nothing) {
      ++general_;
      const pd::batch::Summary all = pd::batch::with_end(summary, motion);
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        const Row& row = rows_[k];
        if (row.energy) continue;
        if (left == Left::all || row.column == PlainNumber::settling_time)
          numbers_[k][i] = row.of(all);
      }
    }
    if (left == Left::all) {
      status_[i] = static_cast<std::int8_t>(summary.outcome.status);
      ending_[i] = static_cast<std::int8_t>(summary.outcome.end);
      if (events_.size() > 0) events_[i] = static_cast<std::int32_t>(summary.events);
    }
    if (!energy_) return;
    const auto ledger = pd::energy_ledger(motion, summary.duration, go_on);
    for (std::size_t k = 0; k < rows_.size(); ++k)
      if (rows_[k].energy) numbers_[k][i] = rows_[k].energy(ledger);
  }

  const Inputs& inputs_;
  const pe::Bounds& bounds_;
  std::size_t size_, share_{least_share};
  const std::vector<std::string>& names_;
  std::vector<Row> rows_;
  pd::detail::Asked asked_;
  bool energy_{false};
  const pe::KernelFunctions& kernel_;
  const OtherNumbers& others_;
  Rows numbers_;
  std::array<bool, input_count> varies_;        ///< inputs that are written for each block
  std::array<pe::Extremes, input_count> ends_;  ///< the least and the largest of each input
  std::mutex merging_;
  Column<std::int8_t> status_, ending_;
  Column<std::int32_t> events_;
  std::atomic<std::size_t> next_{0}, general_{0};
  std::atomic<bool> stopped_{false};
};

const pe::KernelFunctions& kernel_for(int width) {
  const pe::KernelFunctions* found = pe::kernel_of(width);
  if (!found) throw std::invalid_argument("this processor has no kernel of that width");
  return *found;
}

nb::dict simulate_batch(const Inputs& inputs, const pe::Bounds& bounds, std::size_t threads,
                        const std::vector<std::string>& outputs, bool events, int width,
                        const OtherNumbers& others) {
  Batch batch(inputs, bounds, outputs, events, kernel_for(width), others);
  Interrupt interrupt;
  {
    const nb::gil_scoped_release unlocked;
    batch.run(threads, interrupt);
  }
  if (interrupt.found()) throw nb::python_error();
  return batch.table();
}

// ---- the kernel by itself ------------------------------------------------------------------------

std::vector<int> kernel_widths() {
  std::vector<int> widths;
  for (const pe::KernelFunctions* each = pe::kernels(); each->width != 0; ++each)
    widths.push_back(each->width);
  return widths;
}

nb::ndarray<nb::numpy, double, nb::ndim<1>, nb::c_contig> elementary(int which, const Numbers& a,
                                                                     const Numbers& b, int width) {
  Column<double> found(a.size());
  if (a.size() > 0) kernel_for(width).elementary(which, a.data(), b.data(), &found[0], a.size());
  return found.array();
}

}  // namespace

void bind_batch(nb::module_& m);  // called in _core.cpp

void bind_batch(nb::module_& m) {
  m.def(
      "simulate_batch", &simulate_batch, "inputs"_a, "bounds"_a, "threads"_a, "outputs"_a,
      "events"_a, "width"_a = 0, "others"_a = nb::list(),
      "Columns of the numbers named in outputs, one row for each point of the inputs in C order: "
      "arrays of one shape (mass, stiffness, damping, plate kinetic and static, finger kinetic, "
      "static and stiffness, mouse velocity, displacement, velocity, duration, settling band, "
      "plate load). A "
      "point that breaks one of the bounds (the least value, the largest, and one beside them or "
      "NaN) of the arguments in this order, of the damping ratio and of the phase is left out: its "
      "status says which, its numbers are NaN. The column of events is there if asked for; "
      "`general` says how many points the general core followed, `extremes` the least and the "
      "largest value of each argument, NaN if one is NaN. The kernel works in packs of "
      "`width`; 0: the widest. Where others are given (of the end stops travel, infinite: none, "
      "stiffness, infinite: rigid, and damping; damping of the skin; a NaN is a number that is "
      "refused) the general core follows all points.");
  m.def("kernel_widths", &kernel_widths, "The widths of the kernel that this processor runs.");
  m.def("elementary", &elementary, "which"_a, "a"_a, "b"_a, "width"_a,
        "Values of one of the elementary functions: sine, cosine, exp, expm1, log, log1p of a, or "
        "the angle of the points (b, a), by the kernel of a width.");
}
