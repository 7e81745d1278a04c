// Compiled engine: simulation of derivatives.
#include "pindrive/engine.hpp"

namespace pindrive {
PINDRIVE_ENGINE_SIMULATION(Dual<double>, )
}  // namespace pindrive
