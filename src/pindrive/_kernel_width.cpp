// The kernel for one width, PINDRIVE_WIDTH, and the instruction set that this file is compiled for.
#include "_kernel.hpp"

namespace pk = pindrive::detail;

namespace pindrive_extension {

namespace {

using V = pk::Pack<PINDRIVE_WIDTH>;

/// The inputs of a block that bounds refer to, in their order.
enum : int { mass, stiffness, damping, plate_kinetic, plate_static, finger_kinetic, finger_static };
constexpr int duration = 11, inputs = pk::KernelBlock::inputs;

/// True if the inputs are within a bound of `checks`.
template <class T>
pk::MaskOf<T> keeps(int check, const T (&in)[inputs], const Bounds& bounds) {
  const auto within = [](const T& value, const Interval& bound) {
    return ((T(bound[0]) <= value) & (value <= T(bound[1]))) | (value == T(bound[2]));
  };
  if (check < inputs) return within(in[check], bounds[check]);
  switch (check - inputs) {
    case 0:
      return in[plate_kinetic] <= in[plate_static];
    case 1:
      return in[finger_kinetic] <= in[finger_static];
    case 2: {
      const T critical = T(2.0) * pk::root(in[mass]) * pk::root(in[stiffness]);
      return within(in[damping] / critical, bounds[inputs]);
    }
    default: {
      const T phase = pk::root(in[stiffness] / in[mass]) * in[duration];
      return (in[duration] == T(__builtin_inf())) | within(phase, bounds[inputs + 1]);
    }
  }
}
constexpr int checks = inputs + 4;
/// Number of the broken bound, from 1 on.
int flag(int check) {
  constexpr int of_others[] = {plate_static, finger_static, inputs, inputs + 1};
  return 1 + (check < inputs ? check : of_others[check - inputs]);
}

/// True if all values between two ends are within a bound.
bool surely_keeps(const Extremes& ends, const Interval& bound) {
  return (bound[0] <= ends.least && ends.largest <= bound[1]) ||
         (ends.least == bound[2] && ends.largest == bound[2]);
}

/// True if all releases are certainly within the bounds of `checks`, by the extremes of the inputs
/// and without division or root; a value within rounding of a bound, or with powers beyond a
/// double, is not certain.
bool all_surely_keep(const pk::KernelBlock& block, int count, const Extremes* of_inputs,
                     const Bounds& bounds) {
  for (int k = 0; k < inputs; ++k)
    if (!surely_keeps(of_inputs[k], bounds[k])) return false;
  const Interval &ratio = bounds[inputs], &phase = bounds[inputs + 1];
  if (phase[0] > 0.0) return false;
  constexpr double less = 1.0 - 1e-9, more = 1.0 + 1e-9, least = 1e-290, most = 1e290;
  const V largest(ratio[1] * ratio[1] * 4.0 * less), smallest(ratio[0] * ratio[0] * 4.0 * more);
  const V beside(ratio[2]), of_phase(phase[1] * phase[1] * less);
  pk::MaskOf<V> good(true);
  for (int first = 0; first < count; first += PINDRIVE_WIDTH) {
    const auto in = [&](int k) { return pk::load<V>(&block.input[k][first]); };
    const V critical = in(mass) * in(stiffness), squared = in(damping) * in(damping);
    const V time = in(duration), turned = in(stiffness) * time * time;
    good = good & (in(plate_kinetic) <= in(plate_static)) &
           (in(finger_kinetic) <= in(finger_static)) & (V(least) < critical) &
           (critical < V(most)) & (squared <= largest * critical) &
           ((smallest * critical <= squared) | ((in(damping) == beside) & (beside == V(0.0)))) &
           ((time == V(__builtin_inf())) | (turned <= in(mass) * of_phase));
  }
  using pk::any;
  return !any(!good);
}

bool judge(const pk::KernelBlock& block, int count, const Extremes* of_inputs, const Bounds& bounds,
           signed char* broken) {
  for (int i = 0; i < count; ++i) broken[i] = 0;
  if (all_surely_keep(block, count, of_inputs, bounds)) return true;
  bool all = true;
  for (int first = 0; first < count; first += PINDRIVE_WIDTH) {
    V in[inputs];
    for (int k = 0; k < inputs; ++k) in[k] = pk::load<V>(&block.input[k][first]);
    pk::MaskOf<V> good(true);
    for (int check = 0; check < checks; ++check) good = good & keeps(check, in, bounds);
    const int end = first + PINDRIVE_WIDTH < count ? first + PINDRIVE_WIDTH : count;
    using pk::any;
    if (!any(!good)) continue;
    for (int i = first; i < end; ++i) {
      double alone[inputs];
      for (int k = 0; k < inputs; ++k) alone[k] = block.input[k][i];
      int check = 0;
      while (check < checks && keeps(check, alone, bounds)) ++check;
      if (check == checks) continue;
      broken[i] = static_cast<signed char>(flag(check));
      all = false;
    }
  }
  return all;
}

Extremes extremes(const double* values, std::size_t count) {
  constexpr std::size_t width = PINDRIVE_WIDTH, packs = 4;  // independent of each other
  constexpr double infinite = __builtin_inf(), none = __builtin_nan("");
  V least[packs], largest[packs];
  pk::MaskOf<V> lost[packs];
  for (std::size_t k = 0; k < packs; ++k) {
    least[k] = V(infinite);
    largest[k] = V(-infinite);
    lost[k] = pk::MaskOf<V>(count == 0);
  }
  const auto look = [&](std::size_t k, const V& value) {
    least[k] = pk::smaller(least[k], value);
    largest[k] = pk::larger(largest[k], value);
    lost[k] = lost[k] | !(value == value);
  };
  std::size_t i = 0;
  for (; i + packs * width <= count; i += packs * width)
    for (std::size_t k = 0; k < packs; ++k) look(k, pk::load<V>(values + i + k * width));
  for (; i < count; ++i) look(0, V(values[i]));
  Extremes found{infinite, -infinite};
  for (std::size_t k = 0; k < packs; ++k) {
    using pk::any;
    if (any(lost[k])) return {none, none};
    double low[width], high[width];
    pk::store(least[k], low);
    pk::store(largest[k], high);
    for (std::size_t j = 0; j < width; ++j) {
      found.least = pk::smaller(found.least, low[j]);
      found.largest = pk::larger(found.largest, high[j]);
    }
  }
  return found;
}

V function(int which, const V& a, const V& b) {
  switch (which) {
    case 0:
      return pk::sine_and_cosine(a).sine;
    case 1:
      return pk::sine_and_cosine(a).cosine;
    case 2:
      return pk::exponential(a);
    case 3:
      return pk::exponential_minus_1(a);
    case 4:
      return pk::logarithm(a);
    case 5:
      return pk::logarithm_of_1_plus(a);
    default:
      return pk::angle_of(a, b);
  }
}

void elementary(int which, const double* a, const double* b, double* found, std::size_t count) {
  constexpr std::size_t width = PINDRIVE_WIDTH;
  double one[width], other[width], both[width];
  for (std::size_t first = 0; first < count; first += width) {
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t at = first + i < count ? first + i : count - 1;
      one[i] = a[at];
      other[i] = b[at];
    }
    pk::store(function(which, pk::load<V>(one), pk::load<V>(other)), both);
    for (std::size_t i = 0; i < width && first + i < count; ++i) found[first + i] = both[i];
  }
}

}  // namespace

#define PINDRIVE_JOINED(name, width) name##width
#define PINDRIVE_OF_WIDTH(name, width) PINDRIVE_JOINED(name, width)

extern const KernelFunctions PINDRIVE_OF_WIDTH(kernel_, PINDRIVE_WIDTH);
const KernelFunctions PINDRIVE_OF_WIDTH(kernel_, PINDRIVE_WIDTH){
    PINDRIVE_WIDTH, &pk::follow_block<V>, &judge, &extremes, &elementary};

}  // namespace pindrive_extension
