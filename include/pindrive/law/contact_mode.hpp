/// Modes of one contact and the candidates among which an instant decides.
#pragma once

#include <utility>

#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"

namespace pindrive::detail {

/// Mode of one contact.
template <class T>
struct ContactMode {
  ContactState state{ContactState::absent};
  ActiveGuard guard{ActiveGuard::none};
  int branch{0};
  T slip_sign{0};  ///< sign of the sliding velocity: 1, −1 or 0

  static ContactMode slip(T slip_sign, ActiveGuard guard, int branch = 0) {
    return {slip_sign > 0 ? ContactState::slip_forward : ContactState::slip_backward, guard, branch,
            slip_sign};
  }
};

/// Friction and slider of a contact at the start of a mode.
template <class T>
struct ModeStart {
  T friction;          ///< friction for a load factor of 1, N
  T slider_speed;      ///< slider speed in the direction of slip, m/s
  bool keeps_speed;    ///< the slider keeps the speed of the pin
  bool shortens_skin;  ///< the skin shortens at once
};

/// Mode that a contact may have after an instant.
template <class T>
struct Candidate {
  ContactMode<T> mode;
  ModeStart<T> start;
};

/// Candidates in order of preference, at most four.
template <class T>
class Candidates {
 public:
  int size() const { return size_; }
  const Candidate<T>& operator[](int index) const { return candidates_[index]; }
  void clear() { size_ = 0; }
  void add(const ContactMode<T>& mode, const ModeStart<T>& start) {
    candidates_[size_++] = {mode, start};
  }
  void swap(int one, int other) { std::swap(candidates_[one], candidates_[other]); }

 private:
  Candidate<T> candidates_[4];
  int size_{0};
};

/// First and second derivative of a force, N/s and N/s², at constant acceleration.
///
/// `scale` is the magnitude of the terms of the first derivative, from which its error follows.
template <class T>
struct ForceRate {
  T value{0}, scale{0}, second{0};
};

}  // namespace pindrive::detail
