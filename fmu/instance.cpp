#include "instance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>
#ifdef _WIN32
#include <filesystem>
#endif

namespace pindrive_fmu {

namespace {

constexpr const char* inputs[] = {"mouse_velocity", "mouse_velocity_rate", "plate_load",
                                  "plate_load_rate"};
constexpr const char* outputs[] = {"position",     "velocity",    "acceleration", "plate_force",
                                   "finger_force", "stretch",     "stretch_rate", "next_event_time",
                                   "plate_state",  "finger_state"};
static_assert(sizeof outputs / sizeof *outputs == output_count);

[[noreturn]] void refuse(const std::string& message) { throw Failure(message); }

void need(pindrive_error error) {
  if (error != PINDRIVE_OK) refuse(pindrive_last_error());
}

struct FreeDrive {
  void operator()(pindrive_drive* drive) const { pindrive_drive_free(drive); }
};
struct FreeRelease {
  void operator()(pindrive_release* release) const { pindrive_release_free(release); }
};
using Drive = std::unique_ptr<pindrive_drive, FreeDrive>;
using Release = std::unique_ptr<pindrive_release, FreeRelease>;

std::string content_of(const std::string& path) {
#ifdef _WIN32
  std::FILE* file = _wfopen(std::filesystem::u8path(path).c_str(), L"rb");
#else
  std::FILE* file = std::fopen(path.c_str(), "rb");
#endif
  if (!file) refuse(path + " cannot be read");
  std::string content;
  char part[1024];
  std::size_t got = sizeof part;
  while (got == sizeof part) {
    got = std::fread(part, 1, sizeof part, file);
    content.append(part, got);
  }
  std::fclose(file);
  return content;
}

/// The words of a text, one after the other; empty at its end.
class Words {
 public:
  explicit Words(std::string text) : text_(std::move(text)) {}
  std::string next() {
    constexpr const char* space = " \r\n";
    const std::size_t begin = text_.find_first_not_of(space, at_);
    if (begin == std::string::npos) return {};
    at_ = std::min(text_.find_first_of(space, begin), text_.size());
    return text_.substr(begin, at_ - begin);
  }

 private:
  std::string text_;
  std::size_t at_{0};
};

/// A list of variables as `drive.txt` has it: a head with the token, then a line for each: kind, name and the
/// bits of its start value, which no locale changes.
std::vector<Variable> read_variables(const std::string& folder, const std::string& token) {
  const std::string path = folder + "/drive.txt";
  Words words(content_of(path));
  if (words.next() != "pindrive-fmu-1")
    refuse(path + " must be the list of variables of a unit of this version");
  const std::string own = words.next();
  if (token != own) refuse("the token must be " + own + ", not " + token);
  std::vector<Variable> found;
  for (std::string kind = words.next(); !kind.empty(); kind = words.next()) {
    Variable variable{};
    variable.kind = kind == "parameter" ? Variable::parameter
                    : kind == "input"   ? Variable::input
                                        : Variable::output;
    variable.name = words.next();
    const std::string bits = words.next();
    if (bits.size() != 16) refuse(path + " must have a start value for " + variable.name);
    const std::uint64_t number = std::strtoull(bits.c_str(), nullptr, 16);
    std::memcpy(&variable.start, &number, sizeof number);
    found.push_back(std::move(variable));
  }
  return found;
}

/// The rows of friction curves by the names of their parameters, "plate.curve.speed[1]".
struct Curve {
  const char* contact;
  std::vector<double> speeds, forces;

  bool take(const std::string& name, double value) {
    const std::string begin = std::string(contact) + ".curve.";
    if (name.compare(0, begin.size(), begin) != 0) return false;
    (name[begin.size()] == 's' ? speeds : forces).push_back(value);
    return true;
  }
};

/// Gives a drive and a release the values of parameters and inputs; kinetic friction before static friction,
/// which it sets.
void fill(pindrive_drive* drive, pindrive_release* release, const std::vector<Variable>& variables,
          const double* values) {
  Curve curves[] = {{"plate", {}, {}}, {"finger", {}, {}}};
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (!curves[0].take(variables[i].name, values[i])) curves[1].take(variables[i].name, values[i]);
  for (const Curve& curve : curves)
    if (!curve.speeds.empty())
      need(pindrive_drive_set_curve(drive, curve.contact, curve.speeds.data(), curve.forces.data(),
                                    curve.speeds.size()));
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const std::string& name = variables[i].name;
    if (variables[i].kind == Variable::output || name.find(".curve.") != std::string::npos)
      continue;
    const auto after = [&](const char* begin) { return name.c_str() + std::strlen(begin); };
    if (name.compare(0, 6, "drive.") == 0)
      need(pindrive_drive_set(drive, after("drive."), values[i]));
    else if (name.compare(0, 7, "motion.") == 0)
      need(pindrive_release_set(release, after("motion."), values[i]));
    else if (variables[i].kind == Variable::parameter)
      need(pindrive_drive_set(drive, name.c_str(), values[i]));
    else if (name == inputs[mouse_velocity] || name == inputs[plate_load])
      need(pindrive_release_set(release, name.c_str(), values[i]));
  }
}

}  // namespace

Instance::Instance(const std::string& folder, const std::string& token)
    : variables_(read_variables(folder, token)) {
  reset();
}

void Instance::reset() {
  values_ = {};
  for (const Variable& variable : variables_) values_.start.push_back(variable.start);
  stepper_.reset();
}

void Instance::set_start_time(double time) {
  if (!std::isfinite(time)) refuse("the start time must be finite");
  values_.begin = time;
  stepper_.reset();
}

/// A stepper at its start; with seeds its derivatives along them.
Stepper Instance::made(const std::vector<double>& numbers, const double* seeds) const {
  const Drive drive(pindrive_drive_new());
  const Release release(pindrive_release_new());
  pindrive_stepper* begun = nullptr;
  fill(drive.get(), release.get(), variables_, numbers.data());
  const auto rate_of = [&](const double* values, Input which) {
    for (std::size_t i = 0; i < variables_.size(); ++i)
      if (variables_[i].name == inputs[which]) return values[i];
    return 0.0;
  };
  if (seeds) {
    const Drive along(pindrive_drive_rate_new(drive.get()));
    const Release of_release(pindrive_release_rate_new(release.get()));
    fill(along.get(), of_release.get(), variables_, seeds);
    need(pindrive_stepper_differentiate(drive.get(), release.get(), along.get(), of_release.get(),
                                        values_.begin, &begun));
  } else {
    need(pindrive_stepper_new(drive.get(), release.get(), values_.begin, &begun));
  }
  Stepper found(begun);
  for (const Input which : {mouse_velocity, plate_load}) {
    const auto rate = static_cast<Input>(which + 1);
    const double slope = rate_of(numbers.data(), rate);
    if (slope != 0)
      need(pindrive_stepper_set(begun, inputs[which], rate_of(numbers.data(), which), slope));
    if (seeds && (slope != 0 || rate_of(seeds, rate) != 0))
      need(pindrive_stepper_set_along(begun, inputs[which], rate_of(seeds, which),
                                      rate_of(seeds, rate)));
  }
  return found;
}

/// Before the initialisation has ended it is made where something is asked of it.
pindrive_stepper* Instance::stepper() {
  if (!stepper_) stepper_ = made(values_.start, nullptr);
  return stepper_.get();
}

void Instance::initialise() {
  stepper();
  values_.initialised = true;
}

const Variable& Instance::variable(std::size_t reference) const {
  if (reference < 1 || reference > variables_.size())
    refuse("a value reference must be from 0 to " + std::to_string(variables_.size()) + ", not " +
           std::to_string(reference));
  return variables_[reference - 1];
}

/// Where a variable of a kind stands in the list of its kind; −1 for another kind.
int Instance::place(std::size_t reference, Variable::Kind kind) const {
  const Variable& asked = variable(reference);
  if (asked.kind != kind) return -1;
  const char* const* const list = kind == Variable::input ? inputs : outputs;
  int at = 0;
  while (asked.name != list[at]) ++at;
  return at;
}

pindrive_instant Instance::instant() {
  pindrive_instant now;
  need(pindrive_stepper_now(stepper(), &now));
  return now;
}

double Instance::now() { return values_.initialised ? instant().time : values_.begin; }
double Instance::next_event() { return instant().next_event; }

double Instance::number(std::size_t reference) {
  if (reference == 0) return now();
  switch (variable(reference).kind) {
    case Variable::parameter:
      return values_.start[reference - 1];
    case Variable::input: {
      if (!values_.initialised) return values_.start[reference - 1];
      const pindrive_instant now = instant();
      const double all[] = {now.mouse_velocity, now.mouse_velocity_rate, now.plate_load,
                            now.plate_load_rate};
      return all[place(reference, Variable::input)];
    }
    default:
      break;
  }
  const int which = place(reference, Variable::output);
  if (which == next_event_time) return std::min(next_event(), std::numeric_limits<double>::max());
  if (which > next_event_time) refuse(variable(reference).name + " is a whole number");
  double value = 0;
  need(pindrive_stepper_evaluate(stepper(), which, &value));
  return value;
}

int Instance::whole(std::size_t reference) {
  const int which = reference == 0 ? -1 : place(reference, Variable::output);
  if (which < plate_state)
    refuse((reference == 0 ? "time" : variable(reference).name) + " is no whole number");
  return which == plate_state ? instant().plate : instant().finger;
}

void Instance::set(std::size_t reference, double value) {
  const Variable& given = variable(reference);
  if (given.kind == Variable::output) refuse(given.name + " is an output, which cannot be set");
  if (!values_.initialised) {
    values_.start[reference - 1] = value;
    stepper_.reset();
    return;
  }
  if (given.kind == Variable::parameter)
    refuse(given.name + " is a fixed parameter: it is set before the initialisation ends");
  const pindrive_instant now = instant();
  const bool load = place(reference, Variable::input) >= plate_load;
  const bool rate = place(reference, Variable::input) % 2 == 1;
  const double value_now = load ? now.plate_load : now.mouse_velocity;
  const double rate_now = load ? now.plate_load_rate : now.mouse_velocity_rate;
  need(pindrive_stepper_set(stepper(), inputs[load ? plate_load : mouse_velocity],
                            rate ? value_now : value, rate ? value : rate_now));
}

void Instance::set_rate(std::size_t reference, double rate) {
  const int which = reference == 0 ? -1 : place(reference, Variable::input);
  if (which != mouse_velocity && which != plate_load)
    refuse((reference == 0 ? "time" : variable(reference).name) + " has no rate that can be set");
  for (std::size_t i = 0; i < variables_.size(); ++i)
    if (variables_[i].name == inputs[which + 1]) set(i + 1, rate);
}

bool Instance::step(double from, double size, bool may_end_early) {
  if (!values_.initialised) refuse("a step must follow the initialisation");
  const pindrive_instant before = instant();
  const double tolerance = 1e-9 * (std::abs(from) + std::abs(size));
  if (!(std::abs(from - before.time) <= tolerance))
    refuse("a step must begin where the last one ended, at " + std::to_string(before.time) +
           " s, not at " + std::to_string(from) + " s");
  if (!(size >= 0) || !std::isfinite(size)) refuse("a step must be finite and at least 0 s long");
  need(pindrive_stepper_step(stepper(), std::max(from + size, before.time), may_end_early));
  const pindrive_instant after = instant();
  return after.plate_event != PINDRIVE_NONE || after.finger_event != PINDRIVE_NONE;
}

double Instance::derivative(std::size_t unknown, const unsigned* knowns, const double* seeds,
                            std::size_t count) {
  const int which = unknown == 0 ? -1 : place(unknown, Variable::output);
  if (which < 0 || which >= next_event_time)
    refuse("a derivative is had of outputs that are real, but not of the next event");
  std::vector<double> along(variables_.size(), 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const Variable& known = variable(knowns[i]);
    if (known.kind == Variable::output ||
        (known.kind == Variable::parameter && values_.initialised))
      refuse("a derivative is had along inputs and, before the initialisation ends, parameters: " +
             known.name + " is none");
    along[knowns[i] - 1] = seeds[i];
  }
  Stepper changing;
  if (!values_.initialised) {
    changing = made(values_.start, along.data());
  } else {
    pindrive_stepper* made = nullptr;
    need(pindrive_stepper_derivative(stepper(), &made));
    changing.reset(made);
    double slopes[4] = {};
    for (std::size_t i = 0; i < variables_.size(); ++i)
      if (const int which = place(i + 1, Variable::input); which >= 0) slopes[which] = along[i];
    for (const Input each : {mouse_velocity, plate_load})
      need(pindrive_stepper_set_along(made, inputs[each], slopes[each], slopes[each + 1]));
  }
  double value = 0;
  need(pindrive_stepper_evaluate(changing.get(), which, &value));
  return value;
}

// ---- states ------------------------------------------------------------------------------------

namespace {

Stepper copied(const Stepper& stepper) {
  if (!stepper) return {};
  pindrive_stepper* copy = nullptr;
  need(pindrive_stepper_copy(stepper.get(), &copy));
  return Stepper(copy);
}

}  // namespace

Instance::State* Instance::keep() { return new State{values_, copied(stepper_)}; }

void Instance::go_back(const State& state) {
  Stepper stepper = copied(state.stepper);
  values_ = state.values;
  stepper_ = std::move(stepper);
}

/// The numbers as they stand in memory, whether it is initialised, then the stepper if there is one.
std::vector<unsigned char> Instance::written(const State& state) {
  std::vector<unsigned char> bytes;
  const auto add = [&](const auto& number) {
    const auto* const from = reinterpret_cast<const unsigned char*>(&number);
    bytes.insert(bytes.end(), from, from + sizeof number);
  };
  for (const double number : state.values.start) add(number);
  add(state.values.begin);
  add(static_cast<unsigned char>(state.values.initialised));
  if (!state.stepper) return bytes;
  const std::size_t before = bytes.size(), size = pindrive_stepper_size(state.stepper.get());
  bytes.resize(before + size);
  need(pindrive_stepper_write(state.stepper.get(), &bytes[before], size));
  return bytes;
}

Instance::State* Instance::read(const unsigned char* bytes, std::size_t size) const {
  auto state = std::make_unique<State>();
  const unsigned char* const end = bytes + size;
  const auto take = [&](auto& number) {
    if (static_cast<std::size_t>(end - bytes) < sizeof number)
      refuse("the bytes must be those of a state of this unit, not " + std::to_string(size));
    std::memcpy(&number, bytes, sizeof number);
    bytes += sizeof number;
  };
  state->values.start.resize(variables_.size());
  for (double& number : state->values.start) take(number);
  take(state->values.begin);
  unsigned char initialised = 0;
  take(initialised);
  state->values.initialised = initialised != 0;
  if (bytes < end) {
    pindrive_stepper* stepper = nullptr;
    need(pindrive_stepper_read(bytes, static_cast<std::size_t>(end - bytes), &stepper));
    state->stepper.reset(stepper);
  } else if (state->values.initialised) {
    refuse("the bytes must be those of a state of this unit, not " + std::to_string(size));
  }
  return state.release();
}

}  // namespace pindrive_fmu
