// The C interface: a pin that is followed step by step.
#include "stepper.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>

#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

pindrive_error pindrive_c::check_start(const pindrive_release& release, double begin) {
  for (const auto& [name, rows] :
       {std::pair<const char*, const pd::Rows*>{"mouse_velocity", &release.mouse_velocity},
        std::pair<const char*, const pd::Rows*>{"plate_load", &release.plate_load},
        std::pair<const char*, const pd::Rows*>{"force", &release.force},
        std::pair<const char*, const pd::Rows*>{"across_velocity", &release.across_velocity},
        std::pair<const char*, const pd::Rows*>{"finger_load", &release.finger_load}})
    if (rows->size() > 1)
      return fail(PINDRIVE_UNSUPPORTED,
                  "%s of a stepper must have one value, not %zu rows; set it on the way", name,
                  rows->size());
  return check("begin", begin, std::isfinite(begin), "finite");
}

namespace {

using State = pd::Stepper<double>::State;

// ---- bytes -------------------------------------------------------------------------------------

constexpr std::uint32_t magic = 0x70647333;  // "pds3"

/// Goes over everything that bytes hold, in one order for writing and reading.
template <class Bytes, class Numbers>
void exchange(Bytes& bytes, Numbers& at, State& s) {
  const auto number = [&](auto&... each) { (bytes.item(each), ...); };
  const auto rows = [&](auto& list) {
    auto count = static_cast<std::uint64_t>(list.size());
    bytes.item(count);
    if (!bytes.fits(count * 2 * sizeof(double))) return;
    if constexpr (!std::is_const_v<Numbers>) list.resize(static_cast<std::size_t>(count));
    for (auto& [first, second] : list) number(first, second);
  };
  number(at.mass, at.stiffness, at.damping, at.stops.travel, at.stops.stiffness, at.stops.damping);
  for (auto* contact : {&at.plate, &at.finger}) {
    number(contact->kinetic, contact->static_limit, contact->stiffness);
    rows(contact->curve);
  }
  const auto option = [&](auto& o) { number(o.state, o.guard, o.branch, o.slip_sign); };
  const auto line = [&](auto& l) { number(l.value, l.rate); };
  const auto held = [&](auto& h) {
    number(h.since, h.ends);
    line(h.line);
  };
  number(s.now, s.since, s.since_error);
  number(s.pin.x, s.pin.v, s.pin.skin, s.pin.position_scale, s.pin.force_error,
         s.pin.slider_velocity);
  option(s.plate);
  option(s.finger);
  number(s.at_plate, s.at_finger, s.limit, s.stop, s.stop_released, s.stop_met, s.struck);
  number(s.before.plate, s.before.finger, s.before.plate_branch, s.before.finger_branch,
         s.before.stop);
  line(s.plate_velocity);
  for (auto* input :
       {&s.mouse_velocity, &s.plate_load, &s.across_velocity, &s.force, &s.finger_load})
    held(*input);
  number(s.horizon, s.event.plate, s.event.finger, s.event.stop);
}

class Counting {
 public:
  template <class N>
  void item(const N&) {
    size_ += sizeof(N);
  }
  static bool fits(std::uint64_t) { return true; }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_{0};
};

class Writing {
 public:
  explicit Writing(unsigned char* to) : to_(to) {}
  template <class N>
  void item(const N& number) {
    static_assert(std::is_arithmetic_v<N> || std::is_enum_v<N>);
    std::memcpy(to_, &number, sizeof number);
    to_ += sizeof number;
  }
  static bool fits(std::uint64_t) { return true; }

 private:
  unsigned char* to_;
};

class Reading {
 public:
  Reading(const unsigned char* from, std::size_t size) : from_(from), left_(size) {}
  template <class N>
  void item(N& number) {
    if (!fits(sizeof number)) return;
    std::memcpy(&number, from_, sizeof number);
    from_ += sizeof number;
    left_ -= sizeof number;
  }
  /// True if that many entries remain.
  bool fits(std::uint64_t size) {
    good_ = good_ && size <= left_;
    return good_;
  }
  bool whole() const { return good_ && left_ == 0; }

 private:
  const unsigned char* from_;
  std::size_t left_;
  bool good_{true};
};

/// FNV-1a: tells bytes that were damaged.
std::uint64_t checksum(const unsigned char* bytes, std::size_t size) {
  std::uint64_t hash = 14695981039346656037U;
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211U;
  return hash;
}

struct Head {
  std::uint32_t magic, interface;
  std::uint64_t checksum;
};

}  // namespace

extern "C" {

pindrive_error pindrive_stepper_new(const pindrive_drive* drive, const pindrive_release* release,
                                    double begin, pindrive_stepper** stepper) {
  if (!drive || !release) return null_pointer("drive and release");
  if (!stepper) return null_pointer("stepper");
  pindrive_error error = check(*drive, *release);
  if (!error) error = check_start(*release, begin);
  if (error) return error;
  return made(stepper, [&](pindrive_stepper& s) {
    s.at = s.along = numbers_of(*drive, *release);
    start(s.at, s.along);
    s.pin = followed<double>(s.at, s.along, begin);
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
  if (!stepper || !stepper->values()) return 0;
  Counting counting;
  State state = stepper->values()->state();
  exchange(counting, stepper->at, state);
  return sizeof(Head) + counting.size();
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
  auto* const to = static_cast<unsigned char*>(bytes);
  Writing writing(to + sizeof(Head));
  State state = stepper->values()->state();
  exchange(writing, stepper->at, state);
  const Head head{magic, PINDRIVE_INTERFACE, checksum(to + sizeof(Head), size - sizeof(Head))};
  std::memcpy(to, &head, sizeof head);
  return PINDRIVE_OK;
}

pindrive_error pindrive_stepper_read(const void* bytes, size_t size, pindrive_stepper** stepper) {
  if (!bytes) return null_pointer("bytes");
  if (!stepper) return null_pointer("stepper");
  const auto* const from = static_cast<const unsigned char*>(bytes);
  Head head{};
  if (size >= sizeof head) std::memcpy(&head, from, sizeof head);
  if (head.magic != magic || head.interface != PINDRIVE_INTERFACE ||
      head.checksum != checksum(from + sizeof head, size - sizeof head))
    return fail(PINDRIVE_BAD_VALUE,
                "the bytes must be those of a stepper, whole and of interface %d",
                PINDRIVE_INTERFACE);
  return guarded([&]() -> pindrive_error {
    pd::Numbers at{};
    State state{};
    Reading reading(from + sizeof head, size - sizeof head);
    exchange(reading, at, state);
    if (!reading.whole())
      return fail(PINDRIVE_BAD_VALUE, "the bytes must be those of a stepper, not %zu", size);
    return made(stepper, [&](pindrive_stepper& s) {
      s.at = s.along = at;
      s.pin = std::make_unique<Followed<double>>(s.at, s.along, state);
    });
  });
}

}  // extern "C"
