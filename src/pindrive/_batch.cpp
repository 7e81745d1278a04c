// Many points at once: arrays in and out of the core, shared out among threads. No physics here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <future>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "interrupt.hpp"
#include "pindrive/batch.hpp"
#include "pindrive/energy.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
using nb::literals::operator""_a;

namespace {

using Summary = pd::Summary<double>;
using Ledger = pd::Ledger<double>;

constexpr std::size_t share = 32;       // points that a thread takes at a time
constexpr std::size_t keep = 1U << 12;  // segments that a thread keeps room for

// ---- in ------------------------------------------------------------------------------------------

/// The arguments of a point, in the order of `inputs` below.
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
  input_count
};
using Input = nb::ndarray<const double, nb::device::cpu>;
using Inputs = std::array<Input, input_count>;
using Statuses = nb::ndarray<const std::int8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Point = std::array<double, input_count>;

/// Point i, in C order, of arrays that have one shape; along an axis an array may stand still.
Point point(const Inputs& inputs, std::size_t i) {
  std::array<std::int64_t, input_count> offset{};
  for (std::size_t axis = inputs[0].ndim(); axis-- > 0;) {
    const auto length = inputs[0].shape(axis);
    const auto index = static_cast<std::int64_t>(i % length);
    i /= length;
    for (std::size_t k = 0; k < input_count; ++k) offset[k] += index * inputs[k].stride(axis);
  }
  Point found;
  for (std::size_t k = 0; k < input_count; ++k) found[k] = inputs[k].data()[offset[k]];
  return found;
}

pd::Drive<double> drive_of(const Point& p) {
  return {p[mass],
          p[stiffness],
          p[damping],
          {p[plate_kinetic], p[plate_static]},
          {p[finger_kinetic], p[finger_static], p[finger_stiffness]}};
}

pd::Inputs<double> inputs_of(const Point& p) {
  return {p[mouse_velocity], p[displacement], p[velocity], p[duration]};
}

// ---- out -----------------------------------------------------------------------------------------

/// A number that is read off a summary or a ledger.
template <class Source>
struct Number {
  const char* name;  ///< in the table of quantities
  double (*of)(const Source&);
};

constexpr Number<Summary> numbers[] = {
    {"transient.peak_displacement", [](const Summary& s) { return s.transient.peak_displacement; }},
    {"transient.peak_time", [](const Summary& s) { return s.transient.peak_time; }},
    {"transient.trough_displacement",
     [](const Summary& s) { return s.transient.trough_displacement; }},
    {"transient.trough_time", [](const Summary& s) { return s.transient.trough_time; }},
    {"transient.swing", [](const Summary& s) { return s.transient.swing; }},
    {"transient.return_velocity", [](const Summary& s) { return s.transient.return_velocity; }},
    {"transient.return_velocity_time",
     [](const Summary& s) { return s.transient.return_velocity_time; }},
    {"transient.first_reversal_time",
     [](const Summary& s) { return s.transient.first_reversal_time; }},
    {"transient.settling_time", [](const Summary& s) { return s.transient.settling_time; }},
    {"transient.rest_time", [](const Summary& s) { return s.transient.rest_time; }},
    {"transient.last_event_time", [](const Summary& s) { return s.transient.last_event_time; }},
    {"transient.peak_stretch", [](const Summary& s) { return s.transient.peak_stretch; }},
    {"transient.peak_stretch_rate", [](const Summary& s) { return s.transient.peak_stretch_rate; }},
    {"transient.plate.reversals", [](const Summary& s) { return s.transient.plate.reversals; }},
    {"transient.plate.time_stuck", [](const Summary& s) { return s.transient.plate.time_stuck; }},
    {"transient.plate.distance_slid",
     [](const Summary& s) { return s.transient.plate.distance_slid; }},
    {"transient.plate.dissipated", [](const Summary& s) { return s.transient.plate.dissipated; }},
    {"transient.plate.peak_force", [](const Summary& s) { return s.transient.plate.peak_force; }},
    {"transient.finger.reversals", [](const Summary& s) { return s.transient.finger.reversals; }},
    {"transient.finger.time_stuck", [](const Summary& s) { return s.transient.finger.time_stuck; }},
    {"transient.finger.distance_slid",
     [](const Summary& s) { return s.transient.finger.distance_slid; }},
    {"transient.finger.dissipated", [](const Summary& s) { return s.transient.finger.dissipated; }},
    {"transient.finger.peak_force", [](const Summary& s) { return s.transient.finger.peak_force; }},
    {"ending.position", [](const Summary& s) { return s.transient.end_position; }},
    {"ending.steady_since", [](const Summary& s) { return s.transient.steady_since; }},
    {"ending.amplitude", [](const Summary& s) { return s.transient.amplitude; }},
    {"ending.period", [](const Summary& s) { return s.outcome.period; }},
    {"duration", [](const Summary& s) { return s.duration; }},
};
constexpr Number<Ledger> energies[] = {
    {"energy.kinetic_start", [](const Ledger& l) { return l.kinetic_start; }},
    {"energy.kinetic_end", [](const Ledger& l) { return l.kinetic_end; }},
    {"energy.spring_start", [](const Ledger& l) { return l.spring_start; }},
    {"energy.spring_end", [](const Ledger& l) { return l.spring_end; }},
    {"energy.skin_start", [](const Ledger& l) { return l.skin_start; }},
    {"energy.skin_end", [](const Ledger& l) { return l.skin_end; }},
    {"energy.plate_work", [](const Ledger& l) { return l.plate_work; }},
    {"energy.inertia_work", [](const Ledger& l) { return l.inertia_work; }},
    {"energy.damper_dissipated", [](const Ledger& l) { return l.damper_dissipated; }},
    {"energy.plate_dissipated", [](const Ledger& l) { return l.plate_dissipated; }},
    {"energy.finger_dissipated", [](const Ledger& l) { return l.finger_dissipated; }},
    {"energy.residual", [](const Ledger& l) { return l.residual(); }},
};
constexpr std::size_t number_count = std::size(numbers), energy_count = std::size(energies);

/// A column of flags or counts over all points, each of which is written once.
template <class T>
class Column {
 public:
  explicit Column(std::size_t size) : values_(new T[size]), size_(size) {}
  T& operator[](std::size_t i) { return values_[i]; }
  nb::ndarray<nb::numpy, T, nb::ndim<1>, nb::c_contig> array() {
    T* values = values_.release();
    const nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    return {values, {size_}, owner};
  }

 private:
  std::unique_ptr<T[]> values_;
  std::size_t size_;
};

// ---- between -------------------------------------------------------------------------------------

class Batch {
 public:
  /// A point whose status is not 0 is bad: it is left out, and marked.
  Batch(const Inputs& inputs, const Statuses& given, bool energy)
      : inputs_(inputs),
        given_(given),
        energy_(energy),
        // One block, which NumPy asks the system for in large pages.
        block_(nb::module_::import_("numpy").attr("empty")(nb::make_tuple(rows(), size()))),
        numbers_(nb::cast<nb::ndarray<double, nb::c_contig, nb::device::cpu>>(block_).data()),
        status_(size()),
        ending_(size()),
        events_(size()) {}

  std::size_t size() const { return given_.size(); }
  std::size_t rows() const { return number_count + (energy_ ? energy_count : 0); }

  /// Works all points off with so many threads, of which the caller's is one and alone looks for an
  /// interrupt; when it finds one, all of them stop.
  void run(std::size_t threads, Interrupt& interrupt) {
    const auto go_on = [&] { return !stopped_.load(std::memory_order_relaxed); };
    std::vector<std::future<void>> others;
    try {
      while (others.size() + 1 < std::min(threads, size() / share + 1))
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

  nb::dict table() {
    nb::dict columns;
    for (std::size_t k = 0; k < rows(); ++k)
      columns[k < number_count ? numbers[k].name : energies[k - number_count].name] = block_[k];
    columns["status"] = status_.array();
    columns["ending"] = ending_.array();
    columns["events"] = events_.array();
    return columns;
  }

 private:
  template <class GoOn>
  void work(GoOn go_on) {
    std::vector<pd::Segment<double>> segments;
    for (;;) {
      const std::size_t first = next_.fetch_add(share);
      if (first >= size()) return;
      for (std::size_t i = first; i < std::min(first + share, size()); ++i) {
        if (!go_on()) return;
        settle(i, segments, go_on);
        if (segments.capacity() > keep) std::vector<pd::Segment<double>>().swap(segments);
      }
    }
  }

  template <class GoOn>
  void settle(std::size_t i, std::vector<pd::Segment<double>>& segments, GoOn go_on) {
    if (given_.data()[i] != 0) {
      status_[i] = given_.data()[i];
      ending_[i] = -1;
      events_[i] = 0;
      for (std::size_t k = 0; k < rows(); ++k)
        numbers_[k * size() + i] = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    const Point p = point(inputs_, i);
    const pd::Drive<double> drive = drive_of(p);
    const pd::Inputs<double> inputs = inputs_of(p);
    const Summary summary = pd::summarise(drive, inputs, p[settling_band], segments, go_on);
    status_[i] = static_cast<std::int8_t>(summary.outcome.status);
    ending_[i] = static_cast<std::int8_t>(summary.outcome.end);
    events_[i] = static_cast<std::int32_t>(summary.events);
    write(numbers, summary, numbers_ + i, std::make_index_sequence<number_count>{});
    if (!energy_) return;
    const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(),
                                    summary.outcome);
    write(energies, pd::energy_ledger(motion, summary.duration, summary.transient, go_on),
          numbers_ + number_count * size() + i, std::make_index_sequence<energy_count>{});
  }

  /// Each number to its own row, one below the other.
  template <class Source, std::size_t count, std::size_t... k>
  void write(const Number<Source> (&of)[count], const Source& source, double* first,
             std::index_sequence<k...>) {
    const std::size_t stride = size();
    ((first[k * stride] = of[k].of(source)), ...);
  }

  const Inputs& inputs_;
  const Statuses& given_;
  bool energy_;
  nb::object block_;
  double* numbers_;  ///< its rows are the columns
  Column<std::int8_t> status_, ending_;
  Column<std::int32_t> events_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stopped_{false};
};

nb::dict simulate_batch(const Inputs& inputs, const Statuses& status, std::size_t threads,
                        bool energy) {
  Batch batch(inputs, status, energy);
  Interrupt interrupt;
  {
    const nb::gil_scoped_release unlocked;
    batch.run(threads, interrupt);
  }
  if (interrupt.found()) throw nb::python_error();
  return batch.table();
}

}  // namespace

void bind_batch(nb::module_& m);  // called in _core.cpp

void bind_batch(nb::module_& m) {
  m.def(
      "simulate_batch", &simulate_batch, "inputs"_a, "status"_a, "threads"_a, "energy"_a,
      "Columns of numbers, one row for each point of the inputs in C order: arrays of one shape "
      "(mass, stiffness, damping, plate kinetic and static, finger kinetic, static and "
      "stiffness, mouse velocity, displacement, velocity, duration, settling band). A point whose "
      "status is not 0 is left out: its numbers are NaN. With `energy` the ledger's terms too.");
}
