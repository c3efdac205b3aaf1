#pragma once

#include <optional>
#include <vector>

#include "render/intersect.hpp"
#include "render/shadow.hpp"

namespace tesserae::render {

/// What a view ray found on a body.
struct Surface {
    double distance;     ///< along the view ray [m]
    std::uint32_t body;  ///< index into PlacedBodies::bodies
    Vec4 point;          ///< relative to the camera, world axes [m]
    Vec4 normal;         ///< unit, out of the body, world axes
    Color albedo;
};

/// Colour of a material at a point of the body's frame. Checker: cells of edge pattern_size, one of
/// them centred on the origin, coloured by the parity of their four indices. Stripes: slabs of
/// width pattern_size across the body's x axis, one of them centred on the origin. Odd cells have
/// the pattern's albedo.
Color albedo_at(const Material& material, const Vec4& point);

/// The thesis's picture: Lambert surfaces lit by suns, with shadows, and by an unoccluded sky.
class Shading {
  public:
    Shading(const Picture& picture, const PlacedBodies& placed);

    /// @param direction   of the view ray, unit, world axes
    Surface surface(const Hit& hit, const Vec4& direction) const;

    /// Radiance that leaves the surface toward any viewer: albedo times (3/(4 pi) times the sum
    /// over the suns of irradiance * cos * visibility, plus the sky's radiance). The BRDF of a 4D
    /// Lambert surface is 3 albedo/(4 pi), as the integral of cos over the hemisphere of S^3 is 4
    /// pi/3.
    Color radiance(const Surface& surface, FrameStats& stats) const;

    const Color& sky() const { return picture_.lights.sky; }

  private:
    const Picture& picture_;
    const PlacedBodies& placed_;
    std::vector<SunDisc> suns_;       ///< those that give light
    std::optional<Shadows> shadows_;  ///< none without suns: nothing is built for them
};

}  // namespace tesserae::render
