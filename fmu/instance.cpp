#include "instance.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "interface.hpp"

namespace pindrive_fmu {

namespace {

using pindrive_c::fail;

bool begins(const char* text, const char* with) {
  return std::strncmp(text, with, std::strlen(with)) == 0;
}

struct FreeDrive {
  void operator()(pindrive_drive* drive) const { pindrive_drive_free(drive); }
};
struct FreeRelease {
  void operator()(pindrive_release* release) const { pindrive_release_free(release); }
};
using Drive = std::unique_ptr<pindrive_drive, FreeDrive>;
using Release = std::unique_ptr<pindrive_release, FreeRelease>;

/// The rows of friction curves by the names of their parameters, "plate.curve.speed[1]".
struct Curve {
  const char* contact;
  std::vector<double> speeds, forces;

  bool take(const char* name, double value) {
    const std::size_t length = std::strlen(contact);
    if (!begins(name, contact) || !begins(name + length, ".curve.")) return false;
    (begins(name + length, ".curve.s") ? speeds : forces).push_back(value);
    return true;
  }
};

/// Gives a drive and a release the values of parameters and inputs; kinetic friction before static friction,
/// which it sets.
pindrive_error fill(pindrive_drive* drive, pindrive_release* release,
                    const std::vector<Variable>& variables, const double* values) {
  Curve curves[] = {{"plate", {}, {}}, {"finger", {}, {}}};
  pindrive_error error = PINDRIVE_OK;
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (!curves[0].take(variables[i].name, values[i])) curves[1].take(variables[i].name, values[i]);
  for (const Curve& curve : curves)
    if (!curve.speeds.empty() && !error)
      error = pindrive_drive_set_curve(drive, curve.contact, curve.speeds.data(),
                                       curve.forces.data(), curve.speeds.size());
  for (std::size_t i = 0; i < variables.size() && !error; ++i) {
    const auto& [kind, name, start, place] = variables[i];
    if (kind == Variable::input && place % 2 == 0)
      error = pindrive_release_set(release, name, values[i]);
    if (kind != Variable::parameter || std::strstr(name, ".curve.")) continue;
    if (begins(name, "drive."))
      error = pindrive_drive_set(drive, name + std::strlen("drive."), values[i]);
    else if (begins(name, "motion."))
      error = pindrive_release_set(release, name + std::strlen("motion."), values[i]);
    else
      error = pindrive_drive_set(drive, name, values[i]);
  }
  return error;
}

}  // namespace

pindrive_error Instance::begin(const char* folder, const char* token) {
  constexpr const char file[] = "/drive.txt";
  std::vector<char> path(folder, folder + std::strlen(folder));
  path.insert(path.end(), std::begin(file), std::end(file));
  const pindrive_error error = read_variables(path.data(), token, list_, variables_);
  if (!error) reset();
  return error;
}

void Instance::reset() {
  values_ = {};
  for (const Variable& variable : variables_) values_.start.push_back(variable.start);
  stepper_.reset();
}

pindrive_error Instance::set_start_time(double time) {
  if (!std::isfinite(time)) return fail(PINDRIVE_BAD_VALUE, "the start time must be finite");
  values_.begin = time;
  stepper_.reset();
  return PINDRIVE_OK;
}

double Instance::value_of_input(std::size_t place, const double* values) const {
  for (std::size_t i = 0; i < variables_.size(); ++i)
    if (variables_[i].kind == Variable::input && variables_[i].place == static_cast<int>(place))
      return values[i];
  return 0;
}

/// A stepper at its start; with seeds its derivatives along them.
pindrive_error Instance::make(const double* seeds, Stepper& stepper) const {
  const Drive drive(pindrive_drive_new());
  const Release release(pindrive_release_new());
  const double* const values = values_.start.data();
  pindrive_stepper* made = nullptr;
  pindrive_error error = fill(drive.get(), release.get(), variables_, values);
  if (error) return error;
  if (seeds) {
    const Drive along(pindrive_drive_rate_new(drive.get()));
    const Release of_release(pindrive_release_rate_new(release.get()));
    error = fill(along.get(), of_release.get(), variables_, seeds);
    if (!error)
      error = pindrive_stepper_differentiate(drive.get(), release.get(), along.get(),
                                             of_release.get(), values_.begin, &made);
  } else {
    error = pindrive_stepper_new(drive.get(), release.get(), values_.begin, &made);
  }
  stepper.reset(made);
  std::size_t place = 0;
  for (const Input& input : inputs) {
    const double rate = value_of_input(place + 1, values);
    if (rate != 0 && !error)
      error = pindrive_stepper_set(made, input.name, value_of_input(place, values), rate);
    if (seeds && !error && (rate != 0 || value_of_input(place + 1, seeds) != 0))
      error = pindrive_stepper_set_along(made, input.name, value_of_input(place, seeds),
                                         value_of_input(place + 1, seeds));
    place += 2;
  }
  if (error) stepper.reset();
  return error;
}

/// Before the initialisation has ended the stepper is made where something is asked of it.
pindrive_error Instance::followed() { return stepper_ ? PINDRIVE_OK : make(nullptr, stepper_); }

pindrive_error Instance::initialise() {
  const pindrive_error error = followed();
  if (!error) values_.initialised = true;
  return error;
}

/// Null where it is refused.
const Variable* Instance::variable(std::size_t reference) const {
  if (reference >= 1 && reference <= variables_.size()) return &variables_[reference - 1];
  fail(PINDRIVE_BAD_VALUE, "a value reference must be from 0 to %zu, not %zu", variables_.size(),
       reference);
  return nullptr;
}

/// Where a variable of a kind stands in the list of its kind; −1 for another kind, and for none.
int Instance::place(std::size_t reference, Variable::Kind kind) const {
  if (reference < 1 || reference > variables_.size()) return -1;
  const Variable& asked = variables_[reference - 1];
  return asked.kind == kind ? asked.place : -1;
}

const char* Instance::name(std::size_t reference) const {
  return reference >= 1 && reference <= variables_.size() ? variables_[reference - 1].name : "time";
}

pindrive_error Instance::instant(pindrive_instant& now) {
  const pindrive_error error = followed();
  return error ? error : pindrive_stepper_now(stepper_.get(), &now);
}

pindrive_error Instance::now(double& time) {
  time = values_.begin;
  if (!values_.initialised) return PINDRIVE_OK;
  pindrive_instant now;
  const pindrive_error error = instant(now);
  if (!error) time = now.time;
  return error;
}

pindrive_error Instance::next_event(double& time) {
  pindrive_instant now;
  const pindrive_error error = instant(now);
  if (!error) time = now.next_event;
  return error;
}

pindrive_error Instance::number(std::size_t reference, double& value) {
  if (reference == 0) return now(value);
  const Variable* const asked = variable(reference);
  if (!asked) return PINDRIVE_BAD_VALUE;
  if (asked->kind == Variable::parameter ||
      (asked->kind == Variable::input && !values_.initialised)) {
    value = values_.start[reference - 1];
    return PINDRIVE_OK;
  }
  pindrive_instant now;
  const pindrive_error error = instant(now);
  if (error) return error;
  if (asked->kind == Variable::input) {
    const Input& input = inputs[asked->place / 2];
    value = now.*(asked->place % 2 == 0 ? input.value : input.rate);
    return PINDRIVE_OK;
  }
  if (asked->place > next_event_time)
    return fail(PINDRIVE_BAD_VALUE, "%s is a whole number", asked->name);
  if (asked->place < next_event_time)
    return pindrive_stepper_evaluate(stepper_.get(), asked->place, &value);
  value = std::min(now.next_event, std::numeric_limits<double>::max());
  return PINDRIVE_OK;
}

pindrive_error Instance::whole(std::size_t reference, int& value) {
  const int which = place(reference, Variable::output);
  if (which < plate_state)
    return fail(PINDRIVE_BAD_VALUE, "%s is no whole number", name(reference));
  pindrive_instant now;
  const pindrive_error error = instant(now);
  if (!error) value = which == plate_state ? now.plate : now.finger;
  return error;
}

pindrive_error Instance::set(std::size_t reference, double value) {
  const Variable* const given = variable(reference);
  if (!given) return PINDRIVE_BAD_VALUE;
  if (given->kind == Variable::output)
    return fail(PINDRIVE_BAD_VALUE, "%s is an output, which cannot be set", given->name);
  if (!values_.initialised) {
    values_.start[reference - 1] = value;
    stepper_.reset();
    return PINDRIVE_OK;
  }
  if (given->kind == Variable::parameter)
    return fail(PINDRIVE_BAD_VALUE,
                "%s is a fixed parameter: it is set before the initialisation ends", given->name);
  pindrive_instant now;
  const pindrive_error error = instant(now);
  if (error) return error;
  const Input& input = inputs[given->place / 2];
  const bool rate = given->place % 2 == 1;
  return pindrive_stepper_set(stepper_.get(), input.name, rate ? now.*input.value : value,
                              rate ? value : now.*input.rate);
}

pindrive_error Instance::set_rate(std::size_t reference, double rate) {
  const int which = place(reference, Variable::input);
  for (std::size_t i = 0; i < variables_.size() && which >= 0 && which % 2 == 0; ++i)
    if (place(i + 1, Variable::input) == which + 1) return set(i + 1, rate);
  return fail(PINDRIVE_BAD_VALUE, "%s has no rate that can be set", name(reference));
}

pindrive_error Instance::step(double from, double size, bool may_end_early, bool& happens) {
  if (!values_.initialised)
    return fail(PINDRIVE_BAD_VALUE, "a step must follow the initialisation");
  pindrive_instant at;
  pindrive_error error = instant(at);
  if (error) return error;
  const double tolerance = 1e-9 * (std::abs(from) + std::abs(size));
  if (!(std::abs(from - at.time) <= tolerance))
    return fail(PINDRIVE_BAD_VALUE,
                "a step must begin where the last one ended, at %.9g s, not at %.9g s", at.time,
                from);
  if (!(size >= 0) || !std::isfinite(size))
    return fail(PINDRIVE_BAD_VALUE, "a step must be finite and at least 0 s long, not %.9g s",
                size);
  error = pindrive_stepper_step(stepper_.get(), std::max(from + size, at.time), may_end_early);
  if (!error) error = instant(at);
  happens = !error && (at.plate_event != PINDRIVE_NONE || at.finger_event != PINDRIVE_NONE);
  return error;
}

pindrive_error Instance::derivative(std::size_t unknown, const unsigned* knowns,
                                    const double* seeds, std::size_t count, double& value) {
  const int which = place(unknown, Variable::output);
  if (which < 0 || which >= next_event_time)
    return fail(PINDRIVE_BAD_VALUE,
                "a derivative is had of outputs that are real, but not of the next event");
  std::vector<double> along(variables_.size(), 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const Variable* const known = variable(knowns[i]);
    if (!known) return PINDRIVE_BAD_VALUE;
    if (known->kind == Variable::output ||
        (known->kind == Variable::parameter && values_.initialised))
      return fail(PINDRIVE_BAD_VALUE,
                  "a derivative is had along inputs and, before the initialisation ends, "
                  "parameters: %s is none",
                  known->name);
    along[knowns[i] - 1] = seeds[i];
  }
  Stepper changing;
  pindrive_error error = PINDRIVE_OK;
  if (!values_.initialised) {
    error = make(along.data(), changing);
  } else {
    pindrive_stepper* made = nullptr;
    error = followed();
    if (!error) error = pindrive_stepper_derivative(stepper_.get(), &made);
    changing.reset(made);
    std::size_t place = 0;
    for (const Input& input : inputs) {
      const double value_seed = value_of_input(place, along.data());
      const double rate_seed = value_of_input(place + 1, along.data());
      if (!error && (value_seed != 0 || rate_seed != 0))
        error = pindrive_stepper_set_along(made, input.name, value_seed, rate_seed);
      place += 2;
    }
  }
  return error ? error : pindrive_stepper_evaluate(changing.get(), which, &value);
}

// ---- states ------------------------------------------------------------------------------------

namespace {

pindrive_error copy(const Stepper& stepper, Stepper& copied) {
  copied.reset();
  if (!stepper) return PINDRIVE_OK;
  pindrive_stepper* made = nullptr;
  const pindrive_error error = pindrive_stepper_copy(stepper.get(), &made);
  copied.reset(made);
  return error;
}

}  // namespace

pindrive_error Instance::keep(std::unique_ptr<State>& state) const {
  auto kept = std::make_unique<State>();
  kept->values = values_;
  const pindrive_error error = copy(stepper_, kept->stepper);
  if (!error) state = std::move(kept);
  return error;
}

pindrive_error Instance::go_back(const State& state) {
  Stepper stepper;
  const pindrive_error error = copy(state.stepper, stepper);
  if (error) return error;
  values_ = state.values;
  stepper_ = std::move(stepper);
  return PINDRIVE_OK;
}

/// The numbers as they stand in memory, whether it is initialised, then the stepper if there is one.
pindrive_error Instance::write(const State& state, std::vector<unsigned char>& bytes) {
  bytes.clear();
  const auto add = [&](const auto& number) {
    const auto* const from = reinterpret_cast<const unsigned char*>(&number);
    bytes.insert(bytes.end(), from, from + sizeof number);
  };
  for (const double number : state.values.start) add(number);
  add(state.values.begin);
  add(static_cast<unsigned char>(state.values.initialised));
  if (!state.stepper) return PINDRIVE_OK;
  const std::size_t before = bytes.size(), size = pindrive_stepper_size(state.stepper.get());
  bytes.resize(before + size);
  return pindrive_stepper_write(state.stepper.get(), &bytes[before], size);
}

pindrive_error Instance::read(const unsigned char* bytes, std::size_t size,
                              std::unique_ptr<State>& state) const {
  const std::size_t numbers = variables_.size() * sizeof(double) + sizeof(double) + 1;
  const auto refused = [&] {
    return fail(PINDRIVE_BAD_VALUE, "the bytes must be those of a state of this unit, not %zu",
                size);
  };
  if (size < numbers) return refused();
  auto found = std::make_unique<State>();
  Values& values = found->values;
  values.start.resize(variables_.size());
  std::memcpy(values.start.data(), bytes, variables_.size() * sizeof(double));
  std::memcpy(&values.begin, bytes + variables_.size() * sizeof(double), sizeof(double));
  values.initialised = bytes[numbers - 1] != 0;
  if (size > numbers) {
    pindrive_stepper* stepper = nullptr;
    if (const pindrive_error error =
            pindrive_stepper_read(bytes + numbers, size - numbers, &stepper))
      return error;
    found->stepper.reset(stepper);
  } else if (values.initialised) {
    return refused();
  }
  state = std::move(found);
  return PINDRIVE_OK;
}

}  // namespace pindrive_fmu
