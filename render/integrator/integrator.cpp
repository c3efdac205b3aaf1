#include "render/integrator/integrator.hpp"

#include <algorithm>

#include "render/integrator/direct.hpp"
#include "render/integrator/path.hpp"

namespace tesserae::render {

std::unique_ptr<const LightIntegrator> make_integrator(const Picture& picture,
                                                       const PlacedBodies& placed,
                                                       const BodyTree& tree, const LightSet& lights,
                                                       const Shading& shading) {
    if (picture.settings.integrator == Integrator::kPath)
        return std::make_unique<PathIntegrator>(picture, placed, tree, lights, shading);
    return std::make_unique<DirectIntegrator>(picture, placed, tree, lights, shading);
}

bool needs_rays(const Picture& picture) {
    if (picture.settings.integrator == Integrator::kPath) return true;
    return std::any_of(picture.appearance.begin(), picture.appearance.end(),
                       [&](const Appearance& a) {
                           return a.visible && is_specular(picture.materials[a.material]);
                       });
}

}  // namespace tesserae::render
