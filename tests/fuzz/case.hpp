/// A drive and its inputs as a file that replays it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <istream>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace fuzz {

inline constexpr double never = std::numeric_limits<double>::infinity();

struct Rows {
  std::vector<double> at, value;
};

/// A drive and its inputs, owned.
struct Case {
  double mass{}, stiffness{}, damping{};
  std::array<double, 2> limit{};  ///< static friction of plate and finger
  std::array<Rows, 2> curve;      ///< kinetic friction over speed; one row is Coulomb
  double skin{never};             ///< stiffness of the finger
  Rows mouse_velocity, plate_load, force{{0}, {0}}, across{{0}, {0}},
      finger_load{{0}, {1}};  ///< over time; one row is a constant
  double displacement{}, velocity{}, duration{};
};

inline void write(std::ostream& out, const Case& c) {
  const auto rows = [&](const char* name, const Rows& r) {
    out << name << ' ' << r.at.size();
    for (std::size_t i = 0; i < r.at.size(); ++i) out << "  " << r.at[i] << ' ' << r.value[i];
    out << '\n';
  };
  out << std::setprecision(17) << "drive " << c.mass << ' ' << c.stiffness << ' ' << c.damping
      << '\n';
  out << "static " << c.limit[0] << ' ' << c.limit[1] << '\n';
  rows("plate", c.curve[0]);
  rows("finger", c.curve[1]);
  out << "skin " << (std::isinf(c.skin) ? 0.0 : c.skin) << '\n';
  rows("mouse_velocity", c.mouse_velocity);
  rows("plate_load", c.plate_load);
  out << "start " << c.displacement << ' ' << c.velocity << ' ' << c.duration << '\n';
  if (c.force.at.size() > 1 || c.force.value[0] != 0) rows("force", c.force);
  if (c.across.at.size() > 1 || c.across.value[0] != 0) rows("across", c.across);
  if (c.finger_load.at.size() > 1 || c.finger_load.value[0] != 1)
    rows("finger_load", c.finger_load);
}

/// False if the text is no such drive.
inline bool read(std::istream& in, Case& c) {
  std::string name;
  const auto named = [&](Rows& r) {
    std::size_t count = 0;
    in >> count;
    r.at.resize(count);
    r.value.resize(count);
    for (std::size_t i = 0; i < count; ++i) in >> r.at[i] >> r.value[i];
  };
  const auto rows = [&](Rows& r) {
    in >> name;
    named(r);
  };
  in >> name >> c.mass >> c.stiffness >> c.damping >> name >> c.limit[0] >> c.limit[1];
  rows(c.curve[0]);
  rows(c.curve[1]);
  in >> name >> c.skin;
  if (c.skin == 0) c.skin = never;
  rows(c.mouse_velocity);
  rows(c.plate_load);
  in >> name >> c.displacement >> c.velocity >> c.duration;
  if (!in) return false;
  while (in >> std::ws && in.peek() != 'd' && in >> name) {  // until the next drive
    if (name != "force" && name != "across" && name != "finger_load") return false;
    named(name == "force" ? c.force : name == "across" ? c.across : c.finger_load);
  }
  in.clear();
  return true;
}

}  // namespace fuzz
