// Arrays in and out of the exact core. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "pindrive/certify.hpp"
#include "pindrive/energy.hpp"
#include "pindrive/motion.hpp"
#include "pindrive/simulate.hpp"
#include "pindrive/transient.hpp"

namespace nb = nanobind;
namespace pd = pindrive;
using nb::literals::operator""_a;

namespace {

using Times = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class T>
using Array = nb::ndarray<nb::numpy, T, nb::ndim<1>, nb::c_contig>;

template <class T>
Array<T> to_array(std::vector<T>&& values) {
  auto* owned = new std::vector<T>(std::move(values));
  nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return Array<T>(owned->data(), {owned->size()}, owner);
}

/// A motion that owns its segments.
class CoreMotion {
 public:
  CoreMotion(const pd::Drive<double>& drive, const pd::Inputs<double>& inputs)
      : drive_(drive), inputs_(inputs) {
    outcome_ = pd::simulate(drive, inputs,
                            [this](const pd::Segment<double>& s) { segments_.push_back(s); });
  }
  pd::Motion<double> view() const {
    return {drive_, inputs_, segments_.data(), segments_.size(), outcome_};
  }
  const std::vector<pd::Segment<double>>& segments() const { return segments_; }
  const pd::Outcome<double>& outcome() const { return outcome_; }

 private:
  pd::Drive<double> drive_;
  pd::Inputs<double> inputs_;
  std::vector<pd::Segment<double>> segments_;
  pd::Outcome<double> outcome_;
};

CoreMotion simulate(double mass, double stiffness, double damping, double plate_kinetic,
                    double plate_static, double finger_kinetic, double finger_static,
                    double mouse_velocity, double displacement, double velocity, double duration) {
  const nb::gil_scoped_release unlocked;
  return {
      {mass, stiffness, damping, {plate_kinetic, plate_static}, {finger_kinetic, finger_static}},
      {mouse_velocity, displacement, velocity, duration}};
}

/// f(segment, τ) at each time.
template <class Function>
Array<double> at_times(const CoreMotion& motion, const Times& times, bool right, Function&& f) {
  std::vector<double> values(times.size());
  {
    const nb::gil_scoped_release unlocked;
    const auto view = motion.view();
    const auto side = right ? pd::Side::right : pd::Side::left;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto [segment, tau] = view.locate(times.data()[i], side);
      values[i] = f(*segment, tau);
    }
  }
  return to_array(std::move(values));
}

using FlowPath = pd::Path<double> pd::Flow<double>::*;

template <FlowPath path>
Array<double> evaluate(const CoreMotion& motion, const Times& times, bool right) {
  return at_times(motion, times, right, [](const pd::Segment<double>& segment, double tau) {
    return (segment.flow.*path).at(segment.flow.oscillator, tau);
  });
}

template <double pd::Friction<double>::Forces::* contact>
Array<double> force(const CoreMotion& motion, const Times& times, bool right) {
  const auto friction = motion.view().friction();
  return at_times(motion, times, right, [&](const pd::Segment<double>& segment, double tau) {
    const double x = segment.flow.position.at(segment.flow.oscillator, tau);
    return friction.forces(segment.mode, x).*contact;
  });
}

/// One column of the list of segments.
template <class T, class Function>
Array<T> column(const CoreMotion& motion, Function&& f) {
  std::vector<T> values;
  values.reserve(motion.segments().size());
  for (const auto& segment : motion.segments()) values.push_back(static_cast<T>(f(segment)));
  return to_array(std::move(values));
}

nb::dict segments(const CoreMotion& motion) {
  using Segment = pd::Segment<double>;
  nb::dict table;
  table["begin"] = column<double>(motion, [](const Segment& s) { return s.begin; });
  table["end"] = column<double>(motion, [](const Segment& s) { return s.end; });
  table["position"] =
      column<double>(motion, [](const Segment& s) { return s.flow.position.start; });
  table["velocity"] =
      column<double>(motion, [](const Segment& s) { return s.flow.velocity.start; });
  table["plate"] = column<std::int8_t>(motion, [](const Segment& s) { return s.mode.plate; });
  table["finger"] = column<std::int8_t>(motion, [](const Segment& s) { return s.mode.finger; });
  table["event"] = column<std::int8_t>(motion, [](const Segment& s) { return s.event.kind; });
  table["event_contacts"] = column<std::int8_t>(
      motion, [](const Segment& s) { return (s.event.plate ? 1 : 0) + (s.event.finger ? 2 : 0); });
  return table;
}

nb::dict contact_use(const pd::ContactUse<double>& use) {
  nb::dict d;
  d["reversals"] = static_cast<long long>(use.reversals);
  d["time_stuck"] = use.time_stuck;
  d["distance_slid"] = use.distance_slid;
  d["dissipated"] = use.dissipated;
  d["peak_force"] = use.peak_force;
  return d;
}

nb::dict transient(const CoreMotion& motion, double duration, double band) {
  const auto view = motion.view();
  const auto t = pd::Measurement<double>(view, duration).transient(band);
  nb::dict d;
  d["peak_displacement"] = t.peak_displacement;
  d["peak_time"] = t.peak_time;
  d["trough_displacement"] = t.trough_displacement;
  d["trough_time"] = t.trough_time;
  d["swing"] = t.swing;
  d["return_velocity"] = t.return_velocity;
  d["return_velocity_time"] = t.return_velocity_time;
  d["first_reversal_time"] = t.first_reversal_time;
  d["settling_time"] = t.settling_time;
  d["end_position"] = t.end_position;
  d["amplitude"] = t.amplitude;
  d["plate"] = contact_use(t.plate);
  d["finger"] = contact_use(t.finger);
  return d;
}

nb::dict ledger(const CoreMotion& motion, double duration) {
  const auto l = pd::energy_ledger(motion.view(), duration);
  nb::dict d;
  d["kinetic_start"] = l.kinetic_start;
  d["kinetic_end"] = l.kinetic_end;
  d["spring_start"] = l.spring_start;
  d["spring_end"] = l.spring_end;
  d["plate_work"] = l.plate_work;
  d["damper_dissipated"] = l.damper_dissipated;
  d["plate_dissipated"] = l.plate_dissipated;
  d["finger_dissipated"] = l.finger_dissipated;
  d["residual"] = l.residual();
  return d;
}

nb::dict certificate(const CoreMotion& motion, double duration) {
  const auto view = motion.view();
  const auto c = pd::Certifier<double>(view, duration).certify();
  nb::dict d;
  d["motion_law"] = c.motion_law;
  d["kinematics"] = c.kinematics;
  d["force_bound"] = c.force_bound;
  d["sliding_sign"] = c.sliding_sign;
  d["sticking"] = c.sticking;
  d["continuity"] = c.continuity;
  d["transitions"] = c.transitions;
  d["energy"] = c.energy;
  d["dissipation"] = c.dissipation;
  return d;
}

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "The exact core. All quantities in SI units; nothing is checked here.";

  nb::class_<CoreMotion>(m, "Motion", "A simulated motion and its segments.")
      .def("position", &evaluate<&pd::Flow<double>::position>, "times"_a, "right"_a)
      .def("velocity", &evaluate<&pd::Flow<double>::velocity>, "times"_a, "right"_a)
      .def("acceleration", &evaluate<&pd::Flow<double>::acceleration>, "times"_a, "right"_a)
      .def("plate_force", &force<&pd::Friction<double>::Forces::plate>, "times"_a, "right"_a)
      .def("finger_force", &force<&pd::Friction<double>::Forces::finger>, "times"_a, "right"_a)
      .def("segments", &segments, "Columns, one row a segment.")
      .def("transient", &transient, "duration"_a, "band"_a)
      .def("ledger", &ledger, "duration"_a)
      .def("certificate", &certificate, "duration"_a)
      .def_prop_ro("duration", [](const CoreMotion& c) { return pd::duration_of(c.view()); })
      .def_prop_ro("known_until", [](const CoreMotion& c) { return c.view().known_until(); })
      .def_prop_ro("status",
                   [](const CoreMotion& c) { return static_cast<int>(c.outcome().status); })
      .def_prop_ro("end", [](const CoreMotion& c) { return static_cast<int>(c.outcome().end); })
      .def_prop_ro("since", [](const CoreMotion& c) { return c.outcome().since; })
      .def_prop_ro("period", [](const CoreMotion& c) { return c.outcome().period; })
      .def_prop_ro("until", [](const CoreMotion& c) { return c.outcome().until; });

  m.def("simulate", &simulate, "mass"_a, "stiffness"_a, "damping"_a, "plate_kinetic"_a,
        "plate_static"_a, "finger_kinetic"_a, "finger_static"_a, "mouse_velocity"_a,
        "displacement"_a, "velocity"_a, "duration"_a,
        "Simulates one pin from its release until its ending is known or the duration is over.");
  m.attr("settling_band") = pd::settling_band;
  m.attr("event_limit") = pd::event_limit;
}
