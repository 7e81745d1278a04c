// The C interface: a pin that is followed step by step.
#include "stepper.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "bytes.hpp"
#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

using State = pd::StepperState<double>;

constexpr std::uint32_t magic = 0x70647335;  // "pds5"

/// Goes over the numbers of a drive and the inputs over time.
template <class Bytes>
void exchange_numbers(Bytes& bytes, pd::Numbers& at) {
  const auto number = [&](auto&... each) { (bytes.item(each), ...); };
  const auto row = [&](auto& each) { number(each.first, each.second); };
  number(at.mass, at.stiffness, at.damping, at.stops.travel, at.stops.stiffness, at.stops.damping);
  for (auto* contact : {&at.plate, &at.finger}) {
    auto& law = contact->law;
    number(contact->kinetic, contact->static_limit, contact->stiffness, contact->damping);
    number(law.law, law.breakaway, law.velocity, law.exponent, law.viscous);
    exchange_list(bytes, contact->curve, 2 * sizeof(double), row);
  }
  for (auto* input :
       {&at.mouse_velocity, &at.plate_load, &at.force, &at.across_velocity, &at.finger_load}) {
    exchange_list(bytes, input->rows, 2 * sizeof(double), row);
    exchange_list(bytes, input->pieces, sizeof(double), [&](auto& piece) {
      number(piece.begin);
      for (double& coefficient : piece.polynomial) number(coefficient);
      exchange_list(bytes, piece.terms, 4 * sizeof(double),
                    [&](auto& term) { number(term[0], term[1], term[2], term[3]); });
    });
  }
}

/// A stepper as bytes hold it.
struct Kept {
  pd::Numbers at;
  State state;

  template <class Bytes>
  void operator()(Bytes& bytes) {
    exchange_numbers(bytes, at);
    exchange(bytes, state);
  }
};
Kept kept(const pindrive_stepper& stepper) { return {stepper.at, stepper.values()->state()}; }

}  // namespace

extern "C" {

pindrive_error pindrive_stepper_new(const pindrive_drive* drive, const pindrive_release* release,
                                    double begin, pindrive_stepper** stepper) {
  if (!drive || !release) return null_pointer("drive and release");
  if (!stepper) return null_pointer("stepper");
  pindrive_error error = check(*drive, *release);
  if (!error) error = check("begin", begin, std::isfinite(begin), "finite");
  if (error) return error;
  return made(stepper, [&](pindrive_stepper& s) {
    s.at = s.along = numbers_of(*drive, *release);
    start(s.at, s.along, begin);
    s.pin = std::make_unique<Followed<double>>(s.at, s.along, begin);
  });
}

pindrive_error pindrive_stepper_copy(const pindrive_stepper* stepper, pindrive_stepper** copy) {
  if (!stepper) return null_pointer("stepper");
  if (!copy) return null_pointer("copy");
  return made(copy, [&](pindrive_stepper& s) {
    s.at = stepper->at;
    s.along = stepper->along;
    s.pin = stepper->pin->copy(s.at, s.along);
  });
}

void pindrive_stepper_free(pindrive_stepper* stepper) { delete stepper; }

pindrive_error pindrive_stepper_set(pindrive_stepper* stepper, const char* input, double value,
                                    double rate) {
  if (!stepper) return null_pointer("stepper");
  if (!input) return null_pointer("input");
  const bool load = std::strcmp(input, "plate_load") == 0 || std::strcmp(input, "finger_load") == 0;
  if (!in_range(value, !load)) return check(input, value, false, range_of(!load));
  if (!std::isfinite(rate)) return check("rate", rate, false, "finite");
  const pd::ContactNumbers& finger = stepper->at.finger;
  if (rate != 0 && finger.load_exponent != 1 && std::strcmp(input, "finger_load") == 0)
    if (const pindrive_error error = check_raised(finger, false)) return error;
  return stepper->pin->set(input, value, rate);
}

pindrive_error pindrive_stepper_step(pindrive_stepper* stepper, double until, int stop_at_event,
                                     pindrive_go_on go_on, void* context) {
  if (!stepper) return null_pointer("stepper");
  const double now = stepper->pin->now().time;
  if (!(until >= now) || !std::isfinite(until))
    return fail(PINDRIVE_BAD_VALUE, "until must be finite and at least %.17g s, not %.17g", now,
                until);
  Attended attended(go_on, context);
  if (stepper->pin->step(until, stop_at_event != 0, attended)) return PINDRIVE_OK;
  return attended.stopped() ? stopped() : given_up(stepper->pin->status());
}

pindrive_error pindrive_stepper_now(const pindrive_stepper* stepper, pindrive_instant* instant) {
  if (!stepper) return null_pointer("stepper");
  if (!instant) return null_pointer("instant");
  *instant = stepper->pin->now();
  return PINDRIVE_OK;
}

pindrive_error pindrive_stepper_evaluate(const pindrive_stepper* stepper,
                                         pindrive_quantity quantity, double* value) {
  if (!stepper) return null_pointer("stepper");
  if (!value) return null_pointer("value");
  if (quantity < PINDRIVE_POSITION || quantity > PINDRIVE_STOP_FORCE)
    return fail(PINDRIVE_BAD_VALUE, "a quantity must be from 0 to %d, not %d", PINDRIVE_STOP_FORCE,
                quantity);
  *value = stepper->pin->evaluate(quantity);
  return PINDRIVE_OK;
}

size_t pindrive_stepper_size(const pindrive_stepper* stepper) {
  return stepper && stepper->values() ? framed_size(kept(*stepper)) : 0;
}

pindrive_error pindrive_stepper_write(const pindrive_stepper* stepper, void* bytes, size_t size) {
  if (!stepper) return null_pointer("stepper");
  if (!bytes) return null_pointer("bytes");
  if (!stepper->values())
    return fail(PINDRIVE_DERIVATIVE, "a stepper is written, not its derivatives");
  const std::size_t needed = pindrive_stepper_size(stepper);
  if (size != needed)
    return fail(PINDRIVE_BAD_VALUE, "size must be %zu, as pindrive_stepper_size says, not %zu",
                needed, size);
  write_framed(magic, bytes, size, kept(*stepper));
  return PINDRIVE_OK;
}

pindrive_error pindrive_stepper_read(const void* bytes, size_t size, pindrive_stepper** stepper) {
  if (!bytes) return null_pointer("bytes");
  if (!stepper) return null_pointer("stepper");
  return guarded([&]() -> pindrive_error {
    Kept found{};
    if (!read_framed(magic, bytes, size, found))
      return fail(PINDRIVE_BAD_VALUE,
                  "the bytes must be those of a stepper, whole and of interface %d",
                  PINDRIVE_INTERFACE);
    return made(stepper, [&](pindrive_stepper& s) {
      s.at = s.along = found.at;
      s.pin = std::make_unique<Followed<double>>(s.at, s.along, found.state);
    });
  });
}

}  // extern "C"
