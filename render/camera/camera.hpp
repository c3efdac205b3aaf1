// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/algebra/vector.hpp"
#include "render/description.hpp"
#include "render/ray.hpp"

namespace tesserae::render {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Where view rays may start along the camera's fourth axis [m]: a pinhole's at 0. Every view ray
/// stays in the slice that it starts in.
struct SliceRange {
    double low = 0, high = 0;
};

/// A ray that stays in a hyperplane parallel to the camera's. In camera coordinates it has three
/// directions only: what film lists and Embree work with.
struct ViewRay {
    Vec3 origin = Vec3::Zero();      ///< [m]
    Vec3 direction = Vec3::UnitZ();  ///< unit
    double fourth = 0;               ///< where it is along the camera's fourth axis [m]
};

/// A pinhole in 4D. It sees the 3D hyperplane through its origin that is orthogonal to `fourth`.
/// Camera coordinates are (right, up, forward, fourth); the frame is orthonormal with determinant
/// +1: forward is kept, then fourth, then up made orthogonal to both. Looking along +z with fourth
/// +w and up +y gives right = +x, as in left-handed 3D.
/// Film points are continuous pixels from the top left: pixel (i, j) covers [i, i+1) x [j, j+1).
class Camera {
  public:
    /// @param width, height   of the full frame [pixels]; a crop does not change the view
    /// @throws InputError     position equals look_at; up, fourth and forward are not independent
    Camera(const CameraDescription& description, int width, int height);

    const Vec4& origin() const { return origin_; }
    Vec4 right() const { return axes_.col(0); }
    Vec4 up() const { return axes_.col(1); }
    Vec4 forward() const { return axes_.col(2); }
    Vec4 fourth() const { return axes_.col(3); }

    Vec4 to_camera(const Vec4& world_direction) const {
        return axes_.transpose() * world_direction;
    }
    Vec4 to_world(const Vec4& camera_direction) const { return axes_ * camera_direction; }
    Ray to_world(const ViewRay& view, double limit) const {
        const Vec3 &o = view.origin, &d = view.direction;
        return {to_world({o.x(), o.y(), o.z(), view.fourth}), to_world({d.x(), d.y(), d.z(), 0}),
                kNoBody, limit};
    }

    /// Unit direction of the view ray of a film point, in camera coordinates (no fourth part).
    Vec3 ray_direction(const Vec2& film) const {
        return Vec3((film.x() - centre_.x()) * pixel_, (centre_.y() - film.y()) * pixel_, 1)
            .normalized();
    }
    /// The film point of a direction (x, y, 1).
    Vec2 film_point(double x, double y) const {
        return {centre_.x() + x / pixel_, centre_.y() - y / pixel_};
    }

    /// A pixel's side on the film at distance 1.
    double pixel_size() const { return pixel_; }

  private:
    Vec4 origin_;
    Mat4 axes_;    ///< columns: right, up, forward, fourth
    Vec2 centre_;  ///< film point of the forward axis
    double pixel_;
};

}  // namespace tesserae::render
