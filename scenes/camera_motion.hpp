// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae::scenes {

struct FollowAxes {
    bool x = true, y = true, z = true, w = true;

    friend bool operator==(const FollowAxes&, const FollowAxes&) = default;
};

/// How the camera moves beside its keys.
struct CameraMotion {
    bool closed = false;             ///< its path goes on round after the last key
    std::string follow;              ///< name of the body that it follows; empty: none
    FollowAxes follow_axes;          ///< along which it follows
    double follow_lag = 0;           ///< see FilmCamera [s]
    std::optional<BodyId> followed;  ///< the body of that name
};

}  // namespace tesserae::scenes
