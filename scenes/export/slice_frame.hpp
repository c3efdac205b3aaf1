// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/algebra/vector.hpp"
#include "render/camera/camera.hpp"
#include "scenes/export/mesh.hpp"

namespace tesserae::scenes {

/// The slice of a frame as a space of three dimensions, and its place in the space of the exported
/// film: that of the first frame's camera, which stands at its origin, with the axes x = right,
/// y = forward, z = up. Those are right-handed, and a picture of them is not mirrored: a camera
/// that looks along y with z up has x on its right in any right-handed program.
///
/// The frame's own coordinates are (right, forward, up, height) about its camera; its slice is
/// where the height along `fourth` is 0. A slice that is shifted along `fourth` only is laid over
/// the first one as it is. One that is turned is turned back about the plane that it shares with
/// the first, in the plane of both directions `fourth`: what both slices show keeps its place,
/// lengths and angles stay, the picture is the frame's. (Of a half turn, where no turn back is the
/// shortest, the one in the plane of `fourth` and `right`.)
class SliceFrame {
  public:
    SliceFrame(const render::Camera& camera, const render::Camera& first);

    /// Into the frame's coordinates, world axes and origin before.
    Vec4 point_to_frame(const Vec4& world) const { return axes_.transpose() * (world - origin_); }
    Mat4 turn_to_frame(const Mat4& to_world) const { return axes_.transpose() * to_world; }
    /// The direction whose coordinate is the height, in the world.
    Vec4 fourth() const { return axes_.col(3); }
    const Vec4& origin() const { return origin_; }
    Vec4 direction_to_frame(const Vec4& world) const { return axes_.transpose() * world; }

    /// From the slice, at height 0, to the film's space.
    Vec3 point_to_film(const Vec3& in_slice) const { return turn_ * in_slice + place_; }
    Vec3 direction_to_film(const Vec3& in_slice) const { return turn_ * in_slice; }

  private:
    Vec4 origin_;
    Mat4 axes_;   ///< columns: right, forward, up, fourth
    Mat3 turn_;   ///< a rotation
    Vec3 place_;  ///< of the camera in the film's space [m]
};

}  // namespace tesserae::scenes
