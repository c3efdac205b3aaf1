#pragma once

#include "core/contact/box_pair.hpp"

namespace tesserae {

/// A cell's normal: an axis of its own box.
struct CellAxis {
    int axis = 0;
    double gap = 0;
};

/// The normal of a 2-face of one box and an edge of the other. The 2-face extends along the two
/// axes that are neither p nor q.
struct EdgeAxis {
    bool face_of_b = false;
    int p = 0, q = 1;  ///< p < q
    int edge = 0;      ///< axis of the other box
    double gap = 0;
};

/// Error bound of a gap, in units.
constexpr double kGapError = 2e-14;

/// The best axis of each kind. A gap is how far the boxes lie apart along the unit axis; negative:
/// overlap. The largest is minus the least overlap where the boxes overlap, and a lower bound on
/// the distance where they don't.
struct SeparatingAxes {
    CellAxis cell_a, cell_b;
    EdgeAxis edge;

    double gap() const { return std::max({cell_a.gap, cell_b.gap, edge.gap}); }
    /// The edge's axis beats both cells.
    bool is_edge() const { return edge.gap > std::max(cell_a.gap, cell_b.gap); }
};

/// All 56 axes: the facets of a zonotope of eight generators are spanned by three of them each, so
/// the Minkowski difference of the boxes has the 4 + 4 cell normals and 24 + 24 generalised cross
/// products of two edges of one box and one edge of the other (Torres tests 32 and misses some).
/// @return false as soon as a gap exceeds `margin` (in units, >= 0); of `axes` only gap() is then
///         right, of those that were tried
/// Accuracy of a gap: kGapError units (tested).
bool find_separating_axes(const BoxPair& pair, double margin, SeparatingAxes& axes);

/// Unit, from a to b, in a's frame. Where the centres coincide along the axis either sign is
/// right: the positive one.
Vec4 normal_a(const BoxPair& pair, const CellAxis& axis);
Vec4 normal_b(const BoxPair& pair, const CellAxis& axis);
Vec4 normal_of(const BoxPair& pair, const EdgeAxis& axis);

/// The normal of the axis with the largest gap.
Vec4 best_normal(const BoxPair& pair, const SeparatingAxes& axes);

}  // namespace tesserae
