// Compiled engine: numbers of the derivatives of a motion.
#include "pindrive/engine.hpp"

namespace pindrive {
PINDRIVE_ENGINE_MOTION(Dual<double>, )
}  // namespace pindrive
