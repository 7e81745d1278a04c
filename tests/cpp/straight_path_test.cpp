// The direction of a plate whose two velocities are one function along a straight path, and none of other plates.
#include "pindrive/series/straight_path.hpp"

#include <cmath>

#include "check.hpp"

namespace pd = pindrive;
using check::expect;
using check::near;
using Curve = pd::Curve<double>;
using Dual = pd::Dual<double>;

namespace {

template <class T>
pd::InputPiece<T> stroke(T part) {
  pd::InputPiece<T> piece;
  piece.polynomial = {T(0), T(0), 0.3 * part, -0.7 * part, 0.1 * part, T(0)};
  return piece;
}

void strokes_have_a_direction() {
  for (const double angle : {0.1, 0.5, 1.2, 2.8}) {
    const auto along = stroke(std::cos(angle)), across = stroke(std::sin(angle));
    const auto path = pd::detail::straight_path(Curve(along, 0.2), Curve(across, 0.2));
    const double sense = path.along * std::cos(angle) + path.across * std::sin(angle);
    expect(near(std::abs(sense), 1, 1e-15), "a stroke has the direction of its two velocities");
  }
  const auto across = stroke(0.7);
  const auto path = pd::detail::straight_path(Curve{}, Curve(across, 0.2));
  expect(path.along == 0 && path.across == 1, "a hand that moves across only has one, too");
}

void waves_have_a_direction() {
  const pd::InputTerm<double> near_[]{{0.3, -0.1, 2, 50}}, far[]{{0.6, -0.2, 2, 50}};
  const pd::InputTerm<double> late[]{{0.3, 0.1, 2, 50}}, other[]{{0.6, -0.2, 2, 51}};
  pd::InputPiece<double> along, across;
  along.terms = near_;
  along.count = across.count = 1;
  const auto found = [&](const pd::InputTerm<double>* terms) {
    across.terms = terms;
    return pd::detail::straight_path(Curve(along, 0.0), Curve(across, 0.0));
  };
  expect(near(found(far).across, 2 * found(far).along, 1e-15), "a wave along a line has one");
  expect(found(late).across == 0 && found(other).across == 0,
         "a wave with another phase or frequency across has none");
}

void other_plates_have_none() {
  const auto along = stroke(0.8);
  auto across = stroke(0.6);
  across.polynomial[3] *= 1 + 1e-12;
  const auto path = pd::detail::straight_path(Curve(along, 0.0), Curve(across, 0.0));
  expect(path.along == 0 && path.across == 0, "a path that bends has no direction");
  const auto line = pd::detail::straight_path(Curve{0.1, 0.2}, Curve(along, 0.0));
  expect(line.along == 0 && line.across == 0, "nor have a line and a function");
}

void derivatives_bend_a_path() {
  const auto along = stroke(Dual(0.8, 0.1));
  auto across = stroke(Dual(0.6, -0.2));
  const auto found = [&] {
    return pd::detail::straight_path(pd::Curve<Dual>(along, Dual(0)),
                                     pd::Curve<Dual>(across, Dual(0)));
  };
  // φ = atan2(0.6, 0.8) changes by −0.22.
  expect(near(std::abs(found().along.slope), 0.6 * 0.22, 1e-14),
         "a path that turns keeps a direction");
  across.polynomial[3].slope += 1e-3;
  expect(found().along == 0 && found().across == 0, "a path whose derivative bends has none");
}

}  // namespace

int main() {
  strokes_have_a_direction();
  waves_have_a_direction();
  other_plates_have_none();
  derivatives_bend_a_path();
  return check::status();
}
