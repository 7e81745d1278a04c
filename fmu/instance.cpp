#include "instance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "bytes.hpp"
#include "interface.hpp"
#include "parameters.hpp"
#include "stepper.hpp"

namespace pindrive_fmu {

namespace {

using pindrive_c::fail;

/// Makes the magnet of the parameters, which are checked, without a current.
pindrive_error make_magnet(const Given& given, double time, Magnet& magnet) {
  magnet = {};
  const pindrive_error error = given.parameters().check(given.parameters().has_magnet());
  if (error) return error;
  magnet.electromagnet = given.parameters().magnet();
  if (!magnet.electromagnet) return PINDRIVE_OK;
  if (given.has_luminance()) {
    magnet.controller =
        std::make_unique<pindrive::device::Controller>(given.parameters().controller());
    magnet.control.sample = magnet.controller->sample_from(time);
  }
  magnet.coil = std::make_unique<pindrive::device::Coil<double>>(*magnet.electromagnet, time);
  const auto pressing = given.parameters().pressing();
  magnet.pressing = {pressing.normal_force.value, pressing.touch.value};
  return PINDRIVE_OK;
}

/// Sets the plate load by the pull of the magnet and the touch from now on.
pindrive_error pulled(pindrive_stepper* stepper, const Magnet& magnet) {
  const pindrive_instant now = stepper->pin->now();
  return stepper->pin->set_load(
      magnet.load({now.time, {now.finger_load, now.finger_load_rate}}).piece);
}

}  // namespace

void Magnet::pass(double until) {
  while (next_sample() <= until) {
    controller->sample(control.sample, control.luminance, control.decision, control.pending);
    control.sample = controller->sample_after(control.sample);
  }
  for (double time = next(); time <= until; time = next()) {
    if (time == control.due()) {
      coil->command(!coil->state().command, time);
      control.pending.erase(control.pending.begin());
    } else {
      coil->pass(time);
    }
  }
}

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

/// A stepper at its start, with its magnet.
pindrive_error Instance::make(Stepper& stepper, Magnet& magnet) const {
  const Drive drive(pindrive_drive_new());
  const Release release(pindrive_release_new());
  const double* const values = values_.start.data();
  const Given given(variables_, values, nullptr);
  pindrive_stepper* made = nullptr;
  pindrive_error error = make_magnet(given, values_.begin, magnet);
  if (!error) error = given.fill(drive.get(), release.get(), &Number::value);
  if (!error && magnet.present())
    error =
        pindrive_release_set(release.get(), "plate_load", given.parameters().residual_load().value);
  if (!error) error = pindrive_stepper_new(drive.get(), release.get(), values_.begin, &made);
  if (error) return error;
  stepper.reset(made);
  std::size_t place = 0;
  for (const Input& input : inputs) {
    const double rate = value_of_input(place + 1, values);
    if (rate != 0 && !error)
      error = pindrive_stepper_set(made, input.name, value_of_input(place, values), rate);
    place += 2;
  }
  for (std::size_t i = 0; i < variables_.size() && !error; ++i) {
    if (variables_[i].kind == Variable::luminance) magnet.control.luminance = values[i];
    if (variables_[i].kind == Variable::command && values[i] != 0) {
      magnet.coil->command(true, values_.begin);
      error = pulled(made, magnet);
    }
  }
  if (error) stepper.reset();
  return error;
}

/// Creates the stepper at its first use before the end of the initialisation.
pindrive_error Instance::followed() { return stepper_ ? PINDRIVE_OK : make(stepper_, magnet_); }

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

/// Index of a variable within its kind; −1 for another kind, and for an unknown variable.
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
  if (error) return error;
  time = now.next_event;
  if (!magnet_.present()) return PINDRIVE_OK;
  if (magnet_.next() > now.time) {
    time = std::min(time, magnet_.next());
  } else {  // a piece of the pull ends now: its next one is not the stepper's yet
    pindrive::device::Coil<double> ahead = *magnet_.coil;
    ahead.pass(now.time);
    time = std::min(time > now.time ? time : ahead.next(), ahead.next());
  }
  time = std::min(time, std::max(magnet_.next_switching(), now.time));
  return PINDRIVE_OK;
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
  if (asked->kind == Variable::luminance) {
    value = values_.initialised ? magnet_.control.luminance : values_.start[reference - 1];
    return PINDRIVE_OK;
  }
  pindrive_instant now;
  pindrive_error error = instant(now);
  if (error) return error;
  if (asked->kind == Variable::input) {
    const Input& input = inputs[asked->place / 2];
    value = now.*(asked->place % 2 == 0 ? input.value : input.rate);
    return PINDRIVE_OK;
  }
  if (asked->kind == Variable::command || asked->place >= plate_state)
    return fail(PINDRIVE_BAD_VALUE, "%s is no real number", asked->name);
  if (asked->place < next_event_time)
    return pindrive_stepper_evaluate(stepper_.get(), asked->place, &value);
  switch (asked->place) {
    case magnet_current:
      value = magnet_.coil->current(now.time);
      return PINDRIVE_OK;
    case magnet_pull:
      value = magnet_.coil->pull(now.time);
      return PINDRIVE_OK;
    case magnet_warming:
      value = magnet_.coil->warming(now.time);
      return PINDRIVE_OK;
    default:
      error = next_event(value);
      value = std::min(value, std::numeric_limits<double>::max());
      return error;
  }
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

pindrive_error Instance::flag(std::size_t reference, bool& value) {
  const Variable* const asked = variable(reference);
  if (!asked) return PINDRIVE_BAD_VALUE;
  if (asked->kind != Variable::command)
    return fail(PINDRIVE_BAD_VALUE, "%s is no Boolean", asked->name);
  value = values_.initialised ? magnet_.coil->state().command : values_.start[reference - 1] != 0;
  return PINDRIVE_OK;
}

/// True if the variable may be set now; before the end of the initialisation all but outputs.
pindrive_error Instance::settable(std::size_t reference, const Variable*& given) const {
  given = variable(reference);
  if (!given) return PINDRIVE_BAD_VALUE;
  if (given->kind == Variable::output)
    return fail(PINDRIVE_BAD_VALUE, "%s is an output, which cannot be set", given->name);
  if (values_.initialised && given->kind == Variable::parameter)
    return fail(PINDRIVE_BAD_VALUE,
                "%s is a fixed parameter: it is set before the initialisation ends", given->name);
  return PINDRIVE_OK;
}

pindrive_error Instance::set(std::size_t reference, double value) {
  const Variable* given = nullptr;
  pindrive_error error = settable(reference, given);
  if (error) return error;
  if (given->kind == Variable::command)
    return fail(PINDRIVE_BAD_VALUE, "%s is a Boolean", given->name);
  if (given->kind == Variable::luminance) {
    error = pindrive_c::check(given->name, value, value >= 0 && value <= 1, "from 0 to 1");
    if (error) return error;
    magnet_.control.luminance = value;
    if (values_.initialised) return PINDRIVE_OK;
  }
  if (!values_.initialised) {
    values_.start[reference - 1] = value;
    stepper_.reset();
    return PINDRIVE_OK;
  }
  pindrive_instant now;
  error = instant(now);
  if (error) return error;
  const Input& input = inputs[given->place / 2];
  const bool rate = given->place % 2 == 1;
  error = pindrive_stepper_set(stepper_.get(), input.name, rate ? now.*input.value : value,
                               rate ? value : now.*input.rate);
  const bool presses = magnet_.present() && magnet_.pressing.touch != 0 &&
                       input.value == &pindrive_instant::finger_load;
  return error || !presses ? error : pulled(stepper_.get(), magnet_);
}

pindrive_error Instance::set_flag(std::size_t reference, bool value) {
  const Variable* given = nullptr;
  pindrive_error error = settable(reference, given);
  if (error) return error;
  if (given->kind != Variable::command)
    return fail(PINDRIVE_BAD_VALUE, "%s is no Boolean", given->name);
  if (!values_.initialised) {
    values_.start[reference - 1] = value ? 1 : 0;
    stepper_.reset();
    return PINDRIVE_OK;
  }
  pindrive_instant now;
  error = instant(now);
  if (error || value == magnet_.coil->state().command) return error;
  magnet_.coil->command(value, now.time);
  magnet_.coil->pass(now.time);
  return pulled(stepper_.get(), magnet_);
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
  const double until = std::max(from + size, at.time);
  do {  // an event due at the end of the step waits for the next step: a command may come first
    double next = until;
    if (magnet_.present()) {
      if (std::min(magnet_.next(), magnet_.next_sample()) <= at.time) {
        magnet_.pass(at.time);
        error = pulled(stepper_.get(), magnet_);
      }
      next = std::min({until, magnet_.next(), magnet_.next_sample()});
    }
    if (!error)
      error = pindrive_stepper_step(stepper_.get(), next, may_end_early, nullptr, nullptr);
    if (!error) error = instant(at);
    happens = !error && (at.plate_event != PINDRIVE_NONE || at.finger_event != PINDRIVE_NONE ||
                         at.stop_event != PINDRIVE_NONE);
  } while (!error && at.time < until && !(may_end_early && happens));
  return error;
}

// ---- states ------------------------------------------------------------------------------------

namespace {

bool possible(const pindrive::device::CoilState<double>& s) {
  const auto part = [](double number) { return number >= 0 && number <= 1; };
  return part(s.flux) && part(s.level) && s.warming >= 0 && std::isfinite(s.since) &&
         std::isfinite(s.warming) && std::isfinite(s.commanded);
}

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
  if (magnet_.present()) kept->coil = magnet_.coil->state();
  kept->control = magnet_.control;
  const pindrive_error error = copy(stepper_, kept->stepper);
  if (!error) state = std::move(kept);
  return error;
}

pindrive_error Instance::go_back(const State& state) {
  Stepper stepper;
  Magnet magnet;
  pindrive_error error = copy(state.stepper, stepper);
  if (!error && stepper)
    error =
        make_magnet({variables_, state.values.start.data(), nullptr}, state.values.begin, magnet);
  if (error) return error;
  if (magnet.present()) {
    if (!possible(state.coil))
      return fail(PINDRIVE_BAD_VALUE, "the bytes must be those of a state of this unit");
    magnet.coil =
        std::make_unique<pindrive::device::Coil<double>>(*magnet.electromagnet, state.coil);
    pindrive_instant now;
    if (stepper) error = pindrive_stepper_now(stepper.get(), &now);
    while (stepper && !error && magnet.coil->next() < now.time)
      magnet.coil->pass(magnet.coil->next());
  }
  if (error) return error;
  magnet.control = state.control;
  values_ = state.values;
  magnet_ = std::move(magnet);
  stepper_ = std::move(stepper);
  return PINDRIVE_OK;
}

namespace {

constexpr std::uint32_t magic = 0x70646676;  // "pdfv"

/// State in the order of its bytes, with the bytes of the stepper.
struct Bytes {
  Values values;
  pindrive::device::CoilState<double> coil;
  ControlState control;
  std::vector<unsigned char> stepper;

  template <class Exchanged>
  void operator()(Exchanged& bytes) {
    const auto item = [&](auto& each) { bytes.item(each); };
    pindrive_c::exchange_list(bytes, values.start, sizeof(double), item);
    item(values.begin);
    item(values.initialised);
    pindrive_c::exchange(bytes, coil);
    item(control.luminance);
    item(control.decision);
    item(control.sample);
    pindrive_c::exchange_list(bytes, control.pending, sizeof(double), item);
    pindrive_c::exchange_list(bytes, stepper, 1, item);
  }
};

}  // namespace

pindrive_error Instance::write(const State& state, std::vector<unsigned char>& bytes) {
  Bytes kept{state.values, state.coil, state.control, {}};
  if (state.stepper) {
    kept.stepper.resize(pindrive_stepper_size(state.stepper.get()));
    const pindrive_error error =
        pindrive_stepper_write(state.stepper.get(), kept.stepper.data(), kept.stepper.size());
    if (error) return error;
  }
  bytes.resize(pindrive_c::framed_size(kept));
  pindrive_c::write_framed(magic, bytes.data(), bytes.size(), kept);
  return PINDRIVE_OK;
}

pindrive_error Instance::read(const unsigned char* bytes, std::size_t size,
                              std::unique_ptr<State>& state) const {
  Bytes kept{};
  const bool whole = pindrive_c::read_framed(magic, bytes, size, kept);
  if (!whole || kept.values.start.size() != variables_.size() ||
      (kept.stepper.empty() && kept.values.initialised))
    return fail(PINDRIVE_BAD_VALUE, "the bytes must be those of a state of this unit, not %zu",
                size);
  auto found = std::make_unique<State>();
  found->values = std::move(kept.values);
  found->coil = kept.coil;
  found->control = std::move(kept.control);
  if (!kept.stepper.empty()) {
    pindrive_stepper* stepper = nullptr;
    if (const pindrive_error error =
            pindrive_stepper_read(kept.stepper.data(), kept.stepper.size(), &stepper))
      return error;
    found->stepper.reset(stepper);
  }
  state = std::move(found);
  return PINDRIVE_OK;
}

}  // namespace pindrive_fmu
