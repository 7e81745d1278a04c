// Inputs that are functions of time: their values and derivatives, and motions under them by the certificate, beside
// tables of many breakpoints, and their derivatives beside differences.
#include "pindrive/model/input_function.hpp"

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

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Pieces of an input, with their terms.
template <class T>
class Function {
 public:
  struct Piece {
    T begin{0};
    std::vector<T> polynomial;
    std::vector<pd::InputTerm<T>> terms;
  };
  explicit Function(std::vector<Piece> pieces) : given_(std::move(pieces)) {
    for (const Piece& piece : given_) {
      pd::InputPiece<T> made{piece.begin, {}, piece.terms.data(), piece.terms.size()};
      for (std::size_t n = 0; n < piece.polynomial.size(); ++n)
        made.polynomial[n] = piece.polynomial[n];
      pieces_.push_back(made);
    }
  }
  Function(const Function&) = delete;
  pd::Profile<T> profile() const { return {pieces_.data(), pieces_.size()}; }
  const pd::InputPiece<T>& piece(std::size_t i) const { return pieces_[i]; }

 private:
  std::vector<Piece> given_;
  std::vector<pd::InputPiece<T>> pieces_;
};

void values() {
  const Function<double> function(
      {{0, {1, 2, -3, 0.5}, {{0.3, -0.2, 4, 7}, {0.1, 0, 2, 0}}}, {0.5, {2, 1}, {}}});
  const auto direct = [](double t) {
    return 1 + 2 * t - 3 * t * t + 0.5 * t * t * t +
           std::exp(-4 * t) * (0.3 * std::cos(7 * t) - 0.2 * std::sin(7 * t)) +
           0.1 * std::exp(-2 * t);
  };
  const pd::Profile<double> profile = function.profile();
  const pd::Curve<double> here = profile.from(0.2);
  const double h = 1e-3;
  const double rate = (direct(0.2 + h) - direct(0.2 - h)) / (2 * h);
  const double second = (direct(0.2 + h) - 2 * direct(0.2) + direct(0.2 - h)) / (h * h);
  const double third =
      (direct(0.2 + 2 * h) - 2 * direct(0.2 + h) + 2 * direct(0.2 - h) - direct(0.2 - 2 * h)) /
      (2 * h * h * h);
  expect(
      std::abs(here.value - direct(0.2)) < 1e-15 && std::abs(here.at(0.15) - direct(0.35)) < 1e-15,
      "an input has the values of its function");
  expect(std::abs(here.rate - rate) < 1e-4 && std::abs(here.second() - second) < 1e-3 &&
             std::abs(here.third() - third) < 1e-2,
         "... and its derivatives");
  expect(std::abs(here.rate_at(0.1) - here.from(0.1).rate) < 1e-14 &&
             std::abs(here.from(0.1).at(0.05) - direct(0.35)) < 1e-15,
         "a curve continues");
  expect(profile.next_breakpoint(0.2) == 0.5 && profile.next_breakpoint(0.5) == never,
         "a piece ends where the next begins");
  const pd::Curve<double> line = profile.from(0.75);
  expect(
      line.straight() && line.value == 2.25 && line.rate == 1 && !line.steady() && !here.straight(),
      "a piece of degree one is a line");
  std::array<double, 26> c;
  function.piece(0).expand(0.2, 0.3, c, 25);
  double sum = 0;
  for (int n = 24; n >= 0; --n) sum += c[n];
  expect(std::abs(sum - direct(0.5)) <= function.piece(0).beyond(0.2, 0.3, 24) + 1e-15,
         "a series is its function within its bound");
  double cut = 0;
  for (int n = 9; n >= 0; --n) cut += c[n];
  const double missed = std::abs(cut - direct(0.5)), bound = function.piece(0).beyond(0.2, 0.3, 9);
  expect(missed < bound && bound < 1e4 * missed, "... which is not much larger");
}

/// A function close to the instant at which it only touches zero, where its terms cancel: within the rounding of time.
void beside_a_touch() {
  const double w = 4 * std::acos(-1.0), amplitude = 0.1, touches = 0.375;
  const Function<double> harmonic({{0, {amplitude}, {{0, amplitude, 0, w}}}});
  const Function<double> stroke({{0, {0, 0, 30, -60, 30}, {}}});  // of minimum jerk, velocity
  double worst = 0, of_stroke = 0;
  for (double part = 1e-9; part < 2e-3; part *= 1.9)
    for (const double sign : {-1.0, 1.0}) {
      const double time = touches + sign * part, off = time - touches, half = std::sin(w / 2 * off);
      const pd::Curve<double> here = harmonic.profile().from(time);
      const double value = 2 * amplitude * half * half, rate = amplitude * w * std::sin(w * off);
      const double known = 4 * pd::detail::rounding<double> * touches / part;
      worst = std::max({worst, std::abs(here.value / value - 1) / known,
                        std::abs(here.rate / rate - 1) / known});
      const double before = 1 - part, left = 1 - before;
      const double end = 30 * before * before * left * left;
      of_stroke = std::max(of_stroke, std::abs(stroke.profile().from(before).value / end - 1) *
                                          part / (1024 * pd::detail::rounding<double>));
    }
  expect(worst < 1, "a sinusoid that touches zero is exact close to there");
  expect(of_stroke < 1, "... and a stroke close to its end");
}

/// A function that begins at zero, as its terms cancel there: to its last digits from the first instant on.
void from_a_begin() {
  const double a = 0.01, decay = 50, w = 80;
  const Function<double> approach({{0, {a}, {{-a, 0, decay, 0}}}});
  const Function<double> ringing({{0, {a, 0.2}, {{-a, 0, decay, w}}}});
  double worst = 0, of_ringing = 0;
  for (double time = 1e-15; time < 0.5; time *= 1.7) {
    const double value = -a * std::expm1(-decay * time), half = std::sin(w / 2 * time);
    const double turn = -std::expm1(-decay * time) * std::cos(w * time) + 2 * half * half;
    worst = std::max(worst, std::abs(approach.profile().from(time).value / value - 1));
    of_ringing = std::max(
        of_ringing, std::abs(ringing.profile().from(time).value / (a * turn + 0.2 * time) - 1));
  }
  expect(worst < pd::detail::rounding<double>,
         "a velocity that approaches its limit begins at zero");
  expect(of_ringing < pd::detail::rounding<double>, "... and one that swings about it");
}

/// Drive and functions of a random case.
template <class T>
struct Case {
  T mass, stiffness, damping, plate, finger, above, viscous, v_p, amplitude, frequency, decay, x, v;
  T push, load, touch, duration;
};

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  double scaled(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
  bool chance(double part) { return uniform(0, 1) < part; }
  Case<double> one() {
    Case<double> c{};
    c.mass = scaled(2e-3, 0.03);
    c.stiffness = scaled(30, 500);
    c.damping = 2 * std::sqrt(c.mass * c.stiffness) * uniform(0, 0.6);
    c.plate = uniform(0, 0.05);
    c.finger = chance(0.3) ? 0 : uniform(0, 0.02);
    c.above = chance(0.5) ? 1 : uniform(1, 1.5);
    c.viscous = chance(0.5) ? 0 : scaled(1e-3, 0.3);
    c.v_p = uniform(-0.1, 0.1);
    c.amplitude = chance(0.2) ? 0 : scaled(1e-3, 0.1);
    c.frequency = std::sqrt(c.stiffness / c.mass) * scaled(0.1, 10);
    c.decay = scaled(3, 300);
    c.x = uniform(-3e-3, 3e-3);
    c.v = chance(0.3) ? c.v_p : uniform(-0.2, 0.2);
    c.push = chance(0.4) ? 0 : scaled(1e-3, 0.1);
    c.load = chance(0.4) ? 0 : uniform(0.1, 0.9);
    c.touch = chance(0.6) ? 0 : uniform(0.1, 0.9);
    c.duration = 10 * std::sqrt(c.mass / c.stiffness);
    return c;
  }

 private:
  std::mt19937 random_;
};

/// Motion of a case under functions or, if `rows` is not 0, under tables with this number of rows.
template <class T>
class Followed {
  using F = Function<T>;
  struct Table {
    std::vector<T> times, values;
  };
  static pd::Profile<T> tabled(const pd::Profile<T>& input, T duration, int rows, Table& table) {
    for (int i = 0; i <= rows; ++i) {
      table.times.push_back(duration * T(i) / T(rows));
      table.values.push_back(input.from(table.times.back()).value);
    }
    return {table.times.data(), table.values.data(), table.times.size()};
  }
  static typename F::Piece stroke(const Case<T>& c) {
    return {T(0),
            {c.v_p, T(0), T(20) * c.v_p, T(-90) * c.v_p},
            {{c.amplitude, T(0), T(0), c.frequency}}};
  }

 public:
  explicit Followed(const Case<T>& c, int rows = 0)
      : curve_{T(0), T(never), c.plate, c.viscous, T(0)},
        velocity_({stroke(c),
                   {c.duration / T(2),
                    {F({stroke(c)}).piece(0).at(c.duration / T(2))},
                    {{T(0), c.amplitude, T(0), c.frequency}}}}),
        push_({{T(0),
                {},
                {{-c.push, T(0), c.decay, T(0)}, {T(0), c.push, T(0), T(2) * c.frequency}}}}),
        load_({{T(0), {T(1)}, {{-c.load, T(0), c.decay, T(0)}}}}),
        touch_({{T(0), {T(1)}, {{T(0), c.touch, T(0), c.frequency}}}}),
        drive_{c.mass,
               c.stiffness,
               c.damping,
               {c.plate, c.plate * c.above},
               {c.finger, c.finger * c.above}},
        inputs_{velocity_.profile(), c.x, c.v, c.duration} {
    if (c.viscous > 0) {
      drive_.plate.curve = &curve_;
      drive_.plate.branches = 1;
    }
    inputs_.force = push_.profile();
    inputs_.plate_load = load_.profile();
    inputs_.finger_load = touch_.profile();
    if (rows > 0) {
      inputs_.mouse_velocity = tabled(inputs_.mouse_velocity, c.duration, rows, tables_[0]);
      inputs_.force = tabled(inputs_.force, c.duration, rows, tables_[1]);
      inputs_.plate_load = tabled(inputs_.plate_load, c.duration, rows, tables_[2]);
      inputs_.finger_load = tabled(inputs_.finger_load, c.duration, rows, tables_[3]);
    }
    outcome_ =
        pd::simulate(drive_, inputs_, [&](const pd::Segment<T>& s) { segments_.push_back(s); });
  }
  Followed(const Followed&) = delete;
  pd::Motion<T> motion() const {
    return {drive_, inputs_, segments_.data(), segments_.size(), outcome_};
  }
  T at(T t, pd::Quantity quantity = pd::Quantity::position) const {
    const auto place = motion().locate(t, pd::Side::right);
    return motion().value(*place.segment, place.tau, quantity);
  }
  bool followed() const { return outcome_.status == pd::Status::ok; }
  std::size_t size() const { return segments_.size(); }

 private:
  pd::Branch<T> curve_;
  F velocity_, push_, load_, touch_;
  std::array<Table, 4> tables_;
  pd::Drive<T> drive_;
  pd::Inputs<T> inputs_;
  std::vector<pd::Segment<T>> segments_;
  pd::Outcome<T> outcome_;
};

void by_certificate(int count) {
  Draw draw(47);
  double worst = 0;
  int followed = 0, worst_case = -1;
  std::size_t segments = 0;
  for (int i = 0; i < count; ++i) {
    const Case<double> c = draw.one();
    const Followed<double> run(c);
    if (!run.followed()) std::printf("case %d is not followed\n", i);
    followed += run.followed();
    segments += run.size();
    const auto certificate = pd::Certifier<double>(run.motion(), c.duration).certify();
    if (certificate.worst() > 1e-9) {
      std::printf("case %d:", i);
      for (const auto& law : pd::certificate_numbers<double>)
        if (law.of(certificate) > 1e-9) std::printf(" %s %.2g", law.name, law.of(certificate));
      std::printf("\n");
    }
    if (certificate.worst() > worst) {
      worst = certificate.worst();
      worst_case = i;
    }
  }
  std::printf("%d of %d motions, %zu segments, the worst law missed by %.2g, in case %d\n",
              followed, count, segments, worst, worst_case);
  expect(followed == count, "every motion is followed");
  expect(worst < 1e-11, "every law holds");
}

/// A stroke that starts without speed or acceleration parts two surfaces that hold a pin.
void smooth_start() {
  const Function<double> stroke({{0, {0, 0, 3, -2}, {}}});
  const pd::Drive<double> drive{0.01, 100, 0.4, {0.02, 0.03}, {0.005, 0.0075}};
  const pd::Inputs<double> inputs{stroke.profile(), 0, 0, 0.5};
  std::vector<pd::Segment<double>> segments;
  const auto outcome =
      pd::simulate(drive, inputs, [&](const pd::Segment<double>& s) { segments.push_back(s); });
  const pd::Motion<double> motion(drive, inputs, segments.data(), segments.size(), outcome);
  expect(!segments[0].mode.both_stuck() &&
             pd::Certifier<double>(motion, 0.5).certify().worst() < 1e-12,
         "two surfaces that part smoothly do not both hold a pin");
}

/// The distance to a table falls with the square of its breakpoints.
void beside_tables() {
  Draw draw(11);
  double coarse = 0, fine = 0;
  for (int i = 0; i < 20; ++i) {
    const Case<double> c = draw.one();
    const Followed<double> exact(c);
    const auto apart = [&](int rows) {
      const Followed<double> table(c, rows);
      double most = 0;
      for (int k = 1; k <= 20; ++k) {
        const double t = k * c.duration / 20;
        most = std::max(most, std::abs(exact.at(t) - table.at(t)));
      }
      return most / 3e-3;
    };
    coarse = std::max(coarse, apart(1000));
    fine = std::max(fine, apart(10000));
  }
  std::printf("from tables of 1000 and 10000 rows: %.2g and %.2g of the release\n", coarse, fine);
  expect(coarse < 1e-2 && fine < 1e-4, "a table approaches the function");
}

void derivatives() {
  using D = pd::Dual<double>;
  const Case<double> c{0.01, 100, 0.2,  0.02, 0.005, 1,   0.01, 0.06, 0.02,
                       60,   30,  2e-3, 0.05, 0.02,  0.5, 0.3,  0.12};
  double Case<double>::* const parts[] = {&Case<double>::amplitude, &Case<double>::frequency,
                                          &Case<double>::decay,     &Case<double>::push,
                                          &Case<double>::load,      &Case<double>::v_p};
  D Case<D>::* const duals[] = {&Case<D>::amplitude, &Case<D>::frequency, &Case<D>::decay,
                                &Case<D>::push,      &Case<D>::load,      &Case<D>::v_p};
  for (int i = 0; i < 6; ++i) {
    Case<double> more = c, less = c;
    const double h = 1e-5 * c.*parts[i];
    more.*parts[i] += h;
    less.*parts[i] -= h;
    const double difference =
        (Followed<double>(more).at(0.11) - Followed<double>(less).at(0.11)) / (2 * h);
    Case<D> along{D(c.mass),  D(c.stiffness), D(c.damping), D(c.plate),     D(c.finger),
                  D(c.above), D(c.viscous),   D(c.v_p),     D(c.amplitude), D(c.frequency),
                  D(c.decay), D(c.x),         D(c.v),       D(c.push),      D(c.load),
                  D(c.touch), D(c.duration)};
    (along.*duals[i]).slope = 1;
    const double exact = Followed<D>(along).at(D(0.11)).slope;
    std::printf("derivative %d: %.10g, difference %.10g\n", i, exact, difference);
    expect(std::abs(exact / difference - 1) < 1e-6, "a derivative is that of the difference");
  }
}

}  // namespace

int main(int argc, char** argv) {
  values();
  beside_a_touch();
  from_a_begin();
  by_certificate(argc > 1 ? static_cast<int>(std::strtol(argv[1], nullptr, 10)) : cases(500));
  smooth_start();
  beside_tables();
  derivatives();
  return check::status();
}
