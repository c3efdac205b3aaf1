// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/integrator/shading.hpp"
#include "render/light/lamps.hpp"
#include "render/light/light_set.hpp"
#include "render/material/bsdf.hpp"
#include "render/sampling/sampler.hpp"
#include "render/scene/glass_bodies.hpp"
#include "render/scene/ray_scene.hpp"

namespace tesserae::render {

/// How a view ray stands to glass.
struct GlassStart {
    std::uint32_t medium = GlassBodies::kNone;  ///< the glass that it begins in
    bool is_exit = false;  ///< what it meets first is met from inside: the way out of the medium
};

/// A sample's view ray and the rest that decides what comes along it.
struct ViewSample {
    const Surface* first;  ///< what the ray meets; null if nothing
    Ray ray;
    Sampler sampler;  ///< of the sample; its groups are used from 0 on
    GlassStart start{};
    Color* direct = nullptr;  ///< gets LightPath::direct, where that is asked for
};

/// Light followed from the viewer back: the ray that it has come to, what that meets (a surface, a
/// light, or neither: the sky), and what it has brought so far.
struct LightPath {
    /// @param number   of the view ray
    LightPath(const ViewSample& view, std::uint32_t number)
        : ray(view.ray),
          sampler(view.sampler),
          sample(number),
          medium(view.start.medium),
          surface(view.first),
          is_exit(view.start.is_exit),
          direct(view.direct) {}

    Ray ray;
    Sampler sampler;
    std::uint32_t sample;  ///< whose view ray it began with
    std::uint32_t medium;  ///< the glass that the ray is in
    /// Of the choice of the ray's direction, where lights were chosen as well; else 0.
    double density = 0;
    Vec4 normal = Vec4::Zero();  ///< of the surface that the ray comes from
    bool is_view = true;

    const Surface* surface;
    bool is_exit;  ///< the surface is met from inside, out of the medium
    std::uint32_t light = LightSet::kNone;
    int specular = 0;  ///< scatterings by mirrors and glass so far

    Color sum = Color::Zero(), throughput = Color::Ones();
    Color from_lights = Color::Zero();  ///< what the surface sends on of what lights bring to it
    /// Where asked for: the part of the sum that is no indirect light (see since_rough).
    Color* direct;
    /// Scatterings since the first surface that is no mirror or glass, with that one's. What such a
    /// surface gets from a light or from what glows is direct, what comes farther not.
    int since_rough = 0;

    bool is_in_glass() const { return medium != GlassBodies::kNone; }
    bool meets_surface() const { return surface && light == LightSet::kNone; }
};

/// What a light brings to a path's surface if nothing stands between them.
struct Lighting {
    std::uint32_t path;
    Color light;  ///< sent on toward the viewer
};

/// Paths that are followed side by side, since their rays are traced faster so. None changes what
/// another one brings. It keeps its memory from one use to the next.
struct PathWave {
    std::vector<LightPath> paths;
    std::vector<std::uint32_t> live;  ///< the paths that go on, ascending
    std::vector<Ray> rays;            ///< of those outside glass; with their hits
    std::vector<Hit> hits;
    std::vector<Surface> surfaces;  ///< by path: what its last ray met
    std::vector<Ray> light_rays;    ///< toward lights, up to them; with what they bring
    std::vector<Lighting> lightings;
    std::vector<std::uint8_t> blocked;
    std::vector<std::uint32_t> lit;  ///< the live paths whose surfaces get light from lights
};

/// The radiance along view rays. A ray is followed from surface to surface: mirrors and glass send
/// it on, up to `specular_bounces` times; what comes from other surfaces is where DirectIntegrator
/// and PathIntegrator differ: `bounces` = 0 is emitted and direct light, also by way of mirrors and
/// glass; at most bounces + 1 of them scatter a path. Sphere lights are seen by every ray and end
/// it, in front of what lies behind them; suns with an angle are seen by all but view rays.
class LightIntegrator {
  public:
    /// All must outlive it.
    /// @param tree   of the bodies; it is not asked unless PictureNeeds has rays off the slice
    LightIntegrator(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
                    const LightSet& lights, const Shading& shading);
    virtual ~LightIntegrator() = default;

    /// @param colors   as many as samples; what a sample's `direct` gets is no more than its colour
    /// @param wave     to work in
    virtual void radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                          PathWave& wave, FrameStats& stats) const = 0;

    /// What view rays begin in and go into, for who traces them; and, while something moves, what
    /// they meet.
    const GlassBodies& glass() const { return glass_; }
    const RayScene& scene() const { return *scene_; }

  protected:
    /// Adds the path of a view ray, arrived where that arrives.
    void begin(PathWave& wave, const ViewSample& sample, std::uint32_t number) const;
    /// Follows the rays of the live paths to what they meet.
    void trace(PathWave& wave, FrameStats& stats) const;
    /// Radiance of the light or the sky that a path's ray ends in, weighted against the choice of
    /// lights.
    /// @param chosen   density with which that gives the ray's direction, toward a sphere light
    Color light_seen(const LightPath& path, double chosen) const;
    /// What view rays bring that meet nothing.
    Color sky_seen() const {
        return settings_.sky == Sky::kOpaque ? lights_.sky : Color(Color::Zero());
    }
    /// The group of numbers for the scattering after so many. Those up to the next scattering's are
    /// for the choice of lights, one for each sun and for each lamp that is asked.
    std::uint32_t first_group(int scattered, std::size_t lamps) const;
    /// Sends a path on from its surface.
    void leave(LightPath& path, const Vec4& direction, double density) const;
    /// The same from a mirror or glass.
    /// @param choice   uniform in [0, 1): between reflection and refraction
    void scatter_specular(LightPath& path, double choice) const;
    /// Whether a path that has come to a mirror or glass must end there; counted.
    bool is_cut(const LightPath& path, FrameStats& stats) const;
    /// Whether a path goes on after its scattering: by Russian roulette once it is long.
    /// @param chance   uniform in [0, 1)
    bool survives(LightPath& path, int scattered, double chance) const;
    /// The weight of a choice of density p against one of density q; 1 where one is 0.
    static double power_weight(double p, double q);

    const Settings& settings_;
    const LightSet& lights_;
    const Shading& shading_;
    GlassBodies glass_;
    std::optional<RayScene> scene_;  ///< none where view rays of the slice are all there is
};

/// Direct light without noise: the first surface that is no mirror or glass ends a path, with
/// Shading's closed forms.
class DirectIntegrator : public LightIntegrator {
  public:
    using LightIntegrator::LightIntegrator;
    void radiance(std::span<const ViewSample> samples, std::span<Color> colors, PathWave& wave,
                  FrameStats& stats) const override;

  private:
    bool scatter(LightPath& path, int scattered, FrameStats& stats) const;
};

/// All light, with noise that falls with the number of samples. Every surface that is no mirror or
/// glass adds what a random point of every light brings there, and sends the path on in a random
/// direction of its own choice. Lights that both choices can find (sphere lights, suns with an
/// angle, bounded bodies that glow) are counted with weights that add up to 1 (power heuristic;
/// Veach 1997, section 9.2); the sky, planes that glow and whatever is seen in mirrors and through
/// glass is found by the ray alone, point lights and hard suns by the lights' choice alone. So the
/// mean over samples is exact, but for the light of points and hard suns by way of mirrors and
/// glass, which no ray finds. Its reference chooses no lights: path_reference() of
/// tests/render/integrator/path_test.cpp.
class PathIntegrator : public LightIntegrator {
  public:
    PathIntegrator(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
                   const LightSet& lights, const Shading& shading);
    void radiance(std::span<const ViewSample> samples, std::span<Color> colors, PathWave& wave,
                  FrameStats& stats) const override;

  private:
    bool arrive(LightPath& path, int scattered, FrameStats& stats) const;
    void light(PathWave& wave, int scattered, FrameStats& stats) const;
    void scatter(PathWave& wave, int scattered) const;
    /// Adds light that comes to where a path has arrived; indirect light is clamped.
    void add(LightPath& path, const Color& light, bool is_indirect) const;
    /// Shadow rays from a path's surface, with what they bring, into the wave:
    void aim_at_points(PathWave& wave, std::uint32_t path, const Bsdf& bsdf) const;
    /// From all paths that are lit.
    /// @param group   of the sampler's numbers: the first of one for each light
    void aim_at_suns(PathWave& wave, std::uint32_t group) const;
    void aim_at_lamps(PathWave& wave, std::uint32_t path, const Bsdf& bsdf, std::uint32_t group,
                      FrameStats& stats) const;
    /// Through a point of a disc of even radiance.
    /// @param in       toward it, world axes
    /// @param angle    solid angle of the disc over the chance that it was chosen
    /// @param source   the sphere light that it is, or kNone
    void aim_at_disc(PathWave& wave, std::uint32_t path, const Bsdf& bsdf, const Vec4& in,
                     double angle, const Color& radiance, std::uint32_t source) const;
    void aim_at_body(PathWave& wave, std::uint32_t path, const Bsdf& bsdf, const Lamp& lamp,
                     double chance, const Uniform3& u, FrameStats& stats) const;
    void aim(PathWave& wave, std::uint32_t path, Ray ray, const Color& light) const;
    /// With which the choice of lamps gives the direction of a path's ray, toward what it meets.
    double lamp_density(const LightPath& path) const;

    const PlacedBodies& placed_;
    Lamps lamps_;
};

/// The one that the picture's settings name.
std::unique_ptr<const LightIntegrator> make_integrator(const Picture& picture,
                                                       const PlacedBodies& placed,
                                                       const BodyTree& tree, const LightSet& lights,
                                                       const Shading& shading);

}  // namespace tesserae::render
