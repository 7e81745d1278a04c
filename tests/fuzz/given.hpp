/// A drive and its inputs as the core takes them, and its motion.
#pragma once

#include <limits>
#include <vector>

#include "case.hpp"
#include "pindrive.hpp"

namespace fuzz {

namespace pd = pindrive;

/// The rows of a curve as branches, as the core makes them.
inline std::vector<pd::Branch<double>> branches(const Rows& rows) {
  std::vector<pd::Branch<double>> all(rows.at.size() + 1);
  const int count = static_cast<int>(rows.at.size());
  all.resize(pd::branches_of(rows.at.data(), rows.value.data(), count, all.data()));
  return all;
}

/// A drive and its inputs as the core takes them: they point into the case, which outlives them.
struct Given {
  explicit Given(const Case& c)
      : plate(branches(c.curve[0])),
        finger(branches(c.curve[1])),
        drive{
            c.mass,
            c.stiffness,
            c.damping,
            {c.curve[0].value[0], c.limit[0], never, plate.data(), static_cast<int>(plate.size())},
            {c.curve[1].value[0], c.limit[1], c.skin, finger.data(),
             static_cast<int>(finger.size())},
            {c.travel, c.stop_stiffness, c.stop_damping}},
        inputs{profile(c.mouse_velocity),
               c.displacement,
               c.velocity,
               c.duration,
               profile(c.plate_load),
               std::numeric_limits<double>::quiet_NaN(),
               profile(c.force),
               profile(c.across),
               profile(c.finger_load)} {}
  Given(const Given&) = delete;
  Given& operator=(const Given&) = delete;

  static pd::Profile<double> profile(const Rows& rows) {
    return rows.at.size() == 1
               ? pd::Profile<double>(rows.value[0])
               : pd::Profile<double>(rows.at.data(), rows.value.data(), rows.at.size());
  }

  std::vector<pd::Branch<double>> plate, finger;
  pd::Drive<double> drive;
  pd::Inputs<double> inputs;
};

inline pd::Outcome<double> run(const Given& given, std::vector<pd::Segment<double>>& segments) {
  segments.clear();
  return pd::simulate(given.drive, given.inputs,
                      [&](const pd::Segment<double>& segment) { segments.push_back(segment); });
}

}  // namespace fuzz
