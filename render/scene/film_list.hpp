// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/scene/intersect.hpp"
#include "render/scene/slice.hpp"

namespace tesserae::render {

/// The bodies that rays from the pinhole through a small window of the film can meet, nearest
/// first.
class FilmList {
  public:
    /// Side of the windows that pay best [pixels]: a list costs some hundred comparisons to make,
    /// and is the shorter the smaller its window.
    static constexpr int kSide = 8;

    /// Makes the list anew.
    /// @param list     indices into `slice`, ascending by `nearest`
    /// @param window   film points, closed
    void fill(std::span<const SliceBounds> slice, std::span<const std::uint32_t> list,
              const Crop& window);

    /// What a ray from the pinhole through the window meets first.
    /// @param view   its direction in camera coordinates
    Hit nearest(const PlacedBodies& placed, const Vec3& view, Ray ray, const Settings& settings,
                FrameStats& stats) const;

  private:
    struct Candidate {
        Vec3 centre;              ///< of the sphere about the slice
        double distance_squared;  ///< from the pinhole
        double radius_squared;
        double nearest;  ///< lower bound of the hit distance [m]
        std::uint32_t body;
    };
    std::vector<Candidate> candidates_;
};

}  // namespace tesserae::render
