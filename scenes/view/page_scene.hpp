// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/view/page_joints.hpp"

namespace tesserae::scenes {

/// A moment that a page shows as it was computed; between two of them it interpolates.
struct ViewMoment {
    double time = 0;                   ///< [s]
    render::CameraDescription camera;  ///< the film's
};

/// What a page knows of a scene beside its bodies' poses, as JSON in ASCII without `<`: whatever
/// text a scene holds stays text.
/// @param near_slice   bodies that never come as near as this to the film's slice are not in the
///                     page [m]
/// @param joints       that the page draws
std::string page_scene(const Scene& scene, const std::vector<ViewMoment>& moments,
                       std::optional<double> near_slice, const std::vector<PageJoint>& joints = {});

}  // namespace tesserae::scenes
