// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/camera/camera.hpp"
#include "render/scene/bounds_scene.hpp"
#include "render/scene/intersect.hpp"
#include "render/scene/slice.hpp"

namespace tesserae::render {

/// The bodies as view rays from anywhere near the camera meet them: lenses, thick slices. The
/// candidates are those of a BoundsScene, over the exact bounds of the slices; the hits are those
/// of hit_distance, in double. Rays from the pinhole itself have the tiles' lists, which are
/// faster: see FilmList.
class ViewScene {
  public:
    /// Built on the threads of the caller's task arena.
    /// @param placed, camera, settings   must outlive it
    /// @param range                      that holds every ray's `fourth`
    /// @param reach                      no ray starts farther from the camera than this [m]
    ViewScene(const PlacedBodies& placed, const Camera& camera, const Settings& settings,
              const SliceRange& range, double reach);
    ViewScene(const ViewScene&) = delete;  // its parts refer to each other

    /// What each ray meets first within settings.ray_limit().
    /// @param rays   finite
    /// @param hits   as many
    void nearest(std::span<const ViewRay> rays, std::span<Hit> hits, FrameStats& stats) const;

  private:
    const PlacedBodies& placed_;
    const Camera& camera_;
    const Settings& settings_;
    SliceRange range_;
    std::vector<SliceBounds> slice_;  ///< of the bounded bodies
    std::vector<std::uint32_t> unbounded_;
    std::optional<BoundsScene> bounded_;
};

}  // namespace tesserae::render
