// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/slice_frame.hpp"

#include <cmath>

namespace tesserae::scenes {
namespace {

/// Where 1 + cosine of the angle between two directions is below this, they count as opposite: the
/// plane in which they are turned is lost to rounding.
constexpr double kOpposite = 1e-12;

Mat4 axes_of(const render::Camera& camera) {
    Mat4 axes;
    axes << camera.right(), camera.forward(), camera.up(), camera.fourth();
    return axes;
}

/// The rotation that takes one unit vector to another and leaves alone what is orthogonal to both.
Mat4 shortest_turn(const Vec4& from, const Vec4& to, const Vec4& aside) {
    const double cosine = from.dot(to);
    if (1 + cosine < kOpposite)
        return Mat4::Identity() - 2 * (to * to.transpose() + aside * aside.transpose());
    const Vec4 sum = from + to;
    return Mat4::Identity() - sum * sum.transpose() / (1 + cosine) + 2 * to * from.transpose();
}

}  // namespace

SliceFrame::SliceFrame(const render::Camera& camera, const render::Camera& first)
    : origin_(camera.origin()), axes_(axes_of(camera)) {
    const Mat4 film = axes_of(first);
    const Vec4 here = camera.fourth(), there = first.fourth();
    const Mat4 turned = film.transpose() * shortest_turn(here, there, first.right()) * axes_;
    turn_ = turned.topLeftCorner<3, 3>();

    // The turn is about the plane that both slices share: it takes the camera, at this height above
    // the first slice, along the bisector of both directions.
    const Vec4 way = camera.origin() - first.origin();
    const double height = there.dot(way), cosine = here.dot(there);
    const Vec4 down = 1 + cosine < kOpposite ? Vec4(height * there)
                                             : Vec4(height / (1 + cosine) * (here + there));
    place_ = (film.transpose() * (way - down)).head<3>();
}

}  // namespace tesserae::scenes
