// SPDX-License-Identifier: Apache-2.0
#include "render/camera/camera_rays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tesserae::render {
namespace {

/// Uniform in the unit disc, squares to sectors (P. Shirley and K. Chiu, 1997).
Vec2 on_disc(double u, double v) {
    const double a = 2 * u - 1, b = 2 * v - 1;
    constexpr double kEighth = std::numbers::pi / 4;
    if (a == 0 && b == 0) return Vec2::Zero();
    if (std::abs(a) > std::abs(b))
        return {a * std::cos(kEighth * b / a), a * std::sin(kEighth * b / a)};
    return {b * std::sin(kEighth * a / b), b * std::cos(kEighth * a / b)};
}

}  // namespace

SliceSheet::SliceSheet(const CameraDescription& camera, int width, int height)
    : slices_(camera.slices), thickness_(camera.slice_thickness) {
    // The grid whose cells come nearest to the frame's own proportions.
    columns_ = static_cast<int>(std::ceil(std::sqrt(slices_)));
    rows_ = (slices_ + columns_ - 1) / columns_;
    cell_width_ = std::max(1, width / columns_);
    cell_height_ = std::max(1, height / rows_);
}

std::optional<SliceSheet::Cell> SliceSheet::cell_of(int x, int y) const {
    const int column = x / cell_width_, row = y / cell_height_;
    const int slice = row * columns_ + column;
    if (column >= columns_ || slice >= slices_) return std::nullopt;
    return Cell{column * cell_width_, row * cell_height_, fourth(slice), slice};
}

double SliceSheet::fourth(int cell) const {
    const double part = slices_ == 1 ? 0 : static_cast<double>(cell) / (slices_ - 1) - 0.5;
    return part * thickness_;
}

CameraRays::CameraRays(const CameraDescription& description, const Camera& camera)
    : camera_(camera),
      aperture_(description.aperture),
      focus_(description.focus_distance > 0 ? description.focus_distance
                                            : (description.look_at - description.position).norm()),
      thickness_(description.slice_thickness),
      is_sheet_(description.slices > 1) {}

bool CameraRays::is_pinhole() const { return aperture_ == 0 && thickness_ == 0; }

ViewRay CameraRays::middle(const SliceSheet::Cell& cell, const Vec2& film) const {
    return {Vec3::Zero(), camera_.ray_direction(film - Vec2(cell.x0, cell.y0)), cell.fourth};
}

ViewRay CameraRays::sample(const SliceSheet::Cell& cell, const Vec2& film,
                           const std::array<double, 3>& u) const {
    ViewRay ray = middle(cell, film);
    if (!is_sheet_) ray.fourth = (u[2] - 0.5) * thickness_;
    if (aperture_ > 0) {
        const Vec2 lens = aperture_ * on_disc(u[0], u[1]);
        ray.origin = {lens.x(), lens.y(), 0};
        ray.direction = (focus_ / ray.direction.z() * ray.direction - ray.origin).normalized();
    }
    return ray;
}

}  // namespace tesserae::render
