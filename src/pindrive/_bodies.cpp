// Systems of several bodies: arrays in and out of include/pindrive/bodies. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "_input.hpp"
#include "arrays.hpp"
#include "function_sum.hpp"
#include "interrupt.hpp"
#include "pindrive/bodies/follow.hpp"
#include "pindrive/bodies/step_certificate.hpp"
#include "pindrive/bodies/stored_motion.hpp"
#include "pindrive/bodies/system.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
namespace bodies = pindrive::bodies;
using nb::literals::operator""_a;

namespace {

using Dual = pd::Dual<double>;
using pd::number, pd::plain, pd::result;
/// Mass, force, position, velocity.
using BodyNumbers = std::tuple<double, Input, double, double>;
/// First and second body (−1: ground), stiffness, damping, length.
using LinkNumbers = std::tuple<int, int, double, double, Input>;
/// First and second body, kinetic and static friction, stiffness, damping, load, velocity, stretch, mode that presses
/// it, share.
using ContactNumbers =
    std::tuple<int, int, double, double, double, double, Input, Input, double, int, double>;
/// First and second body, position, side, stiffness, damping, restitution.
using StopNumbers = std::tuple<int, int, double, int, double, double, double>;
/// Bodies of the force, bodies whose distance is measured, gains of position, velocity and integral, reference, period.
using FeedbackNumbers = std::tuple<int, int, int, int, double, double, double, Input, double>;
using SystemNumbers =
    std::tuple<std::vector<BodyNumbers>, std::vector<LinkNumbers>, std::vector<ContactNumbers>,
               std::vector<StopNumbers>, std::vector<FeedbackNumbers>>;

/// A system with its initial state, and the arrays to which its inputs refer.
template <class T>
class OwnedSystem {
 public:
  OwnedSystem(SystemNumbers at, SystemNumbers along) {
    auto& [bodies, links, contacts, stops, feedbacks] = at;
    auto& [bodies_along, links_along, contacts_along, stops_along, feedbacks_along] = along;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      auto& [mass, force, position, velocity] = bodies[i];
      auto& [mass_rate, force_rate, position_rate, velocity_rate] = bodies_along[i];
      system_.bodies.push_back({number<T>(mass, mass_rate), own(force, force_rate)});
      state_.position.push_back(number<T>(position, position_rate));
      state_.velocity.push_back(number<T>(velocity, velocity_rate));
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      auto& [one, other, stiffness, damping, length] = links[i];
      auto& [one_, other_, stiffness_rate, damping_rate, length_rate] = links_along[i];
      system_.links.push_back({one, other, number<T>(stiffness, stiffness_rate),
                               number<T>(damping, damping_rate), own(length, length_rate)});
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      auto& [one, other, kinetic, fixed, stiffness, damping, load, velocity, stretch, by, share] =
          contacts[i];
      auto& [one_, other_, kinetic_rate, fixed_rate, stiffness_rate, damping_rate, load_rate,
             velocity_rate, stretch_rate, by_, share_rate] = contacts_along[i];
      system_.contacts.push_back(
          {one, other, number<T>(kinetic, kinetic_rate), number<T>(fixed, fixed_rate),
           number<T>(stiffness, stiffness_rate), number<T>(damping, damping_rate),
           own(load, load_rate), own(velocity, velocity_rate), by, number<T>(share, share_rate)});
      state_.stretch.push_back(number<T>(stretch, stretch_rate));
    }
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const auto& [one, other, position, side, stiffness, damping, restitution] = stops[i];
      const auto& [one_, other_, position_rate, side_, stiffness_rate, damping_rate,
                   restitution_rate] = stops_along[i];
      system_.stops.push_back({one, other, number<T>(position, position_rate), side,
                               number<T>(stiffness, stiffness_rate),
                               number<T>(damping, damping_rate),
                               number<T>(restitution, restitution_rate)});
    }
    for (std::size_t i = 0; i < feedbacks.size(); ++i) {
      auto& [one, other, measured, against, position, velocity, sum, reference, period] =
          feedbacks[i];
      auto& [one_, other_, measured_, against_, position_rate, velocity_rate, sum_rate,
             reference_rate, period_] = feedbacks_along[i];
      system_.feedbacks.push_back({one, other, measured, against,
                                   number<T>(position, position_rate),
                                   number<T>(velocity, velocity_rate), number<T>(sum, sum_rate),
                                   own(reference, reference_rate), period});
    }
  }

  const bodies::System<T>& system() const { return system_; }
  const bodies::State<T>& state() const { return state_; }

 private:
  pd::Profile<T> own(Input& at, Input& along) {
    inputs_.push_back(
        std::make_unique<pd::OwnedInput<T>>(input_of(std::move(at)), input_of(std::move(along))));
    return inputs_.back()->profile();
  }

  std::vector<std::unique_ptr<pd::OwnedInput<T>>> inputs_;
  bodies::System<T> system_;
  bodies::State<T> state_;
};

constexpr double never = std::numeric_limits<double>::infinity();
/// Time within which a motion without a duration must come to rest, s.
constexpr double longest = 1e6;
constexpr double seen_at_rest =
    1.25;  ///< end of such a motion over the time at which it comes to rest

/// A motion that was followed, with its events and its status.
template <class T>
struct Followed {
  bodies::StoredMotion<T> motion;
  std::vector<bodies::Change<T>> changes;
  pd::Status status;
  bool rests;
  std::size_t body_count, contact_count, stop_count, feedback_count;
};

template <class T>
std::unique_ptr<Followed<T>> follow(SystemNumbers at, SystemNumbers along, double duration,
                                    std::size_t most_steps = 0) {
  const OwnedSystem<T> owned(std::move(at), std::move(along));
  return interruptible([&](auto go_on) {
    const bodies::System<T>& system = owned.system();
    bodies::StoredMotion<T> motion(system);
    bodies::Following<T> following(system, owned.state());
    bool interrupted = false;
    const auto keep = [&](const bodies::Step<T>& step) {
      motion.add(step);
      interrupted = !go_on();
      return !interrupted;
    };
    if (duration < never)
      following.advance(T(duration), keep);
    else
      following.advance_to_rest(T(longest), [&](const bodies::Step<T>& step) {
        return keep(step) && motion.steps() < most_steps;
      });
    if (!(duration < never) && following.resting()) {
      const double rest = plain(following.state().time);
      following.advance(T(rest > 0 ? rest * seen_at_rest : 1), keep);
    }
    const bool whole = following.status() == pd::Status::stopped && !interrupted;
    return std::make_unique<Followed<T>>(Followed<T>{
        std::move(motion), following.changes(), whole ? pd::Status::ok : following.status(),
        following.resting(), system.bodies.size(), system.contacts.size(), system.stops.size(),
        system.feedbacks.size()});
  });
}

/// Quantities at times: rows of bodies and then of contacts, each over all times.
template <class T>
nb::tuple at(const Followed<T>& followed, const Column& times, bool right) {
  const std::size_t count = times.size(), size = followed.body_count,
                    contacts = followed.contact_count, stops = followed.stop_count,
                    feedbacks = followed.feedback_count;
  std::vector<double> moving(3 * size * count), touching(4 * contacts * count),
      pushing((stops + feedbacks) * count);
  interruptible([&](auto go_on) {
    bodies::Quantities<T> found;
    for (std::size_t k = 0; k < count && go_on(); ++k) {
      followed.motion.at(times.data()[k], right, found);
      for (std::size_t i = 0; i < size; ++i) {
        moving[i * count + k] = result(found.position[i]);
        moving[(size + i) * count + k] = result(found.velocity[i]);
        moving[(2 * size + i) * count + k] = result(found.acceleration[i]);
      }
      for (std::size_t j = 0; j < contacts; ++j) {
        touching[j * count + k] = result(found.friction[j]);
        touching[(contacts + j) * count + k] = result(found.stretch[j]);
        touching[(2 * contacts + j) * count + k] = result(found.sliding[j]);
        touching[(3 * contacts + j) * count + k] = static_cast<double>(found.slip[j]);
      }
      for (std::size_t s = 0; s < stops; ++s) pushing[s * count + k] = result(found.push[s]);
      for (std::size_t f = 0; f < feedbacks; ++f)
        pushing[(stops + f) * count + k] = result(found.control[f]);
    }
    return true;
  });
  return nb::make_tuple(to_array(std::move(moving)), to_array(std::move(touching)),
                        to_array(std::move(pushing)));
}

template <class T>
nb::dict changes(const Followed<T>& followed) {
  const auto column = [&](auto&& of) {
    return mapped<double>(followed.changes.size(),
                          [&](std::size_t i) { return of(followed.changes[i]); });
  };
  using Change = bodies::Change<T>;
  nb::dict table;
  table["time"] = column([](const Change& c) { return result(c.time); });
  table["contact"] = column([](const Change& c) { return c.contact; });
  table["before"] = column([](const Change& c) { return static_cast<int>(c.before); });
  table["after"] = column([](const Change& c) { return static_cast<int>(c.after); });
  return table;
}

nb::dict certify(SystemNumbers given, double duration) {
  const SystemNumbers along = given;
  const OwnedSystem<double> owned(std::move(given), along);
  const auto [worst, ledger] = interruptible([&](auto go_on) {
    bodies::StepCertificate<double> certificate(owned.system());
    bodies::Following<double> following(owned.system(), owned.state());
    following.advance(duration, [&](const bodies::Step<double>& step) {
      certificate.add(step);
      return go_on();
    });
    return std::make_pair(certificate.violations(), certificate.ledger());
  });
  nb::dict laws, energy;
  laws["motion"] = worst.motion;
  laws["kinematics"] = worst.kinematics;
  laws["friction"] = worst.friction;
  laws["sliding"] = worst.sliding;
  laws["stops"] = worst.stops;
  laws["continuity"] = worst.continuity;
  laws["energy"] = worst.energy;
  energy["before"] = ledger.before;
  energy["after"] = ledger.after;
  energy["inputs"] = ledger.inputs;
  energy["dampers"] = ledger.dampers;
  energy["contacts"] = ledger.contacts;
  energy["stops"] = ledger.stops;
  nb::dict both;
  both["laws"] = laws;
  both["energy"] = energy;
  return both;
}

/// Pieces of the integral of a function, or of its derivative along a direction.
template <class T>
std::vector<Piece> integral(std::vector<Piece> at, std::vector<Piece> along) {
  const pd::FunctionPieces<T> found =
      pd::integral_of(pd::pieces_of<T>(input_of(std::move(at)), input_of(std::move(along))));
  std::vector<Piece> pieces;
  for (const pd::FunctionPiece<T>& piece : found) {
    auto& [begin, polynomial, terms] = pieces.emplace_back();
    begin = result(piece.begin);
    for (std::size_t n = 0; n < polynomial.size(); ++n) polynomial[n] = result(piece.polynomial[n]);
    for (const auto& [cosine, sine, decay, frequency] : piece.terms)
      terms.push_back({result(cosine), result(sine), result(decay), result(frequency)});
  }
  return pieces;
}

template <class T>
nb::class_<Followed<T>> bind(nb::module_& m, const char* name, const char* meaning) {
  nb::class_<Followed<T>> bound(m, name, meaning);
  return bound
      .def("at", &at<T>, "times"_a, "right"_a,
           "Position, velocity and acceleration of each body, and friction, stretch, sliding speed "
           "and slip of each "
           "contact, and the force of each stop and of each feedback, over all times.")
      .def("changes", &changes<T>, "Columns, one row an event.");
}

}  // namespace

void bind_bodies(nb::module_& m) {
  using Motion = Followed<double>;
  bind<double>(m, "SystemMotion", "A simulated motion of several bodies.")
      .def_prop_ro("status", [](const Motion& f) { return static_cast<int>(f.status); })
      .def_prop_ro("rests", [](const Motion& f) { return f.rests; })
      .def(
          "range", [](const Motion& f, std::size_t body) { return f.motion.range(body); }, "body"_a,
          "Least and largest position of a body.")
      .def_prop_ro("end", [](const Motion& f) { return f.motion.end(); })
      .def_prop_ro("step_count", [](const Motion& f) { return f.motion.steps(); });
  bind<Dual>(m, "SystemDerivative", "The derivatives of such a motion along a direction.");
  m.def(
      "simulate_system",
      [](SystemNumbers numbers, double duration, std::size_t most_steps) {
        const SystemNumbers along = numbers;
        return follow<double>(std::move(numbers), along, duration, most_steps);
      },
      "numbers"_a, "duration"_a, "most_steps"_a = 0,
      "Simulates several bodies; without a duration until they rest, or for so many steps. Bodies "
      "are (mass, force, position, velocity); springs (first "
      "body, second or -1, "
      "stiffness, damping, length); contacts (first body, second or -1, kinetic, static, "
      "stiffness, damping, load, "
      "velocity, stretch, place of what presses it or -1, share); stops (first body, second or -1, "
      "position, side, stiffness, damping, restitution); feedbacks (both bodies of the force, both "
      "bodies that are measured, gains of position, velocity and integral, reference, period).");
  m.def(
      "differentiate_system",
      [](SystemNumbers numbers, SystemNumbers along, double duration) {
        return follow<Dual>(std::move(numbers), std::move(along), duration);
      },
      "numbers"_a, "along"_a, "duration"_a,
      "The derivatives of a motion of several bodies along a direction.");
  m.def(
      "input_at",
      [](Input input, const Column& times, bool right) {
        const pd::InputNumbers numbers = input_of(std::move(input));
        const pd::OwnedInput<double> owned(numbers, numbers);
        const pd::Profile<double> profile = owned.profile();
        std::vector<double> values, rates;
        for (std::size_t i = 0; i < times.size(); ++i) {
          const double t = times.data()[i];
          // On the left of a breakpoint the course before it holds.
          const double since = right ? t : std::nextafter(t, -never);
          const pd::Curve<double> curve = profile.from(since);
          values.push_back(curve.at(t - since));
          rates.push_back(curve.rate_at(t - since));
        }
        return nb::make_tuple(to_array(std::move(values)), to_array(std::move(rates)));
      },
      "input"_a, "times"_a, "right"_a, "Values and rates of an input at times.");
  m.def(
      "function_integral",
      [](std::vector<Piece> pieces) {
        const std::vector<Piece> along = pieces;
        return integral<double>(std::move(pieces), along);
      },
      "pieces"_a, "The pieces of the integral of a function from t = 0 on.");
  m.def("function_integral_along", &integral<Dual>, "pieces"_a, "along"_a,
        "The derivative of that integral along a direction of the pieces.");
  m.def("certify_system", &certify, "numbers"_a, "duration"_a,
        "The worst violation of each law, and the energy.");
}
