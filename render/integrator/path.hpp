#pragma once

#include "render/integrator/light_paths.hpp"
#include "render/material/bsdf.hpp"

namespace tesserae::render {

/// All light, with noise that falls with the number of samples. Every surface that is no mirror or
/// glass adds what a random point of every light brings there, and sends the path on in a random
/// direction of its own choice. Lights that both choices can find (sphere lights, suns with an
/// angle) are counted with weights that add up to 1 (power heuristic; Veach 1997, section 9.2); the
/// sky, emission and whatever is seen in mirrors and through glass is found by the ray alone, point
/// lights and hard suns by the lights' choice alone. So the mean over samples is exact, but for the
/// light of points and hard suns by way of mirrors and glass, which no ray finds.
/// Its reference chooses no lights: path_reference() of tests/render/integrator/path_test.cpp.
class PathIntegrator : public LightIntegrator {
  public:
    PathIntegrator(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
                   const LightSet& lights, const Shading& shading)
        : settings_(picture.settings),
          lights_(lights),
          paths_(picture, placed, tree, lights, shading) {}

    void radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                  FrameStats& stats) const override;

  private:
    /// Adds what comes from where a path has arrived after so many scatterings, and sends it on.
    /// False where it ends.
    bool scatter(LightPath& path, int scattered, FrameStats& stats) const;
    /// Adds light that comes to where a path has arrived; indirect light is clamped.
    void add(LightPath& path, const Color& light, bool is_indirect) const;

    Color light_of_points(const Surface& surface, const Bsdf& bsdf, FrameStats& stats) const;
    /// @param group   of the sampler's numbers: the first of one for each light
    Color light_of_spheres_and_suns(const Surface& surface, const Bsdf& bsdf,
                                    const Sampler& sampler, std::uint32_t group,
                                    FrameStats& stats) const;
    /// Whether light comes along a ray toward it.
    bool is_lit(const Ray& ray, FrameStats& stats) const;

    const Settings& settings_;
    const LightSet& lights_;
    LightPaths paths_;
};

}  // namespace tesserae::render
