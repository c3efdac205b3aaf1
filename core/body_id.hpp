// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

namespace tesserae {

/// A BodyId is a body's number. The [[body]] tables come first, in file order, then the lattices.
/// All lists of bodies have this order.
using BodyId = std::uint32_t;

/// The number that stands for the world, to which a body may be joined. It never moves.
constexpr BodyId kWorld = std::numeric_limits<BodyId>::max();

}  // namespace tesserae
