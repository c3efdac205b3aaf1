#pragma once

#include "core/contact/separating_axes.hpp"

namespace tesserae {

/// The closest points of two boxes that lie apart.
struct BoxWitness {
    double distance = 0;
    Vec4 normal = Vec4::UnitX();  ///< unit, from a to b, in a's frame
    Vec4 on_a, on_b;              ///< each in its own box's frame
    BoxFace face_a, face_b;       ///< the faces they lie on; dimensions k + l <= 3

    /// k + l = 3: the faces meet inside both, and their normal is a separating axis.
    bool spans_axis() const {
        return std::count(face_a.begin(), face_a.end(), 0) +
                   std::count(face_b.begin(), face_b.end(), 0) ==
               3;
    }
};

/// Error bound of a distance, in units: nearly touching boxes may have features for which rounding
/// hides a turn of b - a by 1e-19/distance, which is worth that times up to eight sides of 4 units,
/// and no more than the distance. At distances of 1e-4 and more the error is below 1e-14.
constexpr double kDistanceError = 2e-9;

/// Distance of two boxes: least |b - a| over both, box-constrained least squares in the eight
/// coordinates, by an active set (Stark and Parker 1995, "Bounded-variable least squares"). It
/// starts from the vertices that face each other along `normal` and frees one coordinate at a time;
/// free ones end up orthogonal to b - a, so that at most three are free at the end.
/// Works in long double: a rounding of 1e-16 in b - a is an angle of 1e-8 when the gap is 1e-8,
/// and would choose wrong features.
/// Accuracy: kDistanceError units.
BoxWitness closest_points(const BoxPair& pair, const Vec4& normal);

/// The signed separation of two boxes, exact on both sides of touching.
struct BoxSeparation {
    double value = 0;     ///< distance, or minus the least overlap of all directions
    bool is_axis = true;  ///< along a separating axis; else along the witness's normal
    BoxWitness witness;   ///< of boxes apart
};
BoxSeparation separation_of(const BoxPair& pair, const SeparatingAxes& axes);

}  // namespace tesserae
