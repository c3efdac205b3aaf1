#pragma once

#include <cstdint>

#include "render/body_tree.hpp"
#include "render/intersect.hpp"

namespace tesserae::render {

/// The bodies as rays in any direction of 4D meet them: shadow and bounce rays, which leave the
/// camera's hyperplane. Whole bodies, not their slices.
class RayScene {
  public:
    static constexpr std::uint32_t kNoBody = ~std::uint32_t{0};

    /// @param tree   of the bodies; it must outlive this, like the others
    RayScene(const PlacedBodies& placed, const BodyTree& tree, const Settings& settings)
        : placed_(placed), tree_(tree), settings_(settings) {}

    /// The nearest body that a ray meets no farther than `limit` [m]; equal distances go to the
    /// lower id. The origin is relative to the camera, the direction unit, both in world axes.
    /// @param on   a body left out, or kNoBody: a ray that leaves a convex body outward never meets
    ///             it again, so that no origin needs to be moved off its surface
    Hit nearest(const Vec4& origin, const Vec4& direction, double limit, std::uint32_t on,
                FrameStats& stats) const;

    /// Whether any body but `on` is met no farther than `limit` [m].
    bool is_blocked(const Vec4& origin, const Vec4& direction, double limit, std::uint32_t on,
                    FrameStats& stats) const;

  private:
    const PlacedBodies& placed_;
    const BodyTree& tree_;
    const Settings& settings_;
};

}  // namespace tesserae::render
