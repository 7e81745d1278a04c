// The C interface: names and arrays in and out of the exact core. Its only logic is to check them.
#include "pindrive.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "owned_motion.hpp"
#include "pindrive/batch.hpp"
#include "pindrive/certify.hpp"
#include "pindrive/crossings.hpp"
#include "pindrive/energy.hpp"
#include "pindrive/transient.hpp"

namespace pd = pindrive;

namespace {

using Dual = pd::Dual<double>;
double plain(double number) { return number; }
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double none = std::numeric_limits<double>::quiet_NaN();

// ---- errors ------------------------------------------------------------------------------------

thread_local char last_error[256] = "";

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
pindrive_error fail(pindrive_error error, const char* format, ...) {
  std::va_list given;
  va_start(given, format);
  std::vsnprintf(last_error, sizeof last_error, format, given);
  va_end(given);
  return error;
}

pindrive_error null_pointer(const char* what) {
  return fail(PINDRIVE_NULL, "%s must not be null", what);
}

/// What a function returns that may run out of memory.
template <class Function>
pindrive_error guarded(Function&& function) {
#if defined(__cpp_exceptions)
  try {
    return function();
  } catch (const std::bad_alloc&) {
    return fail(PINDRIVE_OUT_OF_MEMORY, "out of memory");
  }
#else
  return function();
#endif
}

/// Asks a caller now and then whether to go on.
class Attended {
 public:
  Attended(pindrive_go_on ask, void* context) : ask_(ask), context_(context) {}

  bool go_on() {
    if (ask_ && ++done_ % between == 0 && !stopped_) stopped_ = ask_(context_) == 0;
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  static constexpr std::uint32_t between = 1U << 12;  ///< segments: about a millisecond

  pindrive_go_on ask_;
  void* context_;
  std::uint32_t done_{0};
  bool stopped_{false};
};

}  // namespace

// ---- drives and releases -----------------------------------------------------------------------

struct pindrive_drive {
  double mass{none}, stiffness{none}, damping{0};
  pd::ContactNumbers plate{0, 0, infinity, {}}, finger{0, 0, infinity, {}};
};

struct pindrive_release {
  pd::Rows mouse_velocity{{0, 0}}, plate_load{{0, 1}}, force{{0, 0}}, across_velocity{{0, 0}};
  double displacement{0}, velocity{none}, skin_stretch{none}, duration{infinity};
};

namespace {

/// The number of that name, or null; kinetic friction is two numbers.
double* find(pindrive_drive& drive, const char* name) {
  const std::pair<const char*, double*> numbers[] = {{"mass", &drive.mass},
                                                     {"stiffness", &drive.stiffness},
                                                     {"damping", &drive.damping},
                                                     {"plate.kinetic", &drive.plate.kinetic},
                                                     {"plate.static", &drive.plate.static_limit},
                                                     {"finger.kinetic", &drive.finger.kinetic},
                                                     {"finger.static", &drive.finger.static_limit},
                                                     {"finger.stiffness", &drive.finger.stiffness}};
  for (const auto& [known, number] : numbers)
    if (std::strcmp(known, name) == 0) return number;
  return nullptr;
}

bool set(pindrive_drive& drive, const char* name, double value) {
  double* number = find(drive, name);
  if (!number) return false;
  *number = value;
  for (pd::ContactNumbers* contact : {&drive.plate, &drive.finger})
    if (number == &contact->kinetic) contact->static_limit = value;
  return true;
}

pd::Rows* profile(pindrive_release& release, const char* name) {
  if (std::strcmp(name, "mouse_velocity") == 0) return &release.mouse_velocity;
  if (std::strcmp(name, "plate_load") == 0) return &release.plate_load;
  if (std::strcmp(name, "force") == 0) return &release.force;
  if (std::strcmp(name, "across_velocity") == 0) return &release.across_velocity;
  return nullptr;
}

bool set(pindrive_release& release, const char* name, double value) {
  if (pd::Rows* rows = profile(release, name)) {
    rows->assign(1, {0, value});
    return true;
  }
  const std::pair<const char*, double*> numbers[] = {{"displacement", &release.displacement},
                                                     {"velocity", &release.velocity},
                                                     {"skin_stretch", &release.skin_stretch},
                                                     {"duration", &release.duration}};
  for (const auto& [known, number] : numbers)
    if (std::strcmp(known, name) == 0) {
      *number = value;
      return true;
    }
  return false;
}

constexpr const char* drive_names =
    "mass, stiffness, damping, plate.kinetic, plate.static, finger.kinetic, finger.static, "
    "finger.stiffness";
constexpr const char* release_names =
    "mouse_velocity, plate_load, force, across_velocity, displacement, velocity, "
    "skin_stretch, duration";

pindrive_error bad_name(const char* of, const char* name, const char* names) {
  return fail(PINDRIVE_BAD_NAME, "%s has no %.40s, but %s", of, name, names);
}

// ---- what the core can follow ------------------------------------------------------------------

/// Checks a number; the range in words is what the message says.
pindrive_error check(const char* name, double value, bool good, const char* range) {
  if (good) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "%s must be %s, not %.17g", name, range, value);
}

/// Two rows at one time are a step, where there may be one.
pindrive_error check_rows(const char* name, const pd::Rows& rows, bool negative, bool steps) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [first, second] = rows[i];
    const bool steps_here =
        steps && i > 0 && first == rows[i - 1].first && !(i > 1 && first == rows[i - 2].first);
    if (!std::isfinite(first) || (i > 0 && !(first > rows[i - 1].first) && !steps_here))
      return fail(PINDRIVE_BAD_VALUE, "row %zu of %s must come after the one before, not at %.17g",
                  i, name, first);
    if (!std::isfinite(second) || (!negative && second < 0))
      return fail(PINDRIVE_BAD_VALUE, "row %zu of %s must be %s, not %.17g", i, name,
                  negative ? "finite" : "at least 0 and finite", second);
  }
  return PINDRIVE_OK;
}

pindrive_error check_contact(const char* name, const pd::ContactNumbers& contact) {
  char of[40];
  const auto named = [&](const char* what) {
    std::snprintf(of, sizeof of, "%s.%s", name, what);
    return of;
  };
  const double kinetic = contact.kinetic, at_rest = contact.static_limit;
  pindrive_error error = check(named("kinetic"), kinetic, kinetic >= 0 && std::isfinite(kinetic),
                               "at least 0 and finite");
  if (!error)
    error = check(named("static"), at_rest, at_rest >= kinetic && std::isfinite(at_rest),
                  "at least the kinetic friction and finite");
  if (!error)
    error = check(named("stiffness"), contact.stiffness, contact.stiffness > 0, "above 0");
  if (!error && !contact.curve.empty()) {
    error = check(named("curve"), contact.curve[0].first, contact.curve[0].first == 0,
                  "a curve from speed 0 on");
    if (!error) error = check_rows(of, contact.curve, false, false);
    if (!error)
      error = check(named("kinetic"), kinetic, kinetic == contact.curve[0].second,
                    "the first force of its curve");
  }
  return error;
}

pindrive_error check(const pindrive_drive& drive, const pindrive_release& release) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  const auto finite_or = [](double value, double other) {
    return std::isfinite(value) || (std::isnan(value) && std::isnan(other));
  };
  pindrive_error error = check("mass", drive.mass, positive(drive.mass), "above 0 and finite");
  if (!error)
    error = check("stiffness", drive.stiffness, positive(drive.stiffness), "above 0 and finite");
  if (!error)
    error = check("damping", drive.damping, drive.damping >= 0 && std::isfinite(drive.damping),
                  "at least 0 and finite");
  if (!error) error = check_contact("plate", drive.plate);
  if (!error) error = check_contact("finger", drive.finger);
  if (!error) error = check_rows("mouse_velocity", release.mouse_velocity, true, false);
  if (!error) error = check_rows("plate_load", release.plate_load, false, true);
  if (!error) error = check_rows("force", release.force, true, true);
  if (!error) error = check_rows("across_velocity", release.across_velocity, true, false);
  if (!error)
    error = check("duration", release.duration,
                  std::isfinite(release.duration) || release.across_velocity.back().second == 0,
                  "finite where the hand moves across the axis at the end");
  if (!error)
    error =
        check("displacement", release.displacement, std::isfinite(release.displacement), "finite");
  if (!error)
    error = check("velocity", release.velocity, finite_or(release.velocity, none),
                  "finite, or NaN for the plate's");
  if (!error)
    error = check("skin_stretch", release.skin_stretch, finite_or(release.skin_stretch, none),
                  "finite, or NaN");
  if (!error) error = check("duration", release.duration, release.duration > 0, "above 0");
  if (error) return error;
  if (drive.finger.curve.size() > 1 && std::isfinite(drive.finger.stiffness))
    return fail(PINDRIVE_UNSUPPORTED,
                "a compliant finger must have one kinetic friction, not a curve");
  const double skin = release.skin_stretch, most = drive.finger.static_limit;
  if (std::isnan(skin)) return PINDRIVE_OK;
  if (!std::isfinite(drive.finger.stiffness))
    return fail(PINDRIVE_UNSUPPORTED, "skin_stretch must be NaN for a rigid finger");
  return check("skin_stretch", skin, std::abs(skin) * drive.finger.stiffness <= most,
               "what the finger's static friction can hold");
}

pindrive_error same_rows(const char* name, const pd::Rows& rows, const pd::Rows& rates) {
  if (rows.size() == rates.size()) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "the rate of %s must have %zu rows, as it has, not %zu", name,
              rows.size(), rates.size());
}

pd::Numbers numbers_of(const pindrive_drive& drive, const pindrive_release& release) {
  return {drive.mass,       drive.stiffness,        drive.damping,      drive.plate,
          drive.finger,     release.mouse_velocity, release.plate_load, release.displacement,
          release.velocity, release.skin_stretch,   release.force,      release.across_velocity,
          release.duration};
}

/// What stands for the plate's velocity at the release, with its derivative.
void start(pd::Numbers& at, pd::Numbers& along) {
  if (!std::isnan(at.velocity)) return;
  const pd::OwnedRows<Dual> rows(at.mouse_velocity, along.mouse_velocity);
  const Dual plate = rows.profile().from(Dual(0)).value;
  at.velocity = plate.value;
  along.velocity = plate.slope;
}

}  // namespace

// ---- motions -----------------------------------------------------------------------------------

/// A motion, or the derivatives of one: the same questions, answered by values or by derivatives.
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
  motion = std::make_unique<pd::OwnedMotion<T>>(at, along, [&] { return attended.go_on(); });
  if (!attended.stopped()) return PINDRIVE_OK;
  return fail(PINDRIVE_STOPPED, "the computation was stopped by its caller");
}

template <class T>
double value_at(const pd::Motion<T>& motion, const pd::Segment<T>& segment, T tau,
                pindrive_quantity quantity) {
  const T skin = motion.drive().finger.stiffness;
  return motion.along(segment, [&](const auto& along) {
    const auto at = [&](const auto& path) { return along.at(path, tau); };
    switch (quantity) {
      case PINDRIVE_POSITION:
        return pd::result(at(along.position()));
      case PINDRIVE_VELOCITY:
        return pd::result(at(along.velocity()));
      case PINDRIVE_ACCELERATION:
        return pd::result(at(along.acceleration()));
      case PINDRIVE_PLATE_FORCE:
        return pd::result(motion.friction(segment, tau).plate);
      case PINDRIVE_FINGER_FORCE:
        return pd::result(motion.friction(segment, tau).finger);
      case PINDRIVE_SKIN_STRETCH:
        return pd::result(-at(along.finger_force()) / skin);
      case PINDRIVE_SKIN_STRETCH_RATE:
        return pd::result(-at(along.derivative(along.finger_force())) / skin);
      default:
        return none;
    }
  });
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

pindrive_error check_band(double band) {
  return check("settling_band", band, band > 0 && band <= 1, "above 0 and at most 1");
}

constexpr const char* number_names[] = {"transient.peak_displacement",
                                        "transient.peak_time",
                                        "transient.trough_displacement",
                                        "transient.trough_time",
                                        "transient.swing",
                                        "transient.return_velocity",
                                        "transient.return_velocity_time",
                                        "transient.first_reversal_time",
                                        "transient.settling_time",
                                        "transient.rest_time",
                                        "transient.last_event_time",
                                        "transient.peak_stretch",
                                        "transient.peak_stretch_rate",
                                        "transient.plate.reversals",
                                        "transient.plate.time_stuck",
                                        "transient.plate.distance_slid",
                                        "transient.plate.dissipated",
                                        "transient.plate.peak_force",
                                        "transient.finger.reversals",
                                        "transient.finger.time_stuck",
                                        "transient.finger.distance_slid",
                                        "transient.finger.dissipated",
                                        "transient.finger.peak_force",
                                        "ending.position",
                                        "ending.steady_since",
                                        "ending.amplitude",
                                        "ending.period"};
constexpr std::size_t number_count = sizeof number_names / sizeof *number_names;

template <class T>
void write(const pd::Transient<T>& t, const pd::Outcome<T>& outcome, double* values) {
  const T all[] = {t.peak_displacement,
                   t.peak_time,
                   t.trough_displacement,
                   t.trough_time,
                   t.swing,
                   t.return_velocity,
                   t.return_velocity_time,
                   t.first_reversal_time,
                   t.settling_time,
                   t.rest_time,
                   t.last_event_time,
                   t.peak_stretch,
                   t.peak_stretch_rate,
                   t.plate.reversals,
                   t.plate.time_stuck,
                   t.plate.distance_slid,
                   t.plate.dissipated,
                   t.plate.peak_force,
                   t.finger.reversals,
                   t.finger.time_stuck,
                   t.finger.distance_slid,
                   t.finger.dissipated,
                   t.finger.peak_force,
                   t.end_position,
                   outcome.steady_since,
                   t.amplitude,
                   outcome.period};
  static_assert(sizeof all / sizeof *all == number_count);
  for (const T& number : all) *values++ = pd::result(number);
}

constexpr const char* energy_names[] = {
    "kinetic_start",    "kinetic_end",       "spring_start", "spring_end", "skin_start",
    "skin_end",         "plate_work",        "inertia_work", "force_work", "damper_dissipated",
    "plate_dissipated", "finger_dissipated", "residual"};
constexpr std::size_t energy_count = sizeof energy_names / sizeof *energy_names;

constexpr const char* certificate_names[] = {
    "motion_law", "kinematics", "friction_law", "force_bound", "sliding_sign",
    "sticking",   "continuity", "transitions",  "energy",      "dissipation"};
constexpr std::size_t certificate_count = sizeof certificate_names / sizeof *certificate_names;

}  // namespace

extern "C" {

int pindrive_interface(void) { return PINDRIVE_INTERFACE; }

const char* pindrive_last_error(void) { return last_error; }

pindrive_drive* pindrive_drive_new(void) { return new (std::nothrow) pindrive_drive; }
void pindrive_drive_free(pindrive_drive* drive) { delete drive; }

pindrive_error pindrive_drive_set(pindrive_drive* drive, const char* name, double value) {
  if (!drive) return null_pointer("drive");
  if (!name) return null_pointer("name");
  return set(*drive, name, value) ? PINDRIVE_OK : bad_name("a drive", name, drive_names);
}

pindrive_error pindrive_drive_set_curve(pindrive_drive* drive, const char* contact,
                                        const double* speeds, const double* forces, size_t count) {
  if (!drive) return null_pointer("drive");
  if (!contact) return null_pointer("contact");
  if (count > 0 && (!speeds || !forces)) return null_pointer("speeds and forces");
  const bool at_plate = std::strcmp(contact, "plate") == 0;
  if (!at_plate && std::strcmp(contact, "finger") != 0)
    return bad_name("a drive", contact, "the contacts plate and finger");
  return guarded([&]() -> pindrive_error {
    pd::ContactNumbers& numbers = at_plate ? drive->plate : drive->finger;
    pd::Rows rows;
    for (std::size_t i = 0; i < count; ++i) rows.emplace_back(speeds[i], forces[i]);
    numbers.curve = std::move(rows);
    if (count > 0) numbers.kinetic = numbers.static_limit = forces[0];
    return PINDRIVE_OK;
  });
}

pindrive_release* pindrive_release_new(void) {
  pindrive_release* release = nullptr;
  guarded([&]() -> pindrive_error {
    release = new pindrive_release;
    return PINDRIVE_OK;
  });
  return release;
}
void pindrive_release_free(pindrive_release* release) { delete release; }

pindrive_error pindrive_release_set(pindrive_release* release, const char* name, double value) {
  if (!release) return null_pointer("release");
  if (!name) return null_pointer("name");
  return set(*release, name, value) ? PINDRIVE_OK : bad_name("a release", name, release_names);
}

pindrive_error pindrive_release_set_profile(pindrive_release* release, const char* name,
                                            const double* times, const double* values,
                                            size_t count) {
  if (!release) return null_pointer("release");
  if (!name) return null_pointer("name");
  if (!times || !values) return null_pointer("times and values");
  pd::Rows* input = profile(*release, name);
  if (!input)
    return bad_name("a release", name,
                    "the profiles mouse_velocity, plate_load, force and across_velocity");
  if (count == 0) return fail(PINDRIVE_BAD_VALUE, "a profile must have at least one row, not 0");
  return guarded([&]() -> pindrive_error {
    pd::Rows rows;
    for (std::size_t i = 0; i < count; ++i) rows.emplace_back(times[i], values[i]);
    *input = std::move(rows);
    return PINDRIVE_OK;
  });
}

pindrive_drive* pindrive_drive_rate_new(const pindrive_drive* drive) {
  pindrive_drive* rate = nullptr;
  if (drive)
    guarded([&]() -> pindrive_error {
      rate = new pindrive_drive{0, 0, 0, pd::ContactNumbers{0, 0, 0, {}},
                                pd::ContactNumbers{0, 0, 0, {}}};
      rate->plate.curve.resize(drive->plate.curve.size());
      rate->finger.curve.resize(drive->finger.curve.size());
      return PINDRIVE_OK;
    });
  return rate;
}

pindrive_release* pindrive_release_rate_new(const pindrive_release* release) {
  pindrive_release* rate = nullptr;
  if (release)
    guarded([&]() -> pindrive_error {
      rate = new pindrive_release{pd::Rows(release->mouse_velocity.size()),
                                  pd::Rows(release->plate_load.size()),
                                  pd::Rows(release->force.size()),
                                  pd::Rows(release->across_velocity.size()),
                                  0,
                                  0,
                                  0,
                                  0};
      return PINDRIVE_OK;
    });
  return rate;
}

pindrive_error pindrive_simulate(const pindrive_drive* drive, const pindrive_release* release,
                                 pindrive_go_on go_on, void* context, pindrive_motion** motion) {
  if (!drive) return null_pointer("drive");
  if (!release) return null_pointer("release");
  if (!motion) return null_pointer("motion");
  if (const pindrive_error error = check(*drive, *release)) return error;
  return guarded([&]() -> pindrive_error {
    auto made = std::make_unique<pindrive_motion>();
    Attended attended(go_on, context);
    const pd::Numbers at = numbers_of(*drive, *release);
    if (const pindrive_error error = simulated(made->values, at, at, attended)) return error;
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
  if (!error) error = same_rows("plate.curve", drive->plate.curve, drive_rate->plate.curve);
  if (!error) error = same_rows("finger.curve", drive->finger.curve, drive_rate->finger.curve);
  if (!error)
    error = same_rows("mouse_velocity", release->mouse_velocity, release_rate->mouse_velocity);
  if (!error) error = same_rows("plate_load", release->plate_load, release_rate->plate_load);
  if (!error) error = same_rows("force", release->force, release_rate->force);
  if (!error)
    error = same_rows("across_velocity", release->across_velocity, release_rate->across_velocity);
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
                            pd::result(found.steady_since),
                            pd::result(found.period),
                            pd::result(of.view().known_until()),
                            pd::result(found.until),
                            found.cycles() ? pd::result(found.cycle_begin) : none,
                            of.segments().size()};
  });
  return PINDRIVE_OK;
}

const char* pindrive_status_text(pindrive_status status) {
  switch (status) {
    case PINDRIVE_STATUS_OK:
      return "followed to the end";
    case PINDRIVE_STATUS_TOO_MANY_EVENTS:
      return "stopped at the largest number of events: friction and damping are too weak to end "
             "the "
             "motion; give a shorter duration";
    case PINDRIVE_STATUS_STANDSTILL:
      return "stopped where events pile up at one instant; change a parameter by a little, and "
             "please report the drive";
    case PINDRIVE_STATUS_INCONSISTENT:
      return "stopped where no mode agrees with the state; change a parameter by a little, and "
             "please report the drive";
    default:
      return "no status";
  }
}

pindrive_error pindrive_evaluate(const pindrive_motion* motion, pindrive_quantity quantity,
                                 const double* times, size_t count, pindrive_side side,
                                 double* values) {
  if (!motion) return null_pointer("motion");
  if (count > 0 && (!times || !values)) return null_pointer("times and values");
  if (quantity < PINDRIVE_POSITION || quantity > PINDRIVE_SKIN_STRETCH_RATE)
    return fail(PINDRIVE_BAD_VALUE, "a quantity must be from 0 to %d, not %d",
                PINDRIVE_SKIN_STRETCH_RATE, quantity);
  const double known = motion->known_until();
  for (std::size_t i = 0; i < count; ++i) {
    const bool exists = times[i] >= 0 && times[i] <= known && std::isfinite(times[i]);
    if (!exists)
      return fail(PINDRIVE_BAD_VALUE, "times[%zu] must be finite and from 0 to %.17g s, not %.17g",
                  i, known, times[i]);
  }
  const auto limit = side == PINDRIVE_LEFT ? pd::Side::left : pd::Side::right;
  motion->ask([&](const auto& of) {
    const auto view = of.view();
    for (std::size_t i = 0; i < count; ++i) {
      const auto [segment, tau] = view.locate(times[i], limit);
      values[i] = value_at(view, *segment, tau, quantity);
    }
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
                pd::result(of.view().along(
                    s, [](const auto& along) { return along.start(along.acceleration()); })),
                static_cast<pindrive_contact_state>(s.mode.plate),
                static_cast<pindrive_contact_state>(s.mode.finger),
                static_cast<pindrive_transition>(s.event.plate),
                static_cast<pindrive_transition>(s.event.finger)};
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
      const double tau = s.end - s.begin;
      events[i] = {time, value_at(view, s, tau, PINDRIVE_POSITION),
                   value_at(view, s, tau, PINDRIVE_VELOCITY),
                   static_cast<pindrive_transition>(s.event.plate),
                   static_cast<pindrive_transition>(s.event.finger)};
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
  return index < number_count ? number_names[index] : nullptr;
}

pindrive_error pindrive_numbers(const pindrive_motion* motion, double duration,
                                double settling_band, double* values) {
  if (!motion) return null_pointer("motion");
  if (!values) return null_pointer("values");
  if (const pindrive_error error = check_band(settling_band)) return error;
  return motion->ask([&](const auto& of) -> pindrive_error {
    if (const auto error = duration_in(of, settling_band, duration)) return error;
    const auto view = of.view();
    write(pd::Measurement(view, decltype(view.known_until())(duration)).transient(settling_band),
          of.outcome(), values);
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

size_t pindrive_energy_count(void) { return energy_count; }
const char* pindrive_energy_name(size_t index) {
  return index < energy_count ? energy_names[index] : nullptr;
}

pindrive_error pindrive_energy(const pindrive_motion* motion, double duration, double* values) {
  if (!motion) return null_pointer("motion");
  if (!values) return null_pointer("values");
  return motion->ask([&](const auto& of) -> pindrive_error {
    if (const auto error = duration_in(of, pd::settling_band, duration)) return error;
    const auto view = of.view();
    const auto ledger = pd::energy_ledger(view, decltype(view.known_until())(duration));
    const decltype(ledger.residual()) entries[] = {
        ledger.kinetic_start,     ledger.kinetic_end,      ledger.spring_start,
        ledger.spring_end,        ledger.skin_start,       ledger.skin_end,
        ledger.plate_work,        ledger.inertia_work,     ledger.force_work,
        ledger.damper_dissipated, ledger.plate_dissipated, ledger.finger_dissipated,
        ledger.residual()};
    static_assert(sizeof entries / sizeof *entries == energy_count);
    for (const auto& entry : entries) *values++ = pd::result(entry);
    return PINDRIVE_OK;
  });
}

size_t pindrive_certificate_count(void) { return certificate_count; }
const char* pindrive_certificate_name(size_t index) {
  return index < certificate_count ? certificate_names[index] : nullptr;
}

pindrive_error pindrive_certificate(const pindrive_motion* motion, double duration,
                                    double* values) {
  if (!values) return null_pointer("values");
  if (const pindrive_error error = check_asked(motion, 0, "duration")) return error;
  if (const pindrive_error error = duration_in(*motion->values, pd::settling_band, duration))
    return error;
  const auto view = motion->values->view();
  const auto c = pd::Certifier<double>(view, duration).certify();
  const double laws[] = {c.motion_law, c.kinematics, c.friction_law, c.force_bound, c.sliding_sign,
                         c.sticking,   c.continuity, c.transitions,  c.energy,      c.dissipation};
  static_assert(sizeof laws / sizeof *laws == certificate_count);
  std::copy(std::begin(laws), std::end(laws), values);
  return PINDRIVE_OK;
}

pindrive_error pindrive_batch(const pindrive_drive* drive, const pindrive_release* release,
                              const pindrive_varied* varied, size_t varied_count, size_t points,
                              double settling_band, pindrive_go_on go_on, void* context,
                              double* numbers, pindrive_status* status, pindrive_end* end,
                              pindrive_error* errors) {
  if (!drive) return null_pointer("drive");
  if (!release) return null_pointer("release");
  if (varied_count > 0 && !varied) return null_pointer("varied");
  if (points > 0 && !numbers) return null_pointer("numbers");
  if (const pindrive_error error = check_band(settling_band)) return error;
  return guarded([&]() -> pindrive_error {
    pindrive_drive at_drive = *drive;
    pindrive_release at_release = *release;
    for (std::size_t j = 0; j < varied_count; ++j) {
      if (!varied[j].name || !varied[j].values) return null_pointer("name and values of a varied");
      if (!set(at_drive, varied[j].name, 0) && !set(at_release, varied[j].name, 0))
        return fail(PINDRIVE_BAD_NAME, "neither a drive nor a release has %.40s, but %s; %s",
                    varied[j].name, drive_names, release_names);
    }
    at_drive = *drive;
    at_release = *release;
    Attended attended(go_on, context);
    for (std::size_t i = 0; i < points; ++i) {
      for (std::size_t j = 0; j < varied_count; ++j)
        if (!set(at_drive, varied[j].name, varied[j].values[i]))
          set(at_release, varied[j].name, varied[j].values[i]);
      double* row = numbers + i * number_count;
      const pindrive_error error = check(at_drive, at_release);
      if (errors) errors[i] = error;
      if (error) {
        std::fill(row, row + number_count, none);
        if (status) status[i] = PINDRIVE_STATUS_INCONSISTENT;
        if (end) end[i] = PINDRIVE_END_MOVING;
        continue;
      }
      std::unique_ptr<pd::OwnedMotion<double>> motion;
      const pd::Numbers at = numbers_of(at_drive, at_release);
      if (const pindrive_error stopped = simulated(motion, at, at, attended)) return stopped;
      double duration = none;
      duration_in(*motion, settling_band, duration);
      const auto view = motion->view();
      write(pd::Measurement(view, duration).transient(settling_band), motion->outcome(), row);
      if (status) status[i] = static_cast<pindrive_status>(motion->outcome().status);
      if (end) end[i] = static_cast<pindrive_end>(motion->outcome().end);
    }
    return PINDRIVE_OK;
  });
}

}  // extern "C"
