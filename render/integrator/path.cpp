// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "render/integrator/integrator.hpp"
#include "render/light/toward.hpp"
#include "render/sampling/cap.hpp"
#include "render/scene/intersect.hpp"

namespace tesserae::render {
namespace {

/// No brighter than `most`; of the same hue. 0: as it is.
Color clamped(const Color& light, double most) {
    const double brightest = light.maxCoeff();
    return most > 0 && brightest > most ? Color(light * (most / brightest)) : light;
}

/// The numbers of one group, of four samples.
using FourGroups = std::array<simd::Double4, 4>;

/// Calls use(paths, numbers) for four of the paths after the other, in the end for fewer, with
/// their numbers of a group.
template <class Use>
void for_each_four(const PathWave& wave, std::span<const std::uint32_t> paths, std::uint32_t group,
                   Use&& use) {
    for (std::size_t begin = 0; begin < paths.size(); begin += 4) {
        const auto four = paths.subspan(begin, std::min<std::size_t>(4, paths.size() - begin));
        std::array<const Sampler*, 4> samplers;
        for (std::size_t i = 0; i < 4; ++i)
            samplers[i] = &wave.paths[four[std::min(i, four.size() - 1)]].sampler;
        use(four, Sampler::groups(samplers, group));
    }
}

}  // namespace

PathIntegrator::PathIntegrator(const Picture& picture, const PlacedBodies& placed,
                               const BodyTree& tree, const LightSet& lights, const Shading& shading)
    : LightIntegrator(picture, placed, tree, lights, shading),
      placed_(placed),
      lamps_(lights, picture, placed) {}

void PathIntegrator::radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                              PathWave& wave, FrameStats& stats) const {
    wave.paths.clear();
    wave.live.clear();
    for (std::uint32_t i = 0; i < samples.size(); ++i) begin(wave, samples[i], i);
    for (int scattered = 0; !wave.live.empty(); ++scattered) {
        std::erase_if(wave.live,
                      [&](std::uint32_t i) { return !arrive(wave.paths[i], scattered, stats); });
        light(wave, scattered, stats);
        scatter(wave, scattered);
        trace(wave, stats);
    }
    for (const LightPath& path : wave.paths) colors[path.sample] = path.sum;
}

/// Adds what comes by itself from where a path has arrived after so many scatterings. False where
/// it ends.
bool PathIntegrator::arrive(LightPath& path, int scattered, FrameStats& stats) const {
    if (!path.meets_surface()) {
        add(path, light_seen(path, lamp_density(path)), path.since_rough > 1);
        return false;
    }
    const Color& emission = path.surface->material->emission;
    if (!(emission == 0).all())
        add(path, power_weight(path.density, lamp_density(path)) * emission, path.since_rough > 1);
    if (is_specular(*path.surface->material)) return !is_cut(path, stats);
    return scattered - path.specular <= settings_.bounces;
}

/// Adds what lights bring to the surfaces of the live paths.
void PathIntegrator::light(PathWave& wave, int scattered, FrameStats& stats) const {
    const std::uint32_t group = first_group(scattered, lamps_.asked()) + 1;
    const auto suns = static_cast<std::uint32_t>(lights_.suns.size());
    wave.light_rays.clear();
    wave.lightings.clear();
    wave.lit.clear();
    for (const std::uint32_t i : wave.live) {
        LightPath& path = wave.paths[i];
        path.from_lights = Color::Zero();
        // Glass lets no straight ray to a light pass: the path's own finds the light.
        if (!is_specular(*path.surface->material) && !path.is_in_glass()) wave.lit.push_back(i);
    }
    aim_at_suns(wave, group);
    for (const std::uint32_t i : wave.lit) {
        const Bsdf bsdf(*wave.paths[i].surface, -wave.paths[i].ray.direction);
        aim_at_points(wave, i, bsdf);
        aim_at_lamps(wave, i, bsdf, group + suns, stats);
    }
    stats.shadow_rays += wave.light_rays.size();
    wave.blocked.resize(wave.light_rays.size());
    if (!wave.light_rays.empty()) scene_->find_blocked(wave.light_rays, wave.blocked, stats);
    for (std::size_t k = 0; k < wave.lightings.size(); ++k)
        if (!wave.blocked[k])
            wave.paths[wave.lightings[k].path].from_lights += wave.lightings[k].light;
    for (const std::uint32_t i : wave.live)
        add(wave.paths[i], wave.paths[i].from_lights, wave.paths[i].since_rough > 0);
}

/// Sends the live paths on; some end.
void PathIntegrator::scatter(PathWave& wave, int scattered) const {
    const auto is_live = [&](LightPath& path, const Uniform3& u, double chance,
                             const Vec4& cosine) {
        const Surface& surface = *path.surface;
        if (is_specular(*surface.material)) {
            scatter_specular(path, u[0]);
            if (path.since_rough > 0) ++path.since_rough;
        } else {
            const auto next = Bsdf(surface, -path.ray.direction).sample(u, cosine);
            path.throughput *= next.weight;
            leave(path, next.in, path.is_in_glass() ? 0 : next.density);
            ++path.since_rough;
        }
        return survives(path, scattered, chance);
    };
    std::size_t kept = 0;
    for_each_four(
        wave, wave.live, first_group(scattered, lamps_.asked()),
        [&](std::span<const std::uint32_t> paths, const FourGroups& u) {
            const FourDirections cosines = cosine_directions({u[0], u[1], u[2]});
            for (std::size_t i = 0; i < paths.size(); ++i)
                if (is_live(wave.paths[paths[i]], {u[0][i], u[1][i], u[2][i]}, u[3][i], cosines[i]))
                    wave.live[kept++] = paths[i];
        });
    wave.live.resize(kept);
}

void PathIntegrator::add(LightPath& path, const Color& light, bool is_indirect) const {
    const Color seen = path.throughput * light;
    path.sum += is_indirect ? clamped(seen, settings_.clamp_indirect) : seen;
    if (path.direct && !is_indirect) *path.direct += seen;
}

void PathIntegrator::aim_at_points(PathWave& wave, std::uint32_t path, const Bsdf& bsdf) const {
    const Surface& s = *wave.paths[path].surface;
    const auto aim_along = [&](const LightDisc& disc, const Color& irradiance) {
        if (!(irradiance > 0).any()) return;
        const Ray ray = {s.point, disc.toward, s.body, disc.limit, s.time};
        if (lights_.first_sphere(ray).sphere == LightSet::kNone)
            aim(wave, path, ray, bsdf.value(disc.toward) * irradiance);
    };
    for (const PointLight& point : lights_.points) {
        const LightAt light = LightSet::at(point, s.point, s.normal);
        aim_along(light.disc, light.irradiance);
    }
    for (const SunDisc& sun : lights_.suns)
        if (sun.angle == 0) aim_along(sun, s.normal.dot(sun.toward) * sun.irradiance);
}

void PathIntegrator::aim_at_suns(PathWave& wave, std::uint32_t group) const {
    for (const SunDisc& sun : lights_.suns) {
        const std::uint32_t own = group++;
        if (sun.angle == 0) continue;
        for_each_four(
            wave, wave.lit, own, [&](std::span<const std::uint32_t> paths, const FourGroups& u) {
                const FourDirections in =
                    sun.frame.to_world(sun.cap.directions({u[0], u[1], u[2]}));
                for (std::size_t i = 0; i < paths.size(); ++i) {
                    const LightPath& path = wave.paths[paths[i]];
                    aim_at_disc(wave, paths[i], Bsdf(*path.surface, -path.ray.direction), in[i],
                                sun.cap.solid_angle(), sun.radiance, LightSet::kNone);
                }
            });
    }
}

void PathIntegrator::aim_at_lamps(PathWave& wave, std::uint32_t path, const Bsdf& bsdf,
                                  std::uint32_t group, FrameStats& stats) const {
    const Surface& s = *wave.paths[path].surface;
    for (std::uint32_t k = 0; k < lamps_.asked(); ++k) {
        const auto u = wave.paths[path].sampler.group(group++);
        const auto choice = lamps_.choose(k, s.point, s.normal, u[3]);
        if (!choice) continue;
        const Lamp& lamp = lamps_[choice->lamp];
        const Uniform3 place = {u[0], u[1], u[2]};
        if (lamp.sphere == LightSet::kNone) {
            aim_at_body(wave, path, bsdf, lamp, choice->chance, place, stats);
            continue;
        }
        const LightDisc disc = LightSet::at(lights_.spheres[lamp.sphere], s.point, s.normal).disc;
        if (disc.angle == 0) continue;
        const Cap cap(disc.angle);
        aim_at_disc(wave, path, bsdf, TangentFrame(disc.toward).to_world(cap.direction(place)),
                    cap.solid_angle() / choice->chance, lamp.radiance, lamp.sphere);
    }
}

void PathIntegrator::aim_at_disc(PathWave& wave, std::uint32_t path, const Bsdf& bsdf,
                                 const Vec4& in, double angle, const Color& radiance,
                                 std::uint32_t source) const {
    const Surface& s = *wave.paths[path].surface;
    const double cosine = s.normal.dot(in);
    if (!(cosine > 0)) return;
    // A nearer light may stand before this one.
    Ray ray = {s.point, in, s.body, kMiss, s.time};
    const LightSet::Seen seen = lights_.first_sphere(ray);
    ray.limit = seen.distance;
    if (seen.sphere != source) return;
    const double weight = power_weight(1 / angle, bsdf.density(in));
    aim(wave, path, ray, bsdf.value(in) * radiance * (cosine * angle * weight));
}

void PathIntegrator::aim_at_body(PathWave& wave, std::uint32_t path, const Bsdf& bsdf,
                                 const Lamp& lamp, double chance, const Uniform3& u,
                                 FrameStats& stats) const {
    const Surface& s = *wave.paths[path].surface;
    if (s.body == lamp.body) return;
    const PlacedBody& body = placed_.bodies[lamp.body];
    const auto toward = sample_toward(*body.shape, placed_.point_to_body(body, s.point, s.time), u);
    if (!toward) return;
    Ray ray = {s.point, placed_.direction_to_world(body, toward->direction, s.time), s.body,
               settings_.ray_limit(), s.time};
    const double cosine = s.normal.dot(ray.direction);
    if (!(cosine > 0)) return;
    const double distance = hit_distance(placed_, lamp.body, ray, settings_, stats);
    // Up to the body, not including it.
    ray.limit = std::nextafter(distance, 0.0);
    if (distance == kMiss || lights_.first_sphere(ray).sphere != LightSet::kNone) return;
    const double density = chance * toward->density;
    const double weight = power_weight(density, bsdf.density(ray.direction));
    aim(wave, path, ray, bsdf.value(ray.direction) * lamp.radiance * (cosine / density * weight));
}

void PathIntegrator::aim(PathWave& wave, std::uint32_t path, Ray ray, const Color& light) const {
    ray.limit = std::min(ray.limit, settings_.ray_limit());
    wave.light_rays.push_back(ray);
    wave.lightings.push_back({path, light});
}

double PathIntegrator::lamp_density(const LightPath& path) const {
    if (!(path.density > 0)) return 0;
    const Vec4& origin = path.ray.origin;
    if (path.light != LightSet::kNone) {
        const SphereLight& light = lights_.spheres[path.light];
        const double angle = LightSet::at(light, origin, path.ray.direction).disc.angle;
        if (angle == 0) return 0;
        return lamps_.chance_of(lamps_.of_sphere(path.light), origin, path.normal) /
               Cap(angle).solid_angle();
    }
    const std::uint32_t lamp = path.surface ? lamps_.of_body(path.surface->body) : Lamps::kNone;
    if (lamp == Lamps::kNone) return 0;
    const PlacedBody& body = placed_.bodies[path.surface->body];
    return lamps_.chance_of(lamp, origin, path.normal) *
           density_toward(*body.shape, placed_.point_to_body(body, origin, path.ray.time),
                          placed_.direction_to_body(body, path.ray.direction, path.ray.time));
}

}  // namespace tesserae::render
