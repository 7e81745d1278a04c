// Directional derivatives of the outputs of a unit at the current time and in the current mode. As FMI requires,
// they do not include later changes of the inputs.
#include <cmath>
#include <vector>

#include "instance.hpp"
#include "interface.hpp"
#include "parameters.hpp"
#include "pindrive/motion/instant.hpp"
#include "pindrive/numbers/dual.hpp"
#include "stepper.hpp"

namespace pindrive_fmu {

namespace {

using pindrive_c::fail;
namespace pd = pindrive;

double slope_of(const pd::Instant<Number>& now, int which) {
  switch (which) {
    case PINDRIVE_POSITION:
      return now.position().slope;
    case PINDRIVE_VELOCITY:
      return now.velocity().slope;
    case PINDRIVE_ACCELERATION:
      return now.acceleration().slope;
    case PINDRIVE_PLATE_FORCE:
      return now.friction().plate.slope;
    case PINDRIVE_FINGER_FORCE:
      return now.friction().finger.slope;
    case PINDRIVE_SKIN_STRETCH:
      return now.stretch().slope;
    case PINDRIVE_SKIN_STRETCH_RATE:
      return now.stretch_rate().slope;
    default:
      return now.housing_force().slope;
  }
}

/// A drive that changes along a direction.
struct Changing {
  pd::OwnedContact<Number> plate, finger;
  pd::Drive<Number> drive;

  Changing(const pd::Numbers& at, const pd::Numbers& along)
      : plate(at.plate, along.plate),
        finger(at.finger, along.finger),
        drive{pd::number<Number>(at.mass, along.mass),
              pd::number<Number>(at.stiffness, along.stiffness),
              pd::number<Number>(at.damping, along.damping),
              plate.contact,
              finger.contact,
              pd::stops<Number>(at.stops, along.stops)} {}
};

}  // namespace

pindrive_error Instance::derivative(std::size_t unknown, const unsigned* knowns,
                                    const double* seeds, std::size_t count, double& value) {
  const int which = place(unknown, Variable::output);
  if (which < 0 || which == next_event_time || which >= plate_state)
    return fail(PINDRIVE_BAD_VALUE,
                "a derivative is had of outputs that are real, but not of the next event");
  std::vector<double> along(variables_.size(), 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const Variable* const known = variable(knowns[i]);
    if (!known) return PINDRIVE_BAD_VALUE;
    if (known->kind == Variable::output || known->kind == Variable::command ||
        known->kind == Variable::luminance ||
        (known->kind == Variable::parameter && values_.initialised))
      return fail(PINDRIVE_BAD_VALUE,
                  "a derivative is had along inputs and, before the initialisation ends, "
                  "parameters: %s is none",
                  known->name);
    along[knowns[i] - 1] = seeds[i];
  }
  if (which >
      next_event_time) {  // load of the magnet: no input changes it; initially the residual pull alone
    value = which == magnet_pull ? Given(variables_, values_.start.data(), along.data())
                                       .parameters()
                                       .of("magnet.residual")
                                       .slope
                                 : 0;
    return PINDRIVE_OK;
  }
  const Given given(variables_, values_.start.data(), along.data());
  pindrive_error error = followed();
  if (error) return error;
  const pd::Stepper<double>& stepper = *stepper_->values();
  const pd::InputCurves<double> lines = stepper.lines().from(stepper.tau());
  std::size_t place = 0;
  const auto changing = [&](const pd::Curve<double>& line) {
    const double change = value_of_input(place, along.data());
    const double of_rate = value_of_input(place + 1, along.data());
    place += 2;
    return pd::Line<Number>{{line.value, change}, {line.rate, of_rate}};
  };
  pd::InputCurves<Number> now;  // in the order of `inputs`
  now.plate_velocity = changing(lines.plate_velocity);
  now.plate_load = changing(lines.plate_load);
  now.force = changing(lines.force);
  now.across_velocity = changing(lines.across_velocity);
  now.finger_load = changing(lines.finger_load);
  const pd::Mode mode = stepper.mode();
  const pd::detail::State<double> pin = stepper.pin();

  if (values_.initialised) {
    const Changing same(stepper_->at, pd::without_change(stepper_->at));
    const Number v(pin.v, now.plate_velocity.value.slope);  // beside a housing that jumps
    value = slope_of({same.drive, mode, now, pd::changed(same.drive, mode, now, v, pin)}, which);
    return PINDRIVE_OK;
  }
  const Drive drive(pindrive_drive_new());
  const Release release(pindrive_release_new());
  error = given.fill(drive.get(), release.get(), &Number::value);
  const Drive of_drive(pindrive_drive_rate_new(drive.get()));
  const Release of_release(pindrive_release_rate_new(release.get()));
  if (!error) error = given.fill(of_drive.get(), of_release.get(), &Number::slope);
  if (error) return error;
  if (magnet_.present()) now.plate_load.value.slope = given.parameters().residual_load().slope;
  pd::Numbers at = pindrive_c::numbers_of(*drive, *release);
  pd::Numbers changes = pindrive_c::numbers_of(*of_drive, *of_release);
  pindrive_c::start(at, changes, values_.begin);
  const auto over_time = [&](pd::Curve<Number>& curve, const pd::InputNumbers& input,
                             const pd::InputNumbers& change) {
    const pd::OwnedInput<Number> owned(input, change);
    if (owned.profile().has_breakpoints())
      curve = owned.profile().from(Number(values_.begin)).line();
  };
  over_time(now.plate_velocity, at.mouse_velocity, changes.mouse_velocity);
  over_time(now.plate_load, at.plate_load, changes.plate_load);
  over_time(now.force, at.force, changes.force);
  over_time(now.across_velocity, at.across_velocity, changes.across_velocity);
  over_time(now.finger_load, at.finger_load, changes.finger_load);
  const auto number = [](double at, double slope) { return pd::number<Number>(at, slope); };
  const Changing moving(at, changes);
  const pd::detail::State<Number> state = pd::released(
      moving.drive, mode, now, number(at.displacement, changes.displacement),
      number(at.velocity, changes.velocity), number(at.skin_stretch, changes.skin_stretch), pin);
  value = slope_of({moving.drive, mode, now, state}, which);
  return PINDRIVE_OK;
}

}  // namespace pindrive_fmu
