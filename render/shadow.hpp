#pragma once

#include <cstdint>

#include "render/body_tree.hpp"
#include "render/picture.hpp"

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

/// The rim of a body as a point sees it along a ray: Rim::sine, in world axes.
double rim_sine(const PlacedBodies& placed, std::uint32_t body, const Vec4& origin,
                const Vec4& direction, const RimRange& range, FrameStats& stats);

/// The part of a light's disc that lies beyond a flat rim at angle x * half-angle from its middle,
/// x in [-1, 1] (0 hidden, 1 clear). The disc is a 3-ball of directions, and a plane cuts
/// (2 + 3x - x^3)/4 of a ball off, which is smoothstep((1 + x)/2).
double visible_part(double x);

/// How much of a light reaches a point: 0 to 1. The rim of the body that covers most of the disc
/// decides, as in a distance field of the whole scene; the rim counts as flat, and a small disc of
/// directions as a Euclidean ball. A hard light is hidden or not. A body counts as far as it comes
/// before the light's limit along the ray to the disc's middle: what stands beside a sphere light,
/// between its near side and its rim, is decided by that.
class Shadows {
  public:
    /// @param tree   of the bodies; it must outlive this, like them
    Shadows(const PlacedBodies& placed, const BodyTree& tree) : placed_(placed), tree_(tree) {}

    /// @param point   relative to the camera, world axes, on the surface of body `on`. A convex
    /// body
    ///                never shades its own lit side, so that body is left out and no ray needs to
    ///                be moved off its surface.
    double visibility(const LightDisc& light, const Vec4& point, std::uint32_t on,
                      FrameStats& stats) const;

  private:
    bool is_hidden(const LightDisc& light, const Vec4& point, std::uint32_t on,
                   FrameStats& stats) const;

    bool is_behind(const LightDisc& light, const Vec4& point, std::uint32_t body) const;

    const PlacedBodies& placed_;
    const BodyTree& tree_;
};

}  // namespace tesserae::render
