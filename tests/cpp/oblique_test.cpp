// The friction of a plate that slides across too: its changes against differences of the friction itself, how a
// pin sets out from the plate and how it lands on it.
#include "pindrive/law/oblique.hpp"

#include <random>

#include "check.hpp"
#include "pindrive/law/contact_point.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using pd::ContactState;
using pd::detail::ActiveGuard, pd::detail::ObliqueSlip;
using Line = pd::Line<double>;
using ContactMode = pd::detail::ContactMode<double>;
using ContactPoint = pd::detail::ContactPoint<double>;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const pd::Branch<double> branch{0.01, 0.5, 0.03, -0.02, 0};
const pd::Branch<double> falling{0, inf, 0.03, 0.02, 0, {pd::FallingShape::gaussian, 0.01, 0.2}};

/// −λ (F + S ρ) u/ρ, F at no speed, or with a part that falls.
long double force(const pd::Branch<double>& of, const Line& along, const Line& across,
                  const Line& load, long double t) {
  const long double u = along.value + along.rate * t, w = across.value + across.rate * t;
  const long double r = std::sqrt(u * u + w * w);
  long double friction = of.force + of.slope * (r - of.from);
  if (!of.linear()) {
    const long double s = r / of.falling.velocity;
    friction -= of.falling.excess * (1 - std::exp(-s * s));
  }
  return -(load.value + load.rate * t) * friction * u / r;
}

void changes(const pd::Branch<double>& of) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> draw(-0.1, 0.1);
  bool rates = true, bends = true, steep = true, speeds = true;
  for (int i = 0; i < 500; ++i) {
    const Line u{draw(random), draw(random)}, w{draw(random), draw(random)};
    const ObliqueSlip<double> slip(u.value, u.rate, Line{}, w);
    const Line load{1 + draw(random), 10 * draw(random)};
    const double speed = std::hypot(u.value, w.value);
    const pd::Branch<double> tangent = of.tangent(speed);
    const double curvature = of.linear() ? 0 : of.falling.curvature(speed);
    const long double h = 1e-4L * speed;  // of third order beside the speed's rates of change
    const auto at = [&](int k) { return force(of, u, w, load, k * h); };
    const long double rate = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
    const long double bend = (16 * (at(1) + at(-1)) - (at(2) + at(-2)) - 30 * at(0)) / (12 * h * h);
    const double size = 0.04 * (1 + 1 / speed);
    rates = rates && std::abs(slip.force_rate(tangent, load) - rate) < 1e-10 * size;
    const double second = slip.force_second_rate(tangent, curvature, load);
    bends = bends && std::abs(second - bend) < 1e-6 * size / speed;
    const Line faster{u.value + 1e-6 * speed, u.rate}, slower{u.value - 1e-6 * speed, u.rate};
    const long double fall = force(of, slower, w, load, 0) - force(of, faster, w, load, 0);
    const auto steepness = static_cast<double>(fall / (2e-6L * speed));
    steep = steep && near(slip.steepness(tangent, load) / steepness, 1, 1e-5);
    const auto square = [&](long double t) {
      const long double along = u.value + u.rate * t, aside = w.value + w.rate * t;
      return (along * along + aside * aside) / 2;
    };
    const auto closing = static_cast<double>((square(h) - square(-h)) / (2 * h));
    const auto parting = static_cast<double>((square(h) + square(-h) - 2 * square(0)) / (h * h));
    speeds =
        speeds && near(slip.closing(), closing, 1e-12) && near(slip.parting(0, 0), parting, 1e-9);
  }
  expect(rates, "the rate of the force is its derivative along straight velocities");
  expect(bends, "... and the bend its second one");
  expect(steep, "it falls with the velocity along the axis as steeply as it says");
  expect(speeds, "closing() and parting() are the derivatives of ρ²/2");
}

/// Second derivative of the force where velocities and load have second derivatives of their own.
void bends_of_functions() {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> draw(-1, 1);
  bool bends = true;
  for (int i = 0; i < 500; ++i) {
    const pd::InputPiece<double> plate{0, {draw(random), draw(random), draw(random)}, nullptr, 0},
        aside{0, {draw(random), draw(random), draw(random)}, nullptr, 0},
        pressed{0, {1.5 + draw(random), draw(random), draw(random)}, nullptr, 0};
    const double v = draw(random), acceleration = draw(random);
    const auto at = [&](long double t) {
      const auto of = [&](const pd::InputPiece<double>& piece) {
        const auto& p = piece.polynomial;
        return p[0] + (p[1] + p[2] * t) * t;
      };
      const long double u = v + acceleration * t - of(plate), w = of(aside);
      return -of(pressed) * (branch.intercept() / std::sqrt(u * u + w * w) + branch.slope) * u;
    };
    const ObliqueSlip<double> slip(v - plate.at(0), acceleration - plate.polynomial[1],
                                   {plate, 0.0}, {aside, 0.0});
    const double speed = std::hypot(v - plate.at(0), aside.at(0));
    const long double h = 1e-4L * speed;
    const long double bend =
        (16 * (at(h) + at(-h)) - (at(2 * h) + at(-2 * h)) - 30 * at(0)) / (12 * h * h);
    const double second = slip.force_second_rate(branch, 0, {pressed, 0.0});
    bends = bends && std::abs(second - bend) < 1e-6 * (1 + 1 / (speed * speed));
  }
  expect(bends, "the second derivative of the force has those of velocities and load");
}

/// A plate of friction 0.03 N that moves at 0.1 m/s, and across.
ContactPoint plate(Line across, Line load = {1, 0}) {
  static const pd::Contact<double> contact{0.03, 0.04};
  ContactPoint point(contact);
  point.surface = {0.1, 0.5};
  point.across = across;
  point.load = load;
  point.mode = ContactMode::slip(1, ActiveGuard::none, 0);
  return point;
}

void asks() {
  ContactPoint point = plate({0.3, 0});
  ActiveGuard at = ActiveGuard::lower;
  expect(pd::detail::enumerate_oblique_candidates(point, 0.4, at) && point.oblique() &&
             at == ActiveGuard::none,
         "a plate that begins to slide across slips in the one way that is left");
  expect(near(point.direction, 0.8, 1e-15) && point.start.friction == 0.03,
         "... along its velocity");
  ContactPoint unloaded = plate({0.3, 0}, {0, 0});
  expect(!pd::detail::enumerate_oblique_candidates(unloaded, 0.4, at) && !unloaded.oblique(),
         "what carries nothing is not asked");
  point.across = {0, 0};
  point.load = {1, 0};
  expect(!pd::detail::enumerate_oblique_candidates(point, -0.4, at) &&
             point.mode.state == ContactState::slip_backward,
         "where it no longer slides across it slips along the axis");
  ContactPoint still = plate({0, 0.2});
  expect(pd::detail::enumerate_oblique_candidates(still, 0.0, at) &&
             near(still.direction, -0.5 / std::hypot(0.5, 0.2), 1e-15),
         "from no velocity it sets out against that of its surface");
}

void sets_out_and_lands() {
  ContactPoint point = plate({0, 0.2});
  point.start.friction = 0.03;
  const double mass = 0.01, pull = 0.02;
  const double p = pd::detail::oblique_departure(mass, point, pull), direction = point.direction;
  expect(near(p, 0.2 * direction / std::sqrt(1 - direction * direction), 1e-12) &&
             near((mass * p + 0.03 * direction) / (pull - mass * 0.5), 1, 1e-12),
         "a pin sets out in the direction in which the forces along the axis balance");
  point.mode = {ContactState::slip_oblique, ActiveGuard::none, 0, 0.0};
  point.across = {0, 0};
  pd::detail::State<double> state{1e-3, 0.1 * (1 + 4e-16)};
  pd::detail::end_oblique_slip(state, point, false, 0.0, mass, 1.0);
  expect(state.v == 0.1, "a pin that has the plate's velocity to rounding has it exactly");
  state.v = 0.101;
  pd::detail::end_oblique_slip(state, point, false, 1e-9, mass, 1.0);
  expect(state.v == 0.101, "... one that slides does not");
  state.v = 0.1 + 3e-9;
  pd::detail::end_oblique_slip(state, point, false, 1e-9, mass, 1.0);
  expect(state.v == 0.1 + 3e-9, "... nor one that is faster along than its plate was across");
  state.v = 0.1 + 5e-10;
  pd::detail::end_oblique_slip(state, point, true, 1e-9, mass, 1.0);
  expect(point.surface.value == state.v, "... and a pin on the finger keeps its own");
}

/// Direction of velocities whose first order that is not zero is a later one, as in a stroke.
void begins_with_a_later_order() {
  const double across[]{0, 0, 3, -4, 1, 0}, along[]{0, 0, 4, 1, -2, 0};
  pd::InputPiece<double> u, w;
  std::copy(along, along + 6, u.polynomial.begin());
  std::copy(across, across + 6, w.polynomial.begin());
  const ObliqueSlip<double> slip(0.0, 0.0, pd::Curve<double>(u, 0.0), pd::Curve<double>(w, 0.0));
  const Line load{2, 0.5};
  expect(near(slip.along(), -0.8, 1e-15), "a plate that begins to slide does so in this direction");
  const auto at = [&](long double t) {
    const long double a = -(4 + t - 2 * t * t), b = 3 - 4 * t + t * t;
    return -0.03L * (load.value + load.rate * t) * a / std::sqrt(a * a + b * b);
  };
  const pd::Branch<double> flat{0, inf, 0.03, 0, 0};
  const long double h = 1e-4L;
  expect(near(slip.force_rate(flat, load), static_cast<double>((at(h) - at(-h)) / (2 * h)), 1e-9),
         "... which turns as the later orders say");
  const auto bend = static_cast<double>((at(h) + at(-h) - 2 * at(0)) / (h * h));
  expect(near(slip.force_second_rate(flat, 0, load), bend, 1e-7), "... and bends");
}

void departures() {
  double worst = 0;
  bool odd = true, grows = true, directed = true;
  for (const double mass : {1e-3, 1.0})
    for (const double friction : {0.0, 1e-4, 1.0, 1e4})
      for (const double across : {1e-3, -1.0, 1e3}) {
        double before = 0;
        for (const double pull : {1e-6, 1e-2, 1.0, 1e3}) {
          const auto [p, along] = pd::detail::departure_of(mass, friction, across, pull);
          const double force = mass * p + friction * p / std::hypot(p, across);
          worst = std::max(worst, std::abs(force - pull) / pull);
          odd = odd && pd::detail::departure_of(mass, friction, across, -pull).acceleration == -p;
          directed = directed && near(along, p / std::hypot(p, across), 1e-14);
          grows = grows && p > before;
          before = p;
        }
      }
  expect(worst < 1e-14, "the acceleration that sets out needs the force that pulls");
  expect(odd, "... to either side alike");
  expect(grows, "... and grows with the pull");
  expect(directed, "... in the direction of the relative acceleration");
  expect(pd::detail::departure_of(1.0, 0.5, 1.0, 0.0).acceleration == 0,
         "without a pull it is zero");
  const auto follows = pd::detail::departure_of(0.1, 0.5, 0.0, -0.3);
  expect(
      follows.acceleration == 0 && follows.along == -0.3 / 0.5,
      "a plate that begins to slide without an acceleration takes a pin along up to its friction");
  const auto leaves = pd::detail::departure_of(0.1, 0.5, 0.0, -0.8);
  expect(near(leaves.acceleration, -3, 1e-15) && leaves.along == -1, "... and no farther");
}

}  // namespace

int main() {
  departures();
  begins_with_a_later_order();
  changes(branch);
  changes(falling);
  bends_of_functions();
  asks();
  sets_out_and_lands();
  return check::status();
}
