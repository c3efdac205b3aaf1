// SPDX-License-Identifier: Apache-2.0
#include "render/scene/slice.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tesserae::render {
namespace {

/// Relative slack on every bound. A ray-sphere discriminant loses half of a double's digits to
/// cancellation, and this covers the square root of the rounding unit tenfold.
constexpr double kSlack = 1e-7;

struct Extent {
    double low, high;
};

/// Tangents of the two directions from the origin that touch a disc at (offset, z), radius < z.
Extent tangents(double offset, double z, double radius) {
    const double middle = std::atan2(offset, z);
    const double half = std::asin(std::min(1.0, radius / std::hypot(offset, z)));
    constexpr double kRight = 1.5707963267948966;
    const auto tangent = [&](double angle) {
        if (angle >= kRight) return kInfinite;
        return angle <= -kRight ? -kInfinite : std::tan(angle);
    };
    return {tangent(middle - half), tangent(middle + half)};
}

/// Sets the film rectangle of a sphere and a box that both hold what is to be seen, wholly or
/// partly in front of the camera.
void project(SliceBounds& s, const Camera& camera) {
    Extent x = {-kInfinite, kInfinite}, y = x;
    // Where the camera's own plane cuts the sphere, it may show anywhere on the film.
    if (s.centre.z() > s.radius) {
        x = tangents(s.centre.x(), s.centre.z(), s.radius);
        y = tangents(s.centre.y(), s.centre.z(), s.radius);
    }
    if (s.low.z() > 0) {
        const auto narrow = [&](Extent& i, double low, double high) {
            i.low = std::max(i.low, low / (low < 0 ? s.low.z() : s.high.z()));
            i.high = std::min(i.high, high / (high > 0 ? s.low.z() : s.high.z()));
        };
        narrow(x, s.low.x(), s.high.x());
        narrow(y, s.low.y(), s.high.y());
    }
    const Vec2 top_left = camera.film_point(x.low, y.high);
    const Vec2 bottom_right = camera.film_point(x.high, y.low);
    const auto slack = [](double v) { return kSlack * (1 + std::abs(v)); };
    s.x0 = top_left.x() - slack(top_left.x());
    s.y0 = top_left.y() - slack(top_left.y());
    s.x1 = bottom_right.x() + slack(bottom_right.x());
    s.y1 = bottom_right.y() + slack(bottom_right.y());
}

/// How far a body's slices reach from its centre along a direction e of the hyperplane, from
/// above: the most of e.x over the points x of the body (from its centre) with n.x in `range`, n
/// being the fourth axis. For any number l this is at most the most of (e - l n).x over the whole
/// body plus the most of l n.x, and for the best l it is just that (Lagrange duality; both sides
/// are convex). So any l gives a bound, and golden section a tight one.
/// @param e, n   in the body's frame
template <class S>
double slice_extent(const S& shape, const Vec4& e, const Vec4& n, const SliceRange& range) {
    // l = u / (1 - u^2): all numbers for u within +-1. The width left, 1e-3, makes the bound
    // too large by at most about as much of the body.
    constexpr int kSteps = 16;
    constexpr double kGoldenRatio = 0.6180339887498949;
    double best = kInfinite;
    const auto bound = [&](double u) {
        const double l = u / (1 - u * u);
        const double value =
            half_extent_along(shape, e - l * n) + std::max(l * range.low, l * range.high);
        best = std::min(best, value);
        return value;
    };
    double a = -1, b = 1;
    double u = b - kGoldenRatio * (b - a), v = a + kGoldenRatio * (b - a);
    double at_u = bound(u), at_v = bound(v);
    for (int i = 0; i < kSteps; ++i) {
        if (at_u < at_v) {
            b = v, v = u, at_v = at_u;
            u = b - kGoldenRatio * (b - a), at_u = bound(u);
        } else {
            a = u, u = v, at_u = at_v;
            v = a + kGoldenRatio * (b - a), at_v = bound(v);
        }
    }
    return best;
}

/// Narrows the box of the sphere to the body's own slices.
void fit_box(SliceBounds& s, const PlacedBodies& placed, const PlacedBody& body,
             const Camera& camera, double centre_fourth, const SliceRange& range, double slack) {
    const Vec4 n = placed.direction_to_body(body, camera.fourth());
    const SliceRange from_centre = {range.low - centre_fourth, range.high - centre_fourth};
    for (int axis = 0; axis < 3; ++axis) {
        const Vec4 e = placed.direction_to_body(body, camera.to_world(Vec4::Unit(axis)));
        std::visit(
            [&](const auto& shape) {
                const double c = s.centre[axis];
                s.high[axis] =
                    std::min(s.high[axis], c + slice_extent(shape, e, n, from_centre) + slack);
                s.low[axis] =
                    std::max(s.low[axis], c - slice_extent(shape, -e, n, from_centre) - slack);
            },
            *body.shape);
    }
}

/// Half the body's width along the camera's fourth axis [m].
double half_width(const PlacedBodies& placed, const PlacedBody& body, const Vec4& fourth) {
    const Vec4 axis = placed.direction_to_body(body, fourth);
    return std::visit([&](const auto& s) { return half_extent_along(s, axis); }, *body.shape);
}

SliceBounds unbounded(const PlacedBodies& placed, std::uint32_t index) {
    const PlacedBody& body = placed.bodies[index];
    SliceBounds s;
    s.body = index;
    s.centre = Vec3::Zero();
    s.radius = s.x1 = s.y1 = kInfinite;
    s.x0 = s.y0 = -kInfinite;
    s.low.setConstant(-kInfinite), s.high.setConstant(kInfinite);
    const double distance = std::visit(
        [&](const auto& shape) {
            return signed_distance(shape, placed.point_to_body(body, Vec4::Zero()));
        },
        *body.shape);
    s.nearest = std::max(0.0, distance * (1 - kSlack));
    return s;
}

}  // namespace

std::optional<SliceBounds> slice_bounds_of(const PlacedBodies& placed, std::uint32_t index,
                                           const Camera& camera, double max_distance,
                                           const SliceRange& range) {
    const PlacedBody& body = placed.bodies[index];
    if (body.radius == kInfinite) return unbounded(placed, index);
    const Vec4 centre = camera.to_camera(body.centre);
    const double slack = kSlack * (body.radius + body.centre.norm());
    const double off = std::max({range.low - centre[3], centre[3] - range.high, 0.0});
    if (off > half_width(placed, body, camera.fourth()) + slack) return std::nullopt;

    SliceBounds s;
    s.body = index;
    s.centre = centre.head<3>();
    s.radius = std::sqrt(std::max(0.0, (body.radius - off) * (body.radius + off))) + slack;
    s.low = s.centre.array() - s.radius, s.high = s.centre.array() + s.radius;
    // A hypersphere's slice is the sphere.
    if (!std::holds_alternative<Hypersphere>(*body.shape))
        fit_box(s, placed, body, camera, centre[3], range, slack);
    const Vec3 to_box = s.low.cwiseMax(-s.high).cwiseMax(0);
    s.nearest = std::max({0.0, s.centre.norm() - s.radius, to_box.norm() * (1 - kSlack)});
    if (s.high.z() < 0 || s.nearest > max_distance) return std::nullopt;
    project(s, camera);
    return s;
}

std::vector<SliceBounds> slice_bounds(const PlacedBodies& placed, const Camera& camera,
                                      double max_distance, const SliceRange& range) {
    std::vector<std::optional<SliceBounds>> each(placed.bodies.size());
    tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t i) {
        each[i] =
            slice_bounds_of(placed, static_cast<std::uint32_t>(i), camera, max_distance, range);
    });
    std::vector<SliceBounds> slice;
    for (const auto& bounds : each)
        if (bounds) slice.push_back(*bounds);
    return slice;
}

}  // namespace tesserae::render
