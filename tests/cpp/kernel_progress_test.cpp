// What one round of the kernel hands to the next: every number once, in as many columns as it says.
#include "pindrive/kernel/kernel_progress.hpp"

#include <set>

#include "check.hpp"
#include "pindrive/numbers/pack.hpp"

namespace pk = pindrive::detail;
using check::expect;

namespace {

constexpr double inf = __builtin_inf();
const pk::ForwardRelease<double> release(pk::PlainRelease<double>{
    0.01, 100, 0.4, 0.02, 0.02, 0.005, 0.005, inf, -0.1, 1.5e-3, -0.05, inf, 0.05});

template <class Progress>
void columns(const char* what) {
  Progress progress(release), copy(release);
  std::set<const double*> visited;
  int calls = 0;
  progress.columns([&](double& column) {
    visited.insert(&column);
    column = ++calls;
  });
  expect(calls == Progress::column_count && static_cast<int>(visited.size()) == calls, what);
  // Whatever is handed over this way arrives.
  double handed[Progress::column_count];
  int at = 0;
  progress.columns([&](double& column) { handed[at++] = column; });
  at = 0;
  copy.columns([&](double& column) { column = handed[at++]; });
  bool arrived = true;
  at = 0;
  copy.columns([&](double& column) { arrived = arrived && column == ++at; });
  expect(arrived, "... and what is taken from them arrives in another");
}

}  // namespace

int main() {
  columns<pk::Progress<double, false>>("a progress without numbers has the columns of its state");
  columns<pk::Progress<double, true>>("one with numbers has each of theirs once");
  const pk::Progress<double, true> progress(release);
  expect(progress.standing.position == -1.5e-3 && progress.standing.velocity == 0.05 &&
             progress.standing.time == 0 && progress.standing.released == 0,
         "it begins at the release, seen so that the plate moves forward");
  static_assert(pk::Progress<pk::Pack<4>, true>::column_count ==
                pk::Progress<double, true>::column_count);
  return check::status();
}
