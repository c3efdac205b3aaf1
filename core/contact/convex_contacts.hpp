// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/contact.hpp"
#include "core/convex/convex_separation.hpp"
#include "core/convex/hull.hpp"
#include "core/shape/room.hpp"

namespace tesserae {

/// A RoundSide is all points whose projection onto a plane or 3-space lies in a ball there.
struct RoundSide {
    Mat4 axes;  ///< projects onto the plane or 3-space
    Vec4 centre;
    double radius;
};

/// A SurfacePiece is a piece of a body's surface in the world: a flat cell, or one of fewer
/// dimensions.
struct SurfacePiece {
    bool is_flat = false;  ///< a cell, in the hyperplane that bounds `plane`, within its sides
    HalfSpace plane{};
    /// A piece that is not flat is a part of the surface of this round side. The radius is 0 where
    /// the level of the core says as much, as for a segment.
    RoundSide top{};
    std::vector<HalfSpace> sides;
    std::vector<RoundSide> round_sides;
    std::vector<Vec4> vertices;        ///< of a round piece: some points that span it
    std::vector<std::uint16_t> names;  ///< one for each vertex
    std::vector<std::array<std::uint16_t, 2>> edges;  ///< places of the two ends in `vertices`
};

/// A ConvexBody is a body as the general pair function sees it: all points within a radius of a
/// convex core. The two bodies of a pair share an origin of coordinates.
struct ConvexBody {
    Support core;
    double radius;
    /// Fills an empty piece with the part of the core's surface that faces a direction most.
    FunctionRef<void(const Vec4& direction, SurfacePiece& piece)> surface_piece;
    /// Returns the signed distance of a point from the core, and its gradient.
    FunctionRef<Level(const Vec4& point)> level;
};

/// Finds the contact points of any two convex bodies. If a cell of one body faces the other's
/// piece, the corners of both are points, each clipped to the other along the normal. If neither
/// piece is flat, as for two bodies side by side on their round sides, the corners that are near
/// the other are points. The nearest points are one too, unless another is as near.
/// @param nearest   separation of the cores
/// @param size      sum of the bounding radii [m]
/// @param origin    of both bodies' coordinates, world [m]
void convex_contacts(const ConvexBody& a, const ConvexBody& b, const ConvexSeparation& nearest,
                     double size, const Vec4& origin, double margin, PairContacts& out);

/// Finds the corners of either body over one flat cell of the other, wherever the bodies are
/// nearest. Each has its separation along the cell's normal. There are none if nothing is over the
/// cell.
/// @param face_of_b   the cell belongs to b, otherwise to a
/// @param outward     a direction near the cell's normal, world
void convex_contacts_over_face(const ConvexBody& a, const ConvexBody& b, bool face_of_b,
                               const Vec4& outward, double size, const Vec4& origin, double margin,
                               PairContacts& out);

/// Returns the feature that both functions give to a corner of a body over the other's cell.
/// @param of_b   the corner belongs to b
/// @param name   of the corner, as in SurfacePiece::names
std::uint32_t feature_of_corner(bool of_b, std::uint32_t name);

}  // namespace tesserae
