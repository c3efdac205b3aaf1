#pragma once

#include "render/integrator/light_paths.hpp"

namespace tesserae::render {

/// Direct light without noise: the first surface that is no mirror or glass ends a path, with
/// Shading's closed forms.
class DirectIntegrator : public LightIntegrator {
  public:
    DirectIntegrator(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
                     const LightSet& lights, const Shading& shading)
        : settings_(picture.settings),
          lights_(lights),
          shading_(shading),
          paths_(picture, placed, tree, lights, shading) {}

    void radiance(std::span<const ViewSample> samples, std::span<Color> colors,
                  FrameStats& stats) const override;

  private:
    /// Adds what comes from where a path has arrived after so many scatterings, and sends it on.
    /// False where it ends.
    bool scatter(LightPath& path, int scattered, FrameStats& stats) const;

    const Settings& settings_;
    const LightSet& lights_;
    const Shading& shading_;
    LightPaths paths_;
};

}  // namespace tesserae::render
