// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// A ContactPoint is a point of a pair whose points share one normal. Its members are not
/// initialised: many are made and few are filled.
struct ContactPoint {
    Vec4 point;             ///< midway between the two surfaces, in any frame and unit of length
    double separation;      ///< along the normal, negative when overlapping
    std::uint32_t feature;  ///< differs from that of every other point of the pair
};

/// A pair keeps at most so many points: a cell has eight corners.
constexpr std::size_t kManifoldPoints = 8;
/// reduce_manifold() takes at most so many points. A cell clipped by another has at most 20
/// corners, and rounding may repeat each of them several times.
constexpr std::size_t kManifoldInput = 64;

/// Moves the points to keep to the front, ascending by feature, and returns their number. Up to
/// kManifoldPoints all are kept. Of more these are: the deepest, the farthest from it, the farthest
/// from their line, the farthest from their plane, and then four times the one farthest from all
/// that are kept. Distances are seen along the normal. Among points about equally far the deepest
/// is taken, among those about as deep the farthest, then the one of lowest feature. If the deepest
/// has sunk in by a visible part of the manifold's length, points at least half as deep are taken
/// before all others. The result depends on the set of points, not on their order. Takes at most
/// kManifoldInput points.
/// @param normal   unit, of the contact, in the frame of the points
std::size_t reduce_manifold(std::span<ContactPoint> points, const Vec4& normal);

/// Reduces the corners of a body at a plane in the same way. Of more than kManifoldPoints it first
/// leaves out those behind a deeper corner: seen along the normal, they are less far aside of it
/// than they are higher. If a card lies on the plane, the corners of its upper face are about as
/// deep as those of the lower one, and would take their places.
std::size_t reduce_corners(std::span<ContactPoint> corners, const Vec4& normal);

}  // namespace tesserae
