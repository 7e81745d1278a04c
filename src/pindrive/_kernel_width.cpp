// The kernel for one width, PINDRIVE_WIDTH, and the instruction set that this file is compiled for.
#include "_kernel.hpp"

namespace pk = pindrive::detail;

namespace pindrive_extension {

namespace {

template <int N>
struct OfWidth {
  using type = pk::Pack<N>;
};
template <>
struct OfWidth<1> {
  using type = double;
};
using V = OfWidth<PINDRIVE_WIDTH>::type;

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
const KernelFunctions PINDRIVE_OF_WIDTH(kernel_, PINDRIVE_WIDTH){PINDRIVE_WIDTH,
                                                                 &pk::follow_block<V>, &elementary};

}  // namespace pindrive_extension
