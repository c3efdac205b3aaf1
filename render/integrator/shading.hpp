// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "render/light/light_set.hpp"
#include "render/light/shadow.hpp"
#include "render/material/bsdf.hpp"
#include "render/material/rough.hpp"
#include "render/material/surface.hpp"
#include "render/scene/intersect.hpp"

namespace tesserae::render {

/// The thesis's picture: surfaces lit by suns, point and sphere lights, with shadows, and by an
/// unoccluded sky.
class Shading {
  public:
    /// @param tree     of the bodies; without lights that cast shadows nothing asks it
    /// @param rough    of its materials; must outlive it, like the others
    Shading(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
            const LightSet& lights, const RoughReflections& rough);

    /// Where a ray meets a body.
    void find_surface(const Hit& hit, const Ray& ray, Surface& surface) const;
    Surface surface(const Hit& hit, const Ray& ray) const {
        Surface s;
        find_surface(hit, ray, s);
        return s;
    }

    /// Radiance that leaves the surface toward the viewer: its emission, plus the sum over the
    /// lights of BRDF * irradiance * visibility, plus albedo times the sky's radiance. The BRDF of
    /// a 4D Lambert surface is 3 albedo/(4 pi), as the integral of cos over the hemisphere of S^3
    /// is 4 pi/3; a rough surface's is taken toward the light's middle, and its share of the sky as
    /// Lambert's. Point and sphere lights may be left out as long as that changes no channel by
    /// more than 1e-4 of it.
    /// @param out   toward the viewer, unit, world axes
    Color radiance(const Surface& surface, const Vec4& out, FrameStats& stats) const;

  private:
    void add_lamps(const Surface& surface, const Bsdf& bsdf, Color& sum, FrameStats& stats) const;
    /// One light's share of the radiance.
    Color reflected(const Surface& surface, const Bsdf& bsdf, const LightDisc& light,
                    const Color& irradiance, FrameStats& stats) const;

    const Picture& picture_;
    const PlacedBodies& placed_;
    const LightSet& lights_;
    const RoughReflections& rough_;
    std::optional<Shadows> shadows_;  ///< none without lights that cast shadows
};

}  // namespace tesserae::render
