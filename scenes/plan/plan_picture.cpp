// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/plan_picture.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.hpp"
#include "render/camera/camera.hpp"
#include "render/file/preview.hpp"
#include "render/light/lamps.hpp"
#include "render/material/bsdf.hpp"
#include "render/picture_needs.hpp"
#include "render/scene/glass_bodies.hpp"
#include "render/scene/slice.hpp"
#include "render/tile/frame_scene.hpp"
#include "scenes/load/picture_keys.hpp"

namespace tesserae::scenes {
namespace {

render::Picture picture_of(const Scene& scene, const render::CameraDescription& camera) {
    return {scene.bodies, scene.appearance, scene.materials, camera, scene.lights, scene.render};
}

/// Those that shine, but for the sky.
std::string light_counts(const Scene& scene) {
    const render::LightSet shining(scene.lights, Vec4::Zero());
    std::string text;
    const auto add = [&](std::size_t count, const char* name) {
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
    };
    add(shining.suns.size(), "sun(s)");
    add(shining.points.size(), "point light(s)");
    add(shining.spheres.size(), "sphere light(s)");
    if (scene.render.integrator == render::Integrator::kPath)
        add(render::count_glowing(picture_of(scene, scene.camera)), "glowing bodies");
    return text;
}

void decide_light(const Scene& scene, const render::PictureNeeds& needs, Plan& plan) {
    const bool is_path = scene.render.integrator == render::Integrator::kPath;
    const std::string counts = light_counts(scene);
    const char* dark = is_path ? "no light but the sky, which bounced rays find"
                               : "no light but the sky, which is taken unoccluded";
    plan.decide("shadow rays", needs.shadow_rays, counts,
                counts.empty() ? dark : "lights shine on nothing visible but mirrors and glass");
    plan.decide("global illumination", is_path,
                fmt::format("integrator = \"path\": emitted and direct light and {} bounce(s)",
                            scene.render.bounces),
                "integrator = \"direct\"");
    const auto reflects = count_if_type(scene.bodies, [&](auto t) {
        const render::Appearance& a = scene.appearance[t];
        return a.visible && render::is_specular(scene.materials[a.material]);
    });
    plan.decide("reflected and refracted rays", needs.specular_rays,
                fmt::format("{} bodies of mirror or glass, up to {} of their surfaces a path",
                            reflects, scene.render.specular_bounces),
                "nothing is a mirror or glass");
    if (is_path) {
        plan.decide("choice of lamps", needs.lamp_choice,
                    "of the sphere lights and glowing bodies a surface asks one for light",
                    fmt::format("at most {} sphere lights and glowing bodies: each is asked",
                                render::Lamps::kEach));
        const double most = scene.render.clamp_indirect;
        plan.decide("clamped indirect light", most > 0,
                    fmt::format("clamp_indirect = {}: brighter indirect light is lost", most),
                    "clamp_indirect = 0: all light counts");
    }
}

/// How the camera moves.
std::string text_of_motion(const Scene& scene) {
    const CameraMotion& motion = scene.camera_motion;
    std::string text = fmt::format("{} keys", scene.camera_keys.size());
    if (motion.closed) text += " that go on round";
    if (!scene.follows()) return text;
    text = scene.camera_keys.empty() ? "" : text + ", and ";
    text += fmt::format("it follows \"{}\"", motion.follow);
    if (motion.follow_lag > 0)
        text += fmt::format(" by its mean way over {} s: frames before are needed too, {} of them",
                            motion.follow_lag,
                            std::ceil(motion.follow_lag * scene.render.frames_per_second));
    return text;
}

void decide_camera(const Scene& scene, const render::PictureNeeds& needs, Plan& plan) {
    const render::CameraDescription& c = scene.camera;
    const bool is_moving = scene.has_moving_camera();
    const int samples = scene.render.least_samples(), most = scene.render.most_samples();
    plan.decide("lens", needs.lens, fmt::format("aperture = {}", c.aperture),
                "aperture = 0: a pinhole");
    plan.decide(
        "motion blur", c.shutter > 0 && (plan.moves || is_moving),
        fmt::format(
            "shutter = {}: every sample has a time of its own; where something moves, up to {} "
            "intervals with trees of their own",
            c.shutter, render::most_intervals(plan.bodies)),
        c.shutter > 0 ? "nothing moves" : "shutter = 0");
    if (needs.slices)
        plan.decide("several slices", true,
                    fmt::format("{} side by side over {} m", c.slices, c.slice_thickness));
    else
        plan.decide("thick slice", needs.thick_slice,
                    fmt::format("averaged over {} m", c.slice_thickness), "slice_thickness = 0");
    plan.decide(
        "ghosts", needs.ghosts,
        fmt::format("ghost_depth = {}: bodies beside the slice are drawn {}",
                    scene.render.ghost_depth,
                    scene.render.ghosts == render::GhostsIn::kOver ? "over previews and films"
                                                                   : "in layer ghost"),
        "ghost_depth = 0");
    plan.decide("moving camera", is_moving, text_of_motion(scene), "no [[camera.key]]");
    plan.decide("moving noise", needs.moving_noise, "every frame has random numbers of its own",
                scene.render.lock_noise ? "lock_noise = true: every frame has those of frame 0"
                                        : "nothing in the picture is random");
    plan.decide(
        "distance limit", scene.render.max_distance > 0,
        fmt::format("max_distance = {}: no ray meets a body farther on", scene.render.max_distance),
        "max_distance = 0: rays go on for ever");
    plan.decide("noise target", needs.more_samples,
                fmt::format("{} to {} samples a pixel", samples, most),
                fmt::format("every pixel has {} samples", samples));
}

}  // namespace

void decide_picture(const Scene& scene, Plan& plan) {
    const auto visible =
        count_if_type(scene.bodies, [&](auto t) { return scene.appearance[t].visible; });
    if (visible < plan.bodies)
        plan.decide("invisible bodies in the picture", false, "",
                    fmt::format("{} bodies have visible = false", plan.bodies - visible));
    const render::PictureNeeds needs = render::needs_of(picture_of(scene, scene.camera));
    decide_camera(scene, needs, plan);
    decide_light(scene, needs, plan);
    const auto varied =
        std::count_if(scene.materials.begin(), scene.materials.end(),
                      [](const render::Material& m) { return m.albedo_variation > 0; });
    plan.decide("colour variation", varied > 0,
                fmt::format("{} material(s) differ a little from body to body", varied),
                "albedo_variation = 0 of all materials");
    const render::Crop window = scene.render.window();
    const render::PreviewSize preview = render::preview_size_of(scene.render, window);
    plan.decide(
        "smaller previews", preview.width < window.x1 - window.x0,
        fmt::format("preview_size: {}x{}, pixels averaged by area", preview.width, preview.height),
        "previews have the picture's size");
    plan.decide("transparent sky", scene.render.sky == render::Sky::kTransparent,
                "view rays that meet nothing bring no light", "sky = \"opaque\"");
    plan.decide("overlay", !scene.overlay.is_empty(),
                "text is drawn over previews and films, not into images", "nothing in [overlay]");
    for (const auto& [name, member] : kChannels)
        if (!(scene.render.channels.*member))
            plan.decide(fmt::format("channel {}", name), false, "", "not in channels");
}

void warn_of_hidden_glass(const Scene& scene, Plan& plan) {
    const bool any_glass = std::any_of(
        scene.materials.begin(), scene.materials.end(),
        [](const render::Material& m) { return m.kind == render::MaterialKind::kGlass; });
    if (!any_glass) return;
    const render::Picture picture = picture_of(scene, scene.camera);
    const render::PlacedBodies placed = render::place_bodies(picture, Vec4::Zero());
    const render::GlassBodies glass(picture, placed);
    const auto name_at = [&](BodyId id) {
        return std::prev(std::upper_bound(scene.names.begin(), scene.names.end(), id,
                                          [](BodyId i, const auto& run) { return i < run.first; }));
    };
    // One line for a [[body]] or [[lattice]], whatever the number of its bodies.
    const NamedBodies* last = nullptr;
    for (std::uint32_t i = 0; i < placed.bodies.size(); ++i) {
        const std::uint32_t outer = glass.hidden_in(i);
        if (outer == render::GlassBodies::kNone) continue;
        const NamedBodies* inner = &*name_at(placed.bodies[i].id);
        if (inner == last) continue;
        last = inner;
        plan.warnings.push_back(
            fmt::format("{}\"{}\" lies wholly inside the glass \"{}\", which is declared later and "
                        "rules there: it is not seen",
                        inner->count > 1 ? "a body of " : "", inner->name,
                        name_at(placed.bodies[outer].id)->name));
    }
}

void count_off_slice(const Scene& scene, Plan& plan) {
    const auto visible =
        count_if_type(scene.bodies, [&](auto t) { return scene.appearance[t].visible; });
    const render::CameraDescription camera = scene.camera_path().at(0);
    const double half = 0.5 * camera.slice_thickness;
    const render::Picture picture = picture_of(scene, camera);
    const render::Camera frame(camera, scene.render.width, scene.render.height);
    const auto seen = render::slice_bounds(render::place_bodies(picture, frame.origin()), frame,
                                           scene.render.ray_limit(), {-half, half})
                          .size();
    plan.decide("bodies off the slice", false, "",
                fmt::format("{} of {} visible bodies of frame 0 are met by no view ray, only by "
                            "shadows and reflections",
                            visible - seen, visible));
}

}  // namespace tesserae::scenes
