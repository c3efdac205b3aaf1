// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/load.hpp"

#include "core/dynamics/motion_version.hpp"
#include "core/error.hpp"
#include "scenes/load/body_keys.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/versions.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {

void load_name(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    scene.name = scene.file.stem().string();
    if (const auto* table = root.table("scene")) {
        TableReader reader(*table, origin, "[scene]");
        scene_keys(scene, ReadKeys{reader});
        reader.finish();
    }
    if (!FileName::accepts(scene.name))
        throw InputError(
            fmt::format("{}: the file's stem names the scene: {}; rename it or give "
                        "[scene] a name",
                        origin.place, FileName::kExpected));
    out.table("[scene]");
    scene_keys(scene, WriteKeys{out});
}

void load_physics(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    const auto* table = root.table("physics");
    if (table == nullptr) return;
    TableReader reader(*table, origin, "[physics]");
    physics_keys(scene.physics.emplace(), ReadKeys{reader});
    reader.finish();
    out.table("[physics]");
    physics_keys(*scene.physics, WriteKeys{out});
}

Scene load_scene(const std::filesystem::path& file, std::span<const std::string> sets) {
    return load_scene_text(file, read_scene_file(file), sets);
}

Scene load_scene_text(const std::filesystem::path& file, std::string source,
                      std::span<const std::string> sets) {
    Overrides overrides(sets);
    Scene scene;
    scene.file = file;
    scene.source = std::move(source);
    const Origin origin{printable(file.string(), 400)};
    const SceneText text = cut_scene_text(scene.source, origin.place);
    TomlDocument document(text.rest, origin);
    if (document.is_empty() && text.body_count == 0)
        throw InputError(fmt::format(
            "{}: is empty; expected tables such as [[body]], [camera] and [render]", origin.place));
    overrides.apply(document.root(), text.body_count);

    TableReader root(document.root(), origin, "scene file");
    for (const std::string_view table : kSceneTables) root.has(table);
    EffectiveWriter out;
    MaterialNumbers materials;
    ErrorList errors;
    errors.collect([&] { root.finish(); });
    errors.collect([&] { load_name(root, origin, scene, out); });
    errors.collect([&] { load_physics(root, origin, scene, out); });
    errors.collect([&] { load_materials(root, origin, scene, out, materials); });
    // [[materials]] may hold them.
    materials.is_complete = materials.is_complete && errors.is_empty();
    bool has_bodies = false;
    errors.collect([&] {
        load_bodies(root, origin, text, materials, overrides, scene, out);
        has_bodies = true;
    });
    errors.collect([&] { load_joints(root, origin, has_bodies, scene, out); });
    errors.collect([&] { load_camera(root, origin, scene, out); });
    errors.collect([&] { load_lights(root, origin, scene, out); });
    errors.collect([&] { load_render(root, origin, scene, out); });
    errors.collect([&] { load_overlay(root, origin, scene, out); });
    errors.collect([&] { root.finish(); });
    errors.require_none();
    find_followed(root, origin, scene);
    require_view(scene, origin);
    // Both refuse what no command could do.
    step_count(scene), frame_count(scene);

    find_unused_keys(root, origin, scene);
    scene.hash = hex_hash(out.text());
    scene.motion_hash = motion_hash(out.text(), kMotionVersion);
    scene.effective = out.take_text();
    return scene;
}

}  // namespace tesserae::scenes
