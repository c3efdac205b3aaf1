#pragma once

#include "render/description.hpp"
#include "render/ray.hpp"

namespace tesserae::render {

/// What a point sees of a light: a disc of directions, and how far away it is.
struct LightDisc {
    Vec4 toward;           ///< unit
    double angle;          ///< half-angle [rad], below pi/2; 0 casts hard shadows
    Cone cone;             ///< of that half-angle
    double limit = kMiss;  ///< what is farther than this is behind the light [m]
};

/// A sun made ready: `toward` is where it stands.
struct SunDisc : LightDisc {
    Color irradiance;  ///< on a facing surface
    Color radiance;    ///< of the disc: irradiance/((4 pi/3) sin^3 angle); 0 for a hard sun
};
SunDisc sun_disc(const Sun& sun);

}  // namespace tesserae::render
