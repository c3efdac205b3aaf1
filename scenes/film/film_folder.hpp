// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/file/copied_frame.hpp"
#include "render/file/image_info.hpp"
#include "render/picture.hpp"
#include "scenes/overlay/stamps.hpp"
#include "scenes/scene.hpp"

// A folder holds the frames of one scene; its scene.toml is the effective text of that scene.
namespace tesserae::scenes {

constexpr const char* kSceneFile = "scene.toml";
/// Which frames a draft has, as `--frames` takes them. Other folders have all.
constexpr const char* kFramesFile = "frames.txt";

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

/// The scene that a film's folder holds, also where an older program has put it there.
/// @param file   the kSceneFile of a film, or of its jobs
Scene scene_of_film(const std::filesystem::path& file);

/// Makes a folder and those above it.
/// @throws RunError   with the path and the system's reason
void create_folder(const std::filesystem::path& folder);

/// Makes the folder that a file will be in.
/// @throws RunError   with the file and the system's reason
void create_folder_of(const std::filesystem::path& file);

/// The hash of what a frame shows: of all of the scene but its duration, where that is not seen, as
/// it is in the last frame with an open shutter or vectors of motion.
std::string hash_of_frame(const Scene& scene, int frame, int picture_version, int motion_version);

/// A file's frame shows this scene, in whatever versions.
bool is_frame_of(const Scene& scene, const render::ImageInfo& there, int frame);

/// The frames that a folder shall have in the end: those that were submitted, those of a draft, or
/// all.
/// @throws InputError   the file that says so is damaged
std::vector<int> wanted_frames(const Scene& scene, const std::filesystem::path& folder);

enum class FrameState {
    kMissing,
    kComplete,
    kLacksPreview,    ///< the image is whole, its preview is missing, damaged or of another size
    kOther,           ///< of another scene or look
    kOfOtherVersion,  ///< of this scene or another, by another version of motion or picture
    kDamaged,         ///< the image cannot be read or is cut off
};

/// How a frame's files are, and why.
struct FrameCheck {
    FrameState state = FrameState::kMissing;
    std::string reason;  ///< with the file's path; empty where it is missing or complete
};

/// Looks at the files of a frame: reads the image's header and table, and the whole preview.
/// @param motion_version   of the trajectory that moves its bodies
FrameCheck check_frame(const Scene& scene, int frame, int motion_version,
                       const render::FrameFiles& files);

/// What is wrong with a frame's preview, with its path; empty where it is whole and of its size.
std::string damage_of_preview(const Scene& scene, const std::filesystem::path& preview);

/// Makes a preview that is missing or damaged from its image, and tells it on standard error.
/// @return false: the image holds no colour, or is damaged as well
/// @throws RunError   the preview cannot be written
bool mend_preview(const Scene& scene, int frame, const render::FrameFiles& files,
                  const OverlayPainter& painter, const std::string& reason);

/// Whether a frame is there already. What is damaged is made again, and that is told on standard
/// error; a preview is made from its image where that is possible.
/// @throws InputError   a frame of something else is there, and may not be replaced
bool is_done(const Scene& scene, const render::FrameInfo& info, const render::FrameFiles& files,
             Replace replace, const OverlayPainter& painter);

}  // namespace tesserae::scenes
