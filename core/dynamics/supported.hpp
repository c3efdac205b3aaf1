#pragma once

#include <optional>
#include <string>

#include "core/dynamics/bodies.hpp"

namespace tesserae {

/// Why these bodies cannot be simulated: two shapes among them that could collide, one at least
/// movable by contacts, and whose contacts are not yet built. None if every meeting is supported.
/// Looks at kinds of shapes, whatever the bodies' places: time is linear in the bodies.
std::optional<std::string> unsupported_contacts(const Bodies& bodies);

}  // namespace tesserae
