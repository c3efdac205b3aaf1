// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/constraints/joint.hpp"
#include "core/dynamics/step/settings.hpp"
#include "render/description.hpp"
#include "scenes/camera_motion.hpp"
#include "scenes/camera_path.hpp"
#include "scenes/named_bodies.hpp"
#include "scenes/overlay/overlay.hpp"

namespace tesserae::scenes {

/// A scene file, checked, overridden and expanded: all that simulating and rendering need.
struct Scene {
    std::filesystem::path file;
    std::string name;                            ///< stem of the frames' file names
    std::optional<PhysicsSettings> physics;      ///< none: a still
    Bodies bodies;                               ///< at time 0
    std::vector<render::Appearance> appearance;  ///< by body type
    std::vector<NamedBodies> names;              ///< ascending, covering all bodies
    std::vector<Joint> joints;                   ///< as the bodies are at time 0
    std::vector<std::string> joint_names;        ///< of each joint
    std::vector<render::Material> materials;
    render::CameraDescription camera;    ///< where no key moves it
    std::vector<CameraKey> camera_keys;  ///< ascending in time
    CameraMotion camera_motion;
    render::Lights lights;
    render::Settings render;
    bool gives_ghost_depth = false;  ///< also where that is 0; if not, a draft has ghosts
    Overlay overlay;

    std::vector<std::string> unused;  ///< a line for each key of the file that changes nothing

    std::string source;     ///< the file's text as read
    std::string effective;  ///< canonical TOML after overrides: the same scene gives the same text
    std::string hash;       ///< 32 hex digits of `effective`
    std::string motion_hash;  ///< of a trajectory that this program makes of it

    /// The camera follows a body of a scene in which something may move.
    bool follows() const { return physics && camera_motion.followed; }
    bool has_moving_camera() const { return !camera_keys.empty() || follows(); }
    CameraPath camera_path() const { return CameraPath(camera, camera_keys, camera_motion.closed); }
};

}  // namespace tesserae::scenes
