// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/body_finder.hpp"
#include "scenes/load/load_parts.hpp"

namespace tesserae::scenes {

void find_followed(TableReader& root, const Origin& origin, Scene& scene) {
    const std::string& name = scene.camera_motion.follow;
    if (name.empty()) return;
    TableReader reader(*root.table("camera"), origin, "[camera]");
    scene.camera_motion.followed = BodyFinder(scene.names).find(reader, "follow", name);
}

}  // namespace tesserae::scenes
