// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/box_pair.hpp"

namespace tesserae {

/// A CellAxis is the normal of a cell, which is an axis of its own box.
struct CellAxis {
    int axis = 0;
    double gap = 0;
};

/// An EdgeAxis is the normal of a 2-face of one box and an edge of the other. The 2-face extends
/// along the two axes that are neither p nor q.
struct EdgeAxis {
    bool face_of_b = false;
    int p = 0, q = 1;  ///< p < q
    int edge = 0;      ///< axis of the other box
    double gap = 0;
};

/// The error of a gap is at most this, in units.
constexpr double kGapError = 2e-14;

/// SeparatingAxes holds the best axis of each kind. A gap is how far the boxes lie apart along the
/// unit axis [units], negative in overlap. The largest gap is minus the least overlap if the boxes
/// overlap, and a lower bound of the distance if they don't.
struct SeparatingAxes {
    CellAxis cell_a, cell_b;
    EdgeAxis edge;

    double gap() const { return std::max({cell_a.gap, cell_b.gap, edge.gap}); }
    /// Returns whether the axis of the edge is better than those of both cells.
    bool is_edge() const { return edge.gap > std::max(cell_a.gap, cell_b.gap); }
};

/// Finds the best of all 56 axes. The facets of a zonotope of eight generators are each spanned by
/// three of them. So the Minkowski difference of the boxes has 4 + 4 cell normals and 24 + 24
/// generalised cross products of two edges of one box and one edge of the other (Torres tests 32
/// and misses some).
/// @return false as soon as a gap exceeds `margin` (in units, >= 0); then only gap() of `axes` is
///         right, for the axes that were tried
/// Accuracy of a gap: kGapError units (tested).
bool find_separating_axes(const BoxPair& pair, double margin, SeparatingAxes& axes);

/// Returns the unit normal of an axis from a to b, in the frame of a. If the centres coincide along
/// the axis either sign is right, and the positive one is taken.
Vec4 normal_a(const BoxPair& pair, const CellAxis& axis);
Vec4 normal_b(const BoxPair& pair, const CellAxis& axis);
Vec4 normal_of(const BoxPair& pair, const EdgeAxis& axis);

/// Returns the normal of the axis with the largest gap.
Vec4 best_normal(const BoxPair& pair, const SeparatingAxes& axes);

}  // namespace tesserae
