#pragma once

#include <cstdint>

#include "core/dynamics/solver/sweep.hpp"

// Kernels of two batches at once, `first` and the one behind it, which has as many rows: in sixteen
// lanes. The one source that is compiled for AVX-512; only where most_lanes() says so may it be
// called.
namespace tesserae::lanes {
struct EightPairs;
}

namespace tesserae::sixteen {

/// Whether the compiler could.
extern const bool kCompiled;

double sweep_round(ColouredIslands& coloured, std::uint32_t first, Sweep sweep);
double sweep_general(ColouredIslands& coloured, std::uint32_t first, Sweep sweep);
/// @param made    see ColouredStage
/// @param pairs   of both
void start_general(ColouredIslands& coloured, std::uint32_t first, bool made,
                   const lanes::EightPairs* pairs);

}  // namespace tesserae::sixteen
