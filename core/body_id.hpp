#pragma once

#include <cstdint>

namespace tesserae {

/// A body's number: [[body]] tables in file order, then lattices. The order of every list of
/// bodies.
using BodyId = std::uint32_t;

}  // namespace tesserae
