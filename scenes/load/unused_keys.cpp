// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "render/picture_needs.hpp"
#include "scenes/load/load_parts.hpp"

namespace tesserae::scenes {
namespace {

/// Remarks on the keys of one table.
class Unused {
  public:
    Unused(TableReader& reader, std::vector<std::string>& lines) : reader_(reader), lines_(lines) {}

    void operator()(bool is_unused, const char* key, const char* why) {
        if (!is_unused) return;
        std::string line = reader_.remark(key, fmt::format("changes nothing: {}", why));
        if (!line.empty()) lines_.push_back(std::move(line));
    }

  private:
    TableReader& reader_;
    std::vector<std::string>& lines_;
};

void check_render(Unused unused, const Scene& scene) {
    const render::Settings& s = scene.render;
    const render::PictureNeeds needs = render::needs_of(
        {scene.bodies, scene.appearance, scene.materials, scene.camera, scene.lights, s});
    const bool is_path = s.integrator == render::Integrator::kPath;
    unused(!is_path, "bounces",
           "integrator = \"direct\" follows light by way of mirrors and glass only, see "
           "specular_bounces");
    unused(!needs.specular_rays, "specular_bounces", "nothing that is seen is a mirror or glass");
    unused(!is_path, "clamp_indirect", "integrator = \"direct\" has no indirect light");
    unused(s.noise_target == 0, "max_samples", "noise_target = 0: every pixel has `samples`");
    unused(s.intersector == render::Intersector::kAnalytic, "max_steps",
           "intersector = \"analytic\" takes no steps");
    render::Settings unlocked = s;
    unlocked.lock_noise = false;
    const bool is_random = render::needs_of({scene.bodies, scene.appearance, scene.materials,
                                             scene.camera, scene.lights, unlocked})
                               .moving_noise;
    unused(!is_random, "seed", "nothing in the picture is random");
    unused(!is_random, "lock_noise", "nothing in the picture is random");
    unused(!scene.physics && scene.camera.shutter == 0 && !s.channels.motion, "frames_per_second",
           "a still: without [physics] there is one frame");
    for (const char* key : {"ghosts", "ghost_minus", "ghost_plus"})
        unused(!s.has_ghosts(), key, "ghost_depth = 0: no ghosts are drawn");
    const bool one = s.most_samples() == 1;
    unused(one, "filter", "one sample, which is at the pixel's centre");
    unused(one, "filter_width", "one sample, which is at the pixel's centre");
}

/// Why a body never moves; null: it may.
const char* why_at_rest(const Scene& scene, BodyId body) {
    const BodyType& type = scene.bodies.type_of(body);
    if (!scene.physics) return "a still: without [physics] nothing moves";
    if (!is_bounded(type.shape)) return "the body is a hyperplane, which never moves";
    if (type.fixed_position && scene.bodies.velocity[body].isZero(0))
        return "the body is fixed in its position and has no velocity";
    return nullptr;
}

void check_joint(Unused unused, const Scene& scene, std::size_t number) {
    unused(!scene.physics, "type", "a still: without [physics] nothing moves");
    const Joint& joint = scene.joints[number];
    unused(joint.a == kWorld && joint.collide, "collide", "there is no b");
}

void check_follow(Unused unused, const Scene& scene) {
    const CameraMotion& motion = scene.camera_motion;
    unused(!motion.followed, "follow_axes", "there is no follow");
    unused(!motion.followed, "follow_lag", "there is no follow");
    if (!motion.followed) return;
    const char* const why = why_at_rest(scene, *motion.followed);
    unused(why != nullptr, "follow", why);
}

void check_material(Unused unused, const render::Material& m) {
    using Kind = render::MaterialKind;
    unused(m.kind != Kind::kGlass, "ior", "kind is not \"glass\"");
    unused(m.kind != Kind::kRough, "roughness", "kind is not \"rough\"");
    using render::Pattern;
    const bool is_plain = m.pattern == Pattern::kNone;
    const bool has_lines = m.pattern == Pattern::kGrid || m.pattern == Pattern::kEdges;
    const char* plain = "the material has no pattern";
    unused(is_plain, "pattern_albedo", plain);
    unused(m.pattern == Pattern::kCells || m.pattern == Pattern::kW, "pattern_albedo",
           "the pattern makes its own colours");
    unused(is_plain, "pattern_size", plain);
    unused(m.pattern == Pattern::kCells || m.pattern == Pattern::kEdges, "pattern_size",
           "the pattern is as large as the body");
    unused(!has_lines, "line_width", "pattern is not \"grid\" or \"edges\"");
    unused(m.pattern != Pattern::kW, "w_of", "pattern is not \"w\"");
}

}  // namespace

void find_unused_keys(TableReader& root, const Origin& origin, Scene& scene) {
    std::vector<std::string>& lines = scene.unused;
    const auto tables = root.tables("material");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        TableReader reader(*tables[i], origin, fmt::format("material {}", i));
        // The first is the default's.
        check_material({reader, lines}, scene.materials[i + 1]);
    }
    const auto lattices = root.tables("lattice");
    for (std::size_t i = 0; i < lattices.size(); ++i) {
        TableReader reader(*lattices[i], origin, fmt::format("lattice {}", i));
        double jitter = 0;
        reader.read("jitter", jitter, Rule::kNonNegative);
        Unused(reader, lines)(jitter == 0, "seed", "jitter = 0: nothing of it is random");
    }
    const auto joints = root.tables("joint");
    for (std::size_t i = 0; i < joints.size(); ++i) {
        TableReader reader(
            *joints[i], origin,
            fmt::format("joint {} {}", i, toml_text(printable(scene.joint_names[i]))));
        check_joint({reader, lines}, scene, i);
    }
    if (const auto* table = root.table("camera")) {
        TableReader reader(*table, origin, "[camera]");
        Unused unused(reader, lines);
        check_follow(unused, scene);
        unused(scene.camera.aperture == 0, "focus_distance", "aperture = 0: all is sharp");
        unused(!scene.physics && scene.camera_keys.empty() && scene.camera.shutter > 0, "shutter",
               "a still without [physics] and [[camera.key]]: nothing moves");
    }
    if (const auto* table = root.table("overlay")) {
        TableReader reader(*table, origin, "[overlay]");
        Unused unused(reader, lines);
        const bool turns = std::any_of(scene.camera_keys.begin(), scene.camera_keys.end(),
                                       [](const CameraKey& key) { return key.fourth.has_value(); });
        unused(scene.overlay.dial && !turns, "dial", "no [[camera.key]] turns the slice");
        for (const char* key : {"text_size", "color", "font"})
            unused(scene.overlay.is_empty(), key, "the overlay shows nothing");
    }
    if (const auto* table = root.table("render")) {
        TableReader reader(*table, origin, "[render]");
        check_render({reader, lines}, scene);
    }
}

}  // namespace tesserae::scenes
