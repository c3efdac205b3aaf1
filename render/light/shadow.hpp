// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "render/light/light_set.hpp"
#include "render/light/overlap.hpp"
#include "render/picture.hpp"
#include "render/scene/body_tree.hpp"

namespace tesserae::render {

/// The rim of a body as a ray's origin sees it along the ray, up to its limit: Rim::sine.
/// @param low, high   as in RimRange
double rim_sine(const PlacedBodies& placed, std::uint32_t body, const Ray& ray, double low,
                double high, FrameStats& stats);

/// How much of a light reaches a point: 0 to 1. The rim of a body that alone covers a part of the
/// disc counts as flat, and a small disc of directions as a Euclidean ball. Several bodies cover
/// it together: clear_part(), each bent as the ball about it is seen. A hard light is hidden or
/// not. A body counts as far as it comes before the limit, the light's or one of all rays, along
/// the ray to the disc's middle: what stands beside a sphere light, between its near side and its
/// rim, is decided by that.
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
    void complete(DiscCover& cover, const LightDisc& light, const Ray& ray,
                  const TangentFrame& frame, FrameStats& stats) const;
    bool is_hidden(const Ray& ray, FrameStats& stats) const;
    /// Whether a body lies beyond the ray's limit.
    bool is_behind(const Ray& ray, std::uint32_t body) const;

    const PlacedBodies& placed_;
    const BodyTree& tree_;
    double limit_;
};

}  // namespace tesserae::render
