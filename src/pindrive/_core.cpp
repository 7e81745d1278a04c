// Arrays in and out of the exact core. No logic lives here.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>
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

using Rows = std::vector<std::pair<double, double>>;
using Regions = std::vector<std::tuple<double, double, double, double>>;

/// One contact as it comes from Python: kinetic, static, stiffness, and the regions of a curve.
struct ContactRows {
  double kinetic, static_limit, stiffness;
  std::vector<pd::Region<double>> regions;

  ContactRows(double kinetic, double static_limit, double stiffness, const Regions& curve)
      : kinetic(kinetic), static_limit(static_limit), stiffness(stiffness) {
    for (const auto& [from, to, force, slope] : curve) regions.push_back({from, to, force, slope});
  }
  pd::Contact<double> view() const {
    return {kinetic, static_limit, stiffness, regions.data(), static_cast<int>(regions.size())};
  }
};

/// An input as it comes from Python: one row is a constant.
struct ProfileRows {
  std::vector<double> times, values;

  explicit ProfileRows(const Rows& rows) {
    for (const auto& [time, value] : rows) {
      times.push_back(time);
      values.push_back(value);
    }
  }
  pd::Profile<double> view() const {
    if (times.size() == 1) return {values[0]};
    return {times.data(), values.data(), times.size()};
  }
};

/// A motion that owns its inputs and its segments.
class CoreMotion {
 public:
  CoreMotion(double mass, double stiffness, double damping, ContactRows plate, ContactRows finger,
             ProfileRows mouse_velocity, ProfileRows plate_load, double displacement,
             double velocity, double skin_stretch, double duration)
      : plate_(std::move(plate)),
        finger_(std::move(finger)),
        mouse_velocity_(std::move(mouse_velocity)),
        plate_load_(std::move(plate_load)),
        drive_{mass, stiffness, damping, plate_.view(), finger_.view()},
        inputs_{mouse_velocity_.view(), displacement, velocity, duration,
                plate_load_.view(),     skin_stretch},
        outcome_(pd::simulate(drive_, inputs_, [this](const pd::Segment<double>& segment) {
          segments_.push_back(segment);
        })) {}

  pd::Motion<double> view() const {
    return {drive_, inputs_, segments_.data(), segments_.size(), outcome_};
  }
  const std::vector<pd::Segment<double>>& segments() const { return segments_; }
  const pd::Outcome<double>& outcome() const { return outcome_; }
  const pd::Drive<double>& drive() const { return drive_; }

 private:
  ContactRows plate_, finger_;
  ProfileRows mouse_velocity_, plate_load_;
  pd::Drive<double> drive_;
  pd::Inputs<double> inputs_;
  std::vector<pd::Segment<double>> segments_;
  pd::Outcome<double> outcome_;
};

using ContactNumbers = std::tuple<double, double, double, Regions>;

std::unique_ptr<CoreMotion> simulate(double mass, double stiffness, double damping,
                                     const ContactNumbers& plate, const ContactNumbers& finger,
                                     const Rows& mouse_velocity, const Rows& plate_load,
                                     double displacement, double velocity, double skin_stretch,
                                     double duration) {
  const nb::gil_scoped_release unlocked;
  return std::make_unique<CoreMotion>(
      mass, stiffness, damping, std::make_from_tuple<ContactRows>(plate),
      std::make_from_tuple<ContactRows>(finger), ProfileRows(mouse_velocity),
      ProfileRows(plate_load), displacement, velocity, skin_stretch, duration);
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

using MotionView = pd::Motion<double>;

template <double MotionView::Friction::* contact>
Array<double> force(const CoreMotion& motion, const Times& times, bool right) {
  const auto view = motion.view();
  return at_times(motion, times, right, [&](const pd::Segment<double>& segment, double tau) {
    return view.friction(segment, tau).*contact;
  });
}

/// Stretch of a compliant finger's skin, or how fast it grows.
template <bool rate>
Array<double> stretch(const CoreMotion& motion, const Times& times, bool right) {
  const double stiffness = motion.drive().finger.stiffness;
  return at_times(motion, times, right, [=](const pd::Segment<double>& segment, double tau) {
    const auto& oscillator = segment.flow.oscillator;
    const auto& force = segment.finger_force;
    return -(rate ? force.derivative(oscillator) : force).at(oscillator, tau) / stiffness;
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
  table["acceleration"] =
      column<double>(motion, [](const Segment& s) { return s.flow.acceleration.start; });
  table["plate"] = column<std::int8_t>(motion, [](const Segment& s) { return s.mode.plate; });
  table["finger"] = column<std::int8_t>(motion, [](const Segment& s) { return s.mode.finger; });
  table["plate_event"] =
      column<std::int8_t>(motion, [](const Segment& s) { return s.event.plate; });
  table["finger_event"] =
      column<std::int8_t>(motion, [](const Segment& s) { return s.event.finger; });
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
  d["peak_stretch"] = t.peak_stretch;
  d["peak_stretch_rate"] = t.peak_stretch_rate;
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
  d["skin_start"] = l.skin_start;
  d["skin_end"] = l.skin_end;
  d["plate_work"] = l.plate_work;
  d["inertia_work"] = l.inertia_work;
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
  d["friction_law"] = c.friction_law;
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

void bind_batch(nb::module_& m);  // _batch.cpp

NB_MODULE(_core, m) {
  m.doc() = "The exact core. All quantities in SI units; nothing is checked here.";

  nb::class_<CoreMotion>(m, "Motion", "A simulated motion and its segments.")
      .def("position", &evaluate<&pd::Flow<double>::position>, "times"_a, "right"_a)
      .def("velocity", &evaluate<&pd::Flow<double>::velocity>, "times"_a, "right"_a)
      .def("acceleration", &evaluate<&pd::Flow<double>::acceleration>, "times"_a, "right"_a)
      .def("plate_force", &force<&MotionView::Friction::plate>, "times"_a, "right"_a)
      .def("finger_force", &force<&MotionView::Friction::finger>, "times"_a, "right"_a)
      .def("stretch", &stretch<false>, "times"_a, "right"_a)
      .def("stretch_rate", &stretch<true>, "times"_a, "right"_a)
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
      .def_prop_ro("cycle_begin", [](const CoreMotion& c) { return c.outcome().cycle_begin; })
      .def_prop_ro("until", [](const CoreMotion& c) { return c.outcome().until; });

  m.def("simulate", &simulate, "mass"_a, "stiffness"_a, "damping"_a, "plate"_a, "finger"_a,
        "mouse_velocity"_a, "plate_load"_a, "displacement"_a, "velocity"_a, "skin_stretch"_a,
        "duration"_a,
        "Simulates one pin from its release until its ending is known or the duration is over. "
        "Contacts are (kinetic, static, stiffness, regions of the curve), inputs rows (time, "
        "value).");
  bind_batch(m);
  m.attr("settling_band") = pd::settling_band;
  m.attr("event_limit") = pd::event_limit;
}
