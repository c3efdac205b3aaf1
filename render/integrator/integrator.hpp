#pragma once

#include <memory>
#include <span>

#include "render/light/light_set.hpp"
#include "render/ray_scene.hpp"
#include "render/sampler.hpp"
#include "render/shading.hpp"

namespace tesserae::render {

/// A sample's view ray and the rest that decides what comes along it.
struct ViewSample {
    const Surface* first;  ///< what the ray meets; null if nothing
    Ray ray;
    Sampler sampler;  ///< of the sample; its groups are used from 0 on
};

/// The radiance along view rays. A ray is followed from surface to surface: mirrors and glass send
/// it on, up to `bounces` times; what comes from other surfaces is what DirectIntegrator and
/// PathIntegrator differ in. `bounces` = 0 is emitted and direct light: at most bounces + 1
/// surfaces scatter a path. Sphere lights are seen by every ray and end it, in front of what lies
/// behind them; suns with an angle are seen by all but view rays.
class LightIntegrator {
  public:
    virtual ~LightIntegrator() = default;

    /// @param colors   as many as samples
    virtual void radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                          FrameStats& stats) const = 0;
};

/// The one that settings.integrator names. All must outlive it.
/// @param tree   of the bodies; it is not asked unless needs_rays()
std::unique_ptr<const LightIntegrator> make_integrator(const Picture& picture,
                                                       const PlacedBodies& placed,
                                                       const BodyTree& tree, const LightSet& lights,
                                                       const Shading& shading);

/// Whether the picture's integrator traces any rays but view rays and those of Shading's shadows.
bool needs_rays(const Picture& picture);

}  // namespace tesserae::render
