/// pindrive: the exact motion of a pin that friction moves, event by event. SI units throughout.
///
///     #include <pindrive.hpp>
///
///     const pindrive::Drive<double> drive{0.010, 100.0, 0.40, {0.020, 0.020}, {0.005, 0.005}};
///     const pindrive::Inputs<double> release{0.10, 1.5e-3, 0.10};  // mouse velocity, x(0), x'(0)
///     std::vector<pindrive::Segment<double>> segments;
///     const auto outcome = pindrive::simulate(
///         drive, release, [&](const auto& segment) { segments.push_back(segment); });
///     const pindrive::Motion<double> motion(drive, release, segments.data(), segments.size(), outcome);
///     const auto [segment, tau] = motion.locate(0.02, pindrive::Side::right);
///     const double x = segment->flow.position.at(segment->flow.oscillator, tau);  // x(0.02 s)
///
/// `summarise` gives all numbers of a motion at once, `certify` proves one against the laws of
/// motion, `Dual` makes everything its own derivative, `Stepper` goes on from time to time under inputs that
/// are set on the way. Names in `pindrive::detail` are internal.
#pragma once

#include "pindrive/certificate/certify.hpp"  // IWYU pragma: export
#include "pindrive/engine.hpp"               // IWYU pragma: export
#include "pindrive/events/simulate.hpp"      // IWYU pragma: export
#include "pindrive/events/stepper.hpp"       // IWYU pragma: export
#include "pindrive/model/model.hpp"          // IWYU pragma: export
#include "pindrive/motion/batch.hpp"         // IWYU pragma: export
#include "pindrive/motion/crossings.hpp"     // IWYU pragma: export
#include "pindrive/motion/energy.hpp"        // IWYU pragma: export
#include "pindrive/motion/motion.hpp"        // IWYU pragma: export
#include "pindrive/motion/sampling.hpp"      // IWYU pragma: export
#include "pindrive/motion/transient.hpp"     // IWYU pragma: export
#include "pindrive/numbers/dual.hpp"         // IWYU pragma: export
