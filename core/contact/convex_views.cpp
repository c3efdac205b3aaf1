// SPDX-License-Identifier: Apache-2.0
#include "core/contact/convex_views.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tesserae {
namespace {

/// A ball that leans less than this from a direction's [rad] lies flat to it: all of it may touch.
/// Less, and a disc that wobbles down has one point, which runs round its rim faster than it is
/// found again (at 0.02 one of 6 mm sinks in by 42 mm); more, and points are made that do not
/// touch.
constexpr double kFlat = 0.5;
/// One that leans less than this is even: which of its points is farthest is rounding.
constexpr double kEven = 1e-5;

/// Points that span a factor's ball as it is seen along a direction.
struct Skeleton {
    std::vector<NamedPoint> points;
    std::vector<std::array<std::uint16_t, 2>> edges;
};
/// @param leans   how much of the unit direction is along its axes
Skeleton farthest_only(const BallFactor& factor, const Vec4& direction) {
    return {{{support(factor, direction), 6}}, {}};
}
Skeleton skeleton_of(const BallFactor& factor, const Vec4& direction) {
    const double leans = stable_norm(factor.axes.cwiseProduct(direction));
    if (factor.dimensions > 1 && leans > kFlat) return farthest_only(factor, direction);
    Skeleton skeleton;
    for (int axis = 0; axis < 4; ++axis) {
        if (!(factor.axes[axis] > 0)) continue;
        const auto first = static_cast<std::uint16_t>(skeleton.points.size());
        const auto second = static_cast<std::uint16_t>(first + 1);
        skeleton.points.push_back({factor.radius * Vec4::Unit(axis), first});
        skeleton.points.push_back({-factor.radius * Vec4::Unit(axis), second});
        skeleton.edges.push_back({first, second});
    }
    if (factor.dimensions > 1 && leans > kEven)
        skeleton.points.push_back({support(factor, direction), 6});
    return skeleton;
}

/// The product of two: a point of either with a point of the other, an edge of either with a point
/// of the other.
Skeleton operator*(const Skeleton& a, const Skeleton& b) {
    Skeleton both;
    const auto at = [&](std::size_t i, std::size_t k) {
        return static_cast<std::uint16_t>(i * b.points.size() + k);
    };
    for (const NamedPoint& p : a.points)
        for (const NamedPoint& q : b.points)
            both.points.push_back(
                {p.point + q.point, static_cast<std::uint16_t>(7 * p.name + q.name)});
    for (const auto& edge : a.edges)
        for (std::size_t k = 0; k < b.points.size(); ++k)
            both.edges.push_back({at(edge[0], k), at(edge[1], k)});
    for (std::size_t i = 0; i < a.points.size(); ++i)
        for (const auto& edge : b.edges) both.edges.push_back({at(i, edge[0]), at(i, edge[1])});
    return both;
}

}  // namespace

void piece_along(const HullShape& shape, const Vec4& direction, SurfacePiece& piece) {
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

std::vector<NamedPoint> points_along(const BallProduct& shape, const Vec4& direction) {
    Skeleton all{{{Vec4::Zero(), 0}}, {}};
    for (const BallFactor& factor : shape) all = all * skeleton_of(factor, direction);
    return all.points;
}

/// The ball that looks most along the direction gives a point, the others all of themselves: with a
/// segment's end it is a flat cell.
void piece_along(const BallProduct& shape, const Vec4& direction, SurfacePiece& piece) {
    const auto leans = [&](const BallFactor& factor) {
        return factor.axes.cwiseProduct(direction).squaredNorm();
    };
    const BallFactor* along =
        std::max_element(shape.begin(), shape.end(),
                         [&](const auto& a, const auto& b) { return leans(a) < leans(b); });
    Skeleton all{{{Vec4::Zero(), 0}}, {}};
    for (const BallFactor& factor : shape) {
        all = all * (&factor == along ? farthest_only(factor, direction)
                                      : skeleton_of(factor, direction));
        if (&factor == along) continue;
        if (factor.dimensions > 1) {
            piece.round_sides.push_back(
                {Mat4(factor.axes.asDiagonal()), Vec4::Zero(), factor.radius});
        } else {
            piece.sides.push_back({factor.axes, factor.radius});
            piece.sides.push_back({-factor.axes, factor.radius});
        }
    }
    piece.is_flat = along->dimensions == 1;
    piece.plane = {support(*along, direction) / along->radius, along->radius};
    if (!piece.is_flat) piece.top = {Mat4(along->axes.asDiagonal()), Vec4::Zero(), along->radius};
    for (const NamedPoint& p : all.points) {
        piece.vertices.push_back(p.point);
        piece.names.push_back(p.name);
    }
    piece.edges = std::move(all.edges);
}

/// All of the core.
void piece_along(const Hypercapsule& shape, const Vec4&, SurfacePiece& piece) {
    piece.vertices = {-0.5 * shape.height * Vec4::UnitY(), 0.5 * shape.height * Vec4::UnitY()};
    piece.names = {0, 1};
    piece.edges = {{0, 1}};
    piece.sides = {{Vec4::UnitY(), 0.5 * shape.height}, {-Vec4::UnitY(), 0.5 * shape.height}};
}

PlacedBalls placed_core(const BallProduct& shape, const Mat4& turn, const Vec4& centre) {
    PlacedBalls core = {{}, Vec4::Zero(), turn, centre};
    for (std::size_t i = 0; i < shape.factors; ++i) {
        core.radius[static_cast<int>(i)] = shape.factor[i].radius;
        for (std::size_t axis = 0; axis < 4; ++axis)
            if (shape.factor[i].axes[static_cast<int>(axis)] > 0)
                core.group[axis] = static_cast<std::uint8_t>(i);
    }
    return core;
}
PlacedBalls placed_core(const Hyperbox& shape, const Mat4& turn, const Vec4& centre) {
    return {{0, 1, 2, 3}, 0.5 * shape.size, turn, centre};
}
PlacedBalls placed_core(const Hypercapsule& shape, const Mat4& turn, const Vec4& centre) {
    return {{0, 1, 0, 0}, {0, 0.5 * shape.height, 0, 0}, turn, centre};
}

void move_to(const Mat4& rotation, const Vec4& position, SurfacePiece& piece) {
    const auto move = [&](HalfSpace& plane) {
        plane.normal = rotation * plane.normal;
        plane.offset += plane.normal.dot(position);
    };
    move(piece.plane);
    for (HalfSpace& side : piece.sides) move(side);
    const auto move_side = [&](RoundSide& side) {
        side.axes = rotation * side.axes * rotation.transpose();
        side.centre = position;
    };
    if (piece.top.radius > 0) move_side(piece.top);
    for (RoundSide& side : piece.round_sides) move_side(side);
    for (Vec4& vertex : piece.vertices) vertex = position + rotation * vertex;
}

}  // namespace tesserae
