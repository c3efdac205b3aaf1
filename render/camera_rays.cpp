#include "render/camera_rays.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tesserae::render {
namespace {

/// Part of the way from one camera to another.
CameraDescription between(const CameraDescription& a, const CameraDescription& b, double part) {
    CameraDescription c = a;
    c.position += part * (b.position - a.position);
    c.look_at += part * (b.look_at - a.look_at);
    c.up = (1 - part) * a.up.normalized() + part * b.up.normalized();
    c.fourth = (1 - part) * a.fourth.normalized() + part * b.fourth.normalized();
    c.field_of_view += part * (b.field_of_view - a.field_of_view);
    return c;
}

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
    const double part = slices_ == 1 ? 0 : static_cast<double>(slice) / (slices_ - 1) - 0.5;
    return Cell{column * cell_width_, row * cell_height_, part * thickness_};
}

CameraRays::CameraRays(const CameraDescription& opening, const CameraDescription& closing,
                       int width, int height)
    : opening_(opening),
      closing_(closing),
      sheet_(opening, width, height),
      camera_(opening, sheet_.cell_width(), sheet_.cell_height()),
      focus_(opening.focus_distance > 0 ? opening.focus_distance
                                        : (opening.look_at - opening.position).norm()),
      is_pinhole_(opening.aperture == 0 && opening.slice_thickness == 0 && opening.shutter == 0),
      moves_(opening.shutter > 0 && !(opening == closing)) {}

Ray CameraRays::middle(const SliceSheet::Cell& cell, const Vec2& film) const {
    const Vec3 view = camera_.ray_direction(film - Vec2(cell.x0, cell.y0));
    return {cell.fourth * camera_.fourth(), camera_.to_world({view.x(), view.y(), view.z(), 0}), 0};
}

Ray CameraRays::sample(const SliceSheet::Cell& cell, const Vec2& film,
                       const std::array<double, 4>& u) const {
    if (is_pinhole_) return middle(cell, film);
    const double time = opening_.shutter > 0 ? u[3] : 0;
    const Camera camera = moves_ ? Camera(between(opening_, closing_, time), sheet_.cell_width(),
                                          sheet_.cell_height())
                                 : camera_;
    Vec3 view = camera.ray_direction(film - Vec2(cell.x0, cell.y0));
    Vec4 from = {0, 0, 0, cell.fourth};
    if (opening_.slices == 1) from[3] = (u[2] - 0.5) * opening_.slice_thickness;
    if (opening_.aperture > 0) {
        const Vec2 lens = opening_.aperture * on_disc(u[0], u[1]);
        from.head<2>() = lens;
        view = (focus_ / view.z() * view - Vec3(lens.x(), lens.y(), 0)).normalized();
    }
    return {camera.origin() - camera_.origin() + camera.to_world(from),
            camera.to_world({view.x(), view.y(), view.z(), 0}), time};
}

}  // namespace tesserae::render
