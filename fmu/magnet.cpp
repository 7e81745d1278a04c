#include "magnet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "interface.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive_fmu {

namespace {

using pindrive::detail::exp;
using pindrive::detail::expm1;
using pindrive::detail::log;
using pindrive_c::check;
using pindrive_c::fail;

constexpr double infinity = std::numeric_limits<double>::infinity();

// The constants and formulas of pindrive.device.coil, closing, heating and electromagnet.
constexpr double magnetic_constant = 1.25663706127e-6, copper = 1 / 58e6, copper_rise = 3.93e-3;
constexpr double pi = 0x1.921fb54442d18p+1;
constexpr double at_once = 0.01;  // time after a switching from which the pull is exact

/// Flux linkage that tends to `target`, a number of time constants later.
double flux_after(double start, double target, double constants) {
  const double left = exp(-constants);
  return target == 1 ? 1 - (1 - start) * left : target + (start - target) * left;
}

}  // namespace

// ---- how it is made ----------------------------------------------------------------------------

Number Magnet::first_load(const Given& given) {
  return 1 + given.of("magnet.residual") / given.plate_normal_force();
}

pindrive_error Magnet::begin(const Given& given, double time) {
  present_ = given.has("magnet.residual");
  if (!present_) return PINDRIVE_OK;
  if (const pindrive_error error = read(given)) return error;
  make_levels();
  state_ = {};
  state_.since = time;
  state_.pull = residual_;
  make_rows();
  return PINDRIVE_OK;
}

pindrive_error Magnet::read(const Given& given) {
  const auto number = [&](const char* name, double otherwise = 0) {
    return given.of(name, otherwise).value;
  };
  pindrive_error error = PINDRIVE_OK;
  const auto allow = [&](const char* name, double value, bool good, const char* allowed) {
    if (!error) error = check(name, value, good, allowed);
  };
  const auto positive = [&](const char* name, double value) {
    allow(name, value, value > 0 && value < infinity, "above 0 and finite");
  };
  steps_.clear();
  heat_capacity_ = edge_ = 0;
  opened_ = 1;
  if (given.has("magnet.turns")) {
    error = read_coil(given);
  } else {
    const double rise = number("magnet.rise_time"), fall = number("magnet.fall_time");
    saturation_ = number("magnet.saturation");
    hold_force_ = number("magnet.hold_force");
    allow("magnet.saturation", saturation_, saturation_ > 0 && saturation_ <= 1,
          "above 0 and at most 1");
    positive("magnet.rise_time", rise);
    positive("magnet.fall_time", fall);
    positive("magnet.hold_force", hold_force_);
    rise_constant_ = -rise / log(1 - saturation_ * std::sqrt(0.9));
    fall_constant_ = -fall / log(saturation_ * std::sqrt(0.1));
  }
  residual_ = number("magnet.residual");
  allow("magnet.residual", residual_, residual_ >= 0 && residual_ < hold_force_,
        "at least 0 and less than the full pull");
  if (given.has("magnet.lift")) {
    const double lift = number("magnet.lift"), force = number("magnet.closing_force");
    allow("magnet.lift", lift, lift >= 0 && lift < infinity, "at least 0 and finite");
    opened_ = number("magnet.gap") / (number("magnet.gap") + lift);
    edge_ = saturation_ * std::sqrt((force - residual_) / (hold_force_ - residual_));
    allow("magnet.closing_force", force,
          force > residual_ && force < pull_of(opened_) && edge_ < opened_,
          "more than the residual pull and less than that with the open gap");
  }
  deviation_ = number("magnet.deviation", 1e-4);
  allow("magnet.deviation", deviation_, deviation_ >= 1e-8 && deviation_ <= 0.1,
        "from 1e-8 to 0.1");
  tolerance_ = (1 - 5 * at_once) * deviation_ * hold_force_ / (hold_force_ - residual_);
  duty_ = number("magnet.pwm_duty", 1);
  allow("magnet.pwm_duty", duty_, duty_ > 0 && duty_ <= 1, "above 0 and at most 1");
  frequency_ = number("magnet.pwm_frequency", 1);
  allow("magnet.pwm_frequency", frequency_, frequency_ >= 1 && frequency_ <= 2e4,
        "from 1 to 20000");
  normal_force_ = given.plate_normal_force().value;
  positive("weight and plate.preload", normal_force_);
  return error;
}

pindrive_error Magnet::read_coil(const Given& given) {
  constexpr const char* positive[] = {"magnet.turns",
                                      "magnet.pole_area",
                                      "magnet.gap",
                                      "magnet.wire_diameter",
                                      "magnet.turn_length",
                                      "magnet.supply_voltage",
                                      "magnet.saturation_field",
                                      "magnet.thermal_resistance"};
  double values[8];
  for (int i = 0; i < 8; ++i) {
    values[i] = given.of(positive[i]).value;
    const bool good = values[i] > 0 && values[i] < infinity;
    if (const pindrive_error error = check(positive[i], values[i], good, "above 0 and finite"))
      return error;
  }
  const auto [turns, area, gap, wire, length, voltage, most, thermal] = values;
  outer_resistance_ = given.of("magnet.release_resistance").value;
  heat_capacity_ = given.of("magnet.heat_capacity").value;
  for (const auto& [name, value] : {std::pair{"magnet.release_resistance", outer_resistance_},
                                    std::pair{"magnet.heat_capacity", heat_capacity_}})
    if (const pindrive_error error =
            check(name, value, value >= 0 && value < infinity, "at least 0 and finite"))
      return error;
  own_resistance_ = copper * turns * length / (pi / 4 * wire * wire);
  const double inductance = magnetic_constant * turns * turns * area / (2 * gap);
  const double full = voltage / own_resistance_;
  const double field = magnetic_constant * turns * full / (2 * gap);
  const double reached = std::min(field, most);
  saturation_ = std::min(1.0, most / field);
  hold_force_ = reached * reached * area / magnetic_constant;
  rise_constant_ = inductance / own_resistance_;
  fall_constant_ = inductance / (own_resistance_ + outer_resistance_);
  power_ = voltage * full;
  cooling_resistance_ = thermal;
  const auto times = given.rows("magnet.voltage.time"), volts = given.rows("magnet.voltage.value");
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Row step{times[i].value, volts[i].value / voltage};
    const bool later = i == 0 ? step.time == 0 : step.time > steps_[i - 1].time;
    const bool within = step.pull >= 0 && step.pull <= 1;
    if (!later || !within)
      return fail(
          PINDRIVE_BAD_VALUE,
          "magnet.voltage must begin at 0 s, its times increase, and be from 0 V to %.17g V",
          voltage);
    steps_.push_back(step);
  }
  return PINDRIVE_OK;
}

/// The flux linkages at which rows of the pull are due as it rises from 0 or falls from 1.
void Magnet::make_levels() {
  const auto curvature = [](double c) {
    const double e = 1 - c;
    return std::max(std::abs(2 * e * (2 * e - 1)), e > 0.25 ? 0.25 : 0.0);
  };
  rising_.clear();
  double c = 0;
  while (saturation_ < 1 ? c < saturation_ : 1 - c * c > tolerance_) {
    c = 1 - (1 - c) * exp(-saturation_ * std::sqrt(8 * tolerance_ / curvature(c)));
    rising_.push_back(saturation_ < 1 ? std::min(c, saturation_) : c);
  }
  falling_.clear();
  if (saturation_ < 1) falling_.push_back(1);
  for (c = saturation_;; c *= exp(-saturation_ * std::sqrt(2 * tolerance_) / c)) {
    falling_.push_back(c);
    if ((c / saturation_) * (c / saturation_) <= tolerance_) break;
  }
}

// ---- switching ---------------------------------------------------------------------------------

void Magnet::command(bool on, double time) {
  if (on == (state_.command != 0)) return;
  state_.command = on ? 1 : 0;
  if (!on) {
    if (state_.on) change(false, 1, time);
    return;
  }
  state_.commanded = time;
  state_.step = 0;
  if (!steps_.empty()) return change(true, steps_[0].pull, time);
  if (duty_ == 1) return change(true, 1, time);
  state_.period = std::floor(time * frequency_);
  if ((state_.period + duty_) / frequency_ > time)
    change(true, 1, time);
  else
    state_.period += 1;
}

double Magnet::next_switching() const {
  if (!state_.command) return infinity;
  if (!steps_.empty())
    return state_.step + 1 < steps_.size() ? state_.commanded + steps_[state_.step + 1].time
                                           : infinity;
  if (duty_ == 1) return infinity;
  return (state_.on ? state_.period + duty_ : state_.period) / frequency_;
}

double Magnet::next() const {
  const double row = state_.row + 1 < rows_.size() ? rows_[state_.row + 1].time : infinity;
  return std::min({row, piece().end, next_switching()});
}

void Magnet::pass(double until) {
  for (double time = next(); time <= until; time = next()) {
    const double switching = next_switching(), crossing = piece().end;
    if (time < std::min(switching, crossing)) {
      ++state_.row;
    } else if (crossing < switching) {
      change(state_.on != 0, state_.level, crossing);
    } else if (!steps_.empty()) {
      change(true, steps_[++state_.step].pull, time);
    } else {
      if (state_.on) state_.period += 1;
      change(!state_.on, 1, time);
    }
  }
}

/// Switches it, or closes or opens its gap: the pull goes on from its line, the flux from what it is.
void Magnet::change(bool on, double level, double time) {
  const double pulling = this->pull(time), linked = flux(time), warm = warming(time);
  state_.since = time;
  state_.flux = linked;
  state_.pull = pulling;
  state_.warming = warm;
  state_.on = on ? 1 : 0;
  state_.level = level;
  state_.row = 0;
  make_rows();
}

pindrive_error Magnet::go_back(const CoilState& state) {
  const auto part = [](double number) { return number >= 0 && number <= 1; };
  const auto finite = [](auto... numbers) { return (std::isfinite(numbers) && ...); };
  if (!part(state.flux) || !part(state.level) || !(state.warming >= 0) ||
      !finite(state.since, state.pull, state.warming, state.commanded, state.period))
    return fail(PINDRIVE_BAD_VALUE, "the bytes must be those of a state of this unit");
  state_ = state;
  make_rows();
  state_.row = std::min<std::uint64_t>(state_.row, rows_.size() - 1);
  return PINDRIVE_OK;
}

// ---- what follows ------------------------------------------------------------------------------

double Magnet::resistance() const {
  return heat_capacity_ > 0 ? 1 + copper_rise * state_.warming : 1;
}

/// Just where the gap closes or opens, the flux's way tells which it does.
Magnet::Piece Magnet::piece() const {
  const double start = state_.flux, r = resistance();
  double target = 0, constant = fall_constant_;
  if (state_.on) {
    target = 1 / r * state_.level;
    constant = rise_constant_ / r;
  } else if (r != 1) {
    constant = fall_constant_ * (own_resistance_ + outer_resistance_) /
               (r * own_resistance_ + outer_resistance_);
  }
  const bool closed = start > edge_ || (start == edge_ && target > edge_);
  const double inductance = closed ? 1 : opened_;
  target *= inductance;
  constant *= inductance;
  const bool crosses = closed ? start > edge_ && edge_ > target : start < edge_ && edge_ < target;
  const double lasts = crosses ? constant * log((start - target) / (edge_ - target)) : infinity;
  return {target, constant, inductance, state_.since + lasts};
}

/// At a closing or opening of the gap it equals that linkage to the bit, on which piece() relies.
double Magnet::flux(double time) const {
  const Piece piece = this->piece();
  if (time == piece.end) return edge_;
  return flux_after(state_.flux, piece.target, (time - state_.since) / piece.constant);
}

double Magnet::current(double time) const { return flux(time) / piece().inductance; }

double Magnet::warming(double time) const {
  if (heat_capacity_ == 0) return 0;
  const Piece piece = this->piece();
  const double constant = piece.constant, target = piece.target / piece.inductance;
  const double lasts = time - state_.since, swing = state_.flux / piece.inductance - target;
  const double cooling = 1 / (cooling_resistance_ * heat_capacity_);
  const double heating = power_ * resistance() / heat_capacity_;
  const double shares[] = {target * target, 2 * target * swing, swing * swing};
  double found = state_.warming * exp(-cooling * lasts);
  for (int i = 0; i < 3; ++i) {
    const double rate = i / constant, apart = std::abs(cooling - rate) * lasts;
    const double mean = apart > 0 ? -expm1(-apart) / apart : 1;
    found += heating * shares[i] * lasts * exp(-std::min(rate, cooling) * lasts) * mean;
  }
  return found;
}

double Magnet::pull_of(double flux) const {
  const double part = flux / saturation_;
  return residual_ + (hold_force_ - residual_) * std::min(part * part, 1.0);
}

double Magnet::rate() const {
  if (state_.row + 1 >= rows_.size()) return 0;
  const Row &from = rows_[state_.row], &to = rows_[state_.row + 1];
  return to.time > from.time ? (to.pull - from.pull) / (to.time - from.time) : 0;
}

double Magnet::pull(double time) const {
  if (rows_.empty()) return state_.pull;
  const Row& from = rows_[state_.row];
  return from.pull + rate() * (time - from.time);
}

/// Rows linear between which the pull is nowhere further from the exact one than the deviation.
void Magnet::make_rows() {
  const Piece piece = this->piece();
  const double start = state_.flux, target = piece.target, constant = piece.constant;
  rows_.assign(1, {state_.since, state_.pull});
  if (start == target) return;
  if (target != 0 && target != 1) return make_rows_between(piece);
  double last = 0;
  const auto add = [&](double after, double flux) {
    rows_.push_back({state_.since + constant * after, pull_of(flux)});
    last = after;
  };
  const bool rises = target == 1;
  const double moment = at_once * saturation_ * tolerance_;
  const double soon = flux_after(start, target, moment);
  add(moment, soon);
  for (const double level : rises ? rising_ : falling_) {
    if (rises ? level <= soon : level >= soon) continue;
    const double after = log(rises ? (1 - start) / (1 - level) : start / level);
    if (after > 2 * moment) add(after, level);
  }
  add(last + 1, target);
}

/// Times and currents of a flux that tends to a partial value.
void Magnet::make_rows_between(const Piece& piece) {
  const double start = state_.flux, target = piece.target, constant = piece.constant;
  const double sigma = saturation_, swing = start - target;
  const double kink =
      (start > sigma) != (target > sigma) ? log(swing / (sigma - target)) : infinity;
  double x = at_once * sigma * tolerance_;
  const auto add = [&](double after, double flux) {
    rows_.push_back({state_.since + constant * after, pull_of(flux)});
  };
  const auto due = [&] { add(x, target + swing * exp(-x)); };
  for (due();; due()) {
    const double left = exp(-x), c = target + swing * left;
    if (x < kink && c >= sigma) {  // saturated until then, or forever
      if (kink == infinity) break;
      x = kink;
      continue;
    }
    if (x >= kink && target >= sigma) break;
    const double bend = 2 * std::abs(target * swing) * left;
    const double size = 4 * (swing * left) * (swing * left) + bend;
    if (bend + (swing * left) * (swing * left) <= tolerance_ * sigma * sigma) break;
    const double step = x + sigma * std::sqrt(8 * tolerance_ / size);
    x = x < kink && kink <= step ? kink : step;
  }
  add(x + 1, target);
}

}  // namespace pindrive_fmu
