#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/glass_bodies.hpp"
#include "render/integrator/integrator.hpp"

namespace tesserae::render {

/// Light followed from the viewer back: the ray that it has come to, what that meets (a surface, a
/// light, or neither: the sky), and what it has brought so far.
struct LightPath {
    Ray ray;
    Sampler sampler;
    std::uint32_t sample;                       ///< whose view ray it began with
    std::uint32_t medium = GlassBodies::kNone;  ///< the glass that the ray is in
    /// Of the choice of the ray's direction, where lights were chosen as well; else 0.
    double density = 0;
    bool is_view = true;

    std::optional<Surface> surface{};
    bool is_exit = false;  ///< the surface is met from inside, out of the medium
    std::uint32_t light = LightSet::kNone;

    Color sum = Color::Zero(), throughput = Color::Ones();
    /// Scatterings since the first surface that is no mirror or glass, with that one's. What such a
    /// surface gets from a light or from what glows is direct, what comes farther not.
    int since_rough = 0;

    bool is_in_glass() const { return medium != GlassBodies::kNone; }
    bool meets_surface() const { return surface && light == LightSet::kNone; }
    /// Goes on from the surface.
    void leave(const Vec4& direction, double chosen_density = 0) {
        ray = {surface->point, direction, surface->body};
        density = chosen_density;
        is_view = false;
    }
};

/// Paths that are followed side by side, since their rays are traced faster so. None changes what
/// another one brings.
struct PathWave {
    std::vector<LightPath> paths;
    std::vector<std::uint32_t> live;  ///< the paths that go on, ascending
    std::vector<Ray> rays;            ///< of those outside glass; with their hits
    std::vector<Hit> hits;

    void add(const LightPath& path) {
        live.push_back(static_cast<std::uint32_t>(paths.size()));
        paths.push_back(path);
    }
    /// Scatters every live path; scatter(path) is false for those that end there.
    template <class Scatter>
    void scatter_each(Scatter&& scatter) {
        std::erase_if(live, [&](std::uint32_t i) { return !scatter(paths[i]); });
    }
    void write_sums(std::span<Color> colors) const {
        for (const LightPath& path : paths) colors[path.sample] = path.sum;
    }
};

/// What both integrators do along a path: find what its rays meet, let mirrors and glass send them
/// on, end some of the long ones.
class LightPaths {
  public:
    LightPaths(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
               const LightSet& lights, const Shading& shading);

    /// The path of a view ray, arrived where that arrives.
    LightPath begin(const ViewSample& sample, std::uint32_t index) const;

    /// Follows the rays of the live paths to what they meet.
    void trace(PathWave& wave, FrameStats& stats) const;

    /// Radiance of the light or the sky that a path's ray ends in, weighted against the choice of
    /// lights.
    Color light_seen(const LightPath& path) const;

    /// The group of numbers for the scattering after so many. The groups up to the next one's are
    /// for the choice of lights, one for each sun and sphere light.
    std::uint32_t group(int scattered) const;

    /// Sends a path on from a mirror or glass.
    /// @param choice   uniform in [0, 1): between reflection and refraction
    void scatter_specular(LightPath& path, double choice) const;

    /// Whether a path goes on after its scattering: by Russian roulette once it is long.
    /// @param chance   uniform in [0, 1)
    bool survives(LightPath& path, int scattered, double chance) const;

    /// Whether any body is on the ray.
    bool is_blocked(const Ray& ray, FrameStats& stats) const {
        return scene_->is_blocked(ray, stats);
    }

  private:
    const LightSet& lights_;
    const Shading& shading_;
    GlassBodies glass_;
    std::optional<RayScene> scene_;  ///< none where view rays are all that there is
};

/// The weight of a choice of density p against one of density q (Veach's power heuristic).
double power_weight(double p, double q);

}  // namespace tesserae::render
