// Motions under friction that falls with the sliding speed: by the certificate, beside the closed form under
// a table of many points of the same law, and their derivatives beside differences.
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "cases.hpp"
#include "check.hpp"
#include "pindrive/certificate/certify.hpp"
#include "pindrive/events/simulate.hpp"
#include "pindrive/motion/motion.hpp"
#include "pindrive/numbers/dual.hpp"

namespace pd = pindrive;
using check::expect;
using Shape = pd::FallingShape;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// A law of a contact: F_c + (F_b − F_c) g(|u|/velocity) + viscous |u|.
template <class T>
struct Law {
  Shape shape;
  T kinetic, breakaway, velocity, viscous;

  pd::Branch<T> branch() const {
    return {T(0), T(never), breakaway, viscous, T(0), {shape, breakaway - kinetic, velocity}};
  }
};

template <class T>
pd::Contact<T> contact(const pd::Branch<T>& branch, double above = 1) {
  return {branch.force, branch.force * T(above), T(never), &branch, 1};
}

struct Case {
  Law<double> plate, finger;
  double above;  ///< static friction over that at rest
  double mass, stiffness, damping, v_p, across, x, v;
  double load_rate, duration;
};

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  double scaled(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
  bool chance(double part) { return uniform(0, 1) < part; }
  Law<double> law(double most) {
    const Shape shape = static_cast<Shape>(1 + static_cast<int>(uniform(0, 2.999)));
    const double breakaway = most * uniform(0.1, 1);
    return {shape, breakaway * uniform(0.2, 0.95), breakaway, scaled(3e-3, 0.3),
            chance(0.5) ? 0 : scaled(1e-3, 0.3)};
  }
  Case one() {
    Case c{};
    c.plate = law(0.05);
    c.finger = law(0.02);
    c.above = chance(0.5) ? 1 : uniform(1, 1.5);
    c.mass = scaled(2e-3, 0.03);
    c.stiffness = scaled(30, 500);
    c.damping = 2 * std::sqrt(c.mass * c.stiffness) * uniform(0, 0.6);
    c.v_p = uniform(-0.15, 0.15);
    c.across = chance(0.3) ? uniform(0.005, 0.1) : 0;
    c.x = uniform(-3e-3, 3e-3);
    c.v = chance(0.3) ? c.v_p : uniform(-0.2, 0.2);
    c.load_rate = chance(0.3) ? uniform(-3, 3) : 0;
    c.duration = 8 * std::sqrt(c.mass / c.stiffness);
    return c;
  }

 private:
  std::mt19937 random_;
};

/// A motion of a case, with what it points to.
class Followed {
 public:
  Followed(const Case& c, const pd::Contact<double>& plate, const pd::Contact<double>& finger)
      : drive_{c.mass, c.stiffness, c.damping, plate, finger},
        inputs_{pd::Profile<double>(c.v_p), c.x, c.v, c.duration} {
    if (c.load_rate != 0) {
      loads_[1] = std::max(0.1, 1 + c.load_rate * c.duration / 4);
      times_[1] = c.duration / 4;
      inputs_.plate_load = pd::Profile<double>(times_, loads_, 2);
      inputs_.finger_load = pd::Profile<double>(times_, loads_, 2);
    }
    inputs_.across_velocity = pd::Profile<double>(c.across);
    outcome_ = pd::simulate(drive_, inputs_,
                            [&](const pd::Segment<double>& s) { segments_.push_back(s); });
  }
  Followed(const Followed&) = delete;
  pd::Motion<double> motion() const {
    return {drive_, inputs_, segments_.data(), segments_.size(), outcome_};
  }
  double at(double t, pd::Quantity quantity) const {
    const auto place = motion().locate(t, pd::Side::right);
    return motion().value(*place.segment, place.tau, quantity);
  }
  bool followed() const { return outcome_.status == pd::Status::ok; }
  std::size_t size() const { return segments_.size(); }

 private:
  double times_[2]{0, 1}, loads_[2]{1, 1};
  pd::Drive<double> drive_;
  pd::Inputs<double> inputs_;
  std::vector<pd::Segment<double>> segments_;
  pd::Outcome<double> outcome_;
};

void by_certificate(int count) {
  Draw draw(47);
  double worst = 0;
  int followed = 0, worst_case = -1;
  for (int i = 0; i < count; ++i) {
    const Case c = draw.one();
    const pd::Branch<double> plate = c.plate.branch(), finger = c.finger.branch();
    const Followed run(c, contact(plate, c.above), contact(finger, c.above));
    if (!run.followed()) std::printf("case %d is not followed\n", i);
    followed += run.followed();
    const double residual = pd::Certifier<double>(run.motion(), c.duration).certify().worst();
    if (residual > worst) {
      worst = residual;
      worst_case = i;
    }
  }
  std::printf("%d of %d motions, the worst law missed by %.2g, in case %d\n", followed, count,
              worst, worst_case);
  expect(followed == count, "every motion is followed");
  expect(worst < 1e-9, "every law holds");
}

/// Points of a law, dense where it bends.
class Table {
 public:
  Table(const Law<double>& law, int count) {
    std::vector<double> speeds, forces;
    const pd::Branch<double> branch = law.branch();
    for (int i = 0; i < count; ++i) {
      const double part = static_cast<double>(i) / (count - 1);
      speeds.push_back(part * part * part);  // to 1 m/s
      forces.push_back(branch.at(speeds.back()));
    }
    branches_.resize(count + 1);
    made_ = pd::branches_of(speeds.data(), forces.data(), count, branches_.data());
    first_ = forces[0];
  }
  pd::Contact<double> contact(double above) const {
    return {first_, first_ * above, never, branches_.data(), made_};
  }

 private:
  std::vector<pd::Branch<double>> branches_;
  int made_{0};
  double first_{0};
};

/// The distance to a table of points falls with the square of their number.
void beside_tables() {
  Draw draw(11);
  double coarse = 0, fine = 0;
  for (int i = 0; i < 20; ++i) {
    Case c = draw.one();
    c.across = c.load_rate = 0;
    c.duration = 2 * std::sqrt(c.mass / c.stiffness);
    const pd::Branch<double> plate = c.plate.branch(), finger = c.finger.branch();
    const Followed exact(c, contact(plate, c.above), contact(finger, c.above));
    const auto apart = [&](int count) {
      const Table at_plate(c.plate, count), at_finger(c.finger, count);
      const Followed table(c, at_plate.contact(c.above), at_finger.contact(c.above));
      double most = 0;
      for (int k = 1; k <= 20; ++k) {
        const double t = k * c.duration / 20;
        most = std::max(most, std::abs(exact.at(t, pd::Quantity::position) -
                                       table.at(t, pd::Quantity::position)));
      }
      return most / 3e-3;
    };
    coarse = std::max(coarse, apart(60));
    fine = std::max(fine, apart(600));
  }
  std::printf("from tables of 60 and 600 points: %.2g and %.2g of the release\n", coarse, fine);
  expect(coarse < 1e-2 && fine < 1e-4, "a table approaches the law");
}

void derivatives() {
  using D = pd::Dual<double>;
  const Law<double> law{Shape::exponential, 0.02, 0.035, 0.02, 0.02};
  const auto end = [&](const auto& given, auto&& value_of) {
    using T = std::decay_t<decltype(given.kinetic)>;
    const pd::Branch<T> branch = given.branch();
    const pd::Drive<T> drive{T(0.01), T(100), T(0.2), contact(branch), {}};
    pd::Inputs<T> inputs{pd::Profile<T>(T(0.06)), T(2e-3), T(0.06), T(0.1)};
    std::vector<pd::Segment<T>> segments;
    const auto outcome =
        pd::simulate(drive, inputs, [&](const pd::Segment<T>& s) { segments.push_back(s); });
    const pd::Motion<T> motion(drive, inputs, segments.data(), segments.size(), outcome);
    const auto place = motion.locate(T(0.09), pd::Side::right);
    return value_of(motion.value(*place.segment, place.tau, pd::Quantity::position));
  };
  const auto plain = [](double x) { return x; };
  const auto slope = [](D x) { return x.slope; };
  double Law<double>::* const parts[] = {&Law<double>::kinetic, &Law<double>::breakaway,
                                         &Law<double>::velocity, &Law<double>::viscous};
  D Law<D>::* const duals[] = {&Law<D>::kinetic, &Law<D>::breakaway, &Law<D>::velocity,
                               &Law<D>::viscous};
  for (int i = 0; i < 4; ++i) {
    Law<double> more = law, less = law;
    const double h = 1e-5 * law.*parts[i];
    more.*parts[i] += h;
    less.*parts[i] -= h;
    const double difference = (end(more, plain) - end(less, plain)) / (2 * h);
    Law<D> along{law.shape, D(law.kinetic), D(law.breakaway), D(law.velocity), D(law.viscous)};
    (along.*duals[i]).slope = 1;
    const double exact = end(along, slope);
    expect(std::abs(exact / difference - 1) < 1e-6, "a derivative is that of the difference");
  }
}

}  // namespace

int main(int argc, char** argv) {
  by_certificate(argc > 1 ? static_cast<int>(std::strtol(argv[1], nullptr, 10)) : cases(500));
  beside_tables();
  derivatives();
  return check::status();
}
