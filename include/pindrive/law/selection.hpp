/// Selection of the mode that follows an event (docs/theory.md, section 11).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "pindrive/law/contact_point.hpp"
#include "pindrive/law/guards.hpp"
#include "pindrive/law/oblique.hpp"
#include "pindrive/law/pin.hpp"
#include "pindrive/law/state.hpp"
#include "pindrive/model/model.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pindrive::detail {

/// Motion that the selected mode starts, and its guards.
template <class T>
struct SelectedMotion {
  T acceleration{};        ///< acceleration in slip, m/s²
  bool tangential{false};  ///< a contact starts to slip without a relative acceleration
  T applied_force{};       ///< inertial and external force, N
  Path<T> stick_force{};   ///< stick force, N
  Guards<T> guards;
};

/// Selection of the mode of a pin and of the motion that the mode starts.
///
/// Contacts and end stops list their candidates (contact_point.hpp, skin.hpp, stops.hpp). The
/// combinations are tested in a fixed order, and the first consistent one is selected: a stop or a
/// contact holds the pin (`try_stop`, `try_stick`), then the pin slips on both contacts (`try_slip`),
/// each beside each state of the stops. Three decisions that follow:
///
/// - *Static friction above kinetic friction.* A contact sticks while the stick force is within
///   `static_limit`; once it slips, its force is the kinetic friction, so that the force jumps. With
///   both directions of slip consistent at that jump, the direction opposite to the stick force is
///   selected (`prefer_direction`). A contact whose static friction still suffices is not released
///   (`could_stick`), unless no other candidate is consistent.
/// - *Two surfaces part.* A pin that sticks to both cannot follow both once their accelerations
///   differ. It stays on the surface to which it stuck alone before, else on the plate, if the static
///   friction there suffices; otherwise on the other one; if neither suffices, it slips on both.
/// - *A stop lets go.* A rigid stop holds the pin while its push is positive (`try_stop`); a push that
///   is zero and falls is inconsistent. An elastic stop separates where its push becomes zero.
template <class T>
class Selection {
 public:
  Selection(Pin<T>& pin, SelectedMotion<T>& selected) : pin_(pin), selected_(selected) {}

  /// Selects the first consistent combination: the first non-zero derivative of each guard that is
  /// zero is positive. Returns false if there is none.
  bool select() {
    pin_.plate.enumerate_candidates(pin_.state);
    pin_.finger.enumerate_candidates(pin_.state);
    selected_.applied_force = pin_.drive.mass * pin_.plate.surface.rate;
    restoring_force_ = pin_.drive.stiffness * pin_.state.x + pin_.drive.damping * pin_.state.v;
    T scale =
        pin_.drive.stiffness * pin_.state.position_scale + pin_.drive.damping * abs(pin_.state.v);
    selected_.applied_force += pin_.force.value;
    // Error from the time resolution.
    scale +=
        (abs(pin_.force.rate) + pin_.drive.mass * abs(pin_.plate.surface.second())) * pin_.time;
    pin_.stop.enumerate_candidates(pin_.state);
    scale += pin_.stop.force_scale(pin_.state);
    // rounding: tests/hard/rigid-stop-lets-go-within-the-resolution-of-an-inertial-force.txt, and five more drives
    pin_.state.force_error = rounding<T> * (scale + 2 * abs(selected_.applied_force) +
                                            pin_.plate.force_scale(pin_.state.v) +
                                            pin_.finger.force_scale(pin_.state.v));
    const T without_stop = restoring_force_;
    for (const bool stick : {true, false})
      for (int option = 0; option < pin_.stop.count(); ++option) {
        pin_.stop.choose(option);
        restoring_force_ = without_stop - pin_.stop.force(pin_.state);
        if (pin_.stop.is_holding() ? stick && try_stop() : stick ? try_any_stick() : try_any_slip())
          return true;
      }
    return false;
  }

 private:
  using ContactPoint = detail::ContactPoint<T>;

  /// Stiffness of spring and pushing stop, N/m.
  T stiffness() const { return pin_.drive.stiffness + pin_.stop.stiffness(); }
  T damping() const { return pin_.drive.damping + pin_.stop.damping(); }

  /// True if the finger is evaluated before the plate.
  bool finger_first() const {
    return pin_.finger.before == ContactState::stick && pin_.plate.before != ContactState::stick;
  }
  /// Selects a mode in which a contact sticks; false if none is consistent.
  bool try_any_stick() {
    const bool finger = finger_first();
    ContactPoint &first = finger ? pin_.finger : pin_.plate,
                 &second = finger ? pin_.plate : pin_.finger;
    if (first.may_stick() && try_stick_beside(first, second, 0)) return true;
    return second.may_stick() && try_stick_beside(second, first, first.may_stick() ? 1 : 0);
  }
  /// Selects a mode in which no contact sticks; false if none is consistent.
  bool try_any_slip() {
    const bool finger = finger_first();
    ContactPoint &first = finger ? pin_.finger : pin_.plate,
                 &second = finger ? pin_.plate : pin_.finger;
    for (ContactPoint* side : {&first, &second}) {
      ContactPoint& other = side == &first ? second : first;
      if (!side->may_stick()) continue;
      if (!other.may_stick()) other.choose(0);
      side->prefer_direction(
          holding_force(*side, other.may_stick() ? T(0) : other.force(pin_.state)));
    }
    for (const bool kept : {false, true})
      for (int k = first.may_stick() ? 1 : 0; k < first.candidates.size(); ++k)
        for (int l = second.may_stick() ? 1 : 0; l < second.candidates.size(); ++l) {
          first.choose(k);
          second.choose(l);
          if ((could_stick(first, second) || could_stick(second, first)) == kept && try_slip())
            return true;
        }
    return false;
  }
  /// True if `side` was stuck and its static friction still suffices while `other` slips. `side` is
  /// released only if no other candidate is consistent.
  bool could_stick(const ContactPoint& side, const ContactPoint& other) const {
    if (side.before != ContactState::stick || !side.may_stick() || other.may_stick()) return false;
    const T force = holding_force(side, other.force(pin_.state));
    return pin_.stick_limit_side == 0 && side.stick_limit() - abs(force) > pin_.state.force_error;
  }

  /// Tests the mode in which a rigid stop holds the pin. The pin is at rest, which determines the
  /// modes of its contacts; a rigid finger transmits no force.
  bool try_stop() {
    selected_.tangential = false;
    selected_.acceleration = T(0);
    const T end = stop_sign(pin_.stop.state);
    const auto choose = [&](ContactPoint& side) {
      for (int k = 0; k < side.candidates.size(); ++k) {
        side.choose(k);
        if (is_admissible_beside(Curve<T>{}, side)) return true;
      }
      return false;
    };
    if (!choose(pin_.plate) || !choose(pin_.finger)) return false;
    const T force = selected_.applied_force - restoring_force_ + pin_.plate.force(pin_.state) +
                    pin_.finger.force(pin_.state);
    const auto rate = pin_.plate.force_rate(T(0), T(0)), skin = pin_.finger.force_rate(T(0), T(0));
    const Path<T> push{end * force, T(0), T(0), end * (applied_rate() + rate.value + skin.value),
                       end * (applied_second_rate() + rate.second + skin.second)};
    return pin_.stop.try_hold(push, pin_.no_push(), pin_.state.force_error, selected_.guards);
  }

  /// Tests stick of one contact beside each candidate of the second contact, from `option` on.
  bool try_stick_beside(ContactPoint& on, ContactPoint& other, int option) {
    on.choose(0);
    for (; option < other.candidates.size(); ++option) {
      other.choose(option);
      if (try_stick(on, other)) return true;
    }
    return false;
  }

  /// Force that keeps the pin on the surface of a contact, beside the force of the second contact,
  /// N.
  T holding_force(const ContactPoint& on, T of_other) const {
    return restoring_force_ - (selected_.applied_force - pin_.drive.mass * on.surface.rate) -
           of_other;
  }
  /// Stick force as a function of time.
  Path<T> holding_force_from(T force, const ContactPoint& on, const ContactPoint& other) const {
    const T a = on.surface.rate, spring = stiffness() * pin_.state.v, damper = damping() * a;
    const auto rate = other.force_rate(pin_.state.v, a);
    // Derivatives of the inertial and external force less the inertia of the pin on its surface.
    const T applied = applied_rate() - pin_.drive.mass * on.surface.second();
    const T bend = damping() * on.surface.second() -
                   (applied_second_rate() - pin_.drive.mass * on.surface.third());
    const T drift = spring + damper - rate.value - applied;
    const T second = rate.second + other.force_by_speed(pin_.state.v) * on.surface.second();
    return {force, T(0), T(0), drift, stiffness() * a - second + bend};
  }
  /// Magnitude of the terms of the slope of a stick force, N/s.
  T holding_slope_scale(const ContactPoint& on, const ContactPoint& other) const {
    const T a = on.surface.rate, v = pin_.state.v;
    const T applied = applied_rate() - pin_.drive.mass * on.surface.second();
    return abs(stiffness() * v) + abs(damping() * a) + other.force_rate(v, a).scale + abs(applied);
  }

  /// Tests the mode in which a contact, and `other` if it sticks too, keeps the pin on its surface.
  bool try_stick(const ContactPoint& on, const ContactPoint& other) {
    if (!is_admissible_beside(on.surface, other)) return false;
    if (!pin_.stop.is_consistent(pin_.state.v, on.surface.rate,
                                 {on.surface.second(), later(on.surface)}))
      return false;
    const T own_limit = on.contact.static_limit;
    const T other_limit = other.stuck() ? other.contact.static_limit : T(0);
    const Line<T> limit{own_limit * on.load.value + other_limit * other.load.value,
                        own_limit * on.load.rate + other_limit * other.load.rate};
    const T force = holding_force(on, other.force(pin_.state));
    const int at_limit = pin_.stays_at_limit() ? pin_.stick_limit_side : 0;
    // rounding: the friction of an oblique plate turns within the time resolution
    // (tests/hard/finger-grips-as-oblique-friction-turns-within-the-resolution-of-time.txt).
    const T turns =
        other.oblique() ? abs(other.force_rate(pin_.state.v, on.surface.rate).value) : T(0);
    const T error = pin_.force_error() + rounding<T> * pin_.time * turns;
    if (limit.value - abs(force) < -error && (force < 0 ? -1 : 1) != at_limit) return false;
    Path<T> most = limit;
    most.curvature = own_limit * on.load.second() + other_limit * other.load.second();
    const bool powerless = on.powerless() && (!other.stuck() || other.powerless());
    if (powerless && relative_beginning(on.surface) != 0) return false;
    selected_.stick_force = holding_force_from(force, on, other);
    selected_.guards.clear();
    for (const int side : {1, -1}) {
      Path<T> margin = most + T(-side) * selected_.stick_force;
      if (!(margin.start > pin_.force_error()) || side == at_limit) {
        margin.start = T(0);
        if (grazes(margin.drift, margin.curvature, pin_.state.force_error)) margin.drift = T(0);
        const T first = margin.drift != 0       ? margin.drift
                        : margin.curvature != 0 ? margin.curvature
                                                : later_margin(on, other, T(side));
        if (first < 0) return false;
      }
      selected_.guards.add_force(margin, pin_.plate.stuck(), side);
    }
    return true;
  }

  using Coefficients = std::array<T, beginning_orders>;
  static Coefficients coefficients(const Curve<T>& of) {
    return of.template coefficients<beginning_orders>();
  }
  /// True if the force of a contact depends on its load, or on the position of the pin, alone.
  static bool follows_load(const ContactPoint& side) {
    const Branch<T> range = side.branch();
    const bool falls = range.falling.present() && range.falling.excess != 0;
    return !side.oblique() && (!side.sliding() || (range.slope == 0 && !falls));
  }
  /// Friction of a contact that slides per load factor, N.
  T friction_per_load(const ContactPoint& side) const {
    const bool rubs = side.sliding() && side.load.value != 0;
    return rubs ? side.force(pin_.state) / side.load.value : T(0);
  }
  /// Stiffness of the spring and of a skin that grips the pin, N/m.
  T stiffness_with_skin() const {
    return stiffness() + (pin_.finger.elastic() ? pin_.drive.finger.stiffness : T(0));
  }
  /// Returns the lowest coefficient, from the third on, of the margin of a stick force on a side that is not zero; 0
  /// without one. If the force of the other contact depends on its speed, only the third coefficient is known, and only
  /// while that contact does not accelerate.
  T later_margin(const ContactPoint& on, const ContactPoint& other, T side) const {
    const bool any_order = follows_load(other);
    const T relative = on.surface.rate - other.surface.rate;
    if (!any_order && (other.oblique() || relative != 0 || !other.load.steady())) return T(0);
    const Coefficients surface = coefficients(on.surface), force = coefficients(pin_.force),
                       plate = coefficients(pin_.plate.surface), own = coefficients(on.load),
                       load = coefficients(other.load);
    const T of_other = friction_per_load(other);
    const Coefficients of_surface = coefficients(other.surface);
    const T by_speed = any_order ? T(0) : other.force_by_speed(pin_.state.v);
    Coefficients margin{};
    for (std::size_t n = 3; n < (any_order ? beginning_orders - 1 : 4); ++n) {
      const T inertia = pin_.drive.mass * T(n + 1) * (plate[n + 1] - surface[n + 1]);
      const T holding = stiffness_with_skin() * surface[n - 1] / T(n) + damping() * surface[n] -
                        force[n] - inertia - of_other * load[n] -
                        by_speed * (surface[n] - of_surface[n]);
      const T beside = other.stuck() ? other.contact.static_limit * load[n] : T(0);
      margin[n] = on.contact.static_limit * own[n] + beside - side * holding;
    }
    return third_or_later(margin);
  }

  /// Tests the mode in which no contact sticks. A relative acceleration that is zero within its
  /// error is exactly zero: the pin starts tangentially to that surface.
  bool try_slip() {
    selected_.tangential = false;
    selected_.guards.clear();
    const T finger = pin_.finger.force(pin_.state);
    // On a plate that begins to slide across, all forces may balance within rounding.
    const bool starts = pin_.plate.oblique() && pin_.plate.across.value == 0 &&
                        pin_.state.v == pin_.plate.surface.value;
    const T departure = starts
                            ? oblique_departure(pin_.drive.mass, pin_.plate,
                                                selected_.applied_force - restoring_force_ + finger,
                                                pin_.force_error())
                            : T(0);
    follows_plate_ =
        starts && departure == 0 && pin_.plate.across.rate == 0 && pin_.plate.start.friction > 0;
    const T plate = pin_.plate.force(pin_.state);
    selected_.acceleration =
        starts ? pin_.plate.surface.rate + departure
               : (selected_.applied_force - restoring_force_ + plate + finger) / pin_.drive.mass;
    // Relative acceleration times the mass.
    const auto relative_force = [&](const ContactPoint& side, T own, T of_other) {
      if (!side.is_decided_by_acceleration(pin_.state.v)) return selected_.acceleration;
      const T force = starts ? pin_.drive.mass * (selected_.acceleration - side.surface.rate)
                             : own - holding_force(side, of_other);
      const bool releases = side.before == ContactState::stick && pin_.stays_at_limit();
      const T error = starts ? T(0) : pin_.force_error() + pin_.plate.force_error(pin_.state.v);
      // rounding: tests/hard/creep-across-curve-point-of-finger.txt
      const bool none = abs(force) <= error;
      if (!selected_.tangential && (none || releases)) {
        selected_.tangential = true;
        selected_.acceleration = side.surface.rate;
      }
      return force;
    };
    const T at_plate = relative_force(pin_.plate, plate, finger),
            at_finger = relative_force(pin_.finger, finger, plate);
    if (pin_.stop.is_undecided() && !leaves_stop()) return false;
    const auto is_admissible = [&](const ContactPoint& side, const ContactPoint& other, T force) {
      if (side.oblique()) {
        const Line<T> jerk = this->jerk();
        return side.is_admissible(pin_.state, selected_.acceleration - side.surface.rate,
                                  jerk.value - side.surface.second(), jerk.rate);
      }
      if (side.contact.damped()) {
        const Line<T> jerk = this->jerk();
        return side.is_admissible_with_damping(pin_.state.v, selected_.acceleration, jerk.value,
                                               jerk.rate, pin_.force_error() / pin_.drive.mass);
      }
      if (!selected_.tangential) return side.is_admissible(pin_.state, force);
      if (follows_plate_) {
        const Line<T> jerk = this->jerk();
        return side.is_admissible(pin_.state, T(0), jerk.value, jerk.rate);
      }
      const T relative = selected_.acceleration - side.surface.rate;
      if (pin_.drive.mass * abs(relative) > pin_.force_error() ||
          !side.is_decided_by_acceleration(pin_.state.v))
        return side.is_admissible(pin_.state, relative);
      const Path<T> needed = holding_force_from(T(0), side, other);
      const T own = side.force_rate(pin_.state.v, selected_.acceleration).value,
              jerk = own - needed.drift;
      // rounding: tests/hard/start-with-zero-acceleration-and-jerk.txt
      const bool none = abs(jerk) <= rounding<T> * (holding_slope_scale(side, other) + abs(own));
      const T third = needed.curvature == 0 ? relative_beginning(side.surface) : -needed.curvature;
      return side.is_admissible(pin_.state, T(0), none ? T(0) : jerk, third);
    };
    return is_admissible(pin_.plate, pin_.finger, at_plate) &&
           is_admissible(pin_.finger, pin_.plate, at_finger);
  }

  /// Derivatives of the inertial and external force, N/s and N/s².
  T applied_rate() const { return pin_.force.rate + pin_.drive.mass * pin_.plate.surface.second(); }
  T applied_second_rate() const {
    return pin_.force.second() + pin_.drive.mass * pin_.plate.surface.third();
  }
  /// True if a contact may stick or slip while the pin moves as a surface does.
  bool is_admissible_beside(const Curve<T>& surface, const ContactPoint& side) const {
    const T relative = surface.rate - side.surface.rate;
    if (relative != 0) return !side.stuck() && side.is_admissible(pin_.state, relative);
    const T second = surface.second() - side.surface.second();
    const T third = later(surface) - later(side.surface);
    if (side.stuck()) return second == 0 && third == 0;
    return side.is_admissible(pin_.state, relative, second, third);
  }

  static T later(const Curve<T>& velocity) {
    return velocity.straight() ? T(0) : third_or_later(coefficients(velocity));
  }
  /// Returns the lowest coefficient, from the third on, of the velocity relative to a surface that is not zero, for a pin
  /// that has the acceleration of the surface; 0 without one. The sign alone is exact: friction that depends on the
  /// speed has its present value.
  T relative_beginning(const Curve<T>& surface) const {
    const Coefficients plate = coefficients(pin_.plate.surface), force = coefficients(pin_.force),
                       plate_load = coefficients(pin_.plate.load),
                       finger_load = coefficients(pin_.finger.load);
    Coefficients relative = coefficients(surface);
    const T of_plate = friction_per_load(pin_.plate), of_finger = friction_per_load(pin_.finger);
    T x = pin_.state.v, v = relative[1];
    relative[0] = relative[1] = T(0);
    for (std::size_t n = 1; n + 1 < beginning_orders; ++n) {
      const T friction = of_plate * plate_load[n] + of_finger * finger_load[n];
      const T pull = force[n] + friction - damping() * v - stiffness_with_skin() * x;
      const T next = plate[n + 1] + pull / (pin_.drive.mass * T(n + 1));
      x = v / T(n + 1);
      v = next;
      relative[n + 1] = v - relative[n + 1];
    }
    return third_or_later(relative);
  }

  /// True if a slipping pin is consistent with the state of the stops.
  bool leaves_stop() {
    const bool none = pin_.drive.mass * abs(selected_.acceleration) <= pin_.state.force_error ||
                      (pin_.stop.rigid() && pin_.no_push());
    if (!selected_.tangential && pin_.stop.at_edge() && none) {
      selected_.tangential = true;
      selected_.acceleration = T(0);
    }
    return pin_.stop.is_consistent(pin_.state.v, selected_.acceleration, jerk());
  }

  /// Jerk of a slipping pin, m/s³, and the derivative of the jerk.
  Line<T> jerk() const {
    if (follows_plate_) return creeping_jerk();
    const Line<T> force = force_rate();
    return {force.value / pin_.drive.mass, force.rate / pin_.drive.mass};
  }
  /// Jerk of a pin on a plate that begins to slide across, with the acceleration of the plate: u = w d/√(1 − d²). The
  /// slope is the next later coefficient that is not zero, of which the sign is used.
  Line<T> creeping_jerk() const {
    auto velocity = pin_.plate.surface.template coefficients<beginning_orders>();
    const auto across = pin_.plate.across.template coefficients<beginning_orders>();
    const T d = pin_.plate.direction, ratio = d / sqrt(1 - d * d);
    for (std::size_t n = 0; n < beginning_orders; ++n) velocity[n] += ratio * abs(across[n]);
    // A pull that begins at zero turns the direction from zero.
    if (d == 0) {
      const auto [turn, order] = beginning_of_pull();
      for (std::size_t n = 0; n + order < beginning_orders; ++n)
        velocity[n + order] +=
            turn / (pin_.plate.load.value * pin_.plate.start.friction) * abs(across[n]);
    }
    return {2 * velocity[2], third_or_later(velocity)};
  }
  /// First coefficient of the force on a pin that moves as the plate, beside friction, after that of order 0; and its
  /// order. 0 without one.
  std::pair<T, std::size_t> beginning_of_pull() const {
    const auto force = pin_.force.template coefficients<beginning_orders>();
    const auto plate = pin_.plate.surface.template coefficients<beginning_orders>();
    for (std::size_t n = 1; n + 1 < beginning_orders; ++n)
      if (const T pull = force[n] - damping() * plate[n] - stiffness() * plate[n - 1] / T(n);
          pull != 0)
        return {pull, n};
    return {T(0), beginning_orders};
  }
  /// Derivatives of the force on a slipping pin, N/s and N/s².
  Line<T> force_rate() const {
    const auto plate = pin_.plate.force_rate(pin_.state.v, selected_.acceleration);
    const auto finger = pin_.finger.force_rate(pin_.state.v, selected_.acceleration);
    const T spring = stiffness() * pin_.state.v, damper = damping() * selected_.acceleration;
    return {applied_rate() + plate.value + finger.value - spring - damper,
            applied_second_rate() + plate.second + finger.second -
                stiffness() * selected_.acceleration};
  }

  Pin<T>& pin_;
  SelectedMotion<T>& selected_;
  /// A plate begins to slide across, and the pin has its velocity and acceleration.
  bool follows_plate_{false};
  T restoring_force_{0};  ///< force of spring and damper less that of a stop, N
};

}  // namespace pindrive::detail
