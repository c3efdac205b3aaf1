#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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

    /// What a view ray met, if any body, and the rest that decides a path.
    struct Start {
        const Surface* first;    ///< null if none
        Vec4 origin, direction;  ///< of the view ray, relative to the camera, unit; world axes
        Sampler sampler;         ///< of the sample; its groups are used from 0 on
    };
    /// The radiance along each view ray: `colors`, as many as `starts`. Paths are followed side by
    /// side, since their rays are traced faster so; none changes what another one brings.
    void radiance(std::span<const Start> starts, std::span<Color> colors, FrameStats& stats) const;

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

    struct Path {
        Ray ray;
        Arrival arrival;  ///< what the ray meets
        std::uint32_t start;
        Color sum = Color::Zero(), throughput = Color::Ones();
        /// Scatterings since the first surface that is no mirror or glass, with that one's. What
        /// such a surface gets from a light or from what glows is direct, what comes farther not.
        int since_rough = 0;
    };

    bool is_direct() const { return picture_.settings.integrator == Integrator::kDirect; }
    /// Adds light that comes to where a path has arrived; indirect light is clamped.
    void add(Path& path, const Color& light, bool is_indirect) const;
    /// Adds the light that comes from where a path has arrived after so many scatterings, and sends
    /// its ray on. False where it ends.
    bool scatter(Path& path, int scattered, const Sampler& sampler, FrameStats& stats) const;
    /// Sends a ray on from a surface that is no mirror or glass, and adds light.
    void scatter_rough(Path& path, const std::array<double, 4>& u, const Sampler& sampler,
                       std::uint32_t group, FrameStats& stats) const;
    /// Paths that are followed side by side.
    struct Wave {
        std::vector<Path> paths;
        std::vector<std::uint32_t> live;  ///< the paths that go on, ascending
        std::vector<RayScene::Ray> rays;
        std::vector<Hit> hits;
    };
    /// Traces the rays of the live paths.
    void trace(Wave& wave, FrameStats& stats) const;
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
