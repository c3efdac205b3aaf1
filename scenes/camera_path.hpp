#pragma once

#include <optional>
#include <span>

#include "render/description.hpp"

namespace tesserae::scenes {

/// What a [[camera.key]] says: parts of the view at a time.
struct CameraKey {
    double time = 0;  ///< [s]
    std::optional<Vec4> position, look_at;
    std::optional<Vec4> up, fourth;  ///< unit; no two that follow each other are opposite
    std::optional<double> field_of_view;
};

/// The camera at a time [s]: each part goes smoothly through the keys that name it (ascending in
/// time), stands still between equal ones and before the first and after the last, and stays as in
/// `still` where none does. A part with two keys moves evenly. Directions turn on the sphere.
///
/// Cubic Bezier arcs whose slopes at a key are those of the parabola through it and its neighbours
/// (Catmull-Rom for uneven times), by de Casteljau's construction, which on the sphere takes great
/// arcs for segments (Shoemake 1985).
render::CameraDescription camera_at(const render::CameraDescription& still,
                                    std::span<const CameraKey> keys, double time);

}  // namespace tesserae::scenes
