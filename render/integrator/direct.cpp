// SPDX-License-Identifier: Apache-2.0
#include "render/integrator/integrator.hpp"

namespace tesserae::render {

void DirectIntegrator::radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                                PathWave& wave, FrameStats& stats) const {
    wave.paths.clear();
    wave.live.clear();
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
        const Surface* first = samples[i].first;
        // The usual view ray ends where it is: a path of it would only take time.
        if (!lights_.spheres.empty() || (first && is_specular(*first->material)))
            begin(wave, samples[i], i);
        else
            colors[i] =
                first ? shading_.radiance(*first, -samples[i].ray.direction, stats) : sky_seen();
    }
    for (int scattered = 0; !wave.live.empty(); ++scattered) {
        std::erase_if(wave.live,
                      [&](std::uint32_t i) { return !scatter(wave.paths[i], scattered, stats); });
        trace(wave, stats);
    }
    for (const LightPath& path : wave.paths) colors[path.sample] = path.sum;
    // All that it makes counts as direct.
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (samples[i].direct) *samples[i].direct = colors[i];
}

/// Adds what comes from where a path has arrived after so many scatterings, and sends it on. False
/// where it ends.
bool DirectIntegrator::scatter(LightPath& path, int scattered, FrameStats& stats) const {
    if (!path.meets_surface()) {
        path.sum += path.throughput * light_seen(path, 0);
        return false;
    }
    const Surface& surface = *path.surface;
    if (!is_specular(*surface.material)) {
        path.sum += path.throughput * shading_.radiance(surface, -path.ray.direction, stats);
        return false;
    }
    path.sum += path.throughput * surface.material->emission;
    if (is_cut(path, stats)) return false;

    const auto u = path.sampler.group(first_group(scattered, lights_.spheres.size()));
    scatter_specular(path, u[0]);
    return survives(path, scattered, u[3]);
}

}  // namespace tesserae::render
