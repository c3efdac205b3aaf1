#include <algorithm>
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

}  // namespace

PathIntegrator::PathIntegrator(const Picture& picture, const PlacedBodies& placed,
                               const BodyTree& tree, const LightSet& lights, const Shading& shading)
    : LightIntegrator(picture, placed, tree, lights, shading),
      placed_(placed),
      lamps_(lights, picture, placed) {}

void PathIntegrator::radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                              FrameStats& stats) const {
    PathWave wave;
    for (std::uint32_t i = 0; i < samples.size(); ++i) begin(wave, samples[i], i);
    for (int scattered = 0; !wave.live.empty(); ++scattered) {
        std::erase_if(wave.live,
                      [&](std::uint32_t i) { return !scatter(wave.paths[i], scattered, stats); });
        trace(wave, stats);
    }
    for (const LightPath& path : wave.paths) colors[path.sample] = path.sum;
}

/// Adds what comes from where a path has arrived after so many scatterings, and sends it on. False
/// where it ends.
bool PathIntegrator::scatter(LightPath& path, int scattered, FrameStats& stats) const {
    if (!path.meets_surface()) {
        add(path, light_seen(path, lamp_density(path)), path.since_rough > 1);
        return false;
    }
    const Surface& surface = *path.surface;
    const double weight = power_weight(path.density, lamp_density(path));
    add(path, weight * surface.material->emission, path.since_rough > 1);
    if (scattered > settings_.bounces) return false;

    const std::uint32_t group = first_group(scattered, lamps_.asked());
    const auto u = path.sampler.group(group);
    if (is_specular(*surface.material)) {
        scatter_specular(path, u[0]);
        if (path.since_rough > 0) ++path.since_rough;
    } else {
        const Bsdf bsdf(surface, -path.ray.direction);
        // Glass lets no straight ray to a light pass: the path's own finds the light.
        if (!path.is_in_glass())
            add(path,
                light_of_points(surface, bsdf, stats) +
                    light_of_suns_and_lamps(surface, bsdf, path.sampler, group + 1, stats),
                path.since_rough > 0);
        const Bsdf::Sample next = bsdf.sample({u[0], u[1], u[2]});
        path.throughput *= next.weight;
        leave(path, next.in, path.is_in_glass() ? 0 : next.density);
        ++path.since_rough;
    }
    return survives(path, scattered, u[3]);
}

void PathIntegrator::add(LightPath& path, const Color& light, bool is_indirect) const {
    const Color seen = path.throughput * light;
    path.sum += is_indirect ? clamped(seen, settings_.clamp_indirect) : seen;
    if (path.direct && !is_indirect) *path.direct += seen;
}

Color PathIntegrator::light_of_points(const Surface& s, const Bsdf& bsdf, FrameStats& stats) const {
    Color sum = Color::Zero();
    const auto add_light = [&](const LightDisc& disc, const Color& irradiance) {
        if (!(irradiance > 0).any()) return;
        const Ray ray = {s.point, disc.toward, s.body, disc.limit, s.time};
        if (lights_.first_sphere(ray).sphere == LightSet::kNone && is_lit(ray, stats))
            sum += bsdf.value(disc.toward) * irradiance;
    };
    for (const PointLight& point : lights_.points) {
        const LightAt light = LightSet::at(point, s.point, s.normal);
        add_light(light.disc, light.irradiance);
    }
    for (const SunDisc& sun : lights_.suns)
        if (sun.angle == 0) add_light(sun, s.normal.dot(sun.toward) * sun.irradiance);
    return sum;
}

Color PathIntegrator::light_of_suns_and_lamps(const Surface& s, const Bsdf& bsdf,
                                              const Sampler& sampler, std::uint32_t group,
                                              FrameStats& stats) const {
    Color sum = Color::Zero();
    for (const SunDisc& sun : lights_.suns) {
        const auto u = sampler.group(group++);
        sum += light_of_disc(s, bsdf, sun, sun.radiance, LightSet::kNone, 1, {u[0], u[1], u[2]},
                             stats);
    }
    for (std::uint32_t k = 0; k < lamps_.asked(); ++k) {
        const auto u = sampler.group(group++);
        const auto choice = lamps_.choose(k, s.point, s.normal, u[3]);
        if (!choice) continue;
        const Lamp& lamp = lamps_[choice->lamp];
        const Uniform3 place = {u[0], u[1], u[2]};
        sum +=
            lamp.sphere == LightSet::kNone
                ? light_of_body(s, bsdf, lamp, choice->chance, place, stats)
                : light_of_disc(s, bsdf,
                                LightSet::at(lights_.spheres[lamp.sphere], s.point, s.normal).disc,
                                lamp.radiance, lamp.sphere, choice->chance, place, stats);
    }
    return sum;
}

Color PathIntegrator::light_of_disc(const Surface& s, const Bsdf& bsdf, const LightDisc& disc,
                                    const Color& radiance, std::uint32_t source, double chance,
                                    const Uniform3& u, FrameStats& stats) const {
    if (disc.angle == 0) return Color::Zero();
    const Vec4 in = TangentFrame(disc.toward).to_world(cap_direction(disc.angle, u));
    const double cosine = s.normal.dot(in);
    if (!(cosine > 0)) return Color::Zero();
    // A nearer light may stand before this one.
    Ray ray = {s.point, in, s.body, kMiss, s.time};
    const LightSet::Seen seen = lights_.first_sphere(ray);
    ray.limit = seen.distance;
    if (seen.sphere != source || !is_lit(ray, stats)) return Color::Zero();
    const double angle = cap_solid_angle(disc.angle) / chance;
    const double weight = power_weight(1 / angle, bsdf.density(in));
    return bsdf.value(in) * radiance * (cosine * angle * weight);
}

Color PathIntegrator::light_of_body(const Surface& s, const Bsdf& bsdf, const Lamp& lamp,
                                    double chance, const Uniform3& u, FrameStats& stats) const {
    if (s.body == lamp.body) return Color::Zero();
    const PlacedBody& body = placed_.bodies[lamp.body];
    const auto toward = sample_toward(*body.shape, placed_.point_to_body(body, s.point, s.time), u);
    if (!toward) return Color::Zero();
    Ray ray = {s.point, placed_.direction_to_world(body, toward->direction, s.time), s.body,
               settings_.ray_limit(), s.time};
    const double cosine = s.normal.dot(ray.direction);
    if (!(cosine > 0)) return Color::Zero();
    const double distance = hit_distance(placed_, lamp.body, ray, settings_, stats);
    // Up to the body, not including it.
    ray.limit = std::nextafter(distance, 0.0);
    if (distance == kMiss || lights_.first_sphere(ray).sphere != LightSet::kNone ||
        !is_lit(ray, stats))
        return Color::Zero();
    const double density = chance * toward->density;
    const double weight = power_weight(density, bsdf.density(ray.direction));
    return bsdf.value(ray.direction) * lamp.radiance * (cosine / density * weight);
}

double PathIntegrator::lamp_density(const LightPath& path) const {
    if (!(path.density > 0)) return 0;
    const Vec4& origin = path.ray.origin;
    if (path.light != LightSet::kNone) {
        const SphereLight& light = lights_.spheres[path.light];
        const double angle = LightSet::at(light, origin, path.ray.direction).disc.angle;
        if (angle == 0) return 0;
        return lamps_.chance_of(lamps_.of_sphere(path.light), origin, path.normal) /
               cap_solid_angle(angle);
    }
    const std::uint32_t lamp = path.surface ? lamps_.of_body(path.surface->body) : Lamps::kNone;
    if (lamp == Lamps::kNone) return 0;
    const PlacedBody& body = placed_.bodies[path.surface->body];
    return lamps_.chance_of(lamp, origin, path.normal) *
           density_toward(*body.shape, placed_.point_to_body(body, origin, path.ray.time),
                          placed_.direction_to_body(body, path.ray.direction, path.ray.time));
}

bool PathIntegrator::is_lit(const Ray& toward_light, FrameStats& stats) const {
    ++stats.shadow_rays;
    Ray ray = toward_light;
    ray.limit = std::min(ray.limit, settings_.ray_limit());
    return !scene_->is_blocked(ray, stats);
}

}  // namespace tesserae::render
