// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <unordered_map>

#include "scenes/load/effective.hpp"
#include "scenes/load/overrides.hpp"
#include "scenes/load/scene_text.hpp"
#include "scenes/load/toml_reader.hpp"
#include "scenes/scene.hpp"

// The sections of a scene. Each function reads one, checks it, fills the scene's part and appends
// its canonical text.
namespace tesserae::scenes {

void load_name(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out);
void load_physics(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out);

/// Index of each material by name. Material 0 is the grey of bodies that name none.
struct MaterialNumbers : std::unordered_map<std::string, std::uint32_t> {
    bool is_complete = true;  ///< false: a table has errors, and may have another name
};
/// @param numbers   gets them, also where an error is thrown: bodies may name what has errors
void load_materials(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out,
                    MaterialNumbers& numbers);

/// All [[body]], then all [[lattice]].
void load_bodies(TableReader& root, const Origin& origin, const SceneText& text,
                 const MaterialNumbers& materials, Overrides& overrides, Scene& scene,
                 EffectiveWriter& out);

/// All [[joint]].
/// @param has_bodies   false: the bodies have errors, so that no joint can be made
void load_joints(TableReader& root, const Origin& origin, bool has_bodies, Scene& scene,
                 EffectiveWriter& out);

void load_camera(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out);
/// Once all is loaded: which body the camera follows.
void find_followed(TableReader& root, const Origin& origin, Scene& scene);
/// Once all is loaded: keys that the file has and this scene does not use, into Scene::unused.
void find_unused_keys(TableReader& root, const Origin& origin, Scene& scene);
/// Once all is loaded: that the moving camera has a frame of axes in every frame of the film.
void require_view(const Scene& scene, const Origin& origin);
void load_lights(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out);
void load_render(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out);
void load_overlay(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out);

}  // namespace tesserae::scenes
