// Compiled engine: numbers, certificate and level crossings of a motion.
#include "pindrive/engine.hpp"

namespace pindrive {
PINDRIVE_ENGINE_MOTION(double, )
PINDRIVE_ENGINE_SEARCH(double, )
}  // namespace pindrive
