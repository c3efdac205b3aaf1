// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/camera/camera.hpp"
#include "render/scene/bounds_scene.hpp"
#include "render/scene/intersect.hpp"

namespace tesserae::render {

/// A body beside the slice, which is drawn though no view ray meets it: cut by another slice,
/// parallel to the camera's, and the paler the farther away it is.
struct Ghost {
    std::uint32_t body = 0;  ///< index into PlacedBodies::bodies
    double fourth = 0;       ///< of the slice that cuts it, along the camera's fourth axis [m]
    double alpha = 0;        ///< 1 less the gap between slice and body, as a part of the depth
    Color color;             ///< where the surface faces the ray
};

/// The bounded bodies that a slice misses by less than `depth` [m], ascending by body. The slice
/// that cuts a ghost goes through its centre, or, where that is farther, is `depth` away.
/// @param slice   what the picture shows along the camera's fourth axis
/// @param color   of ghosts on the fourth axis's negative and positive side
std::vector<Ghost> ghosts_beside(const PlacedBodies& placed, const Camera& camera,
                                 const SliceRange& slice, double depth,
                                 const std::array<Color, 2>& color);

/// What a view ray meets of ghosts, all together.
struct GhostLight {
    Color color = Color::Zero();  ///< premultiplied by alpha
    double alpha = 0;

    GhostLight& operator+=(const GhostLight& other) {
        color += other.color, alpha += other.alpha;
        return *this;
    }
};

/// The ghosts beside a slice as its view rays meet them. They stand as they do when the shutter
/// opens.
class Ghosts {
  public:
    /// Built on the threads of the caller's task arena.
    /// @param placed, camera, settings   must outlive it
    /// @param reach                      no ray starts farther from the camera than this [m]
    Ghosts(const PlacedBodies& placed, const Camera& camera, const Settings& settings,
           const SliceRange& slice, double reach);
    Ghosts(const Ghosts&) = delete;  // its parts refer to each other

    /// Ghosts before the solid surface, the nearer over the farther; of equally near ones, that of
    /// the lower body comes first. One that the ray starts in is not seen.
    /// @param solid   what the ray meets in its slice, if anything
    GhostLight along(const ViewRay& ray, const Hit& solid, FrameStats& stats) const;

  private:
    class Met;

    const PlacedBodies& placed_;
    const Camera& camera_;
    const Settings& settings_;
    std::vector<Ghost> ghosts_;        ///< those in front of the camera
    std::vector<SliceBounds> bounds_;  ///< of each
    BoundsScene scene_;
};

}  // namespace tesserae::render
