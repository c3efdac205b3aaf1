#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/contact.hpp"
#include "core/convex/convex_separation.hpp"
#include "core/convex/hull.hpp"
#include "core/shape/room.hpp"

namespace tesserae {

/// The points whose part in some plane or 3-space is within a ball there.
struct RoundSide {
    Mat4 axes;  ///< projects onto the plane or 3-space
    Vec4 centre;
    double radius;
};

/// A piece of a body's surface: a flat cell, or one of less dimensions, in the world.
struct SurfacePiece {
    bool is_flat = false;  ///< a cell, in the hyperplane that bounds `plane`, within its sides
    HalfSpace plane{};
    /// What a piece that is not flat is a part of the surface of: of radius 0 where the level of
    /// the core says as much, as of a segment.
    RoundSide top{};
    std::vector<HalfSpace> sides;
    std::vector<RoundSide> round_sides;
    std::vector<Vec4> vertices;                       ///< of a round piece some that span it
    std::vector<std::uint16_t> names;                 ///< of the vertices
    std::vector<std::array<std::uint16_t, 2>> edges;  ///< by the places of their ends
};

/// A body as the general pair function sees it: all points within a radius of a convex core, about
/// an origin that a pair's two bodies share.
struct ConvexBody {
    Support core;
    double radius;
    /// Puts the piece of the core's surface that looks most along a direction into an empty one.
    FunctionRef<void(const Vec4& direction, SurfacePiece& piece)> surface_piece;
    /// The core's signed distance, and the way out.
    FunctionRef<Level(const Vec4& point)> level;
};

/// Contact points of any two convex bodies: their separation, and where a cell lies near the other
/// body's piece that faces it the corners of both, each clipped to the other along the normal;
/// where neither is flat, as two bodies side by side on their round sides, those that are near the
/// other.
/// @param nearest   of the cores
/// @param size      sum of the bounding radii [m]
/// @param origin    of both bodies' coordinates, world
void convex_contacts(const ConvexBody& a, const ConvexBody& b, const ConvexSeparation& nearest,
                     double size, const Vec4& origin, double margin, PairContacts& out);

/// The corners of either body over one flat cell of the other, wherever they are nearest, each with
/// its separation along the cell's normal; none where nothing is over it.
/// @param face_of_b   the cell is b's, otherwise a's
/// @param outward     near the cell's normal, world
void convex_contacts_over_face(const ConvexBody& a, const ConvexBody& b, bool face_of_b,
                               const Vec4& outward, double size, const Vec4& origin, double margin,
                               PairContacts& out);

/// What both functions call a corner of a body over the other's cell.
/// @param of_b   the corner is b's
/// @param name   of the corner, as in SurfacePiece::names
std::uint32_t feature_of_corner(bool of_b, std::uint32_t name);

}  // namespace tesserae
