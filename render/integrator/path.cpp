#include "render/integrator/integrator.hpp"
#include "render/sampling/cap.hpp"

namespace tesserae::render {
namespace {

/// No brighter than `most`; of the same hue. 0: as it is.
Color clamped(const Color& light, double most) {
    const double brightest = light.maxCoeff();
    return most > 0 && brightest > most ? Color(light * (most / brightest)) : light;
}

}  // namespace

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
        add(path, light_seen(path), path.since_rough > 1);
        return false;
    }
    const Surface& surface = *path.surface;
    add(path, surface.material->emission, path.since_rough > 1);
    if (scattered > settings_.bounces) return false;

    const std::uint32_t group = first_group(scattered);
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
                    light_of_spheres_and_suns(surface, bsdf, path.sampler, group + 1, stats),
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
}

Color PathIntegrator::light_of_points(const Surface& s, const Bsdf& bsdf, FrameStats& stats) const {
    Color sum = Color::Zero();
    const auto add_light = [&](const LightDisc& disc, const Color& irradiance) {
        if (!(irradiance > 0).any()) return;
        const Ray ray = {s.point, disc.toward, s.body, disc.limit};
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

Color PathIntegrator::light_of_spheres_and_suns(const Surface& s, const Bsdf& bsdf,
                                                const Sampler& sampler, std::uint32_t group,
                                                FrameStats& stats) const {
    Color sum = Color::Zero();
    const auto add_light = [&](const LightDisc& disc, const Color& radiance, std::uint32_t sphere) {
        const auto u = sampler.group(group++);
        if (disc.angle == 0) return;
        const Vec4 in =
            TangentFrame(disc.toward).to_world(cap_direction(disc.angle, {u[0], u[1], u[2]}));
        const double cosine = s.normal.dot(in);
        if (!(cosine > 0)) return;
        // A nearer light may stand before this one.
        Ray ray = {s.point, in, s.body};
        const LightSet::Seen seen = lights_.first_sphere(ray);
        ray.limit = seen.distance;
        if (seen.sphere != sphere || !is_lit(ray, stats)) return;
        const double angle = cap_solid_angle(disc.angle);
        const double weight = power_weight(1 / angle, bsdf.density(in));
        sum += bsdf.value(in) * radiance * (cosine * angle * weight);
    };
    for (const SunDisc& sun : lights_.suns) add_light(sun, sun.radiance, LightSet::kNone);
    for (std::uint32_t i = 0; i < lights_.spheres.size(); ++i)
        add_light(LightSet::at(lights_.spheres[i], s.point, s.normal).disc,
                  lights_.spheres[i].radiance, i);
    return sum;
}

bool PathIntegrator::is_lit(const Ray& toward_light, FrameStats& stats) const {
    ++stats.shadow_rays;
    return !scene_->is_blocked(toward_light, stats);
}

}  // namespace tesserae::render
