#pragma once

#include <algorithm>
#include <array>

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"

namespace tesserae {

/// Two boxes in the frame of the first, a. Lengths are in units of `unit`, a power of two near the
/// largest half side, so that tolerances are plain numbers and nothing overflows.
struct BoxPair {
    Vec4 half_a, half_b;  ///< half sides
    Vec4 offset;          ///< centre of b
    Mat4 rotation;        ///< column j: axis j of b
    double unit = 1;      ///< [m]
};

/// @return the pair as given by sizes and poses: b's centre and axes in a's frame
BoxPair box_pair(const Hyperbox& a, const Vec4& position_a, const Mat4& axes_a, const Hyperbox& b,
                 const Vec4& position_b, const Mat4& axes_b);

/// The same pair with b first, in b's frame.
BoxPair swapped(const BoxPair& pair);

/// Rounding in a pair's coordinates stays below this, in units: corners closer to a clip plane lie
/// on it, points closer to each other are one, and axes that tie within it are equally good.
constexpr double kBoxSlack = 1e-12;

/// How much worse than the best axis a cell's may be and still build the manifold, relative to the
/// smallest half side. A cell gives up to 20 points where an edge gives one: without it a stack
/// that tilts by 1e-5 would stand on one point. Below the overlap of 0.005 that the solver leaves.
constexpr double kCellBias = 1e-3;
inline double cell_bias(const BoxPair& pair) {
    return kCellBias * std::min(pair.half_a.minCoeff(), pair.half_b.minCoeff());
}

/// Cosine of an angle (0.02 rad): a cell whose normal is nearer than that to the best one has the
/// contact. An edge has one point or two, on which a thin box that lands a little aslant turns
/// about faster than its next points are found. Less, and more thin boxes sink into each other;
/// more, and normals jump by more where a box tips over an edge.
constexpr double kLeaning = 0.9998;
/// The same (0.3 rad) where boxes overlap by more than this part of the smallest half side, twice
/// what the solver leaves: a point at one end of a sheet that is sunk in would turn it about
/// itself, the other end in, in the next step that one out, and so on down (of 96 piles of eight
/// sheets 23 had some deep in each other; at 0.1 rad 6, at 0.2 rad 2, at 0.3 and 0.5 rad none).
constexpr double kSunkLeaning = 0.955, kBoxSunk = 0.01;

/// A face of a box of any dimension: for each axis the side that it lies on, or 0 where it
/// extends. All 0 is the box, three 0 a cell, no 0 a vertex.
using BoxFace = std::array<signed char, 4>;

/// One of 81 numbers.
inline std::uint32_t code_of(const BoxFace& face) {
    std::uint32_t code = 0;
    for (const signed char side : face) code = 3 * code + static_cast<std::uint32_t>(side + 1);
    return code;
}

/// A contact point of a pair. The two faces that meet name it: the same pair of faces is the same
/// point, whichever box was the reference and whichever axis was taken.
struct BoxPoint {
    Vec4 on_b;  ///< where b's surface is, in a's frame, units
    double separation;
    BoxFace face_a, face_b;
};

/// The points of a pair on one normal, without heap. Clipping two cells gives at most 8 + 8
/// corners and two crossings on each of 12 + 12 edges.
struct BoxPoints {
    Vec4 normal = Vec4::UnitX();  ///< unit, from a to b, in a's frame
    std::array<BoxPoint, 64> point;
    int count = 0;

    /// The same points for the swapped pair: its first box's frame taken to its second's.
    /// @param pair  the pair that these points are of
    void swap_boxes(const BoxPair& pair);
    void clear();
    /// Appends the point unless it lies on one that is already there.
    void add_distinct(const Vec4& on_b, double separation, const BoxFace& face_a,
                      const BoxFace& face_b);
    double least_separation() const;

  private:
    using Lanes = Eigen::Array4d;
    std::array<Lanes, 16> marks_;  ///< a number of each point, the same for points in one place
};

/// -1 or +1: +1 for 0.
inline signed char side_of(double x) { return x < 0 ? -1 : 1; }

}  // namespace tesserae
