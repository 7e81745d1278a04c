/// Shared parts of the C interface: handles, checks, and error messages.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <new>

#include "owned_motion.hpp"
#include "pindrive.h"
#include "pindrive/device/inputs.hpp"

namespace pindrive_c {
namespace pd = pindrive;
using pd::plain;
using Dual = pd::Dual<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double none = std::numeric_limits<double>::quiet_NaN();
}  // namespace pindrive_c

struct pindrive_drive {
  double mass{pindrive_c::none}, stiffness{pindrive_c::none}, damping{0};
  pindrive::ContactNumbers plate{0, 0, pindrive_c::infinity}, finger{0, 0, pindrive_c::infinity};
  pindrive::StopNumbers stops{};
};

struct pindrive_release {
  pindrive::InputNumbers mouse_velocity{{{0, 0}}}, plate_load{{{0, 1}}}, force{{{0, 0}}},
      across_velocity{{{0, 0}}}, finger_load{{{0, 1}}};
  double displacement{0}, velocity{pindrive_c::none}, skin_stretch{pindrive_c::none},
      duration{pindrive_c::infinity}, support{0};
};

namespace pindrive_c {

/// Keeps what the last error of this thread says, as printf does.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
pindrive_error fail(pindrive_error error, const char* format, ...);
pindrive_error null_pointer(const char* what);

/// Result of a function that may run out of memory.
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

/// True if an input or a friction force is finite and small enough that no product overflows.
inline bool in_range(double value, bool may_be_negative) {
  return value <= 1e12 && value >= (may_be_negative ? -1e12 : 0);
}
constexpr const char* range_of(bool may_be_negative) {
  return may_be_negative ? "from -1e12 to 1e12" : "from 0 to 1e12";
}

inline pindrive_error stopped() {
  return fail(PINDRIVE_STOPPED, "the computation was stopped by its caller");
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

/// Sets a number by its name; whether there is one.
bool set(pindrive_drive& drive, const char* name, double value);
bool set(pindrive_release& release, const char* name, double value);
constexpr const char* drive_names =
    "mass, stiffness, damping, travel, stop_stiffness, stop_damping, finger.stiffness, "
    "finger.damping, and, of plate and finger, kinetic, static, law, breakaway, stribeck_velocity, "
    "exponent, viscous";
constexpr const char* input_names =
    "the inputs mouse_velocity, plate_load, force, across_velocity and finger_load";
constexpr const char* release_names =
    "mouse_velocity, plate_load, force, across_velocity, finger_load, displacement, velocity, "
    "skin_stretch, duration, support";

/// Checks a value of an input, which a message calls by a label.
pindrive_error check(const char* label, const pd::device::InputQuantity& input, double value);
/// Checks a value against a limit, which a message tells: "less than the hold force, 1.0 N".
pindrive_error check(const char* label, double value, bool good, const char* words, double limit,
                     const char* unit, const char* rest = "");
pindrive_error check_band(double band);
/// Checks that the core can simulate the drive, and that the direction of a derivative fits.
pindrive_error check(const pindrive_drive& drive, const pindrive_release& release);
/// Value of an input at the begin.
double initial(const pd::InputNumbers& input, double power = 1);
bool needs_linear_touch(const pd::ContactNumbers& finger);
pindrive_error check_raised(const pd::ContactNumbers& finger, bool pieces);
pindrive_error check_duration(const pindrive_release& release);
pindrive_error check(const char* name, double value, bool good, const char* range);
pindrive_error check_rates(const pindrive_drive& drive, const pindrive_release& release,
                           const pindrive_drive& drive_rate, const pindrive_release& release_rate);
pd::Numbers numbers_of(const pindrive_drive& drive, const pindrive_release& release);
/// Velocity of the plate at the release at a time, s, with its derivative.
void start(pd::Numbers& at, pd::Numbers& along, double begin = 0);

}  // namespace pindrive_c
