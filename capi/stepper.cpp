// The C interface: a pin that is followed step by step.
#include "pindrive/stepper.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "interface.hpp"
#include "owned_motion.hpp"
#include "pindrive.h"

using namespace pindrive_c;  // NOLINT(google-build-using-namespace): its own

namespace {

/// A stepper with the friction curves that it refers to.
template <class T>
class Followed {
  pd::OwnedContact<T> plate_, finger_;

  static pd::Drive<T> drive(const pd::Numbers& at, const pd::Numbers& along,
                            const Followed& owner) {
    return {pd::number<T>(at.mass, along.mass),
            pd::number<T>(at.stiffness, along.stiffness),
            pd::number<T>(at.damping, along.damping),
            owner.plate_.contact,
            owner.finger_.contact,
            pd::stops<T>(at.stops, along.stops)};
  }

 public:
  template <class Start>
  Followed(const pd::Numbers& at, const pd::Numbers& along, const Start& start)
      : plate_(at.plate, along.plate),
        finger_(at.finger, along.finger),
        stepper(drive(at, along, *this), start) {}
  Followed(const pd::Numbers& at, const pd::Numbers& along, const pd::Inputs<T>& inputs,
           double begin)
      : plate_(at.plate, along.plate),
        finger_(at.finger, along.finger),
        stepper(drive(at, along, *this), inputs, T(begin)) {}

  pd::Stepper<T> stepper;
};

using State = pd::Stepper<double>::State;
using StateOfDual = pd::Stepper<Dual>::State;

/// A direction in which the drive does not change.
pd::Numbers without_change(const pd::Numbers& at) {
  pd::Numbers along{};
  along.plate.curve.resize(at.plate.curve.size());
  along.finger.curve.resize(at.finger.curve.size());
  return along;
}

StateOfDual lifted(const State& s) {
  const auto line = [](const pd::Line<double>& l) { return pd::Line<Dual>{l.value, l.rate}; };
  const auto held = [&](const pd::Held<double>& h) {
    pd::Held<Dual> lifted(h.since, line(h.line));
    lifted.ends = h.ends;
    return lifted;
  };
  const auto option = [](const auto& o) {
    return decltype(StateOfDual::plate){o.state, o.at, o.branch, o.sense};
  };
  const pd::detail::State<Dual> pin{s.pin.x,      s.pin.v,        s.pin.skin,
                                    s.pin.x_size, s.pin.roundoff, s.pin.slide};
  return {s.now,
          s.since,
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
          s.event};
}

}  // namespace

struct pindrive_stepper {
  pd::Numbers at, along;
  std::unique_ptr<Followed<double>> values;
  std::unique_ptr<Followed<Dual>> derivatives;

  template <class Function>
  auto ask(Function&& function) const {
    return values ? function(values->stepper) : function(derivatives->stepper);
  }
};

namespace {

template <class T>
std::unique_ptr<Followed<T>> followed(const pd::Numbers& at, const pd::Numbers& along,
                                      double begin) {
  const auto held = [&](const pd::Rows& rows, const pd::Rows& rates) {
    return pd::Held<T>{T(begin), {pd::number<T>(rows[0].second, rates[0].second), T(0)}};
  };
  const pd::Inputs<T> inputs{held(at.mouse_velocity, along.mouse_velocity),
                             pd::number<T>(at.displacement, along.displacement),
                             pd::number<T>(at.velocity, along.velocity),
                             T(infinity),
                             held(at.plate_load, along.plate_load),
                             pd::number<T>(at.skin_stretch, along.skin_stretch),
                             held(at.force, along.force),
                             held(at.across_velocity, along.across_velocity),
                             held(at.finger_load, along.finger_load)};
  return std::make_unique<Followed<T>>(at, along, inputs, begin);
}

pindrive_error check_start(const pindrive_release& release, double begin) {
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

pindrive_error given_up(pd::Status status) {
  return fail(PINDRIVE_GIVEN_UP, "%s", pindrive_status_text(static_cast<int>(status)));
}

template <class Make>
pindrive_error made(pindrive_stepper** stepper, Make&& make) {
  return guarded([&]() -> pindrive_error {
    auto handle = std::make_unique<pindrive_stepper>();
    make(*handle);
    const pd::Status status = handle->ask([](const auto& of) { return of.status(); });
    if (status != pd::Status::ok) return given_up(status);
    *stepper = handle.release();
    return PINDRIVE_OK;
  });
}

/// The input of that name, or null.
template <class T>
pd::Line<T>* find(pd::InputLines<T>& inputs, const char* name) {
  const std::pair<const char*, pd::Line<T>*> lines[] = {
      {"mouse_velocity", &inputs.plate_velocity},
      {"plate_load", &inputs.plate_load},
      {"across_velocity", &inputs.across_velocity},
      {"force", &inputs.force},
      {"finger_load", &inputs.finger_load}};
  for (const auto& [known, line] : lines)
    if (std::strcmp(known, name) == 0) return line;
  return nullptr;
}

/// Sets one of the inputs, which change(line) changes; the others go on.
template <class T, class Change>
pindrive_error set_input(pd::Stepper<T>& stepper, const char* name, Change&& change) {
  pd::InputLines<T> inputs = stepper.inputs();
  pd::Line<T>* const line = find(inputs, name);
  if (!line)
    return fail(
        PINDRIVE_BAD_NAME,
        "a stepper has no input %.40s, but mouse_velocity, plate_load, across_velocity, force, "
        "finger_load",
        name);
  const pd::Line<T> before = *line;
  change(*line);
  const auto& finger = stepper.drive().finger;
  const bool same = plain(line->value) == plain(before.value) && plain(line->rate) == 0;
  if (line == &inputs.finger_load && !same && !finger.rigid())
    return fail(PINDRIVE_UNSUPPORTED, "finger_load must stay %.17g for a finger that is compliant",
                plain(before.value));
  stepper.set(inputs);
  return stepper.status() == pd::Status::ok ? PINDRIVE_OK : given_up(stepper.status());
}

// ---- bytes -------------------------------------------------------------------------------------

constexpr std::uint32_t magic = 0x70647332;  // "pds2"

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
  const auto option = [&](auto& o) { number(o.state, o.at, o.branch, o.sense); };
  const auto line = [&](auto& l) { number(l.value, l.rate); };
  const auto held = [&](auto& h) {
    number(h.since, h.ends);
    line(h.line);
  };
  number(s.now, s.since, s.pin.x, s.pin.v, s.pin.skin, s.pin.x_size, s.pin.roundoff, s.pin.slide);
  option(s.plate);
  option(s.finger);
  number(s.at_plate, s.at_finger, s.limit, s.stop, s.stop_released, s.stop_met, s.struck);
  number(s.before.plate, s.before.finger, s.before.plate_branch, s.before.finger_branch,
         s.before.stop);
  line(s.plate_velocity);
  for (auto* input :
       {&s.mouse_velocity, &s.plate_load, &s.across_velocity, &s.force, &s.finger_load})
    held(*input);
  number(s.event.plate, s.event.finger, s.event.stop);
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
  /// Whether so many more are there.
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
    s.values = followed<double>(s.at, s.along, begin);
  });
}

pindrive_error pindrive_stepper_differentiate(const pindrive_drive* drive,
                                              const pindrive_release* release,
                                              const pindrive_drive* drive_rate,
                                              const pindrive_release* release_rate, double begin,
                                              pindrive_stepper** derivative) {
  if (!drive || !drive_rate) return null_pointer("drive and drive_rate");
  if (!release || !release_rate) return null_pointer("release and release_rate");
  if (!derivative) return null_pointer("derivative");
  pindrive_error error = check(*drive, *release);
  if (!error) error = check_start(*release, begin);
  if (!error) error = check_rates(*drive, *release, *drive_rate, *release_rate);
  if (error) return error;
  return made(derivative, [&](pindrive_stepper& s) {
    s.at = numbers_of(*drive, *release);
    s.along = numbers_of(*drive_rate, *release_rate);
    start(s.at, s.along);
    s.derivatives = followed<Dual>(s.at, s.along, begin);
  });
}

pindrive_error pindrive_stepper_derivative(const pindrive_stepper* stepper,
                                           pindrive_stepper** derivative) {
  if (!stepper) return null_pointer("stepper");
  if (!derivative) return null_pointer("derivative");
  if (!stepper->values)
    return fail(PINDRIVE_DERIVATIVE, "this is asked of a stepper, not of its derivatives");
  return made(derivative, [&](pindrive_stepper& s) {
    s.at = stepper->at;
    s.along = without_change(s.at);
    s.derivatives =
        std::make_unique<Followed<Dual>>(s.at, s.along, lifted(stepper->values->stepper.state()));
  });
}

pindrive_error pindrive_stepper_copy(const pindrive_stepper* stepper, pindrive_stepper** copy) {
  if (!stepper) return null_pointer("stepper");
  if (!copy) return null_pointer("copy");
  return made(copy, [&](pindrive_stepper& s) {
    s.at = stepper->at;
    s.along = stepper->along;
    if (stepper->values)
      s.values =
          std::make_unique<Followed<double>>(s.at, s.along, stepper->values->stepper.state());
    else
      s.derivatives =
          std::make_unique<Followed<Dual>>(s.at, s.along, stepper->derivatives->stepper.state());
  });
}

void pindrive_stepper_free(pindrive_stepper* stepper) { delete stepper; }

pindrive_error pindrive_stepper_set(pindrive_stepper* stepper, const char* input, double value,
                                    double rate) {
  if (!stepper) return null_pointer("stepper");
  if (!input) return null_pointer("input");
  const bool load = std::strcmp(input, "plate_load") == 0 || std::strcmp(input, "finger_load") == 0;
  if (!std::isfinite(value) || (load && value < 0))
    return check(input, value, false, load ? "at least 0 and finite" : "finite");
  if (!std::isfinite(rate)) return check("rate", rate, false, "finite");
  const auto set = [&](auto& of) {
    return set_input(of, input, [&](auto& line) { line = {value, rate}; });
  };
  return stepper->values ? set(stepper->values->stepper) : set(stepper->derivatives->stepper);
}

pindrive_error pindrive_stepper_set_along(pindrive_stepper* derivative, const char* input,
                                          double value, double rate) {
  if (!derivative) return null_pointer("derivative");
  if (!input) return null_pointer("input");
  if (!derivative->derivatives)
    return fail(PINDRIVE_DERIVATIVE, "a direction is set of derivatives, not of a stepper");
  if (!std::isfinite(value) || !std::isfinite(rate))
    return check("a direction", std::isfinite(value) ? rate : value, false, "finite");
  return set_input(derivative->derivatives->stepper, input, [&](pd::Line<Dual>& line) {
    line = {{line.value.value, value}, {line.rate.value, rate}};
  });
}

pindrive_error pindrive_stepper_step(pindrive_stepper* stepper, double until, int stop_at_event) {
  if (!stepper) return null_pointer("stepper");
  const auto step = [&](auto& of) -> pindrive_error {
    const double now = plain(of.now());
    if (!(until >= now) || !std::isfinite(until))
      return fail(PINDRIVE_BAD_VALUE, "until must be finite and at least %.17g s, not %.17g", now,
                  until);
    return of.step(until, stop_at_event != 0) ? PINDRIVE_OK : given_up(of.status());
  };
  return stepper->values ? step(stepper->values->stepper) : step(stepper->derivatives->stepper);
}

pindrive_error pindrive_stepper_now(const pindrive_stepper* stepper, pindrive_instant* instant) {
  if (!stepper) return null_pointer("stepper");
  if (!instant) return null_pointer("instant");
  *instant = stepper->ask([](const auto& of) {
    const auto inputs = of.inputs();
    return pindrive_instant{plain(of.now()),
                            plain(of.next()),
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
                            static_cast<pindrive_contact_state>(of.mode().plate),
                            static_cast<pindrive_contact_state>(of.mode().finger),
                            static_cast<pindrive_transition>(of.event().plate),
                            static_cast<pindrive_transition>(of.event().finger),
                            static_cast<int>(of.mode().stop),
                            static_cast<pindrive_transition>(of.event().stop)};
  });
  return PINDRIVE_OK;
}

pindrive_error pindrive_stepper_evaluate(const pindrive_stepper* stepper,
                                         pindrive_quantity quantity, double* value) {
  if (!stepper) return null_pointer("stepper");
  if (!value) return null_pointer("value");
  if (quantity < PINDRIVE_POSITION || quantity > PINDRIVE_STOP_FORCE)
    return fail(PINDRIVE_BAD_VALUE, "a quantity must be from 0 to %d, not %d", PINDRIVE_STOP_FORCE,
                quantity);
  *value = stepper->ask([&](const auto& of) {
    const auto tau = of.tau();
    const auto lines = of.lines();
    return pd::visit_trajectory(of.drive(), of.segment(), lines, [&](const auto& along) {
      const auto friction = [&] {
        return pd::friction_along(along, of.drive(), of.segment(), [&] { return lines; }, tau);
      };
      if (quantity == PINDRIVE_STOP_FORCE)
        return pd::result(pd::stop_force_along(along, of.drive(), of.segment(), lines.force, tau));
      return value_along(along, tau, of.drive(), friction, quantity);
    });
  });
  return PINDRIVE_OK;
}

size_t pindrive_stepper_size(const pindrive_stepper* stepper) {
  if (!stepper || !stepper->values) return 0;
  Counting counting;
  State state = stepper->values->stepper.state();
  exchange(counting, stepper->at, state);
  return sizeof(Head) + counting.size();
}

pindrive_error pindrive_stepper_write(const pindrive_stepper* stepper, void* bytes, size_t size) {
  if (!stepper) return null_pointer("stepper");
  if (!bytes) return null_pointer("bytes");
  if (!stepper->values)
    return fail(PINDRIVE_DERIVATIVE, "a stepper is written, not its derivatives");
  const std::size_t needed = pindrive_stepper_size(stepper);
  if (size != needed)
    return fail(PINDRIVE_BAD_VALUE, "size must be %zu, as pindrive_stepper_size says, not %zu",
                needed, size);
  auto* const to = static_cast<unsigned char*>(bytes);
  Writing writing(to + sizeof(Head));
  State state = stepper->values->stepper.state();
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
      s.values = std::make_unique<Followed<double>>(s.at, s.along, state);
    });
  });
}

}  // extern "C"
