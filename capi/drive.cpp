// The C interface: drives and releases by the names of their numbers, how they are checked, and what an error says.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <new>
#include <utility>

#include "function_pieces.hpp"
#include "function_sum.hpp"
#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"
#include "pindrive/device/inputs.hpp"
#include "pindrive/model/input_period.hpp"
#include "pindrive/series/input_range.hpp"
#include "wording.hpp"

namespace pd = pindrive;

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

// ---- errors ------------------------------------------------------------------------------------

thread_local char last_error[256] = "";

}  // namespace

namespace pindrive_c {

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

}  // namespace pindrive_c

// ---- drives and releases -----------------------------------------------------------------------

namespace {

using NamedNumbers = std::initializer_list<std::pair<const char*, double*>>;

/// The number of that name, or null.
double* find(NamedNumbers numbers, const char* name) {
  for (const auto& [known, number] : numbers)
    if (std::strcmp(known, name) == 0) return number;
  return nullptr;
}

/// The contact of a name like "plate.kinetic", or null; `name` becomes "kinetic".
pd::ContactNumbers* contact_of(pindrive_drive& drive, const char*& name) {
  for (const auto& [table, contact] :
       {std::pair{"plate.", &drive.plate}, std::pair{"finger.", &drive.finger}})
    if (const std::size_t length = std::strlen(table); std::strncmp(name, table, length) == 0) {
      name += length;
      return contact;
    }
  return nullptr;
}

}  // namespace

bool pindrive_c::set(pindrive_drive& drive, const char* name, double value) {
  double* number = nullptr;
  if (pd::ContactNumbers* const contact = contact_of(drive, name)) {
    pd::LawNumbers& law = contact->law;
    number = find({{"kinetic", &contact->kinetic},
                   {"static", &contact->static_limit},
                   {"law", &law.law},
                   {"breakaway", &law.breakaway},
                   {"stribeck_velocity", &law.velocity},
                   {"exponent", &law.exponent},
                   {"viscous", &law.viscous}},
                  name);
    if (contact == &drive.finger && std::strcmp(name, "stiffness") == 0)
      number = &contact->stiffness;
    if (contact == &drive.finger && std::strcmp(name, "damping") == 0) number = &contact->damping;
    if (contact == &drive.finger && std::strcmp(name, "load_exponent") == 0)
      number = &contact->load_exponent;
    if (number == &contact->kinetic || number == &law.breakaway) contact->static_limit = value;
  } else {
    number = find({{"mass", &drive.mass},
                   {"stiffness", &drive.stiffness},
                   {"damping", &drive.damping},
                   {"travel", &drive.stops.travel},
                   {"stop_stiffness", &drive.stops.stiffness},
                   {"stop_damping", &drive.stops.damping}},
                  name);
  }
  if (!number) return false;
  *number = value;
  return true;
}

namespace {

pd::InputNumbers* profile(pindrive_release& release, const char* name) {
  if (std::strcmp(name, "mouse_velocity") == 0) return &release.mouse_velocity;
  if (std::strcmp(name, "plate_load") == 0) return &release.plate_load;
  if (std::strcmp(name, "force") == 0) return &release.force;
  if (std::strcmp(name, "across_velocity") == 0) return &release.across_velocity;
  if (std::strcmp(name, "finger_load") == 0) return &release.finger_load;
  return nullptr;
}

}  // namespace

bool pindrive_c::set(pindrive_release& release, const char* name, double value) {
  if (pd::InputNumbers* input = profile(release, name)) {
    *input = {{{0, value}}};
    return true;
  }
  const std::pair<const char*, double*> numbers[] = {{"displacement", &release.displacement},
                                                     {"velocity", &release.velocity},
                                                     {"skin_stretch", &release.skin_stretch},
                                                     {"duration", &release.duration},
                                                     {"support", &release.support}};
  for (const auto& [known, number] : numbers)
    if (std::strcmp(known, name) == 0) {
      *number = value;
      return true;
    }
  return false;
}

namespace {

pindrive_error bad_name(const char* of, const char* name, const char* names) {
  return fail(PINDRIVE_BAD_NAME, "%s has no %.40s, but %s", of, name, names);
}

// ---- what the core can follow ------------------------------------------------------------------

}  // namespace

/// The range in words is what the message says.
pindrive_error pindrive_c::check(const char* name, double value, bool good, const char* range) {
  if (good) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "%s must be %s, not %.17g", name, range, value);
}

pindrive_error pindrive_c::check(const char* label, const pd::device::InputQuantity& input,
                                 double value) {
  const pd::device::Bounds* const violated = input.violated(value);
  if (!violated) return PINDRIVE_OK;
  Text required, given;
  add_bounds(required, *violated, unit_of(input));
  given.add_number(value, unit_of(input));
  return fail(PINDRIVE_BAD_VALUE, "%s must be %s, got %s", label, required.get(), given.get());
}

pindrive_error pindrive_c::check(const char* label, double value, bool good, const char* words,
                                 double limit, const char* unit, const char* rest) {
  if (good) return PINDRIVE_OK;
  Text most, given;
  most.add_number(limit, unit);
  given.add_number(value, unit);
  return fail(PINDRIVE_BAD_VALUE, "%s must be %s, %s%s, got %s", label, words, most.get(), rest,
              given.get());
}

namespace {

/// The input of a key, found by the compiler: a copy, so that a library without a device has no table.
template <std::size_t N>
constexpr pd::device::InputQuantity input(const char (&key)[N]) {
  return *pd::device::find_input(key);
}

/// Two rows at one time are a step, where there may be one.
pindrive_error check_rows(const char* name, const pd::Rows& rows, bool negative, bool steps) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [first, second] = rows[i];
    const bool stepped = i > 1 && first == rows[i - 2].first;
    const bool later =
        i == 0 || first > rows[i - 1].first || (steps && first == rows[i - 1].first && !stepped);
    if (!std::isfinite(first) || !later)
      return fail(PINDRIVE_BAD_VALUE, "row %zu of %s must come after the one before, not at %.17g",
                  i, name, first);
    if (!in_range(second, negative))
      return fail(PINDRIVE_BAD_VALUE, "row %zu of %s must be %s, not %.17g", i, name,
                  range_of(negative), second);
  }
  return PINDRIVE_OK;
}

/// Largest decay and frequency of a term of an input, 1/s.
constexpr double largest_decay = 1e9, largest_frequency = 1e7;

/// Pieces in order, with numbers in range.
pindrive_error check_pieces(const char* name, const pd::Pieces& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const pd::PieceNumbers& piece = pieces[i];
    if (!std::isfinite(piece.begin) || (i > 0 && !(piece.begin > pieces[i - 1].begin)))
      return fail(PINDRIVE_BAD_VALUE,
                  "piece %zu of %s must begin after the one before, not at %.17g", i, name,
                  piece.begin);
    for (const double coefficient : piece.polynomial)
      if (!std::isfinite(coefficient))
        return fail(PINDRIVE_BAD_VALUE, "piece %zu of %s must have finite coefficients, not %.17g",
                    i, name, coefficient);
    for (const auto& [cosine, sine, decay, frequency] : piece.terms) {
      for (const double amplitude : {cosine, sine})
        if (!in_range(amplitude, true))
          return fail(PINDRIVE_BAD_VALUE, "an amplitude of %s must be %s, not %.17g", name,
                      range_of(true), amplitude);
      for (const auto& [rate, largest] :
           {std::pair(decay, largest_decay), std::pair(frequency, largest_frequency)}) {
        const bool within = rate >= 0 && rate <= largest;
        if (!within)
          return fail(PINDRIVE_BAD_VALUE, "a rate of %s must be from 0 to %g 1/s, not %.17g", name,
                      largest, rate);
      }
    }
  }
  return PINDRIVE_OK;
}

/// Copies pieces.
pindrive_error read_pieces(const pindrive_piece* pieces, size_t count, pd::Pieces& made) {
  made.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    made[i].begin = pieces[i].begin;
    std::copy_n(pieces[i].polynomial, made[i].polynomial.size(), made[i].polynomial.begin());
    if (pieces[i].count > 0 && !pieces[i].terms) return null_pointer("terms");
    for (std::size_t j = 0; j < pieces[i].count; ++j) {
      const pindrive_term& term = pieces[i].terms[j];
      made[i].terms.push_back({term.cosine, term.sine, term.decay, term.frequency});
    }
  }
  return PINDRIVE_OK;
}

/// Calls use(input, pieces) with an input of a release and the given pieces.
template <class Use>
pindrive_error take_function(pindrive_release* release, const char* name,
                             const pindrive_piece* pieces, size_t count, Use&& use) {
  if (!release) return null_pointer("release");
  if (!name) return null_pointer("name");
  if (!pieces) return null_pointer("pieces");
  pd::InputNumbers* input = profile(*release, name);
  if (!input) return bad_name("a release", name, input_names);
  if (count == 0) return fail(PINDRIVE_BAD_VALUE, "a function must have at least one piece, not 0");
  return guarded([&]() -> pindrive_error {
    pd::Pieces made;
    if (const pindrive_error error = read_pieces(pieces, count, made)) return error;
    return use(*input, std::move(made));
  });
}

/// A function of time: a velocity may not jump, a load may not be negative within the duration.
pindrive_error check_function(const char* name, const pd::InputNumbers& input, bool negative,
                              bool steps, double duration) {
  if (const pindrive_error error = check_pieces(name, input.pieces)) return error;
  const pd::OwnedInput<double> owned(input, input);
  const pd::Profile<double> profile = owned.profile();
  const pd::InputJump jump = pd::first_jump(profile);
  if (!steps && jump.time < infinity)
    return fail(PINDRIVE_BAD_VALUE, "%s must be without a jump, not from %.17g to %.17g at %.17g s",
                name, jump.before, jump.after, jump.time);
  const pd::InputPoint lowest =
      negative ? pd::InputPoint{0, 0} : pd::lowest_value(profile, duration);
  if (lowest.value < -1e-9)
    return fail(PINDRIVE_BAD_VALUE, "%s must not be negative, and is %.17g at %.17g s", name,
                lowest.value, lowest.time);
  return PINDRIVE_OK;
}

pindrive_error check_input(const char* name, const pd::InputNumbers& input, bool negative,
                           bool steps, double duration) {
  return input.pieces.empty() ? check_rows(name, input.rows, negative, steps)
                              : check_function(name, input, negative, steps, duration);
}

pindrive_error check_contact(const char* name, const pd::ContactNumbers& contact) {
  char of[40];
  const auto named = [&](const char* what) {
    std::snprintf(of, sizeof of, "%s.%s", name, what);
    return of;
  };
  // The bounds of both contacts are alike.
  static constexpr auto force = input("plate.kinetic");
  static constexpr auto stiffness = input("finger.stiffness");
  static constexpr auto damping = input("finger.damping");
  static constexpr auto exponent = input("finger.load_exponent");
  static constexpr auto law = input("plate.law");
  static constexpr auto velocity = input("plate.stribeck_velocity");
  static constexpr auto viscous = input("plate.viscous");
  const double kinetic = contact.kinetic, at_rest = contact.static_limit;
  pindrive_error error = check(named("kinetic"), force, kinetic);
  if (!error) error = check(named("static"), force, at_rest);
  if (!error) error = check(named("law"), law, contact.law.law);
  if (!error) error = check(named("viscous"), viscous, contact.law.viscous);
  const bool falls = !error && contact.law.shape() != pd::FallingShape::none;
  const double breakaway = falls ? contact.law.breakaway : kinetic;
  if (falls) {
    error = check(named("stribeck_velocity"), velocity, contact.law.velocity);
    const double exponent = contact.law.exponent;
    if (!error)
      error = check(named("exponent"), exponent, exponent == 1 || exponent == 2, "1 or 2");
    if (!error) error = check(named("breakaway"), force, breakaway);
    if (!error)
      error = check(named("breakaway"), breakaway, breakaway >= kinetic,
                    "at least the kinetic friction", kinetic, "N");
    if (!error && !contact.curve.empty())
      return fail(PINDRIVE_BAD_VALUE, "%s.curve must be empty under a law of its own", name);
    if (!error && contact.stiffness != infinity)
      return fail(PINDRIVE_UNSUPPORTED, "%s.law must be coulomb or table on compliant skin", name);
  }
  if (!error)
    error = check(named("static"), at_rest, at_rest >= breakaway, "at least the kinetic friction",
                  breakaway, "N");
  if (!error && contact.stiffness != infinity)
    error = check(named("stiffness"), stiffness, contact.stiffness);
  if (!error) error = check(named("load_exponent"), exponent, contact.load_exponent);
  if (!error) error = check(named("damping"), damping, contact.damping);
  if (!error)
    error = check(named("damping"), contact.damping,
                  contact.damping == 0 || contact.stiffness != infinity, "0 for a rigid finger");
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

}  // namespace

/// True if the slider of the skin follows the load of the finger's friction, which then is linear in time.
bool pindrive_c::needs_linear_touch(const pd::ContactNumbers& finger) {
  const bool curved = !finger.curve.empty() || finger.law.viscous != 0;
  return finger.stiffness != infinity && (finger.damping == 0 || curved);
}

/// A touch that changes under an exponent of the friction other than 1.
pindrive_error pindrive_c::check_raised(const pd::ContactNumbers& finger, bool pieces) {
  if (pieces)
    return fail(PINDRIVE_UNSUPPORTED,
                "finger_load must be constant or a profile at a finger.load_exponent of %g, not a "
                "function",
                finger.load_exponent);
  if (needs_linear_touch(finger))
    return fail(PINDRIVE_UNSUPPORTED,
                "finger_load must be constant at a finger.load_exponent of %g beside a "
                "finger.stiffness, unless the finger has damping and Coulomb friction",
                finger.load_exponent);
  return PINDRIVE_OK;
}

pindrive_error pindrive_c::check(const pindrive_drive& drive, const pindrive_release& release) {
  static constexpr auto mass = input("drive.mass");
  static constexpr auto spring = input("drive.stiffness");
  static constexpr auto damping = input("drive.damping");
  static constexpr auto travel = input("drive.travel");
  static constexpr auto stop_stiffness = input("drive.stop_stiffness");
  static constexpr auto stop_damping = input("drive.stop_damping");
  static constexpr auto displacement = input("motion.displacement");
  static constexpr auto velocity = input("motion.velocity");
  static constexpr auto stretch = input("motion.skin_stretch");
  const pd::StopNumbers& stops = drive.stops;
  pindrive_error error = check("mass", mass, drive.mass);
  if (!error) error = check("stiffness", spring, drive.stiffness);
  if (!error) error = check("damping", damping, drive.damping);
  if (!error) error = check_contact("plate", drive.plate);
  if (!error) error = check_contact("finger", drive.finger);
  if (!error && stops.travel != infinity) error = check("travel", travel, stops.travel);
  if (!error && stops.stiffness != infinity)
    error = check("stop_stiffness", stop_stiffness, stops.stiffness);
  if (!error) error = check("stop_damping", stop_damping, stops.damping);
  if (!error)
    error = check_input("mouse_velocity", release.mouse_velocity, true, false, release.duration);
  if (!error) error = check_input("plate_load", release.plate_load, false, true, release.duration);
  if (!error) error = check_input("force", release.force, true, true, release.duration);
  if (!error)
    error = check_input("across_velocity", release.across_velocity, true, false, release.duration);
  if (!error)
    error = check_input("finger_load", release.finger_load, false, true, release.duration);
  const bool pieces = !release.finger_load.pieces.empty();
  if (!error && pieces && needs_linear_touch(drive.finger))
    error = fail(PINDRIVE_UNSUPPORTED,
                 "finger_load must be constant or a profile beside a finger.stiffness, unless the "
                 "finger has damping and Coulomb friction");
  if (!error && drive.finger.load_exponent != 1 && !release.finger_load.constant())
    error = check_raised(drive.finger, pieces);
  if (!error)
    error = check("support", release.support, release.support == 0 || release.support == 1,
                  "0 (mouse) or 1 (ground)");
  if (!error) error = check("displacement", displacement, release.displacement);
  if (!error && stops.stiffness == infinity)
    error =
        check("displacement", release.displacement, std::abs(release.displacement) <= stops.travel,
              "at most travel", stops.travel, "m", ", either way");
  if (!error && !std::isnan(release.velocity))
    error = check("velocity", velocity, release.velocity);
  if (!error && !std::isnan(release.skin_stretch))
    error = check("skin_stretch", stretch, release.skin_stretch);
  if (error) return error;
  const double skin = release.skin_stretch;
  const double most =
      drive.finger.static_limit * initial(release.finger_load, drive.finger.load_exponent);
  if (std::isnan(skin)) return PINDRIVE_OK;
  if (!std::isfinite(drive.finger.stiffness))
    return fail(PINDRIVE_UNSUPPORTED, "skin_stretch must be NaN for a rigid finger");
  if (drive.finger.damping > 0) return PINDRIVE_OK;
  return check("skin_stretch", skin, std::abs(skin) * drive.finger.stiffness <= most,
               "at most static friction over stiffness", most / drive.finger.stiffness, "m",
               ", either way");
}

namespace {

/// True if all inputs are constant at last or have a common period.
bool ends_or_repeats(const pindrive_release& release) {
  const auto owned = [](const pd::InputNumbers& input) {
    return pd::OwnedInput<double>(input, input);
  };
  const auto velocity = owned(release.mouse_velocity), load = owned(release.plate_load);
  const auto force = owned(release.force), touch = owned(release.finger_load);
  const auto across = owned(release.across_velocity);
  const pd::InputPeriod<double> found =
      pd::period_of<double>({velocity.profile(), 0, 0, infinity, load.profile(), 0, force.profile(),
                             across.profile(), touch.profile()});
  return found.constant || found.repeats();
}

}  // namespace

double pindrive_c::initial(const pd::InputNumbers& input, double power) {
  return pd::OwnedInput<double>(input, input).profile().to_the(power).from(0).value;
}

pindrive_error pindrive_c::check_duration(const pindrive_release& release) {
  static constexpr auto duration = input("motion.duration");
  if (release.duration == infinity && !ends_or_repeats(release))
    return fail(PINDRIVE_BAD_VALUE,
                "duration must be finite under functions that neither end nor repeat");
  return release.duration == infinity ? PINDRIVE_OK : check("duration", duration, release.duration);
}

namespace {

pindrive_error same_rows(const char* name, const pd::Rows& rows, const pd::Rows& rates) {
  if (rows.size() == rates.size()) return PINDRIVE_OK;
  return fail(PINDRIVE_BAD_VALUE, "the rate of %s must have %zu rows, as it has, not %zu", name,
              rows.size(), rates.size());
}
pindrive_error same_input(const char* name, const pd::InputNumbers& at,
                          const pd::InputNumbers& rate) {
  bool same = at.pieces.size() == rate.pieces.size();
  for (std::size_t i = 0; same && i < at.pieces.size(); ++i)
    same = at.pieces[i].terms.size() == rate.pieces[i].terms.size();
  if (same) return same_rows(name, at.rows, rate.rows);
  return fail(PINDRIVE_BAD_VALUE, "the rate of %s must have its pieces, with their terms", name);
}

}  // namespace

pindrive_error pindrive_c::check_rates(const pindrive_drive& drive, const pindrive_release& release,
                                       const pindrive_drive& drive_rate,
                                       const pindrive_release& release_rate) {
  pindrive_error error = same_rows("plate.curve", drive.plate.curve, drive_rate.plate.curve);
  if (!error) error = same_rows("finger.curve", drive.finger.curve, drive_rate.finger.curve);
  if (!error)
    error = same_input("mouse_velocity", release.mouse_velocity, release_rate.mouse_velocity);
  if (!error) error = same_input("plate_load", release.plate_load, release_rate.plate_load);
  if (!error) error = same_input("force", release.force, release_rate.force);
  if (!error)
    error = same_input("across_velocity", release.across_velocity, release_rate.across_velocity);
  if (!error) error = same_input("finger_load", release.finger_load, release_rate.finger_load);
  return error;
}

pd::Numbers pindrive_c::numbers_of(const pindrive_drive& drive, const pindrive_release& release) {
  return {drive.mass,           drive.stiffness,      drive.damping,
          drive.plate,          drive.finger,         release.mouse_velocity,
          release.plate_load,   release.displacement, release.velocity,
          release.skin_stretch, release.force,        release.across_velocity,
          release.finger_load,  drive.stops,          release.duration,
          release.support};
}

void pindrive_c::start(pd::Numbers& at, pd::Numbers& along, double begin) {
  if (!std::isnan(at.velocity)) return;
  const pd::OwnedInput<Dual> input(at.mouse_velocity, along.mouse_velocity);
  const Dual plate = input.profile().from(Dual(begin)).value;
  at.velocity = plate.value;
  along.velocity = plate.slope;
}

pindrive_error pindrive_c::check_band(double band) {
  static constexpr auto share = input("motion.settling_band");
  return check("settling_band", share, band);
}

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
  pd::InputNumbers* input = profile(*release, name);
  if (!input) return bad_name("a release", name, input_names);
  if (count == 0) return fail(PINDRIVE_BAD_VALUE, "a profile must have at least one row, not 0");
  return guarded([&]() -> pindrive_error {
    pd::Rows rows;
    for (std::size_t i = 0; i < count; ++i) rows.emplace_back(times[i], values[i]);
    *input = {std::move(rows)};
    return PINDRIVE_OK;
  });
}

pindrive_error pindrive_release_set_function(pindrive_release* release, const char* name,
                                             const pindrive_piece* pieces, size_t count) {
  return take_function(release, name, pieces, count,
                       [](pd::InputNumbers& input, pd::Pieces made) -> pindrive_error {
                         input = {{}, std::move(made)};
                         return PINDRIVE_OK;
                       });
}

pindrive_error pindrive_release_add_function(pindrive_release* release, const char* name,
                                             const pindrive_piece* pieces, size_t count) {
  return take_function(release, name, pieces, count,
                       [&](pd::InputNumbers& input, pd::Pieces made) -> pindrive_error {
                         const pd::Pieces before = pd::as_function(input);
                         for (const pd::Pieces* each : {&before, &std::as_const(made)})
                           if (const pindrive_error error = check_pieces(name, *each)) return error;
                         input = {{}, pd::sum_of(before, made)};
                         return PINDRIVE_OK;
                       });
}

pindrive_error pindrive_function(const char* kind, const double* numbers, size_t count,
                                 pindrive_piece* pieces, pindrive_term* terms, size_t* found) {
  if (!kind) return null_pointer("kind");
  if (!numbers) return null_pointer("numbers");
  if (!pieces) return null_pointer("pieces");
  if (!terms) return null_pointer("terms");
  if (!found) return null_pointer("found");
  const pd::FunctionKind* const known = pd::function_kind(kind);
  if (!known) return bad_name("a function", kind, "harmonic, minimum_jerk, exponential");
  if (count != known->count())
    return fail(PINDRIVE_BAD_VALUE, "%s must have %zu numbers, not %zu", kind, known->count(),
                count);
  std::array<double, 4> given{};
  std::copy_n(numbers, count, given.begin());
  const pd::NamedFunction<double> made = pd::named_function(*known, given);
  write_pieces(made, [](double number) { return number; }, pieces, terms);
  *found = made.count;
  return guarded([&]() -> pindrive_error {
    pd::Pieces checked;
    if (const pindrive_error error = read_pieces(pieces, *found, checked)) return error;
    return check_pieces(kind, checked);
  });
}

pindrive_drive* pindrive_drive_rate_new(const pindrive_drive* drive) {
  pindrive_drive* rate = nullptr;
  if (drive)
    guarded([&]() -> pindrive_error {
      rate = new pindrive_drive{0,
                                0,
                                0,
                                pd::ContactNumbers{0, 0, 0, {}, pd::LawNumbers::no_change()},
                                pd::ContactNumbers{0, 0, 0, {}, pd::LawNumbers::no_change()},
                                pd::StopNumbers{0, 0, 0}};
      rate->plate.load_exponent = rate->finger.load_exponent = 0;
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
      rate = new pindrive_release{pd::without_change(release->mouse_velocity),
                                  pd::without_change(release->plate_load),
                                  pd::without_change(release->force),
                                  pd::without_change(release->across_velocity),
                                  pd::without_change(release->finger_load),
                                  0,
                                  0,
                                  0,
                                  0};
      return PINDRIVE_OK;
    });
  return rate;
}

const char* pindrive_status_text(pindrive_status status) {
  switch (status) {
    case PINDRIVE_STATUS_OK:
      return "followed to the end";
    case PINDRIVE_STATUS_TOO_MANY_EVENTS:
      return "stopped at a million segments before its ending or the end of its duration; give a "
             "shorter duration";
    case PINDRIVE_STATUS_TOO_MANY_PERIODS:
      return "stopped after 50 000 periods in which the motion neither ended nor repeated, nor "
             "steadily grew or decayed; give a duration";
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

}  // extern "C"
