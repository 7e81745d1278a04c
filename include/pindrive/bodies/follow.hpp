/// Motion of a system of bodies from event to event.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "pindrive/bodies/expansion.hpp"
#include "pindrive/bodies/mode_selection.hpp"
#include "pindrive/bodies/system.hpp"
#include "pindrive/flow/polynomial.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/callback.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::bodies {

/// Change of a contact at a time, s.
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
  /// Speed of `one` or of its skin over the surface, m/s.
  T sliding(int contact, T tau) const { return at(series_->sliding(contact), tau); }

  using Series = typename detail::Expansion<T>::Series;
  const Series& position_series(std::size_t body) const { return series_->position(body); }
  const Series& velocity_series(std::size_t body) const { return series_->velocity(body); }
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

/// A system under way: its state, the slip of its contacts, and its steps, whose polynomials are its motion.
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
        fastest_(fastest_of(system)) {
    std::vector<int> active;
    for (std::size_t j = 0; j < system.contacts.size(); ++j) {
      const T speed = speed_of(static_cast<int>(j));
      const bool slips = system.contacts[j].rigid() && speed != 0;
      mode_.push_back(!slips ? Slip::stick : speed > 0 ? Slip::forward : Slip::backward);
      if (!slips) active.push_back(static_cast<int>(j));
    }
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
  void resume() { settle({}); }
  /// The same, but ends where all bodies rest.
  void advance_to_rest(T until, Sink sink = {}) {
    while (status_ == Status::ok && state_.time < until && !resting()) step(until, sink);
  }
  /// True if rigid contacts hold all bodies at rest and no input changes any more: nothing moves from now on.
  bool resting() const {
    const auto constant = [&](const Profile<T>& input, bool zero) {
      const Curve<T> now = input.from(state_.time);
      return now.straight() && now.rate == 0 && (!zero || now.value == 0);
    };
    const auto& s = *system_;
    return series_.all_held() &&
           !(s.next_breakpoint(state_.time) < std::numeric_limits<Real>::infinity()) &&
           std::all_of(s.bodies.begin(), s.bodies.end(),
                       [&](const Body<T>& body) { return constant(body.force, false); }) &&
           std::all_of(s.links.begin(), s.links.end(),
                       [&](const Link<T>& link) { return constant(link.length, false); }) &&
           std::all_of(s.contacts.begin(), s.contacts.end(), [&](const Contact<T>& c) {
             return constant(c.load, false) && constant(c.velocity, true);
           });
  }

 private:
  static constexpr Real longest{
      2.5};  ///< step times the fastest rate: the rest of a series is below rounding
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

  /// Bound of the rates of all free motions, 1/s: of the springs by the largest row sum, and so of the dampers.
  static Real fastest_of(const System<T>& system) {
    using std::sqrt;
    const std::size_t count = system.bodies.size();
    std::vector<Real> stiff(count), damped(count);
    Real skin{0};
    const auto add = [&](int one, int other, Real stiffness, Real damping) {
      for (const bool first : {true, false}) {
        const int i = first ? one : other, j = first ? other : one;
        if (i == ground) continue;
        const Real m = plain(system.bodies[i].mass);
        const Real both = j == ground ? m : sqrt(m * plain(system.bodies[j].mass));
        const Real part = 1 / m + (j == ground ? Real(0) : 1 / both);
        stiff[i] += stiffness * part;
        damped[i] += damping * part;
      }
    };
    for (const Link<T>& link : system.links)
      add(link.one, link.other, plain(link.stiffness), plain(link.damping));
    for (const Contact<T>& c : system.contacts) {
      if (c.rigid()) continue;
      add(c.one, c.other, plain(c.stiffness), plain(c.damping));
      if (c.damping != 0) skin = std::max(skin, plain(c.stiffness / c.damping));
    }
    Real fastest = skin;
    for (std::size_t i = 0; i < count; ++i)
      fastest = std::max(fastest, Real(sqrt(stiff[i])) + damped[i]);
    return fastest;
  }

  /// True of a body that a rigid contact holds.
  bool is_held(int body) const {
    for (std::size_t j = 0; j < mode_.size(); ++j) {
      const Contact<T>& c = system_->contacts[j];
      if (body != ground && c.rigid() && mode_[j] == Slip::stick &&
          (c.one == body || c.other == body))
        return true;
    }
    return false;
  }
  T speed_of(int contact) const {
    const Contact<T>& c = system_->contacts[contact];
    const T other = c.other == ground ? T(0) : state_.velocity[c.other];
    return state_.velocity[c.one] - other - c.velocity.from(state_.time).value;
  }

  /// False if the step was cut.
  bool step(T until, Sink sink, Cut cut = {}) {
    const T breakpoint = std::min(system_->next_breakpoint(state_.time), until);
    const Real rest = plain(breakpoint - state_.time);
    const Real rate =
        std::max(fastest_, Real(detail::longest_input) / series_.input_reach(state_.time));
    const Real span = std::min(rest, longest / rate);
    series_.expand(state_, span, order_over(rate * span));
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
    if (!active.empty() || whole) settle(active);
    return goes_on;
  }

  /// First time at which a guard of a contact becomes negative, s; infinite within the step if none.
  T zero_of(int contact, Real span) const {
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

  void move(T tau, T time, Real span) {
    const Real late = detail::rounding<Real> * std::abs(plain(time));
    const auto move_to = [&](const auto& series, T& value, Real& error) {
      const T s = tau / span;
      T sum = series[series_.order()], rate{0};
      for (int n = series_.order(); n-- > 0;) {
        rate = rate * s + sum;
        sum = sum * s + series[n];
      }
      value = sum;
      error = late * std::abs(plain(rate)) / span;
    };
    auto& errors = state_.errors;
    errors.position.resize(state_.position.size());
    errors.velocity.resize(state_.velocity.size());
    errors.stretch.resize(state_.stretch.size());
    for (std::size_t i = 0; i < state_.position.size(); ++i) {
      move_to(series_.position(i), state_.position[i], errors.position[i]);
      move_to(series_.velocity(i), state_.velocity[i], errors.velocity[i]);
    }
    for (std::size_t j = 0; j < state_.stretch.size(); ++j)
      if (!system_->contacts[j].rigid())
        move_to(series_.stretch(j), state_.stretch[j], errors.stretch[j]);
    state_.time = time;
  }

  /// Selects the mode after an event; a rigid contact whose sliding came to zero then has exactly none.
  void settle(const std::vector<int>& active) {
    for (const int contact : active) {
      const Contact<T>& c = system_->contacts[contact];
      if (!c.rigid() || mode_[contact] == Slip::stick || is_held(c.one) || is_held(c.other))
        continue;
      const T error = speed_of(contact), m = system_->bodies[c.one].mass;
      const T part = c.other == ground ? T(1) : 1 / m / (1 / m + 1 / system_->bodies[c.other].mass);
      state_.velocity[c.one] -= part * error;
      if (c.other != ground) state_.velocity[c.other] += (1 - part) * error;
    }
    const Mode before = mode_;
    const Real step = fastest_ > 0 ? 1 / fastest_ : Real(1);
    if (!selection_.select(state_, active, step, mode_)) status_ = Status::inconsistent;
    series_.set(mode_, state_.time);
    for (std::size_t j = 0; j < mode_.size(); ++j)
      if (mode_[j] != before[j])
        changes_.push_back({state_.time, static_cast<int>(j), before[j], mode_[j]});
  }

  const System<T>* system_;
  State<T> state_;
  Mode mode_;
  detail::Expansion<T> series_;
  detail::ModeSelection<T> selection_;
  Real fastest_;
  std::vector<Change<T>> changes_;
  Status status_{Status::ok};
  long steps_{0};
  int standing_{0};  ///< events at this time
};

}  // namespace pindrive::bodies
