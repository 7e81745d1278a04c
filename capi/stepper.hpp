/// Shared parts of the C interface for a pin that is simulated step by step: its handle, which
/// returns values or derivatives.
#pragma once

#include <cstring>
#include <memory>
#include <utility>

#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"
#include "pindrive/events/stepper.hpp"
#include "pindrive/motion/sampling.hpp"

namespace pindrive_c {

inline pindrive_error given_up(pd::Status status) {
  return fail(PINDRIVE_GIVEN_UP, "%s", pindrive_status_text(static_cast<int>(status)));
}

/// Instant of a stepper on a clock on which it began at a time.
template <class T>
pindrive_instant instant_of(const pd::Stepper<T>& stepper, double begin = 0) {
  const auto inputs = stepper.inputs();
  return pindrive_instant{begin + plain(stepper.now()),
                          begin + plain(stepper.next()),
                          plain(inputs.plate_velocity.value),
                          plain(inputs.plate_velocity.rate),
                          plain(inputs.plate_load.value),
                          plain(inputs.plate_load.rate),
                          plain(inputs.across_velocity.value),
                          plain(inputs.across_velocity.rate),
                          plain(inputs.force.value),
                          plain(inputs.force.rate),
                          plain(inputs.finger_load.value),
                          plain(inputs.finger_load.rate),
                          static_cast<pindrive_contact_state>(stepper.mode().plate),
                          static_cast<pindrive_contact_state>(stepper.mode().finger),
                          static_cast<pindrive_transition>(stepper.event().plate),
                          static_cast<pindrive_transition>(stepper.event().finger),
                          static_cast<int>(stepper.mode().stop),
                          static_cast<pindrive_transition>(stepper.event().stop)};
}

/// Stepper of one pin, with or without derivatives. A library that never constructs the second kind links a single
/// instance of the core.
class Following {
 public:
  virtual ~Following() = default;
  virtual std::unique_ptr<Following> copy(const pd::Numbers& at,
                                          const pd::Numbers& along) const = 0;
  virtual pd::Status status() const = 0;
  virtual pindrive_instant now() const = 0;
  virtual double evaluate(pindrive_quantity quantity) const = 0;
  virtual bool step(double until, bool stop_at_event, Attended& attended) = 0;
  virtual pindrive_error set(const char* input, double value, double rate) = 0;
  virtual pindrive_error set_along(const char* input, double value, double rate) = 0;
  virtual const pd::Stepper<double>* values() const { return nullptr; }  ///< null: derivatives
  /// Sets the plate load of a stepper without derivatives to a piece of a function.
  virtual pindrive_error set_load(const pd::InputPiece<double>& load) = 0;
};

/// A stepper with the friction curves and the inputs over time to which it refers.
template <class T>
class Followed final : public Following {
  pd::OwnedContact<T> plate_, finger_;
  pd::OwnedInput<T> mouse_velocity_, plate_load_, force_, across_velocity_, finger_load_;

  static pd::Drive<T> drive(const pd::Numbers& at, const pd::Numbers& along,
                            const Followed& owner) {
    return {pd::number<T>(at.mass, along.mass),
            pd::number<T>(at.stiffness, along.stiffness),
            pd::number<T>(at.damping, along.damping),
            owner.plate_.contact,
            owner.finger_.contact,
            pd::stops<T>(at.stops, along.stops)};
  }

  /// The release; an input that is one number is held from the begin on, and may be set.
  static pd::Inputs<T> release(const pd::Numbers& at, const pd::Numbers& along, double begin,
                               const Followed& owner) {
    const auto input = [begin](const pd::OwnedInput<T>& owned) {
      const pd::Profile<T> profile = owned.profile();
      return profile.has_breakpoints() ? profile
                                       : pd::Profile<T>(T(begin), {profile.first(), T(0)});
    };
    const T exponent = pd::number<T>(at.finger.load_exponent, along.finger.load_exponent);
    return {input(owner.mouse_velocity_),
            pd::number<T>(at.displacement, along.displacement),
            pd::number<T>(at.velocity, along.velocity),
            T(infinity),
            input(owner.plate_load_),
            pd::number<T>(at.skin_stretch, along.skin_stretch),
            input(owner.force_),
            input(owner.across_velocity_),
            input(owner.finger_load_).to_the(exponent)};
  }

  static pd::Stepper<T> begun(const pd::Numbers& at, const pd::Numbers& along,
                              const Followed& owner, double begin) {
    return {drive(at, along, owner), release(at, along, begin, owner), T(begin)};
  }
  static pd::Stepper<T> begun(const pd::Numbers& at, const pd::Numbers& along,
                              const Followed& owner, const pd::StepperState<T>& state) {
    return {drive(at, along, owner), state, release(at, along, 0, owner)};
  }

 public:
  /// Released at a time, s, or from a state.
  template <class Start>
  Followed(const pd::Numbers& at, const pd::Numbers& along, const Start& start)
      : plate_(at.plate, along.plate),
        finger_(at.finger, along.finger),
        mouse_velocity_(at.mouse_velocity, along.mouse_velocity),
        plate_load_(at.plate_load, along.plate_load),
        force_(at.force, along.force),
        across_velocity_(at.across_velocity, along.across_velocity),
        finger_load_(at.finger_load, along.finger_load),
        stepper_(begun(at, along, *this, start)) {}

  std::unique_ptr<Following> copy(const pd::Numbers& at, const pd::Numbers& along) const override {
    return std::make_unique<Followed>(at, along, stepper_.state());
  }
  pd::Status status() const override { return stepper_.status(); }
  pindrive_instant now() const override { return instant_of(stepper_); }
  double evaluate(pindrive_quantity quantity) const override {
    return pd::result(pd::sampled_now(stepper_, static_cast<pd::Sampled>(quantity)));
  }
  bool step(double until, bool stop_at_event, Attended& attended) override {
    return stepper_.step(until, stop_at_event, [&] { return attended.go_on(); });
  }
  pindrive_error set(const char* input, double value, double rate) override {
    return set_input(input, [&](pd::Curve<T>& line) { line = {value, rate}; });
  }
  pindrive_error set_along(const char* input, double value, double rate) override {
    if constexpr (std::is_same_v<T, double>)
      return fail(PINDRIVE_DERIVATIVE, "a direction is set of derivatives, not of a stepper");
    else
      return set_input(input, [&](pd::Curve<T>& line) {
        line.value = {line.value.value, value};
        line.rate = {line.rate.value, rate};
      });
  }
  pindrive_error set_load(const pd::InputPiece<double>& load) override {
    if constexpr (std::is_same_v<T, double>)
      return set_input("plate_load", [&](pd::Curve<double>& given) {
        given = pd::Held<double>(load).from(stepper_.now());
      });
    else
      return fail(PINDRIVE_DERIVATIVE, "a load is set of a stepper, not of derivatives");
  }
  const pd::Stepper<double>* values() const override {
    if constexpr (std::is_same_v<T, double>)
      return &stepper_;
    else
      return nullptr;
  }

 private:
  /// Sets an input, which change(line) changes; all other inputs continue.
  template <class Change>
  pindrive_error set_input(const char* name, Change&& change);

  pd::Stepper<T> stepper_;
};

template <class T>
template <class Change>
pindrive_error Followed<T>::set_input(const char* name, Change&& change) {
  const struct {
    const char* name;
    pd::Curve<T> pd::InputCurves<T>::* line;
    const pd::OwnedInput<T>& given;
  } known[] = {{"mouse_velocity", &pd::InputCurves<T>::plate_velocity, mouse_velocity_},
               {"plate_load", &pd::InputCurves<T>::plate_load, plate_load_},
               {"across_velocity", &pd::InputCurves<T>::across_velocity, across_velocity_},
               {"force", &pd::InputCurves<T>::force, force_},
               {"finger_load", &pd::InputCurves<T>::finger_load, finger_load_}};
  for (const auto& input : known) {
    if (std::strcmp(input.name, name) != 0) continue;
    if (input.given.profile().has_breakpoints())
      return fail(PINDRIVE_UNSUPPORTED,
                  "%s cannot be set: the release gives it over time, by rows or pieces", name);
    pd::InputCurves<T> inputs = stepper_.inputs();
    change(inputs.*input.line);
    stepper_.set(inputs);
    return stepper_.status() == pd::Status::ok ? PINDRIVE_OK : given_up(stepper_.status());
  }
  return fail(
      PINDRIVE_BAD_NAME,
      "a stepper has no input %.40s, but mouse_velocity, plate_load, across_velocity, force, "
      "finger_load",
      name);
}

}  // namespace pindrive_c

struct pindrive_stepper {
  pindrive::Numbers at, along;
  std::unique_ptr<pindrive_c::Following> pin;

  const pindrive::Stepper<double>* values() const { return pin->values(); }
};

namespace pindrive_c {

template <class Make>
pindrive_error made(pindrive_stepper** stepper, Make&& make) {
  return guarded([&]() -> pindrive_error {
    auto handle = std::make_unique<pindrive_stepper>();
    make(*handle);
    const pd::Status status = handle->pin->status();
    if (status != pd::Status::ok) return given_up(status);
    *stepper = handle.release();
    return PINDRIVE_OK;
  });
}

}  // namespace pindrive_c
