// The C interface: motions, and what is asked of them.
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <utility>

#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"
#include "pindrive/engine.hpp"

namespace pd = pindrive;

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

/// A motion, or the derivatives of a motion: equal functions return values or derivatives.
struct pindrive_motion {
  std::unique_ptr<pd::OwnedMotion<double>> values;
  std::unique_ptr<pd::OwnedMotion<Dual>> derivatives;

  template <class Function>
  auto ask(Function&& function) const {
    return values ? function(*values) : function(*derivatives);
  }
  double known_until() const {
    return ask([](const auto& motion) { return plain(motion.view().known_until()); });
  }
};

namespace {

template <class T>
pindrive_error simulated(std::unique_ptr<pd::OwnedMotion<T>>& motion, pd::Numbers at,
                         pd::Numbers along, Attended& attended) {
  start(at, along);
  motion = std::make_unique<pd::OwnedMotion<T>>(at, along,
                                                [&](const auto&) { return attended.go_on(); });
  if (!attended.stopped()) return PINDRIVE_OK;
  return stopped();
}

/// Checks what is asked of a motion alone, over [0, until].
pindrive_error check_asked(const pindrive_motion* motion, double until, const char* name) {
  if (!motion) return null_pointer("motion");
  if (!motion->values)
    return fail(PINDRIVE_DERIVATIVE, "this is asked of a motion, not of its derivatives");
  const double known = motion->known_until();
  if (until >= 0 && until <= known && std::isfinite(until)) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "%s must be finite and from 0 to %.17g s, not %.17g", name, known,
              until);
}

pindrive_error check_turning(pindrive_quantity quantity) {
  if (quantity >= PINDRIVE_POSITION && quantity <= PINDRIVE_ACCELERATION) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "the quantity must be position, velocity or acceleration, not %d",
              quantity);
}

/// Collects what a search visits, as far as it fits.
class Filling {
 public:
  Filling(std::size_t capacity, std::size_t* count) : capacity_(capacity), count_(count) {
    *count_ = 0;
  }
  /// fill(i) while there is room; whether there was.
  template <class Fill>
  bool add(Fill&& fill) {
    if (*count_ == capacity_) {
      more_ = true;
      return false;
    }
    fill((*count_)++);
    return true;
  }
  pindrive_error result() const { return more_ ? PINDRIVE_MORE : PINDRIVE_OK; }

 private:
  std::size_t capacity_;
  std::size_t* count_;
  bool more_{false};
};

/// NaN as the duration that shows the ending; what is allowed is (0, known_until].
template <class T>
pindrive_error duration_in(const pd::OwnedMotion<T>& motion, double band, double& duration) {
  const double known = plain(motion.view().known_until());
  if (std::isnan(duration)) {
    duration = plain(pd::duration_of(motion.view(), T(band)));
    return PINDRIVE_OK;
  }
  if (duration > 0 && duration <= known && std::isfinite(duration)) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "duration must be above 0, finite and at most %.17g s, not %.17g",
              known, duration);
}

/// Writes the numbers of a result in the order of their list.
template <class T, class Result, std::size_t count>
void write(const pd::NamedNumber<T, Result> (&numbers)[count], const Result& of, double* values) {
  for (const auto& number : numbers) *values++ = pd::result(number.of(of));
}

template <class Numbers>
const char* name_of(const Numbers& numbers, std::size_t index) {
  return index < std::size(numbers) ? numbers[index].name : nullptr;
}

constexpr std::size_t number_count = std::size(pd::transient_numbers<double>);

}  // namespace

extern "C" {

pindrive_error pindrive_simulate(const pindrive_drive* drive, const pindrive_release* release,
                                 pindrive_go_on go_on, void* context, pindrive_motion** motion) {
  if (!drive) return null_pointer("drive");
  if (!release) return null_pointer("release");
  if (!motion) return null_pointer("motion");
  pindrive_error error = check(*drive, *release);
  if (!error) error = check_duration(*release);
  if (error) return error;
  return guarded([&]() -> pindrive_error {
    auto made = std::make_unique<pindrive_motion>();
    Attended attended(go_on, context);
    const pd::Numbers at = numbers_of(*drive, *release);
    if (const pindrive_error stopped = simulated(made->values, at, at, attended)) return stopped;
    *motion = made.release();
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_differentiate(const pindrive_drive* drive, const pindrive_release* release,
                                      const pindrive_drive* drive_rate,
                                      const pindrive_release* release_rate, pindrive_go_on go_on,
                                      void* context, pindrive_motion** derivative) {
  if (!drive || !drive_rate) return null_pointer("drive and drive_rate");
  if (!release || !release_rate) return null_pointer("release and release_rate");
  if (!derivative) return null_pointer("derivative");
  pindrive_error error = check(*drive, *release);
  if (!error) error = check_duration(*release);
  if (!error) error = check_rates(*drive, *release, *drive_rate, *release_rate);
  if (error) return error;
  return guarded([&]() -> pindrive_error {
    auto made = std::make_unique<pindrive_motion>();
    Attended attended(go_on, context);
    const pindrive_error stopped = simulated(made->derivatives, numbers_of(*drive, *release),
                                             numbers_of(*drive_rate, *release_rate), attended);
    if (stopped) return stopped;
    *derivative = made.release();
    return PINDRIVE_OK;
  });
}

void pindrive_motion_free(pindrive_motion* motion) { delete motion; }

pindrive_error pindrive_outcome_of(const pindrive_motion* motion, pindrive_outcome* outcome) {
  if (!motion) return null_pointer("motion");
  if (!outcome) return null_pointer("outcome");
  *outcome = motion->ask([&](const auto& of) {
    const auto& found = of.outcome();
    return pindrive_outcome{static_cast<pindrive_status>(found.status),
                            static_cast<pindrive_end>(found.end),
                            pd::result(pd::steady_since(of.view())),
                            pd::result(found.period),
                            pd::result(of.view().known_until()),
                            pd::result(found.until),
                            found.cycles() ? pd::result(found.cycle_begin) : none,
                            of.segments().size()};
  });
  return PINDRIVE_OK;
}

pindrive_error pindrive_evaluate(const pindrive_motion* motion, pindrive_quantity quantity,
                                 const double* times, size_t count, pindrive_side side,
                                 double* values) {
  if (!motion) return null_pointer("motion");
  if (count > 0 && (!times || !values)) return null_pointer("times and values");
  if (quantity < PINDRIVE_POSITION || quantity > PINDRIVE_STOP_FORCE)
    return fail(PINDRIVE_BAD_VALUE, "a quantity must be from 0 to %d, not %d", PINDRIVE_STOP_FORCE,
                quantity);
  const double known = motion->known_until();
  for (std::size_t i = 0; i < count; ++i) {
    const bool exists = times[i] >= 0 && times[i] <= known && std::isfinite(times[i]);
    if (!exists)
      return fail(PINDRIVE_BAD_VALUE, "times[%zu] must be finite and from 0 to %.17g s, not %.17g",
                  i, known, times[i]);
  }
  const auto limit = side == PINDRIVE_LEFT ? pd::Side::left : pd::Side::right;
  motion->ask([&](const auto& of) {
    const auto asked = static_cast<pd::Sampled>(quantity);
    pd::sample(of.view(), times, count, limit, &asked, 1,
               [&](std::size_t i, const auto* found) { values[i] = pd::result(*found); });
  });
  return PINDRIVE_OK;
}

pindrive_error pindrive_segment_of(const pindrive_motion* motion, size_t index,
                                   pindrive_segment* segment) {
  if (!motion) return null_pointer("motion");
  if (!segment) return null_pointer("segment");
  return motion->ask([&](const auto& of) -> pindrive_error {
    if (index >= of.segments().size())
      return fail(PINDRIVE_BAD_VALUE, "a segment must be one of %zu, not %zu", of.segments().size(),
                  index);
    const auto& s = of.segments()[index];
    *segment = {pd::result(s.begin),
                pd::result(s.end),
                pd::result(s.flow.position.start),
                pd::result(s.flow.velocity.start),
                pd::result(pd::start_acceleration(of.view(), s)),
                motion->values ? pd::acceleration_bound(motion->values->view(),
                                                        motion->values->segments()[index])
                               : none,
                static_cast<pindrive_contact_state>(s.mode.plate),
                static_cast<pindrive_contact_state>(s.mode.finger),
                s.mode.plate_branch,
                s.mode.finger_branch,
                static_cast<pindrive_transition>(s.event.plate),
                static_cast<pindrive_transition>(s.event.finger),
                static_cast<int>(s.mode.stop),
                static_cast<pindrive_transition>(s.event.stop)};
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_events(const pindrive_motion* motion, double from, double to,
                               pindrive_event* events, size_t capacity, size_t* count) {
  if (!count) return null_pointer("count");
  if (capacity > 0 && !events) return null_pointer("events");
  if (const pindrive_error error = check_asked(motion, to, "to")) return error;
  if (!(from >= 0)) return fail(PINDRIVE_BAD_VALUE, "from must be at least 0 s, not %.17g", from);
  Filling filling(capacity, count);
  const pd::Motion<double> view = motion->values->view();
  pd::events(view, from, to, [&](double time, const pd::Segment<double>& s) {
    return filling.add([&](std::size_t i) {
      // After the event: a pin that turns or sticks has its velocity exactly, and a rigid stop takes it.
      const auto [segment, tau] = view.locate(s.end, pd::Side::right);
      events[i] = {time,
                   pd::sampled_in(view, *segment, tau, pd::Sampled::position),
                   pd::sampled_in(view, *segment, tau, pd::Sampled::velocity),
                   static_cast<pindrive_transition>(s.event.plate),
                   static_cast<pindrive_transition>(s.event.finger),
                   static_cast<pindrive_transition>(s.event.stop)};
    });
  });
  return filling.result();
}

pindrive_error pindrive_extrema(const pindrive_motion* motion, pindrive_quantity quantity,
                                double until, double* times, double* values, size_t capacity,
                                size_t* count) {
  if (!count) return null_pointer("count");
  if (capacity > 0 && (!times || !values)) return null_pointer("times and values");
  if (const pindrive_error error = check_asked(motion, until, "until")) return error;
  if (const pindrive_error error = check_turning(quantity)) return error;
  Filling filling(capacity, count);
  pd::extrema(motion->values->view(), static_cast<pd::Quantity>(quantity), until,
              [&](double time, double value) {
                return filling.add([&](std::size_t i) { times[i] = time, values[i] = value; });
              });
  return filling.result();
}

pindrive_error pindrive_crossings(const pindrive_motion* motion, pindrive_quantity quantity,
                                  double level, double until, double* times, signed char* sides,
                                  size_t capacity, size_t* count) {
  if (!count) return null_pointer("count");
  if (capacity > 0 && (!times || !sides)) return null_pointer("times and sides");
  if (const pindrive_error error = check_asked(motion, until, "until")) return error;
  if (const pindrive_error error = check_turning(quantity)) return error;
  if (!std::isfinite(level)) return check("level", level, false, "finite");
  Filling filling(capacity, count);
  pd::crossings(motion->values->view(), static_cast<pd::Quantity>(quantity), level, until,
                [&](double time, int side) {
                  return filling.add([&](std::size_t i) {
                    times[i] = time, sides[i] = static_cast<signed char>(side);
                  });
                });
  return filling.result();
}

size_t pindrive_number_count(void) { return number_count; }
const char* pindrive_number_name(size_t index) {
  return name_of(pd::transient_numbers<double>, index);
}

pindrive_error pindrive_numbers(const pindrive_motion* motion, double duration,
                                double settling_band, double* values) {
  if (!motion) return null_pointer("motion");
  if (!values) return null_pointer("values");
  if (const pindrive_error error = check_band(settling_band)) return error;
  return motion->ask([&](const auto& of) -> pindrive_error {
    if (const auto error = duration_in(of, settling_band, duration)) return error;
    const auto view = of.view();
    using T = decltype(view.known_until());
    write(pd::transient_numbers<T>, pd::transient_of(view, T(duration), T(settling_band)), values);
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_duration(const pindrive_motion* motion, double settling_band,
                                 double* duration) {
  if (!motion) return null_pointer("motion");
  if (!duration) return null_pointer("duration");
  if (const pindrive_error error = check_band(settling_band)) return error;
  double found = none;
  motion->ask([&](const auto& of) { return duration_in(of, settling_band, found); });
  *duration = found;
  return PINDRIVE_OK;
}

size_t pindrive_energy_count(void) { return std::size(pd::ledger_numbers<double>); }
const char* pindrive_energy_name(size_t index) {
  return name_of(pd::ledger_numbers<double>, index);
}

pindrive_error pindrive_energy(const pindrive_motion* motion, double duration, double* values) {
  if (!motion) return null_pointer("motion");
  if (!values) return null_pointer("values");
  return motion->ask([&](const auto& of) -> pindrive_error {
    if (const auto error = duration_in(of, pd::settling_band, duration)) return error;
    const auto view = of.view();
    using T = decltype(view.known_until());
    write(pd::ledger_numbers<T>, pd::energy_ledger(view, T(duration)), values);
    return PINDRIVE_OK;
  });
}

size_t pindrive_certificate_count(void) { return std::size(pd::certificate_numbers<double>); }
const char* pindrive_certificate_name(size_t index) {
  return name_of(pd::certificate_numbers<double>, index);
}

pindrive_error pindrive_certificate(const pindrive_motion* motion, double duration,
                                    double* values) {
  if (!values) return null_pointer("values");
  if (const pindrive_error error = check_asked(motion, 0, "duration")) return error;
  if (const pindrive_error error = duration_in(*motion->values, pd::settling_band, duration))
    return error;
  const auto view = motion->values->view();
  write(pd::certificate_numbers<double>, pd::certify(view, duration), values);
  return PINDRIVE_OK;
}

}  // extern "C"
