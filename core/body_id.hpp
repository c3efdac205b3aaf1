#pragma once

#include <cstdint>

namespace tesserae {

/// A BodyId is a body's number. The [[body]] tables come first, in file order, then the lattices.
/// All lists of bodies have this order.
using BodyId = std::uint32_t;

}  // namespace tesserae
