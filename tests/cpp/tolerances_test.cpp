// The tolerances of the certificate allow what the solver may do, and at most twice that.
#include "pindrive/certificate/tolerances.hpp"

#include "check.hpp"
#include "pindrive/numbers/limits.hpp"

namespace pd = pindrive::detail;
using check::expect;

namespace {

void covers(double tolerance, double limit, const char* what) {
  expect(limit <= tolerance && tolerance <= 2 * limit, what);
}

}  // namespace

int main() {
  covers(pd::tolerance::sum<double>, pd::rounding<double>, "sums have their rounding");
  covers(pd::tolerance::difference<double>, pd::difference_error<double>,
         "differences of computed values have theirs");
  covers(pd::tolerance::transverse<double>, pd::least_across<double>,
         "an oblique plate may move along the axis");
  covers(pd::tolerance::unloaded_time<double>, pd::first_grip<double> + pd::rounding<double>,
         "skin has no mode beside a load of zero");
  expect(pd::tolerance::unloaded_stretch<double> > pd::tolerance::unloaded_time<double>,
         "unloaded skin stretches by its speed in that time");
  expect(pd::tolerance::still < 1e-9 && pd::tolerance::unseen_violation < 1e-9,
         "what is not seen is far below a violation that counts");
  return check::status();
}
