// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/dynamics/solver/sweep.hpp"

// Kernels in sixteen lanes for two batches at once: `first` and the one behind it, which has as
// many rows. Only their source is compiled for AVX-512. Call them only where most_lanes() says so.
namespace tesserae::lanes {
struct EightPairs;
}

namespace tesserae::sixteen {

/// True if the compiler could compile these kernels.
extern const bool kCompiled;

double sweep_round(ColouredIslands& coloured, std::uint32_t first, Sweep sweep);
double sweep_general(ColouredIslands& coloured, std::uint32_t first, Sweep sweep);
/// Makes the rows of two general batches, as start_general() of kernels.hpp does.
/// @param made    see ColouredStage
/// @param pairs   the pairs of both batches
void start_general(ColouredIslands& coloured, std::uint32_t first, bool made,
                   const lanes::EightPairs* pairs);

}  // namespace tesserae::sixteen
