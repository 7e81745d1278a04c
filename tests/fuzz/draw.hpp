/// Random drives and inputs over many decades. Family, seed and number determine a drive, so
/// that each drive can be drawn again.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "case.hpp"

namespace fuzz {

/// The generator of Steele, Lea and Flood (2014), "SplitMix": a counter, mixed.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : counter_(mixed(mixed(seed) + stream * step)) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(mixed(counter_ += step) >> 11) * 0x1p-53; }

 private:
  static constexpr std::uint64_t step = 0x9e3779b97f4a7c15ULL;

  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t counter_;
};

/// Family of drives: an aligned or oblique hand, end stops, a compliant finger with a friction curve, inputs that are
/// functions, friction that falls by a law, strokes of a hand at an angle, damped skin, or round numbers under
/// functions; any: one drive in ten has each but the last.
enum class Family { any, aligned, oblique, stops, skin, functions, laws, strokes, damped, round };

class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t number, Family family = Family::any)
      : random_(seed, number), family_(family) {}

  Case next() {
    Case c;
    round_ = chance(0.25);
    const double omega = decade(0.5, 3.5), length = decade(-4, -2);
    c.mass = decade(-4, -1);
    c.stiffness = c.mass * omega * omega;
    const double critical = 2 * c.mass * omega;
    const double pick = uniform(0, 1);
    c.damping = pick < 0.15   ? 0
                : pick < 0.7  ? critical * decade(-4, 0)
                : pick < 0.85 ? critical * (1 + (chance(0.5) ? 1 : -1) * decade(-15, -2))
                              : critical * decade(0, 1.7);
    force_ = c.stiffness * length;
    speed_ = omega * length * decade(-1.5, 0.5);
    for (int i = 0; i < 2; ++i) {
      c.curve[i] = curve();
      c.limit[i] = c.curve[i].value[0] * (chance(0.5) ? 1 : tidy(uniform(1, 2.5)));
    }
    const bool coulomb = c.curve[1].at.size() == 1 && c.curve[1].value[0] > 0;
    if (coulomb && chance(0.6)) c.skin = c.stiffness * decade(0, 6);
    times(c, omega);
    double last = 0;
    c.mouse_velocity =
        profile([&] { return chance(0.3) ? 0 : tidy(speed_ * uniform(-1, 1)); }, last);
    c.plate_load = {{0}, {1}};
    if (chance(0.4))
      c.plate_load = profile([&] { return chance(0.3) ? 0 : tidy(uniform(0, 2)); }, last, 0.3);
    c.displacement = chance(0.1) ? 0 : tidy(length * uniform(-1, 1));
    c.velocity = chance(0.6)   ? c.mouse_velocity.value[0]
                 : chance(0.3) ? 0
                               : speed_ * uniform(-2, 2);
    if (chance(0.15))
      c.force = profile([&] { return chance(0.3) ? 0 : tidy(force_ * uniform(-1, 1)); }, last, 0.3);
    c.duration = last + period_ * uniform(0.3, long_ ? 12 : 2);
    const auto touch = [&] { return chance(0.3) ? 0 : tidy(uniform(0, 2)); };
    if (coulomb && chance(0.2))
      c.finger_load = std::isinf(c.skin) ? profile(touch, last, 0.3) : Rows{{0}, {touch()}};
    // Last, so that what an aligned hand has does not depend on the family.
    const bool oblique = chance(0.1);
    if (family_ == Family::oblique || (family_ == Family::any && oblique)) c.across = across();
    if (family_ == Family::stops || (family_ == Family::any && chance(0.1)))
      stop(c, critical, length);
    if (family_ == Family::skin || (family_ == Family::any && chance(0.1)))
      skin(c, critical, length);
    if (family_ == Family::functions || (family_ == Family::any && chance(0.1)))
      functions(c, omega, length);
    if (family_ == Family::laws || (family_ == Family::any && chance(0.1))) laws(c);
    if (family_ == Family::strokes || (family_ == Family::any && chance(0.1))) strokes(c);
    if (family_ == Family::damped || (family_ == Family::any && chance(0.1)))
      damped(c, omega, length);
    return c;
  }

 private:
  double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
  bool chance(double p) { return random_.uniform() < p; }
  double decade(double low, double high) { return tidy(std::pow(10, uniform(low, high))); }
  /// Now and then few digits, so that things coincide.
  double tidy(double value) const {
    if (!round_ || value == 0) return value;
    const double unit = std::pow(10, std::floor(std::log10(std::abs(value))));
    return std::round(value / unit) * unit;
  }

  /// Durations: one drive in twenty lasts long; one in a thousand lasts for thousands of periods of its
  /// spring, however stiff the skin. The other drives last for the first periods of the skin.
  void times(const Case& c, double omega) {
    long_ = chance(0.05);
    period_ = 6.3 / omega;
    if (std::isinf(c.skin) || chance(0.002)) return;
    const double wave = 6.3 / (omega * std::sqrt(1 + c.skin / c.stiffness));
    period_ = std::min(period_, wave * decade(0, 1.3));
  }

  /// End stops, near enough to be met; elastic ones from soft to stiff, without damping and with much.
  void stop(Case& c, double critical, double length) {
    c.travel = tidy(length * decade(-1.5, 0.2));
    if (chance(0.5)) {
      c.stop_stiffness = c.stiffness * decade(-1, 4);
      const double wave = std::sqrt(c.stop_stiffness / c.stiffness);
      if (chance(0.7)) c.stop_damping = critical * wave * decade(-3, 0.5);
    }
    if (std::abs(c.displacement) > c.travel)
      c.displacement = c.travel * (chance(0.3) ? 1 : uniform(-1, 1));
  }

  /// A friction curve on skin, from soft to stiff, now and then beside stops or under a hand across. It may
  /// rise, fall or stay, and have no static friction. Where a load changes, one finger in three has Coulomb
  /// friction, and one in five is rigid.
  void skin(Case& c, double critical, double length) {
    c.skin = c.stiffness * decade(-1, 4);
    while (c.curve[1].at.size() == 1) c.curve[1] = curve();
    if (chance(0.3)) std::sort(c.curve[1].value.begin(), c.curve[1].value.end());
    if (chance(0.3))
      for (std::size_t i = 1; i < c.curve[1].value.size(); i += 2)
        c.curve[1].value[i] = c.curve[1].value[i - 1];
    c.limit[1] = c.curve[1].value[0] * (chance(0.5) ? 1 : tidy(uniform(1, 2.5)));
    c.finger_load = {{0}, {chance(0.7) ? 1 : tidy(uniform(0, 2))}};
    double last = 0;
    if (chance(0.5))
      c.finger_load = profile([&] { return chance(0.3) ? 0 : tidy(uniform(0, 2)); }, last, 0.2);
    if (last > 0 && chance(0.3)) c.curve[1] = {{0}, {c.curve[1].value[0]}};
    const bool rigid = last > 0 && chance(0.2);
    if (chance(0.1)) c.across = across();
    if (chance(0.2)) stop(c, critical, length);
    // The steepest rise or fall has the slowest skin, the flattest the fastest.
    double flattest = never;
    for (std::size_t i = 1; i < c.curve[1].at.size(); ++i) {
      const double rise = std::abs(c.curve[1].value[i] - c.curve[1].value[i - 1]);
      if (rise > 0) flattest = std::min(flattest, rise / (c.curve[1].at[i] - c.curve[1].at[i - 1]));
    }
    const double load = *std::max_element(c.finger_load.value.begin(), c.finger_load.value.end());
    if (rigid) c.skin = never;
    if (load == 0 || rigid) return;
    c.duration = std::min({c.duration, 3 * period_, 2e3 * flattest * load / c.skin});
    // Where it falls, skin slips and grips the more often the less the friction falls by.
    double least = c.limit[1];
    for (const double force : c.curve[1].value) least = std::min(least, force);
    if (c.limit[1] > least)
      c.duration = std::min(c.duration, 3e2 * load * (c.limit[1] - least) / (c.skin * speed_));
    for (double& at : c.finger_load.at)  // within its time
      if (last > c.duration) at *= 0.8 * c.duration / last;
  }

  /// Skin with a damper, over five decades, with Coulomb friction or a curve. Its load changes, or jumps, now and then.
  void damped(Case& c, double omega, double length) {
    if (c.law[1].shape != 0) return;
    if (std::isinf(c.skin)) c.skin = c.stiffness * decade(-1, 3);
    c.skin_damping = c.skin / omega * decade(-3.5, 1.5);
    if (c.curve[1].value[0] == 0) c.curve[1].value[0] = tidy(force_ * decade(-1.5, 0));
    c.limit[1] = std::max(c.limit[1], c.curve[1].value[0]);
    // Far beyond friction, the force of the damper has more rounding than friction has digits.
    c.skin_damping = std::min(c.skin_damping, tidy(1e3 * c.curve[1].value[0] / (omega * length)));
    double last = 0;
    if (!c.functions[finger_load].empty()) c.curve[1] = {{0}, {c.curve[1].value[0]}};
    if (c.functions[finger_load].empty() && chance(0.4))
      c.finger_load = profile([&] { return chance(0.3) ? 0 : tidy(uniform(0, 2)); }, last, 0.3);
    if (c.curve[1].at.size() == 1 && chance(0.1)) {
      c.finger_load = {{0}, {1}};
      c.functions[finger_load] = load(omega);
    }
    if (chance(0.2)) stop(c, 2 * c.mass * omega, length);
    // Friction that falls faster than the damper rises lets the slider vibrate, ever faster as the load passes the
    // value at which it begins to.
    double steepest = 0;
    for (std::size_t i = 1; i < c.curve[1].at.size(); ++i)
      steepest = std::max(steepest, (c.curve[1].value[i - 1] - c.curve[1].value[i]) /
                                        (c.curve[1].at[i] - c.curve[1].at[i - 1]));
    if (c.finger_load.at.size() > 1)
      c.skin_damping = std::max(c.skin_damping, 1.1 * steepest *
                                                    *std::max_element(c.finger_load.value.begin(),
                                                                      c.finger_load.value.end()));
    else if (c.skin_damping < steepest * c.finger_load.value[0])
      c.duration = std::min(c.duration, 3e2 * c.limit[1] / (c.skin * speed_));
  }

  /// Functions in place of some inputs: strokes, sinusoids and exponentials in sequence. The load of a compliant finger
  /// has rows.
  void functions(Case& c, double omega, double length) {
    if (chance(0.7)) {
      c.mouse_velocity = {{0}, {c.mouse_velocity.value[0]}};
      // A stick force at its limit is judged by two derivatives. Round values bring it there, or no force at all.
      const bool at_limit = round_ || (c.limit[0] == 0 && c.displacement == 0);
      const double bend = at_limit ? speed_ * omega * omega : 0;
      c.functions[mouse_velocity] = function(omega, speed_, c.mouse_velocity.value[0], true, bend);
      if (chance(0.3)) c.velocity = c.mouse_velocity.value[0];
    }
    if (chance(0.3)) {
      c.force = {{0}, {0}};
      const double bend = c.stiffness * length * omega * omega;
      c.functions[force] = function(omega, c.stiffness * length, 0, false, bend);
    }
    if (chance(0.3)) {
      c.plate_load = {{0}, {1}};
      c.functions[plate_load] = load(omega);
    }
    if (std::isinf(c.skin) && chance(0.3)) {
      c.finger_load = {{0}, {1}};
      c.functions[finger_load] = load(omega);
    }
  }
  /// Function of one to three pieces from a value on; continuous where asked for.
  Function function(double omega, double size, double value, bool continuous, double bend = 0) {
    Function pieces;
    double begin = 0;
    for (int left = static_cast<int>(uniform(1, 4)); left > 0; --left) {
      Piece piece{begin, {}, {}};
      const double lasts = tidy(period_ * decade(-1.5, 0.2));
      if (chance(0.4)) {  // a stroke, or another polynomial
        const double height = size * uniform(-1, 1), s = 1 / lasts;
        if (chance(0.5))
          piece.polynomial = {0, 0, height * s * s, -2 * height * s * s * s, height * s * s * s * s,
                              0};
        else
          for (std::size_t n = 1; n < 6; ++n)
            if (chance(0.5)) piece.polynomial[n] = height * std::pow(s, static_cast<double>(n));
      }
      if (piece.polynomial[2] == 0) piece.polynomial[2] = bend;
      if (chance(0.6)) {
        const double height = tidy(size * uniform(-1, 1));
        piece.terms.push_back({0, height, chance(0.2) ? omega * decade(-2, 0) : 0,
                               chance(0.1) ? omega : omega * decade(-1, 1)});
      }
      if (chance(0.3))
        piece.terms.push_back({size * uniform(-1, 1), 0, omega * decade(-1, 1.5), 0});
      if (continuous || chance(0.5)) {
        piece.polynomial[0] = value;
        for (const Term& term : piece.terms) piece.polynomial[0] -= term.cosine;
      }
      begin += lasts;
      value = at_end(piece, lasts);
      pieces.push_back(piece);
    }
    return pieces;
  }
  /// Hand that moves and rests in turn along straight paths, by strokes or other functions; now and then bent.
  void strokes(Case& c) {
    c.mouse_velocity = c.across = {{0}, {0}};
    if (c.plate_load.value[0] == 0) c.plate_load.value[0] = 1;  // a stroke begins on a loaded plate
    if (chance(0.7)) c.velocity = 0;
    Function along, aside;
    double begin = 0;
    for (int left = static_cast<int>(uniform(1, 4)); left > 0; --left) {
      const double off = chance(0.1) ? 0 : chance(0.05) ? decade(-12, -2) : uniform(0, 1.5708);
      const double s = speed_;  // `off`: angle between the path and the transverse direction
      const double lasts = tidy(period_ * decade(-1, 1)), rests = tidy(period_ * decade(-1.5, 0.3));
      const double height = tidy(s * uniform(-16, 16)), rate = 1 / lasts;
      Piece stroke{begin, {}, {}};
      stroke.polynomial = {0,
                           0,
                           height * rate * rate,
                           -2 * height * rate * rate * rate,
                           height * rate * rate * rate * rate,
                           0};
      if (chance(0.2)) {  // a shaking hand
        stroke.polynomial = {};
        stroke.terms.push_back(
            {0, tidy(s), 0, 3.141592653589793 * std::round(uniform(1, 6)) / lasts});
      }
      const auto scaled = [&](double part) {
        Piece piece = stroke;
        for (double& p : piece.polynomial) p *= part;
        for (Term& t : piece.terms) t.sine *= part;
        return piece;
      };
      along.push_back(scaled(std::sin(off)));
      aside.push_back(scaled(std::cos(off)));
      if (chance(0.1) && !aside.back().terms.empty()) aside.back().terms[0].frequency *= 2;
      begin += lasts;
      for (Function* function : {&along, &aside}) function->push_back({begin, {}, {}});
      begin += rests;
    }
    c.functions[mouse_velocity] = along;
    c.functions[across_velocity] = aside;
    c.duration = begin + period_ * uniform(0.1, 2);
  }
  /// Load that begins at 1 and remains above zero: a sinusoid, a decay, or both.
  Function load(double omega) {
    const double depth = uniform(0, 0.95), part = chance(0.5) ? 1 : uniform(0, 1);
    Piece piece{0, {1 - depth * part, 0, 0, 0, 0, 0}, {}};
    if (part > 0) piece.terms.push_back({depth * part, 0, omega * decade(-1, 1.5), 0});
    if (part < 1) piece.terms.push_back({0, depth * (1 - part), 0, omega * decade(-1, 1)});
    return {piece};
  }
  static double at_end(const Piece& piece, double tau) {
    double value = 0;
    for (std::size_t n = 6; n-- > 0;) value = value * tau + piece.polynomial[n];
    for (const Term& t : piece.terms)
      value += (t.cosine * std::cos(t.frequency * tau) + t.sine * std::sin(t.frequency * tau)) *
               std::exp(-t.decay * tau);
    return value;
  }

  /// Laws on plate and rigid finger.
  void laws(Case& c) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (chance(0.3) || (i == 1 && !std::isinf(c.skin))) continue;
      c.curve[i] = {{0}, {c.curve[i].value[0]}};
      c.law[i] = {1 + static_cast<int>(uniform(0, 2.999)), force_ * decade(-2.5, 0),
                  tidy(speed_ * decade(-1.5, 0.5)),
                  chance(0.5) ? 0 : force_ / speed_ * decade(-3, 0)};
      c.limit[i] =
          (c.curve[i].value[0] + c.law[i].excess) * (chance(0.5) ? 1 : tidy(uniform(1, 2.5)));
    }
  }

  Rows curve() {
    Rows rows{{0}, {chance(0.15) ? 0 : force_ * decade(-2.5, 0.3)}};
    if (chance(0.65)) return rows;
    const int more = static_cast<int>(uniform(1, 4));
    for (int i = 0; i < more; ++i) {
      rows.at.push_back(rows.at.back() + tidy(speed_ * decade(-1.5, 0.3)));
      rows.value.push_back(tidy(force_ * decade(-2.5, 0)));
    }
    return rows;
  }

  /// From far below the speeds, where creep is thin, to beyond them; one in three rows is zero.
  Rows across() {
    const double size = speed_ * decade(chance(0.5) ? -2 : -8, 0.5);
    double last = 0;
    return profile([&] { return chance(0.3) ? 0 : tidy(size * uniform(-1, 1)); }, last);
  }

  /// Now and then a load steps: two rows at one time.
  template <class Value>
  Rows profile(Value&& value, double& last, double steps = 0) {
    Rows rows{{0}, {value()}};
    if (chance(0.4)) return rows;
    const int more = static_cast<int>(uniform(1, 6));
    for (int i = 0; i < more; ++i) {
      const bool steps_here = steps > 0 && i > 0 && rows.at[i - 1] < rows.at[i] && chance(steps);
      const double later = tidy(period_ * decade(-1.5, long_ ? 0.7 : 0.2));
      rows.at.push_back(rows.at.back() + (steps_here ? 0 : later));
      rows.value.push_back(chance(0.25) ? rows.value.back() : value());
    }
    last = std::max(last, rows.at.back());
    return rows;
  }

  Random random_;
  Family family_;
  bool round_{false}, long_{false};
  double force_{}, speed_{}, period_{};
};

}  // namespace fuzz
