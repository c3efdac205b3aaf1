#include "render/path.hpp"

#include <algorithm>
#include <cmath>

#include "render/material/dielectric.hpp"

namespace tesserae::render {
namespace {

/// From this bounce on a path may end at random.
constexpr int kRouletteFrom = 4;
/// And it goes on at most this often, so that no path runs for ever between white surfaces.
constexpr double kSurvival = 0.95;

/// The weight of a choice of density p against one of density q (Veach's power heuristic).
double power_weight(double p, double q) {
    const double ratio = q / p;
    return 1 / (1 + ratio * ratio);
}

/// Whether a direction lies in a light's disc, by chords, which keep the digits of small angles.
bool is_in_disc(const LightDisc& disc, const Vec4& direction) {
    return (direction - disc.toward).norm() <= 2 * std::sin(0.5 * disc.angle);
}

/// No brighter than `most`; of the same hue. 0: as it is.
Color clamped(const Color& light, double most) {
    const double brightest = light.maxCoeff();
    return most > 0 && brightest > most ? Color(light * (most / brightest)) : light;
}

}  // namespace

bool LightTransport::needs_rays(const Picture& picture) {
    if (picture.settings.integrator == Integrator::kPath) return true;
    return std::any_of(picture.appearance.begin(), picture.appearance.end(),
                       [&](const Appearance& a) {
                           return a.visible && is_specular(picture.materials[a.material]);
                       });
}

LightTransport::LightTransport(const Picture& picture, const PlacedBodies& placed,
                               const BodyTree& tree, const LightSet& lights, const Shading& shading)
    : picture_(picture), lights_(lights), shading_(shading), glass_(picture, placed) {
    if (needs_rays(picture)) scene_.emplace(placed, tree, picture.settings);
}

void LightTransport::radiance(std::span<const Start> starts, std::span<Color> colors,
                              FrameStats& stats) const {
    Wave wave;
    for (std::uint32_t i = 0; i < starts.size(); ++i) {
        const Start& start = starts[i];
        // The usual view rays of the direct picture need nothing of what follows.
        if (is_direct() && lights_.spheres.empty()) {
            colors[i] = lights_.sky;
            if (!start.first) continue;
            if (!is_specular(*start.first->material)) {
                colors[i] = shading_.radiance(*start.first, -start.direction, stats);
                continue;
            }
        }
        Path path = {{start.origin, start.direction}, {}, i};
        path.ray.is_view = true;
        if (start.first) path.arrival.surface = *start.first;
        const double limit = start.first ? start.first->distance : kMiss;
        path.arrival.light = lights_.first_sphere(start.origin, start.direction, limit).sphere;
        wave.live.push_back(static_cast<std::uint32_t>(wave.paths.size()));
        wave.paths.push_back(path);
    }

    for (int scattered = 0; !wave.live.empty(); ++scattered) {
        std::erase_if(wave.live, [&](std::uint32_t i) {
            Path& path = wave.paths[i];
            return !scatter(path, scattered, starts[path.start].sampler, stats);
        });
        trace(wave, stats);
    }
    for (const Path& path : wave.paths) colors[path.start] = path.sum;
}

void LightTransport::add(Path& path, const Color& light, bool is_indirect) const {
    const Color seen = path.throughput * light;
    path.sum += is_indirect ? clamped(seen, picture_.settings.clamp_indirect) : seen;
}

bool LightTransport::scatter(Path& path, int scattered, const Sampler& sampler,
                             FrameStats& stats) const {
    if (!path.arrival.surface || path.arrival.light != LightSet::kNone) {
        add(path, light_seen(path.ray, path.arrival), path.since_rough > 1);
        return false;
    }
    const Surface& surface = *path.arrival.surface;
    const int bounces = picture_.settings.bounces;
    const bool is_mirror = is_specular(*surface.material);
    if (is_direct() && !is_mirror && scattered <= bounces) {
        path.sum += path.throughput * shading_.radiance(surface, -path.ray.direction, stats);
        return false;
    }
    add(path, surface.material->emission, path.since_rough > 1);
    if (scattered > bounces) return false;

    const auto groups =
        1 + static_cast<std::uint32_t>(lights_.suns.size() + lights_.spheres.size());
    const std::uint32_t group = groups * static_cast<std::uint32_t>(scattered);
    const auto u = sampler.group(group);
    if (is_mirror)
        path.throughput *= scatter_specular(path.ray, path.arrival, u[0]);
    else
        scatter_rough(path, u, sampler, group + 1, stats);
    if (!is_mirror || path.since_rough > 0) ++path.since_rough;

    // Inside glass radiance is up to index^3 as high: what counts is what gets out.
    const double index = glass_.refractive_index(path.ray.medium);
    const double most = path.throughput.maxCoeff() * index * index * index;
    if (!(most > 0)) return false;
    if (scattered >= kRouletteFrom) {
        const double survival = std::min(kSurvival, most);
        if (u[3] >= survival) return false;
        path.throughput /= survival;
    }
    return true;
}

void LightTransport::scatter_rough(Path& path, const std::array<double, 4>& u,
                                   const Sampler& sampler, std::uint32_t group,
                                   FrameStats& stats) const {
    const Surface& surface = *path.arrival.surface;
    const Bsdf bsdf(surface, -path.ray.direction);
    // Glass lets no straight ray to a light pass.
    const bool is_free = path.ray.medium == GlassBodies::kNone;
    if (is_free)
        add(path,
            light_of_points(surface, bsdf, stats) +
                light_of_spheres_and_suns(surface, bsdf, sampler, group, stats),
            path.since_rough > 0);
    const Bsdf::Sample next = bsdf.sample({u[0], u[1], u[2]});
    path.throughput *= next.weight;
    path.ray = {surface.point, next.in, surface.body, path.ray.medium, is_free ? next.density : 0};
}

void LightTransport::trace(Wave& wave, FrameStats& stats) const {
    stats.bounce_rays += wave.live.size();
    const auto is_free = [](const Ray& ray) { return ray.medium == GlassBodies::kNone; };
    wave.rays.clear();
    for (const std::uint32_t i : wave.live) {
        const Ray& ray = wave.paths[i].ray;
        if (is_free(ray)) wave.rays.push_back({ray.origin, ray.direction, ray.on});
    }
    wave.hits.resize(wave.rays.size());
    if (!wave.rays.empty()) scene_->nearest(wave.rays, wave.hits, stats);

    auto hit = wave.hits.begin();
    for (const std::uint32_t i : wave.live) {
        const Ray& ray = wave.paths[i].ray;
        const GlassBodies::Event event =
            is_free(ray) ? GlassBodies::Event{*hit++}
                         : glass_.next(ray.medium, ray.origin, ray.direction, ray.on, stats);
        Arrival& arrival = wave.paths[i].arrival;
        arrival = {};
        arrival.light = lights_.first_sphere(ray.origin, ray.direction, event.hit.distance).sphere;
        arrival.is_exit = event.is_exit;
        if (event.hit) arrival.surface = shading_.surface(event.hit, ray.origin, ray.direction);
    }
}

Color LightTransport::light_seen(const Ray& ray, const Arrival& arrival) const {
    if (arrival.light != LightSet::kNone) {
        const SphereLight& light = lights_.spheres[arrival.light];
        const LightDisc disc = LightSet::at(light, ray.origin, ray.direction).disc;
        const double weight = ray.density > 0 && disc.angle > 0
                                  ? power_weight(ray.density, 1 / cap_solid_angle(disc.angle))
                                  : 1;
        return weight * light.radiance;
    }
    Color light = lights_.sky;
    if (ray.is_view) return light;
    for (const SunDisc& sun : lights_.suns)
        if (sun.angle > 0 && is_in_disc(sun, ray.direction))
            light +=
                (ray.density > 0 ? power_weight(ray.density, 1 / cap_solid_angle(sun.angle)) : 1) *
                sun.radiance;
    return light;
}

bool LightTransport::is_lit(const Surface& surface, const Vec4& toward, double limit,
                            FrameStats& stats) const {
    ++stats.shadow_rays;
    return !scene_->is_blocked(surface.point, toward, limit, surface.body, stats);
}

Color LightTransport::light_of_points(const Surface& s, const Bsdf& bsdf, FrameStats& stats) const {
    Color sum = Color::Zero();
    const auto add = [&](const LightDisc& disc, const Color& irradiance) {
        if (!(irradiance > 0).any()) return;
        const auto in_front = lights_.first_sphere(s.point, disc.toward, disc.limit);
        if (in_front.sphere == LightSet::kNone && is_lit(s, disc.toward, disc.limit, stats))
            sum += bsdf.value(disc.toward) * irradiance;
    };
    for (const PointLight& point : lights_.points) {
        const LightAt light = LightSet::at(point, s.point, s.normal);
        add(light.disc, light.irradiance);
    }
    for (const SunDisc& sun : lights_.suns)
        if (sun.angle == 0) add(sun, s.normal.dot(sun.toward) * sun.irradiance);
    return sum;
}

Color LightTransport::light_of_spheres_and_suns(const Surface& s, const Bsdf& bsdf,
                                                const Sampler& sampler, std::uint32_t group,
                                                FrameStats& stats) const {
    Color sum = Color::Zero();
    const auto add = [&](const LightDisc& disc, const Color& radiance, std::uint32_t sphere) {
        const auto u = sampler.group(group++);
        if (disc.angle == 0) return;
        const Vec4 in =
            TangentFrame(disc.toward).to_world(cap_direction(disc.angle, {u[0], u[1], u[2]}));
        const double cosine = s.normal.dot(in);
        if (!(cosine > 0)) return;
        // A nearer light may stand before this one.
        const LightSet::Seen seen = lights_.first_sphere(s.point, in, kMiss);
        if (seen.sphere != sphere || !is_lit(s, in, seen.distance, stats)) return;
        const double angle = cap_solid_angle(disc.angle);
        const double weight = power_weight(1 / angle, bsdf.density(in));
        sum += bsdf.value(in) * radiance * (cosine * angle * weight);
    };
    for (const SunDisc& sun : lights_.suns) add(sun, sun.radiance, LightSet::kNone);
    for (std::uint32_t i = 0; i < lights_.spheres.size(); ++i)
        add(LightSet::at(lights_.spheres[i], s.point, s.normal).disc, lights_.spheres[i].radiance,
            i);
    return sum;
}

Color LightTransport::scatter_specular(Ray& ray, const Arrival& arrival, double choice) const {
    const Surface& s = *arrival.surface;
    const Vec4 facing = arrival.is_exit ? Vec4(-s.normal) : s.normal;
    const Vec4 direction = ray.direction;
    ray = {s.point, reflected(direction, facing), s.body, ray.medium};
    if (s.material->kind != MaterialKind::kGlass) return s.albedo;

    const std::uint32_t beyond = arrival.is_exit ? glass_.medium_beyond(s.body, s.point) : s.body;
    const double ratio = glass_.refractive_index(ray.medium) / glass_.refractive_index(beyond);
    const double cosine = std::clamp(-direction.dot(facing), 0.0, 1.0);
    const auto across = refracted(direction, facing, ratio);
    if (!across || choice < fresnel(cosine, ratio)) return s.albedo;
    ray.direction = *across;
    ray.medium = beyond;
    return radiance_scale(ratio) * s.albedo;
}

}  // namespace tesserae::render
