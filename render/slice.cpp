#include "render/slice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tesserae::render {
namespace {

/// Relative slack on every bound. A ray-sphere discriminant loses half of a double's digits to
/// cancellation, and this covers the square root of the rounding unit tenfold.
constexpr double kSlack = 1e-7;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Interval {
    double low, high;
};

/// Tangents of the two directions from the origin that touch a disc at (offset, z), radius < z.
Interval tangents(double offset, double z, double radius) {
    const double middle = std::atan2(offset, z);
    const double half = std::asin(std::min(1.0, radius / std::hypot(offset, z)));
    constexpr double kRight = 1.5707963267948966;
    const auto tangent = [&](double angle) {
        if (angle >= kRight) return kInfinite;
        return angle <= -kRight ? -kInfinite : std::tan(angle);
    };
    return {tangent(middle - half), tangent(middle + half)};
}

/// Sets the film rectangle of a sphere wholly or partly in front of the camera.
void project(SliceBounds& s, const Camera& camera) {
    s.x0 = s.y0 = -kInfinite;
    s.x1 = s.y1 = kInfinite;
    // The camera's own plane cuts the sphere: it may show anywhere on the film.
    if (!(s.centre.z() > s.radius)) return;
    const Interval x = tangents(s.centre.x(), s.centre.z(), s.radius);
    const Interval y = tangents(s.centre.y(), s.centre.z(), s.radius);
    const Vec2 top_left = camera.film_point(x.low, y.high);
    const Vec2 bottom_right = camera.film_point(x.high, y.low);
    const auto slack = [](double v) { return kSlack * (1 + std::abs(v)); };
    s.x0 = top_left.x() - slack(top_left.x());
    s.y0 = top_left.y() - slack(top_left.y());
    s.x1 = bottom_right.x() + slack(bottom_right.x());
    s.y1 = bottom_right.y() + slack(bottom_right.y());
}

/// Half the body's width along the camera's fourth axis [m].
double half_width(const PlacedBodies& placed, const PlacedBody& body, const Vec4& fourth) {
    const Vec4 axis = placed.direction_to_body(body, fourth);
    return std::visit([&](const auto& s) { return half_extent_along(s, axis); }, *body.shape);
}

std::optional<SliceBounds> bounds_of(const PlacedBodies& placed, std::uint32_t index,
                                     const Camera& camera, double max_distance) {
    const PlacedBody& body = placed.bodies[index];
    if (body.radius == kInfinite) {
        const double distance = std::visit(
            [&](const auto& s) {
                return signed_distance(s, placed.point_to_body(body, Vec4::Zero()));
            },
            *body.shape);
        return SliceBounds{Vec3::Zero(), kInfinite,  std::max(0.0, distance * (1 - kSlack)),
                           -kInfinite,   -kInfinite, kInfinite,
                           kInfinite,    index};
    }
    const Vec4 centre = camera.to_camera(body.centre);
    const double reach = body.radius + body.centre.norm();
    const double off = std::abs(centre[3]);
    if (off > half_width(placed, body, camera.fourth()) + kSlack * reach) return std::nullopt;

    SliceBounds s;
    s.body = index;
    s.centre = centre.head<3>();
    s.radius = std::sqrt(std::max(0.0, (body.radius - off) * (body.radius + off))) + kSlack * reach;
    s.nearest = std::max(0.0, s.centre.norm() - s.radius);
    if (s.centre.z() < -s.radius || s.nearest > max_distance) return std::nullopt;
    project(s, camera);
    return s;
}

}  // namespace

std::vector<SliceBounds> slice_bounds(const PlacedBodies& placed, const Camera& camera,
                                      double max_distance) {
    std::vector<SliceBounds> slice;
    for (std::uint32_t i = 0; i < placed.bodies.size(); ++i)
        if (const auto bounds = bounds_of(placed, i, camera, max_distance))
            slice.push_back(*bounds);
    return slice;
}

}  // namespace tesserae::render
