// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/film/film_camera.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// The camera's path in the coordinates of exported meshes, as JSON:
///
///   tesserae   the hash that the meshes carry
///   axes       how coordinates come from the world: origin, and the directions x = right,
///              y = forward, z = up and fourth of the first frame's camera, four numbers each
///   size       of the picture [pixels]
///   frames     of every frame of the scene: frame, time [s], position [m], right, forward, up
///              (unit, right-handed), field_of_view (vertical) [degrees]; and height, by which
///              the camera is above the first frame's slice along its fourth [m]
/// Where the camera follows a body, frames are left out at which the trajectory does not tell where
/// that is.
std::string camera_json(const Scene& scene, FilmCamera& camera, const std::string& hash);

}  // namespace tesserae::scenes
