// SPDX-License-Identifier: Apache-2.0
#include "render/integrator/integrator.hpp"

#include <algorithm>
#include <cmath>

#include "render/material/dielectric.hpp"
#include "render/picture_needs.hpp"
#include "render/sampling/cap.hpp"

namespace tesserae::render {
namespace {

/// From this bounce on a path may end at random.
constexpr int kRouletteFrom = 4;
/// And it goes on at most this often from surfaces other than mirrors and glass, so that no path
/// runs for ever between white ones. Mirrors and clear glass end none at random: a few paths are
/// long, which costs little, and bright specks would be what is left of them.
constexpr double kSurvival = 0.95;

}  // namespace

std::unique_ptr<const LightIntegrator> make_integrator(const Picture& picture,
                                                       const PlacedBodies& placed,
                                                       const BodyTree& tree, const LightSet& lights,
                                                       const Shading& shading) {
    if (picture.settings.integrator == Integrator::kPath)
        return std::make_unique<PathIntegrator>(picture, placed, tree, lights, shading);
    return std::make_unique<DirectIntegrator>(picture, placed, tree, lights, shading);
}

LightIntegrator::LightIntegrator(const Picture& picture, const PlacedBodies& placed,
                                 const BodyTree& tree, const LightSet& lights,
                                 const Shading& shading)
    : settings_(picture.settings), lights_(lights), shading_(shading), glass_(picture, placed) {
    const PictureNeeds needs = needs_of(picture);
    if (needs.bounce_rays || needs.moving) scene_.emplace(placed, tree, picture.settings);
}

void LightIntegrator::begin(PathWave& wave, const ViewSample& sample, std::uint32_t number) const {
    wave.live.push_back(static_cast<std::uint32_t>(wave.paths.size()));
    LightPath& path = wave.paths.emplace_back(sample, number);
    path.ray.limit = sample.first ? sample.first->distance : kMiss;
    path.light = lights_.first_sphere(path.ray).sphere;
    if (path.direct) *path.direct = Color::Zero();
}

void LightIntegrator::trace(PathWave& wave, FrameStats& stats) const {
    stats.bounce_rays += wave.live.size();
    wave.rays.clear();
    for (const std::uint32_t i : wave.live)
        if (!wave.paths[i].is_in_glass()) wave.rays.push_back(wave.paths[i].ray);
    wave.hits.resize(wave.rays.size());
    if (!wave.rays.empty()) scene_->nearest(wave.rays, wave.hits, stats);
    if (wave.surfaces.size() < wave.paths.size()) wave.surfaces.resize(wave.paths.size());

    auto hit = wave.hits.begin();
    for (const std::uint32_t i : wave.live) {
        LightPath& path = wave.paths[i];
        const GlassBodies::Event event = path.is_in_glass()
                                             ? glass_.next(path.medium, path.ray, stats)
                                             : GlassBodies::Event{glass_.ruling(*hit++, path.ray)};
        path.surface = nullptr;
        if (event.hit) {
            shading_.find_surface(event.hit, path.ray, wave.surfaces[i]);
            path.surface = &wave.surfaces[i];
        }
        path.is_exit = event.is_exit;
        path.ray.limit = event.hit.distance;
        path.light = lights_.first_sphere(path.ray).sphere;
    }
}

Color LightIntegrator::light_seen(const LightPath& path, double chosen) const {
    if (path.light != LightSet::kNone)
        return power_weight(path.density, chosen) * lights_.spheres[path.light].radiance;
    if (path.is_view) return sky_seen();
    Color light = lights_.sky;
    for (const SunDisc& sun : lights_.suns)
        if (sun.angle > 0 && (path.ray.direction - sun.toward).squaredNorm() <= sun.squared_chord)
            light += power_weight(path.density, 1 / sun.cap.solid_angle()) * sun.radiance;
    return light;
}

std::uint32_t LightIntegrator::first_group(int scattered, std::size_t lamps) const {
    const std::size_t groups = 1 + lights_.suns.size() + lamps;
    return static_cast<std::uint32_t>(groups) * static_cast<std::uint32_t>(scattered);
}

void LightIntegrator::leave(LightPath& path, const Vec4& direction, double density) const {
    path.ray = {path.surface->point, direction, path.surface->body, settings_.ray_limit(),
                path.ray.time};
    path.density = density;
    path.normal = path.surface->normal;
    path.is_view = false;
}

void LightIntegrator::scatter_specular(LightPath& path, double choice) const {
    const Surface& s = *path.surface;
    const Vec4 direction = path.ray.direction;
    const Vec4 facing = path.is_exit ? Vec4(-s.normal) : s.normal;
    Color weight = s.albedo;
    leave(path, reflected(direction, facing), 0);
    if (s.material->kind == MaterialKind::kGlass) {
        const std::uint32_t beyond =
            path.is_exit ? glass_.medium_beyond(s.body, s.point, s.time) : s.body;
        const double ratio = glass_.refractive_index(path.medium) / glass_.refractive_index(beyond);
        const double cosine = std::clamp(-direction.dot(facing), 0.0, 1.0);
        const auto across = refracted(direction, facing, ratio);
        if (across && !(choice < fresnel(cosine, ratio))) {
            path.ray.direction = *across;
            path.medium = beyond;
            weight = radiance_scale(ratio) * s.albedo;
        }
        if (!path.is_in_glass())
            path.ray.origin = glass_.start_outside(s.body, s.point, path.ray.direction, s.time);
    }
    path.throughput *= weight;
    ++path.specular;
}

bool LightIntegrator::is_cut(const LightPath& path, FrameStats& stats) const {
    if (path.specular < settings_.specular_bounces) return false;
    ++stats.cut_paths;
    return true;
}

bool LightIntegrator::survives(LightPath& path, int scattered, double chance) const {
    // Inside glass radiance is up to index^3 as high: what counts is what gets out.
    const double index = glass_.refractive_index(path.medium);
    const double most = path.throughput.maxCoeff() * index * index * index;
    if (!(most > 0)) return false;
    if (scattered < kRouletteFrom) return true;
    const double survival = std::min(is_specular(*path.surface->material) ? 1 : kSurvival, most);
    if (chance >= survival) return false;
    path.throughput /= survival;
    return true;
}

double LightIntegrator::power_weight(double p, double q) {
    if (!(p > 0 && q > 0)) return 1;
    const double ratio = q / p;
    return 1 / (1 + ratio * ratio);
}

}  // namespace tesserae::render
