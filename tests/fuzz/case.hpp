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

/// Term (cosine·cos Ωτ + sine·sin Ωτ) e^(−δτ) of a function.
struct Term {
  double cosine{}, sine{}, decay{}, frequency{};
};
/// Piece of a function of time from its begin on.
struct Piece {
  double begin{};
  std::array<double, 6> polynomial{};
  std::vector<Term> terms;
};
using Function = std::vector<Piece>;

/// Friction that falls with speed, beside a curve of one row; its shape is the number of a FallingShape.
struct Falling {
  int shape{0};
  double excess{}, velocity{1}, viscous{};
};

/// Inputs that may be functions.
enum Input { mouse_velocity, plate_load, force, finger_load, across_velocity };
inline constexpr std::array<const char*, 5> input_names{"mouse_velocity", "plate_load", "force",
                                                        "finger_load", "across_velocity"};

/// A drive and its inputs, owned.
struct Case {
  double mass{}, stiffness{}, damping{};
  std::array<double, 2> limit{};  ///< static friction of plate and finger
  std::array<Rows, 2> curve;      ///< kinetic friction over speed; one row is Coulomb
  double skin{never};             ///< stiffness of the finger
  double skin_damping{};          ///< damping beside it
  Rows mouse_velocity, plate_load, force{{0}, {0}}, across{{0}, {0}},
      finger_load{{0}, {1}};          ///< over time; one row is a constant
  std::array<Function, 5> functions;  ///< in place of the rows of an Input, where not empty
  std::array<Falling, 2> law;         ///< of plate and finger
  double displacement{}, velocity{}, duration{};
  double travel{never}, stop_stiffness{never}, stop_damping{};
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
  if (c.travel < never)
    out << "stops " << c.travel << ' ' << (std::isinf(c.stop_stiffness) ? 0.0 : c.stop_stiffness)
        << ' ' << c.stop_damping << '\n';
  if (c.skin_damping > 0) out << "skin_damping " << c.skin_damping << '\n';
  for (std::size_t i = 0; i < c.law.size(); ++i)
    if (const Falling& law = c.law[i]; law.shape != 0)
      out << "law " << i << ' ' << law.shape << ' ' << law.excess << ' ' << law.velocity << ' '
          << law.viscous << '\n';
  for (std::size_t i = 0; i < c.functions.size(); ++i) {
    if (c.functions[i].empty()) continue;
    out << "function " << i << ' ' << c.functions[i].size();
    for (const Piece& piece : c.functions[i]) {
      out << "  " << piece.begin;
      for (const double p : piece.polynomial) out << ' ' << p;
      out << ' ' << piece.terms.size();
      for (const Term& t : piece.terms)
        out << ' ' << t.cosine << ' ' << t.sine << ' ' << t.decay << ' ' << t.frequency;
    }
    out << '\n';
  }
}

/// A law after its name; false if the text is none.
inline bool read_law(std::istream& in, Case& c) {
  std::size_t contact = 0;
  if (!(in >> contact) || contact >= c.law.size()) return false;
  Falling& law = c.law[contact];
  in >> law.shape >> law.excess >> law.velocity >> law.viscous;
  return law.shape >= 0 && law.shape <= 3;
}
/// A function after its name; false if the text is none.
inline bool read_function(std::istream& in, Case& c) {
  std::size_t input = 0, pieces = 0;
  if (!(in >> input >> pieces) || input >= c.functions.size() || pieces > 1000) return false;
  Function& function = c.functions[input];
  function.resize(pieces);
  for (Piece& piece : function) {
    std::size_t terms = 0;
    in >> piece.begin;
    for (double& p : piece.polynomial) in >> p;
    if (!(in >> terms) || terms > 1000) return false;
    piece.terms.resize(terms);
    for (Term& t : piece.terms) in >> t.cosine >> t.sine >> t.decay >> t.frequency;
  }
  return true;
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
    if (name == "stops") {
      in >> c.travel >> c.stop_stiffness >> c.stop_damping;
      if (c.stop_stiffness == 0) c.stop_stiffness = never;
      continue;
    }
    if (name == "skin_damping") {
      in >> c.skin_damping;
      continue;
    }
    if (name == "law" || name == "function") {
      if (!(name == "law" ? read_law(in, c) : read_function(in, c))) return false;
      continue;
    }
    if (name != "force" && name != "across" && name != "finger_load") return false;
    named(name == "force" ? c.force : name == "across" ? c.across : c.finger_load);
  }
  in.clear();
  return true;
}

}  // namespace fuzz
