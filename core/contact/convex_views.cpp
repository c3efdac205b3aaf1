#include "core/contact/convex_views.hpp"

#include <cmath>

namespace tesserae {

void piece_along(const Polychoron& shape, const Vec4& direction, SurfacePiece& piece) {
    const Hull& hull = shape.body->hull;
    const HullCell& cell = hull.cells[shape.body->normals.largest_at(direction).number];
    piece.is_flat = true;
    piece.plane = cell.plane;
    piece.sides = cell.sides;
    piece.edges = cell.edges;
    piece.names = cell.vertices;
    for (const std::uint16_t vertex : cell.vertices)
        piece.vertices.push_back(hull.vertices[vertex]);
}

/// A cube; its vertices are named by the signs of their coordinates.
void piece_along(const Hyperbox& shape, const Vec4& direction, SurfacePiece& piece) {
    int along;
    direction.cwiseAbs().maxCoeff(&along);
    const double sign = direction[along] < 0 ? -1 : 1;
    const Vec4 half = 0.5 * shape.size;
    piece.is_flat = true;
    piece.plane = {sign * Vec4::Unit(along), half[along]};
    std::array<int, 3> axes{};
    for (int axis = 0, n = 0; axis < 4; ++axis) {
        if (axis == along) continue;
        axes[static_cast<std::size_t>(n++)] = axis;
        piece.sides.push_back({Vec4::Unit(axis), half[axis]});
        piece.sides.push_back({-Vec4::Unit(axis), half[axis]});
    }
    for (std::uint16_t corner = 0; corner < 8; ++corner) {
        Vec4 vertex = sign * half[along] * Vec4::Unit(along);
        unsigned name = sign > 0 ? 1u << along : 0;
        for (std::uint16_t i = 0; i < 3; ++i) {
            const bool up = corner >> i & 1u;
            vertex[axes[i]] = up ? half[axes[i]] : -half[axes[i]];
            if (up)
                name |= 1u << axes[i];
            else
                piece.edges.push_back({corner, static_cast<std::uint16_t>(corner | 1u << i)});
        }
        piece.vertices.push_back(vertex);
        piece.names.push_back(static_cast<std::uint16_t>(name));
    }
}

/// All of the core.
void piece_along(const Hypercapsule& shape, const Vec4&, SurfacePiece& piece) {
    piece.vertices = {-0.5 * shape.height * Vec4::UnitY(), 0.5 * shape.height * Vec4::UnitY()};
    piece.names = {0, 1};
    piece.edges = {{0, 1}};
}

void move_to(const Mat4& rotation, const Vec4& position, SurfacePiece& piece) {
    const auto move = [&](HalfSpace& plane) {
        plane.normal = rotation * plane.normal;
        plane.offset += plane.normal.dot(position);
    };
    move(piece.plane);
    for (HalfSpace& side : piece.sides) move(side);
    for (Vec4& vertex : piece.vertices) vertex = position + rotation * vertex;
}

}  // namespace tesserae
