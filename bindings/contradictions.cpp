#include "contradictions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "pindrive/device/inputs.hpp"
#include "pindrive/device/magnet_construction.hpp"

namespace pindrive_c {

namespace {

namespace device = pindrive::device;

constexpr double gravity = 9.80665;  // m/s^2, as in the Python package
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

bool equal(const char* one, const char* other) { return std::strcmp(one, other) == 0; }

bool ends_with(const char* text, const char* end) {
  const std::size_t length = std::strlen(text), last = std::strlen(end);
  return length >= last && equal(text + length - last, end);
}

/// Name of a key within its table.
const char* name_of(const char* key) { return std::strchr(key, '.') + 1; }

/// Rows (x, y) in one array.
struct RowView {
  const double* numbers{nullptr};
  std::size_t count{0};

  double x(std::size_t i) const { return numbers[2 * i]; }
  double y(std::size_t i) const { return numbers[2 * i + 1]; }
  /// Value at x = 0 of an input over time that has steps.
  double at_begin() const {
    std::size_t after = 0;
    while (after < count && x(after) <= 0) ++after;
    if (after == count) return y(count - 1);
    if (after == 0) return y(0);
    return y(after - 1) +
           (y(after) - y(after - 1)) / (x(after) - x(after - 1)) * (0 - x(after - 1));
  }
  /// Steepest slope between rows, steps left out.
  double steepest() const {
    double worst = 0;
    for (std::size_t i = 1; i < count; ++i) {
      const double dx = x(i) - x(i - 1), dy = y(i) - y(i - 1);
      if (!(dx > 0)) continue;
      const double slope = dx > std::abs(dy) * 1e-300 ? dy / dx : std::copysign(infinity, dy);
      if (std::abs(slope) > std::abs(worst)) worst = slope;
    }
    return worst;
  }
};

/// Kind of the rows of a key: name and unit of the first column, and how its values follow each other.
struct RowKind {
  const char *first, *first_unit, *second, *slope_unit;
  bool steps;
};

RowKind kind_of(const char* key) {
  if (ends_with(key, "coefficient_curve")) return {"speed", "m/s", "coefficient", "s/m", false};
  if (ends_with(key, "curve")) return {"speed", "m/s", "force", "N*s/m", false};
  if (equal(key, "array.places")) return {"x", "m", "y", "", true};
  const bool steps = !equal(key, "motion.mouse_velocity") &&
                     !equal(key, "motion.across_velocity") && !equal(key, "magnet.voltage");
  return {"time", "s", "value", "1/s", steps};
}

/// Friction of a contact as given: forces, or coefficients of a normal force.
struct Friction {
  const char *kinetic_key, *limit_key, *curve_key, *rest_key, *viscous_key, *noun, *unit;
  double kinetic, limit;
  RowView curve;
  double rest;          ///< at rest
  double normal_force;  ///< 1 of forces
};

constexpr const char* friction_keys[2][2][5] = {
    {{"plate.kinetic", "plate.static", "plate.curve", "plate.breakaway", "plate.viscous"},
     {"plate.coefficient", "plate.static_coefficient", "plate.coefficient_curve",
      "plate.breakaway_coefficient", "plate.viscous_coefficient"}},
    {{"finger.kinetic", "finger.static", "finger.curve", "finger.breakaway", "finger.viscous"},
     {"finger.coefficient", "finger.static_coefficient", "finger.coefficient_curve",
      "finger.breakaway_coefficient", "finger.viscous_coefficient"}}};
/// Friction law of a contact, its velocity and its exponent.
constexpr const char* law_keys[2][3] = {
    {"plate.law", "plate.stribeck_velocity", "plate.exponent"},
    {"finger.law", "finger.stribeck_velocity", "finger.exponent"}};
constexpr int at_plate = 0, at_finger = 1;

constexpr const char* magnet_by_times[] = {"magnet.hold_force", "magnet.rise_time",
                                           "magnet.fall_time", "magnet.saturation"};
constexpr const char* coil_needs[] = {"magnet.turns",       "magnet.pole_area",
                                      "magnet.gap",         "magnet.wire_diameter",
                                      "magnet.turn_length", "magnet.supply_voltage"};
constexpr const char* data_sheet_needs[] = {"magnet.resistance", "magnet.inductance",
                                            "magnet.supply_voltage", "magnet.hold_force"};
constexpr const char* in_data_sheet[] = {"magnet.resistance", "magnet.inductance",
                                         "magnet.hold_current"};
constexpr const char* not_in_data_sheet[] = {
    "magnet.turns",       "magnet.pole_area",        "magnet.gap",  "magnet.wire_diameter",
    "magnet.turn_length", "magnet.saturation_field", "magnet.lift", "magnet.closing_force",
    "magnet.rise_time",   "magnet.fall_time"};
constexpr const char* coil_takes[] = {"magnet.release_resistance", "magnet.saturation_field",
                                      "magnet.thermal_resistance", "magnet.heat_capacity",
                                      "magnet.temperature_rise",   "magnet.lift",
                                      "magnet.closing_force"};

/// The search for problems: rule by rule, each in the words of its error.
class Search {
 public:
  Search(const pindrive_given* given, std::size_t count) : given_(given, given + count) {}

  std::vector<Problem> all(bool whole) {
    for (pindrive_given& each : given_) check_alone(each);
    for (const int contact : {at_plate, at_finger}) check_contact(contact);
    check_skin();
    check_stops();
    check_start();
    if (whole) {
      check_magnet();
      check_control();
      check_array();
      check_touch_over_time();
    }
    check_drive();
    return std::move(found_);
  }

 private:
  // ---- values -----------------------------------------------------------------------------------

  const pindrive_given* find(const char* key) const {
    for (const pindrive_given& each : given_)
      if (equal(each.key, key)) return &each;
    return nullptr;
  }
  bool has(const char* key) const { return find(key) != nullptr; }
  /// The number of a key, given or usual; NaN: not known.
  double number(const char* key) const {
    const pindrive_given* const found = find(key);
    if (!found) return device::find_input(key)->absent;
    return found->values && found->rows == 0 ? *found->values : unknown;
  }
  RowView rows(const char* key) const {
    const pindrive_given* const found = find(key);
    return found && found->values ? RowView{found->values, found->rows} : RowView{};
  }
  template <std::size_t N>
  const char* first_of(const char* const (&keys)[N]) const {
    for (const char* const key : keys)
      if (has(key)) return key;
    return nullptr;
  }

  static const char* unit(const char* key) { return unit_of(*device::find_input(key)); }

  // ---- problems ---------------------------------------------------------------------------------

  using Keys = std::array<const char*, 4>;

  /// Adds a problem: "required|given", or "required|given|part of the value", with its numbers and texts.
  /// %v: a number with all its digits; %g: with six; %b: as short as they come; %s: text.
  template <class... Pieces>
  void add(const char* key, const Keys& with, const char* words, Pieces... pieces) {
    add_words(key, with, words, passed(pieces)...);
  }
  /// Adds a known value that is not as required.
  template <class... Pieces>
  void reject(const char* key, const Keys& with, const char* required, Pieces... pieces) {
    if (std::isnan(number(key))) return;
    add_words(key, with, required, passed(pieces)...);
    found_.back().given.add_number(number(key), unit(key));
  }
  static double passed(double value) { return value; }
  static const char* passed(const char* text) { return text; }

  void add_words(const char* key, Keys with, const char* words, ...) {
    std::va_list given;
    va_start(given, words);
    Problem& problem = found_.emplace_back();
    problem.key = key;
    problem.with = with;
    Text* const sections[] = {&problem.required, &problem.given, &problem.part};
    Text* const* text = sections;
    for (const char* at = words; *at != 0; ++at) {
      if (*at == '|') {
        ++text;
      } else if (*at != '%') {
        (*text)->add("%c", *at);
      } else if (*++at == 's') {
        (*text)->add("%s", va_arg(given, const char*));
      } else if (const double value = va_arg(given, double); *at == 'v') {
        (*text)->add_number(value);
      } else if (*at == 'b') {
        (*text)->add_brief(value);
      } else {
        (*text)->add("%g", value);
      }
    }
    va_end(given);
  }

  // ---- a value by itself ------------------------------------------------------------------------

  /// Bounds, order of rows, slopes; a value that is rejected is unknown to the rules that follow.
  void check_alone(pindrive_given& given) {
    const std::size_t before = found_.size();
    const device::InputQuantity* const input = device::find_input(given.key);
    if (!input || !given.values) return;
    if (given.rows == 0)
      check_bounds(given.key, *given.values, input->violated(*given.values), unit_of(*input));
    else
      check_rows(given.key, *input, {given.values, given.rows});
    if (found_.size() > before) given.values = nullptr;
  }

  bool check_bounds(const char* key, double value, const device::Bounds* violated, const char* unit,
                    const char* part = "") {
    if (!violated) return true;
    Text required;
    add_bounds(required, *violated, unit);
    add(key, {}, "%s|%v%s%s|%s", required.get(), value, *unit ? " " : "", unit, part);
    return false;
  }

  void check_rows(const char* key, const device::InputQuantity& input, const RowView& rows) {
    const RowKind kind = kind_of(key);
    const bool curve = equal(kind.first, "speed"), places = equal(kind.first, "x");
    const device::Bounds& firsts = places  ? input.bounds
                                   : curve ? device::ranges::computable[2]
                                           : device::ranges::computable[1];
    for (std::size_t i = 0; i < rows.count; ++i)
      if (!check_bounds(key, rows.x(i), firsts.contains(rows.x(i)) ? nullptr : &firsts,
                        kind.first_unit, part(i, kind.first).get()) ||
          !check_bounds(key, rows.y(i), input.violated(rows.y(i)), unit_of(input),
                        part(i, kind.second).get()))
        return;
    if (places || !check_order(key, kind, rows) || equal(key, "magnet.voltage")) return;
    const double worst = rows.steepest();
    const device::Bounds& slopes = device::ranges::computable[1];
    if (slopes.contains(worst)) return;
    Text required;
    add_bounds(required, slopes, kind.slope_unit);
    add(key, {}, "%s|%g %s| slope", required.get(), worst, kind.slope_unit);
  }

  static Text part(std::size_t row, const char* column) {
    Text text;
    text.add("[%zu] %s", row, column);
    return text;
  }

  bool check_order(const char* key, const RowKind& kind, const RowView& rows) {
    const bool of_motion = std::strncmp(key, "motion.", 7) == 0;
    for (std::size_t i = 1; i < rows.count; ++i) {
      const double before = rows.x(i - 1), here = rows.x(i);
      const bool third = i > 1 && rows.x(i - 2) == here;
      if (kind.steps ? before <= here && !third : before < here) continue;
      const bool later = !kind.steps || third;
      const char* const why = third && kind.steps
                                  ? ": two rows at one time are a step, a third is none"
                              : !kind.steps && of_motion ? " (a jump would take an infinite force)"
                                                         : "";
      add(key, {}, "%s the one before, %v %s%s|%v %s|%s", later ? "greater than" : "at least",
          before, kind.first_unit, why, here, kind.first_unit, part(i, kind.first).get());
      return false;
    }
    return true;
  }

  // ---- friction ---------------------------------------------------------------------------------

  bool by_coefficient(int contact) const { return first_of(friction_keys[contact][1]) != nullptr; }

  /// Normal force of a contact while the magnet is off, by which coefficients are multiplied, N.
  double normal_force(int contact) const {
    const double touch = number("finger.touch_force"), reference = number("finger.reference_touch");
    const double exponent = number("finger.load_exponent");
    if (contact == at_plate)
      return number("drive.mass") * gravity + number("plate.preload") +
             (has("finger.touch_force") ? number("plate.touch_share") * touch : 0);
    return exponent == 1 || touch == 0 ? touch : reference * std::pow(touch / reference, exponent);
  }

  Friction friction(int contact) const {
    const bool coefficients = by_coefficient(contact);
    const auto& [kinetic, limit, curve, rest, viscous] =
        friction_keys[contact][coefficients ? 1 : 0];
    Friction found{kinetic,
                   limit,
                   curve,
                   rest,
                   viscous,
                   coefficients ? "friction coefficient" : "friction",
                   coefficients ? "" : " N",
                   number(kinetic),
                   number(limit),
                   rows(curve),
                   number(rest),
                   coefficients ? normal_force(contact) : 1};
    if (!has(kinetic) && found.curve.count > 0) found.kinetic = found.curve.y(0);
    if (!has(rest)) found.rest = found.kinetic;
    if (!has(limit)) found.limit = found.rest;
    return found;
  }

  void check_contact(int contact) {
    const char* const force = first_of(friction_keys[contact][0]);
    const char* const coefficient = first_of(friction_keys[contact][1]);
    if (force && coefficient)
      return add(coefficient, {force},
                 "left out where %s gives the friction as a force|both, %s and %s", force,
                 coefficient, force);
    const Friction f = friction(contact);
    const double first = f.curve.count > 0 ? f.curve.y(0) : f.kinetic;
    if (f.curve.count > 0 && f.curve.x(0) != 0)
      add(f.curve_key, {f.kinetic_key}, "0 m/s|%v m/s|[0] speed", f.curve.x(0));
    else if (first < f.kinetic || first > f.kinetic)
      add(f.curve_key, {f.kinetic_key}, "the kinetic %s, %v%s|%v%s|[0] %s", f.noun, f.kinetic,
          f.unit, first, f.unit, kind_of(f.curve_key).second);
    check_law(contact, f);
    if (f.limit < f.rest)
      reject(f.limit_key, {f.kinetic_key, f.curve_key, f.rest_key},
             "at least the kinetic %s%s, %v%s", f.noun, f.rest > f.kinetic ? " at rest" : "",
             f.rest, f.unit);
    if (contact == at_plate) return;
    constexpr const char* touch = "finger.touch_force";
    if (coefficient && !has(touch))
      add(touch, {coefficient}, "given where a coefficient gives the finger's friction|none");
    for (const char* const key : {touch, "finger.reference_touch"})
      if (force && has(key))
        reject(key, {force}, "left out where the finger's friction is given as a force");
    constexpr const char *exponent = "finger.load_exponent", *reference = "finger.reference_touch";
    if (coefficient && has(exponent) && number(exponent) != 1 && !has(reference))
      add(reference, {exponent, coefficient},
          "given where the load exponent is not 1, as the touch at which the coefficients "
          "hold|none");
  }

  /// The law of a contact and its parameters.
  void check_law(int contact, const Friction& f) {
    const auto& [law, velocity, exponent] = law_keys[contact];
    const double chosen = has(law) ? number(law) : f.curve.count > 0 ? 3 : 0;
    const bool falls = chosen == 1 || chosen == 2;
    if (chosen != std::floor(chosen)) return reject(law, {}, "0, 1, 2 or 3");
    if (falls && f.curve.count > 0)
      return add(f.curve_key, {law}, "left out under law %s|both", name_of_law(chosen));
    if (has(law) && chosen == 0 && f.curve.count > 1)
      return add(f.curve_key, {law}, "left out under law %s|both", name_of_law(chosen));
    if (chosen == 3 && f.curve.count == 0 && !has(f.curve_key))
      return add(f.curve_key, {law}, "given under law %s|none", name_of_law(chosen));
    for (const char* const key : {f.rest_key, velocity}) {
      if (falls && !has(key)) add(key, {law}, "given under law %s|none", name_of_law(chosen));
      if (!falls && has(key)) reject(key, {law}, "left out under law %s", name_of_law(chosen));
    }
    if (has(exponent) && chosen != 1)
      reject(exponent, {law}, "left out under law %s", name_of_law(chosen));
    else if (number(exponent) > 1 && number(exponent) < 2)
      reject(exponent, {}, "1 or 2");
    if (falls && f.rest < f.kinetic)
      reject(f.rest_key, {f.kinetic_key}, "at least the kinetic %s, %v%s", f.noun, f.kinetic,
             f.unit);
    if (falls && contact == at_finger && has("finger.stiffness"))
      add(law, {"finger.stiffness"}, "coulomb or table on skin that stretches|%s",
          name_of_law(chosen));
  }
  static const char* name_of_law(double law) { return device::law_names[static_cast<int>(law)]; }

  // ---- drive and release ------------------------------------------------------------------------

  void check_skin() {
    constexpr const char *damping = "finger.damping", *stiffness = "finger.stiffness";
    if (number(damping) > 0 && !has(stiffness))
      reject(damping, {stiffness}, "left out for a rigid finger; give finger.stiffness too");
  }

  void check_stops() {
    for (const char* const key : {"drive.stop_stiffness", "drive.stop_damping"})
      if (has(key) && !has("drive.travel"))
        return reject(key, {"drive.travel"}, "left out without travel, as there are no end stops");
    if (number("drive.stop_damping") > 0 && !has("drive.stop_stiffness"))
      reject("drive.stop_damping", {"drive.stop_stiffness", "drive.travel"},
             "left out for rigid end stops; give stop_stiffness too");
  }

  void check_start() {
    constexpr const char *displacement = "motion.displacement", *stretch = "motion.skin_stretch";
    const double travel = number("drive.travel");
    if (!has("drive.stop_stiffness") && std::abs(number(displacement)) > travel)
      reject(displacement, {"drive.travel"}, "at most travel, %v m, either way", travel);
    if (!has(stretch)) return;
    if (!has("finger.stiffness"))
      return reject(stretch, {"finger.stiffness"}, "left out for a rigid finger");
    if (number("finger.damping") > 0) return;  // skin that relaxes need not be held
    const Friction finger = friction(at_finger);
    const RowView load = rows("motion.finger_load");
    const double touch = load.count > 0 ? load.at_begin() : number("motion.finger_load");
    const double factor = std::pow(touch, number("finger.load_exponent"));
    const double largest = finger.limit * finger.normal_force * factor / number("finger.stiffness");
    if (std::abs(number(stretch)) > largest)
      reject(stretch, {"finger.stiffness", finger.limit_key},
             "at most static friction over stiffness, %v m, either way", largest);
  }

  void check_drive() {
    const double mass = number("drive.mass"), stiffness = number("drive.stiffness");
    const double critical = 2 * std::sqrt(mass) * std::sqrt(stiffness);
    const device::Bounds& ratios = device::find_input("drive.damping_ratio")->computable_bounds();
    const double ratio = has("drive.damping") ? number("drive.damping") / critical : 0;
    constexpr double rounding = 1e-12;  // the parts of a ratio are rounded
    if (ratio > ratios.upper * (1 + rounding) ||
        (ratio > 0 && ratio < ratios.lower * (1 - rounding))) {
      Text required;
      add_bounds(required, ratios, "");
      add("drive.damping", {"drive.mass", "drive.stiffness"},
          "such that the damping ratio is %s|%v N*s/m, which makes it %g", required.get(),
          number("drive.damping"), ratio);
    }
    for (const int contact : {at_plate, at_finger}) {
      const Friction f = friction(contact);
      const double falls = (f.rest - f.kinetic) / number(law_keys[contact][1]);
      const double steepest = std::abs(f.curve.steepest()) * f.normal_force;
      if (falls * f.normal_force > ratios.upper * critical)
        add(law_keys[contact][1], {"drive.mass", "drive.stiffness", f.rest_key},
            "such that friction falls at most with %b times critical damping|%g N*s/m",
            ratios.upper, falls * f.normal_force);
      if (number(f.viscous_key) * f.normal_force > ratios.upper * critical)
        add(f.viscous_key, {"drive.mass", "drive.stiffness"},
            "at most %b times critical damping|%g N*s/m", ratios.upper,
            number(f.viscous_key) * f.normal_force);
      if (steepest > ratios.upper * critical)  // acts as damping
        add(f.curve_key, {"drive.mass", "drive.stiffness"},
            "at most %b times critical damping|%g N*s/m| slope", ratios.upper, steepest);
    }
    const double frequency = std::sqrt(stiffness / mass);
    constexpr double most_phase = 1e12;  // beyond, doubles do not tell phases apart
    if (number("motion.duration") * frequency > most_phase)
      reject("motion.duration", {"drive.mass", "drive.stiffness"},
             "at most %b s, %b over the natural frequency", most_phase / frequency, most_phase);
  }

  // ---- electromagnet ----------------------------------------------------------------------------

  void check_pair(const char* one, const char* other) {
    if (has(one) == has(other)) return;
    const char *const given = has(one) ? one : other, *const missing = has(one) ? other : one;
    add(given, {missing}, "given with %s|it alone", name_of(missing));
  }

  void check_magnet() {
    const Friction plate = friction(at_plate);
    if (plate.kinetic * plate.normal_force == 0)
      add("plate.kinetic", {"plate.curve", "plate.coefficient"},
          "greater than 0 N where a magnet holds by friction|0.0 N");
    if (const char* const sheet = first_of(in_data_sheet)) return check_data_sheet(sheet);
    const char* const needed = first_of(coil_needs);
    const char* const made = needed ? needed : first_of(coil_takes);
    const char* const direct = first_of(magnet_by_times);
    if (made && direct)
      return add(direct, {made}, "left out where %s describes the coil|both, %s and %s",
                 name_of(made), name_of(direct), name_of(made));
    if (made && !check_complete(made, coil_needs, coil_takes)) return;
    constexpr const char* voltage = "magnet.voltage";
    if (!made && has(voltage))
      add(voltage, {}, "given with a coil, by turns, gap, wire_diameter and the like|it alone");
    const auto value = [&](const char* key) { return number(key); };
    if (made && !check_coil(device::construction_by_keys(value), made)) return;
    const device::MagnetParameters<double> magnet = device::magnet_by_keys(value);
    check_switching(magnet);
    if (magnet.residual < magnet.hold_force && has("magnet.lift") && has("magnet.closing_force"))
      check_closing(magnet);
    check_pair("magnet.lift", "magnet.closing_force");
    if (made) check_poles();
    if (made) check_voltage(rows(voltage));
  }

  /// A magnet by its data sheet: what gives its winding otherwise is left out.
  void check_data_sheet(const char* sheet) {
    if (const char* const other = first_of(not_in_data_sheet))
      return add(other, {sheet}, "left out where %s is that of a data sheet|both, %s and %s",
                 name_of(sheet), name_of(other), name_of(sheet));
    if (!check_complete(sheet, data_sheet_needs, in_data_sheet)) return;
    if (std::isnan(number("magnet.resistance"))) return;  // refused above
    const auto value = [&](const char* key) { return number(key); };
    const device::MagnetParameters<double> magnet = device::magnet_by_keys(value);
    if (!check_parts(sheet,
                     {{"current", magnet.power / number("magnet.supply_voltage"), 1e-12, 1e12, "A"},
                      {"power", magnet.power, 1e-15, 1e15, "W"},
                      {"time constant", magnet.rise_constant, 1e-12, 1e9, "s"},
                      {"pull", magnet.hold_force, 1e-12, 1e12, "N"}}))
      return;
    check_switching(magnet);
    check_voltage(rows("magnet.voltage"));
  }
  /// What both descriptions of a winding share.
  void check_switching(const device::MagnetParameters<double>& magnet) {
    constexpr const char *voltage = "magnet.voltage", *residual = "magnet.residual";
    if (magnet.residual >= magnet.hold_force)
      reject(residual, {"magnet.hold_force"}, "less than the hold force, %v N", magnet.hold_force);
    check_pair("magnet.pwm_frequency", "magnet.pwm_duty");
    if (has(voltage) && has("magnet.pwm_frequency"))
      add(voltage, {"magnet.pwm_frequency"}, "left out where pwm_frequency gives pulses|both");
  }

  template <class Needs, class Takes>
  bool check_complete(const char* made, const Needs& needs, const Takes& takes) {
    Text missing, alone;
    const auto list = [&](const auto& keys, bool given, Text& names) {
      for (const char* const key : keys) {
        const bool listed = std::strstr(names.get(), name_of(key)) != nullptr;
        if (has(key) == given && !listed) names.add("%s%s", *names.get() ? ", " : "", name_of(key));
      }
    };
    list(needs, false, missing);
    list(needs, true, alone);
    list(takes, true, alone);
    if (!*missing.get()) return true;
    add(made, {}, "given with %s|%s alone", missing.get(), alone.get());
    return false;
  }

  /// Each value is in range, but a quotient of values may be out of its own.
  bool check_coil(const device::CoilConstruction<double>& coil, const char* made) {
    return check_parts(made, {{"resistance", coil.resistance(), 1e-9, 1e15, "ohm"},
                              {"inductance", coil.inductance(), 1e-15, 1e9, "H"},
                              {"current", coil.current(), 1e-12, 1e12, "A"},
                              {"field", coil.field(), 1e-12, 1e12, "T"},
                              {"power", coil.power(), 1e-15, 1e15, "W"}});
  }
  struct Part {
    const char* name;
    double value;
    double lower, upper;
    const char* unit;
  };
  bool check_parts(const char* made, std::initializer_list<Part> parts) {
    for (const Part& part : parts) {
      const device::Bounds bounds = device::ranges::between(part.lower, part.upper);
      if (std::isnan(part.value) || bounds.contains(part.value)) continue;
      Text required;
      add_bounds(required, bounds, part.unit);
      add(made, {}, "such that the %s of the coil is %s|values that make it %v %s", part.name,
          required.get(), part.value, part.unit);
      return false;
    }
    return true;
  }

  /// A gap that never closes, or never opens.
  void check_closing(const device::MagnetParameters<double>& magnet) {
    constexpr const char* key = "magnet.closing_force";
    const double force = number(key);
    const double open = magnet.open_inductance / magnet.saturation;
    const double most =
        magnet.residual + (magnet.hold_force - magnet.residual) * std::min(open * open, 1.0);
    if (force <= magnet.residual)
      reject(key, {"magnet.residual"}, "more than the residual pull, %v N", magnet.residual);
    else if (force >= most || magnet.closing_flux >= magnet.open_inductance)
      reject(key, {"magnet.lift", "magnet.gap"},
             "less than the pull of full current with the open gap, %v N", most);
  }

  void check_poles() {
    const double diameter = number("magnet.outer_diameter");
    const double face = device::CoilConstruction<double>::pi / 4 * diameter * diameter;
    if (2 * number("magnet.pole_area") > face)
      reject("magnet.pole_area", {"magnet.outer_diameter"},
             "at most half of the magnet's face, %g m^2, as it has two poles", 0.5 * face);
  }

  void check_voltage(const RowView& steps) {
    constexpr const char* key = "magnet.voltage";
    const double full = number("magnet.supply_voltage");
    if (steps.count > 0 && steps.x(0) != 0)
      return add(key, {}, "0 s, when the coil is switched on|%v s|[0] time", steps.x(0));
    for (std::size_t i = 0; i < steps.count; ++i)
      if (steps.y(i) < 0 || steps.y(i) > full)
        return add(key, {"magnet.supply_voltage"}, "from 0 V to the supply voltage, %v V|%v V|[%g]",
                   full, steps.y(i), static_cast<double>(i));
  }

  // ---- control block, array, hand ---------------------------------------------------------------

  void check_control() {
    const double threshold = number("control.threshold");
    const double widest = 2 * std::min(threshold, 1 - threshold);
    if (number("control.hysteresis") > widest)
      reject("control.hysteresis", {"control.threshold"}, "at most %g about a threshold of %g",
             widest, threshold);
  }

  void check_array() {
    constexpr const char *places = "array.places", *slot = "array.slot_length";
    constexpr const char* grid[] = {"array.columns", "array.rows", "array.pitch"};
    const char* const by_grid = first_of(grid);
    if (by_grid && has(places))
      add(places, {by_grid}, "left out where columns, rows or pitch are given|it beside %s",
          by_grid);
    check_apart(rows(places));
    const double diameter = number("array.pin_diameter");
    if (number(slot) < diameter)
      reject(slot, {"array.pin_diameter"}, "at least array.pin_diameter, %v m, which moves in it",
             diameter);
    const double columns = number(grid[0]), rows = number(grid[1]);
    for (const char* const key : {grid[0], grid[1]})
      if (std::floor(number(key)) < number(key)) reject(key, {}, "a whole number");
    if (columns * rows > most_pins)
      add(grid[0], {grid[1]}, "such that there are at most %g pins|%g columns of %g rows",
          most_pins, columns, rows);
  }

  void check_apart(const RowView& places) {
    std::vector<std::size_t> order(places.count);
    for (std::size_t i = 0; i < places.count; ++i) order[i] = i;
    const auto at = [&](std::size_t i) { return std::array{places.x(i), places.y(i)}; };
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return at(i) != at(j) ? at(i) < at(j) : i < j; });
    const auto twice = std::adjacent_find(
        order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return at(i) == at(j); });
    if (twice == order.end()) return;
    add("array.places", {}, "places of their own|pins %g and %g both at (%v m, %v m)",
        static_cast<double>(twice[0]), static_cast<double>(twice[1]), places.x(*twice),
        places.y(*twice));
  }

  void check_touch_over_time() {
    constexpr const char *key = "scan.touch", *touch = "finger.touch_force";
    const pindrive_given* const given = find(key);
    if (!given || !given->values) return;
    const bool coefficients = by_coefficient(at_finger);
    check_raised_touch(key, {given->values, given->rows});
    if (coefficients && (!has(touch) || number(touch) > 0 || std::isnan(number(touch)))) return;
    Text shown;
    if (given->rows > 0)
      shown.add("one over time");
    else
      shown.add_number(number(key), "N");
    add(key, {touch, "finger.coefficient", "finger.kinetic"},
        "left out where the finger's friction is %s; it needs finger.coefficient and a "
        "finger.touch_force greater than 0 N|%s",
        coefficients ? "no force" : "given as a force", shown.get());
  }

  /// Skin without damping, or with a friction curve, follows a touch by rows of its friction.
  void check_raised_touch(const char* key, const RowView& touch) {
    constexpr const char *exponent = "finger.load_exponent", *stiffness = "finger.stiffness";
    const auto changes = [&](std::size_t i) { return touch.y(i) != touch.y(0); };
    bool varies = false;
    for (std::size_t i = 0; i < touch.count; ++i) varies = varies || changes(i);
    const Friction finger = friction(at_finger);
    const bool curved = finger.curve.count > 1 || has(finger.viscous_key);
    const bool lags = has(stiffness) && (curved || !(number("finger.damping") > 0));
    if (varies && lags && number(exponent) != 1)
      add(key, {exponent, stiffness, "finger.damping"},
          "one value at a finger.load_exponent of %g, unless the skin has finger.damping and no "
          "curve|one over time",
          number(exponent));
  }

  std::vector<pindrive_given> given_;
  std::vector<Problem> found_;
};

}  // namespace

std::vector<Problem> problems_of(const pindrive_given* given, std::size_t count, bool whole) {
  return Search(given, count).all(whole);
}

}  // namespace pindrive_c
