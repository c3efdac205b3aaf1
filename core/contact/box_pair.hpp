// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"

namespace tesserae {

/// A BoxPair is two boxes in the frame of the first, a. Lengths are in units of `unit`, a power of
/// two near the largest half side. Tolerances are then plain numbers, and nothing overflows.
struct BoxPair {
    Vec4 half_a, half_b;  ///< half sides [units]
    Vec4 offset;          ///< centre of b [units]
    Mat4 rotation;        ///< column j: axis j of b
    double unit = 1;      ///< [m]
};

/// Makes the pair from sizes and poses: it takes the centre and the axes of b into the frame of a.
BoxPair box_pair(const Hyperbox& a, const Vec4& position_a, const Mat4& axes_a, const Hyperbox& b,
                 const Vec4& position_b, const Mat4& axes_b);

/// Returns the same pair with b as the first box, in the frame of b.
BoxPair swapped(const BoxPair& pair);

/// Rounding in the coordinates of a pair stays below this, in units, usual 1e-12. Corners closer
/// than this to a clip plane lie on it, points closer to each other are one, and axes that tie
/// within it are equally good.
constexpr double kBoxSlack = 1e-12;

/// A cell may build the manifold if its axis is at most this much worse than the best one, relative
/// to the smallest half side, usual 1e-3. A cell gives up to 20 points where an edge gives one.
/// Less, and a stack that tilts by 1e-5 stands on one point. It must be below the overlap that the
/// solver leaves (kSlop, 0.005).
constexpr double kCellBias = 1e-3;
/// Returns kCellBias for the smallest half side of a pair [units].
inline double cell_bias(const BoxPair& pair) {
    return kCellBias * std::min(pair.half_a.minCoeff(), pair.half_b.minCoeff());
}

/// A cell builds the manifold if the cosine of the angle between its normal and the best one is at
/// least this, usual 0.9998 (0.02 rad). An edge has only one or two points. A thin box that lands
/// slightly tilted turns about them faster than its next points are found. A smaller angle, and
/// more thin boxes sink into each other; a larger one, and normals jump by more where a box tips
/// over an edge.
constexpr double kLeaning = 0.9998;
/// kSunkLeaning replaces kLeaning for boxes that overlap by more than kBoxSunk, as a part of the
/// smallest half side; usual 0.955 (0.3 rad) and 0.01, twice kSlop. A point at one end of a sheet
/// that has sunk in would turn the other end in, and the next step would turn that one out. An
/// angle of 0.2 rad or less leaves more sheets of a pile sunk into each other; 0.5 rad is no
/// better.
constexpr double kSunkLeaning = 0.955, kBoxSunk = 0.01;

/// A BoxFace is a face of a box of any dimension. For each axis it holds the side (-1 or 1) that
/// the face lies on, or 0 where the face extends. All 0 is the box, three 0 a cell, no 0 a vertex.
using BoxFace = std::array<signed char, 4>;

/// Returns a number from 0 to 80 that identifies the face.
inline std::uint32_t code_of(const BoxFace& face) {
    std::uint32_t code = 0;
    for (const signed char side : face) code = 3 * code + static_cast<std::uint32_t>(side + 1);
    return code;
}

/// A BoxPoint is a contact point of a pair. The two faces that meet name it: the same pair of faces
/// is the same point, whichever box was the reference and whichever axis was taken.
struct BoxPoint {
    Vec4 on_b;          ///< on the surface of b, in the frame of a [units]
    double separation;  ///< along the normal [units], negative in overlap
    BoxFace face_a, face_b;
};

/// BoxPoints is the contact points of a pair along one normal. It takes no heap memory. Clipping
/// two cells gives at most 8 + 8 corners and two crossings on each of 12 + 12 edges.
struct BoxPoints {
    Vec4 normal = Vec4::UnitX();  ///< unit, from a to b, in a's frame
    std::array<BoxPoint, 64> point;
    int count = 0;

    /// Turns these points into those of the swapped pair: from the frame of the first box into that
    /// of the second.
    /// @param pair   the pair that the points belong to, before the swap
    void swap_boxes(const BoxPair& pair);
    void clear();
    /// Appends the point unless it coincides with one that is already there.
    void add_distinct(const Vec4& on_b, double separation, const BoxFace& face_a,
                      const BoxFace& face_b);
    /// Returns the least separation of all points [units], infinite if there are none.
    double least_separation() const;

  private:
    using Lanes = Eigen::Array4d;
    std::array<Lanes, 16> marks_;  ///< a number for each point; points in one place have the same
};

/// Returns the sign of x as -1 or +1; +1 for 0.
inline signed char side_of(double x) { return x < 0 ? -1 : 1; }

}  // namespace tesserae
