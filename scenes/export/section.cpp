// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/section.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <concepts>
#include <numeric>

#include "core/error.hpp"
#include "scenes/export/convex_section.hpp"

namespace tesserae::scenes {
namespace {

/// A plane whose normal has less than this along the slice is the slice, or parallel to it.
constexpr double kParallelToSlice = 1e-12;

/// The part of a convex polygon where a coordinate, or its opposite, is at most so much.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double offset) {
    std::vector<Vec3> rest;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = normal.dot(a) - offset, at_b = normal.dot(b) - offset;
        if (at_a <= 0) rest.push_back(a);
        if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
            rest.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    return rest;
}

Mesh plane_section(const Hyperplane& plane, const SliceFrame& frame, double extent) {
    const Vec4 normal = frame.direction_to_frame(plane.normal);
    const double along = normal.head<3>().norm();
    if (!(along > kParallelToSlice)) return {};
    const double offset = (plane.offset - plane.normal.dot(frame.origin())) / along;
    const Vec3 in_film = frame.direction_to_film(normal.head<3>() / along);
    return plane_patch(in_film, offset + in_film.dot(frame.point_to_film(Vec3::Zero())), extent);
}

Mesh polytope_section(const HullFaces& faces, const PlacedShape& at) {
    std::vector<Vec4> placed;
    for (const Vec4& v : faces.vertices) placed.push_back(at.centre + at.turn * v);
    if (auto mesh = hull_section(faces, placed)) return std::move(*mesh);
    // Rounding has torn the boundary: what the edges' cuts span is the same to rounding.
    std::vector<Vec3> points;
    for (const auto& [a, b] : faces.edges) {
        const double from = placed[a][3], to = placed[b][3];
        if (from * to > 0 || from == to) continue;
        points.push_back((placed[a] + from / (from - to) * (placed[b] - placed[a])).head<3>());
    }
    return hull_mesh(points);
}

void require_tolerance(double tolerance, double radius) {
    if (tolerance > 0 && tolerance < kFinestTolerance * radius)
        throw InputError(fmt::format(
            "--tolerance {}: there is a body of radius {} m: expected at least {} of that, {:.3g}",
            tolerance, radius, kFinestTolerance, kFinestTolerance * radius));
}

}  // namespace

Mesh plane_patch(const Vec3& normal, double offset, double half_side) {
    const Vec3 across = normal.unitOrthogonal(), third = normal.cross(across);
    // Reaches beyond the cube on all sides.
    const double reach = 4 * half_side + std::abs(offset);
    std::vector<Vec3> polygon;
    for (const auto& [u, v] :
         {std::pair(1, 1), std::pair(-1, 1), std::pair(-1, -1), std::pair(1, -1)})
        polygon.push_back(offset * normal + reach * (u * across + v * third));
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            polygon = clipped(polygon, side * Vec3::Unit(axis), half_side);
    Mesh mesh;
    if (polygon.size() < 3) return mesh;
    std::vector<std::uint32_t> corners(polygon.size());
    std::iota(corners.begin(), corners.end(), 0u);
    mesh.vertices = std::move(polygon);
    mesh.add_face(corners);
    return mesh;
}

Sections::Sections(const Bodies& bodies, const SectionSettings& settings)
    : settings_(settings), faces_(bodies.types.size()) {
    for (std::size_t type = 0; type < bodies.types.size(); ++type)
        std::visit(
            [&]<class S>(const S& shape) {
                if constexpr (std::derived_from<S, HullShape>)
                    faces_[type] = faces_of(shape.body->hull);
                else if constexpr (std::same_as<S, Hyperbox>)
                    faces_[type] = faces_of_box(shape.size);
                else if constexpr (S::kBounded)
                    require_tolerance(settings_.tolerance, bounding_radius(shape));
            },
            bodies.types[type].shape);
}

Mesh Sections::of(const Bodies& bodies, BodyId id, const SliceFrame& frame) const {
    const Shape& shape = bodies.type_of(id).shape;
    if (const auto* plane = std::get_if<Hyperplane>(&shape))
        return plane_section(*plane, frame, settings_.extent);
    // Most bodies of a large scene are nowhere near the slice.
    const double height = frame.fourth().dot(bodies.position[id] - frame.origin());
    if (std::abs(height) > bounding_radius(shape)) return {};
    Mesh mesh = bounded(bodies, id, frame);
    for (Vec3& v : mesh.vertices) v = frame.point_to_film(v);
    return mesh;
}

Mesh Sections::bounded(const Bodies& bodies, BodyId id, const SliceFrame& frame) const {
    const std::uint32_t type = bodies.type[id];
    const Shape& shape = bodies.types[type].shape;
    const double tolerance = settings_.tolerance > 0 ? settings_.tolerance
                                                     : 2 * kUsualTolerance * bounding_radius(shape);
    const PlacedShape at = {frame.point_to_frame(bodies.position[id]),
                            frame.turn_to_frame(to_matrix(bodies.rotor[id]))};
    return std::visit(
        [&]<class S>(const S& s) -> Mesh {
            if constexpr (std::derived_from<S, HullShape> || std::same_as<S, Hyperbox>)
                return polytope_section(faces_[type], at);
            else if constexpr (requires { section_mesh(s, at, tolerance); })
                return section_mesh(s, at, tolerance);
            else
                return convex_section(shape, at, tolerance);
        },
        shape);
}

}  // namespace tesserae::scenes
