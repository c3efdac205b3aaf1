#pragma once

#include <cstdint>
#include <optional>

#include "render/glass_bodies.hpp"
#include "render/light/light_set.hpp"
#include "render/material/bsdf.hpp"
#include "render/ray_scene.hpp"
#include "render/sampler.hpp"
#include "render/shading.hpp"

namespace tesserae::render {

/// Radiance along view rays. A ray is followed from surface to surface: mirrors and glass send it
/// on, up to `bounces` times. What else it meets
///  - `direct`: ends it, with Shading's closed forms;
///  - `path`: adds what a random point of every light brings there, and sends it on in a random
///    direction of the surface's own choice.
/// Lights that both choices can find (sphere lights, suns with an angle) are counted with weights
/// that add up to 1 (power heuristic; Veach 1997, section 9.2); the sky, emission and whatever is
/// seen in mirrors and through glass is found by the ray alone, point lights and hard suns by the
/// lights' choice alone. So the mean over samples is exact, but for the light of points and hard
/// suns by way of mirrors and glass, which no ray finds.
/// `bounces` = 0 is emitted and direct light: at most bounces + 1 surfaces scatter a path.
/// Sphere lights are seen by every ray and end it, in front of what lies behind them; suns with an
/// angle are seen by all but view rays.
class LightTransport {
  public:
    /// Whether any ray but view rays and those of Shading's shadows is traced.
    static bool needs_rays(const Picture& picture);

    /// All must outlive it.
    /// @param tree   of the bodies; nothing asks it unless needs_rays()
    LightTransport(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
                   const LightSet& lights, const Shading& shading);

    /// @param first       what a view ray met, if any body
    /// @param origin      of that ray, relative to the camera, world axes
    /// @param direction   of that ray, unit
    /// @param sampler     of the sample; its groups are used from 0 on
    Color radiance(const std::optional<Surface>& first, const Vec4& origin, const Vec4& direction,
                   const Sampler& sampler, FrameStats& stats) const;

  private:
    struct Ray {
        Vec4 origin, direction;
        std::uint32_t on = RayScene::kNoBody;       ///< the body that it left
        std::uint32_t medium = GlassBodies::kNone;  ///< the glass that it is in
        /// Of the choice of the direction, where lights were chosen as well; else 0.
        double density = 0;
        bool is_view = false;
    };
    /// What a ray meets: a surface, a light, or neither (the sky).
    struct Arrival {
        std::optional<Surface> surface;
        bool is_exit = false;  ///< from inside, out of the ray's medium
        std::uint32_t light = LightSet::kNone;
    };

    Arrival arrive(const Ray& ray, FrameStats& stats) const;
    /// Radiance of the light or the sky that a ray ends in, weighted against the choice of lights.
    Color light_seen(const Ray& ray, const Arrival& arrival) const;
    Color light_of_spheres_and_suns(const Surface& surface, const Bsdf& bsdf,
                                    const Sampler& sampler, std::uint32_t group,
                                    FrameStats& stats) const;
    Color light_of_points(const Surface& surface, const Bsdf& bsdf, FrameStats& stats) const;
    /// Whether light reaches a surface's point from a direction, from no farther than `limit`.
    bool is_lit(const Surface& surface, const Vec4& toward, double limit, FrameStats& stats) const;

    /// Sends a ray on from a mirror or glass; what it brings back is to be multiplied with the
    /// result.
    /// @param choice   uniform in [0, 1): between reflection and refraction
    Color scatter_specular(Ray& ray, const Arrival& arrival, double choice) const;

    const Picture& picture_;
    const LightSet& lights_;
    const Shading& shading_;
    GlassBodies glass_;
    std::optional<RayScene> scene_;  ///< none where view rays are all that there is
};

}  // namespace tesserae::render
