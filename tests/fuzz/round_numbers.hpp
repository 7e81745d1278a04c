/// Drives as users write them: documented features, three at a time, with values from {1, 2, 5}·10ⁿ.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "case.hpp"
#include "draw.hpp"

namespace fuzz {

/// Draws round values for one drive.
class RoundNumbers {
 public:
  RoundNumbers(std::uint64_t seed, std::uint64_t number) : random_(seed, number) {}

  bool chance(double p) { return random_.uniform() < p; }
  /// A value of {1, 2, 5}·10ⁿ between two values of that series.
  double between(double low, double high) {
    const int first = index(low), last = index(high);
    return at(first + static_cast<int>(random_.uniform() * (last - first + 1)));
  }
  /// The next value of the series.
  static double above(double value) { return at(index(value) + 1); }
  /// The value before.
  static double below(double value) { return at(index(value) - 1); }

 private:
  static double at(int i) {
    const int decade = static_cast<int>(std::floor(i / 3.0));
    const std::array<double, 3> digits{1, 2, 5};
    const double digit = digits[static_cast<std::size_t>(i - 3 * decade)];
    return decade < 0 ? digit / std::pow(10, -decade) : digit * std::pow(10, decade);
  }
  static int index(double value) {
    const int decade = static_cast<int>(std::floor(std::log10(value) + 1e-9));
    const double digit = value / std::pow(10, decade);
    return 3 * decade + (digit < 1.5 ? 0 : digit < 3 ? 1 : 2);
  }

  Random random_;
};

/// A feature of the documentation, added to a drive.
struct Feature {
  const char* name;
  void (*add)(Case&, RoundNumbers&);
};

/// Static friction: equal to the kinetic friction in half of the contacts, else the next value above.
inline void set_static(Case& c, int contact, RoundNumbers& draw) {
  const double kinetic = c.curve[contact].value[0];
  c.limit[contact] = kinetic == 0 || draw.chance(0.5) ? kinetic : RoundNumbers::above(kinetic);
}
inline void add_finger(Case& c, RoundNumbers& draw) {
  if (c.curve[1].value[0] > 0) return;
  const double plate = c.curve[0].value[0];
  c.curve[1] = {{0}, {plate > 0 && draw.chance(0.1) ? plate : draw.between(1e-3, 2e-2)}};
  set_static(c, 1, draw);
}
/// A Stribeck table that falls over two or three points.
inline void add_curve(Case& c, int contact, RoundNumbers& draw) {
  const double kinetic = contact == 0 ? draw.between(1e-2, 5e-2) : draw.between(5e-3, 2e-2);
  Rows curve{{0}, {kinetic}};
  const double speed = draw.between(2e-2, 1e-1);
  curve.at.push_back(speed);
  curve.value.push_back(RoundNumbers::below(kinetic));
  if (draw.chance(0.5)) {
    curve.at.push_back(10 * speed);
    curve.value.push_back(draw.chance(0.5) ? kinetic : RoundNumbers::below(curve.value[1]));
  }
  c.curve[contact] = curve;
  set_static(c, contact, draw);
}

inline constexpr std::array<Feature, 18> features{{
    {"finger", add_finger},
    {"skin",
     [](Case& c, RoundNumbers& draw) {
       add_finger(c, draw);
       c.skin = draw.between(1e2, 5e3);
     }},
    {"damped skin",
     [](Case& c, RoundNumbers& draw) {
       add_finger(c, draw);
       c.skin = draw.between(1e2, 5e3);
       c.skin_damping = 1.03 * draw.between(5e-2, 5e0);  // never as a curve falls
     }},
    {"plate curve", [](Case& c, RoundNumbers& draw) { add_curve(c, 0, draw); }},
    {"finger curve", [](Case& c, RoundNumbers& draw) { add_curve(c, 1, draw); }},
    {"hand stops",
     [](Case& c, RoundNumbers& draw) {
       const double from = draw.between(1e-2, 1e-1), v = c.mouse_velocity.value[0];
       c.mouse_velocity = {{0, from, 2 * from}, {v, v, 0}};
     }},
    {"hand slows",
     [](Case& c, RoundNumbers& draw) {
       const double from = draw.between(1e-2, 1e-1), v = c.mouse_velocity.value[0];
       c.mouse_velocity = {{0, from, 2 * from}, {v, v, RoundNumbers::below(v)}};
     }},
    {"hand returns",
     [](Case& c, RoundNumbers& draw) {
       const double from = draw.between(1e-2, 1e-1), v = c.mouse_velocity.value[0];
       c.mouse_velocity = {{0, from, 3 * from}, {v, v, -v}};
     }},
    {"force",
     [](Case& c, RoundNumbers& draw) {
       c.force = {{0}, {(draw.chance(0.5) ? 1 : -1) * draw.between(1e-3, 2e-2)}};
     }},
    {"force step",
     [](Case& c, RoundNumbers& draw) {
       const double at = draw.between(1e-2, 1e-1), force = draw.between(1e-3, 2e-2);
       c.force = {{0, at, at}, {0, 0, force}};
     }},
    {"pull decays",
     [](Case& c, RoundNumbers& draw) {
       const double at = draw.between(1e-3, 5e-2);
       c.plate_load = {{0, at, 2 * at}, {1, 0.5, 0.2}};
     }},
    {"pull ends",
     [](Case& c, RoundNumbers& draw) {
       const double at = draw.between(1e-3, 5e-2);
       c.plate_load = {{0, at, at}, {1, 1, 0}};
     }},
    {"oblique hand",
     [](Case& c, RoundNumbers& draw) { c.across = {{0}, {draw.between(1e-2, 1e-1)}}; }},
    {"oblique stroke",
     [](Case& c, RoundNumbers& draw) {
       const double at = draw.between(1e-2, 5e-2);
       c.across = {{0, at, 2 * at}, {0, draw.between(1e-2, 1e-1), 0}};
     }},
    {"rigid stops", [](Case& c, RoundNumbers& draw) { c.travel = draw.between(5e-4, 2e-3); }},
    {"elastic stops",
     [](Case& c, RoundNumbers& draw) {
       c.travel = draw.between(5e-4, 2e-3);
       c.stop_stiffness = draw.between(1e3, 1e5);
       if (draw.chance(0.5)) c.stop_damping = draw.between(1e-1, 1e0);
     }},
    {"touch",
     [](Case& c, RoundNumbers& draw) {
       add_finger(c, draw);
       const double at = draw.between(1e-2, 1e-1);
       c.finger_load = {{0, at, 2 * at}, {1, 1, draw.chance(0.5) ? 2 : 0.5}};
     }},
    {"from rest", [](Case& c, RoundNumbers&) { c.displacement = 0; }},
}};

/// The features of a drive, in the order of `features`.
inline std::array<std::size_t, 3> features_of(std::uint64_t number) {
  // The combinations of three, one after the other.
  constexpr std::size_t n = features.size(), all = n * (n - 1) * (n - 2) / 6;
  std::size_t left = number % all;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) {
      if (left < n - b - 1) return {a, b, b + 1 + left};
      left -= n - b - 1;
    }
  return {};
}

/// The drive of a seed and a number, without an end.
inline Case round_drive(std::uint64_t seed, std::uint64_t number) {
  RoundNumbers draw(seed, number);
  Case c;
  c.mass = draw.between(5e-3, 5e-2);
  c.stiffness = draw.between(5e1, 1e3);
  c.damping = draw.chance(0.1) ? 0 : draw.between(2e-2, 1e0);
  c.curve = {Rows{{0}, {draw.between(5e-3, 5e-2)}}, Rows{{0}, {0}}};
  set_static(c, 0, draw);
  c.plate_load = {{0}, {1}};
  c.mouse_velocity = {{0}, {draw.between(2e-2, 2e-1)}};
  c.displacement = draw.between(5e-4, 5e-3);
  c.duration = std::numeric_limits<double>::infinity();
  for (const std::size_t feature : features_of(number)) features[feature].add(c, draw);
  // Skin whose load changes has no friction curve, as in Draw.
  if (!std::isinf(c.skin) && c.finger_load.at.size() > 1) c.curve[1] = {{0}, {c.curve[1].value[0]}};
  if (c.displacement > c.travel) c.displacement = c.travel;
  c.velocity = c.mouse_velocity.value[0];
  if (std::isinf(c.stop_stiffness) && c.displacement == c.travel) c.velocity = 0;
  return c;
}

/// A pin that friction falling with speed excites: a moving plate with a Stribeck table, and other features.
inline Case self_excited_drive(std::uint64_t seed, std::uint64_t number) {
  RoundNumbers draw(seed, number);
  Case c;
  c.mass = draw.between(1e-2, 1e0);
  c.stiffness = draw.between(5e1, 1e3);
  c.damping = draw.chance(0.5) ? 0 : draw.between(1e-3, 2e-2);
  c.curve[1] = {{0}, {0}};
  c.plate_load = {{0}, {1}};
  add_curve(c, 0, draw);
  c.mouse_velocity = {{0}, {draw.between(1e-2, 1e-1)}};
  c.displacement = draw.chance(0.5) ? 0 : draw.between(5e-4, 2e-3);
  c.velocity = draw.chance(0.5) ? 0 : c.mouse_velocity.value[0];
  c.duration = std::numeric_limits<double>::infinity();
  if (draw.chance(0.3)) add_finger(c, draw);
  if (draw.chance(0.2)) add_curve(c, 1, draw);
  if (draw.chance(0.3)) {
    add_finger(c, draw);
    c.skin = draw.between(1e2, 2e3);
  }
  if (draw.chance(0.2)) {
    c.travel = draw.between(5e-4, 5e-3);
    if (draw.chance(0.5)) c.stop_stiffness = draw.between(1e3, 1e5);
  }
  if (c.displacement > c.travel) c.displacement = c.travel;
  if (c.displacement == c.travel) c.velocity = 0;
  return c;
}

// ---- functions of time -----------------------------------------------------------------------------

inline Function sinusoid(double mean, double amplitude, double frequency, double phase = 0) {
  constexpr double turn = 6.283185307179586;  // rad
  return {{0,
           {mean},
           {{amplitude * std::sin(phase), amplitude * std::cos(phase), 0, turn * frequency}}}};
}
inline Function decay(double start, double end, double time_constant) {
  return {{0, {end}, {{start - end, 0, 1 / time_constant, 0}}}};
}
/// Strokes of minimum jerk, one after the other, of distances in turn forth and back.
inline Function strokes(double distance, double lasts, int count) {
  Function made;
  for (int i = 0; i < count; ++i) {
    const double second = (i % 2 ? -30 : 30) * distance / (lasts * lasts * lasts);
    made.push_back(
        {i * lasts, {0, 0, second, -2 * second / lasts, second / (lasts * lasts), 0}, {}});
  }
  made.push_back({count * lasts, {}, {}});
  return made;
}
/// A velocity over time; half of the sinusoids touch rest.
inline Function round_velocity(RoundNumbers& draw) {
  const double speed = draw.between(1e-2, 1e-1), frequency = draw.between(1, 50);
  if (draw.chance(0.3)) return sinusoid(speed, speed, frequency);
  if (draw.chance(0.4))
    return sinusoid(0, speed, frequency, draw.chance(0.5) ? 0 : 1.5707963267948966);
  if (draw.chance(0.3)) {
    const double constant = draw.between(1e-2, 1e-1);
    return draw.chance(0.5) ? decay(speed, 0, constant) : decay(0, speed, constant);
  }
  return strokes(draw.between(1e-2, 5e-2), draw.between(1e-1, 5e-1), draw.chance(0.5) ? 1 : 2);
}
/// A factor of a load; half of the sinusoids touch zero.
inline Function round_load(RoundNumbers& draw) {
  const double frequency = draw.between(1, 50);
  if (draw.chance(0.5)) return sinusoid(draw.chance(0.5) ? 1 : 2, 1, frequency);
  const double constant = draw.between(5e-3, 5e-2);
  return draw.chance(0.5) ? decay(5, 1, constant) : decay(1, 0, constant);
}

/// A law that falls.
inline void add_law(Case& c, int contact, RoundNumbers& draw) {
  const double kinetic = c.curve[contact].value[0];
  if (kinetic == 0 || c.curve[contact].at.size() > 1) return;
  c.law[contact] = {1 + static_cast<int>(3 * draw.between(1, 5) / 6),
                    draw.chance(0.3) ? 0 : RoundNumbers::above(kinetic) - kinetic,
                    draw.between(5e-3, 1e-1), draw.chance(0.2) ? draw.between(1e-2, 1e-1) : 0};
  c.limit[contact] = kinetic + c.law[contact].excess;
}

/// A drive under a hand that is a function, with other features and functions.
inline Case round_drive_under_functions(std::uint64_t seed, std::uint64_t number) {
  Case c = round_drive(seed, number);
  RoundNumbers draw(seed + 1, number);
  c.mouse_velocity = {{0}, {0}};
  c.functions[mouse_velocity] = round_velocity(draw);
  if (draw.chance(0.5)) c.curve[1] = {{0}, {c.curve[0].value[0]}};  // balanced frictions
  if (draw.chance(0.5)) set_static(c, 1, draw);
  for (const int contact : {0, 1}) {
    if (c.limit[contact] < c.curve[contact].value[0]) c.limit[contact] = c.curve[contact].value[0];
    if (draw.chance(0.3)) add_law(c, contact, draw);
  }
  const auto follow = [&](Input input, Rows& rows, double value, const Function& function) {
    rows = {{0}, {value}};
    c.functions[input] = function;
  };
  if (draw.chance(0.3)) follow(plate_load, c.plate_load, 1, round_load(draw));
  if (draw.chance(0.2) && std::isinf(c.skin))
    follow(finger_load, c.finger_load, 1, round_load(draw));
  if (draw.chance(0.2)) follow(across_velocity, c.across, 0, round_velocity(draw));
  if (draw.chance(0.2))
    follow(force, c.force, 0, sinusoid(0, draw.between(1e-3, 2e-2), draw.between(1, 50)));
  if (!std::isinf(c.skin)) c.law[1] = {};
  if (draw.chance(0.5)) c.displacement = 0;
  const Piece& first = c.functions[mouse_velocity][0];
  c.velocity = first.polynomial[0] + (first.terms.empty() ? 0 : first.terms[0].cosine);
  if (draw.chance(0.5) || c.displacement == c.travel) c.velocity = 0;
  c.duration = draw.between(1e-1, 1e0);
  return c;
}

/// Drive in other units: its forces, lengths and times times these factors.
inline Case in_units(Case c, double force, double length, double time) {
  const double speed = length / time;
  const auto scale = [](Rows& rows, double at, double value) {
    for (double& x : rows.at) x *= at;
    for (double& x : rows.value) x *= value;
  };
  c.mass *= force * time / speed;
  c.stiffness *= force / length;
  c.damping *= force / speed;
  for (double& limit : c.limit) limit *= force;
  for (Rows& curve : c.curve) scale(curve, speed, force);
  c.skin *= force / length;
  c.skin_damping *= force / speed;
  scale(c.mouse_velocity, time, speed);
  scale(c.plate_load, time, 1);
  scale(c.force, time, force);
  scale(c.across, time, speed);
  scale(c.finger_load, time, 1);
  c.displacement *= length;
  c.velocity *= speed;
  c.duration *= time;
  c.travel *= length;
  c.stop_stiffness *= force / length;
  c.stop_damping *= force / speed;
  return c;
}

}  // namespace fuzz
