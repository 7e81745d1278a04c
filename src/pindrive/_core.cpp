// Arrays in and out of the exact core. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/complex.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "_contact.hpp"
#include "_input.hpp"
#include "arrays.hpp"
#include "function_sum.hpp"
#include "interrupt.hpp"
#include "owned_motion.hpp"
#include "pindrive/engine.hpp"
#include "pindrive/model/input_period.hpp"
#include "pindrive/model/named_function.hpp"
#include "pindrive/series/input_range.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
using nb::literals::operator""_a;

namespace {

using Times = Column;

// ---- what Python hands over ----------------------------------------------------------------------

using pd::result, pd::Rows;
template <class T>
using CoreMotion = pd::StoredMotion<T>;
using Dual = pd::Dual<double>;
/// Travel, stiffness, damping of the end stops.
using StopNumbers = std::tuple<double, double, double>;
/// Mass, stiffness, damping; plate, finger; mouse velocity and plate load; displacement, velocity, skin
/// stretch; the force, the velocity across and the finger's load; the end stops; duration; support.
using Numbers =
    std::tuple<double, double, double, ContactNumbers, ContactNumbers, Input, Input, double, double,
               double, Input, Input, Input, StopNumbers, double, double>;

std::vector<Piece> numbers_of(pd::Pieces pieces) {
  std::vector<Piece> found;
  for (pd::PieceNumbers& piece : pieces)
    found.emplace_back(piece.begin, piece.polynomial, std::move(piece.terms));
  return found;
}

/// Pieces of a named function, whose numbers and coefficients are double, or complex with a derivative as
/// imaginary part.
template <class Number, class T>
auto pieces_of(const std::string& kind, const std::array<Number, 4>& numbers) {
  using Terms = std::vector<std::array<Number, 4>>;
  const auto given = [](const T& x) -> Number {
    if constexpr (std::is_same_v<T, double>)
      return x;
    else
      return {x.value, x.slope};
  };
  std::array<T, 4> made;
  for (std::size_t i = 0; i < 4; ++i) {
    if constexpr (std::is_same_v<T, double>)
      made[i] = numbers[i];
    else
      made[i] = {numbers[i].real(), numbers[i].imag()};
  }
  const pd::NamedFunction<T> function = pd::named_function(*pd::function_kind(kind.c_str()), made);
  std::vector<std::tuple<Number, std::array<Number, 6>, Terms>> pieces;
  for (std::size_t i = 0; i < function.count; ++i) {
    const pd::InputPiece<T>& piece = function.pieces[i].piece;
    std::array<Number, 6> polynomial;
    std::transform(piece.polynomial.begin(), piece.polynomial.end(), polynomial.begin(), given);
    Terms terms;
    for (std::size_t j = 0; j < piece.count; ++j) {
      const pd::InputTerm<T>& term = piece.terms[j];
      terms.push_back(
          {given(term.cosine), given(term.sine), given(term.decay), given(term.frequency)});
    }
    pieces.emplace_back(given(piece.begin), polynomial, std::move(terms));
  }
  return pieces;
}

/// Moves an array without other owners into the core.
pd::Numbers numbers(double mass, double stiffness, double damping, ContactNumbers&& plate,
                    ContactNumbers&& finger, Input&& mouse_velocity, Input&& plate_load,
                    double displacement, double velocity, double skin_stretch, Input&& force,
                    Input&& across, Input&& finger_load, const StopNumbers& stops, double duration,
                    double support) {
  return {mass,
          stiffness,
          damping,
          contact_of(std::move(plate)),
          contact_of(std::move(finger)),
          input_of(std::move(mouse_velocity)),
          input_of(std::move(plate_load)),
          displacement,
          velocity,
          skin_stretch,
          input_of(std::move(force)),
          input_of(std::move(across)),
          input_of(std::move(finger_load)),
          as<pd::StopNumbers>(stops),
          duration,
          support};
}

/// Reports the simulated time of a long simulation, s, to a function of Python, which may be None.
class Progress {
 public:
  explicit Progress(const nb::object& report) : report_(report) {}

  void at(double time) {
    if (report_.is_none() || ++segments_ % 64 != 0 || Clock::now() < next_) return;
    next_ = Clock::now() + pause;
    const nb::gil_scoped_acquire locked;
    report_(time);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds first{500}, pause{100};

  const nb::object& report_;
  unsigned segments_{0};
  Clock::time_point next_{Clock::now() + first};
};

template <class T>
std::unique_ptr<CoreMotion<T>> run(const pd::Numbers& at, const pd::Numbers& along,
                                   const nb::object& report = nb::none()) {
  Progress progress(report);
  return interruptible([&](auto go_on) -> std::unique_ptr<CoreMotion<T>> {
    return std::make_unique<pd::OwnedMotion<T>>(at, along, [&](const pd::Segment<T>& segment) {
      if (!go_on()) return false;
      progress.at(result(segment.begin));
      return true;
    });
  });
}

std::unique_ptr<CoreMotion<Dual>> differentiate(Numbers at, Numbers along) {
  const auto of = [](Numbers&& given) {
    return std::apply([](auto&&... field) { return numbers(std::move(field)...); },
                      std::move(given));
  };
  return run<Dual>(of(std::move(at)), of(std::move(along)));
}

// ---- what Python asks for ------------------------------------------------------------------------

struct NamedQuantity {
  const char* name;
  pd::Sampled quantity;

  bool of_skin() const {
    return quantity == pd::Sampled::stretch || quantity == pd::Sampled::stretch_rate;
  }
};
/// In the order of the columns of a table.
constexpr NamedQuantity quantities[] = {
    {"position", pd::Sampled::position},         {"velocity", pd::Sampled::velocity},
    {"acceleration", pd::Sampled::acceleration}, {"plate_force", pd::Sampled::plate_force},
    {"finger_force", pd::Sampled::finger_force}, {"housing_force", pd::Sampled::housing_force},
    {"stop_force", pd::Sampled::stop_force},     {"stretch", pd::Sampled::stretch},
    {"stretch_rate", pd::Sampled::stretch_rate}};

pd::Side side_of(bool right) { return right ? pd::Side::right : pd::Side::left; }

/// A quantity at each time.
template <class T>
Array<double> evaluate(const CoreMotion<T>& motion, pd::Sampled quantity, const Times& times,
                       bool right) {
  return to_array(interruptible([&](auto go_on) {
    std::vector<double> values(times.size());
    pd::sample(motion.view(), times.data(), times.size(), side_of(right), &quantity, 1,
               [&](std::size_t i, const T* found) {
                 values[i] = result(*found);
                 return go_on();
               });
    return values;
  }));
}

/// Quantities at each time, by name, without quantities that the drive does not have.
nb::dict columns(const CoreMotion<double>& motion, const Times& times, bool right) {
  const pd::Drive<double>& drive = motion.drive();
  std::vector<pd::Sampled> asked;
  std::vector<const char*> names;
  for (const NamedQuantity& each : quantities) {
    if (each.of_skin() && drive.finger.rigid()) continue;
    if (each.quantity == pd::Sampled::stop_force && !drive.stops.present()) continue;
    asked.push_back(each.quantity);
    names.push_back(each.name);
  }
  auto found = interruptible([&](auto go_on) {
    std::vector<std::vector<double>> values(asked.size(), std::vector<double>(times.size()));
    pd::sample(motion.view(), times.data(), times.size(), side_of(right), asked.data(),
               asked.size(), [&](std::size_t i, const double* at) {
                 for (std::size_t k = 0; k < asked.size(); ++k) values[k][i] = at[k];
                 return go_on();
               });
    return values;
  });
  nb::dict table;
  for (std::size_t k = 0; k < asked.size(); ++k) table[names[k]] = to_array(std::move(found[k]));
  return table;
}

/// One column of the list of segments.
template <class N, class T, class Function>
Array<N> column(const CoreMotion<T>& motion, Function&& f) {
  return mapped<N>(motion.segments().size(),
                   [&](std::size_t i) { return f(motion.segments()[i]); });
}

template <class T>
nb::dict segments(const CoreMotion<T>& motion) {
  using Segment = pd::Segment<T>;
  nb::dict table;
  table["begin"] = column<double>(motion, [](const Segment& s) { return result(s.begin); });
  table["end"] = column<double>(motion, [](const Segment& s) { return result(s.end); });
  table["position"] =
      column<double>(motion, [](const Segment& s) { return result(s.flow.position.start); });
  table["velocity"] =
      column<double>(motion, [](const Segment& s) { return result(s.flow.velocity.start); });
  table["acceleration"] = column<double>(motion, [view = motion.view()](const Segment& s) {
    return result(pd::start_acceleration(view, s));
  });
  table["plate"] = column<std::int8_t>(motion, [](const Segment& s) { return s.mode.plate; });
  table["finger"] = column<std::int8_t>(motion, [](const Segment& s) { return s.mode.finger; });
  table["plate_branch"] =
      column<std::int32_t>(motion, [](const Segment& s) { return s.mode.plate_branch; });
  table["finger_branch"] =
      column<std::int32_t>(motion, [](const Segment& s) { return s.mode.finger_branch; });
  table["plate_event"] =
      column<std::int8_t>(motion, [](const Segment& s) { return s.event.plate; });
  table["finger_event"] =
      column<std::int8_t>(motion, [](const Segment& s) { return s.event.finger; });
  table["stop"] = column<std::int8_t>(motion, [](const Segment& s) { return s.mode.stop; });
  table["stop_event"] = column<std::int8_t>(motion, [](const Segment& s) { return s.event.stop; });
  return table;
}

/// Bound of the acceleration of the segments that are a step of a series; NaN for a closed form.
Array<double> acceleration_bounds(const CoreMotion<double>& motion) {
  return column<double>(motion, [view = motion.view()](const pd::Segment<double>& segment) {
    return pd::acceleration_bound(view, segment);
  });
}

/// The numbers of a result by their names.
template <class T, class Result, std::size_t count>
nb::dict named(const pd::NamedNumber<T, Result> (&numbers)[count], const Result& of) {
  nb::dict d;
  for (const auto& number : numbers) d[number.name] = result(number.of(of));
  return d;
}

template <class T>
nb::dict transient(const CoreMotion<T>& motion, double duration, double band) {
  const auto view = motion.view();
  return named(pd::transient_numbers<T>, interruptible([&](auto go_on) {
                 return pd::transient_of(view, T(duration), T(band), go_on);
               }));
}

template <class T>
nb::dict ledger(const CoreMotion<T>& motion, double duration) {
  return named(pd::ledger_numbers<T>, interruptible([&](auto go_on) {
                 const auto view = motion.view();
                 return pd::energy_ledger(view, T(duration), go_on);
               }));
}

/// Times and values at these times, up to a largest count, that a search adds.
template <class Seen, class Search>
nb::tuple found(std::size_t most, Search&& search) {
  auto both = interruptible([&](auto go_on) {
    std::pair<std::vector<double>, std::vector<Seen>> lists;
    const auto add = [&](double time, Seen seen) {
      lists.first.push_back(time);
      lists.second.push_back(seen);
      return lists.first.size() < most;
    };
    search(add, go_on);
    return lists;
  });
  return nb::make_tuple(to_array(std::move(both.first)), to_array(std::move(both.second)));
}

nb::tuple crossings(const CoreMotion<double>& motion, int quantity, double level, double until,
                    std::size_t most) {
  const auto view = motion.view();
  return found<std::int8_t>(most, [&](auto add, auto go_on) {
    pd::crossings(
        view, static_cast<pd::Quantity>(quantity), level, until,
        [&](double time, int side) { return add(time, static_cast<std::int8_t>(side)); }, go_on);
  });
}

nb::tuple extrema(const CoreMotion<double>& motion, int quantity, double until, std::size_t most) {
  const auto view = motion.view();
  return found<double>(most, [&](auto add, auto go_on) {
    pd::extrema(view, static_cast<pd::Quantity>(quantity), until, add, go_on);
  });
}

nb::tuple events(const CoreMotion<double>& motion, double from, double to, std::size_t most) {
  const auto view = motion.view();
  return found<std::int64_t>(most, [&](auto add, auto go_on) {
    pd::events(
        view, from, to,
        [&](double time, const pd::Segment<double>& segment) {
          return add(time, &segment - view.begin());
        },
        go_on);
  });
}

double duration(const CoreMotion<double>& motion, double band) {
  const auto view = motion.view();
  return interruptible([&](auto go_on) { return pd::duration_of(view, band, go_on); });
}

nb::dict certificate(const CoreMotion<double>& motion, double duration) {
  const auto view = motion.view();
  return named(pd::certificate_numbers<double>,
               interruptible([&](auto go_on) { return pd::certify(view, duration, go_on); }));
}

/// Common part of a motion and its derivatives.
template <class T>
nb::class_<CoreMotion<T>> bind(nb::module_& m, const char* name, const char* meaning) {
  nb::class_<CoreMotion<T>> bound(m, name, meaning);
  for (const auto& [called, quantity] : quantities)
    bound.def(
        called,
        [quantity = quantity](const CoreMotion<T>& motion, const Times& times, bool right) {
          return evaluate(motion, quantity, times, right);
        },
        "times"_a, "right"_a);
  return bound.def("segments", &segments<T>, "Columns, one row a segment.")
      .def("transient", &transient<T>, "duration"_a, "band"_a)
      .def("ledger", &ledger<T>, "duration"_a);
}

}  // namespace

void bind_batch(nb::module_& m);
void bind_bodies(nb::module_& m);
void bind_device(nb::module_& m);
void bind_scan(nb::module_& m);
void bind_evaluation(nb::module_& m);
void bind_inputs(nb::module_& m);

NB_MODULE(_core, m) {
  m.doc() = "The exact core. All quantities in SI units; nothing is checked here.";

  using Motion = CoreMotion<double>;
  bind<double>(m, "Motion", "A simulated motion and its segments.")
      .def("certificate", &certificate, "duration"_a)
      .def("columns", &columns, "times"_a, "right"_a, "What there is at each time, by name.")
      .def("duration", &duration, "band"_a)
      .def("crossings", &crossings, "quantity"_a, "level"_a, "until"_a, "most"_a,
           "Times and directions; position, velocity or acceleration is 0, 1 or 2.")
      .def("extrema", &extrema, "quantity"_a, "until"_a, "most"_a, "Times and values.")
      .def("events", &events, "begin"_a, "end"_a, "most"_a,
           "Times and the segments that the events end, cycles expanded.")
      .def("acceleration_bounds", &acceleration_bounds,
           "Of each segment without a closed form, what |x''| stays below, m/s²; else NaN.")
      .def_prop_ro("known_until", [](const Motion& c) { return c.view().known_until(); })
      .def_prop_ro("status", [](const Motion& c) { return static_cast<int>(c.outcome().status); })
      .def_prop_ro("end", [](const Motion& c) { return static_cast<int>(c.outcome().end); })
      .def_prop_ro("cycle_begin", [](const Motion& c) { return c.outcome().cycle_begin; })
      .def_prop_ro("until", [](const Motion& c) { return c.outcome().until; })
      .def_prop_ro("segment_count", [](const Motion& c) { return c.segments().size(); });
  bind<Dual>(m, "Derivative", "The derivatives of a motion along a direction of its inputs.");

  m.def(
      "simulate",
      [](double mass, double stiffness, double damping, ContactNumbers plate, ContactNumbers finger,
         Input mouse_velocity, Input plate_load, double displacement, double velocity,
         double skin_stretch, Input force, Input across_velocity, Input finger_load,
         const StopNumbers& stops, double duration, double support, const nb::object& progress) {
        const pd::Numbers at =
            numbers(mass, stiffness, damping, std::move(plate), std::move(finger),
                    std::move(mouse_velocity), std::move(plate_load), displacement, velocity,
                    skin_stretch, std::move(force), std::move(across_velocity),
                    std::move(finger_load), stops, duration, support);
        return run<double>(at, at, progress);
      },
      "mass"_a, "stiffness"_a, "damping"_a, "plate"_a, "finger"_a, "mouse_velocity"_a,
      "plate_load"_a, "displacement"_a, "velocity"_a, "skin_stretch"_a, "force"_a,
      "across_velocity"_a, "finger_load"_a, "stops"_a, "duration"_a, "support"_a,
      "progress"_a.none() = nb::none(),
      "Simulates one pin from its release until its ending is known or the duration is over. "
      "Contacts are (kinetic, static, stiffness, rows (speed, force) of the curve, (law, "
      "breakaway, Stribeck velocity, exponent, viscous)), inputs rows "
      "(time, value), one row for a constant, or the pieces (begin, polynomial, terms (cosine, "
      "sine, "
      "decay, frequency)) of a function. In a long simulation, progress is called with the "
      "simulated time.");
  m.def(
      "function_range",
      [](std::vector<Piece> pieces, double until) {
        const pd::InputNumbers input = input_of(std::move(pieces));
        const pd::OwnedInput<double> owned(input, input);
        const pd::InputPoint low = pd::lowest_value(owned.profile(), until);
        const pd::InputJump jump = pd::first_jump(owned.profile());
        return std::make_tuple(std::make_tuple(low.time, low.value),
                               std::make_tuple(jump.time, jump.before, jump.after));
      },
      "pieces"_a, "until"_a,
      "The lowest value of a function until a time (time, value), and its first jump (time, "
      "before, "
      "after), at an infinite time without one.");
  m.def(
      "input_period",
      [](std::vector<Input> inputs) {
        const auto owned = [&](std::size_t i) {
          const pd::InputNumbers input = input_of(std::move(inputs.at(i)));
          return std::make_unique<pd::OwnedInput<double>>(input, input);
        };
        const auto velocity = owned(0), load = owned(1), force = owned(2), across = owned(3),
                   touch = owned(4);
        const pd::InputPeriod<double> found = pd::period_of<double>(
            {velocity->profile(), 0, 0, std::numeric_limits<double>::infinity(), load->profile(), 0,
             force->profile(), across->profile(), touch->profile()});
        return std::make_tuple(found.since, found.period, found.constant);
      },
      "inputs"_a,
      "The time of the last breakpoint of all inputs (in the order of a release), their period "
      "from then "
      "on, infinite without one, and whether they are constant.");
  m.def(
      "function_at",
      [](std::vector<Piece> pieces, const Times& times) {
        const pd::InputNumbers input = input_of(std::move(pieces));
        const pd::OwnedInput<double> owned(input, input);
        const pd::Profile<double> profile = owned.profile();
        return mapped<double>(times.size(),
                              [&](std::size_t i) { return profile.from(times.data()[i]).value; });
      },
      "pieces"_a, "times"_a, "The values of a function at times (s).");
  m.def(
      "sum_of_functions",
      [](std::vector<Piece> one, std::vector<Piece> other) {
        return numbers_of(
            pd::sum_of(input_of(std::move(one)).pieces, input_of(std::move(other)).pieces));
      },
      "one"_a, "other"_a, "The pieces of the sum of two functions.");
  m.def(
      "function_from",
      [](std::vector<Piece> pieces, double time) {
        return numbers_of({pd::piece_from(input_of(std::move(pieces)).pieces, time)});
      },
      "pieces"_a, "time"_a, "The piece of a function from a time on (s), in a list.");
  m.def(
      "function_of_rows", [](Rows rows) { return numbers_of(pd::as_function({std::move(rows)})); },
      "rows"_a, "The pieces of rows (time, value); the later value holds at a step.");
  m.def("function_pieces", &pieces_of<double, double>, "kind"_a, "numbers"_a,
        "The pieces of a named function; four numbers, of which the last may have no effect.");
  m.def("function_pieces_along", &pieces_of<std::complex<double>, Dual>, "kind"_a, "numbers"_a,
        "As function_pieces; imaginary parts are derivatives along a direction.");
  nb::dict kinds;
  for (const pd::FunctionKind& kind : pd::function_kinds) {
    nb::list names;
    for (std::size_t i = 0; i < kind.count(); ++i) names.append(nb::str(kind.parameters[i]));
    kinds[kind.name] = nb::tuple(names);
  }
  m.attr("function_kinds") = kinds;
  m.def("differentiate", &differentiate, "numbers"_a, "along"_a,
        "The derivatives of a motion along a direction; both as the arguments of simulate.");
  bind_batch(m);
  bind_bodies(m);
  bind_device(m);
  bind_scan(m);
  bind_evaluation(m);
  bind_inputs(m);
  m.attr("settling_band") = pd::settling_band;
  m.attr("event_limit") = pd::event_limit;
  nb::dict statuses;  // Status in quantities/status.py
  statuses["ok"] = static_cast<int>(pd::Status::ok);
  statuses["too_many_events"] = static_cast<int>(pd::Status::too_many_events);
  statuses["standstill"] = static_cast<int>(pd::Status::standstill);
  statuses["stopped"] = static_cast<int>(pd::Status::stopped);
  statuses["inconsistent"] = static_cast<int>(pd::Status::inconsistent);
  statuses["too_many_periods"] = static_cast<int>(pd::Status::too_many_periods);
  m.attr("statuses") = statuses;
}
