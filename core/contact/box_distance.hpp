// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/separating_axes.hpp"

namespace tesserae {

/// A BoxWitness is the closest points of two boxes that lie apart.
struct BoxWitness {
    double distance = 0;
    Vec4 normal = Vec4::UnitX();  ///< unit, from a to b, in a's frame
    Vec4 on_a, on_b;              ///< each in its own box's frame
    BoxFace face_a, face_b;       ///< the points lie on these; dimensions add up to 3 at most

    /// Returns whether the dimensions of the faces add up to 3. The points are then inside both
    /// faces, whose common normal is a separating axis.
    bool spans_axis() const {
        return std::count(face_a.begin(), face_a.end(), 0) +
                   std::count(face_b.begin(), face_b.end(), 0) ==
               3;
    }
};

/// The error of a distance is at most this, in units, usual 2e-9. Nearly touching boxes may have
/// features for which rounding hides a turn of b - a by 1e-19/distance. The error is that turn
/// times up to eight sides of 4 units, and no more than the distance. At distances of 1e-4 and more
/// it is below 4e-14.
constexpr double kDistanceError = 2e-9;

/// Returns the closest points of two boxes. The least |b - a| over both boxes is a box-constrained
/// least-squares problem in the eight coordinates, solved by an active set (Stark and Parker 1995,
/// "Bounded-variable least squares"). It starts from the vertices that face each other along
/// `normal` and frees one coordinate at a time. Free ones end up orthogonal to b - a, so at most
/// three are free at the end.
/// It works in long double: a rounding of 1e-16 in b - a is an angle of 1e-8 when the gap is 1e-8,
/// and would choose wrong features.
/// Accuracy: kDistanceError units.
BoxWitness closest_points(const BoxPair& pair, const Vec4& normal);

/// A BoxSeparation is the signed separation of two boxes, exact on both sides of touching.
struct BoxSeparation {
    double value = 0;     ///< distance, or minus the least overlap of all directions [units]
    bool is_axis = true;  ///< it is along a separating axis; else along the witness's normal
    BoxWitness witness;   ///< closest points, if the boxes lie apart
};
/// Returns the signed separation of two boxes.
/// @param axes   as found by find_separating_axes()
BoxSeparation separation_of(const BoxPair& pair, const SeparatingAxes& axes);

}  // namespace tesserae
