// SPDX-License-Identifier: Apache-2.0
#include "render/tile/centre_layers.hpp"

#include <cmath>
#include <limits>

#include "core/algebra/rotor.hpp"

namespace tesserae::render {
namespace {

/// The sine of the angle between surface and slice below which they count as parallel: there the
/// normal's part in the slice has lost half of a double's digits, and traced surfaces' more.
constexpr double kParallel = 1e-8;

/// The sine of the angle between a direction and the other camera's film below which it counts as
/// beside the camera: its film point, a billion focal lengths away, would be made of rounding.
constexpr double kBeside = 1e-9;

Vec2 film_point(const Camera& camera, const Vec4& at) {
    return camera.film_point(at[0] / at[2], at[1] / at[2]);
}

void store_way(const std::optional<FrameMotion>& motion, const Ray& ray, const Surface* surface,
               BodyId body, float way[2]) {
    if (!motion) return;
    const Vec2 pixels = motion->way(ray.direction, surface, body);
    way[0] = static_cast<float>(pixels[0]);
    way[1] = static_cast<float>(pixels[1]);
}

}  // namespace

FrameMotion::FrameMotion(const Picture& picture, const Camera& camera, const SliceSheet& sheet,
                         const Neighbour& neighbour)
    : picture_(picture),
      camera_(camera),
      neighbour_(neighbour),
      other_(neighbour.camera, sheet.cell_width(), sheet.cell_height()) {}

/// Where a point of a body is in the other frame, relative to the other camera. What does not move
/// keeps its bits.
/// @param point   relative to the frame's own camera
Vec4 FrameMotion::moved(const Vec4& point, BodyId body) const {
    const Bodies &here = picture_.bodies, &there = neighbour_.bodies;
    const Vec4 shift =
        (there.position[body] - here.position[body]) - (other_.origin() - camera_.origin());
    const Rotor &from = here.rotor[body], &to = there.rotor[body];
    if (from == to) return point + shift;
    const Vec4 arm = point - (here.position[body] - camera_.origin());
    return point + (shift + (rotate(to * reverse(from), arm) - arm));
}

Vec2 FrameMotion::way(const Vec4& direction, const Surface* surface, BodyId body) const {
    const Vec4 here = camera_.to_camera(surface ? surface->point : direction);
    const Vec4 there = other_.to_camera(surface ? moved(surface->point, body) : direction);
    if (!(there[2] > kBeside * there.norm())) return Vec2::Zero();
    const Vec2 down = film_point(other_, there) - film_point(camera_, here);
    if (!(down.cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max())) return Vec2::Zero();
    return {down[0], -down[1]};
}

CentreLayers::CentreLayers(const Picture& picture, const Camera& camera, const SliceSheet& sheet)
    : camera_(camera) {
    if (!picture.settings.channels.motion) return;
    if (picture.next) next_.emplace(picture, camera, sheet, *picture.next);
    if (picture.last) last_.emplace(picture, camera, sheet, *picture.last);
}

LayerPixel CentreLayers::empty() {
    LayerPixel pixel = {};
    pixel.plane_depth = std::numeric_limits<float>::infinity();
    return pixel;
}

void CentreLayers::store(const Ray& ray, const Surface* surface, BodyId body,
                         LayerPixel& pixel) const {
    store_way(next_, ray, surface, body, pixel.forward);
    store_way(last_, ray, surface, body, pixel.backward);
    if (!surface) return;
    pixel.plane_depth = static_cast<float>(camera_.forward().dot(surface->point));
    const Vec3 part = camera_.to_camera(surface->normal).head<3>();
    const double length = part.norm();
    if (!(length > kParallel)) return;
    for (int i = 0; i < 3; ++i) pixel.slice_normal[i] = static_cast<float>(part[i] / length);
}

}  // namespace tesserae::render
