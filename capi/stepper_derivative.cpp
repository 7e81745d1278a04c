// The C interface: the derivatives of a pin that is followed step by step, along a direction.
#include <cmath>
#include <memory>

#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"
#include "stepper.hpp"

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

using State = pd::Stepper<double>::State;
using StateOfDual = pd::Stepper<Dual>::State;

StateOfDual lifted(const State& s) {
  const auto line = [](const pd::Line<double>& l) { return pd::Line<Dual>{l.value, l.rate}; };
  const auto held = [&](const pd::Held<double>& h) {
    pd::Held<Dual> lifted(h.since, line(h.line));
    lifted.ends = h.ends;
    return lifted;
  };
  const auto option = [](const auto& o) {
    return decltype(StateOfDual::plate){o.state, o.guard, o.branch, o.slip_sign};
  };
  const pd::detail::State<Dual> pin{
      s.pin.x, s.pin.v, s.pin.skin, s.pin.position_scale, s.pin.force_error, s.pin.slider_velocity};
  return {s.now,
          s.since,
          s.since_error,
          pin,
          option(s.plate),
          option(s.finger),
          s.at_plate,
          s.at_finger,
          s.limit,
          s.stop,
          s.stop_released,
          s.stop_met,
          s.struck,
          s.before,
          line(s.plate_velocity),
          held(s.mouse_velocity),
          held(s.plate_load),
          held(s.across_velocity),
          held(s.force),
          held(s.finger_load),
          s.horizon,
          s.event};
}

}  // namespace

extern "C" {

pindrive_error pindrive_stepper_differentiate(const pindrive_drive* drive,
                                              const pindrive_release* release,
                                              const pindrive_drive* drive_rate,
                                              const pindrive_release* release_rate, double begin,
                                              pindrive_stepper** derivative) {
  if (!drive || !drive_rate) return null_pointer("drive and drive_rate");
  if (!release || !release_rate) return null_pointer("release and release_rate");
  if (!derivative) return null_pointer("derivative");
  pindrive_error error = check(*drive, *release);
  if (!error) error = check("begin", begin, std::isfinite(begin), "finite");
  if (!error) error = check_rates(*drive, *release, *drive_rate, *release_rate);
  if (error) return error;
  return made(derivative, [&](pindrive_stepper& s) {
    s.at = numbers_of(*drive, *release);
    s.along = numbers_of(*drive_rate, *release_rate);
    start(s.at, s.along, begin);
    s.pin = std::make_unique<Followed<Dual>>(s.at, s.along, begin);
  });
}

pindrive_error pindrive_stepper_derivative(const pindrive_stepper* stepper,
                                           pindrive_stepper** derivative) {
  if (!stepper) return null_pointer("stepper");
  if (!derivative) return null_pointer("derivative");
  if (!stepper->values())
    return fail(PINDRIVE_DERIVATIVE, "this is asked of a stepper, not of its derivatives");
  return made(derivative, [&](pindrive_stepper& s) {
    s.at = stepper->at;
    s.along = without_change(s.at);
    s.pin = std::make_unique<Followed<Dual>>(s.at, s.along, lifted(stepper->values()->state()));
  });
}

pindrive_error pindrive_stepper_set_along(pindrive_stepper* derivative, const char* input,
                                          double value, double rate) {
  if (!derivative) return null_pointer("derivative");
  if (!input) return null_pointer("input");
  if (!std::isfinite(value) || !std::isfinite(rate))
    return check("a direction", std::isfinite(value) ? rate : value, false, "finite");
  return derivative->pin->set_along(input, value, rate);
}

}  // extern "C"
