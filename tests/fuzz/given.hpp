/// A drive and its inputs as the core takes them, and its motion.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "case.hpp"
#include "pindrive.hpp"

namespace fuzz {

namespace pd = pindrive;

/// The rows of a curve as branches, as the core makes them; or the branch of a law.
inline std::vector<pd::Branch<double>> branches(const Rows& rows, const Falling& law) {
  if (law.shape != 0)
    return {{0,
             never,
             rows.value[0] + law.excess,
             law.viscous,
             0,
             {static_cast<pd::FallingShape>(law.shape), law.excess, law.velocity}}};
  std::vector<pd::Branch<double>> all(rows.at.size() + 1);
  const int count = static_cast<int>(rows.at.size());
  all.resize(pd::branches_of(rows.at.data(), rows.value.data(), count, all.data()));
  return all;
}

/// A drive and its inputs as the core takes them: they point into the case, which outlives them.
class Given {
 public:
  explicit Given(const Case& c)
      : plate(branches(c.curve[0], c.law[0])),
        finger(branches(c.curve[1], c.law[1])),
        functions(pieces(c)),
        drive{c.mass,
              c.stiffness,
              c.damping,
              {c.curve[0].value[0] + c.law[0].excess, c.limit[0], never, plate.data(),
               static_cast<int>(plate.size())},
              {c.curve[1].value[0] + c.law[1].excess, c.limit[1], c.skin, finger.data(),
               static_cast<int>(finger.size()), c.skin_damping},
              {c.travel, c.stop_stiffness, c.stop_damping}},
        inputs{input(mouse_velocity, c.mouse_velocity),
               c.displacement,
               c.velocity,
               c.duration,
               input(plate_load, c.plate_load),
               std::numeric_limits<double>::quiet_NaN(),
               input(force, c.force),
               input(across_velocity, c.across),
               input(finger_load, c.finger_load)} {}
  Given(const Given&) = delete;
  Given& operator=(const Given&) = delete;

  static pd::Profile<double> profile(const Rows& rows) {
    return rows.at.size() == 1
               ? pd::Profile<double>(rows.value[0])
               : pd::Profile<double>(rows.at.data(), rows.value.data(), rows.at.size());
  }

  std::vector<pd::Branch<double>> plate, finger;
  std::vector<pd::InputTerm<double>> terms;
  std::array<std::vector<pd::InputPiece<double>>, 5> functions;
  pd::Drive<double> drive;
  pd::Inputs<double> inputs;

 private:
  /// The pieces of all functions, after their terms.
  std::array<std::vector<pd::InputPiece<double>>, 5> pieces(const Case& c) {
    for (const Function& function : c.functions)
      for (const Piece& piece : function)
        for (const Term& t : piece.terms) terms.push_back({t.cosine, t.sine, t.decay, t.frequency});
    std::array<std::vector<pd::InputPiece<double>>, 5> found;
    const pd::InputTerm<double>* next = terms.data();
    for (std::size_t i = 0; i < found.size(); ++i)
      for (const Piece& piece : c.functions[i]) {
        found[i].push_back({piece.begin, piece.polynomial, next, piece.terms.size()});
        next += piece.terms.size();
      }
    return found;
  }
  pd::Profile<double> input(Input which, const Rows& rows) const {
    const auto& function = functions[which];
    if (function.empty()) return profile(rows);
    return {function.data(), function.size()};
  }
};

inline pd::Outcome<double> run(const Given& given, std::vector<pd::Segment<double>>& segments) {
  segments.clear();
  return pd::simulate(given.drive, given.inputs,
                      [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
}

}  // namespace fuzz
