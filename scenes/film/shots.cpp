// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/shots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "scenes/film/film_folder.hpp"
#include "scenes/film/mattes.hpp"
#include "scenes/process/version.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

/// The bodies' names by object id (body number + 1), as a JSON object: "first-last" for lattices.
std::string id_names(const Scene& scene) {
    // Enough for a person and for mattes; a header is read whole by every viewer.
    constexpr std::size_t kMaxNames = 10'000;
    auto names = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < std::min(scene.names.size(), kMaxNames); ++i) {
        const NamedBodies& n = scene.names[i];
        const std::string ids = n.count > 1 ? fmt::format("{}-{}", n.first + 1, n.first + n.count)
                                            : fmt::format("{}", n.first + 1);
        names[ids] = n.name;
    }
    return names.dump();
}

}  // namespace

render::FrameInfo common_info(const Scene& scene) {
    render::FrameInfo info;
    info.scene_name = scene.name;
    info.program_version = program_version();
    info.id_names = id_names(scene);
    return info;
}

Shots::Shots(const Scene& scene, const std::vector<int>& frames,
             const std::filesystem::path& trajectory)
    : scene_(scene),
      poses_(scene, frames, trajectory),
      camera_(scene, &poses_),
      painter_(scene),
      info_(common_info(scene)) {
    info_.motion_version = poses_.motion_version();
}

void Shots::name_mattes(const std::filesystem::path& folder) {
    if (scene_.render.channels.cryptomatte) mattes_ = mattes_of(scene_, folder);
}

render::FrameInfo Shots::info(int frame) const {
    render::FrameInfo info = info_;
    info.frame = frame;
    info.scene_hash = hash_of_frame(scene_, frame, info.picture_version, info.motion_version);
    info.time = frame_instant(scene_, frame).time;
    return info;
}

Shot Shots::shot(int frame) {
    Shot shot = {info(frame), Exposure(scene_, camera_, poses_, frame), {}};
    if (!painter_.is_empty())
        shot.overlay = painter_.stamps(frame, SlicePose(shot.exposure.opening.camera));
    return shot;
}

render::Picture Shots::picture(const Shot& shot) const {
    render::Picture picture = shot.exposure.picture(scene_, shot.info.frame);
    if (mattes_) picture.mattes = &*mattes_;
    picture.overlay = shot.overlay;
    return picture;
}

}  // namespace tesserae::scenes
