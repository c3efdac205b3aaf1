#include "render/integrator/direct.hpp"

#include "render/material/bsdf.hpp"

namespace tesserae::render {

void DirectIntegrator::radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                                FrameStats& stats) const {
    PathWave wave;
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
        const Surface* first = samples[i].first;
        // The usual view ray ends where it is: a path of it would only take time.
        if (!lights_.spheres.empty() || (first && is_specular(*first->material)))
            wave.add(paths_.begin(samples[i], i));
        else
            colors[i] =
                first ? shading_.radiance(*first, -samples[i].ray.direction, stats) : lights_.sky;
    }
    for (int scattered = 0; !wave.live.empty(); ++scattered) {
        wave.scatter_each([&](LightPath& path) { return scatter(path, scattered, stats); });
        paths_.trace(wave, stats);
    }
    wave.write_sums(colors);
}

bool DirectIntegrator::scatter(LightPath& path, int scattered, FrameStats& stats) const {
    if (!path.meets_surface()) {
        path.sum += path.throughput * paths_.light_seen(path);
        return false;
    }
    const Surface& surface = *path.surface;
    const bool is_last = scattered > settings_.bounces;
    if (!is_last && !is_specular(*surface.material)) {
        path.sum += path.throughput * shading_.radiance(surface, -path.ray.direction, stats);
        return false;
    }
    path.sum += path.throughput * surface.material->emission;
    if (is_last) return false;

    const auto u = path.sampler.group(paths_.group(scattered));
    paths_.scatter_specular(path, u[0]);
    return paths_.survives(path, scattered, u[3]);
}

}  // namespace tesserae::render
