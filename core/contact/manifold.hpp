#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// A point of a pair whose points share one normal. Nothing is set: many are made, few are filled.
struct ContactPoint {
    Vec4 point;             ///< midway between the two surfaces, in any frame and unit of length
    double separation;      ///< along the normal, negative when overlapping
    std::uint32_t feature;  ///< differs from that of every other point of the pair
};

/// As many points as a pair keeps: a cell has eight corners.
constexpr std::size_t kManifoldPoints = 8;
/// As many as reduce_manifold takes: a cell clipped by another has at most 20 corners, and every
/// one may be there several times over by rounding.
constexpr std::size_t kManifoldInput = 64;

/// Moves the points to keep to the front, ascending by feature, and returns their number: all of
/// them up to kManifoldPoints; else the deepest, the farthest from it, the farthest from their
/// line, the farthest from their plane, and then four times the one farthest from all that are
/// kept. Distances are seen along the normal. Of points about equally far the deepest is taken, of
/// those about as deep the farthest, then the one of lowest feature. Where the deepest has sunk in
/// by a visible part of the manifold's length, points half as deep go before all others. The result
/// depends on the set of points, not on their order. Takes at most kManifoldInput points.
/// @param normal  unit, of the contact, in the frame of the points
std::size_t reduce_manifold(std::span<ContactPoint> points, const Vec4& normal);

/// The same of corners of a body at a plane, without those that are behind a deeper one, seen along
/// the normal by less aside than they are higher. Of a card that lies on it the corners of the
/// upper face are about as deep as those of the lower one, and would take their places.
std::size_t reduce_corners(std::span<ContactPoint> corners, const Vec4& normal);

}  // namespace tesserae
