/// Motion of a system of bodies from event to event.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "pindrive/bodies/expansion.hpp"
#include "pindrive/bodies/free_rates.hpp"
#include "pindrive/bodies/mode_selection.hpp"
#include "pindrive/bodies/system.hpp"
#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/callback.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::bodies {

/// Change of a contact at a time, s. At an impact a stop is met for an instant: it is open before and after.
template <class T>
struct Change {
  T time;
  int contact;
  Slip before, after;
};

/// Motion from an event or the end of another step on: polynomials in time.
template <class T>
class Step {
 public:
  using Real = detail::Real<T>;

  Step(const detail::Expansion<T>& series, const std::vector<Slip>& mode, T begin, T length,
       Real span)
      : series_(&series), mode_(&mode), begin_(begin), length_(length), span_(span) {}

  T begin() const { return begin_; }    ///< s
  T length() const { return length_; }  ///< s
  Real span() const { return span_; }   ///< unit of the time of the polynomials, s
  int order() const { return series_->order(); }
  Slip slip(int contact) const { return (*mode_)[contact]; }
  T position(int body, T tau) const { return at(series_->position(body), tau); }        ///< m
  T velocity(int body, T tau) const { return at(series_->velocity(body), tau); }        ///< m/s
  T acceleration(int body, T tau) const { return rate(series_->velocity(body), tau); }  ///< m/s²
  T stretch(int contact, T tau) const { return at(series_->stretch(contact), tau); }    ///< m
  T stretch_rate(int contact, T tau) const {
    return rate(series_->stretch(contact), tau);
  }  ///< m/s
  /// Friction force on `one`, N.
  T friction(int contact, T tau) const { return at(series_->friction(contact), tau); }
  /// Distance of `one` beyond the place where a stop touches, m, and the force with which the stop pushes, N.
  T depth(int stop, T tau) const { return at(series_->depth(stop), tau); }
  T push(int stop, T tau) const { return pushes(stop) ? at(series_->push(stop), tau) : T(0); }
  /// True of a stop that pushes.
  bool pushes(int stop) const { return stop_slip(stop) == Slip::stick; }
  Slip stop_slip(int stop) const { return (*mode_)[mode_->size() - series_->stops() + stop]; }
  /// Speed of `one` or of its skin over the surface, m/s.
  T sliding(int contact, T tau) const { return at(series_->sliding(contact), tau); }
  /// Force of a feedback on its first body, N; the integral of its error, m s, and the rate of that, m.
  T control(int feedback, T tau) const { return at(series_->control(feedback), tau); }
  T integral(int feedback, T tau) const { return at(series_->integral(feedback), tau); }
  T integral_rate(int feedback, T tau) const { return rate(series_->integral(feedback), tau); }

  using Series = typename detail::Expansion<T>::Series;
  const Series& position_series(std::size_t body) const { return series_->position(body); }
  const Series& velocity_series(std::size_t body) const { return series_->velocity(body); }
  const Series& push_series(std::size_t stop) const { return series_->push(stop); }
  const Series& control_series(std::size_t feedback) const { return series_->control(feedback); }
  const Series& stretch_series(std::size_t contact) const { return series_->stretch(contact); }
  const Series& friction_series(std::size_t contact) const { return series_->friction(contact); }
  const Series& sliding_series(std::size_t contact) const { return series_->sliding(contact); }

 private:
  T at(const Series& c, T tau) const {
    const T s = tau / span_;
    T sum = c[series_->order()];
    for (int n = series_->order(); n-- > 0;) sum = sum * s + c[n];
    return sum;
  }
  T rate(const Series& c, T tau) const {
    const T s = tau / span_;
    T sum = T(series_->order()) * c[series_->order()];
    for (int n = series_->order(); n-- > 1;) sum = sum * s + T(n) * c[n];
    return sum / span_;
  }

  const detail::Expansion<T>* series_;
  const std::vector<Slip>* mode_;
  T begin_, length_;
  Real span_;
};

/// Simulation of a system: state, slip of the contacts, and the steps, which are polynomials.
template <class T>
class Following {
 public:
  using Real = detail::Real<T>;
  using Mode = std::vector<Slip>;

  /// From a state on; a contact whose surfaces move apart slips, another one sticks where it can.
  Following(const System<T>& system, State<T> state)
      : system_(&system),
        state_(std::move(state)),
        series_(system),
        selection_(system),
        rates_(system),
        fastest_(rates_.largest()) {
    inputs_.read(system, state_.time);
    std::vector<int> active;
    for (std::size_t j = 0; j < system.contacts.size(); ++j) {
      const T speed = speed_of(static_cast<int>(j));
      const bool slips = system.contacts[j].rigid() && speed != 0;
      mode_.push_back(!slips ? Slip::stick : speed > 0 ? Slip::forward : Slip::backward);
      if (!slips) active.push_back(static_cast<int>(j));
    }
    struck_.assign(system.stops.size(), -std::numeric_limits<Real>::infinity());
    for (std::size_t s = 0; s < system.stops.size(); ++s) {
      mode_.push_back(Slip::backward);
      const Stop<T>& stop = system.stops[s];
      const T other = stop.other == ground ? T(0) : state_.position[stop.other];
      const T beyond = T(stop.side) * (state_.position[stop.one] - other - stop.position);
      using std::abs;
      const Real size = abs(plain(state_.position[stop.one])) + abs(plain(stop.position));
      if (plain(beyond) >= -16 * detail::rounding<Real> * size)
        active.push_back(static_cast<int>(system.contacts.size() + s));
    }
    state_.integral.resize(system.feedbacks.size());
    state_.held.resize(system.feedbacks.size());
    due_.assign(system.feedbacks.size(), state_.time);
    sample();
    settle(active);
    changes_.clear();  // the first mode is none
  }

  const State<T>& state() const { return state_; }
  const Mode& mode() const { return mode_; }
  const std::vector<Change<T>>& changes() const { return changes_; }
  Status status() const { return status_; }
  long steps() const { return steps_; }

  using Sink = Callback<const Step<T>&>;
  /// May shorten a step, whose length is given, and then returns false: an input changes there.
  using Cut = Callback<const Step<T>&, T&>;

  /// Goes on to a time, s; the status says if it was reached. `sink` is called with each step, and may return false to
  /// stop.
  void advance(T until, Sink sink = {}, Cut cut = {}) {
    while (status_ == Status::ok && state_.time < until)
      if (!step(until, sink, cut)) return;
  }
  /// Selects the mode under inputs that the caller has changed.
  void resume() {
    inputs_.read(*system_, state_.time);
    settle({});
  }
  /// The same, but ends where all bodies rest.
  void advance_to_rest(T until, Sink sink = {}) {
    while (status_ == Status::ok && state_.time < until && !resting()) step(until, sink);
  }
  /// True if rigid contacts hold all bodies at rest and no input changes any more: nothing moves from now on.
  bool resting() const {
    const auto& s = *system_;
    const auto holds = [&](const Feedback<T>& feedback) {
      const auto [error, rate] = error_of(feedback);
      const T held = state_.held[&feedback - s.feedbacks.data()];
      return inputs_.reference[&feedback - s.feedbacks.data()].steady() &&
             (feedback.integral == 0 || error == 0) &&
             (!feedback.sampled() || held == feedback.force(error, rate, T(0)));
    };
    return series_.all_held() &&
           !(s.next_breakpoint(state_.time) < std::numeric_limits<Real>::infinity()) &&
           std::all_of(s.feedbacks.begin(), s.feedbacks.end(), holds) &&
           all_of(inputs_.force, &Curve<T>::steady) && all_of(inputs_.length, &Curve<T>::steady) &&
           all_of(inputs_.load, &Curve<T>::steady) && all_of(inputs_.surface, &Curve<T>::is_zero);
  }

 private:
  static constexpr Real longest{
      2.5};  ///< step times the fastest rate: the rest of a series is below rounding
  static constexpr Real summed{16};  ///< roundings of the sum of a series
  static constexpr int fewest =
      InputPiece<T>::degree + 3;  ///< orders, of a force that is a polynomial

  /// Orders of a series over a span times the fastest rate: the first that leaves out less than rounding.
  static int order_over(Real span) {
    Real term{1};
    int n = 0;
    while (n < detail::series_order && (n < fewest || term > detail::rounding<Real> / 16))
      term *= span / Real(++n + 1);
    return n;
  }

  /// True of a body that a rigid contact or stop holds.
  bool is_held(int body) const {
    for (std::size_t j = 0; j < mode_.size(); ++j) {
      const Pair pair = system_->pair(j);
      if (body != ground && is_rigid(j) && mode_[j] == Slip::stick &&
          (pair.one == body || pair.other == body))
        return true;
    }
    return false;
  }
  static bool all_of(const std::vector<Curve<T>>& curves, bool (Curve<T>::*holds)() const) {
    return std::all_of(curves.begin(), curves.end(),
                       [&](const Curve<T>& curve) { return (curve.*holds)(); });
  }
  bool is_rigid(std::size_t j) const {
    const std::size_t contacts = system_->contacts.size();
    return j < contacts ? system_->contacts[j].rigid() : system_->stops[j - contacts].rigid();
  }
  T speed_of(int contact) const {
    const Contact<T>& c = system_->contacts[contact];
    const T other = c.other == ground ? T(0) : state_.velocity[c.other];
    return state_.velocity[c.one] - other - inputs_.surface[contact].value;
  }

  /// Longest step over which the terms of the inputs are their Taylor polynomials, s.
  Real input_reach() const {
    Real least = std::numeric_limits<Real>::infinity();
    inputs_.each([&](const Curve<T>& curve) {
      if (!curve.straight())
        least =
            std::min(least, curve.reach(T(0), detail::series_order, Real(detail::longest_input)));
    });
    return least;
  }
  /// False if the step was cut.
  bool step(T until, Sink sink, Cut cut = {}) {
    T breakpoint = std::min(system_->next_breakpoint(state_.time), until);
    for (const T& due : due_) breakpoint = std::min(breakpoint, due);
    const Real rest = plain(breakpoint - state_.time);
    const Real rate = std::max(
        rates_.in(mode_, [&](std::size_t j) { return series_.is_settled(j, state_, inputs_); }),
        Real(detail::longest_input) / input_reach());
    const Real span = std::min(rest, longest / rate);
    const int order = order_over(rate * span);
    series_.read(inputs_, state_.time, span, order);
    series_.expand(state_, inputs_, order);
    if (++steps_ > event_limit) status_ = Status::too_many_events;
    T tau = span == rest ? breakpoint - state_.time : T(span);
    std::vector<int> active;
    for (std::size_t j = 0; j < mode_.size(); ++j) {
      const T zero = zero_of(static_cast<int>(j), span);
      if (!(zero <= tau)) continue;
      if (zero < tau - detail::rounding<T> * (state_.time + tau)) active.clear();
      tau = zero;
      active.push_back(static_cast<int>(j));
    }
    const bool goes_on = cut(Step<T>(series_, mode_, state_.time, tau, span), tau);
    if (!goes_on) active.clear();
    const bool whole = span == rest && active.empty() && goes_on;
    standing_ = state_.time + tau > state_.time ? 0 : standing_ + 1;
    if (standing_ > detail::standstill_limit) status_ = Status::standstill;
    if (!sink(Step<T>(series_, mode_, state_.time, tau, span))) status_ = Status::stopped;
    move(tau, whole ? breakpoint : state_.time + tau, span);
    if (sample() || !active.empty() || whole) settle(active);
    return goes_on;
  }

  /// Takes the samples of feedbacks that are due; false if none is.
  bool sample() {
    bool taken = false;
    for (std::size_t f = 0; f < due_.size(); ++f) {
      const Feedback<T>& feedback = system_->feedbacks[f];
      if (!feedback.sampled()) due_[f] = std::numeric_limits<Real>::infinity();
      if (!(due_[f] <= state_.time)) continue;
      taken = true;
      due_[f] = next_sample(feedback.period, plain(state_.time));
      const auto [error, rate] = error_of(feedback);
      state_.integral[f] += T(feedback.period) * error;
      state_.held[f] = feedback.force(error, rate, state_.integral[f]);
    }
    return taken;
  }
  /// First multiple of a period after a time, s.
  static Real next_sample(Real period, Real time) {
    using std::floor;
    Real count = floor(time / period);
    while (!(count * period > time)) ++count;
    return count * period;
  }
  /// Error of a feedback and its rate, m and m/s.
  std::pair<T, T> error_of(const Feedback<T>& feedback) const {
    const Curve<T>& reference = inputs_.reference[&feedback - system_->feedbacks.data()];
    const auto part = [&](int body, const std::vector<T>& of) {
      return body == ground ? T(0) : of[body];
    };
    const auto apart = [&](const std::vector<T>& of) {
      return part(feedback.measured, of) - part(feedback.against, of);
    };
    return {reference.value - apart(state_.position), reference.rate - apart(state_.velocity)};
  }

  /// First time at which a guard of a contact becomes negative, s; infinite within the step if none.
  T zero_of(int contact, Real span) const {
    if (series_.is_stop(contact)) return zero_of_stop(contact, span);
    const int side = static_cast<int>(mode_[contact]);
    detail::Polynomial<T> guard;
    guard.span = span;
    guard.degree = series_.order();
    T first = std::numeric_limits<T>::infinity();
    Real size{0};  // both terms of a guard together
    const auto add = [&](const auto& series) {
      for (int n = 0; n <= guard.degree; ++n) size += std::abs(plain(series[n]));
    };
    const auto look = [&](int way) {
      if (selection_.stays_zero(contact, way)) return;
      Real rest{0};  // most that the guard can fall over the step
      for (int n = 1; n <= guard.degree; ++n) rest += std::max(Real(0), -plain(guard.c[n]));
      if (plain(guard.c[0]) > rest) return;
      first = std::min(first, detail::zero_beyond(guard, detail::rounding<Real> * size));
    };
    if (side != 0) {
      const Contact<T>& c = system_->contacts[contact];
      for (int n = 0; n <= guard.degree; ++n) guard.c[n] = T(side) * series_.sliding(contact)[n];
      add(guard.c);
      add(series_.velocity(c.one));
      if (c.other != ground) add(series_.velocity(c.other));
      look(side);
      return first;
    }
    add(series_.friction(contact));
    for (const int way : {1, -1}) {
      for (int n = 0; n <= guard.degree; ++n)
        guard.c[n] = series_.limit(contact, n) - T(way) * series_.friction(contact)[n];
      look(way);
    }
    return first;
  }

  T zero_of_stop(int j, Real span) const {
    const std::size_t s = series_.stop_of(j);
    const Stop<T>& stop = system_->stops[s];
    detail::Polynomial<T> guard;
    guard.span = span;
    guard.degree = series_.order();
    T first = std::numeric_limits<T>::infinity();
    using std::abs;
    const auto look = [&](const auto& series, int sign, int kind, Real size) {
      if (selection_.stays_zero(j, kind)) return;
      for (int n = 0; n <= guard.degree; ++n) guard.c[n] = T(sign) * series[n];
      Real rest{0};
      for (int n = 1; n <= guard.degree; ++n) rest += std::max(Real(0), -plain(guard.c[n]));
      if (plain(guard.c[0]) > rest) return;
      first = std::min(first, detail::zero_beyond(guard, detail::rounding<Real> * size));
    };
    Real place = abs(plain(stop.position)), force{0};
    for (int n = 0; n <= guard.degree; ++n) {
      place += abs(plain(series_.position(stop.one)[n]));
      if (stop.other != ground) place += abs(plain(series_.position(stop.other)[n]));
      force += abs(plain(series_.push(s)[n]));
    }
    if (!stop.rigid()) force += plain(stop.stiffness) * place;
    const Slip slip = mode_[j];
    if (slip != Slip::stick) look(series_.depth(s), slip == Slip::backward ? -1 : 1, -1, place);
    if (slip != Slip::backward) look(series_.push(s), slip == Slip::stick ? 1 : -1, 1, force);
    return first;
  }

  void move(T tau, T time, Real span) {
    using std::abs;
    const Real late = detail::rounding<Real> * std::abs(plain(time));
    const auto move_to = [&](const auto& series, T& value, Real& error) {
      const T s = tau / span;
      T sum = series[series_.order()], rate{0};
      Real size = abs(plain(sum));  // sum of the sizes of all terms
      for (int n = series_.order(); n-- > 0;) {
        rate = rate * s + sum;
        sum = sum * s + series[n];
        size = size * plain(s) + abs(plain(series[n]));
      }
      value = sum;
      error = late * abs(plain(rate)) / span + summed * detail::rounding<Real> * size;
    };
    auto& errors = state_.errors;
    errors.position.resize(state_.position.size());
    errors.velocity.resize(state_.velocity.size());
    errors.stretch.resize(state_.stretch.size());
    errors.integral.resize(state_.integral.size());
    for (std::size_t i = 0; i < state_.position.size(); ++i) {
      move_to(series_.position(i), state_.position[i], errors.position[i]);
      move_to(series_.velocity(i), state_.velocity[i], errors.velocity[i]);
    }
    for (std::size_t j = 0; j < state_.stretch.size(); ++j)
      if (!system_->contacts[j].rigid())
        move_to(series_.stretch(j), state_.stretch[j], errors.stretch[j]);
    for (std::size_t f = 0; f < state_.integral.size(); ++f)
      if (!system_->feedbacks[f].sampled())
        move_to(series_.integral(f), state_.integral[f], errors.integral[f]);
    state_.time = time;
    inputs_.read(*system_, time);
  }

  /// Selects the mode after an event; a rigid contact whose sliding came to zero then has exactly none.
  void settle(std::vector<int> active) {
    const Mode before = mode_;
    for (const int contact : active) {
      if (series_.is_stop(contact)) continue;
      const Contact<T>& c = system_->contacts[contact];
      if (!c.rigid() || mode_[contact] == Slip::stick || is_held(c.one) || is_held(c.other))
        continue;
      const T error = speed_of(contact), part = part_of_one(c.one, c.other);
      state_.velocity[c.one] -= part * error;
      if (c.other != ground) state_.velocity[c.other] += (1 - part) * error;
    }
    const std::vector<int> hit = strike(active);
    if (!hit.empty()) slip_after_impact(active);
    const Real step = fastest_ > 0 ? 1 / fastest_ : Real(1);
    if (!selection_.select(state_, inputs_, active, step, mode_)) status_ = Status::inconsistent;
    series_.set(mode_, inputs_);
    for (std::size_t j = 0; j < mode_.size(); ++j)
      if (mode_[j] != before[j] ||
          std::find(hit.begin(), hit.end(), static_cast<int>(j)) != hit.end())
        changes_.push_back({state_.time, static_cast<int>(j), before[j], mode_[j]});
  }

  /// Impacts at rigid stops: Newton's law at each place where bodies touch, the fastest first, until none approach any
  /// more. Contacts hold no impulse, as friction has a limit. Returns the stops that are hit.
  std::vector<int> strike(const std::vector<int>& active) {
    std::vector<int> touching, hit;
    for (std::size_t s = 0; s < system_->stops.size(); ++s) {
      const int j = static_cast<int>(system_->contacts.size() + s);
      const bool met = std::find(active.begin(), active.end(), j) != active.end() || touches(s);
      if (!system_->stops[s].rigid() || (!met && mode_[j] != Slip::stick)) continue;
      if (met) place_at(s);
      touching.push_back(j);
    }
    for (int n = 0; n < most_impacts; ++n) {
      int next = -1;
      T fastest{0};
      for (const int j : touching) {
        const T speed = approach(j);
        if (speed > fastest) {
          fastest = speed;
          next = j;
        }
      }
      if (next < 0) break;
      const std::size_t s = series_.stop_of(next);
      push_apart(
          s,
          !comes_to_rest(s, fastest) && 2 * n < most_impacts ? system_->stops[s].restitution : T(0),
          fastest);
      if (std::find(hit.begin(), hit.end(), next) == hit.end()) hit.push_back(next);
    }
    for (const int j : hit) struck_[series_.stop_of(j)] = plain(state_.time);
    return hit;
  }
  /// True if both bodies of a rigid stop touch, within the rounding of their places and of the time.
  bool touches(std::size_t s) const {
    using std::abs;
    const Stop<T>& stop = system_->stops[s];
    Real error = 16 * detail::rounding<Real> * abs(plain(stop.position));
    const auto place = [&](int body) {
      if (body == ground) return T(0);
      const T x = state_.position[body];
      const auto& errors = state_.errors.position;
      error +=
          16 * detail::rounding<Real> * abs(plain(x)) + (errors.empty() ? Real(0) : errors[body]);
      return x;
    };
    const T depth = T(stop.side) * (place(stop.one) - place(stop.other) - stop.position);
    return plain(depth) >= -error;
  }
  /// Moves the bodies of a stop that was met to where they touch, within the rounding of its time.
  void place_at(std::size_t s) {
    const Stop<T>& stop = system_->stops[s];
    if (is_held(stop.one) || (stop.other != ground && is_held(stop.other))) return;
    const T other = stop.other == ground ? T(0) : state_.position[stop.other];
    const T error = state_.position[stop.one] - other - stop.position;
    const T part = part_of_one(stop.one, stop.other);
    state_.position[stop.one] -= part * error;
    if (stop.other != ground) state_.position[stop.other] += (1 - part) * error;
  }
  /// Part of a change of distance that the first of two bodies takes, by their masses.
  T part_of_one(int one, int other) const {
    if (other == ground) return T(1);
    const T first = 1 / system_->bodies[one].mass, second = 1 / system_->bodies[other].mass;
    return first / (first + second);
  }
  /// Speed at which both bodies of a rigid stop approach, m/s; zero within rounding.
  T approach(int j) const {
    using std::abs;
    const Stop<T>& stop = system_->stops[series_.stop_of(j)];
    const T one = state_.velocity[stop.one];
    const T other = stop.other == ground ? T(0) : state_.velocity[stop.other];
    const T speed = T(stop.side) * (one - other);
    const Real error = 16 * detail::rounding<Real> * (abs(plain(one)) + abs(plain(other)));
    return plain(speed) > error ? speed : T(0);
  }
  /// True of a stop whose bounces, each shorter by the restitution, end within the resolution of time, or no longer lift
  /// the bodies beyond the rounding of their places.
  bool comes_to_rest(std::size_t s, T speed) const {
    using std::abs;
    const Stop<T>& stop = system_->stops[s];
    const Real e = plain(stop.restitution), lasted = plain(state_.time) - struck_[s];
    const Real error = 1024 * detail::rounding<Real> * plain(state_.time) +
                       (fastest_ > 0 ? Real(1e-12) / fastest_ : 0);
    Real place = abs(plain(stop.position)) + abs(plain(state_.position[stop.one]));
    if (stop.other != ground) place += abs(plain(state_.position[stop.other]));
    const Real height = e * e * lasted * plain(speed) / 4;
    if (lasted == 0) return false;  // a third body struck it
    return lasted * e < (1 - e) * error || height < 16 * detail::rounding<Real> * place;
  }
  /// Ends the approach of both bodies of a stop; they part with a part of its speed.
  void push_apart(std::size_t s, T restitution, T speed) {
    const Stop<T>& stop = system_->stops[s];
    const T one = 1 / system_->bodies[stop.one].mass;
    const T other = stop.other == ground ? T(0) : 1 / system_->bodies[stop.other].mass;
    const T impulse = T(stop.side) * (1 + restitution) * speed / (one + other);
    state_.velocity[stop.one] -= one * impulse;
    if (stop.other != ground) state_.velocity[stop.other] += other * impulse;
  }
  /// Sets the slip of rigid contacts to which an impact has given a speed; these are no longer `active`.
  void slip_after_impact(std::vector<int>& active) {
    using std::abs;
    for (std::size_t j = 0; j < system_->contacts.size(); ++j) {
      const Contact<T>& c = system_->contacts[j];
      if (!c.rigid()) continue;
      const T speed = speed_of(static_cast<int>(j));
      Real size = abs(plain(state_.velocity[c.one]));
      if (c.other != ground) size += abs(plain(state_.velocity[c.other]));
      if (!(abs(plain(speed)) > 64 * detail::rounding<Real> * size)) continue;
      mode_[j] = speed > 0 ? Slip::forward : Slip::backward;
      active.erase(std::remove(active.begin(), active.end(), static_cast<int>(j)), active.end());
    }
  }

  static constexpr int most_impacts = 2000;  ///< at an instant; the second half is plastic

  const System<T>* system_;
  State<T> state_;
  detail::InputsAt<T> inputs_;
  Mode mode_;
  detail::Expansion<T> series_;
  detail::ModeSelection<T> selection_;
  detail::FreeRates<T> rates_;
  Real fastest_;  ///< in any mode, 1/s
  std::vector<Change<T>> changes_;
  std::vector<Real> struck_;  ///< time of the last impact at each stop, s
  std::vector<T> due_;        ///< time of the next sample of each feedback, s; infinite: none
  Status status_{Status::ok};
  long steps_{0};
  int standing_{0};  ///< events at this time
};

}  // namespace pindrive::bodies
