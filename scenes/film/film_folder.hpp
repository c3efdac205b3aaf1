#pragma once

#include <filesystem>
#include <string>

#include "render/file/copied_frame.hpp"
#include "render/file/image_info.hpp"
#include "render/picture.hpp"
#include "scenes/scene.hpp"

// A folder holds the frames of one scene; its scene.toml is the effective text of that scene.
namespace tesserae::scenes {

constexpr const char* kSceneFile = "scene.toml";

/// What may be replaced in a folder.
enum class Replace {
    kNothing,
    kOtherLooks,  ///< frames of the same scene and motion seen otherwise: what `run` does
    kAll,         ///< `--overwrite`
};

/// How the scene that a folder holds looks otherwise or lasts longer: "camera.field_of_view: 50
/// there, 40 here". Empty where it is the same scene, another that may be replaced, or none yet.
/// @throws InputError   it holds another scene's, and may not; names the first difference
std::string require_folder_of(const Scene& scene, const std::filesystem::path& folder,
                              Replace replace);

/// Makes a folder and those above it.
/// @throws RunError   with the path and the system's reason
void create_folder(const std::filesystem::path& folder);

/// The hash of what a frame shows: of all of the scene but its duration, where that is not seen, as
/// it is in the last frame with an open shutter or vectors of motion.
std::string hash_of_frame(const Scene& scene, int frame, int picture_version, int motion_version);

/// A file's frame shows this scene, in whatever versions.
bool is_frame_of(const Scene& scene, const render::ImageInfo& there, int frame);

/// The whole frame and its preview are there already.
/// @throws InputError   a frame of something else is there, and may not be replaced
bool is_done(const Scene& scene, const render::FrameInfo& info, const render::FrameFiles& files,
             Replace replace);

}  // namespace tesserae::scenes
