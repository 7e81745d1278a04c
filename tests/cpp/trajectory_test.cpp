// The two forms of a segment's quantities beside each other: a segment in closed form has a series too, and
// both give the same values, rates, zeros and integrals.
#include "pindrive/motion/trajectory.hpp"

#include <vector>

#include "check.hpp"
#include "pindrive/events/simulate.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;

namespace {

struct Agreement {
  bool values{true}, rates{true}, changes{true}, integrals{true}, zeros{true}, starts{true};
  int count{0}, roots{0};
};

template <class One, class Other>
std::vector<double> zeros(const One& along, const Other& path, double span) {
  std::vector<double> found;
  const int side = along.side_after_start(path);
  along.each_root(path, side, span, [&](double tau) {
    found.push_back(tau);
    return true;
  });
  return found;
}

/// Compares the first part of a segment, short enough for one step.
void compare(const pd::Drive<double>& drive, const pd::Inputs<double>& inputs,
             pd::Segment<double> segment, Agreement& agree) {
  const double span =
      std::min(segment.end - segment.begin, 0.2 * std::sqrt(drive.mass / drive.stiffness));
  if (!(span > 0)) return;
  segment.end = segment.begin + span;
  segment.moved = segment.flow.after(span);
  const pd::detail::ClosedForm<double> closed(segment);
  pd::Segment<double> step = segment;  // of which a series has the begin alone
  step.flow.velocity.drift = segment.flow.acceleration().start;
  const pd::detail::BySeries<double> series(drive, step,
                                            pd::InputCurves<double>::of(drive, inputs, segment));
  ++agree.count;
  for (const double part : {0.0, 0.3, 0.7, 1.0}) {
    const double tau = part * span;
    const auto same = [&](const auto& p, const auto& q, double size) {
      const double one = closed.at(p, closed.moment(tau)), other = series.at(q, series.moment(tau));
      agree.values = agree.values && std::abs(one - other) <= 1e-13 * size &&
                     std::abs(closed.at(p, tau) - one) <= 1e-15 * size;
      agree.changes =
          agree.changes && std::abs(closed.change(p, tau) - series.change(q, tau)) <= 1e-13 * size;
    };
    same(closed.position(), series.position(), 1e-3);
    same(closed.velocity(), series.velocity(), 0.1);
    same(closed.plate_force(), series.plate_force(), 0.1);
    same(closed.finger_force(), series.finger_force(), 0.1);
    const double rate = closed.at(closed.derivative(closed.velocity()), tau);
    const double found = series.at(series.derivative(series.velocity()), tau);
    agree.rates = agree.rates && std::abs(rate - found) <= 1e-11 * 10 &&
                  std::abs(closed.at(closed.acceleration(), tau) - rate) <= 1e-12 * 10;
  }
  agree.starts = agree.starts && closed.start(closed.position()) == series.start(series.position());
  const double whole = closed.product_integral(closed.velocity(), closed.velocity(), 0, span);
  const double found = series.product_integral(series.velocity(), series.velocity(), 0, span);
  agree.integrals = agree.integrals && std::abs(whole - found) <= 1e-14 * 0.1 * 0.1 * span;
  const double level = closed.at(closed.velocity(), 0.6 * span);
  const auto one = zeros(closed, closed.above(closed.velocity(), level), span);
  const auto other = zeros(series, series.above(series.velocity(), level), span);
  agree.zeros = agree.zeros && one.size() == other.size();
  for (std::size_t i = 0; agree.zeros && i < one.size(); ++i, ++agree.roots)
    agree.zeros = near(one[i] / span, other[i] / span, 1e-10);
}

void both_forms() {
  Agreement agree;
  const double times[] = {0, 0.02, 0.06}, speeds[] = {0.02, 0.1, 0.05};
  for (const double skin : {std::numeric_limits<double>::infinity(), 400.0})
    for (const double damping : {0.0, 0.4, 2.0}) {
      const pd::Drive<double> drive{0.01, 100, damping, {0.02, 0.03}, {0.005, 0.006, skin}};
      const pd::Inputs<double> inputs{pd::Profile<double>(times, speeds, 3), 1.5e-3, 0.1, 0.1};
      pd::simulate(drive, inputs, [&](const auto& s) { compare(drive, inputs, s, agree); });
    }
  expect(agree.count > 20 && agree.roots > 10, "segments of six motions are compared");
  expect(agree.starts && agree.values, "positions, velocities and forces agree");
  expect(agree.rates, "... and accelerations,");
  expect(agree.changes, "... changes since the begin,");
  expect(agree.zeros, "... times at which a level is crossed");
  expect(agree.integrals, "... and integrals of products");
}

void lines() {
  pd::Segment<double> segment{};
  segment.begin = 1;
  segment.end = 2;
  segment.mode = {pd::ContactState::absent, pd::ContactState::absent};
  const pd::detail::ClosedForm<double> closed(segment);
  const pd::detail::BySeries<double> series({0.01, 100, 0.1, {}, {}}, segment, {});
  const pd::Curve<double> line{3, -1};
  expect(closed.at(closed.input(line), 0.5) == 2.5 && series.at(series.input(line), 0.5) == 2.5,
         "a line is a quantity of either form");
  expect(closed.constant(closed.input({3, 0})) && series.constant(series.input({3, 0})) &&
             !closed.constant(closed.input(line)) && !series.constant(series.input(line)),
         "... and constant without a rate");
  expect(!closed.waves() && closed.terms(closed.input(line), 0.5) == 3.5,
         "a pin at rest does not wave");
  expect(pd::detail::quantity_of(closed, pd::Quantity::velocity).start == 0,
         "a quantity has a name");
}

}  // namespace

int main() {
  both_forms();
  lines();
  return check::status();
}
