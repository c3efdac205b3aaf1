#pragma once

#include "render/camera.hpp"
#include "render/ray.hpp"

namespace tesserae::render {

/// A ray that stays in a hyperplane parallel to the camera's. In camera coordinates it has three
/// directions only: what film lists and Embree work with.
struct ViewRay {
    Vec3 origin = Vec3::Zero();  ///< [m]
    Vec3 direction;              ///< unit
    double fourth = 0;           ///< where it is along the camera's fourth axis [m]
};

/// The same ray in the world's axes.
inline Ray world_ray(const ViewRay& view, const Camera& camera, double limit) {
    const Vec3 &o = view.origin, &d = view.direction;
    return {camera.to_world({o.x(), o.y(), o.z(), view.fourth}),
            camera.to_world({d.x(), d.y(), d.z(), 0}), kNoBody, limit};
}

}  // namespace tesserae::render
