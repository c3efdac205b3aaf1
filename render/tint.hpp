#pragma once

#include "core/dynamics/state/bodies.hpp"
#include "render/description.hpp"

namespace tesserae::render {

/// What a body's albedo is multiplied by, so that equal bodies beside each other can be told apart:
/// each colour's factor is random between 1 - variation and 1, by three quarters the same for all
/// of them. A function of the body's number.
Color tint_of(BodyId body, double variation);

}  // namespace tesserae::render
