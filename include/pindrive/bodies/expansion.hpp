/// Taylor series of all quantities of a system in one mode.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "pindrive/bodies/inputs_at.hpp"
#include "pindrive/bodies/joined_bodies.hpp"
#include "pindrive/bodies/system.hpp"
#include "pindrive/flow/polynomial.hpp"
#include "pindrive/series/series_inputs.hpp"

namespace pindrive::detail {

/// Coefficients from a state on, in the time σ = τ/step. N is T, or T with its error.
template <class T, class N = T>
class Expansion {
 public:
  using Real = detail::Real<T>;
  using Series = std::array<N, series_order + 2>;
  using Mode = std::vector<bodies::Slip>;
  using Inputs = InputsAt<T>;

  explicit Expansion(const bodies::System<T>& system)
      : system_(&system),
        joined_(system),
        order_(system.bodies.size(), system.modes()),
        position_(system.bodies.size()),
        velocity_(system.bodies.size()),
        stretch_(system.contacts.size()),
        sliding_(system.contacts.size()),
        settled_(system.contacts.size()),
        friction_(system.contacts.size()),
        depth_(system.stops.size()),
        approach_(system.stops.size()),
        push_(system.stops.size()),
        control_(system.feedbacks.size()),
        integral_(system.feedbacks.size()),
        pushes_(system.bodies.size()),
        lengths_(system.links.size()),
        loads_(system.contacts.size()),
        surfaces_(system.contacts.size()),
        references_(system.feedbacks.size()) {}

  /// Takes a mode under inputs. Of contacts whose surfaces move apart `late` ones hold no body that another holds.
  void set(const Mode& mode, const Inputs& inputs, const std::vector<int>& late = {}) {
    mode_ = mode;
    joined_.clear();
    // Beside friction a stop takes almost all of a force, since it has no limit.
    T most{0};
    for (std::size_t j = 0; j < contacts(); ++j)
      if (holds(j, inputs)) most = std::max(most, limit_of(j, inputs));
    const T share = most > 0 ? 1000 * most : T(1);
    // Stops come first: bodies that they join do not part, and a contact there has to slip.
    for (std::size_t s = 0; s < system_->stops.size(); ++s)
      if (mode[contacts() + s] == bodies::Slip::stick && system_->stops[s].rigid())
        joined_.add(static_cast<int>(contacts() + s), share);
    for (const bool is_late : {false, true})
      for (std::size_t j = 0; j < contacts(); ++j)
        if (holds(j, inputs) &&
            (std::find(late.begin(), late.end(), static_cast<int>(j)) != late.end()) == is_late)
          joined_.add(static_cast<int>(j), limit_of(j, inputs));
    joined_.join();
  }

  /// True of a contact in stick whose surfaces may move apart.
  bool may_part(int j) const {
    const bool rigid = is_stop(j) ? system_->stops[stop_of(j)].rigid() : contact(j).rigid();
    return rigid && !joined_.joins(j);
  }

  /// True of skin that slips under a constant load and whose stretch, at rest to rounding, follows no more.
  bool is_settled(std::size_t j, const bodies::State<T>& state, const Inputs& inputs) const {
    using std::abs;
    const bodies::Contact<T>& c = contact(j);
    if (mode_[j] == bodies::Slip::stick || c.rigid() || c.damping == 0) return false;
    if (c.pressed_by >= 0 && is_stop(c.pressed_by)) return false;
    if (!inputs.load[j].steady() || (c.pressed_by >= 0 && !inputs.load[c.pressed_by].steady()))
      return false;
    T load = inputs.load[j].value;
    if (c.pressed_by >= 0) load += c.share * inputs.load[c.pressed_by].value;
    const T kinetic = T(static_cast<int>(mode_[j])) * c.kinetic * load;
    return abs(plain(kinetic - c.stiffness * state.stretch[j])) <=
           2 * rounding<Real> * abs(plain(kinetic));
  }

  /// True if rigid contacts hold each body to the ground.
  bool all_held() const { return joined_.all_grounded(); }

  /// Computes the inputs from a time on, in the time τ/step, for orders up to one.
  void read(const Inputs& inputs, const T& time, Real step, int order) {
    using std::abs;
    const auto fill = [&](std::vector<InputSeries<T>>& series, const std::vector<Curve<T>>& of) {
      for (std::size_t i = 0; i < of.size(); ++i)
        series[i] = InputSeries<T>(of[i], step,
                                   order + 2);  // rates take one more order, their errors another
    };
    fill(pushes_, inputs.force);
    fill(lengths_, inputs.length);
    fill(loads_, inputs.load);
    fill(surfaces_, inputs.surface);
    fill(references_, inputs.reference);
    step_ = step;
    late_ = rounding<Real> * abs(plain(time)) / step;
  }
  /// Computes the orders up to one from a state on, under the inputs that were read.
  void expand(const bodies::State<T>& state, const Inputs& inputs, int order) {
    begin(state, inputs);
    order_count_ = order;
    for (int n = 0; n <= order; ++n) {
      const T next = T(step_) / T(n + 1);
      for (std::size_t i = 0; i < position_.size(); ++i)
        order_.force[i] = n <= pushes_[i].degree() ? given(pushes_[i], n) : N(T(0));
      for (std::size_t l = 0; l < system_->links.size(); ++l) pull(l, n);
      for (std::size_t f = 0; f < control_.size(); ++f) control(f, n, next);
      for (std::size_t s = 0; s < depth_.size(); ++s) press(s, n);
      for (const Acting& acting : acting_)
        if (n <= acting.degree) rub(acting.contact, n, next);
      for (const int j : joined_.stuck())
        order_.surface[j] = is_stop(j) ? N(T(0)) : rate_of(surfaces_[j], n);
      joined_.solve(order_);
      for (const int j : joined_.stuck()) {
        if (is_stop(j))
          push_[stop_of(j)][n] = -(side(stop_of(j)) * order_.friction[j]);
        else
          friction_[j][n] = order_.friction[j];
      }
      for (std::size_t i = 0; i < position_.size(); ++i) {
        position_[i][n + 1] = next * velocity_[i][n];
        velocity_[i][n + 1] = next * order_.acceleration[i];
      }
    }
    for (std::size_t j = 0; j < contacts(); ++j) slide(j);
  }

  int order() const { return order_count_; }
  const Series& position(std::size_t body) const { return position_[body]; }
  const Series& velocity(std::size_t body) const { return velocity_[body]; }
  const Series& stretch(std::size_t contact) const { return stretch_[contact]; }
  /// Speed at which `one` slides over the surface, or its skin does, m/s.
  const Series& sliding(std::size_t contact) const { return sliding_[contact]; }
  /// Friction force on `one`, N.
  const Series& friction(std::size_t contact) const { return friction_[contact]; }
  /// Distance of `one` beyond the place where a stop touches, m, and the rate of the distance, m/s.
  const Series& depth(std::size_t stop) const { return depth_[stop]; }
  const Series& approach(std::size_t stop) const { return approach_[stop]; }
  /// Force with which a stop pushes, or an elastic one would push, N.
  const Series& push(std::size_t stop) const { return push_[stop]; }
  /// Force of a feedback on its first body, N, and the integral of its error, m s.
  const Series& control(std::size_t feedback) const { return control_[feedback]; }
  const Series& integral(std::size_t feedback) const { return integral_[feedback]; }
  std::size_t stops() const { return depth_.size(); }
  bool is_stop(int j) const { return system_->is_stop(j); }
  std::size_t stop_of(int j) const { return system_->stop_of(j); }
  /// Order n of the largest friction force of a contact that sticks, N.
  N limit(std::size_t j, int n) const { return contact(j).static_limit * load(j, n); }

 private:
  const bodies::Contact<T>& contact(std::size_t j) const { return system_->contacts[j]; }
  std::size_t contacts() const { return system_->contacts.size(); }
  T side(std::size_t stop) const { return T(system_->stops[stop].side); }
  /// True of a rigid contact that sticks and has friction to hold with.
  bool holds(std::size_t j, const Inputs& inputs) const {
    return mode_[j] == bodies::Slip::stick && contact(j).rigid() && limit_of(j, inputs) != 0;
  }
  /// Static friction, N; that of a contact which a stop may press is as under 1 N.
  T limit_of(std::size_t j, const Inputs& inputs) const {
    const bodies::Contact<T>& c = contact(j);
    T load = inputs.load[j].value;
    if (c.pressed_by >= 0)
      load += c.share * (is_stop(c.pressed_by) ? T(1) : inputs.load[c.pressed_by].value);
    return c.static_limit * load;
  }
  /// Order n of the load of a contact.
  N load(std::size_t j, int n) const {
    const bodies::Contact<T>& c = contact(j);
    if (c.pressed_by < 0) return given(loads_[j], n);
    if (!is_stop(c.pressed_by))
      return given(loads_[j], n) + c.share * given(loads_[c.pressed_by], n);
    if (mode_[c.pressed_by] != bodies::Slip::stick) return given(loads_[j], n);
    return given(loads_[j], n) + c.share * push_[stop_of(c.pressed_by)][n];
  }
  /// Order n of the rate of a load; that of a stop that presses is left out, as only skin without damping needs it.
  N load_rate(std::size_t j, int n) const {
    const bodies::Contact<T>& c = contact(j);
    if (c.pressed_by < 0 || is_stop(c.pressed_by)) return rate_of(loads_[j], n);
    return rate_of(loads_[j], n) + c.share * rate_of(loads_[c.pressed_by], n);
  }

  void begin(const bodies::State<T>& state, const Inputs& inputs) {
    for (std::size_t i = 0; i < position_.size(); ++i) {
      position_[i][0] = with_error(state.position[i], error(state.errors.position, i));
      velocity_[i][0] = with_error(state.velocity[i], error(state.errors.velocity, i));
    }
    for (std::size_t j = 0; j < stretch_.size(); ++j)
      stretch_[j][0] = with_error(state.stretch[j], error(state.errors.stretch, j));
    for (std::size_t f = 0; f < control_.size(); ++f) {
      integral_[f][0] = with_error(state.integral[f], error(state.errors.integral, f));
      control_[f][0] = with_error(state.held[f]);
    }
    find_acting();
    for (std::size_t j = 0; j < contacts(); ++j) settled_[j] = is_settled(j, state, inputs);
  }
  /// Contact whose friction acts on bodies as a force, up to an order.
  struct Acting {
    std::size_t contact;
    int degree;
  };
  /// Contacts whose friction is no unknown: of those that slip no order beyond that of their load.
  void find_acting() {
    acting_.clear();
    for (std::size_t j = 0; j < contacts(); ++j) {
      const bodies::Contact<T>& c = contact(j);
      const bool sticks = mode_[j] == bodies::Slip::stick;
      std::fill(friction_[j].begin(), friction_[j].end(), N(T(0)));
      if (sticks && c.rigid()) continue;
      int degree = loads_[j].degree();
      if (c.pressed_by >= 0)
        degree =
            is_stop(c.pressed_by) ? series_order : std::max(degree, loads_[c.pressed_by].degree());
      acting_.push_back({j, sticks ? series_order : degree});
    }
  }
  static Real error(const std::vector<Real>& of, std::size_t i) {
    return of.empty() ? Real(0) : of[i];
  }
  /// Order n of an input, with the error of a time that is known to rounding.
  N given(const InputSeries<T>& input, int n) const {
    return with_error(input[n], late_ * std::abs(plain(T(n + 1) * input[n + 1])));
  }
  /// Order n of the rate of an input, likewise.
  N rate_of(const InputSeries<T>& input, int n) const {
    return with_error(input.rate(n), late_ * std::abs(plain(T(n + 1) * input.rate(n + 1))));
  }
  /// Number of a state, with the rounding of it.
  static N with_error(const T& of, Real within = 0) {
    if constexpr (std::is_same_v<N, T>)
      return of;
    else
      return {of, within + 16 * rounding<Real> * std::abs(plain(of))};
  }
  /// Order n of the difference of two bodies, in position or velocity.
  static N apart(const std::vector<Series>& of, int one, int other, int n) {
    return other == bodies::ground ? of[one][n] : of[one][n] - of[other][n];
  }
  void apply(int one, int other, const N& by) {
    order_.force[one] += by;
    if (other != bodies::ground) order_.force[other] -= by;
  }
  void pull(std::size_t l, int n) {
    const bodies::Link<T>& link = system_->links[l];
    const N longer = apart(position_, link.one, link.other, n) - given(lengths_[l], n);
    const N faster = apart(velocity_, link.one, link.other, n) - rate_of(lengths_[l], n);
    apply(link.one, link.other, -(link.stiffness * longer + link.damping * faster));
  }
  /// Order n of the force of a feedback, and the next order of the integral of its error.
  void control(std::size_t f, int n, T next) {
    const bodies::Feedback<T>& c = system_->feedbacks[f];
    if (c.sampled()) {
      if (n > 0) control_[f][n] = N(T(0));
      integral_[f][n + 1] = N(T(0));
    } else {
      const N error = given(references_[f], n) - apart(position_, c.measured, c.against, n);
      const N rate = rate_of(references_[f], n) - apart(velocity_, c.measured, c.against, n);
      control_[f][n] = c.force(error, rate, integral_[f][n]);
      integral_[f][n + 1] = next * error;
    }
    apply(c.one, c.other, control_[f][n]);
  }
  /// Order n of the friction of a contact that slips, or of skin that sticks, with the next order of its stretch.
  void rub(std::size_t j, int n, T next) {
    const bodies::Contact<T>& c = contact(j);
    if (mode_[j] != bodies::Slip::stick) {
      friction_[j][n] = T(-static_cast<int>(mode_[j])) * (c.kinetic * load(j, n));
    } else {
      const N speed = speed_of(j, n);
      friction_[j][n] = -(c.stiffness * stretch_[j][n] + c.damping * speed);
      stretch_[j][n + 1] = next * speed;
    }
    apply(c.one, c.other, friction_[j][n]);
  }
  /// Order n of the speed of `one` over the surface.
  N speed_of(std::size_t j, int n) const {
    const bodies::Contact<T>& c = contact(j);
    const N speed = apart(velocity_, c.one, c.other, n);
    return n <= surfaces_[j].degree() ? speed - given(surfaces_[j], n) : speed;
  }
  /// Sliding speed of a contact, and the stretch of skin that slips, which no body feels.
  void slide(std::size_t j) {
    const bodies::Contact<T>& c = contact(j);
    const bool sticks = mode_[j] == bodies::Slip::stick;
    for (int n = 0; n <= order_count_; ++n)
      sliding_[j][n] = sticks && !c.rigid() ? N(T(0)) : speed_of(j, n);
    if (sticks || c.rigid()) return;
    for (int n = 0; n <= order_count_; ++n) {
      const N kinetic = -friction_[j][n];
      N rate{};
      if (settled_[j]) {
        stretch_[j][n] = kinetic / c.stiffness;
      } else if (c.damping != 0) {
        rate = (kinetic - c.stiffness * stretch_[j][n]) / c.damping;
        stretch_[j][n + 1] = (T(step_) / T(n + 1)) * rate;
      } else {
        rate = T(static_cast<int>(mode_[j])) * (c.kinetic / c.stiffness * load_rate(j, n));
        stretch_[j][n] = kinetic / c.stiffness;
      }
      sliding_[j][n] -= rate;
    }
  }

  /// Order n of the depth of a stop, and of the force of an elastic one.
  void press(std::size_t s, int n) {
    const bodies::Stop<T>& stop = system_->stops[s];
    N beyond = apart(position_, stop.one, stop.other, n);
    if (n == 0) beyond -= with_error(stop.position);
    depth_[s][n] = side(s) * beyond;
    approach_[s][n] = side(s) * apart(velocity_, stop.one, stop.other, n);
    push_[s][n] = N(T(0));
    if (stop.rigid()) return;  // joined bodies have the force of one that pushes
    push_[s][n] = stop.stiffness * depth_[s][n] + stop.damping * approach_[s][n];
    if (mode_[contacts() + s] == bodies::Slip::stick)
      apply(stop.one, stop.other, -(side(s) * push_[s][n]));
  }

  const bodies::System<T>* system_;
  Mode mode_;
  JoinedBodies<T> joined_;
  typename JoinedBodies<T>::template Order<N> order_;
  std::vector<Series> position_, velocity_, stretch_, sliding_;
  std::vector<char> settled_;  ///< skin that slips and keeps its stretch, contact by contact
  std::vector<Series> friction_, depth_, approach_, push_, control_, integral_;
  std::vector<Acting> acting_;
  int order_count_{0};
  Real step_{1};  ///< s
  Real late_{0};  ///< resolution of the time over the step
  std::vector<InputSeries<T>> pushes_, lengths_, loads_, surfaces_, references_;
};

}  // namespace pindrive::detail
