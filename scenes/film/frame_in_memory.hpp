// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/world/world.hpp"
#include "render/finished_picture.hpp"
#include "scenes/process/watch.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// Renders a frame into memory, with the pixels that film() gives. Runs on the threads of the
/// caller's parallel::Threads.
/// @param trajectory   empty: bodies are as at time 0, which is an error if they have moved
/// @param watch        of tiles
/// @throws InputError   the scene has no such frame; as Poses
/// @throws Stopped      `watch` says so
tesserae::Picture frame_in_memory(const Scene& scene, int frame,
                                  const std::filesystem::path& trajectory, const Watch& watch);

/// The scene with a world's bodies where they are. Numbers that the world does not use any more are
/// of invisible bodies, so that all others keep theirs: colours that vary from body to body depend
/// on them. Bodies that the scene does not have are of the default material.
Scene scene_of_world(const Scene& scene, const World& world);

/// Renders a world as the scene's camera sees it at the world's time, without overlay.
/// @param number   of the picture, which noise depends on
/// @throws InputError   the camera follows a body that the world does not have
tesserae::Picture world_in_memory(const Scene& scene, const World& world, int number,
                                  const Watch& watch);

}  // namespace tesserae::scenes
