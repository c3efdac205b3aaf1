#include "scenes/plan/plan_picture.hpp"

#include "core/error.hpp"
#include "render/camera/camera.hpp"
#include "render/material/bsdf.hpp"
#include "render/scene/frame_scene.hpp"
#include "render/scene/slice.hpp"

namespace tesserae::scenes {
namespace {

std::string light_counts(const render::Lights& lights) {
    std::string text;
    const auto add = [&](std::size_t count, const char* name) {
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
    };
    add(lights.suns.size(), "sun(s)");
    add(lights.points.size(), "point light(s)");
    add(lights.spheres.size(), "sphere light(s)");
    return text;
}

/// @param visible   how many bodies are
void decide_light(const Scene& scene, std::uint64_t visible, Plan& plan) {
    const render::Lights& lights = scene.lights;
    const bool is_path = scene.render.integrator == render::Integrator::kPath;
    const std::string counts = light_counts(lights);
    plan.decisions.push_back(
        {"shadow rays", !counts.empty() && visible > 1,
         counts.empty()
             ? (is_path ? "no light but the sky, which bounced rays find"
                        : "no light but the sky, which is taken unoccluded")
             : (visible > 1 ? counts : "nothing is there to cast a shadow on another body")});
    plan.decisions.push_back(
        {"global illumination", is_path,
         is_path ? fmt::format("integrator = \"path\": emitted and direct light and {} bounce(s)",
                               scene.render.bounces)
                 : "integrator = \"direct\""});
    if (is_path) {
        const double most = scene.render.clamp_indirect;
        plan.decisions.push_back(
            {"clamped indirect light", most > 0,
             most > 0 ? fmt::format("clamp_indirect = {}: brighter indirect light is lost", most)
                      : "clamp_indirect = 0: all light counts"});
        return;
    }

    // Diffuse and rough surfaces end a ray of the direct picture.
    const auto reflects = count_if_type(scene.bodies, [&](auto t) {
        const render::Appearance& a = scene.appearance[t];
        return a.visible && render::is_specular(scene.materials[a.material]);
    });
    plan.decisions.push_back({"reflected and refracted rays", reflects > 0,
                              reflects > 0
                                  ? fmt::format("{} bodies of mirror or glass, {} bounce(s)",
                                                reflects, scene.render.bounces)
                                  : "nothing is a mirror or glass"});
}

void decide_camera(const Scene& scene, Plan& plan) {
    const render::CameraDescription& c = scene.camera;
    const auto add = [&](const char* part, bool needed, const std::string& reason) {
        plan.decisions.push_back({part, needed, reason});
    };
    add("lens", c.aperture > 0,
        c.aperture > 0 ? fmt::format("aperture = {}", c.aperture) : "aperture = 0: a pinhole");
    add("motion blur", c.shutter > 0,
        c.shutter > 0 ? fmt::format("shutter = {}: up to {} instants a frame in which something "
                                    "moves",
                                    c.shutter,
                                    render::most_instants(plan.bodies, scene.render.most_samples()))
                      : "shutter = 0");
    if (c.slices > 1)
        add("several slices", true,
            fmt::format("{} side by side over {} m", c.slices, c.slice_thickness));
    else
        add("thick slice", c.slice_thickness > 0,
            c.slice_thickness > 0 ? fmt::format("averaged over {} m", c.slice_thickness)
                                  : "slice_thickness = 0");
    add("moving camera", !scene.camera_keys.empty(),
        scene.camera_keys.empty() ? "no [[camera.key]]"
                                  : fmt::format("{} keys", scene.camera_keys.size()));
    add("noise target", scene.render.noise_target > 0,
        scene.render.noise_target > 0
            ? fmt::format("{} to {} samples a pixel", scene.render.samples,
                          scene.render.most_samples())
            : fmt::format("every pixel has {} samples", scene.render.samples));
}

}  // namespace

void decide_picture(const Scene& scene, Plan& plan) {
    const Bodies& bodies = scene.bodies;
    const auto visible = count_if_type(bodies, [&](auto t) { return scene.appearance[t].visible; });
    if (visible < plan.bodies)
        plan.decisions.push_back(
            {"invisible bodies in the picture", false,
             fmt::format("{} bodies have visible = false", plan.bodies - visible)});
    decide_camera(scene, plan);
    decide_light(scene, visible, plan);
    const render::Channels& c = scene.render.channels;
    const auto channel = [&](bool wanted, const char* name) {
        if (!wanted)
            plan.decisions.push_back({fmt::format("channel {}", name), false, "not in channels"});
    };
    channel(c.color, "color"), channel(c.depth, "depth"), channel(c.normal, "normal");
    channel(c.albedo, "albedo"), channel(c.id, "id"), channel(c.position, "position");
    channel(c.variance, "variance"), channel(c.samples, "samples");
}

void count_off_slice(const Scene& scene, Plan& plan) {
    const auto visible =
        count_if_type(scene.bodies, [&](auto t) { return scene.appearance[t].visible; });
    const render::CameraDescription camera = camera_at(scene.camera, scene.camera_keys, 0);
    const double half = 0.5 * camera.slice_thickness;
    const render::Picture picture = {scene.bodies, scene.appearance, scene.materials,
                                     camera,       scene.lights,     scene.render};
    const render::Camera frame(camera, scene.render.width, scene.render.height);
    const auto seen = render::slice_bounds(render::place_bodies(picture, frame.origin()), frame,
                                           scene.render.max_distance, {-half, half})
                          .size();
    plan.decisions.push_back(
        {"bodies off the slice", false,
         fmt::format("{} of {} visible bodies of frame 0 are met by no view ray, only by shadows "
                     "and reflections",
                     visible - seen, visible)});
}

}  // namespace tesserae::scenes
