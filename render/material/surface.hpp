// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/algebra/vector.hpp"
#include "render/description.hpp"

namespace tesserae::render {

class RoughReflection;

/// What a ray found on a body.
struct Surface {
    double distance;     ///< along the ray [m]
    std::uint32_t body;  ///< index into PlacedBodies::bodies
    Vec4 point;          ///< relative to the camera, world axes [m]
    Vec4 normal;         ///< unit, out of the body, world axes
    Color albedo;
    const Material* material;
    const RoughReflection* rough = nullptr;  ///< of a rough material
    double time = 0;                         ///< of the ray [s]
};

}  // namespace tesserae::render
