// SPDX-License-Identifier: Apache-2.0
#include "render/picture_needs.hpp"

#include <algorithm>

#include "render/light/lamps.hpp"
#include "render/material/bsdf.hpp"

namespace tesserae::render {
namespace {

/// With one sample the only ray goes through the centre.
bool has_centre_rays(const Settings& settings) {
    const Channels& c = settings.channels;
    return settings.most_samples() > 1 &&
           (c.depth || c.normal || c.position || c.id || c.motion || c.zplanar || c.normal3);
}

}  // namespace

PictureNeeds needs_of(const Picture& picture) {
    const Settings& settings = picture.settings;
    const CameraDescription& camera = picture.camera;
    const auto any_visible = [&](bool specular) {
        return std::any_of(picture.appearance.begin(), picture.appearance.end(), [&](auto& a) {
            return a.visible && is_specular(picture.materials[a.material]) == specular;
        });
    };
    PictureNeeds needs = {};
    const LightSet lights(picture.lights, camera.position);
    const bool is_path = settings.integrator == Integrator::kPath;
    const std::size_t glowing = is_path ? count_glowing(picture) : 0;
    needs.shadow_rays = (!lights.is_empty() || glowing > 0) && any_visible(false);
    needs.lamp_choice =
        is_path && any_visible(false) && lights.spheres.size() + glowing > Lamps::kEach;
    needs.specular_rays = any_visible(true);
    needs.bounce_rays = needs.specular_rays || (is_path && any_visible(false));
    needs.centre_rays = has_centre_rays(settings);
    needs.more_samples = settings.noise_target > 0;
    needs.lens = camera.aperture > 0;
    needs.slices = camera.slices > 1;
    needs.thick_slice = camera.slice_thickness > 0 && !needs.slices;
    needs.ghosts = settings.has_ghosts();
    needs.moving = !picture.path.empty();
    // Of one sample only what follows the view ray is random.
    const bool anything =
        any_visible(true) || any_visible(false) || !picture.lights.spheres.empty();
    const bool is_random = needs.bounce_rays || (settings.most_samples() > 1 && anything);
    needs.moving_noise = is_random && !settings.lock_noise;
    return needs;
}

int most_view_rays(const Settings& settings) {
    return settings.most_samples() + (has_centre_rays(settings) ? 1 : 0);
}

}  // namespace tesserae::render
