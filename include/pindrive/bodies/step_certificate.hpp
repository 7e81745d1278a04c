/// Certificate of a motion of bodies: its laws at points of each step, and its energy, without the solver.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pindrive/bodies/follow.hpp"
#include "pindrive/bodies/system.hpp"
#include "pindrive/numbers/functions.hpp"

namespace pindrive::bodies {

/// Largest violations of the laws so far, as parts of the largest force, velocity, position or energy.
template <class T>
struct Violations {
  T motion{0};      ///< mass times acceleration against the sum of forces
  T kinematics{0};  ///< velocity against the rate of the position, and the rate of a stretch
  T friction{0};    ///< friction in slip against kinetic friction, in stick against its limit
  T sliding{0};     ///< slip against its direction, and sliding in stick
  T stops{0};  ///< bodies beyond a rigid stop, a stop that pulls, and impacts against Newton's law
  T continuity{0};  ///< jumps of position, or of velocity without an impact, between two steps
  T energy{0};      ///< balance of energy, over what was stored and exchanged

  T worst() const {
    return std::max({motion, kinematics, friction, sliding, stops, continuity, energy});
  }
};

/// Energy over a motion, J: `after` − `before` = `inputs` − `dampers` − `contacts` − `stops` but for rounding.
template <class T>
struct Ledger {
  T before{0}, after{0};  ///< of motion and of springs, without that of skin
  T inputs{0};            ///< work of forces, feedbacks, prescribed motions and surfaces
  T dampers{0};           ///< loss in the dampers of springs
  T contacts{0};          ///< loss in contacts, with what their skin stores
  T stops{0};             ///< loss at impacts and in elastic stops, with what these store
};

/// Checks each step of a motion. Reads inputs and polynomials alone.
template <class T>
class StepCertificate {
 public:
  explicit StepCertificate(const System<T>& system) : system_(&system) {}

  void add(const Step<T>& step) {
    if (began_) strike(step);
    for (std::size_t i = 0; i < system_->bodies.size(); ++i) meet(step, static_cast<int>(i));
    for (std::size_t f = 0; f < system_->feedbacks.size(); ++f) sample(step, static_cast<int>(f));
    const T before = energy(step, T(0)), after = energy(step, step.length());
    if (!began_) ledger_.before = before;
    ledger_.after = after;
    began_ = true;
    T gained = after - before;
    for (std::size_t k = 0; k < points.size(); ++k)
      for (const int side : {1, -1}) {
        const T tau = step.length() / 2 * (1 + T(side) * T(points[k]));
        check(step, tau);
        gained -= power(step, tau, step.length() / 2 * T(weights[k]));
      }
    drift_ += gained;
    last_.resize(2 * system_->bodies.size());
    for (std::size_t i = 0; i < system_->bodies.size(); ++i) {
      last_[2 * i] = step.position(static_cast<int>(i), step.length());
      last_[2 * i + 1] = step.velocity(static_cast<int>(i), step.length());
    }
    ++steps_;
  }

  Violations<T> violations() const {
    using std::abs;
    const auto part = [](T of, T scale) { return of > 0 ? of / scale : T(0); };
    return {
        part(found_.motion, force_),
        part(found_.kinematics, speed_),
        part(found_.friction, force_),
        part(found_.sliding, speed_),
        std::max({part(beyond_, size_), part(found_.stops, force_), part(wrong_impact_, speed_)}),
        std::max(part(found_.continuity, size_), part(jump_, speed_)),
        part(std::max(abs(drift_), drift_of_impacts_), exchanged_)};
  }
  const Ledger<T>& ledger() const { return ledger_; }
  long steps() const { return steps_; }

 private:
  // Ten points of Gauss and Legendre.
  static constexpr std::array<double, 5> points{0.14887433898163122, 0.4333953941292472,
                                                0.6794095682990244, 0.8650633666889845,
                                                0.9739065285171717};
  static constexpr std::array<double, 5> weights{0.29552422471475287, 0.26926671930999635,
                                                 0.21908636251598204, 0.1494513491505806,
                                                 0.06667134430868814};

  /// Distances over the largest place: bodies touch, or may have touched within the resolution of the time.
  static constexpr double touching = 1e-14, near = 1e-13;

  static void update_max(T& most, T value) {
    using std::abs;
    most = std::max(most, abs(value));
  }
  void meet(const Step<T>& step, int body) {
    const T x = step.position(body, T(0)), v = step.velocity(body, T(0));
    update_max(size_, x);
    update_max(speed_, v);
    if (!began_) return;
    update_max(found_.continuity, x - last_[2 * body]);
    if (!struck_) update_max(jump_, v - last_[2 * body + 1]);
  }
  /// Looks for an impact before a step: at each rigid stop that touches bodies end to approach, by Newton's law where
  /// only one is hit, and nothing is gained.
  void strike(const Step<T>& step) {
    using std::abs;
    struck_ = false;
    T jump{0}, before{0}, after{0}, size{0};
    for (std::size_t i = 0; i < system_->bodies.size(); ++i) {
      const T m = system_->bodies[i].mass, was = last_[2 * i + 1];
      const T is = step.velocity(static_cast<int>(i), T(0));
      update_max(jump, is - was);
      before += m * was * was / 2;
      after += m * is * is / 2;
      update_max(size, was);
    }
    if (!(jump > 1e-12 * std::max(size, speed_))) return;
    int met = 0;
    for (std::size_t s = 0; s < system_->stops.size(); ++s) {
      const Stop<T>& stop = system_->stops[s];
      const T apart = abs(step.depth(static_cast<int>(s), T(0)));
      if (!stop.rigid() || apart > near * size_) continue;
      const auto was = [&](int body) { return body == ground ? T(0) : last_[2 * body + 1]; };
      const T approached = T(stop.side) * (was(stop.one) - was(stop.other));
      const T approaches = T(stop.side) * between(step, stop.one, stop.other, T(0), true);
      if (apart <= touching * size_) update_max(wrong_impact_, std::max(T(0), approaches));
      if (++met == 1 && approached > 0)
        rebound_ = std::min(abs(approaches), abs(approaches + stop.restitution * approached));
    }
    struck_ = met > 0;
    if (met == 1) update_max(wrong_impact_, rebound_);
    if (!struck_) return;
    update_max(drift_of_impacts_, std::max(T(0), after - before));
    ledger_.stops += before - after;
    exchanged_ += abs(before - after);
  }
  T between(const Step<T>& step, int one, int other, T tau, bool velocities) const {
    const auto of = [&](int body) {
      if (body == ground) return T(0);
      return velocities ? step.velocity(body, tau) : step.position(body, tau);
    };
    return of(one) - of(other);
  }
  /// Error of a feedback, and the rate of it.
  struct Error {
    T value, rate;
  };
  Error error_of(const Step<T>& step, const Feedback<T>& c, T tau) const {
    const Curve<T> reference = c.reference.from(step.begin());
    return {reference.at(tau) - between(step, c.measured, c.against, tau, false),
            reference.rate_at(tau) - between(step, c.measured, c.against, tau, true)};
  }
  /// Samples where a step begins at a multiple of the period.
  void sample(const Step<T>& step, int f) {
    const Feedback<T>& c = system_->feedbacks[static_cast<std::size_t>(f)];
    held_.resize(system_->feedbacks.size());
    if (!c.sampled()) return;
    Held& held = held_[static_cast<std::size_t>(f)];
    if (step.begin() < T(held.samples) * c.period) return;
    const auto [error, rate] = error_of(step, c, T(0));
    held.sum += c.period * error;
    held.force = c.proportional * error + c.derivative * rate + c.integral * held.sum;
    ++held.samples;
  }
  /// Force of a feedback by its law, N.
  T control(const Step<T>& step, int f, T tau) const {
    const Feedback<T>& c = system_->feedbacks[static_cast<std::size_t>(f)];
    if (c.sampled()) return held_[static_cast<std::size_t>(f)].force;
    const auto [error, rate] = error_of(step, c, tau);
    return c.proportional * error + c.derivative * rate + c.integral * step.integral(f, tau);
  }
  /// Elongation of a link, and the rate of it.
  struct Pull {
    T longer, faster, given;
  };
  Pull pull(const Step<T>& step, const Link<T>& link, T tau) const {
    const Curve<T> length = link.length.from(step.begin());
    return {between(step, link.one, link.other, tau, false) - length.at(tau),
            between(step, link.one, link.other, tau, true) - length.rate_at(tau),
            length.rate_at(tau)};
  }

  void check(const Step<T>& step, T tau) {
    using std::abs;
    std::vector<T> rest(system_->bodies.size());
    const auto push = [&](int one, int other, T force) {
      update_max(force_, force);
      rest[one] -= force;
      if (other != ground) rest[other] += force;
    };
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const int body = static_cast<int>(i);
      const T force = system_->bodies[i].force.from(step.begin()).at(tau);
      rest[i] = system_->bodies[i].mass * step.acceleration(body, tau) - force;
      update_max(force_, force);
      update_max(speed_, step.velocity(body, tau));
      update_max(size_, step.position(body, tau));
    }
    for (const Link<T>& link : system_->links) {
      const Pull at = pull(step, link, tau);
      push(link.one, link.other, -(link.stiffness * at.longer + link.damping * at.faster));
    }
    for (std::size_t j = 0; j < system_->contacts.size(); ++j) {
      const int contact = static_cast<int>(j);
      push(system_->contacts[j].one, system_->contacts[j].other, step.friction(contact, tau));
      rub(step, contact, tau);
    }
    for (std::size_t s = 0; s < system_->stops.size(); ++s) {
      const Stop<T>& stop = system_->stops[s];
      const T force = step.push(static_cast<int>(s), tau);
      push(stop.one, stop.other, -T(stop.side) * force);
      halt(step, static_cast<int>(s), tau);
    }
    for (std::size_t i = 0; i < system_->feedbacks.size(); ++i) {
      const Feedback<T>& c = system_->feedbacks[i];
      const int f = static_cast<int>(i);
      push(c.one, c.other, control(step, f, tau));
      update_max(found_.motion, step.control(f, tau) - control(step, f, tau));
      if (!c.sampled())
        update_max(found_.continuity, step.integral_rate(f, tau) - error_of(step, c, tau).value);
    }
    for (const T each : rest) update_max(found_.motion, each);
  }
  void halt(const Step<T>& step, int s, T tau) {
    using std::abs;
    const Stop<T>& stop = system_->stops[static_cast<std::size_t>(s)];
    const T side = T(stop.side), force = step.push(s, tau);
    const T beyond = side * (between(step, stop.one, stop.other, tau, false) - stop.position);
    const T approach = side * between(step, stop.one, stop.other, tau, true);
    update_max(size_, stop.position);
    update_max(found_.stops, std::max(T(0), -force));
    if (stop.rigid()) {
      update_max(beyond_, step.pushes(s) ? abs(beyond) : std::max(T(0), beyond));
      return;
    }
    update_max(found_.stops, force - pressed(stop, beyond, approach));
  }
  /// Force of an elastic stop, N. A damper begins with a force where the bodies meet, within the rounding of their places.
  T pressed(const Stop<T>& stop, T beyond, T approach) const {
    return beyond > -touching * size_
               ? std::max(T(0), stop.stiffness * beyond + stop.damping * approach)
               : T(0);
  }
  T load_of(const Step<T>& step, const Contact<T>& c, T tau) const {
    const T own = c.load.from(step.begin()).at(tau);
    if (c.pressed_by < 0) return own;
    if (!system_->is_stop(c.pressed_by)) {
      const Contact<T>& by = system_->contacts[static_cast<std::size_t>(c.pressed_by)];
      return own + c.share * by.load.from(step.begin()).at(tau);
    }
    const Stop<T>& stop = system_->stops[system_->stop_of(c.pressed_by)];
    const T side = T(stop.side);
    return own + c.share * pressed(stop,
                                   side * (between(step, stop.one, stop.other, tau, false) -
                                           stop.position),
                                   side * between(step, stop.one, stop.other, tau, true));
  }
  void rub(const Step<T>& step, int contact, T tau) {
    const Contact<T>& c = system_->contacts[contact];
    const T load = load_of(step, c, tau), friction = step.friction(contact, tau);
    const T speed =
        between(step, c.one, c.other, tau, true) - c.velocity.from(step.begin()).at(tau);
    const int side = static_cast<int>(step.slip(contact));
    const T rate = c.rigid() ? T(0) : step.stretch_rate(contact, tau);
    update_max(speed_, speed);
    if (side != 0) {
      update_max(found_.friction, friction + T(side) * c.kinetic * load);
      update_max(found_.sliding, std::max(T(0), -T(side) * (speed - rate)));
      if (!c.rigid())
        update_max(found_.friction,
                   c.stiffness * step.stretch(contact, tau) + c.damping * rate + friction);
      return;
    }
    using std::abs;
    update_max(found_.friction, std::max(T(0), abs(friction) - c.static_limit * load));
    update_max(found_.sliding, speed - rate);
    if (!c.rigid())
      update_max(found_.friction,
                 c.stiffness * step.stretch(contact, tau) + c.damping * speed + friction);
  }

  T energy(const Step<T>& step, T tau) {
    T sum{0};
    for (std::size_t i = 0; i < system_->bodies.size(); ++i) {
      const T v = step.velocity(static_cast<int>(i), tau);
      sum += system_->bodies[i].mass * v * v / 2;
    }
    for (const Link<T>& link : system_->links) {
      const T longer = pull(step, link, tau).longer;
      sum += link.stiffness * longer * longer / 2;
    }
    update_max(exchanged_, sum);
    return sum;
  }
  /// Work of inputs, dampers and contacts on bodies and springs during a time, by their power at one moment, J.
  T power(const Step<T>& step, T tau, T during) {
    using std::abs;
    T sum{0};
    const auto give = [&](T work, T& account, int sign) {
      sum += work;
      account += T(sign) * work;
      exchanged_ += abs(work);
    };
    for (std::size_t i = 0; i < system_->bodies.size(); ++i)
      give(during * system_->bodies[i].force.from(step.begin()).at(tau) *
               step.velocity(static_cast<int>(i), tau),
           ledger_.inputs, 1);
    for (const Link<T>& link : system_->links) {
      const Pull at = pull(step, link, tau);
      give(-during * link.damping * at.faster * at.faster, ledger_.dampers, -1);
      give(-during * (link.stiffness * at.longer + link.damping * at.faster) * at.given,
           ledger_.inputs, 1);
    }
    for (std::size_t j = 0; j < system_->contacts.size(); ++j) {
      const Contact<T>& c = system_->contacts[j];
      const T surface = c.velocity.from(step.begin()).at(tau);
      const T force = during * step.friction(static_cast<int>(j), tau);
      give(force * (between(step, c.one, c.other, tau, true) - surface), ledger_.contacts, -1);
      give(force * surface, ledger_.inputs, 1);
    }
    for (std::size_t i = 0; i < system_->feedbacks.size(); ++i) {
      const Feedback<T>& c = system_->feedbacks[i];
      give(during * control(step, static_cast<int>(i), tau) *
               between(step, c.one, c.other, tau, true),
           ledger_.inputs, 1);
    }
    for (std::size_t s = 0; s < system_->stops.size(); ++s) {
      const Stop<T>& stop = system_->stops[s];
      const T force = during * T(-stop.side) * step.push(static_cast<int>(s), tau);
      give(force * between(step, stop.one, stop.other, tau, true), ledger_.stops, -1);
    }
    return sum;
  }

  const System<T>* system_;
  Violations<T> found_{};
  Ledger<T> ledger_{};
  T jump_{0}, force_{0}, speed_{0}, size_{0}, drift_{0}, exchanged_{0};
  T beyond_{0}, wrong_impact_{0}, rebound_{0}, drift_of_impacts_{0};
  bool began_{false}, struck_{false};
  /// State of a sampled feedback.
  struct Held {
    long samples{0};
    T sum{0}, force{0};
  };

  std::vector<T> last_;
  std::vector<Held> held_;
  long steps_{0};
};

}  // namespace pindrive::bodies
