// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/film_folder.hpp"

#include <sstream>

#include "core/error.hpp"
#include "core/file/read_file.hpp"
#include "render/file/preview_file.hpp"
#include "render/file/whole_image.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/load.hpp"
#include "scenes/load/scene_text.hpp"
#include "scenes/load/versions.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// A frame shows that the bodies stop, or that there is no next frame.
bool shows_end(const Scene& scene, int frame) {
    if (!scene.physics) return false;
    const std::uint64_t last = step_count(scene);
    return frame_instant(scene, frame).step == last ||
           (scene.camera.shutter > 0 && closing_instant(scene, frame).step == last) ||
           (scene.render.channels.motion && !has_frame(scene, frame + 1));
}

/// What a frame shows of an effective text.
std::string shown_text(const Scene& scene, const std::string& effective, int frame) {
    return shows_end(scene, frame) ? effective : without_duration(effective);
}

/// How a frame that has another hash differs from those that would be made of a scene.
std::string other_frame(const Scene& scene, const render::ImageInfo& there,
                        const render::FrameInfo& here) {
    const bool same_scene = is_frame_of(scene, there, here.frame);
    if (same_scene && there.picture_version != here.picture_version)
        return fmt::format("is a frame of picture version {}, this program makes version {}",
                           there.picture_version, here.picture_version);
    if (same_scene && there.motion_version != here.motion_version)
        return fmt::format("shows bodies moved by motion version {}, here by version {}",
                           there.motion_version, here.motion_version);
    return fmt::format("is a frame of another scene (hash {}, here {})", there.scene_hash,
                       here.scene_hash);
}

}  // namespace

Scene scene_of_film(const fs::path& file) {
    return load_scene_text(file, without_solver(read_scene_file(file)), {});
}

void create_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw RunError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

void create_folder_of(const fs::path& file) {
    std::error_code error;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
    if (error)
        throw RunError(
            fmt::format("{}: its folder cannot be made: {}", file.string(), error.message()));
}

std::string require_folder_of(const Scene& scene, const fs::path& folder, Replace replace) {
    const fs::path file = folder / kSceneFile;
    if (replace == Replace::kAll || !fs::exists(file)) return {};
    const std::string other = without_solver(read_file(file));
    std::string difference = first_difference(other, scene.effective);
    if (difference.empty()) return {};
    if (replace == Replace::kOtherLooks) {
        const std::string motion = first_motion_difference(other, scene.effective);
        // The name, which comes first, is that of the files.
        if (motion.empty() && !difference.starts_with("scene.")) return difference;
        if (!motion.empty()) difference = motion;
    }
    throw InputError(
        fmt::format("{}: holds frames of another scene: {}; choose another folder, or --overwrite",
                    folder.string(), difference));
}

std::string hash_of_frame(const Scene& scene, int frame, int picture_version, int motion_version) {
    return frame_hash(shown_text(scene, scene.effective, frame), picture_version, motion_version);
}

bool is_frame_of(const Scene& scene, const render::ImageInfo& there, int frame) {
    const int picture = there.picture_version, motion = there.motion_version;
    const std::string older = with_solver(scene.effective);
    for (const std::string& text : {scene.effective, older})
        // The second is that of frames which were made before duration was left out.
        if (there.scene_hash == frame_hash(shown_text(scene, text, frame), picture, motion) ||
            there.scene_hash == frame_hash(text, picture, motion))
            return true;
    return false;
}

std::vector<int> wanted_frames(const Scene& scene, const fs::path& folder) {
    std::string text;
    for (const fs::path& file : {folder / "submit" / "tasks.txt", folder / kFramesFile}) {
        if (!fs::exists(file)) continue;
        std::istringstream in(read_file(file));
        for (std::string line; std::getline(in, line);) text += (text.empty() ? "" : ",") + line;
        if (!text.empty()) break;
    }
    return parse_frames(text, frame_count(scene));
}

FrameCheck check_frame(const Scene& scene, int frame, int motion_version,
                       const render::FrameFiles& files) {
    if (!fs::exists(files.exr)) return {};
    const std::string file = files.exr.string();
    render::FrameInfo here;
    here.frame = frame;
    here.motion_version = motion_version;
    here.scene_hash = hash_of_frame(scene, frame, here.picture_version, motion_version);
    try {
        const render::ImageInfo there = render::read_image_info(files.exr);
        const bool is_ours =
            there.picture_version == here.picture_version && there.motion_version == motion_version;
        if (!is_ours || !is_frame_of(scene, there, frame))
            return {is_ours ? FrameState::kOther : FrameState::kOfOtherVersion,
                    fmt::format("{}: {}", file, other_frame(scene, there, here))};
        if (!render::is_whole_image(files.exr))
            return {FrameState::kDamaged, fmt::format("{}: is cut off", file)};
    } catch (const InputError& error) {
        return {FrameState::kDamaged, error.what()};
    }
    if (!fs::exists(files.preview))
        return {FrameState::kLacksPreview, fmt::format("{}: is missing", files.preview.string())};
    const std::string damage = damage_of_preview(scene, files.preview);
    if (!damage.empty()) return {FrameState::kLacksPreview, damage};
    return {FrameState::kComplete, {}};
}

bool is_done(const Scene& scene, const render::FrameInfo& info, const render::FrameFiles& files,
             Replace replace, const OverlayPainter& painter) {
    const FrameCheck there = check_frame(scene, info.frame, info.motion_version, files);
    switch (there.state) {
        case FrameState::kMissing:
            return false;
        case FrameState::kComplete:
            return true;
        case FrameState::kLacksPreview:
            if (mend_preview(scene, info.frame, files, painter, there.reason)) return true;
            break;
        case FrameState::kOther:
            if (replace != Replace::kNothing) return false;
            throw InputError(there.reason + "; choose another folder, or --overwrite");
        case FrameState::kOfOtherVersion:
            if (replace == Replace::kAll) return false;
            throw InputError(there.reason + "; choose another folder, or --overwrite");
        case FrameState::kDamaged:
            break;
    }
    tell(there.reason + ": the frame is rendered again");
    return false;
}

std::string damage_of_preview(const Scene& scene, const fs::path& preview) {
    return render::damage_of_preview(preview,
                                     render::preview_size_of(scene.render, scene.render.window()));
}

bool mend_preview(const Scene& scene, int frame, const render::FrameFiles& files,
                  const OverlayPainter& painter, const std::string& reason) {
    try {
        std::vector<render::Stamp> overlay;
        if (!painter.is_empty()) overlay = painter.stamps(frame, SlicePose(files.exr));
        if (!render::remake_preview(files.exr, scene.render, overlay, files.preview)) return false;
    } catch (const InputError& error) {
        // The image's pixels are damaged too, which its header does not show.
        tell(error.what());
        return false;
    }
    tell(reason + ": made again from its image");
    return true;
}

}  // namespace tesserae::scenes
