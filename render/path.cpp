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

Color LightTransport::radiance(const std::optional<Surface>& first, const Vec4& origin,
                               const Vec4& direction, const Sampler& sampler,
                               FrameStats& stats) const {
    const bool is_direct = picture_.settings.integrator == Integrator::kDirect;
    // The usual view rays of the direct picture need nothing of what follows.
    if (is_direct && lights_.spheres.empty()) {
        if (!first) return lights_.sky;
        if (!is_specular(*first->material)) return shading_.radiance(*first, -direction, stats);
    }

    const auto groups =
        1 + static_cast<std::uint32_t>(lights_.suns.size() + lights_.spheres.size());
    Ray ray = {origin, direction};
    ray.is_view = true;
    Arrival arrival = {first};
    const double limit = first ? first->distance : kMiss;
    arrival.light = lights_.first_sphere(ray.origin, direction, limit).sphere;

    Color sum = Color::Zero(), throughput = Color::Ones();
    // Scatterings since the first surface that is not specular, with that one's. What such a
    // surface gets from a light or from what glows is direct; light of longer ways is not.
    int since_diffuse = 0;
    const auto add = [&](const Color& light, bool is_indirect) {
        sum += is_indirect ? clamped(throughput * light, picture_.settings.clamp_indirect)
                           : Color(throughput * light);
    };
    for (int scattered = 0;; ++scattered) {
        if (!arrival.surface || arrival.light != LightSet::kNone) {
            add(light_seen(ray, arrival), since_diffuse > 1);
            return sum;
        }
        const Surface& surface = *arrival.surface;
        const Vec4 out = -ray.direction;
        const bool goes_on = is_specular(*surface.material) || !is_direct;
        if (!goes_on && scattered <= picture_.settings.bounces)
            return sum + throughput * shading_.radiance(surface, out, stats);
        add(surface.material->emission, since_diffuse > 1);
        if (scattered > picture_.settings.bounces) return sum;

        const std::uint32_t group = groups * static_cast<std::uint32_t>(scattered);
        const auto u = sampler.group(group);
        if (is_specular(*surface.material)) {
            throughput *= scatter_specular(ray, arrival, u[0]);
            if (since_diffuse > 0) ++since_diffuse;
        } else {
            const Bsdf bsdf(surface, out);
            // Glass lets no straight ray to a light pass.
            const bool is_free = ray.medium == GlassBodies::kNone;
            if (is_free) {
                const Color light =
                    light_of_points(surface, bsdf, stats) +
                    light_of_spheres_and_suns(surface, bsdf, sampler, group + 1, stats);
                add(light, since_diffuse > 0);
            }
            const Bsdf::Sample next = bsdf.sample({u[0], u[1], u[2]});
            throughput *= next.weight;
            ray = {surface.point, next.in, surface.body, ray.medium, is_free ? next.density : 0};
            ++since_diffuse;
        }

        // Inside glass radiance is up to index^3 as high: what counts is what gets out.
        const double index = glass_.refractive_index(ray.medium);
        const double most = throughput.maxCoeff() * index * index * index;
        if (!(most > 0)) return sum;
        if (scattered >= kRouletteFrom) {
            const double survival = std::min(kSurvival, most);
            if (u[3] >= survival) return sum;
            throughput /= survival;
        }
        arrival = arrive(ray, stats);
    }
}

LightTransport::Arrival LightTransport::arrive(const Ray& ray, FrameStats& stats) const {
    ++stats.bounce_rays;
    GlassBodies::Event event;
    if (ray.medium == GlassBodies::kNone)
        event.hit = scene_->nearest(ray.origin, ray.direction, kMiss, ray.on, stats);
    else
        event = glass_.next(ray.medium, ray.origin, ray.direction, ray.on, stats);
    Arrival arrival;
    arrival.light = lights_.first_sphere(ray.origin, ray.direction, event.hit.distance).sphere;
    arrival.is_exit = event.is_exit;
    if (event.hit) arrival.surface = shading_.surface(event.hit, ray.origin, ray.direction);
    return arrival;
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
