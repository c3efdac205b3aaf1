#pragma once

#include <cstdint>

#include "render/light/light_set.hpp"
#include "render/picture.hpp"
#include "render/scene/body_tree.hpp"

namespace tesserae::render {

/// The rim of a body as a ray's origin sees it along the ray, up to its limit: Rim::sine.
/// @param low, high   as in RimRange
double rim_sine(const PlacedBodies& placed, std::uint32_t body, const Ray& ray, double low,
                double high, FrameStats& stats);

/// The part of a light's disc that lies beyond a flat rim at angle x * half-angle from its middle,
/// x in [-1, 1] (0 hidden, 1 clear). The disc is a 3-ball of directions, and a plane cuts
/// (2 + 3x - x^3)/4 of a ball off, which is smoothstep((1 + x)/2).
double visible_part(double x);

/// How much of a light reaches a point: 0 to 1. The rim of the body that covers most of the disc
/// decides, as in a distance field of the whole scene; the rim counts as flat, and a small disc of
/// directions as a Euclidean ball. A hard light is hidden or not. A body counts as far as it comes
/// before the limit, the light's or one of all rays, along the ray to the disc's middle: what
/// stands beside a sphere light, between its near side and its rim, is decided by that.
class Shadows {
  public:
    /// @param tree    of the bodies; it must outlive this, like them
    /// @param limit   bodies farther along a ray shade nothing [m]
    Shadows(const PlacedBodies& placed, const BodyTree& tree, double limit = kMiss)
        : placed_(placed), tree_(tree), limit_(limit) {}

    /// @param point   relative to the camera, world axes
    /// @param on      the body that it lies on: left out, as a convex body never shades its own lit
    ///                side
    double visibility(const LightDisc& light, const Vec4& point, std::uint32_t on,
                      FrameStats& stats, double time = 0) const;

  private:
    bool is_hidden(const Ray& ray, FrameStats& stats) const;
    /// Whether a body lies beyond the ray's limit.
    bool is_behind(const Ray& ray, std::uint32_t body) const;

    const PlacedBodies& placed_;
    const BodyTree& tree_;
    double limit_;
};

}  // namespace tesserae::render
