// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/camera/camera.hpp"
#include "render/scene/slice.hpp"

namespace tesserae::render {

/// Finds the bodies that a view ray may meet, by Embree's hierarchy over their slices' bounds. What
/// a view ray meets is three-dimensional, so Embree's three dimensions are enough; whether a body
/// is met at all, and where, is the caller's to find in double.
class BoundsScene {
  public:
    /// Built on the threads of the caller's task arena.
    /// @param bounds   of bounded bodies; must outlive it
    /// @param reach    no ray starts farther from the camera than this [m]
    BoundsScene(const std::vector<SliceBounds>& bounds, double reach);
    ~BoundsScene();
    BoundsScene(BoundsScene&&) noexcept;

    /// What is done with the candidates of one ray.
    class Search {
      public:
        /// @param number   of a candidate in the bounds; they come in any order
        /// @return how far along the ray further candidates count [m]
        virtual double test(std::uint32_t number) = 0;

      protected:
        ~Search() = default;
    };
    /// @param ray     finite; its place along the fourth axis does not matter here
    /// @param limit   how far along the ray candidates count at first [m]
    void search(const ViewRay& ray, double limit, Search& candidates) const;

  private:
    struct EmbreeScene;

    double reach_;
    std::unique_ptr<EmbreeScene> embree_;  ///< none without bodies
};

}  // namespace tesserae::render
