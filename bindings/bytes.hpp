/// States as bytes, framed by a head that tells damaged ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "pindrive.h"
#include "pindrive/device/coil.hpp"
#include "pindrive/events/stepper_state.hpp"

namespace pindrive_c {

/// Counts the bytes of numbers.
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

/// FNV-1a.
inline std::uint64_t checksum(const unsigned char* bytes, std::size_t size) {
  std::uint64_t hash = 14695981039346656037U;
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211U;
  return hash;
}

struct Head {
  std::uint32_t magic, interface;
  std::uint64_t checksum;
};

/// Size of what exchange(bytes) goes over, with its head.
template <class Exchange>
std::size_t framed_size(Exchange&& exchange) {
  Counting counting;
  exchange(counting);
  return sizeof(Head) + counting.size();
}
template <class Exchange>
void write_framed(std::uint32_t magic, void* bytes, std::size_t size, Exchange&& exchange) {
  auto* const to = static_cast<unsigned char*>(bytes);
  Writing writing(to + sizeof(Head));
  exchange(writing);
  const Head head{magic, PINDRIVE_INTERFACE, checksum(to + sizeof(Head), size - sizeof(Head))};
  std::memcpy(to, &head, sizeof head);
}
/// False if the bytes are damaged, or not framed by that head.
template <class Exchange>
bool read_framed(std::uint32_t magic, const void* bytes, std::size_t size, Exchange&& exchange) {
  const auto* const from = static_cast<const unsigned char*>(bytes);
  Head head{};
  if (size < sizeof head) return false;
  std::memcpy(&head, from, sizeof head);
  if (head.magic != magic || head.interface != PINDRIVE_INTERFACE ||
      head.checksum != checksum(from + sizeof head, size - sizeof head))
    return false;
  Reading reading(from + sizeof head, size - sizeof head);
  exchange(reading);
  return reading.whole();
}

/// Goes over a list, whose length comes first.
template <class Bytes, class List, class Item>
void exchange_list(Bytes& bytes, List& list, std::size_t least, Item&& item) {
  auto count = static_cast<std::uint64_t>(list.size());
  bytes.item(count);
  if (!bytes.fits(count * least)) return;
  if constexpr (std::is_same_v<Bytes, Reading>) list.resize(static_cast<std::size_t>(count));
  for (auto& each : list) item(each);
}

template <class Bytes>
void exchange(Bytes& bytes, pindrive::StepperState<double>& s) {
  const auto number = [&](auto&... each) { (bytes.item(each), ...); };
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
  auto& load = s.load_piece;
  number(load.piece.begin, load.piece.count);
  for (double& coefficient : load.piece.polynomial) number(coefficient);
  for (auto& term : load.terms) number(term.cosine, term.sine, term.decay, term.frequency);
  load.piece.terms = load.terms.data();
  if (load.piece.count > load.terms.size()) load.piece.count = 0;
}

template <class Bytes>
void exchange(Bytes& bytes, pindrive::device::CoilState<double>& s) {
  const auto number = [&](auto&... each) { (bytes.item(each), ...); };
  number(s.since, s.flux, s.warming, s.level, s.commanded, s.on, s.command);
}

}  // namespace pindrive_c
