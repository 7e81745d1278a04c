/// A motion that owns the arrays to which the core only refers: rows of inputs, branches of friction curves,
/// segments. The interfaces in Python and C use it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "function_sum.hpp"
#include "pindrive/engine.hpp"

namespace pindrive {

/// (speed, force) of a friction curve, or (time, value) of an input: one row for a constant.
using Rows = std::vector<std::pair<double, double>>;

using PieceNumbers = FunctionPiece<double>;
using Pieces = FunctionPieces<double>;

/// Input over time: rows or, if it is a function, pieces.
struct InputNumbers {
  Rows rows{};
  Pieces pieces{};

  bool constant() const { return pieces.empty() && rows.size() == 1; }
  /// Value of a constant.
  double value() const { return rows[0].second; }
  bool is(double constant_value) const { return constant() && value() == constant_value; }
};

/// Friction laws by their numbers in the interfaces.
enum class Law : signed char { coulomb, stribeck, hess_soom, table };

/// Friction law of a contact beside its kinetic friction: its number (`Law`), the friction at rest from
/// which it falls, the velocity and the exponent with which it falls, and a viscous part.
struct LawNumbers {
  double law{0}, breakaway{0}, velocity{1}, exponent{1}, viscous{0};

  /// A direction in which the law does not change.
  static LawNumbers no_change() { return {0, 0, 0, 0, 0}; }
  /// Shape of the part that falls.
  FallingShape shape() const {
    if (law == static_cast<double>(Law::hess_soom)) return FallingShape::rational;
    if (law != static_cast<double>(Law::stribeck)) return FallingShape::none;
    return exponent > 1 ? FallingShape::gaussian : FallingShape::exponential;
  }
};

struct ContactNumbers {
  double kinetic, static_limit, stiffness;
  Rows curve{};
  LawNumbers law{};
  double damping{0};        ///< of the skin
  double load_exponent{1};  ///< of the friction over the load
};

/// The end stops of a drive: infinite travel is none, infinite stiffness rigid.
struct StopNumbers {
  double travel{std::numeric_limits<double>::infinity()},
      stiffness{std::numeric_limits<double>::infinity()}, damping{0};

  bool present() const { return travel < std::numeric_limits<double>::infinity(); }
};

/// A drive and its release in plain numbers, as Drive and Inputs have them.
struct Numbers {
  double mass, stiffness, damping;
  ContactNumbers plate, finger;
  InputNumbers mouse_velocity, plate_load;
  double displacement, velocity, skin_stretch;
  InputNumbers force, across_velocity, finger_load;
  StopNumbers stops;
  double duration;
  double support{0};  ///< 1: the spring stands on the ground, 0: in the accelerating mouse
};

/// A direction in which an input does not change.
inline InputNumbers without_change(const InputNumbers& at) {
  InputNumbers along{Rows(at.rows.size()), Pieces(at.pieces.size())};
  for (std::size_t i = 0; i < at.pieces.size(); ++i)
    along.pieces[i].terms.resize(at.pieces[i].terms.size());
  return along;
}
/// A direction in which the drive does not change.
inline Numbers without_change(const Numbers& at) {
  Numbers along{};
  along.plate.curve.resize(at.plate.curve.size());
  along.finger.curve.resize(at.finger.curve.size());
  along.plate.law = along.finger.law = LawNumbers::no_change();
  along.plate.load_exponent = along.finger.load_exponent = 0;
  for (const auto input : {&Numbers::mouse_velocity, &Numbers::plate_load, &Numbers::force,
                           &Numbers::across_velocity, &Numbers::finger_load})
    along.*input = without_change(at.*input);
  return along;
}

/// Returns a number of the core from its value and its derivative along a direction; an infinite
/// direction, as initially, has no derivative.
template <class T>
T number(double value, double slope) {
  if constexpr (std::is_same_v<T, Dual<double>>)
    return {value, std::isinf(slope) ? 0 : slope};
  else
    return value;
}

template <class T>
Stops<T> stops(const StopNumbers& at, const StopNumbers& along) {
  return {number<T>(at.travel, along.travel), number<T>(at.stiffness, along.stiffness),
          number<T>(at.damping, along.damping)};
}

/// Returns the requested part of a number: its value, or its derivative if it has one.
inline double result(double value) { return value; }
inline double result(Dual<double> value) { return value.slope; }

/// An input; a constant is its row alone, without lists.
template <class T>
struct OwnedRows {
  std::vector<T> first, second;
  T constant{};

  OwnedRows(const Rows& rows, const Rows& along) {
    if (rows.size() == 1) constant = number<T>(rows[0].second, along[0].second);
    if (rows.size() < 2) return;
    first.reserve(rows.size());
    second.reserve(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      first.push_back(number<T>(rows[i].first, along[i].first));
      second.push_back(number<T>(rows[i].second, along[i].second));
    }
  }
  Profile<T> profile() const {
    if (first.empty()) return {constant};
    return {first.data(), second.data(), first.size()};
  }
};

/// The pieces of an input that is a function; none of rows.
template <class T>
FunctionPieces<T> pieces_of(const InputNumbers& at, const InputNumbers& along) {
  FunctionPieces<T> pieces(at.pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PieceNumbers &value = at.pieces[i], &rate = along.pieces[i];
    pieces[i].begin = number<T>(value.begin, rate.begin);
    for (std::size_t n = 0; n < value.polynomial.size(); ++n)
      pieces[i].polynomial[n] = number<T>(value.polynomial[n], rate.polynomial[n]);
    pieces[i].terms.resize(value.terms.size());
    for (std::size_t j = 0; j < value.terms.size(); ++j)
      for (std::size_t n = 0; n < 4; ++n)
        pieces[i].terms[j][n] = number<T>(value.terms[j][n], rate.terms[j][n]);
  }
  return pieces;
}

/// An input with the arrays to which its profile refers.
template <class T>
class OwnedInput {
 public:
  OwnedInput(const InputNumbers& at, const InputNumbers& along)
      : OwnedInput(pieces_of<T>(at, along), at.rows, along.rows) {}
  explicit OwnedInput(const FunctionPieces<T>& pieces, const Rows& rows = {},
                      const Rows& along = {})
      : rows_(rows, along) {
    std::size_t terms = 0;
    for (const FunctionPiece<T>& piece : pieces) terms += piece.terms.size();
    terms_.reserve(terms);  // so that no piece refers to a term that moves
    pieces_.reserve(pieces.size());
    for (const FunctionPiece<T>& piece : pieces) {
      pieces_.push_back(
          {piece.begin, piece.polynomial, terms_.data() + terms_.size(), piece.terms.size()});
      for (const auto& [cosine, sine, decay, frequency] : piece.terms)
        terms_.push_back({cosine, sine, decay, frequency});
    }
  }
  OwnedInput(const OwnedInput&) = delete;
  OwnedInput& operator=(const OwnedInput&) = delete;

  Profile<T> profile() const {
    if (pieces_.empty()) return rows_.profile();
    return {pieces_.data(), pieces_.size()};
  }

 private:
  OwnedRows<T> rows_;
  std::vector<InputTerm<T>> terms_;
  std::vector<InputPiece<T>> pieces_;
};

template <class T>
struct OwnedContact {
  Contact<T> contact;
  std::vector<Branch<T>> branches;

  OwnedContact(const ContactNumbers& at, const ContactNumbers& along)
      : contact{number<T>(at.kinetic, along.kinetic),
                number<T>(at.static_limit, along.static_limit),
                number<T>(at.stiffness, along.stiffness)} {
    contact.damping = number<T>(at.damping, along.damping);
    using detail::vanishes;
    const T viscous = number<T>(at.law.viscous, along.law.viscous);
    if (at.law.shape() != FallingShape::none) {
      const T rest = number<T>(at.law.breakaway, along.law.breakaway);
      FallingFriction<T> falling{at.law.shape(), rest - contact.kinetic,
                                 number<T>(at.law.velocity, along.law.velocity)};
      if (vanishes(falling.excess)) falling = {};
      contact.kinetic = rest;
      branches = {{T(0), unlimited, rest, viscous, T(0), falling}};
      contact.branches = 1;
    } else if (const OwnedRows<T> rows(at.curve, along.curve); !rows.first.empty()) {
      branches.resize(rows.first.size() + 1);
      contact.branches = branches_of(rows.first.data(), rows.second.data(),
                                     static_cast<int>(rows.first.size()), branches.data());
      if (!vanishes(viscous)) add_viscous(branches.data(), contact.branches, viscous);
    } else if (!vanishes(viscous)) {
      branches = {{T(0), unlimited, contact.kinetic, viscous, T(0)}};
      contact.branches = 1;
    }
    contact.curve = branches.data();
  }

 private:
  static constexpr T unlimited = std::numeric_limits<T>::infinity();
};

/// An input as a function; of two rows at one time, the later value holds.
template <class T>
FunctionPieces<T> function_of(const InputNumbers& at, const InputNumbers& along) {
  if (!at.pieces.empty()) return pieces_of<T>(at, along);
  FunctionPieces<T> pieces;
  const auto time = [&](std::size_t i) { return number<T>(at.rows[i].first, along.rows[i].first); };
  const auto value = [&](std::size_t i) {
    return number<T>(at.rows[i].second, along.rows[i].second);
  };
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    const bool last = i + 1 == at.rows.size();
    if (!last && at.rows[i + 1].first == at.rows[i].first) continue;
    FunctionPiece<T>& piece = pieces.emplace_back();
    piece.begin = time(i);
    piece.polynomial[0] = value(i);
    if (!last) piece.polynomial[1] = (value(i + 1) - value(i)) / (time(i + 1) - time(i));
  }
  return pieces;
}
inline Pieces as_function(const InputNumbers& input) { return function_of<double>(input, input); }

/// The force on a pin whose spring stands on the ground: the given force less the inertial force of an
/// accelerating mouse, which the core includes. Sets the values, and the derivatives along a direction.
inline void set_force_on_ground(const Numbers& at, const Numbers& along, InputNumbers& value,
                                InputNumbers& slope) {
  using Dual = pindrive::Dual<double>;
  const Dual mass = number<Dual>(at.mass, along.mass);
  const auto sum =
      sum_of(function_of<Dual>(at.force, along.force),
             derivative_of(function_of<Dual>(at.mouse_velocity, along.mouse_velocity), -mass));
  value = slope = {};
  for (const FunctionPiece<Dual>& piece : sum) {
    PieceNumbers &values = value.pieces.emplace_back(), &slopes = slope.pieces.emplace_back();
    values.begin = piece.begin.value, slopes.begin = piece.begin.slope;
    for (std::size_t n = 0; n < piece.polynomial.size(); ++n)
      values.polynomial[n] = piece.polynomial[n].value,
      slopes.polynomial[n] = piece.polynomial[n].slope;
    for (const auto& [cosine, sine, decay, frequency] : piece.terms) {
      values.terms.push_back({cosine.value, sine.value, decay.value, frequency.value});
      slopes.terms.push_back({cosine.slope, sine.slope, decay.slope, frequency.slope});
    }
  }
}

/// Inputs of a motion with the arrays to which they refer.
template <class T>
struct OwnedInputs {
  OwnedContact<T> plate, finger;
  OwnedInput<T> mouse_velocity, plate_load, force, across_velocity, finger_load;
  Drive<T> core_drive;
  Inputs<T> core_inputs;

  OwnedInputs(const Numbers& at, const Numbers& along)
      : plate(at.plate, along.plate),
        finger(at.finger, along.finger),
        mouse_velocity(at.mouse_velocity, along.mouse_velocity),
        plate_load(at.plate_load, along.plate_load),
        force(force_of(at, along)),
        across_velocity(at.across_velocity, along.across_velocity),
        finger_load(at.finger_load, along.finger_load),
        core_drive{number<T>(at.mass, along.mass),
                   number<T>(at.stiffness, along.stiffness),
                   number<T>(at.damping, along.damping),
                   plate.contact,
                   finger.contact,
                   stops<T>(at.stops, along.stops)},
        core_inputs{mouse_velocity.profile(),
                    number<T>(at.displacement, along.displacement),
                    number<T>(at.velocity, along.velocity),
                    number<T>(at.duration, along.duration),
                    plate_load.profile(),
                    number<T>(at.skin_stretch, along.skin_stretch),
                    force.profile(),
                    across_velocity.profile(),
                    finger_load.profile().to_the(
                        number<T>(at.finger.load_exponent, along.finger.load_exponent)),
                    at.support != 0} {}
  OwnedInputs(const OwnedInputs&) = delete;
  OwnedInputs& operator=(const OwnedInputs&) = delete;

 private:
  static OwnedInput<T> force_of(const Numbers& at, const Numbers& along) {
    if (at.support == 0 || at.mouse_velocity.constant())
      return OwnedInput<T>(at.force, along.force);
    InputNumbers value, slope;
    set_force_on_ground(at, along, value, slope);
    return OwnedInput<T>(value, slope);
  }
};

/// Motion with its segments. Refers to the rows of its inputs and the branches of its friction curves,
/// which must outlive it.
template <class T>
class StoredMotion {
 public:
  StoredMotion(const Drive<T>& drive, const Inputs<T>& inputs, std::vector<Segment<T>>&& segments,
               const Outcome<T>& outcome)
      : drive_(drive), inputs_(inputs), segments_(std::move(segments)), outcome_(outcome) {}
  StoredMotion(const StoredMotion&) = delete;
  StoredMotion& operator=(const StoredMotion&) = delete;
  virtual ~StoredMotion() = default;

  Motion<T> view() const { return {drive_, inputs_, segments_.data(), segments_.size(), outcome_}; }
  const std::vector<Segment<T>>& segments() const { return segments_; }
  const Outcome<T>& outcome() const { return outcome_; }
  const Drive<T>& drive() const { return drive_; }

 protected:
  /// Simulates; `go_on` is called with each segment.
  StoredMotion(const Drive<T>& drive, const Inputs<T>& inputs, SegmentSink<T> go_on)
      : drive_(drive),
        inputs_(inputs),
        outcome_(simulate(drive_, inputs_, [&](const Segment<T>& segment) {
          segments_.push_back(segment);
          return go_on(segment);
        })) {}

 private:
  Drive<T> drive_;
  Inputs<T> inputs_;
  std::vector<Segment<T>> segments_;
  Outcome<T> outcome_;
};

/// Motion that owns its inputs. With dual numbers, its results are derivatives along the direction in which
/// the inputs change.
template <class T>
class OwnedMotion : private OwnedInputs<T>, public StoredMotion<T> {
 public:
  OwnedMotion(const Numbers& at, const Numbers& along, SegmentSink<T> go_on)
      : OwnedInputs<T>(at, along),
        StoredMotion<T>(OwnedInputs<T>::core_drive, OwnedInputs<T>::core_inputs, go_on) {}
};

}  // namespace pindrive
