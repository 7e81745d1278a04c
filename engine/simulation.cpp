// Compiled engine: simulation of values.
#include "pindrive/engine.hpp"

namespace pindrive {
PINDRIVE_ENGINE_SIMULATION(double, )
}  // namespace pindrive
